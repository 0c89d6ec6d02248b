"""A capsule between a jaw and a finger that presses on it: nothing moves."""

from codegen.model import *

model = Model("Pinched capsule", source="MuJoCo, issue 3328: a capsule of 45 g that creeps out of a grip")

m = model.parameter("m", "kg", 0.045, "mass", above=0)
r = model.parameter("r", "m", 0.015, "radius", above=0)
finger = model.parameter("finger", "kg", 0.2, "mass of a finger", above=0)
press = model.parameter("press", "N", 12.0, "force of a finger", minimum=0)
mu = model.parameter("mu", "1", 0.7, "friction", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "centre, to the right")
y = model.coordinate("y", "m", "centre, upwards")
theta = model.coordinate("theta", "rad", "turn, counter-clockwise")
tip = model.coordinate("tip", "m", "tip of the finger, on the right")
lift = model.input("lift", "N", "further force on the capsule, upwards")
model.gravity(g)
model.rigid_body(m, inertia=m * r**2 / 2, position=(x, y), angle=theta)
model.kinetic(finger * tip.rate**2 / 2)
model.force(tip, -press)
model.force(y, lift)
model.contact("jaw", gap=x - r, slip=y - r * theta, kinetic=mu)
model.contact("finger_tip", gap=tip - x - r, slip=y + r * theta, kinetic=mu)
