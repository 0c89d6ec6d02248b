"""The report of a verification: gathered once, then written as text, JSON or HTML (html.py)."""

import json
from dataclasses import dataclass, field
from typing import Dict, List, Optional

from . import transcription
from .algebra import expression
from .corrections import KINDS, apply
from .definite import critical, determinant, minors, printed_mass, prove, states
from .findings import Finding, from_corrections, judge, scores, unexplained
from .intervals import intervals, signs
from .judgements import TITLES, Subject, compare
from .lagrange import Motion
from .numbers import check
from .printed import PaperError
from .show import form_latex, form_text, shown


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
    """All results on one case."""

    case: object
    printed: object
    corrected: object
    motions: List
    comparisons: Dict[str, Dict[str, object]]
    violations: Dict[str, list]
    corrected_violations: Optional[Dict[str, list]]
    findings: List
    definiteness: List = field(default_factory=list)
    numbers: List = field(default_factory=list)
    scores: List = field(default_factory=list)
    transcribed: List[str] = field(default_factory=list)
    variants: Dict[str, Dict[str, dict]] = field(default_factory=dict)


def verify(case, thorough=True):
    """Judge a case. `thorough` also bounds the mass matrices over the whole box."""
    paper = case.paper
    printed = Subject(paper)
    motions = [Motion(paper, energies) for energies in case.energies]
    first = motions[0] if motions else None
    violations = judge(printed, first)
    corrected = Subject(apply(paper, case.corrections), printed) if case.corrections else None
    comparisons = {}
    for motion in motions:
        found = {n: compare(printed, motion, n) for n in paper.equations}
        comparisons[motion.energies.name] = {n: c for n, c in found.items() if c}
    report = Report(
        case, printed, corrected, motions, comparisons, violations,
        judge(corrected, first) if corrected else None,
        from_corrections(case, first) if case.corrections else unexplained(printed, first, violations))
    report.transcribed = transcription.proved(printed)
    report.numbers = check(case.numbers)
    report.scores = scores(case)
    if paper.motions():
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
        if not d.neglected:
            verdict = "singular: the determinant at rest is exactly 0, and accelerations along its null vector are not determined"
        elif any(violated := [-1 in signs([d.neglected], intervals({**values, **state}))
                              for values in paper.sets.values() for state in states(paper)]):
            verdict = (f"indefinite for {sum(violated)} of {len(violated)} parameter sets and states: "
                       f"the determinant at rest is {closed(d.neglected)}")
        else:
            continue
        limits = ""
        if d.critical:
            limits = "; it is regular between " + ", and between ".join(
                f"{' and '.join(f'{root:.4g}' for root in roots)} ({key})" for key, roots in d.critical.roots.items() if roots)
        names = " and ".join(paper.negligible)
        findings.append(Finding(
            f"neglect-{len(findings) + 1}", "text", "approximation",
            f"With {' = '.join(paper.negligible)} = 0 the mass matrix of '{motion.energies.name}' is {verdict}.", (),
            [f"{names} can be negligible"], [f"the kinetic energy needs {paper.negligible[0]}{limits}"], ["definite"], None))
    return findings


def _wrong_numbers(report):
    """A finding for each printed number whose value or unit is not confirmed."""
    findings = []
    for x in report.numbers:
        n = x.number
        if x.agrees is False:
            findings.append(Finding(f"number-{n.name}", "text", "misprint", f"{n.meaning}: it does not follow from the other "
                                    "printed numbers within their rounding", (), [f"{n.name} = {n.printed} {n.unit}"],
                                    [f"{x.low:.6g} to {x.high:.6g} {n.unit}"], ["difference"], None))
        if not x.unit_agrees:
            findings.append(Finding(f"unit-{n.name}", "text", "misprint", f"{n.meaning}: {n.note}", (),
                                    [f"{n.printed} {n.unit_printed}"], [f"{n.printed} {n.unit}"], ["dimensions"], None))
    return findings


def _squares(motion):
    """Whether the declared sum of squares is the kinetic energy: an identity in normal form."""
    total = motion.ring.number(0)
    for coefficient, velocity in motion.energies.squares(motion.s, motion.m):
        total += motion.ring.read(coefficient) * motion.ring.read(velocity) ** 2
    return not (total - motion.kinetic.substitute(motion.held) * 2)


def _definiteness(name, paper, mass, squares, thorough):
    """The sixth judgement on one mass matrix."""
    rest = {p + n: 0 for n in paper.coordinates() for p in ("", "d", "dd")}
    at_rest = determinant(mass).substitute(rest)
    neglected = at_rest.substitute({n: 0 for n in paper.negligible}) if paper.negligible else None
    decided = critical(at_rest, paper.negligible[0], paper) if paper.negligible else None
    boxes = {}
    for set_name, values in paper.sets.items() if thorough else ():
        for neglect in (False, True) if paper.negligible else (False,):
            if neglect and not neglected:
                continue  # singular at rest: the exact zero above says so
            fixed = {**values, **({n: 0 for n in paper.negligible} if neglect else {})}
            for state in states(paper):
                verdict = prove(minors(mass), {**fixed, **state}, paper.box or {n: (0.0, 0.0) for n in paper.coordinates()})
                label = set_name + (", " + " = ".join([*paper.negligible, "0"]) if neglect else "")
                key = ", ".join([label] + [f"{n} = {v:+d}" for n, v in state.items()])
                boxes[key] = verdict
    return Definiteness(name, at_rest, neglected, decided, boxes, squares)


def closed(form):
    """A form as a factored SymPy expression, proved equal to it."""
    import sympy

    expanded = sympy.expand(sympy.expand_trig(expression(form)))
    angles = sorted({a for f in expanded.atoms(sympy.sin) for a in f.free_symbols}, key=str)
    expanded = sympy.expand(expanded.subs({sympy.sin(a)**2: 1 - sympy.cos(a)**2 for a in angles}))
    result = sympy.factor(expanded)
    if form.ring.read(result) != form:
        raise ArithmeticError(f"the factored form of {form} is not identical to it")
    return result


def message_text(message, paper):
    """A violation's message as plain text."""
    return "".join(part if isinstance(part, str) else form_text(part, paper) for part in message)


def term_list(parts, paper):
    """Several terms one after the other."""
    return ",  ".join(shown(part, paper) for part in parts) or "(nothing)"


def as_text(report):
    """The report for a terminal."""
    case, paper = report.case, report.case.paper
    lines = [f"{case.name}: {paper.title}", f"source: {paper.source}", ""]
    if report.transcribed:
        lines += [f"Transcription: ({'), ('.join(report.transcribed)}) are proved equal to their LaTeX, term by term.", ""]
    for motion in report.motions:
        found = report.comparisons[motion.energies.name]
        agree = sum(len(c.agree) for c in found.values())
        total = agree + sum(len(c.differ) for c in found.values())
        lines.append(f"Energies '{motion.energies.name}': {agree} of {total} printed terms agree, "
                     f"{sum(len(c.absent) for c in found.values())} derived terms are not printed")
        for number, c in found.items():
            lines.append(f"  ({number})  {len(c.agree)} of {len(c.agree) + len(c.differ)} terms agree")
        lines.append("")
    if report.scores:
        lines.append("Candidate energies (equations of motion, forces and reactions): agreeing terms, absent terms")
        lines += [f"  {agree:3d} of {total}, {absent:2d} absent   {name}" for name, agree, total, absent in report.scores] + [""]
    lines.append("Judgements on the printed equations" + (" and, in brackets, on the corrected ones" if report.corrected else ""))
    for name, title in TITLES.items():
        after = f" ({len(report.corrected_violations[name])})" if report.corrected else ""
        lines.append(f"  {title}: {len(report.violations[name])} objections{after}")
        if name != "difference":
            lines += ["    " + message_text(v.message, paper) for v in report.violations[name]]
    lines += ["", f"{len(report.findings)} findings"]
    for f in report.findings:
        where = f", terms {', '.join(str(k + 1) for k in f.ordinals)}" if f.ordinals else ""
        lines += ["", f"  [{f.key}] equation ({f.equation}){where}", f"    printed:    {term_list(f.printed, paper)}",
                  f"    consistent: {term_list(f.consistent, paper)}"]
        if f.kind in KINDS:
            lines += [f"    {KINDS[f.kind]}", f"    {f.reason}"]
        lines.append("    found by: " + ", ".join(f.judgements))
        lines += [f"    {line}" for line in extent_lines(f) + effect_lines(f)]
    if report.variants:
        lines += ["", "The scenes with the equations as a whole"]
    for scene, results in report.variants.items():
        lines.append(f"  {scene}")
        lines += [f"    {name}: {outcome_text(result)}" for name, result in results.items()]
    if report.definiteness:
        lines += ["", "Positive definite kinetic energy"]
    for d in report.definiteness:
        lines += [f"  {d.name}", f"    determinant at rest: {closed(d.at_rest)}"]
        if d.neglected is not None:
            value = closed(d.neglected) if d.neglected else "0 (singular)"
            lines.append(f"    with {' = '.join(paper.negligible)} = 0: {value}")
        if d.critical:
            name = d.critical.parameter
            lines.append(f"    critical {name}: roots of c0 + c1 {name} + c2 {name}^2")
            lines += [f"      c{k} = {closed(c) if c else 0}" for k, c in enumerate(d.critical.coefficients)]
            lines += [f"      {key}: {', '.join(f'{root:.6g}' for root in roots) or 'none'}"
                      for key, roots in d.critical.roots.items()]
        if d.squares is not None:
            lines.append("    the kinetic energy is " + ("" if d.squares else "NOT ") + "the declared sum of squares (identity proved)")
        lines += [f"    {key}: {verdict_text(v)}" for key, v in d.boxes.items()]
    if report.numbers:
        lines += ["", "Printed numbers (recomputed as an interval over the rounding of what they come from)"]
    for x in report.numbers:
        lines.append("  " + number_text(x))
    if paper.definitions:
        lines += ["", "Symbols that the paper uses and does not define"]
        lines += [f"  {name}: {paper.symbols[name].meaning}" for name in paper.definitions]
    return "\n".join(lines) + "\n"


def extent_lines(finding):
    """How small a finding is, and where it vanishes."""
    lines = [] if finding.order is None else [f"order in the coordinates: {finding.order}"]
    return lines + (["makes no difference for " + ", ".join(finding.vanishes)] if finding.vanishes else [])


def effect_lines(finding):
    """The simulated effect of a finding, a line a scene."""
    if not finding.effects:
        return ["effect on the scenes: not simulated"]
    lines = []
    for scene, effect in finding.effects.items():
        parts = [f"{which} the slip {outcome_text(effect[which])}" for which in ("without", "with")]
        lines.append(f"effect on {scene}: " + "; ".join(parts))
    return lines


def outcome_text(result):
    """What a simulation gave: its quantities, and why it stopped early if it did."""
    return ", ".join(f"{n} = {v:.6g}" if isinstance(v, (int, float)) else f"{n} {v}" for n, v in result.items())


def verdict_text(verdict):
    """A verdict over the box in words."""
    where = "" if not verdict.point else " at " + ", ".join(
        f"{n} = {low:g}" if low == high else f"{n} in [{low:g}, {high:g}]" for n, (low, high) in verdict.point.items())
    return {"proved": f"positive definite on the whole box (proved, {verdict.boxes} boxes)",
            "refuted": f"NOT positive definite{where}",
            "undecided": f"undecided{where} after {verdict.boxes} boxes"}[verdict.status]


def number_text(checked):
    """One number with its verdict."""
    n = checked.number
    text = f"{n.name} = {n.printed} {n.unit_printed or n.unit}" if n.printed else f"{n.name} [{n.unit}] not printed"
    if checked.low is not None:
        text += f"; recomputed {checked.low:.6g}" + (f" to {checked.high:.6g}" if f"{checked.low:.6g}" != f"{checked.high:.6g}" else "")
    if checked.agrees is not None:
        text += ": agrees" if checked.agrees else ": DISAGREES"
    if not checked.unit_agrees:
        text += f"; the unit must be {n.unit}"
    return f"{text}   ({n.meaning}{'; ' + n.note if n.note else ''})"


def as_dictionary(report):
    """The report for machines."""
    paper = report.case.paper

    def show(part):
        return {"text": part} if isinstance(part, str) else {"text": form_text(part, paper), "latex": form_latex(part, paper)}

    return {
        "model": report.case.name, "title": paper.title, "source": paper.source,
        "transcription_proved": report.transcribed,
        "energies": [{
            "name": m.energies.name, "description": m.energies.description,
            "equations": {n: {
                "agree": [{"term": k + 1, **show(report.printed.forms[n][k])} for k in c.agree],
                "differ": [{"term": k + 1, **show(report.printed.forms[n][k])} for k in c.differ],
                "absent": [show(x) for x in c.absent],
            } for n, c in report.comparisons[m.energies.name].items()},
        } for m in report.motions],
        "candidates": [dict(zip(("name", "agree", "terms", "absent"), row)) for row in report.scores],
        "judgements": {name: {
            "title": title,
            "objections": [{"equations": v.equations, "terms": [k + 1 for k in v.terms],
                            "message": message_text(v.message, paper)} for v in report.violations[name]],
            "objections_after_correction": len(report.corrected_violations[name]) if report.corrected else None,
        } for name, title in TITLES.items()},
        "findings": [{
            "key": f.key, "equation": f.equation, "kind": f.kind, "reason": f.reason, "terms": [k + 1 for k in f.ordinals],
            "printed": [show(x) for x in f.printed], "consistent": [show(x) for x in f.consistent],
            "judgements": f.judgements, "order": f.order, "vanishes": f.vanishes, "effects": f.effects or None,
        } for f in report.findings],
        "variants": report.variants or None,
        "definiteness": [{
            "name": d.name, "determinant_at_rest": str(closed(d.at_rest)),
            "neglected": None if d.neglected is None else str(closed(d.neglected)) if d.neglected else "0",
            "critical": d.critical and {"parameter": d.critical.parameter, "roots": d.critical.roots,
                                        "coefficients": [str(closed(c)) if c else "0" for c in d.critical.coefficients]},
            "sum_of_squares": d.squares,
            "box": {key: {"status": v.status, "boxes": v.boxes, "point": v.point} for key, v in d.boxes.items()},
        } for d in report.definiteness],
        "numbers": [{
            "name": x.number.name, "printed": x.number.printed, "unit": x.number.unit,
            "unit_printed": x.number.unit_printed, "low": x.low, "high": x.high, "agrees": x.agrees,
            "unit_agrees": x.unit_agrees, "meaning": x.number.meaning, "note": x.number.note,
        } for x in report.numbers],
        "undefined_symbols": {name: paper.symbols[name].meaning for name in paper.definitions},
    }


def as_json(report):
    """The report as JSON text."""
    return json.dumps(as_dictionary(report), indent=2, ensure_ascii=False) + "\n"
