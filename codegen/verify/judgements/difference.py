"""Judgement 3: the printed terms against what follows from energies."""

from typing import List

from .comparison import compare
from .violation import Violation


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
