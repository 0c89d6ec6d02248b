"""Printed equations beside what the energies give, part by part."""

from dataclasses import dataclass
from typing import List

from ..normal import scales


@dataclass
class Comparison:
    """A printed equation beside what the energies give: the ordinals of the terms that agree, that
    differ, and that are idle (nothing derived is like them, but they cancel one another), the derived terms that no printed term covers, printed minus derived with the
    constant that makes it smallest (and with each of the constants that an equation may be
    multiplied by), of a sign rule its orientation and what its terms are multiplied by, and what
    an equation of motion must be multiplied by to be that of the energies."""

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
    forms, orientation = subject.forms[number], 1
    weights = [subject.ring.number(1)]
    if equation.kind == "rule":
        # the reference is positive where the state is +1; only the sign counts: the printed sum may
        # be the derived one over a positive factor
        orientation = equation.result * (1 if equation.relation == ">" else -1)
        weights = [subject.ring.number(orientation), motion.scale(number) * orientation]
    total = sum(forms, subject.ring.number(0))
    weight = min(weights, key=lambda w: len((w * total - reference).terms))
    forms, total = [form * weight for form in forms], total * weight
    factors = subject.factors() if equation.kind == "motion" else [subject.ring.number(1)]
    scale = subject.scales.get(number, factors[0])
    if scale != factors[0]:
        # divided by something: by what, the energies say better than dimensions
        moving = ["dd" + name for name in subject.paper.coordinates()]
        found = [ratio for name in moving for ratio in scales.ratios(total.diff(name), reference.diff(name))]
        scale = min([*dict.fromkeys(found), scale],
                    key=lambda r: min(len((total * r - factor * reference).terms) for factor in factors))
        reference = reference * scale.inverse()
    differences = [total - factor * reference for factor in factors]
    least = min(range(len(factors)), key=lambda k: len(differences[k].terms))
    difference, derived = differences[least], (factors[least] * reference).terms
    differ = [i for i, form in enumerate(forms) if form.terms.keys() & difference.terms.keys()]
    printed = set().union(*(form.terms for form in forms))
    absent = [subject.ring.form({key: derived[key]}) for key in difference.terms if key in derived and key not in printed]
    idle = [i for i, form in enumerate(forms) if i not in differ and not form.terms.keys() & derived.keys()]
    agree = [i for i in range(len(forms)) if i not in differ and i not in idle]
    return Comparison(number, agree, differ, idle, absent, difference, differences,
                      orientation, weight, scale)
