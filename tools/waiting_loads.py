"""Loads that wait for what was just written, in a trace of a program's memory.

    CARGO_PROFILE_RELEASE_DEBUG=1 cargo build --release
    valgrind --tool=lackey --trace-mem=yes target/release/PROGRAM ARGUMENTS 2>&1 |
        python3 tools/waiting_loads.py target/release/PROGRAM [COUNT]

A processor gives a load what a store has written before that is in memory, but only if the load lies
within the store. A load of two numbers that were written one after the other waits until both are in memory,
and with it the chain of operations behind it. Prints such loads with the store that they wait for, most frequent
first, how often each happens, divided by COUNT, and the lines of the source. A run of some thousand steps does.
"""

import subprocess
import sys
from collections import Counter, deque

PLACE = 0x108000
"""Where valgrind places a position-independent program on x86-64."""

STORES, INSTRUCTIONS = 112, 500
"""Stores, and instructions, that a processor of 2023 has under way: what is older is in memory."""


def waits(trace):
    """Counts pairs (address of the load, address of the store) of instructions."""
    pairs, recent = Counter(), deque(maxlen=STORES)
    here = executed = 0
    for line in trace:
        kind = line[:2]
        if kind == "I ":
            here, executed = int(line[3:].partition(",")[0], 16), executed + 1
        elif kind in (" L", " S", " M"):
            address, size = line[3:].split(",")
            start = int(address, 16)
            end = start + int(size)
            if kind != " S":
                for first, last, store, when in reversed(recent):
                    if executed - when > INSTRUCTIONS:
                        break
                    if first < end and start < last:
                        pairs[here, store] += not (first <= start and end <= last)
                        break
            if kind != " L":
                recent.append((start, end, here, executed))
    return pairs


def lines_of(program, address):
    """The lines of the source of an instruction, inlined ones first."""
    command = ["addr2line", "-i", "-e", program, hex(address - PLACE)]
    found = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split("\n")
    return " < ".join(line.rsplit("/", 1)[-1].split(" ")[0] for line in found if line)


def main():
    program, count = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
    for (load, store), times in waits(sys.stdin).most_common(50):
        print(f"{times / count:10.2f}  {lines_of(program, load)}\n{'':10}  waits for {lines_of(program, store)}")


if __name__ == "__main__":
    main()
