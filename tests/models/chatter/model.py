"""A relay that drives a mass back to a sliding surface, and no mode for sliding on it."""

from codegen.model import *

model = Model("Relay without a sliding mode", source="test model: chattering; e.g. Utkin, V. I. (1992), Sliding Modes in Control and Optimization")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
F = model.parameter("F", "N", 2.0, "force of the relay", minimum=0)
rate = model.parameter("rate", "1/s", 1.0, "decay of x on the surface", above=0)

x = model.coordinate("x", "m", "place of the mass")
model.point_mass(m, position=(x, 0))

surface = x.rate + rate * x
above = model.mode("above", "on the positive side of the surface")
below = model.mode("below", "on the negative side of the surface")
above.force(x, -F)
below.force(x, F)
model.transition("down", above, below, when=falls(surface))
model.transition("up", below, above, when=rises(surface))
