"""Small motions about rest, and the special cases that a paper does not name: what equations become there."""

from dataclasses import dataclass
from itertools import combinations
from typing import Dict, List

from ..judgements.definite import rest


@dataclass
class SmallMotion:
    """Equations to the first order in coordinates, rates and accelerations: `forces` what is left at rest (zero where
    rest is an equilibrium), and the matrices by accelerations, rates and coordinates."""

    coordinates: List[str]
    forces: List
    mass: List[List]
    damping: List[List]
    stiffness: List[List]

    def equation(self, k, ring):
        """What is zero: the terms of first order of the equation of one coordinate."""
        total = self.forces[k]
        for prefix, rows in (("dd", self.mass), ("d", self.damping), ("", self.stiffness)):
            total += sum((entry * ring.symbol(prefix + n) for n, entry in zip(self.coordinates, rows[k])), ring.number(0))
        return total


def small_motion(paper, rows, q):
    """The small motions of equations of motion about rest; None where an equation is divided by what is zero there."""
    zeros, _ = rest(paper)
    still = {d + n: 0 for n, x in paper.symbols.items() if x.role == "input" for d in ("", "d", "dd")}

    def matrix(prefix):
        return [[row.diff(prefix + n).substitute(zeros).substitute(still) for n in q] for row in rows]

    try:
        return SmallMotion(q, [row.substitute(zeros).substitute(still) for row in rows], matrix("dd"), matrix("d"), matrix(""))
    except ZeroDivisionError:
        return None


def special_cases(paper) -> Dict[str, Dict[str, object]]:
    """The special cases of a paper, and those that every paper has: a coordinate that stays at zero, two masses (two parameters of one unit and one first letter) that are the same."""
    cases = dict(paper.special)
    known = [_pairs(values) for values in cases.values()]

    def add(name, values):
        if _pairs(values) not in known:
            cases.setdefault(name, values)

    for name in paper.positions():
        if {name: 0} not in paper.special.values():
            add(f"{name} = 0 throughout", {name: 0, "d" + name: 0, "dd" + name: 0})
    parameters = [x for n, x in paper.symbols.items() if x.role == "parameter" and n not in paper.definitions]
    for first, second in combinations(parameters, 2):
        if first.unit == second.unit and first.name[0] == second.name[0]:
            add(f"{first.name} = {second.name}", {first.name: second.name})
    return cases


def _pairs(values):
    """What a special case sets equal, whichever of two names is put for the other."""
    return {frozenset((name, str(value))) for name, value in values.items()}
