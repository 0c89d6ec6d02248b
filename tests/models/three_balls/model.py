"""Three equal point masses on a line: two contacts that can close at the same instant."""

from codegen.model import *

model = Model("Three balls on a line", source="test model: simultaneous impacts, one after the other")

m = model.parameter("m", "kg", 1.0, "mass of each ball", above=0)
e = model.parameter("e", "1", 1.0, "restitution", minimum=0, maximum=1)

left = model.coordinate("left", "m", "place of the left ball")
middle = model.coordinate("middle", "m", "place of the middle ball")
right = model.coordinate("right", "m", "place of the right ball")
for place in (left, middle, right):
    model.point_mass(m, position=(place, 0))

fly = model.mode("fly", "in free motion")
for outer, gap in ((left, middle - left), (right, right - middle)):
    total, slower = (outer.rate + middle.rate) / 2, e * (outer.rate - middle.rate) / 2
    model.transition(
        f"{outer.name()}_contact", fly, fly, when=falls(gap), impact=True,
        reset=[(outer, middle), (outer.rate, total - slower), (middle.rate, total + slower)])
