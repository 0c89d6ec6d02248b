"""The problems of this comparison, as in tests/data (13c, 15a, 14b), and what a row is."""

import csv
import json
import math
import sys
from pathlib import Path
from types import SimpleNamespace

DATA = Path(__file__).resolve().parents[2] / "tests" / "data"

BLOCK = SimpleNamespace(
    b=0.2, h=0.4, m=1.0, g=9.81, mu=0.55, end=2.0,
    ground=lambda t: (12 * math.sin(16 * t), 3 * math.sin(20 * t + 0.7)))
STACK = SimpleNamespace(big=3.0, small=1.0, mu_table=0.3, mu_top=0.2, end=3.0, table=lambda t: 6 * math.sin(7 * t))
LINKAGE = SimpleNamespace(end=10.0)


def reference(name):
    """The coordinates at the end."""
    if name == "block":
        return _numbers(_data("13c_block_forced")["scenes"]["rock, slide and slide-rock"]["final"]["q"])
    if name == "stack":
        return _numbers(_data("15a_two_block_stack")["scenes"]["big sticks, small slips first (mu_top<mu_table)"]["samples"][-1]["q"])
    return next(_numbers(r["B0"]) for r in _data("14b_n_four_bar")["reference"] if r["N"] == 2 and float(r["t"]) == LINKAGE.end)


def error(name, q):
    """The largest error of a coordinate at the end, m or rad."""
    return max(abs(a - b) for a, b in zip(q, reference(name), strict=True))


def row(problem, tool, setting, error, seconds, gap, events=""):
    """One line of the table, at once: what was computed is not lost with what fails later."""
    csv.writer(sys.stdout).writerow([problem, tool, setting, f"{error:.1e}", f"{seconds:.3e}", f"{gap:.1e}", events])
    sys.stdout.flush()


def _data(name):
    return json.loads((DATA / f"{name}.json").read_text())


def _numbers(texts):
    return [float(t) for t in texts]
