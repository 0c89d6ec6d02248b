"""A four-bar linkage of uniform bars in natural coordinates; see README.md."""

from codegen.model import *

model = Model("Four-bar linkage", source="García de Jalón, J. and Bayo, E. (1994), Kinematic and Dynamic Simulation of Multibody Systems, chapter 2")

crank = model.parameter("crank", "m", 0.4, "length of the crank, which turns about the origin", above=0)
coupler = model.parameter("coupler", "m", 1.0, "length of the coupler", above=0)
rocker = model.parameter("rocker", "m", 0.9, "length of the rocker", above=0)
ground = model.parameter("ground", "m", 1.1, "distance of the fixed pins", above=0)
density = model.parameter("density", "kg/m", 1.0, "mass of the bars over their length", above=0)
g = model.parameter("g", "m/s^2", 9.81, "gravity", minimum=0)

A = tuple(model.coordinate(f"{axis}_A", "m", f"pin of crank and coupler, {to}") for axis, to in (("x", "to the right"), ("y", "upwards")))
B = tuple(model.coordinate(f"{axis}_B", "m", f"pin of coupler and rocker, {to}") for axis, to in (("x", "to the right"), ("y", "upwards")))


def rates(point):
    return [p.rate if hasattr(p, "rate") else 0 for p in point]


def bar(name, length, P, Q):
    """A uniform bar from P to Q: its energies, and its length as a constraint."""
    (u, v), (w, z) = rates(P), rates(Q)
    model.kinetic(density * length / 6 * (u**2 + v**2 + u * w + v * z + w**2 + z**2))
    model.potential(density * length * g * (P[1] + Q[1]) / 2)
    model.constraint(name, sqrt((Q[0] - P[0]) ** 2 + (Q[1] - P[1]) ** 2) - length)
    model.draw(name, [P, Q], kind="line")
    # Its force pushes the pins apart: what it does at Q.
    model.draw(name, [Q], kind="contact", of=name, along=[((Q[0] - P[0]) / length, (Q[1] - P[1]) / length)])


for at in (0, ground):
    model.draw("ground", [(at - 0.08, -0.02), (at + 0.08, -0.02)], kind="fixed")
    model.draw("fixed pin", [(at, 0)], kind="point")
bar("crank_bar", crank, (0, 0), A)
bar("coupler_bar", coupler, A, B)
bar("rocker_bar", rocker, (ground, 0), B)
model.output("crank_angle", "rad", atan2(A[1], A[0]), "angle of the crank, counter-clockwise")
