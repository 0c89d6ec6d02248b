"""A rod on a cart that a force pushes along rails: see README.md of the crate."""

from codegen.model import *

model = Model("Rod on a cart", source="any textbook of control")

M = model.parameter("M", "kg", 2.0, "mass of the cart", above=0)
m = model.parameter("m", "kg", 1.0, "mass of the rod, which is slender and homogeneous", above=0)
l = model.parameter("l", "m", 1.0, "length of the rod", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "place of the cart, to the right")
phi = model.coordinate("phi", "rad", "angle of the rod from upright, clockwise")
force = model.input("force", "N", "force on the cart, to the right")

model.gravity(g)
model.point_mass(M, position=(x, 0))
model.rigid_body(m, m * l**2 / 12, position=(x + l / 2 * sin(phi), l / 2 * cos(phi)), angle=-phi)
model.force(x, force)

model.mode("rolls", "on its rails")
