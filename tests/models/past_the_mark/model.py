"""A block whose place is its distance from a mark, on one side of it or the other: a chart beside a contact."""

from codegen.model import *

model = Model("Block that passes a mark", source="test model: other coordinates of the same state")

m = model.parameter("m", "kg", 2.0, "mass", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
mu = model.parameter("mu", "1", 0.2, "friction", minimum=0)
e = model.parameter("e", "1", 0.5, "restitution", minimum=0, maximum=1)
rise = model.parameter("rise", "m", 0.0, "by how much the chart is wrong about the height")
kick = model.parameter("kick", "m/s", 0.0, "by how much it is wrong about the rate of the distance")

x = model.coordinate("x", "m", "distance from the mark", minimum=0)
y = model.coordinate("y", "m", "height")
side = model.discrete("side", (+1, -1), "side of the mark: +1 to the right")
model.gravity(g)
model.point_mass(m, position=(side * x, y))
model.contact("floor", gap=y, slip=side * x, kinetic=mu, restitution=e)
model.chart("mark", when=falls(x), reset=[(side, -side), (x, -x), (x.rate, kick - x.rate), (y, y + rise)])
