"""Verification of hand-derived equations of motion against what follows from energies.

`input` is what a paper prints; `normal` the exact normal form that all is compared in; `readings` the energies that a
paper may mean, and what follows from them; `judgements` what is objected to; `repairs` the slips; `report`
gathers and writes. docs/verification.md is the guide. What the files of a model folder need is imported from here:
`from codegen.verify import Paper, group`. None of it imports SymPy, so that a model that simulates printed equations
with CasADi symbols works where SymPy is not installed.
"""

from .input.corrections import Correction, apply, without
from .input.effects import Effects
from .input.printed import Paper, group
from .judgements.numbers import Number
from .readings.lagrange import Energies

__all__ = ["Correction", "Effects", "Energies", "Number", "Paper", "apply", "group", "without"]
