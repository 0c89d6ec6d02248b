"""Frequencies of small undamped motions about rest: the roots of det(K - w M) = 0, where w is the square of a frequency in rad/s;
a negative one belongs to a motion that grows."""

import math
from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import Dict, List

from mpmath import eig, matrix, mpc, mpf

from ..judgements.definite import rest, states
from ..normal.matrices import determinant
from .lagrangian import motion_rows
from .small import small_motion

# characteristic polynomials of more coordinates are not read any more
SHOWN = 2


@dataclass
class Frequencies:
    """`polynomial` has the coefficients of the powers of w in det(K - w M), of up to SHOWN coordinates; `values` the roots w in
    rad^2/s^2 in rising order, by parameter set and state."""

    coordinates: List[str]
    polynomial: List
    values: Dict[str, List[float]]


def frequencies(subject):
    """The frequencies of the conservative part of the equations of motion, or None: rest is no equilibrium, or there are gyroscopic terms."""
    _, q, rows = motion_rows(subject)
    paper = subject.paper
    forces = {n: 0 for n, x in paper.symbols.items() if x.role == "force"}
    rows = [row.substitute(forces) for row in rows]
    if any(row.over for row in rows):
        return None
    small = small_motion(paper, rows, q)
    if small is None or any(small.forces) or any(entry for line in small.damping for entry in line):
        return None
    if any(n in paper.positions() for form in small.mass + small.stiffness for entry in form for n in entry.names()):
        return None
    polynomial = []
    if len(q) <= SHOWN:
        w = subject.ring.symbol("(w)")
        whole = determinant([[k - w * m for k, m in zip(*lines)] for lines in zip(small.stiffness, small.mass)])
        for power in range(len(q) + 1):
            polynomial.append(whole.substitute({"(w)": 0}) * Fraction(1, factorial(power)))
            whole = whole.diff("(w)")
    values = {}
    for name, numbers in paper.sets.items():
        for state in states(paper, [entry for line in small.mass + small.stiffness for entry in line]):
            given = {**{n: float(v) for n, v in numbers.items()}, **rest(paper)[1], **state}
            mass, stiffness = (matrix([[entry.evaluate(given, math.sin, math.cos, mpf(0)) for entry in line] for line in lines])
                               for lines in (small.mass, small.stiffness))
            try:
                whole = mass**-1 * stiffness
            except ZeroDivisionError:
                continue  # without inertia there is no frequency
            key = ", ".join([name] + [f"{n} = {v:+d}" for n, v in state.items()])
            roots = eig(whole, left=False, right=False) if len(q) > 1 else [whole[0]]
            values[key] = sorted(float(mpc(root).real) for root in roots)
    return Frequencies(q, polynomial, values)
