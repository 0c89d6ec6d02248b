"""The displayed equations of a LaTeX text, with their numbers, their places and what comments say of them."""

import re

from sympy import Rational, sympify

from ..errors import PaperError
from . import transcription
from .latex import Parser
from .macros import expanded
from .tokens import Placed, error_at

DISPLAY = re.compile(r"\\begin\{(?P<name>equation|align|multline|gather|eqnarray|displaymath)(?P<star>\*?)\}(?P<body>.*?)\\end\{(?P=name)(?P=star)\}"
                     r"|\\\[(?P<bracket>.*?)\\\]|\$\$(?P<dollars>.*?)\$\$", re.DOTALL)
# displays that may hold several equations, and what parts them
MANY = ("align", "gather", "eqnarray")
# parts of displays that hold several equations too
ALIGNED = ("aligned", "alignedat", "gathered", "split")
BREAK = re.compile(r"\\\\\*?(?:\[[^\]]*\])?")
RELATION = re.compile(r"[=<>≤≥]|\\(?:equiv|triangleq|coloneqq?|lt|gt|leq?|geq?|leqslant|geqslant)(?![A-Za-z])")
ROLES = {"motion of": "motion", "value of": "value", "reaction": "reaction", "condition on": "condition", "rule for": "rule",
         "impact of": "reset", "constraint with": "constraint", "definition of": "definition", "reading of": "reading",
         "force on": "force",
         "kinetic energy": "T", "potential energy": "V", "dissipation": "D", "lagrangian": "L", "skip": "skip"}
NOTE = re.compile(rf"%[ \t]*(?P<role>{'|'.join(ROLES)})\b[ \t]*(?P<of>[^\n%]*?)[ \t.]*$", re.MULTILINE | re.IGNORECASE)


class Displayed:
    """A displayed equation: its number or None, its LaTeX with its place, what the comment beside it says, and its tree."""

    def __init__(self, latex, number, note):
        self.latex, self.number = latex, number
        self.role, self.named = (ROLES[note["role"].lower()], expanded(note["of"].strip(), latex.macros)) if note else (None, "")
        self.tree = None if self.role == "skip" else Parser(latex).equation()

    def reading(self):
        """The name of the reading that an energy belongs to: what stands behind `in reading`; empty for all of them."""
        match = re.fullmatch(r"in reading\s+(.+)", self.named)
        if self.named and not match:
            raise self.error(f"'{self.named}' says nothing of an energy: write % potential energy, or % potential energy in reading A")
        return match[1].strip() if match else ""

    def error(self, what):
        """An error about the equation: its first character that shows."""
        return error_at(self.latex, len(self.latex) - len(self.latex.lstrip()), what)

    def shape(self):
        """What the equation consists of: sums, relations and words."""
        return [child.kind if child.kind != "relation" else child.text for child in self.tree.children]

    def left(self):
        """The symbol that the left side consists of, alone or as a power, or None."""
        node = self._alone()
        node = node.children[0] if node and node.kind == "power" else node
        return node if node and node.kind == "symbol" else None

    def power(self):
        """The power of the symbol on the left side."""
        node = self._alone()
        return int(node.text) if node and node.kind == "power" else 1

    def _alone(self):
        side = self.tree.children[0]
        return side.children[0].children[0] if len(side.children) == 1 and len(side.children[0].children) == 1 and side.children[0].sign == 1 else None

    def defined(self, paper):
        """What the symbol on the left side is, as a function of the namespaces: where its square is defined, a root."""
        right = self.right(paper)
        return right if self.power() == 1 else lambda s, m: sympify(right(s, m)) ** Rational(1, self.power())

    def right(self, paper):
        """The right side as a function of the namespaces."""
        def function(s, m):
            tree = Parser(self.latex).equation()
            side = tree.children[2]
            transcription._collect(side, 1, [0])
            tree.children = [side]
            return sum(transcription.terms(tree, paper, s, m, self.latex))

        return function


def displayed(text, shown, file, known):
    """The displayed equations, numbered as LaTeX numbers them."""
    found, counter, before = [], 0, 0
    for match in DISPLAY.finditer(shown):
        group = next(name for name in ("body", "bracket", "dollars") if match.group(name) is not None)
        numbers = group == "body" and match.group("name") != "displaymath" and not match.group("star")
        # a comment speaks of the equation in which or directly above which it stands
        lines = re.search(r"(?:^[ \t]*%[^\n]*\n)+[ \t]*\Z", text[before:match.start()], re.MULTILINE)
        above = lines.group() if lines else ""
        equations = _rows(text, shown, match.span(group), match.group("name") in MANY)
        equations = _beside(shown, equations) if match.group("name") not in MANY else equations
        # an aligned part inside an equation has one number
        one = match.group("name") not in MANY
        counter += one and numbers and len(equations) > 1
        for k, rows in enumerate(equations, 1):
            latex, number = Placed(text, rows[0][0], rows[-1][1], file, known), None
            if one and numbers and len(equations) > 1:
                number = f"{counter}.{k}"
            for start, end in rows if number is None else ():
                tag = re.search(r"\\tag\*?\{([^{}]*)\}", shown[start:end])
                counted = numbers and not tag and not re.search(r"\\(?:nonumber|notag)\b", shown[start:end])
                counter += counted
                number = number or (tag.group(1).strip() if tag else str(counter) if counted else None)
            notes = list(NOTE.finditer(above + "\n" + latex))
            if len(notes) > 1:
                raise error_at(latex, 0, "two comments say what this equation is")
            found.append(Displayed(latex, number, notes[0] if notes else None))
            above = ""
        before = match.end()
    if not found:
        raise PaperError(f"{file}: no displayed equation is found: \\begin{{equation}} ... \\end{{equation}}, \\[ ... \\] or $$ ... $$")
    return found


def _rows(text, shown, span, many):
    """The equations of a display, each as the spans of its rows. Of displays that may hold several, a row with a relation in it, but not
    at its start, begins another one, as does a comment that says what it is; of others the rows are one equation."""
    start, end = span
    body = shown[start:end]
    inner = re.findall(r"\\begin\{(\w+)\*?\}", body)
    if not (many or inner) or not set(inner) <= set(ALIGNED):
        return [[span]]
    cuts = [0, *(match.end() for match in BREAK.finditer(body)), len(body)]
    result = []
    for low, high in zip(cuts, cuts[1:]):
        row = re.sub(r"\\(?:begin|end)\{\w+\*?\}(?:\{\d\})?", "", BREAK.sub("", body[low:high]))
        if not row.strip(" &\t\n") and result:
            continue
        begins = RELATION.search(row) and not RELATION.match(row.strip(" &\t\n"))
        # what stands before the first relation belongs to it
        said = NOTE.search(text[start + low:start + high])
        if result and not said and (not begins or not RELATION.search(shown[result[-1][0][0]:result[-1][-1][1]])):
            result[-1].append((start + low, start + high))
        else:
            result.append([(start + low, start + high)])
    return result


def _beside(shown, equations):
    """Equations that stand side by side with a wide space between are one each; `if` and other words belong to what they stand beside."""
    result = []
    for spans in equations:
        start, end = spans[0][0], spans[-1][1]
        body = shown[start:end]
        cuts, depth, last = [], 0, 0
        for match in re.finditer(r"\\q?quad(?![A-Za-z])|\\.|[{}]", body):
            depth += {"{": 1, "}": -1}.get(match.group(), 0)
            if "quad" in match.group() and not depth and all(RELATION.search(part) for part in (body[last:match.start()], body[match.end():])):
                cuts.append(match.start())
                last = match.end()
        if not cuts or re.search(r"\\(?:text|mbox|mathrm)\s*\{\s*(?:if|for|when)", body):
            result.append(spans)
            continue
        result += [[(start + low, start + high)] for low, high in zip([0, *cuts], [*cuts, len(body)])]
    return result
