"""Small motions about rest. Without terms in the rates: the roots of det(K - w M) = 0, where w is the square of a frequency in rad/s;
a negative one belongs to a motion that grows. With them (damping, gyroscopic terms): the roots of det(s^2 M + s C + K) = 0."""

import math
from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import Dict, List

from mpmath import eig, matrix, mp, mpc, mpf

from ..judgements.definite import rest, states
from ..normal.algebra import Opaque
from ..normal.matrices import determinant
from .lagrangian import motion_rows
from .small import small_motion

# Digits in which roots s are computed, and the part of the largest that is taken for zero: far more than their rounding, and far
# less than any that parameters of double precision have.
DIGITS, ZERO = 30, mpf("1e-20")

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


def modes(subject) -> Dict[str, List[complex]]:
    """The roots s, 1/s, of motions exp(s t) of the equations of motion with all that is linear in the rates, by parameter set and state; of
    two that are conjugate that with the positive frequency. Empty: rest is no equilibrium, no term has a rate, or a sign or modulus of
    what moves is no linear term. Forces that are given by symbols, and inputs, are zero."""
    _, q, rows = motion_rows(subject, conservative=False)
    paper, result = subject.paper, {}
    rows = [row.substitute({n: 0 for n, x in paper.symbols.items() if x.role == "force"}) for row in rows]
    if any(row.over or any(isinstance(n, Opaque) for monomial, _ in row.terms for n, _ in monomial) for row in rows):
        return {}
    small = small_motion(paper, rows, q)
    if small is None or any(small.forces) or not any(entry for line in small.damping for entry in line):
        return {}
    if any(n in paper.positions() for form in small.mass + small.damping + small.stiffness for entry in form for n in entry.names()):
        return {}
    for name, numbers in paper.sets.items():
        for state in states(paper, [entry for form in (small.mass, small.damping, small.stiffness) for line in form for entry in line]):
            given = {**{n: mpf(str(v)) for n, v in numbers.items()}, **rest(paper)[1], **state}
            with mp.workdps(DIGITS):
                found = _roots(*([[mpf(entry.evaluate(given, mp.sin, mp.cos, mpf(0))) for entry in line] for line in lines]
                                 for lines in (small.mass, small.damping, small.stiffness)))
            if found is not None:
                result[", ".join([name] + [f"{n} = {v:+d}" for n, v in state.items()])] = found
    return result


def _roots(mass, damping, stiffness):
    """The roots of s^2 M + s C + K, those with a negative imaginary part left out; None where M is singular."""
    n = len(mass)
    try:
        inverse = matrix(mass) ** -1
    except ZeroDivisionError:
        return None
    whole = matrix(2 * n)
    for k, block in enumerate((inverse * matrix(stiffness), inverse * matrix(damping))):
        for i in range(n):
            whole[i, n + i] = mpf(1)
            for j in range(n):
                whole[n + i, k * n + j] = -block[i, j]
    roots = eig(whole, left=False, right=False)
    least = ZERO * max(map(abs, roots))
    real = lambda x: x if abs(x) > least else mpf(0)
    found = [complex(real(mpc(root).real), real(mpc(root).imag)) for root in roots]
    return sorted((root for root in found if root.imag >= 0), key=lambda s: (s.real, s.imag))
