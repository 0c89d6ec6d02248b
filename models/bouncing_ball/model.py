"""A ball that falls on a rigid floor and bounces; see README.md."""

from codegen.model import *

model = Model("Bouncing ball", source="Newton's law of restitution; e.g. Brogliato, B. (2016), Nonsmooth Mechanics, 3rd ed., section 1.1")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
e = model.parameter("e", "1", 0.8, "restitution", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

h = model.coordinate("h", "m", "height above the floor")

model.gravity(g)
model.point_mass(m, position=(0, h))

model.contact("floor", gap=h, restitution=e)

model.draw("ground", [(-1, 0), (1, 0)], kind="fixed")
model.draw("ball", [(0, h)], kind="point")
model.draw("floor", [(0, h)], kind="contact")
