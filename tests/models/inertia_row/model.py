"""Three coordinates, coupled by inertia in a row: an impulse at the last opens the stop of the middle one, and reaches the first."""

from codegen.model import *

model = Model("Row of coupled inertias", source="test model: tests/engine/impacts.rs")

m = model.parameter("m", "kg", 1.0, "inertia of each", above=0)
c = model.parameter("c", "1", -0.3, "inertia between neighbours over that of one")
x0 = model.coordinate("x0", "m", "the first")
x1 = model.coordinate("x1", "m", "the middle one", minimum=0)
x2 = model.coordinate("x2", "m", "the last", minimum=0)

model.kinetic(m * (x0.rate**2 + x1.rate**2 + x2.rate**2) / 2 + c * m * x1.rate * (x0.rate + x2.rate))
model.contact("middle", gap=x1)
model.contact("last", gap=x2)
