"""A ball over a table that shakes: the gap is no coordinate, and no equation of the flight knows of the table."""

from codegen.model import *

model = Model("Ball over a table", source="test model: tests/engine/driven.rs")

form = model.choice("form", ["reduced", "multipliers"], "how the contact is held")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
e = model.parameter("e", "1", 0.6, "restitution", minimum=0)

y = model.coordinate("y", "m", "height")
load = model.input("load", "N", "load on what stands beside it")
wind = model.input("wind", "N", "wind on it, of which nothing but an output knows")
most = model.parameter("most", "N", 1.0, "load that it bears", above=0)
table = model.motion("table", "where the table is", input="a")

model.gravity(g)
model.point_mass(m, position=(0 * y, y))
model.contact("table", gap=y - table, restitution=e)
model.limit("overload", "what stands beside it gives way", when=load > most)
model.output("twice", "N", 2 * wind, "twice the wind")
if form == "multipliers":
    model.multipliers()
