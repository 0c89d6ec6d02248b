"""A mass that slips on shaken ground and carries a second one on a spring and a damper; its modes written by hand."""

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
y = model.coordinate("y", "m", "height; its reaction is the normal force")
slip = model.discrete("slip", (+1, -1), "sign of the slip rate")
z_h = model.ground("z_h", "motion of the ground to the right", input="ground_acceleration")

model.gravity(g)
model.point_mass(m_s, position=(u, y))
model.point_mass(m_i, position=(u + d, y))
model.potential(k * d**2 / 2)
model.dissipation(c * d.rate**2 / 2)

sticks = model.mode("sticks", "the lower mass sticks to the ground", freeze=[u, (y, 0)])
slips = model.mode("slips", "the lower mass slips", freeze=[(y, 0)])

slips.friction(u, normal=slips.reaction(y), coefficient=mu_k, direction=slip)
stops = falls(slip * u.rate)
limit = mu_s * sticks.reaction(y)
model.transition(
    "stick", slips, sticks, when=stops,
    reset=[(u.rate, 0)], provided=[limit + sticks.reaction(u), limit - sticks.reaction(u)],
)
model.transition("reversal", slips, slips, when=stops, reset=[(slip, -slip), (u.rate, 0)])
for direction in (+1, -1):
    model.transition("slip", sticks, slips, when=falls(limit + direction * sticks.reaction(u)), reset=[(slip, direction)])

model.output("upper", "m", u + d, "displacement of the upper mass relative to the ground, to the right")
model.output("shear_ratio", "1", model.reaction(z_h) / ((m_s + m_i) * g), "force of the ground to the right, over the weight")

model.draw("ground", [(-0.5, -0.05), (0.8, -0.05)], kind="fixed")
model.draw("lower mass", [(u - 0.1, -0.05), (u + 0.1, -0.05), (u + 0.1, 0.05), (u - 0.1, 0.05)])
model.draw("base", [(u, -0.05)], kind="contact", force=(u, y), states=[(sticks, "sticks"), (slips, "slides")])
model.draw("spring", [(u + 0.1, 0), (u + d + 0.3, 0)], kind="spring")
model.draw("upper mass", [(u + d + 0.3, -0.04), (u + d + 0.4, -0.04), (u + d + 0.4, 0.04), (u + d + 0.3, 0.04)])
