"""A rod whose lower end slips on rough ground: Painlevé's example."""

from codegen.model import *

model = Model("Sliding rod", source="Génot, F. and Brogliato, B. (1999), Eur. J. Mech. A 18, 653-677")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
l = model.parameter("l", "m", 1.0, "half length", above=0)
mu = model.parameter("mu", "1", 0.5, "friction coefficient", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "place of the end on the ground")
y = model.coordinate("y", "m", "height of that end; its reaction is the normal force")
theta = model.coordinate("theta", "rad", "angle from the ground to the rod")
slip = model.discrete("slip", (-1, +1), "direction of slip")

model.gravity(g)
model.rigid_body(mass=m, inertia=m * l**2 / 3, position=(x + l * cos(theta), y + l * sin(theta)), angle=theta)

slides = model.mode("slides", "slips on the ground", freeze=[(y, 0)])
sticks = model.mode("sticks", "turns about the end at rest", freeze=[x, (y, 0)])
slides.friction(x, normal=slides.reaction(y), coefficient=mu, direction=slip)
model.transition("stick", slides, sticks, when=falls(slip * x.rate))
model.requires(slides, slides.reaction(y), "the rod leaves the ground")
