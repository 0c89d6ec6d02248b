"""The report as JSON."""

import json

from ..judgements import TITLES
from .closed import closed
from .construction import construction_parts
from .lasting import lasting
from .show import form_latex, form_text, message_text
from .words import hidden, undefined_symbols


# raised when a key changes its meaning or goes
SCHEMA = 3


def _terms(found):
    """Terms as the numbers of equations with those of their terms, from 1."""
    result = {}
    for number, k in sorted(found):
        result.setdefault(number, []).append(k + 1)
    return result


def as_dictionary(report):
    """The report for machines."""
    paper = report.case.paper
    first = report.comparisons[report.motions[0].energies.name] if report.motions else {}
    names = lasting(report.findings, paper)

    def show(part):
        return {"text": part} if isinstance(part, str) else {"text": form_text(part, paper), "latex": form_latex(part, paper)}

    return {
        "schema": SCHEMA, "version": report.version, "date": report.date,
        "input": {"sha256": report.digest() if report.files else None, "files": report.files},
        "model": report.case.name, "title": paper.title, "source": paper.source,
        "transcription_proved": report.transcribed,
        "agreeing_terms": sum(len(c.agree) for c in first.values()),
        "terms": sum(c.terms() for c in first.values()),
        "multipliers": {n: show(first[n].scale if n in first else scale) for n, scale in report.printed.scales.items()
                        if (first[n].scale if n in first else scale) != report.printed.ring.number(1)},
        "singular": [{"where": x.where, "zero": show(x.form), "divided": x.divided, "mass_matrix": x.mass} for x in report.singular],
        "unreferenced_equations": report.unreferenced,
        "energies": [{
            "name": m.energies.name, "description": m.energies.description,
            "equations": {n: {
                "agree": [{"term": k + 1, **show(report.printed.forms[n][k])} for k in c.agree],
                "differ": [{"term": k + 1, **show(report.printed.forms[n][k])} for k in c.differ],
                "idle": [{"term": k + 1, **show(report.printed.forms[n][k])} for k in c.idle],
                "absent": [show(x) for x in c.absent],
            } for n, c in report.comparisons[m.energies.name].items()},
        } for m in report.motions],
        "readings": [{
            "name": r.name, "definiteness": r.verdict(), "agree": r.agree, "terms": r.terms, "absent": r.absent,
            "reactions": [{"release": x.release, "case": x.case, "coordinate": x.coordinate, "low": x.low, "high": x.high,
                           "least": x.least and {"value": x.least.value, "t": x.least.time, "uncertainty": x.least.uncertainty}} for x in r.reactions],
            "objections": {name: [message_text(v.message, paper) for v in found] for name, found in r.objections.items()},
        } for r in report.readings],
        "terms_wrong_in_every_reading": _terms(report.wrong_terms()[0]) if len(report.readings) > 1 else None,
        "terms_wrong_in_some_readings": _terms(report.wrong_terms()[1]) if len(report.readings) > 1 else None,
        "judgements": {name: {
            "title": title, "judged": name not in report.unjudged, "not_judged_because": report.unjudged.get(name),
            "objections": [{"equations": v.equations, "terms": [k + 1 for k in v.terms],
                            "message": message_text(v.message, paper)} for v in report.violations[name]],
            "objections_after_correction": len(report.corrected_violations[name]),
        } for name, title in TITLES.items()},
        "findings": [{
            "id": f.key, "lasting": names.get(f.key, f.key), "equation": f.equation, "kind": f.kind, "slip": f.slip or None, "reason": message_text(f.reason, paper),
            "term": [k + 1 for k in f.ordinals], "printed": [show(x) for x in f.printed],
            "consistent": None if not f.consistent and f.kind in ("objection", "principle") else [show(x) for x in f.consistent], "proved": f.proved,
            "possible": [{"equation": n, "term": [k + 1 for k in r.ordinals], "slip": r.slip,
                          "printed": [show(x) for x in r.printed], "edited": [show(x) for x in r.consistent]} for n, r in f.possible],
            "readings": "all" if f.readings is None or len(f.readings) == len(report.readings) else f.readings,
            "alternatives": [{"reading": name, "consistent": [show(x) for x in forms]} for name, forms in f.alternatives.items()],
            "judgements": f.judgements, "order": f.order, "vanishes": f.vanishes, "effects": f.effects or None,
        } for f in report.findings],
        "constructed": [{
            "of": c.of, "lagrangian": c.lagrangian is not None, "why_not": c.why,
            "statements": [{"text": words, "form": None if form is None else show(form)} for words, form in construction_parts(c, paper)],
        } for c in report.constructed],
        "impacts": [{
            "equation": number, "reading": name, "change_of_energy": show(i.change),
            "can_rise": {"case": i.rises[0], "rates": i.rises[1]} if i.rises else False if i.rises is None else None,
            "impulses": {n: show(form) for n, form in i.impulses.items()}, "goes_through_its_bound": i.penetrates,
        } for (number, name), i in report.impacts.items()],
        "variants": report.simulated.variants if report.simulated else None,
        "effects": report.simulated and {"corrected": {scene: found[0] for scene, found in report.simulated.slips.items()},
                                         "corrected_tighter": report.simulated.again, "show_nowhere": hidden(report)},
        "definiteness": [{
            "name": d.name, "determinant_at_rest": None if d.at_rest is None else str(closed(d.at_rest)),
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
        "undefined_symbols": {name: paper.symbols[name].meaning for name in undefined_symbols(paper)},
    }


def as_json(report):
    """The report as JSON text."""
    return json.dumps(as_dictionary(report), indent=2, ensure_ascii=False) + "\n"
