"""A box that is thrown on rough ground: it bounces, slides, rocks and rests; see README.md."""

from codegen.model import *

model = Model("Box on rough ground", source="Moreau, J. J. (1988), Unilateral contact and dry friction in finite freedom dynamics")

# Constants of a run: name, unit, default, meaning. A scene may give other values within the limits.
b = model.parameter("b", "m", 0.15, "half of the width", above=0)
h = model.parameter("h", "m", 0.1, "half of the height", above=0)
m = model.parameter("m", "kg", 2.0, "mass", above=0)
mu = model.parameter("mu", "1", 0.4, "friction coefficient", minimum=0)
e = model.parameter("e", "1", 0.3, "restitution of a corner", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

# What moves.
x = model.coordinate("x", "m", "centre, to the right")
y = model.coordinate("y", "m", "centre, height above the ground")
phi = model.coordinate("phi", "rad", "tilt, counter-clockwise")

model.gravity(g)
model.rigid_body(m, inertia=m * (b**2 + h**2) / 3, position=(x, y), angle=phi)


def point(across, up):
    """A point of the box, from its centre."""
    return x + across * cos(phi) - up * sin(phi), y + across * sin(phi) + up * cos(phi)


# All that can touch: a gap that is never negative, and a slip that friction acts against. Which of them are open, stick or
# slide, what leads from one to the other, and what an impact does follows from the laws of contact.
for name, corner in (("left", (-b, -h)), ("right", (b, -h))):
    place, height = point(*corner)
    model.contact(name, gap=height, slip=place, kinetic=mu, restitution=e)

model.limit("overturned", "a side of the box reaches the ground, whose corners are not in the model", when=phi**2 > (pi / 2) ** 2)

# What pages show: `dalembert run scene.json --html page.html`.
model.draw("ground", [(-4 * b, 0), (6 * b, 0)], kind="fixed")
model.draw("box", [point(-b, -h), point(b, -h), point(b, h), point(-b, h)])
for name, corner in (("left", (-b, -h)), ("right", (b, -h))):
    model.draw(name, [point(*corner)], kind="contact", of=name)
