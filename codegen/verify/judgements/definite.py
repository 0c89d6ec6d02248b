"""Judgement 6: the mass matrix is positive definite over the box of coordinates and parameters.

Signs are proved with interval arithmetic, never sampled; where one parameter decides, its critical
values are roots of the determinant in closed form.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Dict, List, Optional, Tuple

from ..normal.algebra import ONE, Opaque
from ..normal.intervals import intervals, known, signs
from ..normal.matrices import minors
from .angles import without_angles
from .singular import regular
from .violation import Violation

# A budget of some ten seconds. What is undecided by then lies at a point where the matrix is nearly
# singular; the verdict then says "undecided" and names the box.
BISECTIONS = 400

# Minors of more rows have too many terms to be multiplied out: 6 links take half a minute, 8 links hours. Pivots of
# intervals take no time, and prove less over large boxes.
MULTIPLIED_OUT = 4

HALF = Fraction(1, 2)


def printed_mass(subject, symmetric=False):
    """Mass matrix of the printed equations of motion, each times its constant; `symmetric` takes
    the symmetric part."""
    motions = subject.paper.motions()
    matrix = [[subject.multipliers[e.number] * subject.slope(e.number, "dd" + f.of) for f in motions] for e in motions]
    if not symmetric:
        return matrix
    return [[(matrix[i][j] + matrix[j][i]) * HALF for j in range(len(matrix))] for i in range(len(matrix))]


def states(paper, forms=None):
    """All combinations of the discrete states (of those that the forms contain), as dictionaries."""
    names = [x.name for x in paper.symbols.values() if x.role == "discrete"]
    if forms is not None:
        names = [n for n in names if any(n in form.names() for form in forms)]
    return [dict(zip(names, values)) for values in product((1, -1), repeat=len(names))]


def rest(paper):
    """Where the system rests, as (zeros, places): all coordinates and rates at zero, but for coordinates whose
    box has no zero in it, which stay; their places are the middles of their boxes. There zero is singular, or
    no position of the system."""
    places = {n: (low + high) / 2 for n, (low, high) in paper.box.items() if n in paper.positions() and not low <= 0 <= high}
    return {p + n: 0 for n in dict.fromkeys(paper.coordinates() + paper.positions()) for p in ("", "d", "dd") if p or n not in places}, places


@dataclass
class Verdict:
    """`status`: proved, refuted (`point` is a box or point where a leading minor is negative) or
    undecided (`point` is a box that could not be decided)."""

    status: str
    boxes: int
    point: Optional[Dict[str, Tuple[float, float]]] = None


def prove_matrix(matrix, fixed, box, limit=BISECTIONS, tell=None, factors=None) -> Verdict:
    """Whether a symmetric matrix is positive definite over a box, with the other values fixed; `tell` as in `prove`. Where one of
    the `factors` is zero (singular.py) it need not be, of up to MULTIPLIED_OUT rows."""
    if (constant := without_angles(matrix)) is not None and matrix != constant:
        # where this is not positive definite, the matrix may still be, if the box has no equal angles
        verdict = prove_matrix(constant, fixed, box, limit, tell, factors)
        if verdict.status == "proved":
            return verdict
    still = intervals({n: value for n, value in fixed.items() if n not in box})
    if len(matrix) <= MULTIPLIED_OUT:
        forms = [regular(form, factors)[0] for form in minors(matrix)] if factors else minors(matrix)
        known(intervals({**fixed, **box}), forms)
        return prove([_collected(form, still) for form in forms], fixed, box, limit, judge=_signs, tell=tell)
    known(intervals({**fixed, **box}), [form for row in matrix for form in row])
    return prove([[_collected(form, still) for form in row] for row in matrix], fixed, box, limit, judge=pivots, tell=tell, apart=False)


def _collected(form, still):
    """The parts of a form, [(what is constant in them, as an interval, the rest as a form)], each rest once. Of a harmonic the
    constant angles are constants too, sin(a + q) = cos a sin q + sin a cos q: where angles occur with many constant ones,
    little is left that moves, and its interval is narrower."""
    from mpmath import iv

    found = {}

    def add(constant, rest):
        rest = rest.divided(dict(form.over))
        found[rest] = found.get(rest, 0) + constant

    for (monomial, (kind, angle)), value in form.terms.items():
        constant = iv.mpf(value.numerator) / value.denominator
        for name, exponent in monomial:
            if name in still:
                constant = constant * still[name] ** exponent
        factor = form.ring.form({(tuple(item for item in monomial if item[0] not in still), ONE): 1})
        moving = {name: slope for name, slope in angle if name not in still}
        if len(moving) == len(angle):
            add(constant, factor * form.ring.harmonic(kind, moving))
            continue
        fixed = sum((still[name] * slope.numerator / slope.denominator for name, slope in angle if name in still), iv.mpf(0))
        other, sign = ("cos", 1) if kind == "sin" else ("sin", -1)
        for part, amount in ((kind, iv.cos(fixed)), (other, sign * iv.sin(fixed))):
            if harmonic := form.ring.harmonic(part, moving):
                add(constant * amount, factor * harmonic)
    return [(constant, rest) for rest, constant in found.items()]


def _signs(forms, values):
    """The signs of forms as `_collected` gives them over intervals by name: +1, -1 or 0 (not decided)."""
    harmonics, found = {}, []
    for form in forms:
        if _opaque(form):
            found.append(0)
            continue
        value = _value(form, values, harmonics)
        found.append(1 if value.a > 0 else -1 if value.b < 0 else 0)
    return found


def _value(form, values, harmonics):
    """The interval of a form as `_collected` gives it; `harmonics` as in `Form.evaluate`."""
    from mpmath import iv

    return sum((constant * rest.evaluate(values, iv.sin, iv.cos, iv.mpf(0), harmonics) for constant, rest in form), iv.mpf(0))


def _opaque(form):
    """Whether a form as `_collected` gives it has a factor that has no value."""
    return any(isinstance(name, Opaque) for _, rest in form for monomial, _ in rest.terms for name, _ in monomial)


def pivots(matrix, values):
    """The signs of the pivots of a symmetric matrix (entries as `_collected` gives them) over intervals by name: +1, -1 or 0 (not decided, as are all after one
    that is not positive). All are positive only where the matrix is positive definite, and the first that
    is not positive has the sign of its leading minor."""
    if any(_opaque(entry) for row in matrix for entry in row):
        return [0] * len(matrix)
    harmonics = {}
    rows = [[_value(entry, values, harmonics) for entry in row[:i + 1]] for i, row in enumerate(matrix)]
    found = []
    for k, row in enumerate(rows):
        pivot = row[k]
        found.append(1 if pivot.a > 0 else -1 if pivot.b < 0 else 0)
        if found[-1] != 1:
            return found + [0] * (len(rows) - k - 1)
        for i in range(k + 1, len(rows)):
            for j in range(k + 1, i + 1):
                rows[i][j] -= rows[i][k] * rows[j][k] / pivot if i != j else rows[i][k] ** 2 / pivot
    return found


def prove(forms, fixed, box, limit=BISECTIONS, judge=signs, tell=None, apart=True) -> Verdict:
    """Whether all forms are positive over a box {name: (low, high)} with the other values fixed; `judge(forms, values)`
    gives their signs over intervals, each by itself (`apart`: what is positive over a box is not judged again over its
    parts), `tell(done)` is told of each box that is judged."""
    fixed = intervals(fixed)
    queue, count = [(dict(box), forms)], 0
    while queue:
        part, left = queue.pop()
        count += 1
        if tell:
            tell(count)
        found = judge(left, {**fixed, **intervals(part)})
        if -1 in found:
            return Verdict("refuted", count, part)
        if all(sign == 1 for sign in found):
            continue
        if apart:
            left = [form for form, sign in zip(left, found) if sign != 1]
        middle = {n: ((low + high) / 2,) * 2 for n, (low, high) in part.items()}
        if -1 in judge(left, {**fixed, **intervals(middle)}):
            return Verdict("refuted", count, middle)
        widths = {n: (part[n][1] - part[n][0]) / (box[n][1] - box[n][0]) for n in part if box[n][1] > box[n][0]}
        if count >= limit or not widths:
            return Verdict("undecided", count, part)
        name = max(widths, key=widths.get)
        centre = middle[name][0]
        queue += [({**part, name: (part[name][0], centre)}, left), ({**part, name: (centre, part[name][1])}, left)]
    return Verdict("proved", count)


def definite(subject, motion=None) -> List[Violation]:
    """Violations where the symmetric part of the printed mass matrix is not positive definite at
    rest, for one of the paper's parameter sets."""
    if not subject.paper.sets or not subject.paper.motions() or subject.solved:
        return []
    zeros, _ = rest(subject.paper)
    matrix = printed_mass(subject, symmetric=True)
    try:
        matrix = matrix if subject.singular else [[form.substitute(zeros) for form in row] for row in matrix]
    except ZeroDivisionError:  # an equation was divided by what is zero at rest, or it is the pole of a coordinate
        return []
    key = ("definite", None, str(matrix))
    if key not in subject.memo:
        # all equations together may have been multiplied by a constant
        found = []
        for factor in subject.factors():
            forms = minors([[factor * form for form in row] for row in matrix])
            if subject.singular:
                forms = [regular(form, subject.singular)[0].substitute(zeros) for form in forms]
            found.append(_indefinite(subject, forms))
            if not found[-1]:
                break
        subject.memo[key] = [] if [] in found else found[0]
    return subject.memo[key]


def _indefinite(subject, forms):
    """Violations for each parameter set and state in which some leading minor is not positive."""
    violations = []
    numbers = tuple(e.number for e in subject.paper.motions())
    for (name, values), state in product(subject.paper.sets.items(), states(subject.paper)):
        found = signs(forms, intervals({**values, **rest(subject.paper)[1], **state}))
        if any(sign != 1 for sign in found):
            bad = next(k for k, sign in enumerate(found) if sign != 1)
            at = ", ".join([f"parameter set {name}"] + [f"{n} = {v:+d}" for n, v in state.items()])
            violations.append(Violation("definite", numbers, (), [
                f"the kinetic energy is not positive definite at rest ({at}): the leading minor {bad + 1} is not positive: ",
                forms[bad]]))
    return violations


@dataclass
class Critical:
    """Roots of a determinant in one parameter: `coefficients` are those of its powers 0, 1, 2 (as
    forms); `roots` are real roots by parameter set and state, or None where it is not real."""

    parameter: str
    determinant: object
    coefficients: list
    roots: Dict[str, List[float]]


def critical(form, parameter, paper) -> Optional[Critical]:
    """The critical values of a parameter in closed form, where the determinant is a polynomial of
    degree 1 or 2 in it; None otherwise."""
    powers = {dict(monomial).get(parameter, 0) for monomial, _ in form.terms}
    if not powers or not powers <= {0, 1, 2} or powers == {0}:
        return None
    first, second = form.diff(parameter), form.diff(parameter).diff(parameter)
    zero = {parameter: 0}
    coefficients = [form.substitute(zero), first.substitute(zero), second.substitute(zero) * HALF]
    roots = {}
    for (name, values), state in product(paper.sets.items(), states(paper, coefficients)):
        number = {**{n: float(v) for n, v in values.items()}, **rest(paper)[1], **state}
        c, b, a = (x.evaluate(number, math.sin, math.cos, 0.0) for x in coefficients)
        if a:
            square = b * b - 4 * a * c
            # the form without cancellation: the larger root first, the other from the product
            large = -(b + math.copysign(math.sqrt(square), b)) / 2 if square >= 0 else 0.0
            found = sorted({large / a, c / large}) if square >= 0 and large else [0.0] if square >= 0 else []
        else:
            found = [-c / b] if b else []
        found = [root + 0.0 for root in found]  # -0.0 prints as 0
        key = ", ".join([name] + [f"{n} = {v:+d}" for n, v in state.items()])
        roots[key] = found
    return Critical(parameter, form, coefficients, roots)
