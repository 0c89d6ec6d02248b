"""Compares dalembert with other solvers on one machine: python3 benches/peers/run.py SCRATCH; see README.md.

Installs the peers into the folder SCRATCH (once), runs them, and writes results.csv and best.md here
and docs/peers.svg.
"""

import argparse
import csv
import json
import os
import math
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROBLEMS = ["P1", "P2", "P3b", "P4", "P4S", "P5"]
LEVELS = [1e-3, 1e-6, 1e-9, 1e-12]
COLUMNS = ["peer", "method", "problem", "tolerance", "least_us", "median_us", "repeats", "rhs", "jacobians", "steps", "events", "end_error", "event_time_error", "verdict"]
SUNDIALS = "sundials-sys-0.6.2"  # a Rust crate with the sources of SUNDIALS 7.1
SUNDIALS_LIBRARIES = ["cvode", "arkode", "nvecserial", "sunmatrixdense", "sunlinsoldense", "sunnonlinsolfixedpoint", "sunnonlinsolnewton", "sunmatrixband", "core"]
CXX = ["g++", "-O3", "-march=native", "-std=c++20"]


def collect(line, references):
    """A printed row as a row of results.csv: errors against the references, and whether every event was found."""
    peer, method, problem, tolerance, least, median, repeats, rhs, jacobians, steps, status, time, y, events = line.split("|")
    reference = references[problem]
    y, events = ([float(x) for x in field.split(";") if x] for field in (y, events))
    true_events = [float(t) for t in reference["events"]]
    end_error = event_error = math.nan
    verdict = "failed" if int(status) else "ok" if len(events) == len(true_events) else "wrong events"
    if verdict == "ok":
        true_y = [float(x) for x in reference["y_end"]]
        # The spring of P4S follows its load to 1e-9 m; the height at an impact is 0 by the reset.
        compared = {"P4S": [0, 2], "P5": [1]}.get(problem, range(len(y)))
        end_error = max(abs(y[i] - true_y[i]) / reference["scales"][i] for i in compared)
        if problem == "P5":
            end_error = max(end_error, abs(float(time) - float(reference["t_end"])))
        event_error = max(abs(t - s) for t, s in zip(events, true_events))
    values = [peer, method, problem, f"{float(tolerance):g}", f"{1e6 * float(least):.2f}", f"{1e6 * float(median):.2f}", repeats, rhs, jacobians, steps,
              len(events), f"{end_error:.2e}", f"{event_error:.2e}", verdict]
    return dict(zip(COLUMNS, map(str, values)))


def best(rows, problem, level):
    """Fastest row of each peer with every event and an end error of at most the level."""
    fastest = {}
    for row in rows:
        if row["problem"] == problem and row["verdict"] == "ok" and float(row["end_error"]) <= level:
            if row["peer"] not in fastest or float(row["least_us"]) < float(fastest[row["peer"]]["least_us"]):
                fastest[row["peer"]] = row
    return fastest


def table(rows, floors):
    """Markdown: per problem and level each peer's best time, and our ratios."""
    peers = sorted({row["peer"] for row in rows} - {"dalembert"})
    lines = ["| problem | error | dalembert | " + " | ".join(peers) + " | to the best peer | to the floor |", "|---|--:|--:|" + "--:|" * (len(peers) + 2)]
    for problem in PROBLEMS:
        for level in LEVELS:
            fastest = best(rows, problem, level)
            cell = lambda peer: f"{float(fastest[peer]['least_us']):.1f} ({fastest[peer]['method']}, {fastest[peer]['tolerance']})" if peer in fastest else "–"
            ours = float(fastest["dalembert"]["least_us"]) if "dalembert" in fastest else math.nan
            others = [float(row["least_us"]) for peer, row in fastest.items() if peer != "dalembert"]
            ratio = f"{ours / min(others):.2f}" if others and not math.isnan(ours) else "–"
            floor = floors.get(problem, {}).get(f"{level:g}")
            of_floor = f"{ours / floor:.2f}" if floor and not math.isnan(ours) else "–"
            lines.append(f"| {problem} | {level:g} | {cell('dalembert')} | " + " | ".join(map(cell, peers)) + f" | {ratio} | {of_floor} |")
    return "\n".join(lines) + "\n"


def figure(rows, path):
    """Least time against achieved error: a panel a problem, a line a peer."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    grey = "#808080"  # is readable on white and on black
    plt.rcParams.update({"svg.hashsalt": "peers", "text.color": grey, "axes.edgecolor": grey, "axes.labelcolor": grey, "xtick.color": grey, "ytick.color": grey})
    peers = sorted({row["peer"] for row in rows}, key=lambda peer: (peer != "dalembert", peer))
    colours = dict(zip(peers, plt.get_cmap("tab10").colors))
    panels, axes = plt.subplots(2, 3, figsize=(11, 7), sharex=True)
    for axis, problem in zip(axes.flat, PROBLEMS):
        for peer in peers:
            points = sorted((float(r["end_error"]), float(r["least_us"])) for r in rows if (r["peer"], r["problem"], r["verdict"]) == (peer, problem, "ok"))
            # Only what no faster row beats: a peer at its best.
            points = [p for p in points if all(p[1] < q[1] for q in points if q[0] < p[0])]
            ours = peer == "dalembert"
            axis.loglog([max(e, 1e-16) for e, _ in points], [t for _, t in points], "-o", ms=3, lw=3 if ours else 1.2, color=colours[peer], label=peer)
        axis.set_title(problem, color=grey)
        axis.set_xlim(3e-1, 1e-16)
        axis.grid(alpha=0.3)
    for axis in axes[1]:
        axis.set_xlabel("error of the end state")
    for axis in axes[:, 0]:
        axis.set_ylabel("time / µs")
    panels.legend(*axes.flat[0].get_legend_handles_labels(), ncol=5, loc="lower center", frameon=False, labelcolor=grey)
    panels.tight_layout(rect=(0, 0.08, 1, 1))
    panels.savefig(path, transparent=True, metadata={"Date": None})


def call(command, **more):
    print("+", " ".join(map(str, command)), file=sys.stderr, flush=True)
    subprocess.run(list(map(str, command)), check=True, **more)


class Peers:
    """How each peer is installed, built and run; everything is kept in the scratch folder."""

    def __init__(self, scratch):
        self.scratch = scratch
        self.python = scratch / "venv" / "bin" / "python"

    def venv(self):
        if not self.python.exists():
            call([sys.executable, "-m", "venv", self.scratch / "venv"])
        call([self.python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"])

    def sundials(self):
        prefix = self.scratch / "sundials"
        if not (prefix / "lib" / "libsundials_arkode.a").exists():
            self.venv()
            # The crate is only fetched, not built.
            project = self.scratch / "sundials-source"
            (project / "src").mkdir(parents=True, exist_ok=True)
            (project / "src" / "lib.rs").touch()
            name, version = SUNDIALS.rsplit("-", 1)
            (project / "Cargo.toml").write_text(f'[package]\nname = "source"\nversion = "0.0.0"\nedition = "2021"\n[workspace]\n[dependencies]\n{name} = "={version}"\n')
            call(["cargo", "vendor", "--quiet", project / "vendor"], cwd=project, stdout=subprocess.DEVNULL)
            cmake = self.python.parent / "cmake"
            build = self.scratch / "sundials-build"
            off = [f"-D{o}=OFF" for o in ("BUILD_SHARED_LIBS", "EXAMPLES_ENABLE_C", "EXAMPLES_INSTALL", "BUILD_IDA", "BUILD_IDAS", "BUILD_KINSOL", "BUILD_CVODES")]
            call([cmake, "-S", project / "vendor" / name / "vendor", "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O3 -march=native -DNDEBUG",
                  f"-DCMAKE_INSTALL_PREFIX={prefix}", "-DCMAKE_INSTALL_LIBDIR=lib", *off])
            call([cmake, "--build", build, "--parallel", "--target", "install"])
        program = self.scratch / "sundials_rows"
        libraries = [prefix / "lib" / f"libsundials_{name}.a" for name in SUNDIALS_LIBRARIES]
        call([*CXX, "-I", prefix / "include", HERE / "sundials.cpp", "-o", program, *libraries, "-lm"])
        return [program]

    def fortran(self):
        if not list(pathlib.Path("/usr/lib").glob("*/libsiconos_externals.so*")):
            call(["apt-get", "install", "-y", "--no-install-recommends", "libsiconos-kernel-dev"])
        program = self.scratch / "fortran_rows"
        call([*CXX, HERE / "fortran.cpp", "-o", program, "-lsiconos_externals"])
        return [program]

    def heyoka(self):
        self.venv()
        return [self.python, "-B", HERE / "heyoka_rows.py"]

    def dalembert(self):
        # For the processor it runs on, as the peers.
        os.environ |= {"RUSTFLAGS": "-C target-cpu=native", "CFLAGS": "-march=native", "CARGO_TARGET_DIR": str(self.scratch / "target")}
        call(["cargo", "bench", "--no-run", "--bench", "peers"], cwd=ROOT)
        return ["cargo", "bench", "--quiet", "--bench", "peers", "--"]


RUNNABLE = ["sundials", "fortran", "heyoka", "dalembert"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scratch", type=pathlib.Path, help="folder for what is installed and built")
    parser.add_argument("--only", default="", help=f"peers and problems, separated by commas: {', '.join(RUNNABLE + PROBLEMS)}; other rows stay")
    arguments = parser.parse_args()
    arguments.scratch.mkdir(parents=True, exist_ok=True)
    only = [word for word in arguments.only.split(",") if word]
    unknown = set(only) - set(RUNNABLE + PROBLEMS)
    if unknown:
        parser.error(f"--only: no peer or problem is named {', '.join(sorted(unknown))}")
    problems = [p for p in PROBLEMS if p in only] or PROBLEMS
    reference = json.loads((HERE / "reference.json").read_text())
    results = HERE / "results.csv"
    rows = list(csv.DictReader(results.open())) if results.exists() else []
    peers = Peers(arguments.scratch.resolve())
    for name in [r for r in RUNNABLE if r in only] or RUNNABLE:
        command = getattr(peers, name)()
        print(f"{name}: {', '.join(problems)}", file=sys.stderr, flush=True)
        done = subprocess.run([*map(str, command), *problems], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
        new = [collect(line, reference) for line in done.stdout.splitlines() if line.count("|") == 13]
        replaced = {(row["peer"], row["problem"]) for row in new}
        rows = [row for row in rows if (row["peer"], row["problem"]) not in replaced] + new
        with results.open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    text = table(rows, reference["floors"])
    (HERE / "best.md").write_text(text)
    print(text)
    peers.venv()
    draw = f"import csv, sys; sys.path.insert(0, {str(HERE)!r}); import run; run.figure(list(csv.DictReader(open({str(results)!r}))), {str(ROOT / 'docs' / 'peers.svg')!r})"
    call([peers.python, "-B", "-c", draw])


if __name__ == "__main__":
    main()
