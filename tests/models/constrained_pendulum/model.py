"""A pendulum in Cartesian coordinates, its length a constraint."""

from codegen.model import *

model = Model("Pendulum in Cartesian coordinates", source="IFToMM benchmark library, A01: simple pendulum (González, M. et al. 2006)")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
L = model.parameter("L", "m", 1.0, "length", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "to the right")
y = model.coordinate("y", "m", "upwards")
model.gravity(g)
model.point_mass(m, position=(x, y))
model.constraint("rod", sqrt(x**2 + y**2) - L)
