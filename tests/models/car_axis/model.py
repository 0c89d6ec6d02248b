"""The axis of a car on a bumpy road, with its two constraints, as a problem of index 3."""

from codegen.model import *

model = Model(
    "Car axis",
    source="Schneider, S. (1994), Intégration de systèmes d'équations différentielles raides et différentielles-algébriques, thesis, Geneva; "
    "Mazzia, F. and Magherini, C. (2008), Test set for IVP solvers, problem CARAXIS")

m = model.parameter("m", "kg", 5e-4, "mass of a wheel: M eps^2 / 2 with M = 10, eps = 0.01", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness of a suspension", above=0)
l_0 = model.parameter("l_0", "m", 0.5, "its length without a force", above=0)
l = model.parameter("l", "m", 1.0, "length of the axis", above=0)
r = model.parameter("r", "m", 0.1, "height of the bumps", minimum=0)
omega = model.parameter("omega", "rad/s", 10.0, "how often the right wheel meets one", above=0)
g = model.parameter("g", "m/s^2", 1.0, "gravity", minimum=0)
J = model.parameter("J", "kg m^2", 1.0, "inertia of the drive, whose rate is given", above=0)

x_l = model.coordinate("x_l", "m", "left end of the axis, to the right")
y_l = model.coordinate("y_l", "m", "left end of the axis, upwards")
x_r = model.coordinate("x_r", "m", "right end of the axis, to the right")
y_r = model.coordinate("y_r", "m", "right end of the axis, upwards")
phase = model.coordinate("phase", "rad", "phase of the bumps")

model.gravity(g)
model.point_mass(m, (x_l, y_l))
model.point_mass(m, (x_r, y_r))
model.kinetic(J * phase.rate**2 / 2)

y_b = r * sin(phase)
x_b = sqrt(l**2 - y_b**2)
model.potential(k * (sqrt(x_l**2 + y_l**2) - l_0) ** 2 / 2)
model.potential(k * (sqrt((x_r - x_b) ** 2 + (y_r - y_b) ** 2) - l_0) ** 2 / 2)

model.constraint("drive", phase.rate - omega)
model.constraint("upright", x_l * x_b + y_l * y_b)
model.constraint("length", (x_l - x_r) ** 2 + (y_l - y_r) ** 2 - l**2)
