"""A slider turned by a torsion spring: atan2 has no Taylor recurrence."""

from codegen.model import *

model = Model("Slider on a torsion spring", source="test model: equations without a Taylor series")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
kappa = model.parameter("kappa", "N m", 4.0, "stiffness of the torsion spring", minimum=0)
h = model.parameter("h", "m", 1.0, "height of the spring above the slider's line", above=0)

x = model.coordinate("x", "m", "place of the slider; 0 is below the spring")
model.point_mass(m, position=(x, 0))
model.potential(kappa * atan2(x, h) ** 2 / 2)

slides = model.mode("slides", "in motion")
