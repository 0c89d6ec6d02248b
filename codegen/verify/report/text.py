"""The report as text for a terminal."""

from ..judgements import TITLES
from .construction import construction_parts
from .show import message_text
from .words import (READING_HEAD, alternative_lines, consistent_label, consistent_parts, determinant_lines, effect_lines, effect_notes,
                    extent_lines, headline, judged_text, judgement_text, number_parts, origin_line, outcome_text, possible_lines,
                    printed_parts, reading_rows, reading_text, reason_lines, root_lines, scale_lines, singular_lines, squares_text, summary_lines,
                    transcription_lines, undefined_symbols, verdict_text)


def as_text(report):
    """The report for a terminal."""
    case, paper = report.case, report.case.paper

    def show(sentence):
        return message_text(sentence, paper)

    lines = [f"{case.name}: {paper.title}", f"source: {paper.source}", origin_line(report), "", *transcription_lines(report),
             *map(show, scale_lines(report) + singular_lines(report)), ""]
    lines += summary_lines(report) + [""]
    if report.readings:
        for number, c in report.comparisons[report.readings[0].name].items():
            lines.append(f"  ({number})  {len(c.agree)} of {c.terms()} terms agree")
        lines.append("")
    if len(report.readings) > 1:
        lines.append("Readings (energies that the paper may mean), the best first")
        for row in reading_rows(report):
            lines += [f"  {row[0]}"] + [f"    {head}: {cell}" for head, cell in zip(READING_HEAD[1:], row[1:])]
        lines.append("")
    lines.append("Judgements on the printed equations")
    for name in TITLES:
        lines.append("  " + judgement_text(report, name))
        if name != "difference":
            lines += ["    " + show(v.message) for v in report.violations[name]]
    lines += ["", headline(report)]
    for f in report.findings:
        where = f", terms {', '.join(str(k + 1) for k in f.ordinals)}" if f.ordinals else ""
        label = consistent_label(f) + ":"
        lines += ["", f"  [{f.key}] equation ({f.equation}){where}", f"    printed:    {show(printed_parts(f))}",
                  f"    {label:11} {show(consistent_parts(f))}"]
        lines += [f"    {show(line)}" for line in alternative_lines(f) + reason_lines(f) + possible_lines(f)]
        lines += [f"    {line}" for line in [reading_text(f, report)] if line]
        lines.append("    found by: " + judged_text(f))
        lines += [f"    {line}" for line in extent_lines(f) + effect_lines(f)]
    if notes := effect_notes(report):
        lines += ["", "Effect of the slips on the motion"] + [f"  {line}" for line in notes]
    if report.simulated:
        lines += ["", "The scenes with the equations as a whole"]
        for scene, results in report.simulated.variants.items():
            lines.append(f"  {scene}")
            lines += [f"    {name}: {outcome_text(result)}" for name, result in results.items()]
    for constructed in report.constructed:
        lines += ["", f"What follows from the equations {constructed.of}"]
        lines += [f"  {show([words] + ([] if form is None else [form]))}" for words, form in construction_parts(constructed, paper)]
    if report.definiteness:
        lines += ["", "Positive definite kinetic energy"]
    for d in report.definiteness:
        lines += [f"  {d.name}"] + [f"    {show(line)}" for line in determinant_lines(d, paper)]
        lines += [f"      {line}" for line in root_lines(d)]
        if d.squares is not None:
            lines.append("    " + squares_text(d))
        lines += [f"    {key}: {verdict_text(v)}" for key, v in d.boxes.items()]
    if report.numbers:
        lines += ["", "Printed numbers (recomputed as an interval over the rounding of what they come from)"]
    lines += ["  " + show(number_parts(x)) for x in report.numbers]
    if undefined := undefined_symbols(paper):
        lines += ["", "Symbols that the paper uses and does not define"]
        lines += [f"  {name}: {paper.symbols[name].meaning}" for name in undefined]
    return "\n".join(lines) + "\n"
