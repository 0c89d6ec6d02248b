"""Compares dalembert with other solvers on one machine: python3 benches/peers/run.py SCRATCH; see README.md.

Installs the peers into the folder SCRATCH (once), runs them, and writes results.csv, best.md and overhead.md here,
docs/peers.svg and the table in docs/peers.md. The rows of each peer and problem are written as soon as they are there.
"""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys

from install import HERE, ROOT, RUNNABLE, Peers, call
from rows import COLUMNS, FLOOR, PROBLEMS, collect, least, least_costs, merged, table, with_summary

# The names of the rows that a peer prints.
PRINTS = {"sundials": {"CVODE", "ARKODE"}, "fortran": {"LSODAR", "RADAU5"}, "heyoka": {"heyoka", "heyoka less calls"}, "casadi": {"CasADi"}, "floor": {FLOOR}}


def read(path):
    """The rows of a table; none if there is none yet."""
    if not path.exists():
        return []
    with path.open() as file:
        return list(csv.DictReader(file))


def write(path, rows):
    """Puts a table in the place of the old one at once."""
    new = path.with_suffix(".tmp")
    with new.open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    os.replace(new, path)


def is_there(rows, name, problem):
    """Whether a peer has rows of a problem."""
    peers = PRINTS.get(name, {name})
    return any(row["peer"] in peers and row["problem"] == problem for row in rows)


def rows_of(command, problem, reference):
    """Runs a peer on a problem."""
    done = subprocess.run([*map(str, command), problem], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    rows = [line for line in done.stdout.splitlines() if line.count("|") == len(COLUMNS) - 1]
    return [collect(line, reference) for line in rows if line.split("|")[2] == problem]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scratch", type=pathlib.Path, help="folder for what is installed and built")
    parser.add_argument("--only", default="", help=f"peers and problems, separated by commas: {', '.join(RUNNABLE + ['floor'] + PROBLEMS)}; other rows stay")
    parser.add_argument("--floor", type=pathlib.Path, help="C++ source of a program that prints rows of bare code made for each problem; not part of the project")
    parser.add_argument("--missing", action="store_true", help="only what has no rows yet: goes on after an interruption")
    parser.add_argument("--again", action="store_true", help="another pass of the same programs: the least times of both count")
    parser.add_argument("--quick", action="store_true", help="a trial, written into SCRATCH: every third tolerance, few repeats")
    arguments = parser.parse_args()
    scratch = arguments.scratch.resolve()
    scratch.mkdir(parents=True, exist_ok=True)
    only = [word for word in arguments.only.split(",") if word]
    runnable = RUNNABLE + (["floor"] if arguments.floor else [])
    unknown = set(only) - set(runnable + PROBLEMS)
    if unknown:
        parser.error(f"--only: no peer or problem is named {', '.join(sorted(unknown))}")
    if arguments.quick:
        os.environ["PEERS_QUICK"] = "1"
    reference = json.loads((HERE / "reference.json").read_text())
    results, figure = (scratch, scratch / "peers.svg") if arguments.quick else (HERE, ROOT / "docs" / "peers.svg")
    rows = read(results / "results.csv")
    peers = Peers(scratch, arguments.floor)
    failed = []
    for name in [r for r in runnable if r in only] or runnable:
        problems = [p for p in PROBLEMS if p in only] or PROBLEMS
        if arguments.missing:
            problems = [p for p in problems if not is_there(rows, name, p)]
        try:
            command = getattr(peers, name)() if problems else None
            for problem in problems:
                print(f"{name}: {problem}", file=sys.stderr, flush=True)
                new = rows_of(command, problem, reference)
                rows = merged(rows, least(rows, new) if arguments.again else new)
                write(results / "results.csv", rows)
            if name == "dalembert" and problems:
                shares = subprocess.run([*map(str, command), "overhead"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
                file = results / "overhead.md"
                before = file.read_text() if arguments.again and file.exists() else ""
                file.write_text(least_costs(before, shares.stdout))
        except subprocess.CalledProcessError as error:
            print(f"{name}: {error}; the others go on", file=sys.stderr)
            failed.append(name)
    text = table(rows)
    (results / "best.md").write_text(text)
    print(text)
    page = ROOT / "docs" / "peers.md"
    if not arguments.quick:
        page.write_text(with_summary(page.read_text(), rows))
    peers.venv()
    call([peers.python, "-B", HERE / "rows.py", results / "results.csv", figure])
    if failed:
        sys.exit(f"failed: {', '.join(failed)}; run again with --missing")


if __name__ == "__main__":
    main()
