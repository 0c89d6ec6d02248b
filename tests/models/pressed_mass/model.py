"""A mass that a spring presses against a stop which is not at zero."""

from codegen.model import *

model = Model("Mass at a stop", source="test model: hops that end in the rounding of their coordinate")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 4.0, "stiffness")
s = model.parameter("s", "m", 2.0, "place at which the spring pulls no more")
d = model.parameter("d", "m", 1.0, "place of the stop")
e = model.parameter("e", "1", 0.5, "restitution", minimum=0, maximum=1)

x = model.coordinate("x", "m", "place of the mass")

model.point_mass(m, position=(x, 0))
model.potential(k * (x - s)**2 / 2)
model.contact("stop", gap=d - x, restitution=e)
