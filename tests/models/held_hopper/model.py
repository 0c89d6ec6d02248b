"""The block of `contact_hopper`, its contact held by multipliers."""

from codegen.model import *

model = Model("Block on a shaking table, by multipliers", source="Moreau, J. J. (1988), Unilateral contact and dry friction in finite freedom dynamics, CISM 302, 1-82")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
mu_s = model.parameter("mu_s", "1", 0.5, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.4, "kinetic friction coefficient", minimum=0, at_most=mu_s)
e = model.parameter("e", "1", 0.3, "restitution", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)
x = model.coordinate("x", "m", "place on the table, to the right")
y = model.coordinate("y", "m", "height above the table")
model.ground("z_h", "motion of the table to the right", input="horizontal")
model.ground("z_v", "motion of the table upwards", input="vertical", axis="y")
model.gravity(g)
model.point_mass(m, position=(x, y))
model.contact("table", gap=y, slip=x, static=mu_s, kinetic=mu_k, restitution=e)
model.multipliers()
