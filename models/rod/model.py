"""A uniform rod whose end slides on rough ground: Painlevé's paradox; see README.md."""

from codegen.model import *

model = Model("Rod on rough ground", source="Painlevé, P. (1895), C. R. Acad. Sci. Paris 121, 112-115; Génot, F. and Brogliato, B. (1999), Eur. J. Mech. A 18(4), 653-677")

l = model.parameter("l", "m", 1.0, "half of the length", above=0)
m = model.parameter("m", "kg", 1.0, "mass", above=0)
mu = model.parameter("mu", "1", 0.5, "friction coefficient", minimum=0)
e = model.parameter("e", "1", 0.0, "restitution of the ends", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "centre, to the right")
y = model.coordinate("y", "m", "centre, height over the ground")
theta = model.coordinate("theta", "rad", "angle of the rod over the ground, counter-clockwise")

model.gravity(g)
model.rigid_body(m, inertia=m * l**2 / 3, position=(x, y), angle=theta)

ends = {name: (x + side * l * cos(theta), y + side * l * sin(theta)) for name, side in (("lower", -1), ("upper", 1))}
for name, (place, height) in ends.items():
    model.contact(name, gap=height, slip=place, kinetic=mu, restitution=e)

model.draw("ground", [(-3 * l, 0), (3 * l, 0)], kind="fixed")
model.draw("rod", list(ends.values()), kind="line")
for name, end in ends.items():
    model.draw(name, [end], kind="contact", of=name)
