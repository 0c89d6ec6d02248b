"""Eight slabs on each other on a table that shakes, each with friction below it."""

from codegen.model import *

model = Model("Stack of slabs", source="Coulomb's law, set-valued (Moreau 1988)")

SLABS = 8
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
model.ground("z", "table", input="a_g")
masses = [model.parameter(f"m_{k}", "kg", 1.0, "mass", above=0) for k in range(1, SLABS + 1)]
below = 0
for k, m in enumerate(masses, 1):
    mu = model.parameter(f"mu_{k}", "1", 0.3, "friction below it", minimum=0)
    x = model.coordinate(f"x_{k}", "m", "place, relative to the table")
    model.point_mass(m, position=(x, 0))
    model.friction(f"below_{k}", slip=x - below, normal=sum(masses[k - 1:]) * g, kinetic=mu)
    below = x
