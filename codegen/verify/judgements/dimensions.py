"""Judgement 1: dimensions."""

from typing import List

from ..errors import UnitError
from ..input import units
from ..normal import scales
from .violation import Violation


def dimensions(subject, motion=None) -> List[Violation]:
    """Judgement 1: every term of an equation has the unit of the equation."""
    symbols = subject.paper.symbols

    def judge(number):
        equation, found, violations = subject.paper.equations[number], [], []
        for term in subject.expressions[number]:
            try:
                found.append(subject.measure(term))
            except UnitError as error:
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
            readable = [x for x in found if not isinstance(x, UnitError)]
            expected = max(readable, key=readable.count, default=None)
        for index, dimension in enumerate(found):
            if subject.expressions[number][index] == 0:
                continue  # zero is of every dimension
            if isinstance(dimension, UnitError):
                violations.append(Violation("dimensions", (number,), (index,), [
                    "the term ", subject.forms[number][index], f" has no dimension: it is or contains {dimension}"]))
            elif dimension != expected:
                violations.append(Violation("dimensions", (number,), (index,), [
                    "the term ", subject.forms[number][index], " is in ", dimension, ", the equation in ", expected]))
        return violations

    return subject.each("dimensions", judge)
