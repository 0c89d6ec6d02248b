"""A mass that flies on: one transition has twelve conditions, its mode twelve requirements, and both count to the last."""

from codegen.model import *

model = Model("Mass with many conditions", source="test model: as many conditions and requirements as one likes")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
l = model.parameter("l", "m", 1.0, "where it may stop", above=0)
door = model.parameter("door", "1", 1.0, "whether it may stop there: not if negative")

x = model.coordinate("x", "m", "place")
model.point_mass(m, position=(x, 0))

moves = model.mode("moves", "flies on")
stands = model.mode("stands", "has stopped", freeze=[(x, l)])
model.transition("stop", moves, stands, when=falls(l - x), provided=[*(x + n * l for n in range(1, 12)), door])
for n in range(1, 13):
    model.requires(moves, (20 - n) * l - x, f"it is beyond the place {n}")
