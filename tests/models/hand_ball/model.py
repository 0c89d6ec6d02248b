"""A ball that falls on a rigid floor and bounces; its modes written by hand."""

from codegen.model import *

model = Model("Bouncing ball", source="Newton's law of restitution; e.g. Brogliato, B. (2016), Nonsmooth Mechanics, 3rd ed., section 1.1")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
e = model.parameter("e", "1", 0.8, "restitution", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

h = model.coordinate("h", "m", "height above the floor", minimum=0)

model.gravity(g)
model.point_mass(m, position=(0, h))

flies = model.mode("flies", "in free flight")
rests = model.mode("rests", "on the floor", freeze=[(h, 0)])

model.transition("impact", flies, flies, when=falls(h), impact=True, reset=[(h, 0), (h.rate, -e * h.rate)])
model.transition("take_off", rests, flies, when=falls(rests.reaction(h)))
model.rest(flies, rests)

model.draw("floor", [(-1, 0), (1, 0)], kind="fixed")
model.draw("ball", [(0, h)], kind="point")
model.draw("lowest point", [(0, h)], kind="contact", force=(None, h), states=[(rests, "closed")])
