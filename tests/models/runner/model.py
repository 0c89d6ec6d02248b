"""A mass at constant velocity that runs through guards with special zeros: states x' = const."""

from codegen.model import *

model = Model("Mass running through guards", source="test model: events of a linear function of time")

special = model.choice("guard", ("two_roots", "triple_root", "pole"), "the guard that the mass runs through")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
c = model.parameter("c", "m", 1 / 3, "place of the zero, or of the middle between two")
d = model.parameter("d", "m", 1e-2, "half the distance between two zeros", minimum=0)

x = model.coordinate("x", "m", "place of the mass")
model.point_mass(m, position=(x, 0))

outside = model.mode("outside", "where the guard is positive")
inside = model.mode("inside", "where the guard is negative")
guard = {"two_roots": (x - c) ** 2 - d**2, "triple_root": (c - x) ** 3, "pole": 1 / (c - x)}[special]
model.transition("enter", outside, inside, when=falls(guard))
model.transition("leave", inside, outside, when=rises(guard))
