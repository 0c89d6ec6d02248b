"""A ball that is thrown on a table which moves up and down, and whose top runs along: both work at each impact."""

from codegen.model import *

model = Model("A ball thrown on a belt", source="test model: tests/engine/moving_walls.rs")

form = model.choice("form", ["reduced", "multipliers"], "how the contact is held")

m = model.parameter("m", "kg", 2.0, "mass", above=0)
mu = model.parameter("mu", "1", 0.2, "friction coefficient", minimum=0)
e = model.parameter("e", "1", 0.6, "restitution", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
runs = model.parameter("runs", "m/s", 0.7, "speed of the belt")

x = model.coordinate("x", "m", "place")
y = model.coordinate("y", "m", "height")
table = model.motion("table", "where the table is", input="a")

model.gravity(g)
model.point_mass(m, position=(x, y))
model.contact("top", gap=y - table, slip=x.rate - runs, static=mu, kinetic=mu, restitution=e)
if form == "multipliers":
    model.multipliers()
