"""The mass of `belt_oscillator`, its friction held by multipliers."""

from codegen.model import *

model = Model("Stick-slip oscillator on a moving belt, by multipliers", source="Den Hartog, J. P. (1956), Mechanical Vibrations, 4th ed., section 7.6")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness of the spring", minimum=0)
belt = model.parameter("belt", "m/s", 0.1, "velocity of the belt")
mu_s = model.parameter("mu_s", "1", 0.4, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.25, "kinetic friction coefficient", minimum=0, at_most=mu_s)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
x = model.coordinate("x", "m", "elongation of the spring, in the direction of the belt")
force = model.input("force", "N", "force on the mass, in the direction of the belt")
model.gravity(g)
model.point_mass(m, position=(x, 0))
model.potential(k * x**2 / 2)
model.force(x, force)
model.friction("belt", slip=x.rate - belt, normal=m * g, static=mu_s, kinetic=mu_k)
model.multipliers()
