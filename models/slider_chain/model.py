"""Blocks on each other, or in a row, on a table that shakes; see README.md."""

from codegen.model import *

model = Model("Chain of sliding blocks", source="Den Hartog, J. P. (1931), Trans. ASME 53, 107-115, for one block; any textbook of mechanics")

BLOCKS = 3

arrangement = model.choice("arrangement", ["stack", "row"], "the blocks lie on each other, or in a row on the table")

m = model.parameter("m", "kg", 1.0, "mass of a block", above=0)
w = model.parameter("w", "m", 0.2, "width and height of a block, for drawings", above=0)
mu_s = model.parameter("mu_s", "1", 0.35, "static friction coefficient of the first block", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.3, "kinetic friction coefficient of the first block", minimum=0, at_most=mu_s)
grading = model.parameter("grading", "1", 0.9, "friction of a block over that of the block before", above=0, maximum=1)
e = model.parameter("e", "1", 0.5, "in a row, restitution between neighbours", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

model.ground("x_g", "table, to the right", input="a")
model.gravity(g)

place = 0
for k in range(BLOCKS):
    block = f"block_{k + 1}"
    where = "on the table" if k == 0 else f"on block {k} in a stack, clear of block {k} in a row"
    s = model.coordinate(f"s_{k + 1}", "m", f"block {k + 1}, to the right, {where}")
    if arrangement == "stack":
        place, height = place + s, (k + 0.5) * w
        slip, carried = s, BLOCKS - k
    else:
        place, height = place + s + (w if k else 0), 0.5 * w
        slip, carried = place, 1
        if k:
            model.contact(f"blocks_{k}_{k + 1}", gap=s, restitution=e)
            model.draw(f"between {k} and {k + 1}", [(place - w / 2, height)], kind="contact", of=f"blocks_{k}_{k + 1}", along=[(1, 0)])
    model.point_mass(m, position=(place, height))
    model.friction(block, slip=slip, normal=carried * m * g, static=grading**k * mu_s, kinetic=grading**k * mu_k)
    model.draw(f"block {k + 1}", [(place + x * w / 2, height + y * w / 2) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    model.draw(f"under block {k + 1}", [(place, height - w / 2)], kind="contact", of=block)
model.draw("table", [(-5 * w, 0), (5 * w, 0)], kind="fixed")
