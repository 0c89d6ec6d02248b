"""The report as a document: a summary of one page, what is judged, the equations as printed and as they are consistent, the
judgements, the findings, and what follows. html.py and tex.py write it."""

from ..input import transcription
from ..judgements import TITLES
from . import words
from .aligned import aligned
from .blocks import Card, Display, Document, Heading, Items, Link, PageBreak, Paragraph, Strong, Table, Terms
from .construction import construction_parts
from .show import Unit, symbol_latex

# Rows of the ranked table that a page holds beside what stands above it.
ROWS = 22


def document(report):
    """The document of a report."""
    paper = report.case.paper
    blocks = [*_summary(report), PageBreak(), *_judged(report), *_equations(report), *_readings(report), *_judgements(report),
              *_findings(report), *_effects(report), *_constructed(report), *_definiteness(report), *_numbers(report),
              *_symbols(report), *_again(report)]
    return Document(paper.title, report.case.name, blocks, paper, paper.source)


def anchor(finding):
    """The anchor of a finding."""
    return f"finding-{finding.key}"


def _summary(report):
    """What a reader with one minute reads."""
    blocks = [Paragraph([words.origin_line(report)], "faint"), Heading("Summary"),
              Paragraph([Strong(words.headline(report) + ".")])]
    blocks += [Paragraph([line]) for line in words.summary_lines(report) + words.transcription_lines(report)]
    ranked = [(k, f) for k, f in enumerate(report.findings, 1) if f.kind in ("misprint", "repair", "objection", "principle")]
    shown, rest = ranked[:ROWS], ranked[ROWS:]
    if shown:
        several = len(report.readings) > 1
        head = ["", "finding", "equation", "printed", "consistent", "what it is"] + ["readings"] * several
        rows = [[[str(k)], [Link(f.key, anchor(f))], [f"({f.equation})" if f.equation != "text" else "text"], _short(words.printed_parts(f)),
                 _short(words.consistent_parts(f)) if f.kind != "principle" else ["see the finding"], [_kind(f)],
                 *[[_holds(report, f)]] * several] for k, f in shown]
        blocks.append(Table(head, rows, [.035, .12, .1, .245, .245, .15, .105] if several else [.045, .145, .09, .275, .275, .17]))
    if rest:
        blocks.append(Paragraph(["Further of these: ", *words.joined([Link(f.key, anchor(f)) for _, f in rest], ", "), "."]))
    for kind, text in (("approximation", "Approximations"), ("choice", "Choices, which depend on the reading or the model"),
                       ("undefined", "Symbols that are not defined")):
        if found := [Link(f.key, anchor(f)) for f in report.findings if f.kind == kind]:
            blocks.append(Paragraph([f"{text}: ", *words.joined(found, ", "), "."]))
    return blocks


def _short(parts):
    """A sentence for a cell of the summary: what is longer than two terms is in the finding."""
    return parts if len(parts) <= 3 else [*parts[:3], ", …"]


def _kind(finding):
    """What a finding is, in a word or two."""
    if finding.slip:
        return finding.slip
    return {"principle": "principle of mechanics", "repair": "slip"}.get(finding.kind, finding.kind)


def _holds(report, finding):
    """In how many readings a finding holds."""
    if finding.readings is None or len(finding.readings) == len(report.readings):
        return "all"
    return f"{len(finding.readings)} of {len(report.readings)}"


def _judged(report):
    """The energies of the reading whose findings are shown."""
    if not report.readings:
        return [Heading("What is judged"), Paragraph(["No energies are given: the equations are judged by themselves."])]
    reading, d = report.readings[0], report.definiteness[-len(report.readings)]
    motion = reading.motion
    blocks = [Heading("What is judged"), Paragraph([
        f"The reading '{reading.name}'" + (f" ({motion.energies.description})" if motion.energies.description else "")
        + (", the best of those below. With its energies" if len(report.readings) > 1 else ". With the energies")])]
    if d.squares:
        squares = motion.energies.squares(motion.s, motion.m)
        parts = []
        for coefficient, velocity in squares:
            coefficient, velocity = motion.ring.read(coefficient), motion.ring.read(velocity)
            if coefficient:
                single = len(coefficient.terms) == 1
                parts += [*([" + "] if parts else []), "½ " if single else "½ (", coefficient, " (" if single else ") (", velocity, ")²"]
        blocks.append(Paragraph(["T = ", *parts]))
    else:
        blocks.append(Paragraph(["T = ", motion.kinetic]))
    blocks.append(Paragraph(["V = ", motion.potential]))
    if motion.dissipation:
        blocks.append(Paragraph(["D = ", motion.dissipation, " (Rayleigh's function)"]))
    for name, force in motion.energies.forces.items():
        blocks.append(Paragraph([f"generalized force on {motion.paper.shown(name)}: ", motion.ring.read(force(motion.s, motion.m))]))
    blocks.append(Paragraph(["Lagrange's equations of these are what the printed equations are compared with, term by term."]))
    return blocks


def _equations(report):
    """Each equation as printed, and below it, term by term, as it is consistent."""
    paper = report.case.paper
    blocks = [Heading("The equations as printed, and as they are consistent"),
              Paragraph(["Above, as printed: the energies do not give what is marked. Below, where something is found, the terms one by one, those "
                         "of an equation of motion as left side minus right side: printed above, consistent below, with the numbers of the findings."])]
    blocks += [Paragraph(line) for line in words.scale_lines(report) + words.singular_lines(report)]
    found = report.comparisons[report.motions[0].energies.name] if report.motions else {}
    for number, equation in paper.equations.items():
        comparison = found.get(number)
        total = len(report.printed.forms[number])
        count = f": {len(comparison.agree)} of {total} terms agree" if comparison else ": not judged by energies"
        blocks.append(Heading(f"({number}) {equation.title}{count}", 3, f"equation-{number}"))
        marks = {k: "differ" for k in comparison.differ} if comparison else {}
        if equation.latex:
            blocks.append(Display(transcription.statement(equation, paper), marks))
        pairs = aligned(report, number)
        if not equation.latex or any(pair.findings for pair in pairs):
            blocks.append(Terms(pairs, *_around(equation, paper), [anchor(f) for f in report.findings]))
        elif comparison and comparison.absent:
            blocks.append(Paragraph(["derived and not printed: ", *words.joined(comparison.absent)]))
        if about := [Link(f.key, anchor(f)) for f in report.findings if number in f.equation.split(", ")]:
            blocks.append(Paragraph(["findings: ", *words.joined(about, ", ")], "faint"))
    return blocks


def _around(equation, paper):
    """What stands before and behind the terms: a symbol with words, and words."""
    of = symbol_latex(equation.of, paper)
    if equation.kind == "motion":
        return ("", ""), "= 0"
    if equation.kind == "condition":
        return ("", ""), "> 0"
    if equation.kind == "rule":
        return (of, f"= {equation.result} if"), f"{equation.relation} 0"
    return (symbol_latex("d" + equation.of, paper), "after =") if equation.kind == "reset" else (of, "="), ""


def _readings(report):
    """The readings, the best first."""
    if len(report.readings) < 2:
        return []
    return [Heading("Readings: energies that the paper may mean, the best first"),
            Table(list(words.READING_HEAD), [[[cell] for cell in row] for row in words.reading_rows(report)], [.16, .28, .2, .14, .12, .1])]


def _judgements(report):
    """The objections of each judgement."""
    blocks = [Heading("Judgements on the printed equations")]
    for name in TITLES:
        blocks.append(Heading(words.judgement_text(report, name), 3))
        if name != "difference" and report.violations[name]:
            blocks.append(Items([Paragraph(list(v.message)) for v in report.violations[name]]))
    return blocks


def _findings(report):
    """The findings in their order."""
    blocks = [Heading(words.headline(report))]
    for k, f in enumerate(report.findings, 1):
        where = f", term {', '.join(str(i + 1) for i in f.ordinals)}" if f.ordinals else ""
        inside = [Paragraph(["printed: ", *words.printed_parts(f)]),
                  Paragraph([f"{words.consistent_label(f)}: ", *words.consistent_parts(f)])]
        inside += [Paragraph(line) for line in words.alternative_lines(f) + words.reason_lines(f) + words.possible_lines(f)]
        inside += [Paragraph([line]) for line in [words.reading_text(f, report)] if line]
        inside.append(Paragraph(["found by: " + ("; ".join(map(words.title, f.judgements)) or words.judged_text(f))]))
        inside += [Paragraph([line]) for line in words.extent_lines(f) + words.effect_lines(f)]
        inside.append(Paragraph(["to the equation: ", *words.joined([Link(f"({n})", f"equation-{n}") for n in f.equation.split(", ")], ", ")], "faint")
                      if f.equation != "text" else Paragraph(["in the text"], "faint"))
        blocks.append(Card(f.kind, f"{k}. {f.key}: equation ({f.equation}){where}", anchor(f), inside))
    return blocks


def _effects(report):
    """What was simulated."""
    notes = words.effect_notes(report)
    if not notes:
        return []
    blocks = [Heading("Effect of the slips on the motion")] + [Paragraph([line]) for line in notes]
    if report.simulated is None:
        return blocks
    names = list(report.case.effects.quantities)
    shown = [f for f in report.findings if any(e["changes"] for e in f.effects.values())]
    scenes = [scene for scene, found in report.simulated.slips.items() if "stopped" not in found[0]]
    if shown:
        def cell(finding, scene):
            e = finding.effects[scene]
            return "stops early" if "stopped" in e["changes"] else ", ".join(
                f"{n}: {e['with'][n]:.6g}" for n in e["changes"]) or "—"

        rows = [[["corrected"], *[[", ".join(f"{n}: {report.simulated.slips[scene][0][n]:.6g}" for n in names)] for scene in scenes]]]
        rows += [[[Link(f.key, anchor(f))], *[[cell(f, scene)] for scene in scenes]] for f in shown]
        blocks.append(Table(["with this slip", *scenes], rows, [.16] + [.84 / len(scenes)] * len(scenes)))
    rows = [[[scene], [name], *[[f"{result[n]:.6g}"] for n in names], [result.get("stopped", "")]]
            for scene, results in report.simulated.variants.items() for name, result in results.items()]
    return blocks + [Heading("The scenes with the equations as a whole", 3),
                     Table(["scene", "equations", *names, "stopped early"], rows, [.18, .18] + [.24 / len(names)] * len(names) + [.4])]


def _constructed(report):
    """What follows from the equations alone."""
    blocks = []
    for constructed in report.constructed:
        blocks.append(Heading(f"What follows from the equations {constructed.of}"))
        blocks += [Paragraph([text] + ([] if form is None else [form])) for text, form in construction_parts(constructed, report.case.paper)]
    return blocks


def _definiteness(report):
    """The mass matrices."""
    blocks = [Heading("Positive definite kinetic energy")] if report.definiteness else []
    for d in report.definiteness:
        blocks.append(Heading(d.name, 3))
        blocks += [Paragraph(line) for line in words.determinant_lines(d, report.case.paper)]
        lines = words.root_lines(d) + ([words.squares_text(d)] if d.squares is not None else [])
        lines += [f"{key}: {words.verdict_text(v)}" for key, v in d.boxes.items()]
        if lines:
            blocks.append(Items([Paragraph([line]) for line in lines]))
    return blocks


def _numbers(report):
    """Printed numbers."""
    if not report.numbers:
        return []
    def style(x):
        return "bad" if x.agrees is False or not x.unit_agrees else "good" if x.agrees else ""

    return [Heading("Printed numbers, recomputed as intervals over the rounding of what they come from"),
            Items([Paragraph(words.number_parts(x), style(x)) for x in report.numbers])]


def _symbols(report):
    """The table of symbols."""
    paper = report.case.paper
    undefined = words.undefined_symbols(paper)
    rows = [[[report.printed.ring.symbol(n)], [Unit(x.unit.removesuffix("*s") if x.velocity else x.unit)], [("NOT DEFINED in the paper: " if n in undefined else "") + x.meaning]]
            for n, x in paper.symbols.items()]
    return [Heading("Symbols"), Table(["symbol", "unit", "meaning"], rows, [.12, .16, .72])]


def _again(report):
    """How to do it again."""
    blocks = [Heading("How to check this again"), Paragraph([
        f"This is what 'dalembert verify' of version {report.version} found on {report.date}. With --certificate it writes each claim as an "
        "identity, which a script of fifty lines with nothing but SymPy checks. The files that were read, with their SHA-256:"])]
    if report.files:
        blocks.append(Table(["file", "SHA-256"], [[[name], [digest]] for name, digest in report.files.items()], [.25, .75]))
    return blocks
