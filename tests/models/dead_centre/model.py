"""A crank that moves a yoke, which rubs on its guide: at its dead centres the slip vanishes however fast the crank turns."""

from codegen.model import *

model = Model("A yoke at its dead centres", source="closed form: the energy that friction takes along the way of the yoke")
r = model.parameter("r", "m", 0.1, "crank", above=0)
J = model.parameter("J", "kg m^2", 0.1, "moment of inertia of the crank", above=0)
N = model.parameter("N", "N", 1.0, "force on the yoke", above=0)
phi = model.coordinate("phi", "rad", "angle of the crank")
model.kinetic(J * phi.rate**2 / 2)
model.friction("guide", slip=r * cos(phi), normal=N, static=1.2, kinetic=1)
