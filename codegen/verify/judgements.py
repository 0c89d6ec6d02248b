"""Five of the six judgements on printed equations; definite.py has the sixth.

Each takes a `Subject` and returns its violations. Each is exact: a violation is a non-zero
normal form, and none means that the identity is proved, where the judgement has something to
judge by: `unjudged` says where it has not.
"""

from dataclasses import dataclass, field
from fractions import Fraction
from itertools import product
from typing import List, Tuple

from . import scales, units
from .algebra import Opaque
from .comparison import compare

TITLES = {
    "dimensions": "Dimensions of each term",
    "lagrangian": "Symmetric mass matrix and Helmholtz conditions",
    "difference": "Term by term against the energies",
    "mirror": "Mirror symmetry",
    "galilei": "Galilean invariance",
    "definite": "Positive definite kinetic energy at rest",
}


@dataclass
class Violation:
    """What one judgement objects to: equation numbers, ordinals of the terms to blame (from 0,
    within the first equation; empty if the whole is to blame) and the message, a list of strings
    and normal forms. `missing` lists what a lost term may have been: (equation number, form)."""

    judgement: str
    equations: Tuple[str, ...]
    terms: Tuple[int, ...]
    message: list
    missing: list = field(default_factory=list)


def dimensions(subject, motion=None) -> List[Violation]:
    """Judgement 1: every term of an equation has the unit of the equation."""
    symbols = subject.paper.symbols

    def judge(number):
        equation, found, violations = subject.paper.equations[number], [], []
        for term in subject.expressions[number]:
            try:
                found.append(units.measure(term, subject.dimension))
            except units.UnitError as error:
                found.append(error)
        if equation.kind == "motion":
            scale = scales.measure(subject, subject.scales[number])
            expected = scales.expected(subject, equation).times(scale, -1)
        elif equation.kind == "value":
            expected = units.parse(symbols[equation.of].unit)
        elif equation.kind == "reset":
            expected = subject.dimension["d" + equation.of]
        else:
            # an error is no dimension: terms that are wrong in the same way do not agree
            readable = [x for x in found if not isinstance(x, units.UnitError)]
            expected = max(readable, key=readable.count, default=None)
        for index, dimension in enumerate(found):
            if subject.expressions[number][index] == 0:
                continue  # zero is of every dimension
            if isinstance(dimension, units.UnitError):
                violations.append(Violation("dimensions", (number,), (index,), [
                    "the term ", subject.forms[number][index], f" has no dimension: it is or contains {dimension}"]))
            elif dimension != expected:
                violations.append(Violation("dimensions", (number,), (index,), [
                    "the term ", subject.forms[number][index], f" is in {dimension}, the equation in {expected}"]))
        return violations

    return subject.each("dimensions", judge)


def lagrangian(subject, motion=None) -> List[Violation]:
    """Judgement 2: the Helmholtz conditions on the part that is not dissipative. They hold
    exactly if some Lagrangian has these equations of motion, each multiplied by its constant."""
    motions = subject.paper.motions()
    rows = [subject.multipliers[e.number] * subject.conservative(e.number) for e in motions]
    q = [e.of for e in motions]
    inputs = [x.name for x in subject.paper.symbols.values() if x.role == "input"]
    chain = {}
    for name in q + inputs:
        chain.update({name: "d" + name, "d" + name: "dd" + name, "dd" + name: "ddd" + name})
    a = [[row.diff("dd" + name) for name in q] for row in rows]
    v = [[row.diff("d" + name) for name in q] for row in rows]
    x = [[row.diff(name) for name in q] for row in rows]
    violations = []

    def report(i, j, what, form, *missing):
        # each equation's own terms are what is printed, before it was multiplied by its constant
        lost = [(motions[k].number, subject.multipliers[motions[k].number].inverse() * f) for k, f in missing]
        violations.append(Violation("lagrangian", (motions[i].number, motions[j].number), (), [what, form], lost))

    def acceleration(k):
        return subject.ring.symbol("dd" + q[k])

    for e, row in zip(motions, rows):
        violations += _outside(subject, e, row)
    for i, j in product(range(len(q)), repeat=2):
        number_i, number_j = motions[i].number, motions[j].number
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


def difference(subject, motion) -> List[Violation]:
    """Judgement 3: every term against the equations derived from the energies."""
    def judge(number):
        violations = []
        comparison = motion and compare(subject, motion, number)
        if not comparison:
            return violations
        for index in comparison.differ:
            violations.append(Violation("difference", (number,), (index,), [
                "the energies do not give ", subject.forms[number][index]]))
        for form in comparison.absent:
            violations.append(Violation("difference", (number,), (), ["the energies give also ", form]))
        return violations

    return subject.each("difference", judge, motion)


def mirror(subject, motion=None) -> List[Violation]:
    """Judgement 4: in the mirror image each term of an equation takes the same sign, that of the
    coordinate or symbol that the equation is for."""
    symbols = subject.paper.symbols
    flip = {}
    for symbol in symbols.values():
        if symbol.mirror == -1:
            moving = symbol.role in ("coordinate", "input")
            for name in [symbol.name] + (["d" + symbol.name, "dd" + symbol.name] if moving else []):
                flip[name] = -subject.ring.symbol(name)
    if not flip:
        return []

    def judge(number):
        equation, violations = subject.paper.equations[number], []
        images = [form.substitute(flip) for form in subject.forms[number]]
        signs = [1 if image == form else -1 if image == -form else 0 for form, image in zip(subject.forms[number], images)]
        if equation.kind == "motion":
            # an equation may have been multiplied by lambda: the majority decides its sign
            expected = max((symbols[equation.of].mirror, -symbols[equation.of].mirror), key=signs.count)
        elif equation.kind == "condition":
            expected = 1
        else:
            expected = symbols[equation.of].mirror
        for index, (form, sign) in enumerate(zip(subject.forms[number], signs)):
            if form and sign != expected:
                change = {1: "keeps its sign", -1: "changes its sign", 0: "becomes another term"}[sign]
                violations.append(Violation("mirror", (number,), (index,), [
                    "in the mirror image ", form, f" {change}, against the rest of the equation"]))
        return violations

    return subject.each("mirror", judge)


def galilei(subject, motion=None) -> List[Violation]:
    """Judgement 5: a coordinate and the ground's displacement enter as their sum, and neither
    that sum nor its rate exerts a force. Friction, which acts on the slip alone, is left out."""
    if subject.paper.translation is None:
        return []
    x, z = subject.paper.translation
    ring = subject.ring
    shift = ring.symbol("(shift)")
    swap = {"dd" + x: ring.symbol("dd" + x) + shift, "dd" + z: ring.symbol("dd" + z) - shift}
    dissipative = {s.name: 0 for s in subject.paper.symbols.values() if s.dissipative}

    def judge(number):
        equation, violations = subject.paper.equations[number], []
        if equation.kind == "reset":
            return violations
        forms = [form.substitute(dissipative) for form in subject.forms[number]]
        total = subject.conservative(number)
        for name, what in ((x, "displacement"), (z, "displacement"), ("d" + x, "velocity"), ("d" + z, "velocity")):
            # the velocity of the slip may stand in a sign: friction knows it
            moved = {name: ring.symbol(name) + shift}
            if total.diff(name) if name == "d" + x else total.substitute(moved) != total:
                blame = tuple(i for i, form in enumerate(forms) if form.substitute(moved) != form)
                violations.append(Violation("galilei", (number,), blame, [
                    f"a constant {what} added to that of the ground and tank changes ", total - total.substitute({name: 0})]))
        left = total.substitute(swap) - total
        if left and ("dd" + x in total.names() or equation.kind != "value"):
            excess = left.coefficient("(shift)")
            violations.append(Violation("galilei", (number,), (), [
                f"the accelerations of {x} and {z} do not enter as their sum; the factor of dd{x} less that of dd{z} is ",
                excess or "not a number"], [(number, excess * ring.symbol("dd" + z)), (number, -excess * ring.symbol("dd" + x))]))
        return violations

    return subject.each("galilei", judge)


def unjudged(subject, motion):
    """For each judgement that has nothing to judge by, why: its silence says nothing."""
    paper, reasons = subject.paper, {}
    if not paper.motions():
        reasons["lagrangian"] = reasons["definite"] = "there are no equations of motion"
        if any(equation.momentum for equation in paper.equations.values()):
            del reasons["lagrangian"]
    elif not paper.sets:
        reasons["definite"] = "the paper has no parameter sets"
    if motion is None:
        reasons["difference"] = "no energies are given"
    elif all(motion.reference(equation) is None for equation in paper.equations.values()):
        reasons["difference"] = "the energies say nothing about any equation"
    if all(symbol.mirror == 1 for symbol in paper.symbols.values()):
        reasons["mirror"] = "no symbol is declared to change its sign in the mirror image"
    if paper.translation is None:
        reasons["galilei"] = "no translation is declared"
    return reasons


def unreferenced(subject, motion):
    """Numbers of the equations that the energies say nothing about."""
    return [n for n, equation in subject.paper.equations.items() if motion is None or motion.reference(equation) is None]


FIVE = {"dimensions": dimensions, "lagrangian": lagrangian, "difference": difference, "mirror": mirror, "galilei": galilei}
