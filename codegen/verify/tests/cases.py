"""Reports that several tests look at, each made once. They change nothing of it."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from codegen.verify.load import load
from codegen.verify.report import gather

ROOT = Path(__file__).resolve().parents[3]
TANK = ROOT / "models" / "walking_tank"
# what is left out of a case
WITHOUT = {"nothing": {}, "corrections": {"corrections": [], "readings": {}},
           "energies": {"corrections": [], "readings": {}, "energies": []}}


@lru_cache(None)
def report_of(folder, without="nothing"):
    """The report of a folder, without the proofs over the whole box."""
    return gather.verify(replace(load(folder), **WITHOUT[without]), thorough=False)
