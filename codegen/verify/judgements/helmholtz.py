"""Judgement 2: whether some Lagrangian has the printed equations (Helmholtz 1887)."""

from fractions import Fraction
from itertools import product
from typing import List

from ..normal.algebra import Opaque
from .violation import Violation


def lagrangian(subject, motion=None) -> List[Violation]:
    """Judgement 2: the Helmholtz conditions on the part that is not dissipative. They hold
    exactly if some Lagrangian has these equations of motion, each multiplied by its constant."""
    motions = [] if subject.solved else subject.paper.motions()
    rows = [subject.multipliers[e.number] * subject.conservative(e.number) for e in motions]
    q = [e.of for e in motions]
    numbers = [(e.number,) for e in motions]
    if subject.quasi:
        # of the coordinates' equations each is a sum of all that are printed
        if len(motions) != len(subject.paper.coordinates()):
            return []
        q, numbers = subject.quasi.positions, [tuple(e.number for e in motions)] * len(motions)
        outside = [v for e, row in zip(motions, rows) for v in _outside(subject, e, row)]
        rows = subject.quasi.unprojected(subject.in_order(rows))
    inputs = [x.name for x in subject.paper.symbols.values() if x.role == "input"]
    chain = {}
    # a coordinate without an equation of its own moves too
    for name in dict.fromkeys(q + subject.paper.coordinates() + inputs):
        chain.update({name: "d" + name, "d" + name: "dd" + name, "dd" + name: "ddd" + name})
    a = [[row.diff("dd" + name) for name in q] for row in rows]
    v = [[row.diff("d" + name) for name in q] for row in rows]
    x = [[row.diff(name) for name in q] for row in rows]
    violations = []

    def report(i, j, what, form, *missing):
        # each equation's own terms are what is printed, before it was multiplied by its constant
        lost = [] if subject.quasi else [(motions[k].number, subject.multipliers[motions[k].number].inverse() * f) for k, f in missing]
        violations.append(Violation("lagrangian", numbers[i] + numbers[j] if not subject.quasi else numbers[i], (), [what, form], lost))

    def acceleration(k):
        return subject.ring.symbol("dd" + q[k])

    violations += outside if subject.quasi else [v for e, row in zip(motions, rows) for v in _outside(subject, e, row)]
    for i, j in product(range(len(q)), repeat=2):
        number_i, number_j = ("that of " + q[k] if subject.quasi else motions[k].number for k in (i, j))
        for name in q:
            if a[i][j].diff("dd" + name):
                report(i, j, f"({number_i}) is not linear in the accelerations: ", a[i][j])
        if j < i and (form := a[i][j] - a[j][i]):
            report(i, j, f"the mass matrix is not symmetric: acceleration of {q[j]} in ({number_i}) minus "
                         f"acceleration of {q[i]} in ({number_j}) leaves ", form,
                   (i, -form * acceleration(j)), (j, form * acceleration(i)))
        if j <= i and (form := v[i][j] + v[j][i] - (a[i][j] + a[j][i]).rate(chain)):
            report(i, j, f"the velocity terms of ({number_i}) and ({number_j}) do not belong to their mass "
                         "matrix; left over: ", form,
                   *[(k, _integral(form * Fraction(-1, 1 + (i == j)), "d" + q[l])) for k, l in ((i, j), (j, i))])
        if j < i and (form := x[i][j] - x[j][i] - (v[i][j] - v[j][i]).rate(chain) * Fraction(1, 2)):
            report(i, j, f"the terms of ({number_i}) in {q[j]} and of ({number_j}) in {q[i]} do not come from one "
                         "energy; left over: ", form)
    for number, equation in subject.paper.equations.items():
        if equation.momentum:
            violations += _momentum(subject, number, q, chain)
    return violations


def _integral(form, name):
    """A form with this derivative by `name`, which is a factor, not an angle."""
    total = form.ring.number(0)
    for (monomial, harmonic), value in form.terms.items():
        power = dict(monomial).get(name, 0)
        total += form.ring.form({(monomial, harmonic): Fraction(value) / (power + 1)}) * form.ring.symbol(name)
    return total


def _outside(subject, equation, row):
    """What the Helmholtz conditions cannot judge and no Lagrangian gives: a sign or modulus of what
    moves (its derivative is not a function), and a force that is given elsewhere."""
    violations = []
    moving = {d + x.name for x in subject.paper.symbols.values() if x.role in ("coordinate", "input") for d in ("d", "dd")}
    for name in sorted({n for monomial, _ in row.terms for n, _ in monomial if isinstance(n, Opaque)}, key=str):
        if moving & name.argument.names():
            violations.append(Violation("lagrangian", (equation.number,), _holding(subject, equation.number, name), [
                f"no Lagrangian gives ({equation.number}) the factor ", row.ring.symbol(name), "; what is dissipative is declared so"]))
    for name in sorted(row.names()):
        symbol = subject.paper.symbols.get(name)
        if symbol and symbol.role == "force":
            violations.append(Violation("lagrangian", (equation.number,), _holding(subject, equation.number, name), [
                f"({equation.number}) contains the force {name}, which may depend on anything: put in what it is, or declare it "
                "dissipative"]))
    return violations


def _holding(subject, number, name):
    """Ordinals of the terms that contain a name or an opaque factor."""
    def holds(form):
        return name in form.names() or any(n == name for monomial, _ in form.terms for n, _ in monomial)

    return tuple(k for k, form in enumerate(subject.forms[number]) if holds(form))


def _momentum(subject, number, q, chain):
    """The Helmholtz conditions of a reaction of a translation of the whole system. No other
    equation depends on its displacement or velocity, so they concern its own terms only. A sign
    that multiplies all terms alike (that of friction) is a constant here; another is no momentum."""
    total = subject.total(number)
    violations = []
    moving = set(chain) | set(chain.values())
    opaque = [{n for n, _ in monomial if isinstance(n, Opaque) and moving & n.argument.names()} for monomial, _ in total.terms]
    if opaque and any(x != opaque[0] or any(n.function != "sign" for n in x) for x in opaque):
        violations.append(Violation("lagrangian", (number,), (), [
            f"({number}) is not the rate of a momentum: a sign or modulus of what moves multiplies some of its terms only"]))
    for name in q:
        velocity, mass = total.diff("d" + name), total.diff("dd" + name)
        if form := velocity - mass.rate(chain) * 2:
            violations.append(Violation("lagrangian", (number,), (), [
                f"({number}) is not the rate of a momentum: its terms in the velocity of {name} do not belong to those in "
                "the acceleration; left over: ", form], [(number, _integral(-form, "d" + name))]))
        if form := total.diff(name) - velocity.rate(chain) * Fraction(1, 2):
            violations.append(Violation("lagrangian", (number,), (), [
                f"({number}) is not the rate of a momentum: its terms in {name} do not belong to those in the velocities; "
                "left over: ", form]))
    return violations
