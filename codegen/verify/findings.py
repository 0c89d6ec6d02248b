"""From judgements to findings: each slip of a paper with what it must say, who found it, what kind
it is, and where it makes no difference."""

from dataclasses import dataclass, field
from typing import List, Optional, Tuple

from .algebra import NotInClass
from .corrections import apply, without
from .definite import definite
from .judgements import FIVE, Subject, compare
from .lagrange import Motion

JUDGEMENTS = {**FIVE, "definite": definite}


@dataclass
class Finding:
    """One slip. `printed` and `consistent` are forms (terms) or words, `ordinals` those of the printed terms
    (from 0); `judgements` the names of those that find it when everything else is right;
    `order` the lowest degree in the coordinates of what it changes (None: not a term); `vanishes` the special cases in
    which it changes nothing; `effects` what a simulation made of it, by scene."""

    key: str
    equation: str
    kind: str
    reason: str
    ordinals: Tuple[int, ...]
    printed: list
    consistent: list
    judgements: List[str]
    order: Optional[int]
    vanishes: List[str] = field(default_factory=list)
    effects: dict = field(default_factory=dict)


def judge(subject, motion):
    """All violations of a subject by judgement."""
    return {name: function(subject, motion) for name, function in JUDGEMENTS.items()}


def detected(subject, motion):
    """Names of the judgements that object to a subject."""
    return [name for name, violations in judge(subject, motion).items() if violations]


def special_cases(paper, form):
    """Names of the paper's special cases in which a form is zero."""
    result = []
    for name, values in paper.special.items():
        put = {n: form.ring.symbol(v) if isinstance(v, str) else v for n, v in values.items()}
        try:
            if not form.substitute(put):
                result.append(name)
        except (NotInClass, ZeroDivisionError):
            continue  # the case does not exist for this form: it divides by what would be zero
    return result


def from_corrections(case, motion):
    """One finding for each correction. A judgement finds a slip if it objects to the corrected
    equations with this one slip put back."""
    paper, corrections = case.paper, case.corrections
    printed = Subject(paper)
    whole = Subject(apply(paper, corrections), printed)
    findings = []
    for correction in corrections:
        others = without(corrections, correction.key)
        slipped = Subject(apply(paper, corrections, others), printed)
        right = Subject(apply(paper, corrections, [*others, correction.key]), printed)
        number = correction.equation
        if correction.whole:
            ordinals = tuple(range(len(printed.forms[number])))
            consistent = whole.forms[number]
        else:
            ordinals = tuple(k - 1 for k in correction.terms or {})
            made = [make(whole.s, whole.m, lambda key: True) for make in (correction.terms or {}).values() if make]
            made += [make(whole.s, whole.m) for make in correction.adds]
            consistent = [whole.ring.read(x) for x in made]
        change = slipped.total(number) - right.total(number)
        findings.append(Finding(
            correction.key, number, correction.kind, correction.reason, ordinals,
            [printed.forms[number][k] for k in ordinals], consistent, detected(slipped, motion),
            change.order(paper.coordinates()), special_cases(paper, change)))
    return findings


def unexplained(subject, motion, violations):
    """Findings of a paper without corrections: each differing term beside the derived term that is
    most like it, and each derived term that nothing printed is like."""
    findings = []
    for number in subject.paper.equations:
        comparison = motion and compare(subject, motion, number)
        if comparison is None:
            continue
        pairs = _pairs(subject, comparison)
        for k, (ordinals, printed, consistent) in enumerate(pairs, 1):
            found = [name for name, list_ in violations.items()
                     if any(number in v.equations and (not v.terms or set(v.terms) & set(ordinals)) for v in list_)]
            change = sum(printed, subject.ring.number(0)) - sum(consistent, subject.ring.number(0))
            findings.append(Finding(f"{number}-{k}", number, "unexplained", "", ordinals, printed, consistent, found,
                                    change.order(subject.paper.coordinates()), special_cases(subject.paper, change)))
    return findings


def _pairs(subject, comparison):
    """(ordinals, printed, derived) of one equation: differing and absent terms, the most alike first."""
    differ, absent = list(comparison.differ), list(comparison.absent)
    forms = subject.forms[comparison.number]
    ranked = sorted(((-_likeness(forms[i], other), i, k) for i in differ for k, other in enumerate(absent)))
    partner, taken = {}, set()
    for score, i, k in ranked:
        if score < 0 and i not in partner and k not in taken:
            partner[i] = k
            taken.add(k)
    pairs = [((i,), [forms[i]], [absent[partner[i]]] if i in partner else []) for i in differ]
    return pairs + [((), [], [form]) for k, form in enumerate(absent) if k not in taken]


def _likeness(form, other):
    """Number of factors that two terms share."""
    def factors(x):
        found = []
        for monomial, harmonic in list(x.terms)[:1]:
            for name, exponent in monomial:
                found += [str(name)] * abs(exponent)
            found.append(str(harmonic))
        return found

    left, right = factors(form), factors(other)
    return sum(min(left.count(x), right.count(x)) for x in set(left))


def scores(case):
    """For every candidate of the energies: its name and, over equations of motion, forces and
    reactions, how many printed terms agree, of how many, and how many derived terms are absent."""
    subject = Subject(case.paper)
    result = []
    for energies in case.candidates:
        motion = Motion(case.paper, energies)
        chosen = [n for n, e in case.paper.equations.items() if e.kind in ("motion", "value")]
        found = [c for c in (compare(subject, motion, n) for n in chosen) if c]
        result.append((energies.name, sum(len(c.agree) for c in found),
                       sum(len(c.agree) + len(c.differ) for c in found), sum(len(c.absent) for c in found)))
    return result
