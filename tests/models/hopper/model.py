"""Two masses on a spring, one above the other; the lower one stands on the ground, lifts off and lands plastically."""

from codegen.model import *

model = Model("Two-mass hopper", source="test model: smooth lift-off, with and without a condition")

place = model.choice("place", ("elongation", "height"), "coordinate of the upper mass", default="elongation")
landing = model.choice("landing", ("free", "conditional"), "whether a condition that always holds is asked for", default="free")

m1 = model.parameter("m1", "kg", 1.0, "lower mass", above=0)
m2 = model.parameter("m2", "kg", 3.0, "upper mass", above=0)
k = model.parameter("k", "N/m", 1000.0, "stiffness", minimum=0)
c = model.parameter("c", "N s/m", 0.0, "damping", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

h = model.coordinate("h", "m", "height of the lower mass", minimum=0)
r = model.coordinate("r", "m", "elongation, or height of the upper mass")

model.gravity(g)
upper = h + r if place == "elongation" else r
elongation = r if place == "elongation" else r - h
rate = r.rate if place == "elongation" else r.rate - h.rate
model.point_mass(m1, position=(0, h))
model.point_mass(m2, position=(0, upper))
model.potential(k * elongation**2 / 2)
model.dissipation(c * rate**2 / 2)

flies = model.mode("flies", "in the air")
stands = model.mode("stands", "on the ground", freeze=[(h, 0)])

# The upper mass keeps its speed.
keeps = [(r.rate, r.rate + h.rate)] if place == "elongation" else []
model.transition(
    "landing", flies, stands, when=falls(h), impact=True, reset=[(h, 0), (h.rate, 0)] + keeps,
    **({"provided": [m1]} if landing == "conditional" else {}))
model.transition("take_off", stands, flies, when=falls(stands.reaction(h)))
