"""The LaTeX of printed equations, parsed into a tree.

Known: symbols with indices, \\dot and \\ddot, numbers, +, -, \\cdot, powers, \\frac, \\sin, \\cos,
\\operatorname{sign}, brackets, moduli, relations, \\text and line breaks. Anything else, and
whatever is printed in a way that can be read in two, is an error that shows the place. What the
tree means is said by transcription.py, how it looks by mathml.py.
"""

import re
from dataclasses import dataclass, field
from typing import List, Optional

TOKEN = re.compile(
    r"\s+|&|(?P<break>\\\\)|(?P<skip>\\[,;:!])|(?P<frame>\\(?:begin|end)\{(?:aligned|align|align\*|split|equation|equation\*)\})"
    r"|(?P<text>\\text\{[^}]*\})|(?P<time>\(t\^\{?[+-]\}?\))|(?P<sign_function>\\operatorname\{sign\})|(?P<command>\\[A-Za-z]+)"
    r"|(?P<symbol>[A-Za-z])|(?P<number>\d+(?:\.\d+)?)|(?P<open>\(|\[|\\\{)|(?P<close>\)|\]|\\\})|(?P<bar>\|)"
    r"|(?P<relation>[=<>])|(?P<sign>[+-])|(?P<power>\^)|(?P<index>_)|(?P<brace>[{}])")

# what a command is; any other is a symbol, which must be declared
COMMANDS = {"quad": "skip", "qquad": "skip", "left": "skip", "right": "skip", "sin": "function", "cos": "function",
            "sign": "function", "dot": "dots", "ddot": "dots", "dddot": "dots", "frac": "frac", "cdot": "times"}

CLOSING = {"(": ")", "[": "]", r"\{": r"\}"}

FACTORS = ("symbol", "number", "function", "dots", "frac", "open", "bar")

ENTITIES = {"lambda": "λ", "theta": "θ", "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε",
            "zeta": "ζ", "eta": "η", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ",
            "phi": "φ", "psi": "ψ", "omega": "ω", "Omega": "Ω", "Delta": "Δ"}


class LatexError(Exception):
    """LaTeX outside the known part; the message shows where."""


@dataclass
class Node:
    """A node of the tree: `kind` is equation, sum, product, symbol, number, call, group, modulus,
    power, fraction, relation or text; `time` is + or - after (t^+) or (t^-). `ordinal` numbers the
    terms from 0 and `side` is the sign that their side of the equation gives them (transcription.py)."""

    kind: str
    text: str = ""
    children: List["Node"] = field(default_factory=list)
    dots: int = 0
    index: str = ""
    time: str = ""
    sign: int = 1
    lead: str = ""
    broken: bool = False
    ordinal: Optional[int] = None
    side: int = 0


class Parser:
    """Recursive descent over the tokens of one equation."""

    def __init__(self, latex):
        self.latex, self.tokens, self.at, self.depth_bar = latex, [], 0, 0
        place = 0
        while place < len(latex):
            match = TOKEN.match(latex, place)
            if not match:
                raise LatexError(f"cannot read the LaTeX from here: {latex[place:place + 30]!r}")
            kind, text = match.lastgroup, match.group()
            if kind == "command":
                kind = COMMANDS.get(text[1:], "symbol")
            elif kind == "sign_function":
                kind, text = "function", r"\sign"
            if kind not in (None, "skip", "frame"):
                self.tokens.append((kind, text))
            place = match.end()

    def error(self, what):
        """An error about the whole equation."""
        return LatexError(f"{what} in {' '.join(self.latex.split())!r}")

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
            raise self.error(f"expected {' or '.join(kinds)} and found {text or 'the end'!r}")
        self.at += 1
        return text

    def equation(self):
        """Sums with relations and words between them."""
        parts = [self.sum()]
        while self.peek()[0] in ("relation", "text"):
            broken = self.broken()
            kind, text = self.peek()
            self.at += 1
            parts.append(Node(kind, text, broken=broken))
            parts.append(self.sum())
        if self.peek()[0] != "end":
            raise self.error(f"unexpected {self.peek()[1]!r}")
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
        while self.peek()[0] in FACTORS:
            kind, text = self.peek()
            if kind == "bar" and self.depth_bar:
                break
            if factors and self.broken():
                raise self.error(f"a sign or a relation is missing after the line break before {text!r}")
            if factors and kind == "number" and factors[-1].kind == "number":
                raise self.error(f"two numbers side by side, {factors[-1].text} and {text}: write one number, or \\cdot between")
            factors.append(self.factor())
            if self.peek()[0] == "times":
                self.next()
                if self.peek()[0] not in FACTORS:
                    raise self.error("a factor is missing after \\cdot")
        if not factors:
            raise self.error(f"a term is missing before {self.peek()[1] or 'the end'!r}")
        return Node("product", children=factors)

    def factor(self):
        """A factor with its power."""
        node = self.base()
        if self.peek()[0] == "power":
            node = Node("power", self.exponent(), [node])
        return node

    def exponent(self):
        """The whole number after ^."""
        self.next("power")
        text = self.braced_text()
        if not re.fullmatch(r"[+-]?\d+", text):
            raise self.error(f"the power {text!r} is not a whole number")
        return text

    def base(self):
        """A factor without its power."""
        kind, text = self.peek()
        self.next()
        if kind == "number":
            return Node("number", text)
        if kind == "symbol":
            return self.indexed(Node("symbol", text.lstrip("\\")))
        if kind == "dots":
            return self.dotted(text.count("d"))
        if kind == "function":
            return self.call(text[1:])
        if kind == "frac":
            parts = []
            for _ in range(2):
                self.opened("brace", "{")
                parts.append(self.sum())
                self.opened("brace", "}")
            return Node("fraction", children=parts)
        if kind == "bar":
            self.depth_bar += 1
            inner = self.sum()
            self.depth_bar -= 1
            self.next("bar")
            return Node("modulus", children=[inner])
        outside, self.depth_bar = self.depth_bar, 0
        inner = Node("group", text, [self.sum()])
        self.depth_bar = outside
        inner.broken = self.broken()
        self.opened("close", CLOSING[text])
        return inner

    def opened(self, kind, text):
        """Takes a bracket, which must be this one."""
        found = self.next(kind)
        if found != text:
            raise self.error(f"expected {text} and found {found}")

    def dotted(self, dots):
        """The symbol under dots, in braces or not."""
        braced = self.peek() == ("brace", "{")
        if braced:
            self.next()
        name, index = self.next("symbol").lstrip("\\"), ""
        if braced:
            index = self.index()
            self.opened("brace", "}")
        return self.indexed(Node("symbol", name, dots=dots, index=index))

    def call(self, name):
        """A function with its argument: the next factor. A power is written before the argument."""
        power = self.exponent() if self.peek()[0] == "power" else None
        if power is not None and int(power) < 1:
            raise self.error(f"\\{name}^{{{power}}} can be read in two ways: write the reciprocal as \\frac")
        node = Node("call", name, [self.base()])
        if self.peek()[0] == "power":
            raise self.error(f"the power after the argument of \\{name} can be read in two ways: write \\{name}^2 before it, "
                             "or brackets around what is raised")
        return node if power is None else Node("power", power, [node])

    def braced_text(self):
        """The text of `x` or `{x...}` after ^ or _."""
        if self.peek()[0] != "brace":
            text = self.next("symbol", "number")
            if len(text) > 1 and text[0].isdigit():
                raise self.error(f"LaTeX raises or lowers the first digit of {text} alone: write {{{text}}}")
            return text
        self.opened("brace", "{")
        text = ""
        while self.peek()[0] != "brace":
            text += self.next("symbol", "number", "sign")
        self.opened("brace", "}")
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
            node.time = self.next().strip("(t^{})")
        return node

