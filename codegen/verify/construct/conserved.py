"""Conserved quantities of first and second degree in the rates, beside the energy and the momenta of cyclic
coordinates: those of the system without dissipation and given forces, its inputs at rest.

Looked for are multipliers of the equations, linear combinations (with coefficients in the field of the
parameters) of few functions of the coordinates, times one rate for the second degree, with which the sum of
the equations is a time derivative. That is a linear system, and a vector of its null space is proved to be
one. What is not found may still exist with other multipliers.

Noether 1918 (first degree); Whittaker 1904, Analytical Dynamics, article 152 (second).
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, product
from typing import List

from .lagrangian import motion_rows
from .nullspace import depends, null_vectors

HALF = Fraction(1, 2)

# Coordinates up to which each degree is looked for: the unknowns are n (2n + 1) and n^2 (2n + 1) functions and
# more, and beyond these numbers they are hundreds, which takes minutes.
FIRST, SECOND = 6, 3


@dataclass
class Conserved:
    """A conserved quantity, `degree` in the rates, and the `factors` with which the sum of the equations of motion
    (conservative, each times its multiplier, inputs at rest) is its time derivative."""

    quantity: object
    degree: int
    factors: List


def conserved(subject, lagrangian) -> List[Conserved]:
    """Conserved quantities that do not follow from the energy and one another."""
    ring, q = subject.ring, lagrangian.coordinates
    still = {d + n: 0 for n in lagrangian.chain if n not in q and not n.startswith("d") for d in ("", "d", "dd")}
    try:
        rows = [row.substitute(still) for row in motion_rows(subject)[2]]
    except ZeroDivisionError:  # the equations are divided by an input
        return []
    chain = {d + n: "d" + d + n for n in q for d in ("", "d")}
    potential = lagrangian.potential.substitute(still)
    known, found = [ring.number(1), lagrangian.energy().substitute(still)], []
    for degree, limit in ((1, FIRST), (2, SECOND)):
        if len(q) <= limit:
            for candidate in _of_degree(degree, ring, rows, q, chain, potential, known):
                if not depends(candidate.quantity, known):
                    found.append(candidate)
                    known.append(candidate.quantity)
        known += [a.quantity * b.quantity for a, b in combinations_with_replacement(found, 2)]
    return found


def _of_degree(degree, ring, rows, q, chain, potential, known):
    """The conserved quantities in the span of the trials, one for each vector of the null space."""
    functions, zero = _functions(ring, rows, q), ring.number(0)
    trials = []
    for i, function in product(range(len(q)), functions):
        for rate in [ring.symbol("d" + n) for n in q] if degree == 2 else [ring.number(1)]:
            factors = [function * rate if k == i else zero for k in range(len(q))]
            trials.append((factors, _quantity(ring, factors, rows, q, degree)))
    trials += [([zero] * len(q), f) for f in _free(ring, potential, functions, degree, q)]
    left = [_sum(zero, factors, rows) - quantity.rate(chain) for factors, quantity in trials]
    for vector in null_vectors(left, [quantity for _, quantity in trials], known):
        quantity = _sum(zero, vector, [t[1] for t in trials])
        factors = [_sum(zero, vector, [t[0][k] for t in trials]) for k in range(len(q))]
        if _sum(zero, factors, rows) - quantity.rate(chain):
            raise ArithmeticError("a vector of the null space leaves something over")
        yield Conserved(quantity, degree, factors)


def _sum(zero, factors, forms):
    return sum((c * form for c, form in zip(factors, forms) if c), zero)


def _quantity(ring, factors, rows, q, degree):
    """What has the derivatives by the rates that the accelerations in the sum ask for."""
    total = ring.number(0)
    for j in q:
        momentum = _sum(ring.number(0), factors, [row.diff("dd" + j) for row in rows])
        total += momentum * ring.symbol("d" + j) * (1 if degree == 1 else HALF)
    return total


def _functions(ring, rows, q):
    """1, and of each coordinate itself or, where it is an angle in the equations, its sine and cosine."""
    harmonics = {n for row in rows for _, (_, angle) in row.terms for n, _ in angle}
    result = [ring.number(1)]
    for name in q:
        result += [ring.harmonic(kind, {name: 1}) for kind in ("sin", "cos")] if name in harmonics else [ring.symbol(name)]
    return result


def _free(ring, potential, functions, degree, q):
    """Functions of the coordinates that a quantity may have besides: of the first degree, those themselves;
    of the second, also their products, and the parts of the potential times them."""
    trials = list(functions)
    if degree == 2:
        trials = [f * g for f, g in combinations_with_replacement(functions, 2)]
        parts = {(tuple(item for item in monomial if item[0] in q), harmonic): Fraction(1) for monomial, harmonic in potential.terms}
        trials += [ring.form({key: value}) * f for key, value in parts.items() for f in functions]
    forms = dict.fromkeys(ring.form({key: Fraction(1)}) for form in trials for key in form.terms)
    return [form for form in forms if form.names() & set(q)]
