"""Printed equations beside what the energies give, part by part."""

from dataclasses import dataclass, replace
from typing import List

from ..normal import scales
from ..normal.division import common


@dataclass
class Comparison:
    """A printed equation beside what the energies give: the ordinals of the terms that agree, that
    differ, and that are idle (nothing derived is like them, but they cancel one another), the derived terms that no printed term covers,
    `difference`, printed minus derived with the
    constant that makes it smallest (and with each of the constants that an equation may be
    multiplied by), of a sign rule its orientation and what its terms are multiplied by, and `scale`, what
    an equation of motion must be multiplied by to be that of the energies, or, where it is `solved`, to be
    the acceleration minus what gives it. Differences are multiplied by `clear`, with which no divisor is left."""

    number: str
    agree: List[int]
    differ: List[int]
    idle: List[int]
    absent: list
    difference: object
    differences: list
    orientation: int
    weight: object
    scale: object
    clear: object
    solved: bool = False

    def terms(self):
        """Number of printed terms."""
        return len(self.agree) + len(self.differ) + len(self.idle)


def compare(subject, motion, number):
    """Judgement 3 for one equation, or None where the energies say nothing about it. A term
    agrees if some of its parts are derived, and none occurs in the difference of printed and derived."""
    key = ("compare", number, motion)
    if key not in subject.memo:
        subject.memo[key] = _compare(subject, motion, number)
    return subject.memo[key]


def _compare(subject, motion, number):
    equation = subject.paper.equations[number]
    reference = motion.reference(equation)
    if reference is None:
        return None
    forms, one = subject.forms[number], subject.ring.number(1)
    if equation.kind == "motion":
        return _motion(subject, motion, equation, forms, reference)
    orientation, weight = 1, one
    if equation.kind == "rule":
        # the reference is positive where the state is +1; only the sign counts: the printed sum may
        # be the derived one over a positive factor
        orientation = equation.result * (1 if equation.relation == ">" else -1)
        total = sum(forms, subject.ring.number(0))
        weight = min([one * orientation, motion.scale(number) * orientation], key=lambda w: len((w * total - reference).terms))
    found = _beside(number, [form * weight for form in forms], reference, [one], one)
    found.orientation, found.weight = orientation, weight
    return found


def _motion(subject, motion, equation, forms, reference):
    """An equation of motion: as it is, over what it was divided by, or solved for its acceleration. An equation
    of which a term agrees as it stands was not divided."""
    number, factors, total = equation.number, subject.factors(), subject.total(equation.number)
    scale = subject.scales.get(number, factors[0])
    moving = ["dd" + name for name in subject.paper.coordinates()]
    plain = _beside(number, forms, reference, factors, factors[0])
    if scale == factors[0] and (plain.agree or not plain.difference):
        return plain
    # divided by something: by what, the energies say better than dimensions
    candidates = []
    slopes = [(total.diff(name), reference.diff(name), name) for name in moving]
    # and what is multiplied by the same rate shows it as well
    rates = [(total.diff(name), reference.diff(name)) for name in ("d" + name for name in subject.paper.coordinates())]
    candidates += [ratio for printed, derived, _ in slopes for ratio in scales.ratios(printed, derived)]
    candidates += [derived * printed.inverse() for printed, derived, _ in slopes if printed and derived
                   and not printed.names() & subject.ring.involutions]
    ratios = [derived * printed.inverse() for printed, derived in rates if printed and derived and not printed.names() & subject.ring.involutions]
    candidates += [ratio for ratio in ratios if not ratio.is_number() and not ratio.names() - subject.ring.first.keys()]
    found = [_beside(number, forms, reference, factors, ratio) for ratio in dict.fromkeys([scale, *candidates])]
    own = total.diff("dd" + equation.of)
    alone = [name for printed, _, name in slopes if printed] in (["dd" + equation.of], [])
    if alone and any(derived for _, derived, name in slopes if name != "dd" + equation.of):
        solved = motion.solved(equation.of)
        ratios = [scale * 0 + 1, *([own.inverse()] if own else [])]
        if own and not own.is_number():
            # an acceleration that stands by itself has no other factor
            ratios += [ratio.inverse() for ratio in scales.ratios(solved.numerator(), total.numerator())]
        found = [] if subject.solved else found
        found += [replace(_beside(number, forms, solved, factors, ratio), solved=True) for ratio in dict.fromkeys(ratios)]
    best = min(found, key=_left)
    # where no term agrees with it nothing was divided, and what differs is a slip
    return best if best.agree or best.solved or not best.difference or scale != factors[0] else plain


def _left(comparison):
    """How much differs."""
    return len(comparison.difference.terms)


def _beside(number, forms, reference, factors, scale):
    """The comparison for one scale."""
    if scale != factors[0]:
        reference = reference * scale.inverse()
    clear = common([*forms, reference])
    if clear.terms != factors[0].terms:
        forms, reference = [form * clear for form in forms], reference * clear
    total = sum(forms, factors[0] * 0)
    differences = [total - factor * reference for factor in factors]
    least = min(range(len(factors)), key=lambda k: len(differences[k].terms))
    difference, derived = differences[least], (factors[least] * reference).terms
    differ = [i for i, form in enumerate(forms) if form.terms.keys() & difference.terms.keys()]
    printed = set().union(*(form.terms for form in forms))
    absent = [clear.ring.form({key: derived[key]}) for key in difference.terms if key in derived and key not in printed]
    idle = [i for i, form in enumerate(forms) if i not in differ and not form.terms.keys() & derived.keys()]
    agree = [i for i in range(len(forms)) if i not in differ and i not in idle]
    return Comparison(number, agree, differ, idle, absent, difference, differences, 1, factors[0], scale, clear)
