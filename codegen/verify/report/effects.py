"""What a printed slip does to the motion: scenes simulated with and without it.

The model states in `paper_effects.py` how a scene selects the equations; the simulations are runs
of the program itself, whose path is given.
"""

import json
import os
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Dict, List

from ..errors import PaperError


@dataclass
class Simulated:
    """Results of the runs: by scene and variant; by scene and number of the slip (0: none); and by scene, `again`, those of the
    corrected equations at the tighter settings."""

    variants: Dict[str, Dict[str, dict]] = field(default_factory=dict)
    slips: Dict[str, List[dict]] = field(default_factory=dict)
    again: Dict[str, dict] = field(default_factory=dict)


def simulate(effects, corrections, program, progress=lambda done, total: None):
    """Runs all scenes in all variants and with each slip; `progress` is told how many runs are done."""
    jobs = []
    for scene, (file, *overrides) in effects.scenes.items():
        for name, chosen in effects.variants.items():
            jobs.append((scene, name, file, (*overrides, *chosen)))
        jobs.append((scene, None, file, (*overrides, *effects.corrected, *effects.tighter)))
        for number in range(len(corrections) + 1):
            jobs.append((scene, number, file, (*overrides, *effects.corrected, f"parameters.{effects.slip}={number}")))
    simulated = Simulated()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda job: run(program, job[2], job[3], effects.quantities), jobs)
        for done, ((scene, which, _, _), result) in enumerate(zip(jobs, results), 1):
            progress(done, len(jobs))
            if which is None:
                simulated.again[scene] = result
            elif isinstance(which, str):
                simulated.variants.setdefault(scene, {})[which] = result
            else:
                simulated.slips.setdefault(scene, []).append(result)
    return simulated


def attach(findings, corrections, simulated):
    """Fills in the effects of the findings that a correction describes, in the scenes whose corrected equations run."""
    numbers = {correction.key: k for k, correction in enumerate(corrections, 1)}
    for finding in findings:
        if finding.key in numbers:
            finding.effects = {
                scene: {"without": results[0], "with": (found := results[numbers[finding.key]]),
                        "changes": changes(results[0], simulated.again[scene], found)}
                for scene, results in simulated.slips.items() if "stopped" not in results[0]
            }


def changes(right, again, slipped):
    """The quantities that a slip changes by more than a tighter run does; of a run that stops early, that it does."""
    if "stopped" in slipped:
        return ["stopped"]
    return [name for name, value in slipped.items() if abs(value - right[name]) > abs(again[name] - right[name])]


def quantity(summary, path):
    """The number at a place of a summary. What is counted and did not happen is 0; a place that does
    not exist is an error, not a quantity that no slip changes."""
    value = summary
    for k, key in enumerate(path):
        counts = isinstance(value, dict) and all(type(x) is int for x in value.values())
        if isinstance(value, dict) and key in value:
            value = value[key]
        elif counts and k == len(path) - 1:
            return 0
        else:
            raise PaperError(f"the summary of a run has no {'.'.join(path)}; paper_effects.py asks for it")
    return value


def run(program, scene, overrides, quantities):
    """One run of the program: the quantities, and why it stopped where it did early."""
    command = [program, "run", scene]
    for override in overrides:
        command += ["--set", override]
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        done = subprocess.run(command + ["--out", out], capture_output=True, text=True)
        if done.returncode not in (0, 3):
            raise PaperError(f"{' '.join(command)} failed:\n{done.stderr}")
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as stream:
            summary = json.load(stream)
    result = {}
    for name, path in quantities.items():
        result[name] = quantity(summary, path)
    if done.returncode == 3:
        failure = summary["failure"]
        result["stopped"] = f"at t = {failure['t']:.6g} s in mode {failure['mode']}: {failure['reason']}"
    return result
