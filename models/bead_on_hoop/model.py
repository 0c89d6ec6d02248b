"""A bead on a hoop that turns about its vertical diameter; see README.md."""

from codegen.model import *

model = Model("Bead on a rotating hoop", source="Guckenheimer, J. and Holmes, P. (1983), Nonlinear Oscillations, Dynamical Systems, and Bifurcations of Vector Fields")

R = model.parameter("R", "m", 0.5, "radius of the hoop", above=0)
m = model.parameter("m", "kg", 0.2, "mass of the bead", above=0)
Omega = model.parameter("Omega", "rad/s", 6.0, "rate at which the hoop turns about its vertical diameter", minimum=0)
c = model.parameter("c", "kg/s", 0.0, "viscous resistance along the hoop", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "from the axis, in the plane of the hoop")
y = model.coordinate("y", "m", "height over the centre of the hoop")

model.gravity(g)
model.point_mass(m, position=(x, y))
model.potential(-m * Omega**2 * x**2 / 2)  # of the centrifugal force
model.dissipation(c * (x.rate**2 + y.rate**2) / 2)
model.constraint("hoop", sqrt(x**2 + y**2) - R)

model.output("angle", "rad", atan2(x, -y), "angle from the lowest point")
model.draw("axis", [(0, -1.2 * R), (0, 1.2 * R)], kind="line")
model.draw("hoop", [(R * cos(k * pi / 24), R * sin(k * pi / 24)) for k in range(49)], kind="line")
model.draw("bead", [(x, y)], kind="point", radius=0.02)
