"""The report as one self-contained HTML page: MathML, no script, no network."""

import re
from html import escape
from pathlib import Path

from ..input import transcription
from ..input.units import Dimension
from ..judgements import TITLES
from . import mathml
from .closed import closed
from .show import form_latex
from .text import (READING_HEAD, agreement_text, consistent_label, consistent_text, effect_lines, extent_lines, headline, judged_text,
                   judgement_text, number_text, possible_lines, printed_text, reading_rows, reason_lines, scale_lines, squares_text, title, transcription_lines,
                   undefined_symbols, verdict_text)

STYLE = """
body { font-family: Georgia, "DejaVu Serif", serif; max-width: 62rem; line-height: 1.5; }
h1, h2, h3, table { font-family: system-ui, "DejaVu Sans", "Liberation Sans", sans-serif; }
h2 { border-bottom: 1px solid var(--rule); padding-bottom: .2em; } h3 { font-size: 1rem; }
.equation { overflow-x: auto; padding: .3em 0; }
.differ { color: var(--alarm); background: color-mix(in srgb, var(--alarm) 12%, transparent); } .agree { color: inherit; }
.absent { color: var(--accent); }
.finding { border-left: 4px solid var(--alarm); padding-left: 1em; margin: 1.2em 0; break-inside: avoid; }
.finding.approximation { border-color: var(--s5); } .finding.choice { border-color: var(--accent); }
.tag { font: 13px system-ui, sans-serif; background: var(--wash); border-radius: 3px; padding: .1em .5em; margin-right: .3em; }
.bad { color: var(--alarm); } .good { color: var(--good); }
"""
"""What is of reports alone; the rest of the style they share with the pages of runs."""


def _shared():
    """The style of all pages."""
    return (Path(__file__).parents[2] / "page.css").read_text(encoding="utf-8")


def inline(form, paper):
    """A form, or words, inside a sentence."""
    if isinstance(form, str):
        return escape(form)
    if isinstance(form, Dimension):
        return re.sub(r"\^(-?[\d/]+)", lambda power: f"<sup>{power[1].replace('-', '−')}</sup>", escape(str(form))).replace("*", " ")
    return mathml.mathml_inline(form_latex(form, paper))


def as_html(report):
    """The page as text."""
    case, paper = report.case, report.case.paper
    out = ["<!DOCTYPE html>", '<html lang="en"><head><meta charset="utf-8">', f"<title>{escape(case.name)}: verification</title>",
           f"<style>{_shared()}{STYLE}</style></head><body>", f"<h1>{escape(paper.title)}</h1>", f"<p>{escape(paper.source)}</p>"]
    out += _equations(report) + _readings(report) + _judgements(report)
    out.append(f"<h2>{escape(headline(report))}</h2>")
    for finding in report.findings:
        out += _finding(finding, paper)
    out += _variants(report) + _definiteness(report) + _numbers(report)
    out.append("</body></html>")
    return "\n".join(out) + "\n"


def _equations(report):
    """The printed equations with the differing terms marked, and the derived terms that are absent."""
    paper, out = report.case.paper, ["<h2>The equations as printed</h2>",
                                     '<p><span class="differ">Marked</span>: the energies do not give this term. '
                                     '<span class="absent">Blue</span>: the energies give this term too.</p>']
    found = report.comparisons[report.motions[0].energies.name] if report.motions else {}
    out += [f"<p>{escape(line)}</p>" for line in transcription_lines(report)]
    out += [f"<p>{line}</p>" for line in scale_lines(report, lambda form: inline(form, paper))]
    out += [f"<p>{escape(agreement_text(motion, report.comparisons[motion.energies.name]))}.</p>" for motion in report.motions[:1]]
    for number, equation in paper.equations.items():
        comparison = found.get(number)
        marks = {k: "differ" for k in comparison.differ} if comparison else {}
        total = len(report.printed.forms[number])
        count = f": {len(comparison.agree)} of {total} terms agree" if comparison else ": not judged by energies"
        out.append(f"<h3>({escape(number)}) {escape(equation.title)}{count}</h3>")
        if equation.latex:
            out.append(f'<div class="equation">{mathml.mathml(transcription.statement(equation, paper), marks)}</div>')
        else:
            terms = []
            for k, form in enumerate(report.printed.forms[number]):
                sign = "" if form_latex(form, paper).startswith("-") or not k else "<mo>+</mo>"
                terms.append(f'<span class="{marks.get(k, "agree")}">'
                             f'{"<math>" + sign + "</math>" if sign else ""}{inline(form, paper)}</span>')
            out.append(f'<div class="equation">{" ".join(terms)}</div>')
        if comparison and comparison.absent:
            out.append('<p class="absent">' + ", ".join(inline(form, paper) for form in comparison.absent) + "</p>")
    return out


def _readings(report):
    """The readings, the best first."""
    if len(report.readings) < 2:
        return []
    head = "".join(f"<th>{escape(x)}</th>" for x in READING_HEAD)
    rows = "".join("<tr>" + "".join(f"<td>{escape(x)}</td>" for x in row) + "</tr>" for row in reading_rows(report))
    return ["<h2>Readings: energies that the paper may mean, the best first</h2>", f"<table><tr>{head}</tr>{rows}</table>"]


def _judgements(report):
    """The objections of each judgement."""
    out = ["<h2>Judgements</h2>"]
    for name in TITLES:
        violations = report.violations[name]
        out.append(f"<h3>{escape(judgement_text(report, name))}</h3>")
        if name != "difference" and violations:
            items = "".join("<li>" + "".join(escape(p) if isinstance(p, str) else inline(p, report.case.paper) for p in v.message)
                            + "</li>" for v in violations)
            out.append(f"<ul>{items}</ul>")
    return out


def _finding(finding, paper):
    """One finding."""
    def show(part):
        return inline(part, paper)

    out = [f'<div class="finding {finding.kind}"><h3>{escape(finding.key)}: equation ({escape(finding.equation)})</h3>',
           f'<p>printed: <span class="differ">{printed_text(finding, show)}</span><br/>'
           f'{consistent_label(finding)}: {consistent_text(finding, show)}</p>']
    out += [f"<p>{escape(line)}</p>" for line in reason_lines(finding)]
    out += [f"<p>{line}</p>" for line in possible_lines(finding, show)]
    out.append("<p>" + ("".join(f'<span class="tag">{escape(title(name))}</span>' for name in finding.judgements)
                        or escape(judged_text(finding))) + "</p>")
    out += [f"<p>{escape(line)}</p>" for line in extent_lines(finding) + effect_lines(finding)]
    return out + ["</div>"]


def _variants(report):
    """The scenes with the equations as a whole."""
    if not report.variants:
        return []
    names = list(next(iter(next(iter(report.variants.values())).values())))
    head = "".join(f"<th>{escape(name)}</th>" for name in ["scene", "equations", *names, "stopped early"])
    out = [f"<h2>The scenes with the equations as a whole</h2><table><tr>{head}</tr>"]
    for scene, results in report.variants.items():
        for name, result in results.items():
            values = [f"{result[n]:.6g}" for n in names] + [result.get("stopped", "")]
            cells = "".join(f"<td>{escape(value)}</td>" for value in [scene, name, *values])
            out.append(f"<tr>{cells}</tr>")
    return out + ["</table>"]


def _definiteness(report):
    """The mass matrices."""
    if not report.definiteness:
        return []
    paper, out = report.case.paper, ["<h2>Positive definite kinetic energy</h2>"]
    for d in report.definiteness:
        out.append(f"<h3>{escape(d.name)}</h3><p>determinant at rest: <code>{escape(str(closed(d.at_rest)))}</code></p>")
        if d.neglected is not None:
            value = escape(str(closed(d.neglected))) if d.neglected else "0: singular"
            out.append(f"<p>with {escape(' = '.join(paper.negligible))} = 0: <code>{value}</code></p>")
        if d.critical:
            rows = "".join(f"<tr><td>{escape(key)}</td><td>{', '.join(f'{r:.6g}' for r in roots) or 'none'}</td></tr>"
                           for key, roots in d.critical.roots.items())
            terms = ", ".join(f"c{k} = {closed(c) if c else 0}" for k, c in enumerate(d.critical.coefficients))
            out.append(f"<p>critical {escape(d.critical.parameter)}: roots of the quadratic with "
                       f"<code>{escape(terms)}</code></p><table>{rows}</table>")
        if d.squares is not None:
            out.append(f"<p>{escape(squares_text(d))}</p>")
        if d.boxes:
            items = "".join(f"<li>{escape(key)}: {escape(verdict_text(v))}</li>" for key, v in d.boxes.items())
            out.append(f"<ul>{items}</ul>")
    return out


def _numbers(report):
    """Printed numbers and undefined symbols."""
    paper, out = report.case.paper, []
    if report.numbers:
        out.append("<h2>Numbers</h2><ul>")
        for x in report.numbers:
            style = "bad" if x.agrees is False or not x.unit_agrees else "good" if x.agrees else ""
            out.append(f'<li class="{style}">{escape(number_text(x))}</li>')
        out.append("</ul>")
    if undefined := undefined_symbols(paper):
        out.append("<h2>Symbols that the paper uses and does not define</h2><ul>")
        out += [f"<li>{escape(name)}: {escape(paper.symbols[name].meaning)}</li>" for name in undefined]
        out.append("</ul>")
    return out
