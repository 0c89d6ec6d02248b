"""The LaTeX of printed equations, parsed: into terms, to prove that the transcription beside it
says the same, and into MathML, with single terms marked.

Known: symbols with indices, \\dot and \\ddot, numbers, +, -, powers, \\frac, \\sin, \\cos,
\\operatorname{sign}, brackets, moduli, relations, \\text and line breaks. Anything else is an
error that shows the place.
"""

import re
from dataclasses import dataclass, field
from html import escape
from typing import List, Optional

TOKEN = re.compile(
    r"\s+|&|(?P<break>\\\\)|(?P<skip>\\begin\{\w+\}|\\end\{\w+\}|\\quad|\\left|\\right|\\,|\\;)"
    r"|(?P<text>\\text\{[^}]*\})|(?P<time>\(t\^[+-]\))|(?P<function>\\sin|\\cos|\\operatorname\{sign\}|\\sign)"
    r"|(?P<dots>\\d?dot)|(?P<frac>\\frac)|(?P<symbol>\\[A-Za-z]+|[A-Za-z])|(?P<number>\d+(?:\.\d+)?)"
    r"|(?P<open>\(|\[|\\\{)|(?P<close>\)|\]|\\\})|(?P<bar>\|)|(?P<relation>[=<>])|(?P<sign>[+-])"
    r"|(?P<power>\^)|(?P<index>_)|(?P<brace>[{}])")

ENTITIES = {"lambda": "λ", "theta": "θ", "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε",
            "zeta": "ζ", "eta": "η", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ",
            "phi": "φ", "psi": "ψ", "omega": "ω", "Omega": "Ω", "Delta": "Δ"}


class LatexError(Exception):
    """LaTeX outside the known part; the message shows where."""


@dataclass
class Node:
    """A node of the tree: `kind` is relation, sum, product, symbol, number, call, group, modulus,
    power, fraction or text; `ordinal` numbers the terms from 0."""

    kind: str
    text: str = ""
    children: List["Node"] = field(default_factory=list)
    dots: int = 0
    index: str = ""
    sign: int = 1
    lead: str = ""
    broken: bool = False
    ordinal: Optional[int] = None


class Parser:
    """Recursive descent over the tokens of one equation."""

    def __init__(self, latex):
        self.latex, self.tokens, self.at = latex, [], 0
        place = 0
        while place < len(latex):
            match = TOKEN.match(latex, place)
            if not match:
                raise LatexError(f"cannot read the LaTeX from here: {latex[place:place + 30]!r}")
            if match.lastgroup not in (None, "skip"):
                self.tokens.append((match.lastgroup, match.group()))
            place = match.end()

    def peek(self):
        """The next token, line breaks skipped: (kind, text)."""
        at = self.at
        while at < len(self.tokens) and self.tokens[at][0] == "break":
            at += 1
        return self.tokens[at] if at < len(self.tokens) else ("end", "")

    def broken(self):
        """Skips line breaks and tells whether there were any."""
        start = self.at
        while self.at < len(self.tokens) and self.tokens[self.at][0] == "break":
            self.at += 1
        return self.at > start

    def next(self, *kinds):
        """Takes the next token, which must be of one of the kinds."""
        self.broken()
        kind, text = self.peek()
        if kinds and kind not in kinds:
            raise LatexError(f"expected {' or '.join(kinds)} and found {text or 'the end'!r} in {self.latex.strip()!r}")
        self.at += 1
        return text

    def equation(self):
        """relation: sums with relations and words between them."""
        parts = [self.sum()]
        while self.peek()[0] in ("relation", "text"):
            broken = self.broken()
            kind, text = self.peek()
            self.at += 1
            parts.append(Node(kind, text, broken=broken))
            parts.append(self.sum())
        if self.peek()[0] != "end":
            raise LatexError(f"unexpected {self.peek()[1]!r} in {self.latex.strip()!r}")
        return Node("equation", children=parts)

    def sum(self):
        """Products with signs."""
        parts = []
        while True:
            broken = self.broken()
            sign, lead = 1, ""
            if self.peek()[0] == "sign":
                lead = self.next()
                sign = -1 if lead == "-" else 1
            elif parts:
                break
            part = self.product()
            part.sign, part.lead, part.broken = sign, lead, broken
            parts.append(part)
            if self.peek()[0] != "sign":
                break
        return Node("sum", children=parts)

    def product(self):
        """Factors side by side."""
        factors = []
        while self.peek()[0] in ("symbol", "number", "function", "dots", "frac", "open", "bar"):
            if self.peek()[0] == "bar" and self.depth_bar:
                break
            factors.append(self.factor())
        if not factors:
            raise LatexError(f"a term is missing before {self.peek()[1] or 'the end'!r} in {self.latex.strip()!r}")
        return Node("product", children=factors)

    depth_bar = 0

    def factor(self):
        """A factor with its power."""
        node = self.base()
        if self.peek()[0] == "power":
            self.next()
            node = Node("power", self.braced_text(), [node])
        return node

    def base(self):
        """A factor without its power."""
        kind, text = self.peek()
        self.next()
        if kind == "number":
            return Node("number", text)
        if kind == "symbol":
            return self.indexed(Node("symbol", text.lstrip("\\")))
        if kind == "dots":
            self.next("brace")
            name = self.next("symbol").lstrip("\\")
            index = self.index()
            self.next("brace")
            return self.indexed(Node("symbol", name, dots=len(text) - 3, index=index))
        if kind == "function":
            name = "sign" if "sign" in text else text[1:]
            inner = self.factor() if self.peek()[0] != "power" else None
            if inner is None:
                raise LatexError(f"write the power after the argument in {self.latex.strip()!r}")
            return Node("call", name, [inner])
        if kind == "frac":
            parts = []
            for _ in range(2):
                self.next("brace")
                parts.append(self.sum())
                self.next("brace")
            return Node("fraction", children=parts)
        if kind == "bar":
            self.depth_bar += 1
            inner = self.sum()
            self.depth_bar -= 1
            self.next("bar")
            return Node("modulus", children=[inner])
        inner = Node("group", text, [self.sum()])
        inner.broken = self.broken()
        self.next("close")
        return inner

    def braced_text(self):
        """The text of `x` or `{x...}` after ^ or _."""
        if self.peek()[0] != "brace":
            return self.next("symbol", "number")
        self.next("brace")
        text = ""
        while self.peek()[0] != "brace":
            text += self.next("symbol", "number", "sign")
        self.next("brace")
        return text

    def index(self):
        """The index after a symbol, if any."""
        if self.peek()[0] != "index":
            return ""
        self.next()
        return self.braced_text().lstrip("\\")

    def indexed(self, node):
        """A symbol with its index and with a time such as (t^+)."""
        node.index = node.index or self.index()
        if self.peek()[0] == "time":
            node.lead = self.next()
        return node


def parse(latex):
    """The tree of an equation, its terms numbered in printed order (zeros are not terms)."""
    tree = Parser(latex).equation()
    counter = [0]

    def number(node):
        if node.kind == "sum":
            for product in node.children:
                number(product)
        elif node.kind == "product":
            groups = [f for f in node.children if f.kind == "group"]
            if groups:
                number(groups[-1].children[0])
            elif not (len(node.children) == 1 and node.children[0].text == "0"):
                node.ordinal = counter[0]
                counter[0] += 1

    sides = [child for child in tree.children if child.kind == "sum"]
    if any(child.kind == "text" for child in tree.children):
        sides = sides[-2:-1]  # lambda = 1 if (this sum) > 0
    elif len(sides) > 1 and _name(sides[0]):
        sides = sides[1:]  # F = (these terms)
    for side in sides:
        number(side)
    return tree


def _name(side):
    """Whether a side is a single symbol (whose value the other side gives)."""
    if len(side.children) != 1 or len(side.children[0].children) != 1:
        return False
    factor = side.children[0].children[0]
    return factor.kind == "symbol"


def terms(tree, paper, s, m):
    """The expressions of the numbered terms, with the signs of `Equation.terms`: an equation of
    motion is left minus right, a condition positive where it holds."""
    by_latex = {_plain(symbol.latex): symbol.name for symbol in paper.symbols.values()}
    found = {}

    def value(node):
        if node.kind == "sum":
            return sum(product.sign * value(product) for product in node.children)
        if node.kind == "product":
            result = 1
            for factor in node.children:
                result = result * value(factor)
            return result
        if node.kind == "symbol":
            key = _plain(node.text + ("_" + node.index if node.index else ""))
            if key not in by_latex:
                raise LatexError(f"the LaTeX has the symbol {key!r}, which the paper does not declare")
            return getattr(s, "d" * node.dots + by_latex[key])
        if node.kind == "number":
            return int(node.text)
        if node.kind == "call":
            return getattr(m, node.text)(value(node.children[0]))
        if node.kind == "modulus":
            return m.Abs(value(node.children[0]))
        if node.kind == "power":
            return value(node.children[0]) ** int(node.text)
        if node.kind == "fraction":
            return value(node.children[0]) / value(node.children[1])
        return value(node.children[0])

    def collect(node, outer):
        if node.kind == "sum":
            for product in node.children:
                collect(product, outer * product.sign)
        elif node.ordinal is not None:
            found[node.ordinal] = outer * value(node)
        else:
            groups = [f for f in node.children if f.kind == "group"]
            if groups:
                for factor in node.children:
                    if factor is not groups[-1]:
                        outer = outer * value(factor)
                collect(groups[-1].children[0], outer)

    sides = [child for child in tree.children if child.kind == "sum"]
    words = any(child.kind == "text" for child in tree.children)
    relation = next((child.text for child in tree.children if child.kind == "relation"), "=")
    # the side that a residual or a margin takes with the opposite sign
    opposite = 0 if relation == "<" else 1
    for i, side in enumerate(sides):
        value_of = i == 1 and relation == "=" and _name(sides[0])
        collect(side, -1 if i == opposite and not words and not value_of else 1)
    return [found[k] for k in sorted(found)]


def _plain(latex):
    """LaTeX of a symbol without braces, backslashes and spaces."""
    return re.sub(r"[\\{}\s]", "", latex)


BREAK = object()


def mathml(tree, marks=None):
    """MathML of a tree; `marks` gives a CSS class by ordinal. Without any network or script."""
    marks = marks or {}
    out = []

    def symbol(node):
        body = f"<mi>{escape(ENTITIES.get(node.text, node.text))}</mi>"
        if node.dots:
            body = f'<mover accent="true">{body}<mo>{"˙" if node.dots == 1 else "¨"}</mo></mover>'
        if node.index:
            index = ENTITIES.get(node.index, node.index)
            body = f"<msub>{body}<mi mathvariant=\"normal\">{escape(index)}</mi></msub>"
        if node.lead:
            body += f"<mo>(</mo><msup><mi>t</mi><mo>{node.lead[3]}</mo></msup><mo>)</mo>"
        return f"<mrow>{body}</mrow>"

    def inline(node):
        """MathML of a node without line breaks."""
        inner = []
        emit(node, inner)
        return "<mrow>" + "".join(part for part in inner if part is not BREAK) + "</mrow>"

    def emit(node, to):
        if node.kind == "symbol":
            to.append(symbol(node))
        elif node.kind == "number":
            to.append(f"<mn>{node.text}</mn>")
        elif node.kind == "call":
            space = "" if node.children[0].kind == "group" else '<mspace width="0.17em"/>'
            to.append(f"<mrow><mi>{node.text}</mi><mo>&#x2061;</mo>{space}{inline(node.children[0])}</mrow>")
        elif node.kind == "power":
            to.append(f"<msup>{inline(node.children[0])}<mn>{escape(node.text)}</mn></msup>")
        elif node.kind == "fraction":
            to.append(f"<mfrac>{inline(node.children[0])}{inline(node.children[1])}</mfrac>")
        elif node.kind == "modulus":
            to.append(f"<mrow><mo>|</mo>{inline(node.children[0])}<mo>|</mo></mrow>")
        elif node.kind == "group":
            left = node.text[-1]
            to.append(f'<mo stretchy="false">{left}</mo>')
            emit(node.children[0], to)
            to.append(f'<mo stretchy="false">{dict(zip("([{", ")]}"))[left]}</mo>')
        elif node.kind == "sum":
            for product in node.children:
                if product.broken:
                    to.append(BREAK)
                mark = marks.get(product.ordinal) if product.ordinal is not None else None
                inside = []
                if product.lead:
                    inside.append(f'<mo form="infix">{"−" if product.lead == "-" else "+"}</mo>')
                for factor in product.children:
                    emit(factor, inside)
                to += [f'<mrow class="{mark}">' + "".join(x for x in inside if x is not BREAK) + "</mrow>"] if mark else inside
        else:
            text = node.text[6:-1] if node.kind == "text" else node.text
            space = '<mspace width="0.5em"/>'
            to.append(f"{space}<mtext>{escape(text)}</mtext>{space}" if node.kind == "text" else f"<mo>{escape(text)}</mo>")

    for child in tree.children:
        if child.kind != "sum" and child.broken:
            out.append(BREAK)
        emit(child, out)
    rows, row = [], []
    for part in out:
        if part is BREAK:
            if row:
                rows.append(row)
            row = []
        else:
            row.append(part)
    rows.append(row)
    cells = "".join(f'<mtr><mtd style="text-align:left">{"".join(r)}</mtd></mtr>' for r in rows)
    return f'<math display="block"><mtable displaystyle="true" columnalign="left">{cells}</mtable></math>'


def mathml_inline(latex):
    """MathML of a formula inside a sentence."""
    tree = Parser(latex).equation()
    return mathml(tree).replace('<math display="block">', "<math>")
