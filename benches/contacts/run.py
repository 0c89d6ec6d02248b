"""Runs the tools of this comparison, each in its own process, and writes results.csv.

    python3 benches/contacts/run.py SCRATCH

installs MuJoCo and Drake into the folder SCRATCH, compiles the program for Siconos (Debian's libsiconos-kernel-dev must be
there), and replaces the rows of every tool that ran; rows of a tool that failed stay, and its error is printed.
"""

import csv
import os
import subprocess
import sys
from pathlib import Path

import problems

HERE = Path(__file__).resolve().parent
TABLE = HERE / "results.csv"
HEADER = ["problem", "tool", "setting", "error", "seconds", "largest_gap", "events"]


def python_rows(scratch, package, script):
    """Rows that a script prints with a package of its own."""
    target = scratch / package
    if not target.exists():
        subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--target", target, package], check=True)
    environment = {**os.environ, "PYTHONPATH": str(target)}
    run = subprocess.run([sys.executable, HERE / script], env=environment, check=True, stdout=subprocess.PIPE, text=True)
    return list(csv.reader(run.stdout.splitlines()))


def siconos_rows(scratch):
    """Rows of the compiled program: it prints the coordinates at the end, the error is computed here."""
    program = scratch / "siconos_rows"
    include = Path("/usr/include/siconos")
    folders = [include, *sorted(p for p in include.iterdir() if p.is_dir())]
    subprocess.run(["g++", "-std=c++17", "-O3", "-w", *[f"-I{f}" for f in folders], HERE / "siconos_rows.cpp", "-o", program,
                    "-lsiconos_kernel", "-lsiconos_numerics"], check=True)
    run = subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True)
    rows = []
    for line in run.stdout.splitlines():
        fields = line.split(",")
        if fields[0] in ("block", "stack"):
            name, step, seconds, gap, *q = fields
            rows.append([name, "Siconos", f"step {step} s", f"{problems.error(name, map(float, q)):.1e}", seconds, gap, ""])
    return rows


def in_order(row):
    """By problem and tool; of each the coarsest first: `step 0.002 s`, `Taylor tolerance 1e-06`."""
    problem, tool, setting = row[:3]
    words = setting.split()
    return problem, tool, words[0], -max(float(w) for w in words if w[0].isdigit())


def own_rows():
    """Rows of this project."""
    run = subprocess.run(["cargo", "bench", "--quiet", "--bench", "contacts"], check=True, stdout=subprocess.PIPE, text=True)
    return list(csv.reader(run.stdout.splitlines()))


def main():
    scratch = Path(sys.argv[1])
    scratch.mkdir(parents=True, exist_ok=True)
    known = list(csv.reader(TABLE.open()))[1:] if TABLE.exists() else []
    for tool, rows_of in (("dalembert", own_rows), ("MuJoCo", lambda: python_rows(scratch, "mujoco", "mujoco_rows.py")),
                          ("Drake", lambda: python_rows(scratch, "drake", "drake_rows.py")),
                          ("Siconos", lambda: siconos_rows(scratch))):
        try:
            rows = rows_of()
        except (subprocess.CalledProcessError, OSError) as failure:
            print(f"{tool} failed, its rows stay: {failure}", file=sys.stderr)
            continue
        known = [row for row in known if row[1] != tool] + rows
        with TABLE.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([HEADER, *sorted(known, key=in_order)])
    print(f"{len(known)} rows in {TABLE.name}")


if __name__ == "__main__":
    main()
