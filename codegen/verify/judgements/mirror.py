"""Judgement 4: mirror symmetry."""

from typing import List

from .violation import Violation


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

    known = subject.shared.setdefault("mirror", {})

    def sign(form):
        """What the mirror image of a form is, times the form; 0: neither it nor its negative."""
        if form not in known:
            image = form.substitute(flip)
            known[form] = 1 if image == form else -1 if image == -form else 0
        return known[form]

    def judge(number):
        equation, violations = subject.paper.equations[number], []
        signs = [sign(form) for form in subject.forms[number]]
        if equation.kind == "motion":
            # an equation may have been multiplied by lambda: the majority decides its sign
            expected = max((symbols[equation.of].mirror, -symbols[equation.of].mirror), key=signs.count)
        elif equation.kind == "condition":
            expected = 1
        else:
            expected = symbols[equation.of].mirror
        for index, (form, found) in enumerate(zip(subject.forms[number], signs)):
            if form and found != expected:
                change = {1: "keeps its sign", -1: "changes its sign", 0: "becomes another term"}[found]
                violations.append(Violation("mirror", (number,), (index,), [
                    "in the mirror image ", form, f" {change}, against the rest of the equation"]))
        return violations

    return subject.each("mirror", judge)
