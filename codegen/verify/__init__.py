"""Verification of hand-derived equations of motion against what follows from energies.

A model folder with printed equations holds `paper.py` (the equations exactly as printed),
`paper_energies.py` (energies in the paper's symbols) and, optionally, `corrections.py` and
`paper_numbers.py`; README.md in this folder describes them. Importing this package, or
`codegen.verify.printed`, does not import SymPy: a model file may use the printed equations for
simulation with CasADi symbols where SymPy is not installed.
"""
