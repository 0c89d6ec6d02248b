"""Two point masses on massless rods, swinging in a plane; see README.md."""

from codegen.model import *

model = Model("Double pendulum", source="e.g. Landau, L. D. and Lifshitz, E. M. (1976), Mechanics, 3rd ed., section 5, problem 1")

m_1 = model.parameter("m_1", "kg", 1.0, "upper mass", above=0)
m_2 = model.parameter("m_2", "kg", 1.0, "lower mass", above=0)
l_1 = model.parameter("l_1", "m", 1.0, "length of the upper rod", above=0)
l_2 = model.parameter("l_2", "m", 1.0, "length of the lower rod", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

theta_1 = model.coordinate("theta_1", "rad", "angle of the upper rod, from hanging down, counter-clockwise")
theta_2 = model.coordinate("theta_2", "rad", "angle of the lower rod, from hanging down, counter-clockwise")

upper = (l_1 * sin(theta_1), -l_1 * cos(theta_1))
lower = (upper[0] + l_2 * sin(theta_2), upper[1] - l_2 * cos(theta_2))
model.gravity(g)
model.point_mass(m_1, position=upper)
model.point_mass(m_2, position=lower)

model.mode("swings", "both rods swing")

model.output("lower_x", "m", lower[0], "place of the lower mass, to the right of the pivot")
model.output("lower_y", "m", lower[1], "height of the lower mass above the pivot")

model.draw("ceiling", [(0.25 * l_1, 0), (-0.25 * l_1, 0)], kind="fixed")
model.draw("upper rod", [(0, 0), upper], kind="line")
model.draw("lower rod", [upper, lower], kind="line")
model.draw("upper mass", [upper], kind="point")
model.draw("lower mass", [lower], kind="point")
