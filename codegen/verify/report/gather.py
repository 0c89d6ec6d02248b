"""The report of a verification: gathered once, then written as text (text.py), JSON (machine.py), HTML (html.py) or
LaTeX (tex.py), which say the same."""

import hashlib
from dataclasses import dataclass, field, replace
from typing import Dict, List, Optional

from ..construct.balance import energy_balance, momentum_balances
from ..construct.cases import cases
from ..construct.conserved import conserved
from ..construct.frequencies import frequencies, modes
from ..construct.lagrangian import construct, motion_rows
from ..construct.small import small_motion
from ..input import transcription
from ..input.corrections import apply
from ..judgements import unjudged, unreferenced
from ..judgements.comparison import compare
from ..judgements.definite import critical, printed_mass, rest
from ..judgements.numbers import check
from ..judgements.singular import declared, regular
from ..judgements.subject import Subject
from ..normal.matrices import determinant
from ..progress import silent
from ..readings.ranking import Reading, ranked
from . import principles
from .findings import Finding, consistent_terms, from_corrections, from_locations, from_objections, from_repairs, judge, repaired
from .order import ranked as ranked_findings
from .origin import origin


@dataclass
class Definiteness:
    """One mass matrix: `at_rest` its determinant at zero coordinates (None: a divisor vanishes there), `neglected` the same with the
    negligible parameters at zero, `critical` values of the first of these, `boxes` the verdict over
    the box by parameter set, `powers` of the forms that are zero in singular configurations by which the determinant was divided, `squares` whether the sum of squares is proved (None: none is given)."""

    name: str
    at_rest: object
    neglected: object
    critical: object
    boxes: Dict[str, object] = field(default_factory=dict)
    squares: Optional[bool] = None
    powers: Dict[object, int] = field(default_factory=dict)


@dataclass
class Constructed:
    """What is constructed from equations: `lagrangian`, or `why` there is none; balances and conserved quantities;
    small motions with their frequencies, or roots (`modes`); special `cases`. `of` says of which equations: as printed, or with what is consistent."""

    of: str
    lagrangian: object
    why: Optional[str]
    energy: object = None
    momenta: List = field(default_factory=list)
    conserved: List = field(default_factory=list)
    small: object = None
    frequencies: object = None
    modes: Dict = field(default_factory=dict)
    cases: List = field(default_factory=list)


@dataclass
class Report:
    """All results on one case. `readings` are the energies that the paper may mean, the best first, and the findings are
    those of the first; `corrected` has all corrections of the model folder (`by_hand`) for it, or
    the repairs found here; `unjudged` says why a judgement had nothing to judge by, `unreferenced`
    which equations the energies say nothing about; `constructed` what follows from the equations as printed and as
    corrected; `impacts` the impact laws by equation and reading, `splits` what is left over where masses are split, by finding; `singular` the declared
    singular configurations (judgements/singular.py);
    `simulated` the runs with each slip (effects.py); `version`, `date` and `files`, {name: SHA-256}, say what judged what, and when."""

    case: object
    printed: object
    corrected: object
    by_hand: bool
    readings: List[Reading]
    comparisons: Dict[str, Dict[str, object]]
    violations: Dict[str, list]
    corrected_violations: Dict[str, list]
    findings: List[Finding]
    unjudged: Dict[str, str]
    unreferenced: List[str]
    definiteness: List[Definiteness] = field(default_factory=list)
    numbers: List = field(default_factory=list)
    transcribed: List[str] = field(default_factory=list)
    simulated: object = None
    constructed: List[Constructed] = field(default_factory=list)
    impacts: Dict = field(default_factory=dict)
    splits: Dict = field(default_factory=dict)
    singular: List = field(default_factory=list)
    version: str = ""
    date: str = ""
    files: Dict[str, str] = field(default_factory=dict)

    def digest(self):
        """SHA-256 of the lines that `sha256sum` writes of the input files, in the order of their names."""
        return hashlib.sha256("".join(f"{digest}  {name}\n" for name, digest in self.files.items()).encode()).hexdigest()

    @property
    def motions(self):
        """What follows from the energies of each reading."""
        return [reading.motion for reading in self.readings]

    def wrong_terms(self):
        """The printed terms, as (equation number, ordinal), that differ in every reading, and those that do in some."""
        sets = [{(n, k) for n, ordinals in r.differing.items() for k in ordinals} for r in self.readings]
        always = set.intersection(*sets) if sets else set()
        return always, set().union(*sets) - always


def verify(case, thorough=True, tell=silent):
    """Judge a case. `thorough` also bounds the mass matrices over the whole box, and locates what is
    objected to where there are no energies. `tell` is told how far it is (progress.py)."""
    paper = case.paper
    tell("the equations as printed")
    printed = Subject(paper)
    wrong, sound = principles.wrong_energies(printed, case.energies)
    case = replace(case, energies=sound)
    readings = ranked(printed, case.energies, thorough, tell)
    first = readings[0].motion if readings else None
    case = replace(case, corrections=_corrections(case, readings))
    tell("findings")
    violations = judge(printed, first)
    comparisons = {r.name: {n: c for n in paper.equations if (c := compare(printed, r.motion, n))} for r in readings}
    found = {}
    if case.corrections:
        whole = Subject(apply(paper, case.corrections), printed)
        after = judge(whole, first)
        findings = from_corrections(case, first, printed, whole, after)
    else:
        found, whole = repaired(printed, first)
        after = judge(whole, first)
        findings = from_repairs(printed, first, found, whole, after)
    blind = thorough and not readings and not case.corrections
    findings += from_locations(whole, tell) if blind else from_objections(whole, after)
    report = Report(case, printed, whole, bool(case.corrections), readings, comparisons, violations, after, findings,
                    unjudged(printed, first), unreferenced(printed, first))
    report.version, report.date, report.files = origin(case)
    report.transcribed = transcription.proved(printed)
    report.numbers = check(case.numbers)
    if paper.motions() and not printed.solved:
        report.definiteness.append(_definiteness("as printed", paper, printed_mass(printed), printed.singular))
    for r in readings:
        found = _definiteness(r.name, paper, r.motion.mass(), r.motion.singular)
        report.definiteness.append(replace(found, boxes=r.boxes if r.whole else {}, squares=r.squares))
    if paper.singular:
        masses = [r.motion.mass() for r in readings] + ([printed_mass(printed)] if paper.motions() and not printed.solved else [])
        scales = {n: c.scale for n, c in comparisons[readings[0].name].items()} if readings else printed.scales
        report.singular = declared(printed, masses, scales)
    _attribute(report)
    _principles(report)
    report.findings += wrong
    if wrong and not sound:
        report.unjudged["difference"] = "the energies have terms of another dimension"
    tell("what follows from the equations alone")
    report.constructed = [] if printed.solved else [_construct("as printed", printed)]
    if findings and not printed.solved:
        report.constructed.append(_construct("with what is consistent", whole))
    report.findings = ranked_findings(report.findings)
    return report


def _corrections(case, readings):
    """The corrections by hand of the best reading. Those of another explain nothing here."""
    if not readings or readings[0].name in case.readings:
        return list(case.readings[readings[0].name]) if readings else list(case.corrections)
    return list(case.corrections) if readings[0].motion.energies is case.energies[0] else []


def _attribute(report):
    """Says of each finding in which readings what is printed is wrong, and what would be consistent there. What depends on the
    reading is a choice."""
    if len(report.readings) < 2:
        return
    names = [r.name for r in report.readings]
    wholes = {}
    for name in names:
        if name in report.case.readings:
            wholes[name] = Subject(apply(report.case.paper, report.case.readings[name]), report.printed)
        else:
            wholes[name] = repaired(report.printed, next(r.motion for r in report.readings if r.name == name))
    for finding in report.findings:
        if finding.equation in report.case.paper.equations and finding.kind != "objection":
            forms = {name: _forms(report, finding, name, wholes[name]) for name in names}
            finding.readings = [name for name in names if forms[name] is not None]
            finding.alternatives = {name: forms[name] for name in finding.readings if forms[name] != finding.consistent}
            if len(finding.readings) < len(names) and finding.kind in ("misprint", "repair"):
                finding.kind = "choice"


def _forms(report, finding, name, whole):
    """What would be consistent with a reading in the place of a finding; None where what is printed is right there."""
    if name in report.case.readings:
        correction = next((c for c in report.case.readings[name] if c.key == finding.key), None)
        return correction and consistent_terms(correction, whole)
    repairs = whole[0].get(finding.equation, [])
    same = next((r for r in repairs if r.ordinals == finding.ordinals and (r.ordinals or r.consistent == finding.consistent)), None)
    return same and same.consistent


def _principles(report):
    """Adds what is no slip of a term."""
    paper, printed = report.case.paper, report.printed
    certain = [c.key for c in report.case.corrections if all(f.readings is None or len(f.readings) == len(report.readings)
                                                             for f in report.findings if f.key == c.key)]
    mended = apply(paper, report.case.corrections, _closed(report.case.corrections, certain)) if report.case.corrections else report.corrected.paper
    struck = {c.equation for c in report.case.corrections for make in (c.terms or {}).values() if make is None}
    struck |= {f.equation for f in report.findings if f.kind == "repair" and f.ordinals and not f.consistent}
    split, report.splits = principles.split_masses(printed, mended, struck)
    report.findings += split
    if report.readings:
        gains, report.impacts = principles.impacts(printed, report.corrected, report.readings)
        report.findings += gains
        kinetic = report.readings[0].motion.kinetic.substitute(report.readings[0].motion.held)
        for finding in report.findings:
            equation = paper.equations.get(finding.equation)
            if equation and equation.kind == "reset" and finding.ordinals and principles.through_the_bound(printed, finding.equation, kinetic) \
                    and not principles.through_the_bound(report.corrected, finding.equation, kinetic):
                finding.judgements.append("impact")
    report.findings += principles.neglected(paper, report.readings, report.definiteness[-len(report.readings):] if report.readings else [])
    report.findings += principles.wrong_numbers(report.numbers) + principles.undefined(printed)


def _closed(corrections, keys):
    """The keys whose required corrections are among them."""
    needed = {c.key: set(c.requires) for c in corrections}
    while gone := [key for key in keys if not needed[key] <= set(keys)]:
        keys = [key for key in keys if key not in gone]
    return keys


def _construct(of, subject):
    """What follows from equations alone."""
    lagrangian, why = construct(subject)
    _, q, rows = motion_rows(subject, conservative=False)
    if lagrangian is None:
        return Constructed(of, None, why, small=small_motion(subject.paper, rows, q), modes=modes(subject), cases=cases(subject))
    return Constructed(of, lagrangian, None, energy_balance(subject, lagrangian), momentum_balances(subject, lagrangian),
                       conserved(subject, lagrangian), small_motion(subject.paper, rows, q), frequencies(subject),
                       modes(subject), cases(subject))


def _definiteness(name, paper, mass, factors):
    """The sixth judgement on one mass matrix; `factors` are zero in singular configurations."""
    zeros = rest(paper)[0]
    try:
        if factors:
            whole, powers = regular(determinant(mass), factors)
            at_rest = whole.substitute(zeros)
        else:
            at_rest, powers = determinant([[form.substitute(zeros) for form in row] for row in mass]), {}
    except ZeroDivisionError:
        return Definiteness(name, None, None, None)
    neglected = at_rest.substitute({n: 0 for n in paper.negligible}) if paper.negligible else None
    return Definiteness(name, at_rest, neglected, critical(at_rest, paper.negligible[0], paper) if paper.negligible else None,
                        powers={factors[where]: power for where, power in powers.items()})
