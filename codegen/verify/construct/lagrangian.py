"""A Lagrangian of equations of motion whose Helmholtz conditions hold.

The mass matrix gives the part of second degree in the rates. What is left of the equations is then linear in
them: its skew matrix is the curl of a vector potential, its rest a gradient, and both are integrated along
the axes of the coordinates, one after the other (Poincare's lemma, by homotopy along the axes instead of
along rays: a ray from zero would leave the class of trigonometric polynomials, or start in a pole). The
result is proved: Lagrange's equations of it are the printed ones, an identity in normal form.

Helmholtz 1887; Santilli 1978, Foundations of Theoretical Mechanics I.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Dict, List

from ..normal.algebra import NotInClass
from .antiderivative import antiderivative

HALF = Fraction(1, 2)


@dataclass
class Lagrangian:
    """L = T + A - V in the class of the algebra: `kinetic` T has all that is of second degree in the rates of
    coordinates and inputs, `gyroscopic` A what is linear in the rates of the coordinates, `potential` V.
    `equations` names the printed equations that are Lagrange's equations of L, each times its multiplier;
    `chain` the rates of what moves."""

    kinetic: object
    gyroscopic: object
    potential: object
    coordinates: List[str]
    equations: List[str]
    chain: Dict[str, str]

    @property
    def whole(self):
        """T + A - V."""
        return self.kinetic + self.gyroscopic - self.potential

    def energy(self):
        """Jacobi's function, the sum of v dL/dv less L: T + V where no input moves (Jacobi 1866)."""
        whole = self.whole
        total = -whole
        for name in self.coordinates:
            total += whole.diff("d" + name) * whole.ring.symbol("d" + name)
        return total


def equations_of(lagrangian, chain, coordinates):
    """Lagrange's equations of a form."""
    return [lagrangian.diff("d" + n).rate(chain) - lagrangian.diff(n) for n in coordinates]


def motion_rows(subject, conservative=True):
    """(numbers, coordinates, rows): the equations of motion, each times its multiplier; with or without what
    is declared dissipative."""
    motions = subject.paper.motions()
    rows = [subject.multipliers[e.number] * (subject.conservative(e.number) if conservative else subject.total(e.number)) for e in motions]
    if subject.quasi:
        return [e.number for e in motions], subject.quasi.positions, subject.quasi.unprojected(subject.in_order(rows))
    return [e.number for e in motions], [e.of for e in motions], rows


def moving_chain(subject):
    """The rates of coordinates and inputs, up to those of accelerations."""
    chain = {}
    for x in subject.paper.symbols.values():
        if x.role in ("coordinate", "input"):
            chain.update({x.name: "d" + x.name, "d" + x.name: "dd" + x.name, "dd" + x.name: "ddd" + x.name})
    return chain


def construct(subject):
    """(Lagrangian, None), or (None, why there is none or none was found)."""
    numbers, q, rows = motion_rows(subject)
    if not rows:
        return None, "there are no equations of motion"
    if any(row.over for row in rows):
        return None, "none is looked for where an equation is divided by a sum"
    chain, ring = moving_chain(subject), subject.ring
    given = sorted(n for n in subject.paper.symbols if subject.paper.symbols[n].role in ("coordinate", "input") and n not in q)
    try:
        kinetic = _kinetic(ring, rows, q, given)
        left = [row - e for row, e in zip(rows, equations_of(kinetic, chain, q))]
        potential_vector = _vector_potential(ring, left, q)
        gyroscopic = sum((a * ring.symbol("d" + n) for a, n in zip(potential_vector, q)), ring.number(0))
        left = [e - part for e, part in zip(left, equations_of(gyroscopic, chain, q))]
        potential = ring.number(0)
        for name, force in zip(q, left):
            potential += antiderivative(force - potential.diff(name), name)
    except NotInClass as error:
        return None, f"none was found in closed form: {error}"
    # what moves the frame belongs to the kinetic energy
    rates = {"d" + n for n in given}
    moved = ring.form({key: value for key, value in potential.terms.items() if rates & {n for n, _ in key[0]}})
    result = Lagrangian(kinetic - moved, gyroscopic, potential - moved, q, numbers, chain)
    if any(row - e for row, e in zip(rows, equations_of(result.whole, chain, q))):
        return None, "the Helmholtz conditions do not hold, so that none exists with these equations, each times a constant"
    return result, None


def _kinetic(ring, rows, q, given):
    """The part of second degree whose accelerations the rows have."""
    total = ring.number(0)
    for i, row in zip(q, rows):
        for j in q:
            total += row.diff("dd" + j) * ring.symbol("d" + i) * ring.symbol("d" + j) * HALF
        for z in given:
            total += row.diff("dd" + z) * ring.symbol("d" + i) * ring.symbol("d" + z)
    return total


def _vector_potential(ring, left, q):
    """A with dA_i/dq_j - dA_j/dq_i equal to the velocity terms of what is left: the first coordinate has no
    component, and of the others what depends on it is integrated; then the next."""
    skew = {(i, j): left[i].diff("d" + q[j]) for i in range(len(q)) for j in range(len(q)) if i != j}
    found = [ring.number(0)] * len(q)
    for k, name in enumerate(q):
        for i in range(k + 1, len(q)):
            found[i] += antiderivative(skew[i, k] - (found[i].diff(name) - found[k].diff(q[i])), name)
    return found
