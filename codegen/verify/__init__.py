"""Verification of hand-derived equations of motion against what follows from energies.

`input` is what a paper prints; `normal` the exact normal form that all is compared in; `readings` the energies that a
paper may mean, and what follows from them; `judgements` what is objected to; `repairs` the slips; `report`
gathers and writes. docs/verification.md is the guide. What the files of a model folder need is imported from here:
`from codegen.verify import Paper, group`. None of it but `Energies`, which is loaded when it is asked for, imports SymPy: a
model that simulates printed equations with CasADi symbols works where SymPy is not installed, and is judged sooner.
"""

from .input.corrections import Correction, apply, without
from .input.effects import Effects
from .input.number import Number
from .input.printed import Paper, group

__all__ = ["Correction", "Effects", "Energies", "Number", "Paper", "apply", "group", "without"]


def __getattr__(name):
    if name == "Energies":
        from .readings.lagrange import Energies
        return Energies
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
