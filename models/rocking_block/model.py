"""Housner's rocking block: a rigid block on a rigid ground that rocks about its bottom edges.

It never slips and never leaves the ground; see README.md for the sketch and the signs.
"""

from codegen.model import *

model = Model("Rocking rigid block", source="Housner, G. W. (1963), Bull. Seismol. Soc. Am. 53(2), 403-417")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
R = model.parameter("R", "m", 1.0, "half diagonal", above=0)
alpha = model.parameter("alpha", "rad", 0.25, "angle between half diagonal and side", above=0, maximum=1.5707963267948966)
e = model.parameter("e", "1", 0.9, "restitution of the uplift rate", minimum=0, maximum=1)
inertia = model.parameter("shape", "1", 1 / 3, "moment of inertia about the centre, in m R^2 (1/3: homogeneous)", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

theta = model.coordinate("theta", "rad", "uplift about the pivot edge", scale=0.1, rate_scale=0.1)
x = model.coordinate("x", "m", "place of the pivot edge, to the right of where it stands")
y = model.coordinate("y", "m", "height of the pivot edge")
side = model.discrete("side", (+1, -1), "pivot: +1 the left edge, -1 the right edge")
model.ground("z_h", "motion of the ground to the right", input="ground_acceleration")

model.gravity(g)
model.rigid_body(
    mass=m,
    inertia=inertia * m * R**2,
    position=(x + side * R * sin(alpha - theta), y + R * cos(alpha - theta)),
    angle=side * theta,
)

model.contact("base", gap=theta, restitution=e, sides=side)
model.constraint("edge", (x, y))
model.requires(None, model.reaction(y), "the block would leave the ground")

# The pivot edge is where the block stands on it: half a width to the left or right of the centre.
half_width = R * sin(alpha)


def place(along, up):
    """A point of the block, from the pivot edge along its base and up its side."""
    return (x + side * (along * cos(theta) - up * sin(theta) - half_width), y + along * sin(theta) + up * cos(theta))


model.output("rotation", "rad", side * theta, "rotation of the block, counter-clockwise: it leans to the left")
model.output("centre_x", "m", x + side * R * (sin(alpha - theta) - sin(alpha)), "displacement of the centre to the right")
model.output("centre_y", "m", y + R * (cos(alpha - theta) - cos(alpha)), "rise of the centre")
model.output("left_edge", "m", y + (1 - side) * half_width * sin(theta), "height of the left bottom edge")
model.output("right_edge", "m", y + (1 + side) * half_width * sin(theta), "height of the right bottom edge")
model.output("shear_ratio", "1", model.reaction(x) / (m * g), "force of the ground to the right, over the weight")

model.draw("ground", [(-2 * R, 0), (2 * R, 0)], kind="fixed")
model.draw("block", [place(*p) for p in (
    (0, 0), (2 * half_width, 0), (2 * half_width, 2 * R * cos(alpha)), (0, 2 * R * cos(alpha)))])
model.draw("centre", [place(half_width, R * cos(alpha))], kind="point")
model.draw("pivot", [place(0, 0)], kind="contact", of="edge")
model.draw("other edge", [place(2 * half_width, 0)], kind="contact", of="base", along=[])

model.limit("past_balance", "the centre is beyond the pivot edge: at rest the block would fall, shaken it may come back",
            when=theta > alpha, ends=False)
model.limit("overturned", "the side of the block reaches the ground", when=theta > pi / 2)
