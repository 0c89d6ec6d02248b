"""Rows of CasADi's integrators with their own events (fields `zero` and option `transition`); see README.md.

Its explicit and its Rosenbrock method run as C that CasADi generates for the whole integration. Its CVODES and
IDAS look for events between outputs only and cannot go back to them. States are in units of their scales,
since CasADi has one absolute tolerance; the side is a further state, which only transitions change. The
times of the events come from an untimed run whose transition is a Python function that notes them.
"""

import math
import os
import subprocess
import sys
import tempfile
import time

import casadi as ca
import numpy as np

GRAVITY = 9.81
TAU = 2 * math.pi
METHODS = {"erk": "explicit", "rosenbrock": "Rosenbrock"}
PROBLEMS = ["P1", "P2", "P3b", "P4", "P4S", "P5"]
COMPILE = ["gcc", "-O3", "-march=native", "-shared", "-fPIC"]


def sign(x):
    return ca.if_else(x < 0, -1.0, 1.0)


class Problem:
    """States y, rates, guard, and the state and side after an event, as expressions."""

    def __init__(self, name):
        self.name = name
        self.t, self.side = ca.SX.sym("t"), ca.SX.sym("side")
        getattr(self, {"P1": "block", "P2": "block", "P3b": "belt", "P4": "sliding", "P4S": "sliding", "P5": "ball"}[name])()

    def states(self, *scales):
        self.scales = scales
        self.y = ca.SX.sym("y", len(scales))
        return ca.vertsplit(self.y * ca.DM(scales))

    def block(self):
        angle, rate = self.states(0.2, 0.5)
        shaken = self.name == "P2"
        lean = 0.25 * self.side - angle
        moment = ca.sin(lean)
        if shaken:
            moment += 0.35 * ca.sin(1.5 * TAU * self.t + 0.3) * ca.cos(lean)
        self.rates = [rate, -(3 * GRAVITY / 6) * moment]
        self.guard = self.side * angle
        self.after, self.next_side = [0, (0.85 if shaken else 0.9) * rate], -self.side
        self.start, self.first_side, self.end = [(0.3 if shaken else 0.6) * 0.25, 0.0], 1.0, 10.0 if shaken else 6.0

    def belt(self):
        x, v = self.states(0.05, 0.9)
        k, c, belt, static, kinetic = 400.0, 0.1, 0.2, 0.4 * GRAVITY, 0.25 * GRAVITY
        sticks = self.side == 0
        spring, after = k * x + c * v, k * x + c * belt
        self.rates = [v, ca.if_else(sticks, 0, kinetic * self.side - spring)]
        self.guard = ca.if_else(sticks, static - ca.fabs(spring), self.side * (belt - v))
        self.after = [x, belt]
        self.next_side = ca.if_else(ca.logic_and(ca.logic_not(sticks), ca.fabs(after) <= static), 0, sign(after))
        self.start, self.first_side, self.end = [0.05, 0.0], 1.0, 20.0

    def sliding(self):
        stiff = self.name == "P4S"
        u, d, us, ds = self.states(0.02, 8e-8 if stiff else 1e-3, 0.9, 3.5e-6 if stiff else 0.1)
        factor = 1e4 if stiff else 1.0
        base, upper, k, c = 5.0, 39.33, 1.05e6 * factor, 642 * factor
        weight = (base + upper) * GRAVITY
        static, kinetic = 0.2 * weight, 0.19 * weight
        sticks = self.side == 0
        spring, ground = k * d + c * ds, 20 * ca.sin(7 * TAU * self.t)
        held = spring - base * ground
        slips = ca.if_else(sticks, 0, (spring - kinetic * self.side) / base - ground)
        self.rates = [ca.if_else(sticks, 0, us), ds, slips, -spring / upper - ground - slips]
        self.guard = ca.if_else(sticks, static - ca.fabs(held), self.side * us)
        self.after = [u, d, ca.if_else(sticks, us, 0), ds]
        self.next_side = ca.if_else(ca.logic_and(ca.logic_not(sticks), ca.fabs(held) <= static), 0, sign(held))
        self.start, self.first_side, self.end = [0.0] * 4, 0.0, 2.0

    def ball(self):
        """The side counts the impacts; after the 30th nothing moves, and the third state is its time."""
        h, v, _ = self.states(1, 4.4, 1)
        flies = self.side < 30
        self.rates = [ca.if_else(flies, v, 0), ca.if_else(flies, -GRAVITY, 0), 0]
        self.guard = ca.if_else(flies, h, 1)
        self.after, self.next_side = [0, -0.8 * v, self.t], self.side + 1
        # It is over at 4.06 s.
        self.start, self.first_side, self.end = [1.0, 0.0, 0.0], 0.0, 5.0

    def dae(self):
        scales = ca.DM(self.scales)
        x = ca.vertcat(self.y, self.side)
        return {"x": x, "t": self.t, "ode": ca.vertcat(ca.vertcat(*self.rates) / scales, 0), "zero": self.guard}

    def transition(self):
        after = ca.vertcat(ca.vertcat(*self.after) / ca.DM(self.scales), self.next_side)
        x = ca.vertcat(self.y, self.side)
        none = [ca.SX.sym(name, 0) for name in "zpu"]
        inputs = [ca.SX.sym("index"), self.t, x, *none]
        return ca.Function("transition", inputs, [after, ca.SX(0, 1)], ["index", "t", "x", "z", "p", "u"], ["post_x", "post_z"])

    def first(self):
        return np.array([*(y / s for y, s in zip(self.start, self.scales)), self.first_side])

    def result(self, x):
        """Time and state at the end, from the solver's state."""
        y = [float(value) * scale for value, scale in zip(x, self.scales)]
        return (y[2], y[:2]) if self.name == "P5" else (self.end, y)


class Noting(ca.Callback):
    """A transition that notes when it is called."""

    def __init__(self, transition):
        ca.Callback.__init__(self)
        self.transition, self.times = transition, []
        self.construct("noting", {})

    def get_n_in(self):
        return self.transition.n_in()

    def get_n_out(self):
        return self.transition.n_out()

    def get_sparsity_in(self, i):
        return self.transition.sparsity_in(i)

    def get_sparsity_out(self, i):
        return self.transition.sparsity_out(i)

    def get_name_in(self, i):
        return self.transition.name_in(i)

    def get_name_out(self, i):
        return self.transition.name_out(i)

    def eval(self, arguments):
        t = float(arguments[1])
        if self.times[-1:] != [t]:  # it is called twice at an event
            self.times.append(t)
        return self.transition.call(arguments)


def fastest(work, least, most, budget):
    times = []
    begin = time.perf_counter()
    while len(times) < least or (len(times) < most and time.perf_counter() - begin < budget):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
        if times[0] > 0.2:
            break
    times.sort()
    return times[0], times[len(times) // 2], len(times)


def compiled(solver, folder):
    """The whole integration as C."""
    source = solver.name() + ".c"
    here = os.getcwd()
    os.chdir(folder)  # CasADi writes into the present folder only
    try:
        solver.generate(source)
    finally:
        os.chdir(here)
    library = os.path.join(folder, solver.name() + ".so")
    subprocess.run([*COMPILE, os.path.join(folder, source), "-o", library, "-lm"], check=True)
    return ca.external(solver.name(), library)


def row(problem, plugin, tolerance, folder, quick):
    transition = problem.transition()
    options = {"transition": transition, "max_events": 1000, "event_tol": 1e-14, "max_event_iter": 100,
               "reltol": tolerance, "abstol": tolerance, "max_num_steps": 2_000_000}
    make = lambda more: ca.integrator(f"{plugin}_{problem.name}", plugin, problem.dae(), 0, problem.end, options | more)
    solver = compiled(make({}), folder)
    buffer, evaluate = solver.buffer()
    start, end = problem.first(), np.zeros(len(problem.scales) + 1)
    buffer.set_arg(0, memoryview(start))
    buffer.set_res(0, memoryview(end))
    evaluate()
    status = buffer.ret()
    least, median, repeats = fastest(evaluate, *((3, 3, 0) if quick else (10, 400, 0.08)))
    noting = Noting(transition)
    statistics = {}
    if not status:
        untimed = make({"transition": noting})
        untimed(x0=start)
        statistics = untimed.stats()
    t, y = problem.result(end)
    counts = [statistics.get(what, 0) for what in ("n_rhs", "n_jac", "n_steps")]
    fields = ["CasADi", METHODS[plugin], problem.name, f"{tolerance:g}", least, median, repeats, *counts, status, repr(t)]
    return "|".join([*map(str, fields), ";".join(map(repr, y)), ";".join(map(repr, noting.times))])


def main():
    quick = "PEERS_QUICK" in os.environ
    for name in [p for p in PROBLEMS if p in sys.argv[1:] or not sys.argv[1:]]:
        problem = Problem(name)
        for digits in range(3, 14, 3 if quick else 1):
            for plugin in METHODS:
                if plugin == "erk" and name == "P4S":
                    continue
                with tempfile.TemporaryDirectory() as folder:
                    try:
                        print(row(problem, plugin, 10.0**-digits, folder, quick), flush=True)
                    except RuntimeError as error:
                        print(f"{name} 1e-{digits} {plugin}: {str(error).strip().splitlines()[-1]}", file=sys.stderr)


if __name__ == "__main__":
    main()
