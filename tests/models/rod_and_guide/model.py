"""A crank with a rod to a slider on rough ground, which it may leave: it turns back where crank and rod are in line."""

from codegen.model import *

model = Model("A slider on a rod", source="closed form: the slider turns where the angle of the crank is a multiple of π")
r = model.parameter("r", "m", 0.1, "crank", above=0)
J = model.parameter("J", "kg m^2", 0.1, "moment of inertia of the crank", above=0)
l = model.parameter("l", "m", 0.3, "rod", above=0)
m = model.parameter("m", "kg", 0.5, "mass of the slider", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
phi = model.coordinate("phi", "rad", "angle of the crank")
x = model.coordinate("x", "m", "slider, to the right")
y = model.coordinate("y", "m", "slider, height")
psi = model.coordinate("psi", "rad", "angle of the rod")
model.gravity(g)
model.point_mass(m, position=(x, y))
model.kinetic(J * phi.rate**2 / 2 + m * l**2 * psi.rate**2 / 24)
model.constraint("rod", (r * cos(phi) + l * cos(psi) - x, r * sin(phi) - l * sin(psi) - y))
model.contact("guide", gap=y, slip=x, static=0.4, kinetic=0.3)
