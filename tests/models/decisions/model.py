"""A mass that goes to and fro between two walls, and others whose rates it decides at each: what a reset can calculate."""

import casadi as ca

from codegen.model import *

model = Model("Decisions at an impact", source="constructed")

m = model.parameter("m", "kg", 1.0, "mass of each", above=0)
u = model.parameter("u", "m/s", 1.0, "a velocity", above=0)
d = model.parameter("d", "m", 1.0, "distance of the walls", above=0)

x = model.coordinate("x", "m", "place between the walls")
v = x.rate
DECISIONS = {
    "less": v < 0,
    "not_more": v <= -u,
    "equal": v == u,
    "unequal": v != u,
    "not": ca.logic_not(v < 0),
    "both": ca.logic_and(v < 0, x < d / 2),
    "either": ca.logic_or(v < 0, x > 2 * d),
    "choice": ca.if_else(v < 0, 3, 5),
    "sign": ca.sign(v),
    "copied_sign": ca.copysign(7, v),
    "least": ca.fmin(v, u / 2) / u,
    "greatest": ca.fmax(v, -u / 2) / u,
}
model.point_mass(m, position=(x, 0))
resets = []
for name, decision in DECISIONS.items():
    q = model.coordinate(f"{name}_q", "m", "moves as was decided")
    model.point_mass(m, position=(q, 0))
    resets.append((q.rate, u * decision))

moves = model.mode("moves")
model.transition("left", moves, moves, when=falls(x), impact=True, reset=[(x, 0), (v, -v), *resets])
model.transition("right", moves, moves, when=falls(d - x), impact=True, reset=[(x, d), (v, -v), *resets])
