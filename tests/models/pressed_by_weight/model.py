"""A mass on a floor with friction along a rail, whose normal force is its apparent weight: it depends on an acceleration."""

from codegen.model import *

model = Model("Friction under an apparent weight", source="closed form: it slips where the force has come to μ m g")
m = model.parameter("m", "kg", 2.0, "mass", above=0)
mu = model.parameter("mu", "1", 0.3, "friction coefficient", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
x = model.coordinate("x", "m", "along the rail")
y = model.coordinate("y", "m", "height")
force = model.input("force", "N", "force along the rail")
model.gravity(g)
model.point_mass(m, position=(x, y))
model.force(x, force)
model.contact("floor", gap=y)
model.friction("rail", slip=x, normal=m * (g + y.acceleration), kinetic=mu)
model.multipliers()
