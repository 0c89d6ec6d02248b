"""From judgements to findings: each slip of a paper with what it must say, who found it, what kind
it is, and where it makes no difference."""

from dataclasses import dataclass, field
from typing import List, Optional, Tuple

from ..construct.small import special_cases as cases
from ..errors import NotInClass
from ..input.corrections import apply, without
from ..judgements import JUDGEMENTS, TITLES
from ..judgements.comparison import compare
from ..judgements.subject import Subject
from ..repairs import search as repairs
from ..repairs.locate import locate


# what findings are, beside the kinds of corrections
FURTHER = {
    "repair": "a slip, found here: with what is called consistent the equation is that of the reading",
    "objection": "an objection that no slip explains",
    "principle": "a principle of mechanics that the paper does not keep",
    "undefined": "a symbol that the paper uses and does not define",
}
# beside the judgements on equations
IMPACT = "Impact laws: bound, energy and momenta"


@dataclass
class Finding:
    """One slip, or one objection that no slip explains. `kind` is that of a correction or one of `FURTHER`. `printed` and `consistent` are forms (terms) or words, `reason` a sentence (words.py), `ordinals`
    those of the printed terms (from 0); `proved` says whether the equation raises no objection
    with all that is called consistent; `slip` is a kind of slip (edits.SLIPS) or empty;
    `judgements` the names of those that find it when everything else is right; `order` the lowest
    degree in the coordinates of what it changes (None: not a term); `vanishes` the special cases in
    which it changes nothing; `effects` what a simulation made of it, by scene; `possible` the edits,
    as (equation number, Repair), with each of which alone an objection vanishes and none comes; `readings` the names of the
    readings in which what is printed is wrong (None: there is one reading, or none), and `alternatives` what would be consistent in
    those whose forms are not `consistent`: {name: forms}; `slipped` the terms of the equation with this slip alone, as SymPy
    expressions; `violations` what is objected to."""

    key: str
    equation: str
    kind: str
    reason: list
    ordinals: Tuple[int, ...]
    printed: list
    consistent: list
    proved: bool
    judgements: List[str]
    order: Optional[int]
    slip: str = ""
    vanishes: List[str] = field(default_factory=list)
    effects: dict = field(default_factory=dict)
    possible: list = field(default_factory=list)
    readings: Optional[List[str]] = None
    alternatives: dict = field(default_factory=dict)
    slipped: list = field(default_factory=list)
    violations: list = field(default_factory=list)


def judge(subject, motion):
    """All violations of a subject by judgement."""
    return {name: function(subject, motion) for name, function in JUDGEMENTS.items()}


def detected(subject, motion, beside=None):
    """Names of the judgements that object to a subject, beyond the violations `beside`."""
    beside = beside or {}
    return [name for name, violations in judge(subject, motion).items()
            if any(v not in beside.get(name, ()) for v in violations)]


def judged_right(subject, motion, violations, number):
    """Whether an equation is what the energies give, and no judgement objects to it."""
    comparison = motion and compare(subject, motion, number)
    return bool(comparison) and not any(number in v.equations for found in violations.values() for v in found)


def special_cases(paper, form):
    """Names of the special cases in which a form is zero."""
    result = []
    for name, values in cases(paper).items():
        put = {n: form.ring.symbol(v) if isinstance(v, str) else v for n, v in values.items()}
        try:
            if not form.substitute(put):
                result.append(name)
        except (NotInClass, ZeroDivisionError):
            continue  # the case does not exist for this form: it divides by what would be zero
    return result


def consistent_terms(correction, whole):
    """The forms of the terms that a correction puts in, where all corrections of a reading are applied."""
    if correction.whole:
        return whole.forms[correction.equation]
    made = [make(whole.s, whole.m, lambda key: True) for make in (correction.terms or {}).values() if make]
    return [whole.ring.read(x) for x in made + [make(whole.s, whole.m) for make in correction.adds]]


def from_corrections(case, motion, printed, whole, violations):
    """One finding for each correction; `whole` has all of them and raises `violations`. A judgement
    finds a slip if it objects beyond these to the equations with this one slip put back, and with
    those whose corrections require its own."""
    corrections, findings = case.corrections, []
    for correction in corrections:
        others = without(corrections, correction.key)
        slipped = Subject(apply(case.paper, corrections, others), printed)
        right = Subject(apply(case.paper, corrections, [*others, correction.key]), printed)
        number = correction.equation
        ordinals = tuple(range(len(printed.forms[number]))) if correction.whole else tuple(k - 1 for k in correction.terms or {})
        change = slipped.total(number) - right.total(number)
        findings.append(Finding(
            correction.key, number, correction.kind, [correction.reason], ordinals,
            [printed.forms[number][k] for k in ordinals], consistent_terms(correction, whole), judged_right(whole, motion, violations, number),
            detected(slipped, motion, violations), change.order(case.paper.coordinates()),
            vanishes=special_cases(case.paper, change), slipped=slipped.expressions[number]))
    return findings


def repaired(subject, motion):
    """The repairs of all equations, and the subject with all of them."""
    found = {n: repairs.repairs(subject, motion, n) for n in subject.paper.equations}
    found = {n: list_ for n, list_ in found.items() if list_}
    return found, _with(subject, found)


def _with(subject, found):
    """The subject with repairs applied: {equation number: repairs}."""
    changed = [repairs.apply(subject.paper.equations[n], subject.expressions[n], list_) for n, list_ in found.items()]
    return Subject(subject.paper.with_equations(changed), subject)


def from_repairs(subject, motion, found, whole, violations):
    """One finding for each repair; `whole` has all of them and raises `violations`."""
    findings = []
    for number, list_ in found.items():
        proved = judged_right(whole, motion, violations, number)
        for k, repair in enumerate(list_, 1):
            slipped = _with(subject, {**found, number: [r for r in list_ if r is not repair]})
            change = slipped.total(number) - whole.total(number)
            findings.append(Finding(
                f"{number}-{k}", number, "repair", [], repair.ordinals, repair.printed, repair.consistent, proved,
                detected(slipped, motion, violations), change.order(subject.paper.coordinates()), repair.slip,
                special_cases(subject.paper, change), slipped=slipped.expressions[number]))
    return findings


def from_objections(subject, violations):
    """One finding for each objection, to the terms that it blames."""
    findings = []
    for name, list_ in violations.items():
        for k, v in enumerate(list_, 1):
            findings.append(_objection(f"{name}-{k}", subject, [v], v.equations, v.terms))
    return findings


def from_locations(subject, tell):
    """Without energies: one finding for the objections that vanish with one edit of a term, and one
    for each that vanishes with none."""
    locations, left = locate(subject, tell)
    findings = []
    for k, found in enumerate(locations, 1):
        numbers = tuple(dict.fromkeys(number for number, _ in found.candidates))
        same = len(numbers) == 1 and len({repair.ordinals for _, repair in found.candidates}) == 1
        ordinals = found.candidates[0][1].ordinals if same else ()
        findings.append(_objection(f"slip-{k}", subject, found.violations, numbers, ordinals, found.candidates))
    by_name = {name: [v for v in left if v.judgement == name] for name in JUDGEMENTS}
    return findings + from_objections(subject, by_name)


def _objection(key, subject, violations, equations, terms, possible=()):
    """A finding that is one objection, or several with one place."""
    reason = []
    for v in violations:
        reason += ["; "] * bool(reason) + [f"{TITLES[v.judgement]}: ", *v.message]
    judgements = list(dict.fromkeys(v.judgement for v in violations))
    printed = [subject.forms[equations[0]][k] for k in terms]
    return Finding(key, ", ".join(dict.fromkeys(equations)), "objection", reason, terms, printed, [], False, judgements, None,
                   possible=list(possible), violations=list(violations))
