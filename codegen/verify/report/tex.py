"""The report as a LaTeX file, for pdflatex with what every installation of LaTeX has (amsmath, array, color, geometry, hyperref, longtable)."""

import re

from ..input.latex import ENTITIES
from ..input.units import Dimension
from ..normal.form import Form
from . import blocks, texmath
from .document import document
from .show import Quantity, Unit, expression_latex, form_latex, unit_latex

PREAMBLE = r"""\documentclass[10pt,a4paper]{article}
\usepackage[margin=20mm]{geometry}
\usepackage{amsmath,array,color,longtable}
\usepackage[colorlinks,linkcolor=link,urlcolor=link]{hyperref}
\definecolor{link}{rgb}{.12,.37,.66}
\definecolor{differ}{rgb}{.70,.15,.12}
\definecolor{consistent}{rgb}{.11,.42,.23}
\definecolor{faint}{gray}{.4}
\setlength{\parindent}{0pt}\setlength{\parskip}{3pt}\setlength{\tabcolsep}{3pt}
\setcounter{secnumdepth}{0}
\renewcommand{\dddot}[1]{\overset{\dots}{#1}}
\providecommand{\sgn}{\operatorname{sign}}
\newcommand{\pair}[2]{\begin{tabular}[t]{@{}c@{}}$\displaystyle #1$\\$\displaystyle #2$\end{tabular}\hspace{.3em plus .2em}\allowbreak}
\newcommand{\changed}[2]{\fcolorbox{differ}{white}{\pair{\textcolor{differ}{#1}}{\textcolor{consistent}{#2}}}\hspace{.3em plus .2em}\allowbreak}
\renewcommand{\labelitemi}{$\bullet$}
\setlength{\fboxsep}{2pt}\setlength{\lineskiplimit}{2pt}\setlength{\lineskip}{4pt}
\raggedright\sloppy
"""

# what stands in words and is no letter of LaTeX's
SIGNS = {"\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "_": r"\_", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}", "&": r"\&", "%": r"\%",
         "$": r"\$", "#": r"\#", "<": "$<$", ">": "$>$", "|": "$|$", "−": "$-$", "→": r"$\to$", "²": "$^2$", "³": "$^3$", "½": r"$\frac12$",
         "≥": r"$\ge$", "≤": r"$\le$", "·": r"$\cdot$", "—": "---", "–": "--", "…": r"\dots{}", "°": r"$^\circ$", "µ": r"$\mu$", "×": r"$\times$",
         '"': "''", "’": "'", "“": "``", "”": "''",
         **{letter: rf"$\{name}$" for name, letter in ENTITIES.items() if len(letter) == 1 and not letter.isascii()}}
# letters with accents that LaTeX knows by themselves; of others the page shows the number
LETTERS = re.compile("[À-ÖØ-öø-ÿŁłŚśŠšŽžČčŘřŐőŰű]")


def words(text):
    """Text for LaTeX. What LaTeX has no letter for stands as its number in Unicode."""
    return "".join(SIGNS.get(c) or (c if c.isascii() and c.isprintable() or c in " \n" or LETTERS.match(c) else rf"\texttt{{[U+{ord(c):04X}]}}")
                   for c in text)


def as_latex(report):
    """The file as text."""
    made = document(report)
    head = [PREAMBLE + rf"\hypersetup{{pdftitle={{{words(made.name)}: verification}}}}", r"\begin{document}",
            rf"{{\Large\bfseries {words(made.title)}\par}}", words(made.subtitle) + r"\par"]
    return "\n".join(head + _Writer(made.paper).written(made.blocks) + [r"\end{document}"]) + "\n"


class _Writer(blocks.Writer):
    def part(self, part):
        """The LaTeX of a part of a sentence."""
        if isinstance(part, blocks.Link):
            return rf"\hyperlink{{{_anchor(part.target)}}}{{{words(part.words)}}}"
        if isinstance(part, blocks.Strong):
            return rf"\textbf{{{words(part.words)}}}"
        if isinstance(part, Quantity):
            value, _, unit = part.rpartition(" ")
            return f"{words(value)} ${unit_latex(unit)}$"
        if isinstance(part, (Unit, Dimension)):
            return f"${unit_latex(part)}$"
        if isinstance(part, str):
            # a long digest has no place to break
            return re.sub(r"[0-9a-f]{64}", lambda x: r"\texttt{" + r"\allowbreak ".join(re.findall(".{8}", x[0])) + "}", words(part))
        return f"${form_latex(part, self.paper) if isinstance(part, Form) else expression_latex(part, self.paper)}$"

    def heading(self, block):
        anchor = rf"\hypertarget{{{_anchor(block.anchor)}}}{{}}" if block.anchor else ""
        return [rf"\{'sub' * (block.level - 2)}section*{{{anchor}{words(block.words)}}}"]

    def paragraph(self, block):
        colour = {"bad": "differ", "good": "consistent", "faint": "faint"}.get(block.style)
        text = self.sentence(block.parts)
        return [(rf"{{\color{{{colour}}}{text}}}" if colour else text) + r"\par"]

    def items(self, block):
        return [r"\begin{itemize}\setlength{\itemsep}{0pt}", *(r"\item " + self.paragraph(item)[0] for item in block.items), r"\end{itemize}"]

    def table(self, block):
        columns = "".join(rf">{{\raggedright\arraybackslash}}p{{{width - .02:.3f}\textwidth}}" for width in block.widths)
        head = " & ".join(rf"\textbf{{{words(cell)}}}" for cell in block.head)
        rows = [" & ".join(self.sentence(cell) for cell in row) + r" \\" for row in block.rows]
        return [rf"{{\footnotesize\begin{{longtable}}{{{columns}}}", head + r" \\ \hline \endhead", *rows, r"\end{longtable}}"]

    def display(self, block):
        lines = texmath.lines(block.tree, block.marks)
        return [r"\begin{gather*}", " \\\\\n".join(lines), r"\end{gather*}"]

    def terms(self, block):
        symbol, text = block.lead
        before = rf"{symbol} \text{{ {words(text)} }}"
        out = [rf"\pair{{{before}}}{{{before}}}"] if symbol else []
        for k, pair in enumerate(block.pairs):
            numbers = ",".join(rf"\hyperlink{{{_anchor(block.anchors[n - 1])}}}{{{n}}}" for n in pair.findings)
            made = [self._term(form, k) for form in (pair.printed, pair.consistent)]
            out.append(rf"\{'changed' if pair.changed() else 'pair'}{{{made[0]}}}{{{made[1]}{f'{{}}^{{[{numbers}]}}' if numbers else ''}}}")
        out += [rf"\pair{{{block.tail}}}{{{block.tail}}}"] if block.tail else []
        return [*out, r"\par"]

    def _term(self, form, place):
        if form is None:
            return r"\text{---}"
        latex = form_latex(form, self.paper)
        return latex if latex.startswith("-") or not place else "+ " + latex

    def card(self, block):
        return [rf"\subsection*{{\hypertarget{{{_anchor(block.anchor)}}}{{}}{words(block.title)}}}", *self.written(block.blocks)]

    def pagebreak(self, _):
        return [r"\clearpage"]


def _anchor(target):
    """A name for hyperref."""
    return re.sub(r"[^A-Za-z0-9-]", lambda x: f"-{ord(x[0]):x}-", target)
