"""A point mass on a massless rod that a moment drives; see README.md."""

from codegen.model import *

model = Model("Pendulum driven by a moment", source="e.g. Landau, L. D. and Lifshitz, E. M. (1976), Mechanics, 3rd ed., sections 5 and 22")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
l = model.parameter("l", "m", 1.0, "length of the rod", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

theta = model.coordinate("theta", "rad", "angle from hanging down, counter-clockwise")
moment = model.input("moment", "N m", "moment on the rod, counter-clockwise")

model.gravity(g)
model.point_mass(m, position=(l * sin(theta), -l * cos(theta)))
model.force(theta, moment)

model.mode("swings", "the rod swings")

model.draw("ceiling", [(0.25 * l, 0), (-0.25 * l, 0)], kind="fixed")
model.draw("rod", [(0, 0), (l * sin(theta), -l * cos(theta))], kind="line")
model.draw("mass", [(l * sin(theta), -l * cos(theta))], kind="point")
