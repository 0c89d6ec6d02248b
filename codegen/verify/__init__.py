"""Verification of hand-derived equations of motion against what follows from energies.

`input` is what a paper prints; `normal` the exact normal form that all is compared in; `judgements` what is objected to;
`repairs` the slips; `readings` the energies that a paper may mean, and what follows from them; `construct` what a paper
does not print and its equations have; `report` gathers and writes. A folder imports what stands before it, nothing else
(tests/test_layers.py). docs/verification.md is the guide. What the files of a model folder need is imported from here:
`from codegen.verify import Paper, group`. None of it imports SymPy: a model that simulates printed equations with
CasADi symbols works where SymPy is not installed, and is judged sooner.
"""

from .input.corrections import Correction, apply, without
from .input.effects import Effects
from .input.energies import Energies
from .input.number import Number
from .input.printed import Paper, group

__all__ = ["Correction", "Effects", "Energies", "Number", "Paper", "apply", "group", "without"]
