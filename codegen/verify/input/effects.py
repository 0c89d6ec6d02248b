"""How a model folder says in which scenes the effect of slips is simulated (`paper_effects.py`)."""

from dataclasses import dataclass
from typing import Dict, Tuple


@dataclass(frozen=True)
class Effects:
    """How the effect of a slip is simulated.

    `scenes` are scenes by name: a file relative to the project, and overrides of what it says. In each, the corrected equations
    must run to the end, and all that a slip can change should happen. `corrected` are the overrides that select the
    corrected equations, and `slip` the parameter that leaves out one correction, by its number in
    the list of corrections (0: none). `tighter` are overrides with which the corrected equations run once more: what differs
    between the two runs is too little to be an effect. `variants` are overrides by name, for the comparison of the
    equations as a whole. `quantities` are places in the summary of a run by name.
    """

    scenes: Dict[str, Tuple[str, ...]]
    corrected: Tuple[str, ...]
    slip: str
    tighter: Tuple[str, ...]
    variants: Dict[str, Tuple[str, ...]]
    quantities: Dict[str, Tuple[str, ...]]
