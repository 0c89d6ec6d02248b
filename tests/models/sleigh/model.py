"""A sleigh on a blade, which does not move sideways (S. A. Chaplygin 1911)."""

from codegen.model import *

model = Model("Chaplygin's sleigh", source="Chaplygin, S. A. (1911), Mat. Sb. 28(2), 303-314: a constraint on a velocity")

m = model.parameter("m", "kg", 1.5, "mass", above=0)
I = model.parameter("I", "kg m^2", 0.4, "moment of inertia about the centre of mass", above=0)
a = model.parameter("a", "m", 0.3, "distance of the centre of mass ahead of the blade")

x = model.coordinate("x", "m", "place of the blade")
y = model.coordinate("y", "m", "the same, across")
phi = model.coordinate("phi", "rad", "heading")
model.rigid_body(m, I, (x + a * cos(phi), y + a * sin(phi)), phi)

model.constraint("blade", -x.rate * sin(phi) + y.rate * cos(phi), switch=True)
