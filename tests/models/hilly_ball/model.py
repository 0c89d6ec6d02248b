"""A ball on hilly ground: a gap that is no coordinate, in both forms."""

from codegen.model import *

model = Model("Ball on hilly ground", source="test model: tests/engine/hills.rs")

form = model.choice("form", ["reduced", "multipliers"], "how the ground holds the ball")

m = model.parameter("m", "kg", 1.5, "mass", above=0)
h = model.parameter("h", "m", 0.2, "height of the hills", minimum=0)
w = model.parameter("w", "m", 1.0, "their width over 2π", above=0)
level = model.parameter("level", "m", 0.0, "their mean height")
e = model.parameter("e", "1", 0.6, "restitution", minimum=0, maximum=1)
c = model.parameter("c", "N s/m", 0.3, "drag along x", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", above=0)

x = model.coordinate("x", "m", "place")
y = model.coordinate("y", "m", "height")

model.point_mass(m, position=(x, y))
model.potential(m * g * y)
model.dissipation(c * x.rate**2 / 2)
model.contact("ground", gap=y - level - h * cos(x / w), restitution=e, switch=True)
if form == "multipliers":
    model.multipliers()
