"""A ball on a table that vibrates vertically: bouncing, chattering, sticking; see README.md."""

from codegen.model import *

model = Model("Ball on a vibrating table", source="Holmes, P. J. (1982), J. Sound Vib. 84(2), 173-189; Luck, J. M. and Mehta, A. (1993), Phys. Rev. E 48, 3988")

m = model.parameter("m", "kg", 1.0, "mass of the ball", above=0)
e = model.parameter("e", "1", 0.5, "restitution of the relative velocity", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

gap = model.coordinate("gap", "m", "height of the ball above the table")
z = model.ground("z", "motion of the table, upwards", input="table_acceleration", axis="y")

model.gravity(g)
model.point_mass(m, position=(0, gap))

model.contact("table", gap=gap, restitution=e)
model.output("height", "m", z + gap, "height of the ball above where the table began")

model.draw("plate", [(-1, 0), (1, 0)], kind="fixed")
model.draw("ball", [(0, gap)], kind="point")
model.draw("table", [(0, gap)], kind="contact")
