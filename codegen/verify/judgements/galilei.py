"""Judgement 5: Galilean invariance."""

from itertools import combinations
from typing import List

from .violation import Violation


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
        return violations + _split(subject, number)

    return subject.each("galilei", judge)


def _split(subject, number):
    return [Violation("galilei", (number,), (), [
        f"the accelerations of {first} and {second} in ({number}) do not belong to one first moment: the slope by {second} of the "
        f"factor of dd{first} less the slope by {first} of that of dd{second} is ", form]) for first, second, form in split(subject, number)]


def split(subject, number):
    """(coordinate, coordinate, form) where the masses of a momentum are split. A force on a translation of the whole system
    is the second rate of a first moment, masses times positions: the factors of its accelerations are the slopes of one function.
    Where one mass stands by one acceleration and another by the next, there is no such function, and a steady motion of the frame
    exerts a force."""
    equation = subject.paper.equations[number]
    if subject.paper.translation is None or not (
            equation.momentum or equation.kind == "motion" and equation.of == subject.paper.translation[0]):
        return []
    total = subject.scales.get(number, subject.ring.number(1)) * subject.conservative(number)
    factors = {name: total.diff("dd" + name) for name in subject.paper.coordinates()}
    return [(first, second, form) for first, second in combinations(factors, 2)
            if (form := factors[first].diff(second) - factors[second].diff(first))]
