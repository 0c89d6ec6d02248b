"""A rod that falls on two supports; its centre is guided."""

from codegen.model import *

model = Model("Rod on two supports", source="Newton's law of restitution (Moreau 1988)")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
J = model.parameter("J", "kg m^2", 1 / 3, "inertia about the centre", above=0)
a = model.parameter("a", "m", 0.5, "left support, from the centre", above=0)
b = model.parameter("b", "m", 0.5, "right support, from the centre", above=0)
e = model.parameter("e", "1", 0.0, "restitution", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

y = model.coordinate("y", "m", "centre, above the supports")
theta = model.coordinate("theta", "rad", "turn, counter-clockwise")
model.gravity(g)
model.rigid_body(m, inertia=J, position=(0, y), angle=theta)
model.contact("left", gap=y - a * tan(theta), restitution=e)
model.contact("right", gap=y + b * tan(theta), restitution=e)
