"""Rows of Drake: discrete plants with the contact solver SAP and lagged friction, point contact, each step size a row.

Contact is as stiff as each step resolves: a penetration of 1e-4 of the step's own length scale, g step²; SAP's near-rigid bound
does the rest. Constraints of the linkage are ball constraints of SAP.
"""

import sys
import time

import numpy as np
from pydrake.geometry import AddContactMaterial, Box, HalfSpace, ProximityProperties
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig
from pydrake.multibody.tree import FixedOffsetFrame, PlanarJoint, PrismaticJoint, RevoluteJoint, SpatialInertia, UnitInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Sine

import problems

STEPS = [2e-3, 5e-4, 1e-4]
UPRIGHT = RigidTransform(RollPitchYaw(np.pi / 2, 0, 0), [0, 0, 0])
"""A frame whose x and y are the world's x and z."""


def plant(step):
    builder = DiagramBuilder()
    config = MultibodyPlantConfig(time_step=step, contact_model="point", discrete_contact_approximation="lagged")
    made, scene = AddMultibodyPlant(config, builder)
    return builder, made, scene


def material(mu, stiffness):
    properties = ProximityProperties()
    AddContactMaterial(dissipation=0.0, point_stiffness=stiffness, friction=CoulombFriction(mu, mu), properties=properties)
    return properties


def floor(made, mu, stiffness):
    made.RegisterCollisionGeometry(made.world_body(), RigidTransform(), HalfSpace(), "floor", material(mu, stiffness))


def run(builder, made, sine, end, prepare=lambda context: None):
    """Simulates, and gives the plant's context at the end and the time it took, s."""
    if sine is not None:
        source = builder.AddSystem(sine)
        builder.Connect(source.get_output_port(0), made.get_applied_generalized_force_input_port())
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = made.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    prepare(context)
    simulator.Initialize()
    start = time.perf_counter()
    simulator.AdvanceTo(end)
    return context, time.perf_counter() - start


def block(step):
    p = problems.BLOCK
    builder, made, _ = plant(step)
    inertia = (p.b**2 + p.h**2) / 3
    body = made.AddRigidBody("block", SpatialInertia(p.m, [0, 0, 0], UnitInertia(inertia, inertia, inertia)))
    upright = made.AddFrame(FixedOffsetFrame("upright", made.world_frame(), UPRIGHT))
    own = made.AddFrame(FixedOffsetFrame("own", body.body_frame(), UPRIGHT))
    joint = made.AddJoint(PlanarJoint("planar", upright, own, [0, 0, 0]))
    stiffness = p.m * p.g / (1e-2 * p.g * step**2)
    floor(made, p.mu, stiffness)
    made.RegisterCollisionGeometry(body, RigidTransform(), Box(2 * p.b, 0.2, 2 * p.h), "box", material(p.mu, stiffness))
    made.Finalize()
    sine = Sine(np.array([-12.0 * p.m, -3.0 * p.m, 0]), np.array([16.0, 20, 1]), np.array([0, 0.7, 0]), True)
    context, wall = run(builder, made, sine, p.end, lambda c: made.SetPositions(c, [p.b, p.h, 0]))
    q = made.GetPositions(context)
    corners = [q[1] + s * p.b * np.sin(q[2]) - p.h * np.cos(q[2]) for s in (-1, 1)]
    return q, wall, max(0.0, -min(corners))


def stack(step):
    p = problems.STACK
    builder, made, _ = plant(step)
    stiffness = 4 * 9.81 / (1e-2 * 9.81 * step**2)
    floor(made, p.mu_table, stiffness)
    upright = made.AddFrame(FixedOffsetFrame("upright", made.world_frame(), UPRIGHT))
    # Drake combines coefficients as 2 a b / (a + b): both bodies and the floor have what gives the two interfaces theirs.
    small_mu = 1 / (2 / p.mu_top - 1 / p.mu_table)
    for name, mass, half, mu in (("big", p.big, (2, 1, 0.1), p.mu_table), ("small", p.small, (0.1, 0.1, 0.1), small_mu)):
        body = made.AddRigidBody(name, SpatialInertia(mass, [0, 0, 0], UnitInertia(1, 1, 1)))
        own = made.AddFrame(FixedOffsetFrame(name + "_own", body.body_frame(), UPRIGHT))
        between = made.AddRigidBody(name + "_height", SpatialInertia(0, [0, 0, 0], UnitInertia(0, 0, 0)))
        made.AddJoint(PrismaticJoint(name + "_x", upright, between.body_frame(), [1, 0, 0]))
        made.AddJoint(PrismaticJoint(name + "_y", between.body_frame(), own, [0, 1, 0]))
        made.RegisterCollisionGeometry(body, RigidTransform(), Box(*(2 * h for h in half)), name, material(mu, stiffness))
    made.Finalize()
    forces = np.array([-6 * p.big, 0, -6 * p.small, 0])
    sine = Sine(forces, np.array([7.0, 1, 7, 1]), np.zeros(4), True)
    context, wall = run(builder, made, sine, p.end, lambda c: made.SetPositions(c, [0, 0.1, 0, 0.3]))
    q = made.GetPositions(context)
    return q[[0, 2]], wall, max(0.0, 0.1 - q[1], q[1] + 0.2 - q[3])


def linkage(step):
    builder, made, _ = plant(step)
    upright = made.AddFrame(FixedOffsetFrame("upright", made.world_frame(), UPRIGHT))
    def bar(name, parent, along):
        centre = np.array(along) / 2
        unit = UnitInertia(1 / 12, 1 / 12, 1 / 12)
        body = made.AddRigidBody(name, SpatialInertia.MakeFromCentralInertia(1.0, centre, unit * 1.0))
        made.AddJoint(RevoluteJoint(name, parent, body.body_frame(), [0, 0, 1]))
        return body
    verticals = []
    for k in range(3):
        foot = made.AddFrame(FixedOffsetFrame(f"foot{k}", upright, RigidTransform([k, 0, 0])))
        verticals.append(bar(f"v{k}", foot, [0, 1, 0]))
    for k in range(2):
        tip = made.AddFrame(FixedOffsetFrame(f"tip{k}", verticals[k].body_frame(), RigidTransform([0, 1, 0])))
        horizontal = bar(f"h{k}", tip, [1, 0, 0])
        made.AddBallConstraint(horizontal, [1, 0, 0], verticals[k + 1], [0, 1, 0])
    made.Finalize()
    def prepare(context):
        for name, rate in (("v0", -1), ("v1", -1), ("v2", -1), ("h0", 1), ("h1", 1)):
            made.GetJointByName(name).set_angular_rate(context, rate)
    context, wall = run(builder, made, None, problems.LINKAGE.end, prepare)
    angle = made.GetJointByName("v0").get_angle(context)
    tips = []
    for k in range(2):
        a, b = (made.GetBodyByName(n).EvalPoseInWorld(context) @ p for n, p in
                ((f"h{k}", np.array([1.0, 0, 0])), (f"v{k + 1}", np.array([0, 1.0, 0]))))
        tips.append(np.abs(a - b).max())
    return np.array([-np.sin(angle), np.cos(angle)]), wall, max(tips)


if __name__ == "__main__":
    for name, solve in (("block", block), ("stack", stack), ("linkage", linkage)):
        for step in STEPS:
            try:
                q, wall, gap = solve(step)
            except RuntimeError as failure:
                print(f"# {name}, step {step:g} s: {str(failure).splitlines()[0]}", file=sys.stderr)
                continue
            problems.row(name, "Drake", f"step {step:g} s", problems.error(name, q), wall, gap)
