"""The report of a verification: gathered once, then written as text (text.py), JSON (machine.py)
or HTML (html.py), which say the same."""

from dataclasses import dataclass, field
from itertools import product
from typing import Dict, List, Optional

from ..errors import NotInClass
from ..input import transcription
from ..input.corrections import apply
from ..judgements import unjudged, unreferenced
from ..judgements.comparison import compare
from ..judgements.definite import critical, determinant, printed_mass, prove_matrix, rest, states
from ..judgements.numbers import check
from ..normal.algebra import expression
from ..normal.intervals import intervals, signs
from ..normal.subject import Subject
from ..readings.lagrange import Motion
from .findings import Finding, from_corrections, from_locations, from_objections, from_repairs, judge, repaired, scores


@dataclass
class Definiteness:
    """One mass matrix: `at_rest` its determinant at zero coordinates, `neglected` the same with the
    negligible parameters at zero, `critical` values of the first of these, `boxes` the verdict over
    the box by parameter set, `squares` whether the sum of squares is proved (None: none is given)."""

    name: str
    at_rest: object
    neglected: object
    critical: object
    boxes: Dict[str, object]
    squares: Optional[bool]


@dataclass
class Report:
    """All results on one case. `corrected` has all corrections of the model folder (`by_hand`), or
    the repairs found here; `unjudged` says why a judgement had nothing to judge by, `unreferenced`
    which equations the energies say nothing about."""

    case: object
    printed: object
    corrected: object
    by_hand: bool
    motions: List
    comparisons: Dict[str, Dict[str, object]]
    violations: Dict[str, list]
    corrected_violations: Dict[str, list]
    findings: List
    unjudged: Dict[str, str]
    unreferenced: List[str]
    definiteness: List = field(default_factory=list)
    numbers: List = field(default_factory=list)
    scores: List = field(default_factory=list)
    transcribed: List[str] = field(default_factory=list)
    variants: Dict[str, Dict[str, dict]] = field(default_factory=dict)


def verify(case, thorough=True):
    """Judge a case. `thorough` also bounds the mass matrices over the whole box, and locates what is
    objected to where there are no energies."""
    paper = case.paper
    printed = Subject(paper)
    motions = [Motion(paper, energies) for energies in case.energies]
    first = motions[0] if motions else None
    violations = judge(printed, first)
    comparisons = {}
    for motion in motions:
        found = {n: compare(printed, motion, n) for n in paper.equations}
        comparisons[motion.energies.name] = {n: c for n, c in found.items() if c}
    if case.corrections:
        whole = Subject(apply(paper, case.corrections), printed)
        after = judge(whole, first)
        findings = from_corrections(case, first, printed, whole, after)
    else:
        found, whole = repaired(printed, first)
        after = judge(whole, first)
        findings = from_repairs(printed, first, found, whole, after)
    blind = thorough and not motions and not case.corrections
    findings += from_locations(whole) if blind else from_objections(whole, after)
    report = Report(case, printed, whole, bool(case.corrections), motions, comparisons, violations, after, findings,
                    unjudged(printed, first), unreferenced(printed, first))
    report.transcribed = transcription.proved(printed)
    report.numbers = check(case.numbers)
    report.scores = scores(case)
    if paper.motions() and not printed.solved:
        report.definiteness.append(_definiteness("as printed", paper, printed_mass(printed), None, False))
    for motion in motions:
        squares = _squares(motion) if motion.energies.squares else None
        report.definiteness.append(_definiteness(motion.energies.name, paper, motion.mass(), squares, thorough))
    report.findings += _neglected(report) + _wrong_numbers(report)
    return report


def _neglected(report):
    """A finding for each energy whose mass matrix does not survive what the paper neglects."""
    paper, findings = report.case.paper, []
    for motion, d in zip(report.motions, report.definiteness[1:]):
        if d.neglected is None:
            continue
        found = [signs([d.neglected], intervals({**values, **rest(paper)[1], **state}))[0] for values in paper.sets.values() for state in states(paper)]
        if not d.neglected:
            verdict = "singular: the determinant at rest is exactly 0, and accelerations along its null vector are not determined"
        elif -1 in found:
            verdict = (f"indefinite for {found.count(-1)} of {len(found)} parameter sets and states: "
                       f"the determinant at rest is {closed(d.neglected)}")
        elif 0 in found:
            verdict = f"not shown to be positive definite for {found.count(0)} of {len(found)} parameter sets and states"
        else:
            continue
        limits = _regular(paper, d)
        if limits:
            limits = "; the determinant is positive between " + ", and between ".join(limits)
        names = " and ".join(paper.negligible)
        findings.append(Finding(
            f"neglect-{len(findings) + 1}", "text", "approximation",
            f"With {' = '.join(paper.negligible)} = 0 the mass matrix of '{motion.energies.name}' is {verdict}.", (),
            [f"{names} can be negligible"], [f"the kinetic energy needs {paper.negligible[0]}{limits}"], True, ["definite"], None))
    return findings


def _regular(paper, d):
    """Where the determinant is positive between two critical values: shown halfway between them."""
    result = []
    for (name, values), state in product(paper.sets.items(), states(paper, d.critical.coefficients if d.critical else None)):
        key = ", ".join([name] + [f"{n} = {v:+d}" for n, v in state.items()])
        roots = d.critical.roots[key] if d.critical else []
        if len(roots) == 2:
            put = {**values, **rest(paper)[1], **state, d.critical.parameter: sum(roots) / 2}
            if signs([d.at_rest], intervals(put)) == [1]:
                result.append(f"{roots[0]:.4g} and {roots[1]:.4g} ({key})")
    return result


def _wrong_numbers(report):
    """A finding for each printed number whose value or unit is not confirmed."""
    findings = []
    for x in report.numbers:
        n = x.number
        if x.agrees is False:
            findings.append(Finding(f"number-{n.name}", "text", "misprint", f"{n.meaning}: it does not follow from the other "
                                    "printed numbers within their rounding", (), [f"{n.name} = {n.printed} {n.unit}"],
                                    [f"{x.low:.6g} to {x.high:.6g} {n.unit}"], True, ["difference"], None))
        if not x.unit_agrees:
            findings.append(Finding(f"unit-{n.name}", "text", "misprint", f"{n.meaning}: {n.note}", (),
                                    [f"{n.printed} {n.unit_printed}"], [f"{n.printed} {n.unit}"], True, ["dimensions"], None))
    return findings


def _squares(motion):
    """Whether the declared sum of squares is the kinetic energy: an identity in normal form."""
    total = motion.ring.number(0)
    for coefficient, velocity in motion.energies.squares(motion.s, motion.m):
        total += motion.ring.read(coefficient) * motion.ring.read(velocity) ** 2
    return not (total - motion.kinetic.substitute(motion.held) * 2)


def _definiteness(name, paper, mass, squares, thorough):
    """The sixth judgement on one mass matrix."""
    zeros = rest(paper)[0]
    at_rest = determinant([[form.substitute(zeros) for form in row] for row in mass])
    neglected = at_rest.substitute({n: 0 for n in paper.negligible}) if paper.negligible else None
    decided = critical(at_rest, paper.negligible[0], paper) if paper.negligible else None
    boxes = {}
    moving = set(paper.coordinates()) & set().union(*(form.names() for row in mass for form in row))
    # without bounds of all that the matrix depends on there is no box to speak of
    thorough = thorough and moving <= paper.box.keys()
    for set_name, values in paper.sets.items() if thorough else ():
        for neglect in (False, True) if paper.negligible else (False,):
            if neglect and not neglected:
                continue  # singular at rest: the exact zero above says so
            fixed = {**values, **({n: 0 for n in paper.negligible} if neglect else {})}
            for state in states(paper):
                verdict = prove_matrix(mass, {**fixed, **state}, paper.box)
                label = set_name + (", " + " = ".join([*paper.negligible, "0"]) if neglect else "")
                key = ", ".join([label] + [f"{n} = {v:+d}" for n, v in state.items()])
                boxes[key] = verdict
    return Definiteness(name, at_rest, neglected, decided, boxes, squares)


def closed(form):
    """A form as a SymPy expression, factored where the factored one is proved equal to it."""
    import sympy

    expanded = sympy.expand(sympy.expand_trig(expression(form)))
    angles = sorted({a for f in expanded.atoms(sympy.sin) for a in f.free_symbols}, key=str)
    expanded = sympy.expand(expanded.subs({sympy.sin(a)**2: 1 - sympy.cos(a)**2 for a in angles}))
    result = sympy.factor(expanded)
    try:
        return result if form.ring.read(result) == form else expression(form)
    except NotInClass:
        return expression(form)
