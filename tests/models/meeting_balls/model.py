"""Three equal balls on a line; balls that collide are put halfway between them."""

from codegen.model import *

model = Model("Meeting balls", source="test model: contacts that close at the same instant")

m = model.parameter("m", "kg", 1.0, "mass of each ball", above=0)
e = model.parameter("e", "1", 0.5, "restitution", minimum=0, maximum=1)

p = model.coordinate("p", "m", "place of the left ball")
q = model.coordinate("q", "m", "place of the middle ball")
r = model.coordinate("r", "m", "place of the right ball")
for place in (p, q, r):
    model.point_mass(m, position=(place, 0))

fly = model.mode("fly", "in free motion")
for name, a, b in (("left", p, q), ("right", q, r)):
    mean, half = (a.rate + b.rate) / 2, e * (a.rate - b.rate) / 2
    model.transition(
        name, fly, fly, when=falls(b - a), impact=True,
        reset=[(a, (a + b) / 2), (b, (a + b) / 2), (a.rate, mean - half), (b.rate, mean + half)])
