"""A wheel that is thrown on rough ground, with a part that slides along it without friction: its inertia couples it to the slip."""

from codegen.model import *

model = Model("Thrown wheel", source="test model: tests/engine/lines.rs")

form = model.choice("form", ["reduced", "multipliers"], "how the contact is held")

m = model.parameter("m", "kg", 2.0, "mass of the wheel", above=0)
r = model.parameter("r", "m", 0.3, "its radius", above=0)
J = model.parameter("J", "kg m^2", 0.09, "its inertia", above=0)
n = model.parameter("n", "kg", 1.0, "mass of the part", above=0)
k = model.parameter("k", "N/m", 5.0, "stiffness of a spring at the hub", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", above=0)
mu_s = model.parameter("mu_s", "1", 0.3, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.25, "kinetic friction coefficient", minimum=0, at_most=mu_s)
e = model.parameter("e", "1", 0.5, "restitution", minimum=0, maximum=1)
moment = model.input("moment", "N m", "moment on the wheel, along its angle")

x = model.coordinate("x", "m", "place of the hub, where the spring is at rest at 0")
y = model.coordinate("y", "m", "height of the wheel over the ground")
phi = model.coordinate("phi", "rad", "angle of the wheel; it rolls along x")
z = model.coordinate("z", "m", "place of the part on the hub, along x")

model.kinetic(m * (x.rate**2 + y.rate**2) / 2 + J * phi.rate**2 / 2 + n * (x.rate + z.rate)**2 / 2)
model.potential(m * g * y + k * x**2 / 2)
model.force(phi, moment)
model.contact("ground", gap=y, slip=x - r * phi, static=mu_s, kinetic=mu_k, restitution=e)
if form == "multipliers":
    model.multipliers()
