"""A mass on a spring that a pawl lets move one way alone, on ground that may shake."""

from codegen.model import *

model = Model("Mass with a pawl", source="test model: a one-sided constraint on a rate")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness", minimum=0)
feed = model.parameter("feed", "m/s", 0.0, "least speed that the pawl allows")

x = model.coordinate("x", "m", "place of the mass on the ground")
z = model.ground("z", "motion of the ground", input="shaking", axis="x")
model.point_mass(m, position=(x, 0))
model.potential(k * x**2 / 2)

model.ratchet("pawl", rate=x.rate - feed)
