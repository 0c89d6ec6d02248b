"""Compares our ensembles with heyoka's batch mode on driven pendulums: python3 benches/peers/ensemble.py SCRATCH; see README.md.

Both run on one core, one after the other, and are judged by the same solutions. Writes ensemble.md here.
"""

import argparse
import os
import pathlib
import subprocess

from install import HERE, ROOT, Peers

LEVELS = [1e-3, 1e-6, 1e-9, 1e-12]


def rows_of(command):
    """What a driver prints, as lists of numbers."""
    done = subprocess.run(list(map(str, command)), cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return [[float(x) for x in line.split()] for line in done.stdout.splitlines() if line[:1].isdigit()]


def best(rows, level):
    """The fastest (time, error) of rows that end so whose error is at most the level; None without any."""
    return min(([time, error] for *_, time, error in rows if error <= level), default=None)


def table(ours, heyoka):
    """Markdown: the best times for an error."""
    lines = ["| error | dalembert / µs | heyoka, batch mode / µs | ratio |", "|---|--:|--:|--:|"]
    for level in LEVELS:
        pair = [best(rows, level) for rows in (ours, heyoka)]
        times = [f"{1e6 * found[0]:.2f} (error {found[1]:.0e})" if found else "–" for found in pair]
        ratio = f"{pair[0][0] / pair[1][0]:.2f}" if all(pair) else "–"
        lines.append(f"| {level:g} | {times[0]} | {times[1]} | {ratio} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scratch", type=pathlib.Path, help="folder for what is installed and built")
    scratch = parser.parse_args().scratch.resolve()
    scratch.mkdir(parents=True, exist_ok=True)
    peers = Peers(scratch)
    heyoka, ours = peers.heyoka_ensemble(), peers.dalembert_ensemble()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    text = table(rows_of(ours), rows_of(heyoka))
    (HERE / "ensemble.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
