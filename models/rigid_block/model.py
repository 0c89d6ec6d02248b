"""A rectangular block on rough ground that shakes horizontally and vertically; see README.md."""

from codegen.model import *

model = Model("Rigid block on rough ground", source="Shenton, H. W. (1996), J. Eng. Mech. 122(7), 690-693; Taniguchi, T. (2002), Earthquake Eng. Struct. Dyn. 31(3), 481-498")

b = model.parameter("b", "m", 0.2, "half of the width", above=0)
h = model.parameter("h", "m", 0.6, "half of the height", above=0)
m = model.parameter("m", "kg", 1.0, "mass", above=0)
mu_s = model.parameter("mu_s", "1", 0.5, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.5, "kinetic friction coefficient", minimum=0, at_most=mu_s)
e = model.parameter("e", "1", 0.0, "restitution of a corner", minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

x = model.coordinate("x", "m", "centre, to the right, relative to the ground")
y = model.coordinate("y", "m", "centre, height over the ground")
theta = model.coordinate("theta", "rad", "tilt, counter-clockwise")

model.ground("x_g", "ground, to the right", input="a_h", optional=True)
model.ground("y_g", "ground, upwards", input="a_v", axis="y", optional=True)
model.gravity(g)
model.rigid_body(m, inertia=m * (b**2 + h**2) / 3, position=(x, y), angle=theta)


def corner(across, up):
    """A point of the block, from its centre."""
    return x + across * cos(theta) - up * sin(theta), y + across * sin(theta) + up * cos(theta)


for name, across in (("left", -b), ("right", b)):
    place, height = corner(across, -h)
    model.contact(name, gap=height, slip=place, static=mu_s, kinetic=mu_k, restitution=e)

model.limit("overturned", "a side of the block reaches the ground", when=theta**2 > (pi / 2) ** 2)

model.draw("ground", [(-3 * b, 0), (3 * b, 0)], kind="fixed")
model.draw("block", [corner(-b, -h), corner(b, -h), corner(b, h), corner(-b, h)])
for name, across in (("left", -b), ("right", b)):
    model.draw(name, [corner(across, -h)], kind="contact", of=name)
