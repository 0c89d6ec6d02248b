"""A mass matrix given entry by entry: regular, nearly singular, singular, indefinite."""

from codegen.model import *

model = Model("Two coupled coordinates", source="test model: kinetic energies that are no norm")

m_x = model.parameter("m_x", "kg", 1.0, "entry of x")
m_xy = model.parameter("m_xy", "kg", 0.0, "entry that couples x and y")
m_y = model.parameter("m_y", "kg", 1.0, "entry of y")
f_x = model.parameter("f_x", "N", 1.0, "force on x")
f_y = model.parameter("f_y", "N", 1.0, "force on y")

x = model.coordinate("x", "m", "first coordinate")
y = model.coordinate("y", "m", "second coordinate")
model.kinetic(m_x * x.rate**2 / 2 + m_xy * x.rate * y.rate + m_y * y.rate**2 / 2)
model.force(x, f_x)
model.force(y, f_y)
model.mode("moves", "both coordinates move")
