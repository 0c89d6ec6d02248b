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
    inputs = [x.name for x in subject.paper.symbols.values() if x.role == "input"]
    # a coordinate without an equation of its own moves too
    q = subject.quasi.positions if subject.quasi else [e.of for e in motions]
    chain = {}
    for name in dict.fromkeys(q + subject.paper.coordinates() + inputs):
        chain.update({name: "d" + name, "d" + name: "dd" + name, "dd" + name: "ddd" + name})
    if subject.quasi:
        # of the coordinates' equations each is a sum of all that are printed
        if len(motions) != len(subject.paper.coordinates()):
            return []
        rows = [subject.multipliers[e.number] * subject.conservative(e.number) for e in motions]
        violations = [v for e, row in zip(motions, rows) for v in _outside(subject, e, row)]
        numbers, lost = tuple(e.number for e in motions), lambda form: None
        rows = [_Row("that of " + name, name, q, row, lost) for name, row in zip(q, subject.quasi.unprojected(subject.in_order(rows)))]
        for i, j in product(range(len(q)), repeat=2):
            violations += _pair(rows[i], rows[j], numbers, j < i, i == j, chain)
    else:
        # what belongs to one equation or two is judged once, whatever is tried on the others
        scaled = [(e, subject.multipliers[e.number]) for e in motions]
        rows = [subject.remembered(("helmholtz row", e.number, scale), lambda e=e, scale=scale: _Row(
            e.number, e.of, q, scale * subject.conservative(e.number),
            # an equation's own terms are what is printed, before it was multiplied by its constant
            lambda form: (e.number, scale.inverse() * form))) for e, scale in scaled]
        violations = [v for row, (e, scale) in zip(rows, scaled) for v in subject.remembered(
            ("helmholtz outside", e.number, scale), lambda e=e, row=row: _outside(subject, e, row.form))]
        for i, j in product(range(len(q)), repeat=2):
            numbers = (motions[i].number, motions[j].number)
            key = ("helmholtz pair", numbers, j < i, scaled[i][1], scaled[j][1])
            violations += subject.remembered(key, lambda i=i, j=j, numbers=numbers: _pair(rows[i], rows[j], numbers, j < i, i == j, chain))
    for number, equation in subject.paper.equations.items():
        if equation.momentum:
            violations += subject.remembered(("momentum", number, tuple(q)), lambda number=number: _momentum(subject, number, q, chain))
    return violations


class _Row:
    """An equation of motion times its multiplier, with its slopes by accelerations, rates and coordinates: `name` what it is called,
    `lost(form)` says in which printed equation a form is missing (None: it cannot be said)."""

    def __init__(self, name, of, q, form, lost):
        self.name, self.of, self.form, self.lost = name, of, form, lost
        self.a, self.v, self.x = ({n: form.diff(d + n) for n in q} for d in ("dd", "d", ""))

    @property
    def acceleration(self):
        """The acceleration of its coordinate."""
        return self.form.ring.symbol("dd" + self.of)


def _pair(one, other, numbers, before, same, chain):
    """The violations of the Helmholtz conditions by two rows, of printed equations `numbers`: those that are symmetric once, where `other`
    stands `before`, and those of a row with itself where they are the `same`."""
    i, j, violations = one.of, other.of, []

    def report(what, form, *missing):
        lost = [found for row, f in missing if f is not None and (found := row.lost(f))]
        violations.append(Violation("lagrangian", numbers, (), [what, form], lost))

    for name in one.a:
        if one.a[j].diff("dd" + name):
            report(f"({one.name}) is not linear in the accelerations: ", one.a[j])
    if before and (form := one.a[j] - other.a[i]):
        report(f"the mass matrix is not symmetric: acceleration of {j} in ({one.name}) minus acceleration of {i} in ({other.name}) leaves ",
               form, (one, -form * other.acceleration), (other, form * one.acceleration))
    if (before or same) and (form := one.v[j] + other.v[i] - (one.a[j] + other.a[i]).rate(chain)):
        report(f"the velocity terms of ({one.name}) and ({other.name}) do not belong to their mass matrix; left over: ", form,
               *[(row, _integral(form * Fraction(-1, 1 + same), "d" + name)) for row, name in ((one, j), (other, i))])
    if before and (form := one.x[j] - other.x[i] - (one.v[j] - other.v[i]).rate(chain) * Fraction(1, 2)):
        report(f"the terms of ({one.name}) in {j} and of ({other.name}) in {i} do not come from one energy; left over: ", form)
    return violations


def _integral(form, name):
    """A form with this derivative by `name`, which is a factor, not an angle; None where that is a logarithm."""
    total = form.ring.number(0)
    for (monomial, harmonic), value in form.terms.items():
        power = dict(monomial).get(name, 0)
        if power == -1:
            return None  # a logarithm
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
                "the acceleration; left over: ", form], [] if (lost := _integral(-form, "d" + name)) is None else [(number, lost)]))
        if form := total.diff(name) - velocity.rate(chain) * Fraction(1, 2):
            violations.append(Violation("lagrangian", (number,), (), [
                f"({number}) is not the rate of a momentum: its terms in {name} do not belong to those in the velocities; "
                "left over: ", form]))
    return violations
