"""Rows of MuJoCo: error against time, how deep bodies sink and how far a pinched one creeps.

Contacts are as stiff as the step allows (`solref` of two steps, which the manual names as the limit), cones are elliptic,
`impratio` is 100 against slip, the solver runs to 1e-14: each step size is one row.
"""

import sys
import time

import mujoco
import numpy as np

import problems

STEPS = [2e-3, 5e-4, 1e-4, 2e-5]


def option(step):
    return (f'<option timestep="{step}" gravity="0 0 -9.81" integrator="implicitfast" cone="elliptic" impratio="100"'
            ' solver="Newton" tolerance="1e-14" iterations="100"/>')


def model(step, world, extra=""):
    contact = f'<default><geom condim="3" solref="{2 * step} 1" solimp="0.99 0.9999 0.0001"/></default>'
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler autolimits="true"/>{option(step)}{contact}<worldbody>{world}</worldbody>{extra}</mujoco>')


def block(step):
    """The block of `problems.BLOCK`, in the frame of the ground: the ground's acceleration is a change of gravity."""
    p = problems.BLOCK
    inertia = p.m * (p.b**2 + p.h**2) / 3
    m = model(step, f"""
      <geom type="plane" size="5 5 1" friction="{p.mu} 0 0"/>
      <body pos="{p.b} 0 {p.h}">
        <joint name="x" type="slide" axis="1 0 0"/><joint name="y" type="slide" axis="0 0 1"/>
        <joint name="theta" type="hinge" axis="0 -1 0"/>
        <inertial pos="0 0 0" mass="{p.m}" diaginertia="{inertia} {inertia} {inertia}"/>
        <geom type="box" size="{p.b} 0.1 {p.h}" friction="{p.mu} 0 0"/>
      </body>""")
    d = mujoco.MjData(m)
    sunk = 0.0
    start = time.perf_counter()
    for k in range(round(p.end / step)):
        horizontal, vertical = p.ground(k * step)
        m.opt.gravity[0], m.opt.gravity[2] = -horizontal, -p.g - vertical
        mujoco.mj_step(m, d)
        if d.ncon:
            sunk = max(sunk, -d.contact.dist.min())
    wall = time.perf_counter() - start
    return d.qpos + [p.b, p.h, 0], wall, sunk


def stack(step):
    """Two blocks on a shaken table, in its frame."""
    p = problems.STACK
    m = model(step, f"""
      <geom type="plane" size="50 50 1" friction="{p.mu_table} 0 0"/>
      <body pos="0 0 0.1"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
        <geom name="big" type="box" size="2 1 0.1" mass="{p.big}" friction="{p.mu_table} 0 0" priority="1"/></body>
      <body pos="0 0 0.3"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
        <geom name="small" type="box" size="0.1 0.1 0.1" mass="{p.small}" friction="{p.mu_top} 0 0" priority="2"/></body>""")
    d = mujoco.MjData(m)
    sunk = 0.0
    start = time.perf_counter()
    for k in range(round(p.end / step)):
        m.opt.gravity[0] = -p.table(k * step)
        mujoco.mj_step(m, d)
        if d.ncon:
            sunk = max(sunk, -d.contact.dist.min())
    wall = time.perf_counter() - start
    return d.qpos[[0, 2]], wall, sunk


def linkage(step):
    """The double four-bar of IFToMM: bars of 1 m and 1 kg; the joints that close loops are equalities."""
    bar = '<geom type="capsule" size="0.001" fromto="0 0 0 {0} 0 {1}" contype="0" conaffinity="0" mass="0"/>'
    inertial = '<inertial pos="{0} 0 {1}" mass="1" diaginertia="0.0833333333333333 0.0833333333333333 0.0833333333333333"/>'
    def vertical(name, x, inside=""):
        return (f'<body name="{name}" pos="{x} 0 0"><joint name="{name}" type="hinge" axis="0 1 0"/>' + inertial.format(0, 0.5)
                + bar.format(0, 1) + inside + "</body>")
    def horizontal(name):
        return (f'<body name="{name}" pos="0 0 1"><joint name="{name}" type="hinge" axis="0 1 0"/>' + inertial.format(0.5, 0)
                + bar.format(1, 0) + "</body>")
    world = vertical("v0", 0, horizontal("h0")) + vertical("v1", 1, horizontal("h1")) + vertical("v2", 2)
    equality = f"""<equality><connect body1="h0" body2="v1" anchor="1 0 0" solref="{2 * step} 1" solimp="0.9999 0.9999 0.001"/>
      <connect body1="h1" body2="v2" anchor="1 0 0" solref="{2 * step} 1" solimp="0.9999 0.9999 0.001"/></equality>"""
    m = model(step, world, equality)
    d = mujoco.MjData(m)
    for name in ("v0", "v1", "v2"):
        d.joint(name).qvel[0] = 1
    for name in ("h0", "h1"):
        d.joint(name).qvel[0] = -1
    gap = 0.0
    start = time.perf_counter()
    for _ in range(round(problems.LINKAGE.end / step)):
        mujoco.mj_step(m, d)
        gap = max(gap, np.abs(d.efc_pos[: d.ne]).max() if d.ne else 0.0)
    wall = time.perf_counter() - start
    angle = d.joint("v0").qpos[0]
    return np.array([np.sin(angle), np.cos(angle)]), wall, gap


def pinched(step, force):
    """How far a capsule of 45 g creeps in 10 s that is pinched at mu = 0.7 (MuJoCo's issue 3328): 0 by Coulomb's law."""
    m = model(step, """
      <body pos="-0.02 0 0"><joint name="left" type="slide" axis="1 0 0"/>
        <geom type="box" size="0.01 0.05 0.05" mass="0.1" friction="0.7 0 0"/></body>
      <body pos="0.02 0 0"><joint name="right" type="slide" axis="1 0 0"/>
        <geom type="box" size="0.01 0.05 0.05" mass="0.1" friction="0.7 0 0"/></body>
      <body pos="0 0 0"><freejoint/><geom type="capsule" size="0.01 0.03" mass="0.045" friction="0.7 0 0"/></body>""",
        '<actuator><motor joint="left"/><motor joint="right"/></actuator>')
    m.body_gravcomp[1:3] = 1
    d = mujoco.MjData(m)
    d.ctrl[:] = force, -force
    settle = round(1 / step)
    for _ in range(settle):
        mujoco.mj_step(m, d)
    height = d.qpos[4]
    for _ in range(10 * settle):
        mujoco.mj_step(m, d)
    return abs(d.qpos[4] - height)


if __name__ == "__main__":
    for name, run in (("block", block), ("stack", stack), ("linkage", linkage)):
        for step in STEPS:
            q, wall, gap = run(step)
            problems.row(name, "MuJoCo", f"step {step:g} s", problems.error(name, q), wall, gap)
    for force in (12, 60):
        print(f"# a capsule pinched with {force} N creeps {pinched(2e-3, force):.1e} m in 10 s", file=sys.stderr)
