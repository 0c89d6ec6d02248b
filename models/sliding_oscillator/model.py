"""A mass that slips on shaken ground and carries a second one on a spring and a damper; see README.md."""

from codegen.model import *

model = Model("Two-mass oscillator that slips on shaken ground", source="Mostaghel, N. and Tanbakuchi, J. (1983), Earthquake Eng. Struct. Dyn. 11(6), 729-748")

m_s = model.parameter("m_s", "kg", 5.0, "mass that slips on the ground", above=0)
m_i = model.parameter("m_i", "kg", 39.33, "mass on the spring", above=0)
k = model.parameter("k", "N/m", 1.05e6, "stiffness of the spring", minimum=0)
c = model.parameter("c", "N s/m", 642.0, "damping of the damper", minimum=0)
mu_s = model.parameter("mu_s", "1", 0.2, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.19, "kinetic friction coefficient", minimum=0, at_most=mu_s)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

u = model.coordinate("u", "m", "slip of the lower mass on the ground, to the right")
d = model.coordinate("d", "m", "elongation of the spring: how far the upper mass is ahead of the lower one", scale=1e-3, rate_scale=0.1)
z_h = model.ground("z_h", "motion of the ground to the right", input="ground_acceleration")

model.gravity(g)
model.point_mass(m_s, position=(u, 0))
model.point_mass(m_i, position=(u + d, 0))
model.potential(k * d**2 / 2)
model.dissipation(c * d.rate**2 / 2)

model.friction("base", slip=u, normal=(m_s + m_i) * g, static=mu_s, kinetic=mu_k)

model.output("upper", "m", u + d, "displacement of the upper mass relative to the ground, to the right")
model.output("shear_ratio", "1", model.reaction(z_h) / ((m_s + m_i) * g), "force of the ground to the right, over the weight")

model.draw("ground", [(-0.5, -0.05), (0.8, -0.05)], kind="fixed")
model.draw("lower mass", [(u - 0.1, -0.05), (u + 0.1, -0.05), (u + 0.1, 0.05), (u - 0.1, 0.05)])
model.draw("base", [(u, -0.05)], kind="contact")
model.draw("spring", [(u + 0.1, 0), (u + d + 0.3, 0)], kind="spring")
model.draw("upper mass", [(u + d + 0.3, -0.04), (u + d + 0.4, -0.04), (u + d + 0.4, 0.04), (u + d + 0.3, 0.04)])
