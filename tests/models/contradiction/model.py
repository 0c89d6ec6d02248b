"""A mass whose two modes exclude each other between two places: no mode is admissible there."""

from codegen.model import *

model = Model("Guards that contradict each other", source="test model: settling without an admissible mode")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
gap = model.parameter("gap", "m", 1.0, "half width of the places where no mode is admissible", minimum=0)

x = model.coordinate("x", "m", "place of the mass")
model.point_mass(m, position=(x, 0))

right = model.mode("right", "right of the gap")
left = model.mode("left", "left of the gap")
model.transition("to_left", right, left, when=falls(x - gap))
model.transition("to_right", left, right, when=rises(x + gap))
