"""Rows of heyoka: an adaptive Taylor method that compiles a problem's expressions; see README.md.

Besides each measured row there is one less the cost of the calls from Python, which a driver in
C++ would not pay: per restart, that of the same calls over a span of no length.
"""

import math
import os
import sys
import time

import heyoka as hy

from heyoka_tank import Tank

GRAVITY = 9.81
TAU = 2 * math.pi
SIDE = hy.par[0]
# heyoka misses the next root where a guard is zero at the start of a step: restart on its positive side.
BEYOND = 1e-18


def sign(x):
    return -1.0 if x < 0 else 1.0


class Problem:
    """Modes by name: equations and guards; `event(t, y, side, which)` changes y at the fall of a guard and returns the
    next side."""

    stop_after = None

    def __init__(self, name):
        self.name = name
        getattr(self, {"P1": "block", "P2": "block", "P3b": "belt", "P4": "sliding", "P4S": "sliding", "P5": "ball"}[name])()

    def idle(self, t, y, side):
        """What an event costs in Python."""
        self.event(t, y, side, 0)

    def begun(self, _):
        """The side at the start of a run."""
        return self.side

    def mode(self, side):
        return "sticks" if side == 0 else "moves"

    def parameters(self, side):
        return [side]

    def block(self):
        angle, rate = hy.make_vars("angle", "rate")
        shaken = self.name == "P2"
        lean = 0.25 * SIDE - angle
        moment = hy.sin(lean)
        if shaken:
            moment = moment + 0.35 * hy.sin(1.5 * TAU * hy.time + 0.3) * hy.cos(lean)
        self.modes = {"moves": ([(angle, rate), (rate, -(3 * GRAVITY / 6) * moment)], [SIDE * angle])}
        self.start, self.side, self.end = [(0.3 if shaken else 0.6) * 0.25, 0.0], 1.0, 10.0 if shaken else 6.0
        restitution = 0.85 if shaken else 0.9

        def event(t, y, side, _):
            y[0] = -side * BEYOND
            y[1] *= restitution
            return -side

        self.event = event

    def belt(self):
        x, v = hy.make_vars("x", "v")
        k, c, belt, static, kinetic = 400.0, 0.1, 0.2, 0.4 * GRAVITY, 0.25 * GRAVITY
        spring = k * x + c * v
        self.modes = {
            "moves": ([(x, v), (v, kinetic * SIDE - spring)], [SIDE * (belt - v)]),
            "sticks": ([(x, v), (v, 0.0 * x)], [static - spring, static + spring]),
        }
        self.start, self.side, self.end = [0.05, 0.0], 1.0, 20.0

        def event(t, y, side, _):
            force = k * y[0] + c * belt
            sticks = side != 0 and abs(force) <= static
            after = 0.0 if sticks else sign(force)
            y[1] = belt if sticks else math.nextafter(belt, -after * math.inf)
            return after

        self.event = event

    def sliding(self):
        u, d, us, ds = hy.make_vars("u", "d", "us", "ds")
        factor = 1e4 if self.name == "P4S" else 1.0
        base, upper, k, c = 5.0, 39.33, 1.05e6 * factor, 642 * factor
        weight = (base + upper) * GRAVITY
        static, kinetic = 0.2 * weight, 0.19 * weight
        spring, ground = k * d + c * ds, 20 * hy.sin(7 * TAU * hy.time)
        held = spring - base * ground
        friction = kinetic * SIDE
        self.modes = {
            "moves": (
                [(u, us), (d, ds), (us, (spring - friction) * (1 / base) - ground), (ds, friction * (1 / base) - spring * (1 / base + 1 / upper))],
                [SIDE * us],
            ),
            "sticks": ([(u, 0.0 * u), (d, ds), (us, 0.0 * u), (ds, -spring * (1 / upper) - ground)], [static - held, static + held]),
        }
        self.start, self.side, self.end = [0.0] * 4, 0.0, 2.0

        def event(t, y, side, _):
            force = k * y[1] + c * y[3] - base * 20 * math.sin(7 * TAU * t)
            sticks = side != 0 and abs(force) <= static
            after = 0.0 if sticks else sign(force)
            y[2] = after * BEYOND
            return after

        self.event = event

    def ball(self):
        h, v = hy.make_vars("h", "v")
        self.modes = {"moves": ([(h, v), (v, 0.0 * h - GRAVITY)], [h])}
        self.start, self.side, self.end, self.stop_after = [1.0, 0.0], 1.0, 100.0, 30

        def event(t, y, side, _):
            y[0] = BEYOND
            y[1] *= -0.8
            return side

        self.event = event


class Solver:
    def __init__(self, problem, tolerance):
        self.problem, self.tolerance = problem, tolerance
        self.modes = {}
        for name, (equations, guards) in problem.modes.items():
            events = [hy.t_event(g, direction=hy.event_direction.negative) for g in guards]
            integrator = hy.taylor_adaptive(equations, problem.start, tol=tolerance, t_events=events)
            self.modes[name] = (integrator, integrator.state, integrator.pars)

    def begin(self, name, t, y, side):
        integrator, state, parameters = self.modes[name]
        integrator.time = t
        state[:] = y
        if len(parameters):
            parameters[:] = self.problem.parameters(side)[: len(parameters)]
        integrator.reset_cooldowns()
        return integrator, state

    def run(self):
        p = self.problem
        side = p.begun(self.tolerance)
        integrator, state = self.begin(p.mode(side), 0.0, p.start, side)
        events, steps = [], 0
        while True:
            outcome = integrator.propagate_until(p.end)
            steps += outcome[3]
            if outcome[0] == hy.taylor_outcome.time_limit:
                return integrator.time, state, events, steps, 0
            if outcome[0] in (hy.taylor_outcome.err_nf_state, hy.taylor_outcome.step_limit) or len(events) > 1000:
                return integrator.time, state, events, steps, -1
            t = integrator.time
            events.append(t)
            # Outcomes of terminal events are −1, −2, …
            side = p.event(t, state, side, -int(outcome[0]) - 1)
            if len(events) == p.stop_after:
                return t, state, events, steps, 0
            integrator, state = self.begin(p.mode(side), t, state, side)

    def cost_of_calls(self):
        """Of one restart and its propagation, s: the same calls over a span of no length."""
        p = self.problem
        side = p.begun(self.tolerance)

        def once():
            integrator, state = self.begin(p.mode(side), 0.0, p.start, side)
            p.idle(0.0, state, side)
            integrator.propagate_until(0.0)
            integrator.time

        return fastest(once, 300)[0]


def fastest(work, most, budget=0.1):
    times = []
    begin = time.perf_counter()
    while len(times) < 5 or (len(times) < most and time.perf_counter() - begin < budget):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
        if times[0] > 1:
            break
    times.sort()
    return times[0], times[len(times) // 2], len(times)


def main():
    quick = "PEERS_QUICK" in os.environ
    for name in sys.argv[1:] or ["P1", "P2", "P3b", "P4", "P4S", "P5", "free", "plate"]:
        problem = Tank(name) if name in ("free", "plate") else Problem(name)
        runs, call = [], math.inf
        for digits in range(3, 14, 3 if quick else 1):
            solver = Solver(problem, 10.0**-digits)
            least, median, repeats = fastest(solver.run, 5 if quick else 200)
            t, y, events, steps, status = solver.run()
            runs.append((digits, least, median, repeats, t, list(y), list(events), steps, status))
            # What a call costs does not depend on the tolerance: the least is what the machine did not disturb.
            call = min(call, solver.cost_of_calls())
        for digits, least, median, repeats, t, y, events, steps, status in runs:
            calls = (len(events) + 1) * call
            for peer, less in (("heyoka", 0.0), ("heyoka less calls", calls)):
                row = [peer, "Taylor", name, f"1e-{digits}", least - less, median - less, repeats, 0, 0, steps, status, repr(t)]
                print(*row, ";".join(map(repr, map(float, y))), ";".join(map(repr, events)), sep="|", flush=True)


if __name__ == "__main__":
    main()
