"""A block on a rough slope, which sticks and slips: see README.md."""

from codegen.model import *

model = Model("Block on a slope", source="Coulomb, C. A. (1785), Theorie des machines simples")

# Constants of a run: name, unit, default, meaning. A scene may give other values within the limits.
m = model.parameter("m", "kg", 1.0, "mass", above=0)
beta = model.parameter("beta", "rad", 0.3, "inclination of the slope", minimum=0, maximum=1.5)
mu_s = model.parameter("mu_s", "1", 0.4, "static friction coefficient", minimum=0)
mu_k = model.parameter("mu_k", "1", 0.3, "kinetic friction coefficient", minimum=0, at_most=mu_s)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

# What moves, and what is held: the force that holds y is the normal force.
x = model.coordinate("x", "m", "position along the slope, upwards")
y = model.coordinate("y", "m", "distance from the slope; its reaction is the normal force")
slip = model.discrete("slip", (+1, -1), "direction of slip")
force = model.input("force", "N", "force on the block, up the slope")

model.gravity(g)
model.point_mass(m, position=(x * cos(beta) - y * sin(beta), x * sin(beta) + y * cos(beta)))
model.force(x, force)

# Two modes. Each has equations of its own, for the coordinates that are free in it.
slides = model.mode("slides", "slips on the slope", freeze=[(y, 0)])
sticks = model.mode("sticks", "held by friction", freeze=[x, (y, 0)])
slides.friction(x, normal=slides.reaction(y), coefficient=mu_k, direction=slip)

# It begins to slip where friction cannot hold it: a guard for each direction, because a modulus is not smooth.
limit = mu_s * sticks.reaction(y)
margins = {+1: limit + sticks.reaction(x), -1: limit - sticks.reaction(x)}
for direction, margin in margins.items():
    model.transition("slip", sticks, slides, when=falls(margin), reset=[(slip, direction)])

# Where its velocity vanishes it sticks, if friction can hold it; else it turns back.
stops = falls(slip * x.rate)
model.transition("stick", slides, sticks, when=stops, provided=list(margins.values()))
model.transition("reversal", slides, slides, when=stops, reset=[(slip, -slip), (x.rate, 0)])

for mode in (slides, sticks):
    model.requires(mode, mode.reaction(y), "the block would leave the slope")


# The side of the block, which is as good as a point for the equations.
side = model.parameter("side", "m", 0.2, "length of the block, drawn only", above=0)


def place(along, up):
    """A point of the drawing, from the middle of the block's base."""
    return ((x + along) * cos(beta) - (y + up) * sin(beta), (x + along) * sin(beta) + (y + up) * cos(beta))


# What pages show: `dalembert run scene.json --html page.html`.
model.draw("slope", [(-10 * side * cos(beta), -10 * side * sin(beta)), (10 * side * cos(beta), 10 * side * sin(beta))], kind="fixed")
model.draw("block", [place(*p) for p in ((-side / 2, 0), (side / 2, 0), (side / 2, side / 2), (-side / 2, side / 2))])
