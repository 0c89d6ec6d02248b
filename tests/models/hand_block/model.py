"""Housner's rocking block, which rocks about its bottom edges; its modes written by hand."""

from codegen.model import *

model = Model("Rocking rigid block", source="Housner, G. W. (1963), Bull. Seismol. Soc. Am. 53(2), 403-417")

m = model.parameter("m", "kg", 1.0, "mass", above=0)
R = model.parameter("R", "m", 1.0, "half diagonal", above=0)
alpha = model.parameter("alpha", "rad", 0.25, "angle between half diagonal and side", above=0, maximum=1.5707963267948966)
e = model.parameter("e", "1", 0.9, "restitution of the uplift rate", minimum=0, maximum=1)
inertia = model.parameter("shape", "1", 1 / 3, "moment of inertia about the centre, in m R^2 (1/3: homogeneous)", minimum=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

theta = model.coordinate("theta", "rad", "uplift about the pivot edge", minimum=0, scale=0.1, rate_scale=0.1)
y = model.coordinate("y", "m", "height of the pivot edge")
side = model.discrete("side", (+1, -1), "pivot: +1 the left edge, -1 the right edge")
z_h = model.ground("z_h", "motion of the ground to the right", input="ground_acceleration")

model.gravity(g)
model.rigid_body(
    mass=m,
    inertia=inertia * m * R**2,
    position=(side * R * sin(alpha - theta), y + R * cos(alpha - theta)),
    angle=side * theta,
)

stands = model.mode("stands", "on its whole base", freeze=[(theta, 0), (y, 0)])
rocks = model.mode("rocks", "about one edge", freeze=[(y, 0)])

for edge in (+1, -1):
    model.transition("lift_off", stands, rocks, when=falls(stands.reaction(theta, side=edge)), reset=[(side, edge)])
model.transition(
    "landing", rocks, rocks, when=falls(theta), impact=True,
    reset=[(theta, 0), (side, -side), (theta.rate, -e * theta.rate)],
)
model.rest(rocks, stands)
for mode in (stands, rocks):
    model.requires(mode, mode.reaction(y), "the block would leave the ground")

model.limit("past_balance", "the centre is beyond the pivot edge: at rest the block would fall, shaken it may come back",
            when=theta > alpha, ends=False)
model.limit("overturned", "the side of the block reaches the ground", when=theta > pi / 2)
