"""A pendulum with dry friction in its pin, whose torque is the coefficient times the radius times the whole force of the pin."""

from codegen.model import *

model = Model(
    "Pendulum with friction in its pin",
    source="test model: tests/data/14c_pendulum_pin_friction.json")

m = model.parameter("m", "kg", 1.0, "mass at the end", above=0)
L = model.parameter("L", "m", 1.0, "length of the massless rod", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
mu = model.parameter("mu", "1", 0.1, "friction coefficient", minimum=0)
r = model.parameter("r", "m", 1.0, "radius of the pin", above=0)

phi = model.coordinate("phi", "rad", "angle from the downward vertical")
model.gravity(g)
model.point_mass(m, (L * sin(phi), -L * cos(phi)))

# Across the rod the pin carries the friction torque over L, along it the tension: the friction is mu r times the root of both squared.
tension = m * (L * phi.rate**2 + g * cos(phi))
model.friction("pin", slip=phi, normal=r * tension / sqrt(1 - (mu * r / L) ** 2), kinetic=mu)
