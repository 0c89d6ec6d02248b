"""What each feature of the library costs in crates, and in processor time to build them.

    python3 tools/features.py SCRATCH

SCRATCH is an empty folder. All crates that the default features need are built there once (release profile), and the processor time
of each is noted; a feature costs what it adds to the library without features, or, where it includes other features, to those.
The library itself, and what its build script does, is left out. What the library's build script needs counts as needed without
features, in whichever way it is used: crates that are compiled twice, for the build script and for `folders`, count there with both.
Prints the rows of a table: feature, crates, seconds; README.md states them.
"""

import os
import re
import resource
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# Features, and those that each includes.
FEATURES = {"plots": "", "folders": "", "cli": "folders,plots", "png-pdf": "plots", "parquet": "", "shipped-models": ""}
LOG = "DALEMBERT_FEATURES_LOG"


def compile_one(command):
    """The compiler in cargo's stead: notes the processor time of a crate; the library itself is not compiled."""
    name = os.environ.get("CARGO_PKG_NAME")
    if name == "dalembert":
        return 1
    status = subprocess.run(command).returncode
    if name:
        spent = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(os.environ[LOG], "a", encoding="utf-8") as stream:
            stream.write(f"{name} v{os.environ['CARGO_PKG_VERSION']} {spent.ru_utime + spent.ru_stime}\n")
    return status


def crates(features):
    """Names and versions of the crates that the library is built from, with itself."""
    command = ["cargo", "tree", "--package", "dalembert", "--no-default-features", "--features", features, "--edges", "normal,build",
               "--prefix", "none", "--no-dedupe"]
    lines = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    return {" ".join(line.split()[:2]) for line in lines if line.strip()}


def build(scratch):
    """Processor time of each crate, in seconds: what is compiled for it, build scripts too, but not what these run."""
    log = os.path.join(scratch, "crates.log")
    wrapper = os.path.join(scratch, "rustc")
    with open(wrapper, "w", encoding="utf-8") as stream:
        stream.write(f'#!/bin/sh\nexec "{sys.executable}" "{os.path.abspath(__file__)}" --compile "$@"\n')
    os.chmod(wrapper, 0o755)
    environment = {**os.environ, "RUSTC_WRAPPER": wrapper, LOG: log, "CARGO_TARGET_DIR": os.path.join(scratch, "target")}
    # It fails where the library's turn comes; by then, or beside it, all other crates are built.
    subprocess.run(["cargo", "build", "--release", "--lib", "--package", "dalembert", "--keep-going"], cwd=ROOT, env=environment,
                   stderr=subprocess.DEVNULL)
    seconds = {}
    with open(log, encoding="utf-8") as stream:
        for line in stream:
            name, version, spent = line.split()
            seconds[f"{name} {version}"] = seconds.get(f"{name} {version}", 0.0) + float(spent)
    return seconds


def main(scratch):
    os.makedirs(scratch, exist_ok=True)
    if os.listdir(scratch):
        sys.exit(f"{scratch} is not empty: give an empty or new folder")
    scratch = os.path.abspath(scratch)
    seconds = build(scratch)
    all_of_them = crates("default")
    missing = sorted(name for name in all_of_them if name not in seconds and not re.match("dalembert ", name))
    if missing:
        sys.exit(f"not built: {', '.join(missing)}")

    def row(name, group):
        print(f"| {name} | {len(group)} | {sum(seconds.get(crate, 0.0) for crate in group):.0f} |")

    row("none", crates(""))
    for feature, included in FEATURES.items():
        row(f"`{feature}`", crates(feature) - crates(included))
    row("default", all_of_them)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--compile"]:
        sys.exit(compile_one(sys.argv[2:]))
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
