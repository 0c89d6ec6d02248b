"""The dimensions of energies and forces: with an energy that is none nothing can be compared."""

from sympy import Add, sympify

from ..errors import UnitError
from ..input import units
from ..input.namespace import Mathematics, sympy_namespace

UNITS = {"kinetic": "J", "potential": "J", "dissipation": "W"}


def wrong_terms(printed, energies):
    """[(which energy or force, term as a SymPy expression, words)]: the terms that have not its dimension."""
    known = {**printed.dimension, **units.table(energies.extra.values())}
    s, m, symbols = sympy_namespace(printed.paper, energies.extra), Mathematics(), {**printed.paper.symbols, **energies.extra}
    wanted = [(name, getattr(energies, name), units.parse(unit)) for name, unit in UNITS.items() if getattr(energies, name)]
    wanted += [(f"force on {printed.paper.shown(name)}", function, units.parse("J").times(units.parse(symbols[name].unit), -1))
               for name, function in energies.forces.items() if name in symbols]
    found = []
    for name, function, unit in wanted:
        for term in Add.make_args(sympify(energies.called(function, s, m))):
            try:
                measured = units.measure(term, known)
            except UnitError as error:
                found.append((name, term, f"it is or contains {error}"))
                continue
            if measured != unit and term != 0:
                found.append((name, term, f"it is in {measured}, and what it is a term of in {unit}"))
    return found
