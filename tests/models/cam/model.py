"""A follower on an eccentric cam, which it leaves when the cam turns fast; another, that is far away, falls."""

import casadi as ca

from codegen.model import *

model = Model("Cam and follower", source="test model: tests/engine/driven.rs")

form = model.choice("form", ["reduced", "multipliers", "tied", "none"], "how the contact is held; or the follower is tied to the cam, or there is none")

m = model.parameter("m", "kg", 0.5, "mass of each follower", above=0)
c = model.parameter("c", "m", 0.01, "eccentricity", minimum=0)
k = model.parameter("k", "N/m", 2000.0, "stiffness of the spring on the first", minimum=0)
l = model.parameter("l", "m", 0.02, "what it is shortened by where the follower is at zero", minimum=0)
most = model.parameter("most", "m/s", 1e3, "speed of its edge that the cam bears", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

y = model.coordinate("y", "m", "height of the follower")
z = model.coordinate("z", "m", "height of the other")
phi = model.motion("phi", "angle of the cam", input="spin", unit="rad")

model.gravity(g)
model.point_mass(m, position=(0 * y, y))
model.point_mass(m, position=(0 * z, z))
model.potential(k * (y + l)**2 / 2)
if form == "tied":
    model.constraint("cam", y - c * sin(phi))
elif form != "none":
    model.contact("cam", gap=y - c * sin(phi))
model.contact("ground", gap=z)
model.limit("fast", "the cam is too fast", when=ca.fabs(c * cos(phi) * phi.rate) > most)
if form == "multipliers":
    model.multipliers()
