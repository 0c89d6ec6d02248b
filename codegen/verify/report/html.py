"""The report as one self-contained HTML page: MathML, no script, no network."""

import re
from html import escape
from pathlib import Path

from ..input.units import Dimension
from ..normal.form import Form
from . import blocks, mathml
from .document import document
from .show import Quantity, Unit, expression_latex, form_latex

STYLE = """
body { font-family: Georgia, "DejaVu Serif", serif; max-width: 62rem; line-height: 1.5; }
h1, h2, h3, table { font-family: system-ui, "DejaVu Sans", "Liberation Sans", sans-serif; }
h2 { border-bottom: 1px solid var(--rule); padding-bottom: .2em; } h3 { font-size: 1rem; margin: 1em 0 .2em; }
a { color: var(--accent); } table { font-size: .8rem; width: 100%; } th, td { padding-right: .5rem; } td { overflow-wrap: break-word; }
.equation { overflow-x: auto; padding: .3em 0; }
.differ { color: var(--alarm); background: color-mix(in srgb, var(--alarm) 12%, transparent); }
.terms { display: flex; flex-wrap: wrap; gap: .5em .2em; padding: .3em 0 .5em; align-items: stretch; }
.pair { display: grid; grid-template-rows: auto auto; padding: 0 .25em; align-items: center; break-inside: avoid; }
.pair > span { padding: .1em 0; white-space: nowrap; } .pair.same > .after { color: var(--faint); }
.pair.changed { border: 1px solid var(--alarm); border-radius: 3px; }
.pair.changed > .before { color: var(--alarm); } .pair.changed > .after { color: var(--good); border-top: 1px dotted var(--rule); }
.pair a { font: 11px system-ui, sans-serif; vertical-align: super; }
.finding { border-left: 4px solid var(--alarm); padding-left: 1em; margin: 1.2em 0; break-inside: avoid; }
.finding.approximation { border-color: var(--s5); } .finding.choice { border-color: var(--accent); }
:target { background: var(--wash); } .bad { color: var(--alarm); } .good { color: var(--good); }
@page { size: A4; margin: 16mm; }
@media print { :root, :root:not([data-theme=light]) { --paper: #fff; --ink: #1b1b1b; --faint: #5f6670; --rule: #d9d9d9; --accent: #1f5fa8;
    --alarm: #b3261e; --good: #1c6b3a; --wash: #f3f4f6; --s5: #b07600; color-scheme: light; }
  body { font-size: 10.5pt; line-height: 1.35; } table { font-size: 7.5pt; line-height: 1.25; } .terms, tr { break-inside: avoid; } .break { break-after: page; } h2, h3 { break-after: avoid; }
  a { text-decoration: none; } .equation { overflow: visible; } }
"""
"""What is of reports alone; the rest of the style they share with the pages of runs. Paper is white, whatever the screen is."""


def _shared():
    """The style of all pages."""
    return (Path(__file__).parents[2] / "page.css").read_text(encoding="utf-8")


def as_html(report):
    """The page as text."""
    made = document(report)
    head = ["<!DOCTYPE html>", '<html lang="en"><head><meta charset="utf-8">', f"<title>{escape(made.name)}: verification</title>",
            f"<style>{_shared()}{STYLE}</style></head><body>", f"<h1>{escape(made.title)}</h1>", f"<p>{escape(made.subtitle)}</p>"]
    return "\n".join(head + _Writer(made.paper).written(made.blocks) + ["</body></html>"]) + "\n"


def _units(text):
    """A unit with raised exponents."""
    return re.sub(r"\^(-?[\d/]+)", lambda power: f"<sup>{power[1].replace('-', '−')}</sup>", escape(text)).replace("*", " ")


class _Writer(blocks.Writer):
    def part(self, part):
        """The HTML of a part of a sentence."""
        if isinstance(part, blocks.Link):
            return f'<a href="#{escape(part.target)}">{escape(part.words)}</a>'
        if isinstance(part, blocks.Strong):
            return f"<strong>{escape(part.words)}</strong>"
        if isinstance(part, Quantity):
            value, _, unit = part.rpartition(" ")
            return f"{escape(value)} {_units(unit)}"
        if isinstance(part, (Unit, Dimension)):
            return _units(str(part))
        if isinstance(part, str):
            return escape(part)
        return mathml.mathml_inline(form_latex(part, self.paper) if isinstance(part, Form) else expression_latex(part, self.paper))

    def heading(self, block):
        anchor = f' id="{escape(block.anchor)}"' if block.anchor else ""
        return [f"<h{block.level}{anchor}>{escape(block.words)}</h{block.level}>"]

    def paragraph(self, block, tag="p"):
        style = f' class="{block.style}"' if block.style else ""
        return [f"<{tag}{style}>{self.sentence(block.parts)}</{tag}>"]

    def items(self, block):
        return ["<ul>", *(self.paragraph(item, "li")[0] for item in block.items), "</ul>"]

    def table(self, block):
        columns = "".join(f'<col style="width:{100 * width:.3g}%"/>' for width in block.widths)
        head = "".join(f"<th>{escape(cell)}</th>" for cell in block.head)
        rows = ["<tr>" + "".join(f"<td>{self.sentence(cell)}</td>" for cell in row) + "</tr>" for row in block.rows]
        return [f'<div class="scroll"><table><colgroup>{columns}</colgroup><tr>{head}</tr>', *rows, "</table></div>"]

    def display(self, block):
        return [f'<div class="equation">{mathml.mathml(block.tree, block.marks)}</div>']

    def terms(self, block):
        out = [self._lead(*block.lead)] if block.lead[0] else []
        for k, pair in enumerate(block.pairs):
            numbers = "".join(f' <a href="#{escape(block.anchors[n - 1])}">{n}</a>' for n in pair.findings)
            out.append(f'<span class="pair {"changed" if pair.changed() else "same"}"><span class="before">{self._term(pair.printed, k)}</span>'
                       f'<span class="after">{self._term(pair.consistent, k)}{numbers}</span></span>')
        return ['<div class="terms">', *out, *([self._lead("", block.tail)] if block.tail else []), "</div>"]

    def _lead(self, latex, text):
        """What stands before and behind the terms, in both lines."""
        shown = (mathml.mathml_inline(latex) + " " if latex else "") + escape(text)
        return f'<span class="pair same"><span class="before">{shown}</span><span class="after">{shown}</span></span>'

    def _term(self, form, place):
        if form is None:
            return "—"
        latex = form_latex(form, self.paper)
        return mathml.mathml_inline(latex if latex.startswith("-") or not place else "+ " + latex)

    def card(self, block):
        return [f'<div class="finding {block.style}" id="{escape(block.anchor)}"><h3>{escape(block.title)}</h3>', *self.written(block.blocks), "</div>"]

    def pagebreak(self, _):
        return ['<div class="break"></div>']
