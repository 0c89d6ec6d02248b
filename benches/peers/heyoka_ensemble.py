"""heyoka's batch mode on the ensemble of driven pendulums (benches/ensemble.rs): a row of tolerance, batch size, time of a
trajectory in s, and largest error for each.

A batch is a number of trajectories side by side in vector registers, each with steps of its own.
"""

import json
import math
import pathlib
import time

import heyoka as hy
import numpy as np

MEMBERS, END = 512, 10.0
REFERENCE = pathlib.Path(__file__).resolve().parents[2] / "tests" / "data" / "forced_pendulum.json"


def starts():
    """Angles and rates of the members."""
    members = np.arange(MEMBERS)
    return np.stack([3.0 * (members * 0.6180339887498949 % 1.0) - 1.5, 2.0 * (members * 0.41421356237309515 % 1.0) - 1.0])


def equations():
    angle, rate = hy.make_vars("angle", "rate")
    return [(angle, rate), (rate, -4.84 * hy.sin(angle) + hy.sin(3 * math.pi * hy.time))]


def fastest(work, repeats=20):
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def main():
    start, end = starts(), np.empty((2, MEMBERS))
    known = json.loads(REFERENCE.read_text())["members"]
    exact = np.array([[float(x) for x in member["end"]] for member in known]).T
    for tolerance in (10.0**-digits for digits in range(3, 15)):
        for size in (4, 8, 16, 32):
            batch = hy.taylor_adaptive_batch(equations(), np.zeros((2, size)), tol=tolerance)
            state = batch.state

            def run():
                for first in range(0, MEMBERS, size):
                    batch.set_time(0.0)
                    state[:] = start[:, first:first + size]
                    batch.propagate_until(END)
                    end[:, first:first + size] = state

            seconds = fastest(run) / MEMBERS
            error = np.abs(end[:, [member["member"] for member in known]] - exact).max()
            print(f"{tolerance:g} {size} {seconds:e} {error:e}", flush=True)


if __name__ == "__main__":
    main()
