"""A ladder on rough ground at a rough wall: four forces, of which three equations determine what they come to together."""

from codegen.model import *

model = Model("Ladder", source="test model: friction that is not determined while it holds; any textbook of statics")

l = model.parameter("l", "m", 2.0, "half of the length", above=0)
m = model.parameter("m", "kg", 10.0, "mass", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
mu_foot = model.parameter("mu_foot", "1", 0.4, "friction at the ground", minimum=0)
mu_top = model.parameter("mu_top", "1", 0.3, "friction at the wall", minimum=0)

x = model.coordinate("x", "m", "centre, off the wall")
y = model.coordinate("y", "m", "centre, height over the ground")
theta = model.coordinate("theta", "rad", "angle over the ground, clockwise")

model.ground("x_g", "ground and wall, away from the wall", input="a")
model.gravity(g)
model.rigid_body(m, inertia=m * l**2 / 3, position=(x, y), angle=-theta)
model.contact("foot", gap=y - l * sin(theta), slip=x + l * cos(theta), kinetic=mu_foot)
model.contact("top", gap=x - l * cos(theta), slip=y + l * sin(theta), kinetic=mu_top)
