"""A mass on a spring between a wall and one that steps to and fro: every event leads to the same mode."""

from codegen.model import *

model = Model("Shuttle between walls", source="test model: guards with offsets and factors that resets change")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 4.0, "stiffness of the spring", minimum=0)
L = model.parameter("L", "m", 1.0, "distance of the left wall from the middle, and step of the right one", above=0)
e = model.parameter("e", "1", 0.9, "restitution", minimum=0, maximum=1)

x = model.coordinate("x", "m", "place")
y = model.coordinate("y", "m", "height, held wherever it is")
wall = model.discrete("wall", (2, 1), "place of the right wall, in steps")
way = model.discrete("way", (+1, -1), "sign of the rate")
push = model.input("push", "N", "force to the right")

model.point_mass(m, position=(x, y))
model.potential(k * x**2 / 2)
model.force(x, push)

runs = model.mode("runs", "to and fro", freeze=[(y, HELD)])

# The right wall steps wherever the mass may be: beyond it, it is hit at once.
model.transition("turn", runs, runs, when=falls(way * x.rate), reset=[(way, -way), (wall, 3 - wall)])
model.transition(
    "left", runs, runs, when=falls(x + L), impact=True,
    reset=[(x, -L), (x.rate, -e * x.rate), (way, -way), (wall, 3 - wall)])
model.transition(
    "right", runs, runs, when=falls(wall * L - x), impact=True,
    reset=[(x, wall * L), (x.rate, -e * way * x.rate), (way, -1)])
