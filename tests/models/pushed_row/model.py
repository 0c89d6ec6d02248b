"""Blocks in a row on a table that shakes, each with its own friction: those that would slide alone lean on others, or on a stop. The
last two are linked."""

from codegen.model import *

model = Model("Row of blocks that push each other", source="test model: friction that is not determined while it holds")

BLOCKS = 6

m = model.parameter("m", "kg", 1.0, "mass of a block", above=0)
g = model.parameter("g", "m/s^2", 10.0, "gravity", minimum=0)

stop = model.parameter("stop", "m", 1000.0, "distance of a stop without friction, to the left of the origin", minimum=0)

model.ground("x_g", "table, to the right", input="a")

place = 0
for k in range(1, BLOCKS + 1):
    mu = model.parameter(f"mu_{k}", "1", 0.3, f"static friction of block {k}", minimum=0)
    s = model.coordinate(f"s_{k}", "m", f"block {k}, to the right, clear of the block before")
    place = place + s
    if k == BLOCKS:
        model.constraint("link", s)
    elif k > 1:
        model.contact(f"gap_{k}", gap=s)
    else:
        model.contact("stop", gap=s + stop)
    model.point_mass(m, position=(place, 0))
    model.friction(f"block_{k}", slip=place, normal=m * g, static=mu, kinetic=0.9 * mu)
