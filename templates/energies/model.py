"""A pendulum, stated by its energies: see README.md."""

from codegen.model import *

model = Model("Pendulum", source="Huygens, C. (1673), Horologium oscillatorium")

# Constants of a run: name, unit, default, meaning. A scene may give other values within the limits.
m = model.parameter("m", "kg", 1.0, "mass of the bob", above=0)
l = model.parameter("l", "m", 1.0, "length of the rod, which has no mass", above=0)
c = model.parameter("c", "N m s", 0.0, "viscous damping in the hinge", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

# What moves. Its velocity is theta.rate.
theta = model.coordinate("theta", "rad", "angle from hanging, counter-clockwise")

# The equations of motion follow from these.
model.kinetic(m * (l * theta.rate)**2 / 2)
model.potential(m * g * l * (1 - cos(theta)))
model.dissipation(c * theta.rate**2 / 2)

# One mode, in which every coordinate is free.
model.mode("swings", "about the hinge")

# What pages show: `dalembert run scene.json --html page.html`.
model.draw("hinge", [(0, 0)], kind="contact")
model.draw("rod", [(0, 0), (l * sin(theta), -l * cos(theta))], kind="line")
model.draw("bob", [(l * sin(theta), -l * cos(theta))], kind="point")
