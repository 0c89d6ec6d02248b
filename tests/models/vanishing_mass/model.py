"""A mass that decreases with the way, until nothing of it is left."""

from codegen.model import *

model = Model("Vanishing mass", source="test model: an effective mass that comes to zero during the motion")

m = model.parameter("m", "kg", 1.0, "mass at the start of the way", above=0)
L = model.parameter("L", "m", 1.0, "length of the way", above=0)
F = model.parameter("F", "N", 1.0, "force", minimum=0)

x = model.coordinate("x", "m", "way")
y = model.coordinate("y", "m", "place of a mass beside it")
model.kinetic(m * (1 - x / L) * x.rate**2 / 2)
model.point_mass(m, position=(y, 0))
model.force(x, F)
model.mode("moves", "moves")
