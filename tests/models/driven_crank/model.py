"""A slider-crank whose crank is driven: a prescribed angle in constraints."""

from codegen.model import *

model = Model("A driven slider-crank", source="closed form: x = r cos φ + √(l² − r² sin² φ)")
r = model.parameter("r", "m", 0.1, "crank", above=0)
l = model.parameter("l", "m", 0.3, "rod", above=0)
m = model.parameter("m", "kg", 2.0, "mass of the slider", above=0)
m_r = model.parameter("m_r", "kg", 0.5, "mass of the rod", above=0)
x = model.coordinate("x", "m", "slider")
psi = model.coordinate("psi", "rad", "angle of the rod")
phi = model.motion("phi", "angle of the crank", input="crank_acceleration", unit="rad")
model.point_mass(m, position=(x, 0))
model.rigid_body(m_r, m_r * l**2 / 12, position=(x - l / 2 * cos(psi), l / 2 * sin(psi)), angle=psi)
model.constraint("rod", (r * cos(phi) + l * cos(psi) - x, r * sin(phi) - l * sin(psi)))
