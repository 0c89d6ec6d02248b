"""A block on a belt, under a weight that moves at a speed of its own: both frictions act along the same coordinate."""

from codegen.model import *

model = Model("Block between two belts", source="test model: of two slips along one line one stops")

m = model.parameter("m", "kg", 1.0, "mass of the block", above=0)
M = model.parameter("M", "kg", 1.0, "mass of the weight", above=0)
g = model.parameter("g", "m/s^2", 10.0, "gravity", minimum=0)
mu = model.parameter("mu", "1", 0.5, "friction", minimum=0)
v = model.parameter("v", "m/s", 1.0, "speed of the belt")
w = model.parameter("w", "m/s", -1.0, "speed of the weight")

x = model.coordinate("x", "m", "place of the block")
y = model.coordinate("y", "m", "height of the block")
h = model.coordinate("h", "m", "height of the weight above the block at rest")
model.gravity(g)
model.point_mass(m, position=(x, y))
model.point_mass(M, position=(0, h))

model.contact("belt", gap=y, slip=x.rate - v, kinetic=mu)
model.contact("weight", gap=h - y, slip=x.rate - w, kinetic=mu)
