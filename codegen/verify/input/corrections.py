"""Corrections of printed equations: each replaces, removes or adds terms, for a stated reason, and
can be switched on by itself."""

from dataclasses import dataclass, replace
from typing import Callable, Dict, Optional, Tuple

from ..errors import PaperError

KINDS = {
    "misprint": "a misprint: what it must say follows from the other printed equations",
    "approximation": "an approximation: something small is left out",
    "choice": "a modelling choice: the paper can be read, or the model made, either way",
}


@dataclass(frozen=True)
class Correction:
    """One slip of one equation.

    `terms` maps the ordinals of printed terms (from 1) to functions of (s, m, on) that return the
    term instead, or to None where the term must go; `adds` are functions that return a term that
    is absent; `whole` returns all terms anew, whatever other corrections made of them. `on(key)` says whether another correction is applied
    too: two slips in one term are two corrections, each written with the other's switch.
    `requires` names corrections that are applied with this one.
    """

    key: str
    equation: str
    kind: str
    reason: str
    terms: Dict[int, Optional[Callable]] = None
    adds: Tuple[Callable, ...] = ()
    whole: Optional[Callable] = None
    requires: Tuple[str, ...] = ()

    def __post_init__(self):
        if self.kind not in KINDS:
            raise PaperError(f"the correction '{self.key}' is of kind '{self.kind}'; known are {', '.join(KINDS)}")


def closure(corrections, keys):
    """The keys with those that they require; an unknown key is an error."""
    known = {c.key: c for c in corrections}
    found, stack = [], list(keys)
    while stack:
        key = stack.pop()
        if key not in known:
            raise PaperError(f"there is no correction '{key}'; known are {', '.join(known)}")
        if key not in found:
            found.append(key)
            stack += known[key].requires
    return [key for key in known if key in found]


def without(corrections, key):
    """All keys but one and those that require it."""
    gone = {key}
    while more := {c.key for c in corrections if c.key not in gone and gone & set(c.requires)}:
        gone |= more
    return [c.key for c in corrections if c.key not in gone]


def apply(paper, corrections, keys=None):
    """The paper with the corrections `keys` applied (all if None), in the order of the list."""
    keys = closure(corrections, [c.key for c in corrections] if keys is None else keys)
    chosen = [c for c in corrections if c.key in keys]
    changed = []
    for number in dict.fromkeys(c.equation for c in chosen):
        if number not in paper.equations:
            raise PaperError(f"a correction names equation ({number}), which the paper does not have")
        changed.append(_corrected(paper.equations[number], [c for c in chosen if c.equation == number], set(keys)))
    return paper.with_equations(changed)


def _corrected(equation, corrections, keys):
    """One equation with its corrections applied."""

    def function(s, m):
        slots = {i + 1: term for i, term in enumerate(equation.terms(s, m))}
        count = len(slots)
        for correction in corrections:
            for ordinal, make in (correction.terms or {}).items():
                if not 1 <= ordinal <= count:
                    raise PaperError(f"the correction '{correction.key}' names term {ordinal}; "
                                     f"equation ({equation.number}) has {count}")
                if make is None:
                    slots.pop(ordinal, None)
                else:
                    slots[ordinal] = make(s, m, keys.__contains__)
            for make in correction.adds:
                slots[max(slots, default=count) + 1] = make(s, m)
        wholes = [correction for correction in corrections if correction.whole]
        if len(wholes) > 1:
            raise PaperError(f"the corrections {', '.join(repr(c.key) for c in wholes)} all give equation ({equation.number}) anew")
        if wholes:
            return list(wholes[0].whole(s, m))
        return list(slots.values())

    # a corrected condition is already written as the terms of its margin
    return replace(equation, function=function, latex="", margin=True)
