#!/usr/bin/env python3
"""Members per second and core of `dalembert study`, against single runs and what users would do without it.

    python3 benches/studies/throughput.py target/release/dalembert [--members 2000] [--peers]

Each study varies a parameter of a shipped scene at its relative tolerance of 1e-8, on one thread, with end values and counts as measures,
and with a peak besides. What a study takes with two members is subtracted: it is the start of the program and the reading of the
files. A single run is a process for each member, without files. `--peers` needs numpy, scipy, heyoka and openseespy:

- SciPy: a loop over members of the rocking block, DOP853 with its events, the restitution by hand;
- heyoka: the same, by its Taylor method with terminal events, one integrator for all members (the integrator's own ensembles
  make a copy of it for each member);
- OpenSees: the oscillator with Coulomb friction as a zero-length elastic-plastic element, 1e3 times as stiff as the spring, Newmark's
  average acceleration with Newton's method, at a step of 20 ms, where the end is right to 3e-4.

SciPy and heyoka go from landing to landing. Neither can come to rest, and later, short hops are lost by heyoka, so that they are
compared over the first twelve landings; to rest there are 195 of them. Everything is timed in turns, by the time of the
processor, which depends little on what else the machine does; the least of three rounds counts, and results.csv gets the rows.
"""

import argparse
import csv
import json
import math
import resource
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RESULTS = Path(__file__).with_name("results.csv")
TOLERANCE = 1e-8
LANDINGS = 12
TWELVE = {"end": {"time": 12, "after": {"base strikes": LANDINGS}}}
# Name, scene and what is changed in it, the path that varies and its range, the quantity that is measured.
CASES = [
    ("block, 12 landings", "rocking_block", TWELVE, "parameters.alpha", (0.21, 0.4), "theta"),
    ("block, to rest", "rocking_block", {}, "parameters.alpha", (0.21, 0.4), "theta"),
    ("belt oscillator", "belt_oscillator", {}, "initial.x", (0.0, 0.01), "x"),
    ("tank", "tank_rocks_and_slides", {}, "parameters.mu_s", (1.35, 1.45), "theta"),
    ("Coulomb oscillator", "coulomb_oscillator", {}, "inputs.force.sine.amplitude", (0.8, 1.2), "x"),
]


def of_process(command):
    """Seconds of the processor that a program takes."""
    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    return end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime


def study(program, case, count, peaks, folder):
    """Seconds that a study takes on one thread."""
    _, scene, changes, path, ends, quantity = case
    measures = [f"end.{quantity}", "count"] + ([f"peak.{quantity}"] if peaks else [])
    text = json.loads((ROOT / "scenes" / f"{scene}.json").read_text())
    text |= {"accuracy": {"relative": TOLERANCE}} | changes
    (folder / "scene.json").write_text(json.dumps(text))
    text = {"scene": "scene.json", "vary": {path: {"from": ends[0], "to": ends[1], "count": count}}, "measure": measures}
    file = folder / "study.json"
    file.write_text(json.dumps(text))
    out = tempfile.mkdtemp(dir=folder) + "/out"
    return of_process([program, "study", str(file), "--out", out, "--threads", "1"])


def single(program, case, count=20):
    """Seconds that a process for each member takes."""
    _, scene, changes, *_ = case
    changes = {"record": {}, "accuracy.relative": TOLERANCE} | changes
    sets = [word for path, value in changes.items() for word in ("--set", f"{path}={json.dumps(value)}")]
    command = [program, "run", str(ROOT / "scenes" / f"{scene}.json"), *sets]
    return sum(of_process(command) for _ in range(count)) / count


def between(ends, count):
    return [ends[0] + i * (ends[1] - ends[0]) / (count - 1) for i in range(count)]


def scipy_block(ends, count=5, restitution=0.9, end=12.0, p2=0.75 * 9.81):
    """Seconds a member of free rocking from 0.2 rad, by SciPy."""
    from scipy.integrate import solve_ivp

    def landing(t, y):
        return y[0]

    landing.terminal, landing.direction = True, -1
    begin = time.process_time()
    for alpha in between(ends, count):
        t, y = 0.0, [0.2, 0.0]
        for _ in range(LANDINGS):
            run = solve_ivp(
                lambda t, y: (y[1], -p2 * math.sin(alpha - y[0])),
                (t, end), y, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE * 0.1, events=landing,
            )
            if run.status != 1:
                raise RuntimeError("SciPy missed a landing")
            t, y = run.t[-1], [0.0, -restitution * run.y[1, -1]]
    return (time.process_time() - begin) / count


def heyoka_block(ends, count=200, restitution=0.9, end=12.0, p2=0.75 * 9.81):
    """Seconds a member of free rocking from 0.2 rad, by heyoka; without what its compiler takes."""
    import heyoka as hy

    theta, rate = hy.make_vars("theta", "rate")
    equations = [(theta, rate), (rate, -p2 * hy.sin(hy.par[0] - theta))]
    falls = hy.t_event(theta, direction=hy.event_direction.negative)
    block = hy.taylor_adaptive(equations, [0.2, 0.0], tol=TOLERANCE, t_events=[falls], pars=[0.25])
    begin = time.process_time()
    for alpha in between(ends, count):
        block.time, block.pars[0] = 0.0, alpha
        block.state[:] = (0.2, 0.0)
        for _ in range(LANDINGS):
            block.reset_cooldowns()
            if block.propagate_until(end)[0] == hy.taylor_outcome.time_limit:
                raise RuntimeError("heyoka missed a landing")
            block.state[:] = (0.0, -restitution * block.state[1])
    return (time.process_time() - begin) / count


def opensees_coulomb(ends, count=5, step=0.02):
    """Seconds a member of the forced oscillator with Coulomb friction, by OpenSees."""
    import openseespy.opensees as ops

    begin = time.process_time()
    for amplitude in between(ends, count):
        opensees_end(ops, amplitude, step)
    return (time.process_time() - begin) / count


def opensees_end(ops, amplitude, step, end=120.0, friction=0.6, frequency=0.2, stiffness=1e3):
    """The displacement at the end."""
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    ops.node(1, 0.0)
    ops.node(2, 0.0)
    ops.fix(1, 1)
    ops.mass(2, 1.0)
    ops.uniaxialMaterial("Elastic", 1, 1.0)
    ops.uniaxialMaterial("ElasticPP", 2, stiffness, friction / stiffness)
    ops.element("zeroLength", 1, 1, 2, "-mat", 1, 2, "-dir", 1, 1)
    ops.timeSeries("Trig", 1, 0.0, 10 * end, 2 * math.pi / frequency, "-factor", amplitude)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 1.0)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("BandGeneral")
    ops.test("NormUnbalance", 1e-10, 50)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    if ops.analyze(round(end / step), step) != 0:
        raise RuntimeError("OpenSees did not converge")
    return ops.nodeDisp(2, 1)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("--members", type=int, default=2000)
    arguments.add_argument("--peers", action="store_true", help="SciPy, heyoka and OpenSees too, which must be installed")
    given = arguments.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for case in CASES:
            name, *_, ends, _ = case
            least = {}

            def note(tool, seconds):
                least[tool] = min(seconds, least.get(tool, math.inf))

            for _ in range(3):
                for tool, peaks in [("study", False), ("study with a peak", True)]:
                    take = [study(given.program, case, n, peaks, folder) for n in (2, given.members)]
                    note(tool, (take[1] - take[0]) / (given.members - 2))
                note("a process for each member", single(given.program, case))
                if given.peers and name == "block, 12 landings":
                    note("heyoka", heyoka_block(ends))
                    note("SciPy", scipy_block(ends))
                if given.peers and name == "Coulomb oscillator":
                    note("OpenSees", opensees_coulomb(ends))
            for tool, seconds in least.items():
                rows.append([name, tool, f"{seconds * 1e6:.1f}", f"{1 / seconds:.0f}", f"{seconds / least['study']:.2f}"])
                print(f"{name:20} {tool:26} {rows[-1][2]:>10} µs {rows[-1][3]:>8} a second {rows[-1][4]:>9} times a study's", flush=True)
    if given.peers:
        with RESULTS.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([["problem", "tool", "us_a_member", "members_a_second", "of_study"], *rows])


if __name__ == "__main__":
    main()
