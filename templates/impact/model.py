"""A ball that bounces until it rests: see README.md."""

from codegen.model import *

model = Model("Ball on a floor", source="Newton, I. (1687), Philosophiae naturalis principia mathematica, laws of motion, scholium")

# Constants of a run: name, unit, default, meaning. A scene may give other values within the limits.
m = model.parameter("m", "kg", 1.0, "mass", above=0)
e = model.parameter("e", "1", 0.7, "restitution: rate after an impact over rate before it", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

# What moves. `minimum` says that no scene may start below the floor.
h = model.coordinate("h", "m", "height above the floor", minimum=0)

model.gravity(g)
model.point_mass(m, position=(0, h))

# Two modes: while the ball rests, the force that holds h is that of the floor.
flies = model.mode("flies", "in free flight")
rests = model.mode("rests", "on the floor", freeze=[(h, 0)])

# An impact sets a new velocity; the energy that it takes is recorded.
model.transition("impact", flies, flies, when=falls(h), impact=True, reset=[(h, 0), (h.rate, -e * h.rate)])
model.transition("take_off", rests, flies, when=falls(rests.reaction(h)))
# Infinitely many impacts in finite time end here.
model.rest(flies, rests)

# What pages show: `dalembert run scene.json --html page.html`.
model.draw("floor", [(-1, 0), (1, 0)], kind="fixed")
model.draw("ball", [(0, h)], kind="point")
