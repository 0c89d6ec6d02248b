"""The mass of `belt_oscillator` on a belt whose speed changes: a prescribed motion that is not of the ground."""

from codegen.model import *

model = Model("A mass on a spring and a belt of changing speed", source="models/belt_oscillator")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness of the spring", minimum=0)
mu_s = model.parameter("mu_s", "1", 0.4, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.25, "kinetic friction coefficient", minimum=0, at_most=mu_s)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
x = model.coordinate("x", "m", "elongation of the spring, in the direction of the belt")
belt = model.motion("belt", "place of the belt", input="belt_acceleration")
model.gravity(g)
model.point_mass(m, position=(x, 0))
model.potential(k * x**2 / 2)
model.friction("base", slip=x - belt, normal=m * g, static=mu_s, kinetic=mu_k)
