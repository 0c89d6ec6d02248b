#!/usr/bin/env python3
"""Members per second and core of `dalembert study`, against single runs of the program and a loop over SciPy.

    python3 benches/studies/throughput.py target/release/dalembert [--members 2000] [--scipy]

Each study varies a parameter of a shipped scene on one thread, with end values as measures, and with peaks besides. What a study
takes with one member is subtracted: it is the start of the program and the reading of the files. A single run is a process for
each member, without files. SciPy (DOP853 with its events, the restitution by hand) computes the rocking block alone, at
the same relative tolerance, between landings of an uplift rate above 1e-6 rad/s: it cannot come to rest.
"""

import argparse
import json
import math
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOLERANCE = 1e-8
# Model, scene, the parameter that varies and its range, the quantity that is measured.
CASES = [
    ("rocking block", "rocking_block", "parameters.alpha", (0.21, 0.4), "theta"),
    ("belt oscillator", "belt_oscillator", "initial.x", (0.0, 0.01), "x"),
    ("tank", "tank_rocks_and_slides", "parameters.mu_s", (1.35, 1.45), "theta"),
]


def study(program, scene, path, values, measures, folder):
    """Seconds that a study takes on one thread."""
    text = {
        "scene": str(ROOT / "scenes" / f"{scene}.json"),
        "vary": {path: {"from": values[0], "to": values[1], "count": values[2]}},
        "measure": measures,
    }
    file = folder / "study.json"
    file.write_text(json.dumps(text))
    out = tempfile.mkdtemp(dir=folder) + "/out"
    begin = time.perf_counter()
    command = [program, "study", str(file), "--out", out, "--threads", "1"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - begin


def single(program, scene, count):
    """Seconds that a process for each member takes."""
    command = [program, "run", str(ROOT / "scenes" / f"{scene}.json"), "--set", "record={}"]
    begin = time.perf_counter()
    for _ in range(count):
        subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return (time.perf_counter() - begin) / count


def scipy_block(alpha, restitution=0.9, end=12.0, gravity=9.81, radius=1.0):
    """Free rocking from 0.2 rad until landings are slow, by SciPy."""
    from scipy.integrate import solve_ivp

    p2 = 0.75 * gravity / radius
    landing = lambda t, y: y[0]
    landing.terminal, landing.direction = True, -1
    t, y = 0.0, [0.2, 0.0]
    while t < end:
        run = solve_ivp(
            lambda t, y: (y[1], -p2 * math.sin(alpha - y[0])),
            (t, end), y, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE * 0.1, events=landing,
        )
        t, rate = run.t[-1], run.y[1, -1]
        if run.status != 1 or abs(rate) < 1e-6:
            return
        y = [0.0, -restitution * rate]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("--members", type=int, default=2000)
    arguments.add_argument("--scipy", action="store_true", help="SciPy too, which must be installed")
    given = arguments.parse_args()
    print(f"{'scene':16} {'µs a member':>12} {'with peaks':>11} {'members/s':>10} {'a process each, µs':>19} {'SciPy, µs':>10}")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name, scene, path, ends, quantity in CASES:
            def each(measures):
                take = lambda n: study(given.program, scene, path, (*ends, n), measures, folder)
                # The least of three of both: what else the machine does only adds.
                few, many = (min(take(n) for _ in range(3)) for n in (2, given.members))
                return (many - few) / (given.members - 2) * 1e6

            plain = each([f"end.{quantity}", "count"])
            peaks = each([f"end.{quantity}", "count", f"peak.{quantity}"])
            process = single(given.program, scene, 20) * 1e6
            scipy = "-"
            if given.scipy and scene == "rocking_block":
                begin = time.perf_counter()
                for i in range(5):
                    scipy_block(ends[0] + i / 4 * (ends[1] - ends[0]))
                scipy = f"{(time.perf_counter() - begin) / 5 * 1e6:.0f}"
            print(f"{name:16} {plain:12.1f} {peaks:11.1f} {1e6 / plain:10.0f} {process:19.0f} {scipy:>10}")


if __name__ == "__main__":
    main()
