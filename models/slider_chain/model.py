"""Blocks that slide on each other on a table that shakes; see README.md."""

from codegen.model import *

model = Model("Stack of sliding blocks", source="Den Hartog, J. P. (1931), Trans. ASME 53, 107-115, for one block; any textbook of mechanics")

BLOCKS = 3

m = model.parameter("m", "kg", 1.0, "mass of a block", above=0)
w = model.parameter("w", "m", 0.2, "width and height of a block, for drawings", above=0)
mu_s = model.parameter("mu_s", "1", 0.35, "static friction coefficient on the table", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.3, "kinetic friction coefficient on the table", minimum=0, at_most=mu_s)
grading = model.parameter("grading", "1", 0.9, "friction of an interface over that beneath it", above=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

model.ground("x_g", "table, to the right", input="a")
model.gravity(g)

place = 0
for k in range(BLOCKS):
    s = model.coordinate(f"s_{k + 1}", "m", f"block {k + 1}, to the right, on what is beneath it")
    place = place + s
    height = (k + 0.5) * w
    model.point_mass(m, position=(place, height))
    model.friction(f"block_{k + 1}", slip=s, normal=(BLOCKS - k) * m * g, static=grading**k * mu_s, kinetic=grading**k * mu_k)
    model.draw(f"block {k + 1}", [(place + x * w / 2, height + y * w / 2) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    model.draw(f"under block {k + 1}", [(place, k * w)], kind="contact", of=f"block_{k + 1}")
model.draw("table", [(-5 * w, 0), (5 * w, 0)], kind="fixed")
