"""The sentences that all forms of the report share. A sentence is a list of parts: words, forms, dimensions, units and SymPy
expressions, which each writer shows in its own way."""

from ..input.corrections import KINDS
from ..judgements import TITLES
from ..judgements.singular import divided, nowhere_zero
from ..repairs.edits import slip_text
from .closed import closed
from .findings import FURTHER, IMPACT
from .show import Quantity, Unit


def count(number, what):
    """A number of things."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def joined(parts, between=",  "):
    """Parts with words between them."""
    result = []
    for k, part in enumerate(parts):
        result += [between, part] if k else [part]
    return result


def transcription_lines(report):
    """Which equations are proved equal to their LaTeX, and which have none."""
    lines, paper = [], report.case.paper
    if report.transcribed:
        lines.append(f"Transcription: ({'), ('.join(report.transcribed)}) are proved equal to their LaTeX: symbol, relation, and "
                     "term by term.")
    read = [n for n, equation in paper.equations.items() if equation.function is None]
    if read:
        lines.append(f"Transcription: ({'), ('.join(read)}) are judged from their LaTeX: no terms are written beside it.")
    without = [n for n, equation in paper.equations.items() if not equation.latex]
    if without:
        lines.append(f"Transcription: ({'), ('.join(without)}) have no LaTeX; what is judged is the function alone.")
    return lines


def scale_lines(report):
    """What equations are divided by, if they are, as sentences."""
    lines, one = [], report.printed.ring.number(1)
    for number, scale in report.printed.scales.items():
        if report.motions and (comparison := report.comparisons[report.motions[0].energies.name].get(number)):
            scale = comparison.scale
            if comparison.solved:
                of = report.printed.ring.symbol("dd" + report.case.paper.equations[number].of)
                lines.append([f"Equation ({number}) is judged as solved for the acceleration ", of]
                             + (["."] if scale == one else [", and multiplied by ", scale, *_elsewhere(report, scale)]))
                continue
        elif report.printed.multipliers[number].names() - report.printed.ring.involutions:
            # without energies, what makes the mass matrix symmetric
            scale = report.printed.multipliers[number]
        if scale != one:
            lines.append([f"Equation ({number}) is judged as multiplied by ", scale, *_elsewhere(report, scale)])
    return lines


def _elsewhere(report, scale):
    """Where an equation and its multiple do not say the same, behind the multiplier."""
    moving = set(report.case.paper.positions())
    if not scale.names() & moving or scale.over:
        return ["."]
    left, used = divided(scale, report.printed.singular)
    declared = "; they say the same but in configurations that are declared singular" if used else ""
    if not left.names() & moving or nowhere_zero(left, report.case.paper):
        return [declared + "."]
    return [f"{declared}; where ", left, " is zero they do not say the same."]


def singular_lines(report):
    """The singular configurations that are declared, and what is singular there, as sentences."""
    lines = []
    for found in report.singular:
        why = ["the determinant of the mass matrix is zero there"] if found.mass else []
        why += [f"({'), ('.join(found.divided)}) {'was' if len(found.divided) == 1 else 'were'} divided by what is zero there"] if found.divided else []
        # what a manuscript declares shows by itself
        lines.append(["Declared singular, and not judged: ", *([] if "=" in found.where else [f"{found.where}, where "]), found.form, " = 0: "
                      + ("; ".join(why) if why else "nothing that is judged is singular there") + "."])
    return lines


def title(name):
    """The name of a judgement in words."""
    return IMPACT if name == "impact" else TITLES[name]


def summary_lines(report):
    """The verdict in a few sentences."""
    lines = []
    if report.readings:
        best = report.readings[0]
        lines.append(agreement_text(best.motion, report.comparisons[best.name]) + ".")
    if len(report.readings) > 1:
        always, sometimes = report.wrong_terms()
        lines.append(f"{count(len(report.readings), 'reading')}: {count(len(always), 'printed term')} "
                     f"{'is' if len(always) == 1 else 'are'} wrong in every one, {len(sometimes)} only in some, and what these say is a choice.")
    kinds = {}
    for finding in report.findings:
        kinds[finding.kind] = kinds.get(finding.kind, 0) + 1
    if kinds:
        lines.append("Findings by kind: " + ", ".join(f"{number} {kind}" for kind, number in kinds.items()) + ".")
    return lines


VERDICT = {"squares": "T is a sum of squares", "proved": "positive definite (proved)", "undecided": "definiteness undecided", "refuted": "NOT positive definite"}


def reading_rows(report):
    """The readings, the best first: name, definiteness, reactions, invariances, terms."""
    rows = []
    for r in report.readings:
        refuted = [key for key, v in r.boxes.items() if v.status == "refuted"]
        undecided = [key for key, v in r.boxes.items() if v.status == "undecided"]
        definite = VERDICT[r.verdict()] + (f" for {len(refuted)} of {len(r.boxes)} cases: {'; '.join(refuted)}" if refuted
                                           else f" for {len(undecided)} of {len(r.boxes)} cases" if undecided and r.verdict() == "undecided" else "")
        reactions = _reactions_text(r.reactions)
        objected = [f"{len(v)} to {TITLES[name].lower()}" for name, v in r.objections.items() if v]
        rows.append((r.name, definite, reactions, ", ".join(objected) or "none", f"{r.agree} of {r.terms}", str(r.absent)))
    return rows


def _reactions_text(reactions):
    """The least reaction in the scenes, at the start and along the motion."""
    worst = min(reactions, key=lambda x: x.low, default=None)
    if worst is None:
        return "not judged"
    if not worst.low > 0:
        return f"{worst.low:.4g} N ({worst.release}; {worst.case}): what only pushes would pull"
    text = f"at least {worst.low:.4g} N at the start (proved)"
    least = min((x for x in reactions if x.least), key=lambda x: x.least.value, default=None)
    if least is None:
        return text
    where = f"{least.least.value:.4g} N at t = {least.least.time:.3g} s (computed; {least.release}; {least.case})"
    return text + (f"; along the motion at least {where}" if least.pushes() else f"; along the motion {where}: what only pushes would pull")


READING_HEAD = ("reading", "kinetic energy", "reactions in the scenes", "objections to invariance", "printed terms that agree", "derived, not printed")


def reading_text(finding, report):
    """In which readings a finding holds."""
    if finding.readings is None or finding.kind == "undefined":
        return ""
    if len(finding.readings) == len(report.readings):
        return "holds in every reading" + ("; what would be consistent depends on it" if finding.alternatives else "")
    return "a choice: holds in " + ", ".join(f"'{name}'" for name in finding.readings) + "; in the others what is printed is right"


def alternative_lines(finding):
    """What would be consistent in other readings than the first, as sentences."""
    by_forms = {}
    for name, forms in finding.alternatives.items():
        by_forms.setdefault(str(forms), (forms, []))[1].append(name)
    return [[f"consistent in {', '.join(repr(n) for n in names)}: ", *(joined(forms) or ["(no such term)"])] for forms, names in by_forms.values()]


def agreement_text(motion, comparisons):
    """How many printed terms agree with energies."""
    agree = sum(len(c.agree) for c in comparisons.values())
    total, idle = sum(c.terms() for c in comparisons.values()), sum(len(c.idle) for c in comparisons.values())
    return (f"Energies '{motion.energies.name}': {agree} of {total} printed terms agree, "
            + (f"{idle} cancel one another or vanish, " if idle else "")
            + f"{sum(len(c.absent) for c in comparisons.values())} derived terms are not printed")


def judgement_text(report, name):
    """The number of objections of a judgement, before and after correction; or why it is not judged."""
    if name in report.unjudged:
        return f"{TITLES[name]}: not judged: {report.unjudged[name]}"
    after = "as corrected" if report.by_hand else "with the repairs below"
    text = f"{TITLES[name]}: {count(len(report.violations[name]), 'objection')}"
    if report.by_hand or any(finding.kind == "repair" for finding in report.findings):
        text += f" ({len(report.corrected_violations[name])} {after})"
    if name == "difference" and report.unreferenced:
        text += f"; the energies say nothing about ({'), ('.join(report.unreferenced)})"
    if name == "lagrangian" and (lonely := unmoved(report)):
        text += f"; nothing is judged about the motion of {', '.join(lonely)}, which has no equation"
    return text


def unmoved(report):
    """Coordinates without an equation of motion."""
    moved = {equation.of for equation in report.case.paper.motions()}
    return [name for name in report.case.paper.coordinates() if name not in moved]


def headline(report):
    """The number of findings, and what was not judged: without it, none is no verdict."""
    text = count(len(report.findings), "finding")
    open_ = [TITLES[name].lower() for name in report.unjudged]
    if "difference" not in report.unjudged and report.unreferenced:
        open_.append(f"what ({'), ('.join(report.unreferenced)}) must be")
    return text + (f"; not judged: {', '.join(open_)}" if open_ else "")


def origin_line(report):
    """What made the report, of what and when."""
    words = f"dalembert {report.version}, {report.date}"
    return words + (f"; input SHA-256 {report.digest()}" if report.files else "")


def printed_parts(finding):
    """What is printed."""
    if finding.printed:
        return joined(finding.printed)
    return ["(the equation as a whole)" if finding.kind == "objection" else "(not printed)"]


def consistent_parts(finding):
    """What would be consistent, or that it is not known."""
    if finding.kind == "objection":
        return ["not known"]
    return joined(finding.consistent) or ["(no such term)"]


def possible_lines(finding):
    """The edits with each of which an objection vanishes: none is proved to be what was meant."""
    lines = []
    for number, repair in finding.possible:
        where = f"({number})" + (f" term {repair.ordinals[0] + 1}" if repair.ordinals else "")
        before = joined(repair.printed) or ["(not printed)"]
        after = joined(repair.consistent) or ["(no such term)"]
        lines.append([f"would remove it and raise no other: {where}: ", *before, " → ", *after, f": {slip_text(repair.slip)}"])
    return lines


def consistent_label(finding):
    """Whether what is called consistent is proved so."""
    return "consistent" if finding.proved or finding.kind == "objection" else "proposed, not proved consistent"


def kind_text(finding):
    """What kind of slip a finding is; empty for what its reason says."""
    known = {**KINDS, **{k: v for k, v in FURTHER.items() if k not in ("repair", "objection")}}
    return slip_text(finding.slip) if finding.slip else known.get(finding.kind, "")


def reason_lines(finding):
    """What kind of slip a finding is, and why: the last of these sentences may have formulas."""
    lines = [[("slip: " if finding.slip else "") + words] for words in [kind_text(finding)] if words]
    return lines + ([finding.reason if isinstance(finding.reason, list) else [finding.reason]] if finding.reason else [])


def judged_text(finding):
    """Who finds it."""
    if finding.kind == "undefined":
        return "the table of symbols"
    return ", ".join(finding.judgements) or "no judgement: nothing here shows that what is printed is wrong"


def undefined_symbols(paper):
    """Names of the symbols that a paper uses and does not define."""
    return [name for name in paper.definitions if name not in paper.auxiliary]


def extent_lines(finding):
    """How small a finding is, and where it vanishes."""
    lines = [] if finding.order is None else [f"order in the coordinates: {finding.order}"]
    return lines + (["makes no difference for " + ", ".join(finding.vanishes)] if finding.vanishes else [])


def effect_lines(finding):
    """What a slip does to the scenes in which it shows, a line a scene."""
    lines = []
    for scene, effect in finding.effects.items():
        if "stopped" in effect["changes"]:
            lines.append(f"effect on {scene}: the run stops {effect['with']['stopped']}")
        elif effect["changes"]:
            lines.append(f"effect on {scene}: " + ", ".join(
                f"{name} {effect['without'][name]:.6g} → {effect['with'][name]:.6g}" for name in effect["changes"]))
    return lines


def hidden(report):
    """The names of the simulated slips that show in no scene."""
    return [f.key for f in report.findings if f.effects and not any(e["changes"] for e in f.effects.values())]


def effect_notes(report):
    """What was simulated, and what shows nowhere, as sentences."""
    if report.simulated is None:
        return ["The effect of the slips on the motion was not simulated."] if any(f.kind in KINDS for f in report.findings) else []
    lines = ["Each slip alone was put into the corrected equations. What it changes by no more than a run of the corrected equations changes "
             "that is " + " and ".join(report.case.effects.tighter) + " does not show."]
    for scene, found in report.simulated.slips.items():
        base = found[0]
        lines.append(f"{scene}, corrected: {outcome_text(base)}" + (
            "; since this run stops, nothing is said of slips in it" if "stopped" in base else "; "
            + ", ".join(f"{name} uncertain by {abs(report.simulated.again[scene][name] - base[name]):.1g}" for name in report.case.effects.quantities)))
    if keys := hidden(report):
        lines.append(f"Shows in none of these scenes: {', '.join(keys)}.")
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


def squares_text(definiteness):
    """Whether the kinetic energy is the declared sum of squares."""
    if definiteness.squares:
        return "the kinetic energy is the declared sum of squares (identity proved)"
    return "the kinetic energy is NOT the declared sum of squares"


def determinant_lines(definiteness, paper):
    """The determinant at rest, without what is negligible, and the coefficients of the critical value, as sentences."""
    if definiteness.at_rest is None:
        return [["determinant at rest: none, since a divisor vanishes there; a box without zero says where else it rests"]]
    over = [part for form, power in definiteness.powers.items() for part in (", divided by (", form, f")^{power}")]
    lines = [["determinant at rest", *over, ": ", closed(definiteness.at_rest)]]
    if definiteness.neglected is not None:
        zero = " = ".join([*paper.negligible, "0"])
        lines.append([f"with {zero}: "] + ([closed(definiteness.neglected)] if definiteness.neglected else ["0 (singular)"]))
    if definiteness.critical:
        name = definiteness.critical.parameter
        lines.append([f"critical {name}: roots of c0 + c1 {name} + c2 {name}^2"])
        lines += [[f"c{k} = ", closed(c) if c else "0"] for k, c in enumerate(definiteness.critical.coefficients)]
    return lines


def root_lines(definiteness):
    """The critical values by parameter set and state."""
    roots = definiteness.critical.roots.items() if definiteness.critical else ()
    return [f"{key}: {', '.join(f'{root:.6g}' for root in found) or 'none'}" for key, found in roots]


def number_parts(checked):
    """One number with its verdict."""
    n = checked.number
    parts = [f"{n.name} = ", Quantity(f"{n.printed} {n.unit_printed or n.unit}")] if n.printed else [f"{n.name} [", Unit(n.unit), "] not printed"]
    text = ""
    if checked.low is not None:
        text += f"; recomputed {checked.low:.6g}" + (f" to {checked.high:.6g}" if f"{checked.low:.6g}" != f"{checked.high:.6g}" else "")
    if checked.agrees is not None:
        text += ": agrees" if checked.agrees else ": DISAGREES"
    elif checked.low is not None and n.printed:
        text += ": cannot be decided"
    parts.append(text)
    if not checked.unit_agrees:
        parts += ["; the unit must be ", Unit(n.unit)]
    return parts + [f"   ({n.meaning}{'; ' + n.note if n.note else ''})"]
