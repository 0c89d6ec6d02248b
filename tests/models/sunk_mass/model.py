"""A mass on a spring that pulls it below a floor, by multipliers."""

from codegen.model import *

model = Model("Mass pulled below a floor", source="test model: a gap that is below zero in the middle of a step alone")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness", above=0)
depth = model.parameter("depth", "m", 1e-6, "how far below the floor the spring pulls no more", minimum=0)
floor = model.parameter("floor", "m", 1.0, "height of the floor")
y = model.coordinate("y", "m", "height")
model.point_mass(m, position=(0, y))
model.potential(k * (y - floor + depth)**2 / 2)
model.contact("floor", gap=y - floor, restitution=0)
model.multipliers()
