"""A wheel on a rail that may slip, and turns another by a belt without slip: lines that are no coordinates, in both forms."""

from codegen.model import *

model = Model("Wheel on a rail", source="test model: tests/engine/lines.rs")

form = model.choice("form", ["reduced", "multipliers"], "how friction and the belt between the wheels are held")

m = model.parameter("m", "kg", 2.0, "mass of the wheel", above=0)
r = model.parameter("r", "m", 0.3, "its radius", above=0)
J = model.parameter("J", "kg m^2", 0.09, "its inertia", above=0)
j = model.parameter("j", "kg m^2", 0.02, "inertia of the other wheel", above=0)
ratio = model.parameter("ratio", "1", 2.5, "turns of the other wheel for one of this", above=0)
k = model.parameter("k", "N/m", 8.0, "stiffness of a spring at the hub", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", above=0)
mu_s = model.parameter("mu_s", "1", 0.3, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.25, "kinetic friction coefficient", minimum=0, at_most=mu_s)
moment = model.input("moment", "N m", "moment on the wheel, along its angle")

x = model.coordinate("x", "m", "place of the hub, where the spring is at rest at 0")
phi = model.coordinate("phi", "rad", "angle of the wheel; it rolls along x")
psi = model.coordinate("psi", "rad", "angle of the other wheel")

model.kinetic(m * x.rate**2 / 2 + J * phi.rate**2 / 2 + j * psi.rate**2 / 2)
model.potential(k * x**2 / 2)
model.force(phi, moment)
model.friction("rail", slip=x - r * phi, normal=m * g, static=mu_s, kinetic=mu_k)
model.constraint("belt", psi - ratio * phi, switch=True)
if form == "multipliers":
    model.multipliers()
