"""Where the slips are that objections speak of, without energies: the single edits of printed terms,
and the lost terms, with which objections vanish and none comes. Several may do so equally well (a mass
matrix is made symmetric by either of two equations): all of them are named, and none is proved."""

from dataclasses import dataclass
from typing import List

from ..errors import NotInClass
from ..judgements import JUDGEMENTS
from ..judgements.subject import Subject
from ..normal.algebra import expression
from ..progress import silent
from .edits import editor
from .search import Repair, apply

# in the order of what they cost
ORDER = ("dimensions", "mirror", "galilei", "lagrangian", "definite")


@dataclass
class Location:
    """Objections that vanish together: the candidates with which just these do, as (equation number,
    Repair), and the violations."""

    candidates: List
    violations: List


def locate(subject, tell=silent):
    """(locations, violations that no single edit explains) of a subject without energies. Each edit
    is found with those of the locations before it made: of these, the first candidates. `tell` is told how far it is (progress.py)."""
    first = _objections(subject)
    locations, before = [], first
    while before:
        start = len(locations)
        for gone, candidates in _groups(subject, before, tell):
            number, repair = candidates[0]
            edited = _with(subject, number, repair)
            # another edit of this round may have changed what this one does
            left = _objections(edited, before.keys())
            if left is not None and not gone & left.keys() and gone <= before.keys():
                locations.append(Location(candidates, [first[label] for label in first if label in before.keys() - left.keys()]))
                subject, before = edited, left
        if len(locations) == start:
            break
    return locations, [first[label] for label in before]


def _label(violation):
    """What a violation is told by while the form that is left over changes."""
    return (violation.judgement, violation.equations, violation.terms, violation.message[0])


def _objections(subject, known=None):
    """Violations by label; None as soon as one comes that is not `known`, or all that are known are there."""
    found = {}
    for name in ORDER:
        found.update((_label(violation), violation) for violation in JUDGEMENTS[name](subject, None))
        if known is not None and (not found.keys() <= known or found.keys() == known):
            return None
    return found


def _with(subject, number, repair):
    """The subject with one repair."""
    equation = apply(subject.paper.equations[number], subject.expressions[number], [repair])
    return Subject(subject.paper.with_equations([equation]), subject)


def _groups(subject, before, tell):
    """(labels that vanish, [(equation number, Repair)]) of the trials that only remove objections,
    the most first."""
    numbers = dict.fromkeys(n for violation in before.values() for n in violation.equations)
    groups = {}
    trials = list(_trials(subject, numbers, before))
    for k, (number, repair) in enumerate(trials):
        tell(f"location of {len(before)} objections", k, len(trials))
        try:
            left = _objections(_with(subject, number, repair), before.keys())
        except NotInClass:
            continue
        if left is not None and len(left) < len(before):
            groups.setdefault(frozenset(before.keys() - left.keys()), []).append((number, repair))
    # a term that can be mended is not struck out
    return sorted(groups.items(), key=lambda item: (-len(item[0]), item[1][0][1].slip in ("surplus term", "lost term")))


def _trials(subject, numbers, before):
    """(equation number, repair) of all that is tried: edits, surplus terms, lost terms."""
    for number in numbers:
        blamed = {k for v in before.values() if v.equations[0] == number for k in v.terms}
        for k, term in enumerate(subject.expressions[number]):
            printed = [subject.forms[number][k]]
            if blamed and all(v.terms for v in before.values()) and k not in blamed:
                continue  # every objection names its terms, and this is none of them
            for slip, written in [*editor(subject).edits(term), ("number", term / 2), ("number", term * 2)]:
                try:
                    form = subject.read(written)
                except (NotInClass, ZeroDivisionError):
                    continue
                yield number, Repair((k,), slip, printed, [form], [written])
            yield number, Repair((k,), "surplus term", printed, [], [])
    seen = set()
    for violation in before.values():
        for number, form in violation.missing:
            if form and (number, form) not in seen:
                seen.add((number, form))
                yield number, Repair((), "lost term", [], [form], [expression(form)])
