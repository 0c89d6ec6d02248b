"""The LaTeX of printed equations, parsed into a tree.

Known: symbols with indices and accents, \\dot and \\ddot, \\frac{d x}{d t}, numbers, +, -, \\cdot, a/b, powers,
\\frac, \\sin, \\cos, \\tan, \\cot, \\sec, \\csc, \\operatorname{sgn}, brackets of any size, moduli, relations, words and line
breaks. Anything else, and whatever is printed in a way that can be read in two, is an error that shows
the place and says what to write. What the tree means is said by transcription.py, how it looks by mathml.py.
"""

import re

from ..errors import LatexError
from .tokens import GREEK, Token, error_at, tokens
from .tree import Node

__all__ = ["ENTITIES", "LatexError", "Node", "Parser"]

ENTITIES = GREEK

CLOSING = {"(": ")", "[": "]", r"\{": r"\}"}

# what is expected, in words
WORDS = {"symbol": "a symbol", "upright": "a name", "number": "a number", "sign": "a sign", "text": "a word", "end": "a comma or full stop",
         "index": "_", "bar": "|", "power": "^", "slash": "/"}

FACTORS = ("symbol", "upright", "accent", "number", "function", "dots", "frac", "open", "bar", "brace")


class Parser:
    """Recursive descent over the tokens of one equation."""

    def __init__(self, latex):
        self.latex, self.tokens, self.at, self.depth_bar = latex, tokens(latex), 0, 0
        while self.tokens and self.tokens[-1].kind in ("end", "break"):
            self.tokens.pop()  # the full stop or comma after a formula

    def error(self, what, at=None):
        """An error about a place: an offset, a node, or the next token."""
        at = getattr(at, "at", at)
        return error_at(self.latex, self.peek().at if at is None else at, what)

    def peek(self, further=0):
        """The next token, or one further on; line breaks skipped."""
        at = self.at
        while True:
            while at < len(self.tokens) and self.tokens[at].kind == "break":
                at += 1
            if at >= len(self.tokens):
                return Token("nothing", "the end", len(self.latex.rstrip()))
            if not further:
                return self.tokens[at]
            at, further = at + 1, further - 1

    def sees(self, kind, text=None):
        """Whether the next token is this one."""
        token = self.peek()
        return token.kind == kind and text in (None, token.text)

    def broken(self):
        """Skips line breaks and tells whether there were any."""
        start = self.at
        while self.at < len(self.tokens) and self.tokens[self.at].kind == "break":
            self.at += 1
        return self.at > start

    def next(self, *kinds):
        """Takes the next token, which must be of one of the kinds."""
        self.broken()
        token = self.peek()
        if kinds and token.kind not in kinds:
            raise self.error(f"expected {' or '.join(WORDS.get(kind, kind) for kind in kinds)} and found {token.text!r}")
        self.at += 1
        return token

    def equation(self):
        """Sums with relations and words between them."""
        parts = [self.sum()]
        while True:
            if self.sees("end") and self.peek(1).kind == "text":
                self.next()  # the comma before "if"
            token = self.peek()
            if token.kind not in ("relation", "text"):
                break
            broken = self.broken()
            self.next()
            text = {"≤": "<", "≥": ">"}.get(token.text, token.text)
            parts.append(Node(token.kind, text, lead=token.text, broken=broken, at=token.at))
            parts.append(self.sum())
        if not self.sees("nothing"):
            raise self.error(self.unexpected())
        return Node("equation", children=parts)

    def unexpected(self):
        """What to say of a token that cannot stand where it does."""
        token = self.peek()
        if token.kind == "end":
            return f"{token.text!r} stands inside the formula: decimals have a point, and every equation stands by itself"
        if token.kind == "prime":
            return "a prime can be a derivative or a name: write \\dot, or an index"
        return f"unexpected {token.text!r}"

    def sum(self):
        """Products with signs."""
        parts, at = [], self.peek().at
        while True:
            broken = self.broken()
            sign, lead = 1, ""
            if self.sees("sign"):
                lead = self.next().text
                sign = -1 if lead == "-" else 1
            elif parts:
                break
            part = self.product()
            part.sign, part.lead, part.broken = sign, lead, broken
            parts.append(part)
            if not self.sees("sign"):
                break
        return Node("sum", children=parts, at=at)

    def product(self):
        """Factors side by side."""
        factors, at, dot = [], self.peek().at, ""
        while self.peek().kind in FACTORS and not self.sees("brace", "}"):
            token = self.peek()
            if token.kind == "bar" and self.depth_bar:
                break
            if factors and self.broken():
                raise self.error(f"a sign or a relation is missing after the line break before {token.text!r}", token.at)
            if factors and not dot and token.kind == "number" and factors[-1].kind == "number":
                raise self.error(f"two numbers side by side, {factors[-1].text} and {token.text}: write one number, or \\cdot between")
            node = self.factor()
            node.lead, dot = dot, ""
            factors += node.children if node.kind == "product" else [node]
            if self.sees("times"):
                self.next()
                dot = "·"
                if self.peek().kind not in FACTORS:
                    raise self.error("a factor is missing after \\cdot")
            elif self.sees("slash"):
                factors = [self.divided(factors, at)]
        if not factors:
            raise self.error(self.unexpected() if self.peek().kind in ("end", "prime") and not self.sees("end") else
                             f"a term is missing before {self.peek().text!r}")
        return Node("product", children=factors, at=at)

    def divided(self, factors, at):
        """a b/c: everything before the stroke over the one factor behind it, which must be the last."""
        stroke = self.next("slash")
        if factors[-1].kind == "call":
            raise self.error("a stroke after the argument of a function can be read in two ways: write \\frac", stroke)
        if self.peek().kind not in FACTORS:
            raise self.error("a divisor is missing after /")
        divisor = Node("product", children=[self.factor()])
        if self.peek().kind in (*FACTORS, "slash", "times") and not self.sees("brace", "}") and not (self.sees("bar") and self.depth_bar):
            raise self.error("a/b c can be read in two ways: write \\frac{a}{b} c, or brackets", stroke)
        numerator = Node("sum", children=[Node("product", children=factors, at=at)], at=at)
        return Node("fraction", "/", [numerator, Node("sum", children=[divisor], at=stroke.at)], at=at)

    def factor(self):
        """A factor with its power."""
        node = self.base()
        while self.sees("power"):
            mark = self.peek()
            if node.kind == "power":
                raise self.error("a power of a power: write brackets")
            if node.kind == "product":
                raise self.error("braces do not show in print: write brackets around what is raised", node)
            text = self.exponent(node)
            if text in ("+", "-"):
                node.time = text
            else:
                node = Node("power", text, [node], at=mark.at)
            if self.sees("index") and node.kind == "power" and node.children[0].kind == "symbol" and not node.children[0].index:
                node.children[0].index = self.index()
        return node

    def exponent(self, node=None):
        """The whole number after ^; after the rate of a symbol also + or -, for after and before an impact."""
        self.next("power")
        token = self.peek()
        if self.sees("sign") or self.sees("brace") and self.peek(1).kind == "sign" and self.peek(2).text == "}":
            if node is None or node.kind != "symbol":
                raise self.error("expected a whole number")
            return self.braced_text()
        text = self.braced_text()
        if not re.fullmatch(r"[+-]?\d+", text):
            raise self.error(f"the power {text!r} is not a whole number", token)
        return text

    def base(self):
        """A factor without its power."""
        token = self.next()
        kind, text = token.kind, token.text
        if kind == "number":
            return Node("number", text, at=token.at)
        if kind in ("symbol", "upright"):
            return self.indexed(Node("symbol", text.lstrip("\\"), at=token.at))
        if kind == "accent":
            return self.indexed(self.under(text.lstrip("\\"), 0, token))
        if kind == "dots":
            return self.indexed(self.under("", text.count("d"), token))
        if kind == "function":
            return self.call(text[1:], token)
        if kind == "frac":
            return self.rate(token) or Node("fraction", children=[self.argument(), self.argument()], at=token.at)
        if kind == "brace" and text == "{":
            return self.braced(token)
        if kind == "bar":
            self.depth_bar += 1
            inner = self.sum()
            self.depth_bar -= 1
            self.next("bar")
            return Node("modulus", children=[inner], at=token.at)
        if kind != "open":
            raise self.error(f"a factor is missing before {text!r}", token)
        outside, self.depth_bar = self.depth_bar, 0
        inner = Node("group", text, [self.sum()], at=token.at)
        self.depth_bar = outside
        inner.broken = self.broken()
        if not self.sees("close", CLOSING[text]):
            raise self.error(f"expected {CLOSING[text]} and found {self.peek().text!r}")
        self.next()
        return inner

    def braced(self, token):
        """What braces group without showing: one factor, or factors that stay side by side."""
        inner = self.sum()
        self.shut()
        if len(inner.children) > 1 or inner.children[0].lead:
            raise self.error("braces do not show in print: write brackets around a sum", token)
        product = inner.children[0]
        if len(product.children) > 1:
            return product
        node = product.children[0]
        return self.indexed(node) if node.kind == "symbol" else node

    def shut(self):
        """Takes a closing brace."""
        if not self.sees("brace", "}"):
            raise self.error(f"expected }} and found {self.peek().text!r}")
        self.next()

    def argument(self):
        """An argument of \\frac: in braces, or the next sign alone, as TeX takes it."""
        if self.sees("brace", "{"):
            self.next()
            inner = self.sum()
            self.shut()
            return inner
        token = self.peek()
        if token.kind == "number" and len(token.text) > 1:
            if not token.text.isdigit():
                raise self.error("write braces around the arguments of \\frac")
            # \frac12: a digit each
            self.tokens[self.tokens.index(token)] = Token("number", token.text[1:], token.at + 1)
            node = Node("number", token.text[0], at=token.at)
        elif token.kind in ("symbol", "number"):
            self.next()
            node = Node("symbol" if token.kind == "symbol" else "number", token.text.lstrip("\\"), at=token.at)
        else:
            raise self.error("write braces around the arguments of \\frac")
        return Node("sum", children=[Node("product", children=[node], at=token.at)], at=token.at)

    def rate(self, token):
        """d x / d t, also with d^2: the rate of a symbol, or None where it is another fraction."""
        start = self.at

        def differential():
            if self.peek().text != "d" or self.peek().kind not in ("symbol", "upright"):
                return None
            self.next()
            if not self.sees("power"):
                return 1
            self.next()
            return {"2": 2, "3": 3}.get(self.braced_text())

        def opened(text):
            if not self.sees("brace", text):
                return False
            self.next()
            return True

        dots = differential() if opened("{") else None
        if dots and self.sees("brace", "}"):
            return self.derivative(dots, token)
        node = self.base() if dots and self.peek().kind in ("symbol", "upright", "accent") else None
        if node and opened("}") and opened("{") and self.peek().text == "d" and self.next() and self.sees("symbol", "t"):
            self.next()
            power = 1
            if self.sees("power"):
                self.next()
                power = {"2": 2, "3": 3}.get(self.braced_text())
            self.shut()
            if power != dots:
                raise self.error(f"d^{dots} over dt^{power}", token)
            node.dots = dots
            return node
        self.at = start
        return None

    def derivative(self, order, token):
        """d/d t, or d^2/d t^2, of the bracket that follows."""
        self.shut()
        below = [_plain(self.next()) for _ in range(3 if order == 1 else 5)]
        if below != ["{", "d", "t"] + ["^", str(order)] * (order > 1) or order > 2 or not self.sees("brace", "}"):
            raise self.error("of brackets, d/d t and d^2/d t^2 are known: carry other derivatives out", token)
        self.next()
        if not self.sees("open"):
            raise self.error("write brackets around what d/d t is of", token)
        return Node("rate", children=[self.base()], dots=order, at=token.at)

    def under(self, accent, dots, token):
        """The symbol under dots or an accent, in braces or not."""
        braced = self.sees("brace", "{")
        if braced:
            self.next()
        inner = self.next()
        if inner.kind in ("accent", "dots"):
            node = self.under(inner.text.lstrip("\\") if inner.kind == "accent" else "", inner.text.count("d") if inner.kind == "dots" else 0,
                              inner)
        elif inner.kind in ("symbol", "upright"):
            node = Node("symbol", inner.text.lstrip("\\"), at=token.at)
        else:
            raise self.error(f"{token.text} stands over one symbol, not over {inner.text!r}", inner)
        if node.dots and dots or node.accent and accent:
            raise self.error(f"{token.text} over another of its kind", token)
        node.dots, node.accent, node.at = node.dots or dots, node.accent or accent, token.at
        if braced:
            node.index = node.index or self.index()
            if not self.sees("brace", "}"):
                raise self.error(f"{token.text} stands over one symbol: write out the rate of anything else", token)
            self.next()
        return node

    def call(self, name, token):
        """A function with its argument: the next factor, also after a number. A power is written before it."""
        power = self.exponent() if self.sees("power") else None
        if power is not None and int(power) < 1:
            raise self.error(f"\\{name}^{{{power}}} can be read in two ways: write the reciprocal as \\frac", token)
        first = self.peek()
        if first.kind in ("sign", "function", "nothing"):
            raise self.error(f"write brackets around the argument of \\{name}")
        inner = self.base()
        numeric = inner.kind == "number" or inner.kind == "fraction" and all(_numeric(part) for part in inner.children)
        if inner.kind == "product":
            if len(inner.children) > 2 or inner.children[0].kind != "number":
                raise self.error(f"what belongs to \\{name} does not show in print: write brackets around its argument", first)
            inner = Node("group", "", [Node("sum", children=[inner])], at=first.at)
        elif numeric and self.peek().kind in (*FACTORS, "times"):
            if self.peek().kind not in ("symbol", "upright", "accent", "open", "frac"):
                raise self.error(f"what belongs to \\{name} can be read in two ways: write brackets around its argument", first)
            inner = Node("group", "", [Node("sum", children=[Node("product", children=[inner, self.base()])])], at=first.at)
        if self.sees("power"):
            raise self.error(f"the power after the argument of \\{name} can be read in two ways: write \\{name}^2 before it, "
                             "or brackets around what is raised")
        node = Node("call", name, [inner], at=token.at)
        return node if power is None else Node("power", power, [node], at=token.at)

    def braced_text(self):
        """The text of `x` or `{x...}` after ^ or _."""
        if not self.sees("brace", "{"):
            token = self.next("symbol", "number", "sign", "upright", "text")
            if len(token.text) > 1 and token.text[0].isdigit():
                raise self.error(f"LaTeX raises or lowers the first digit of {token.text} alone: write {{{token.text}}}", token)
            return _plain(token)
        self.next()
        text = ""
        while not self.sees("brace", "}"):
            text += _plain(self.next("symbol", "number", "sign", "upright", "text", "end", "index"))
        self.shut()
        return text

    def index(self):
        """The index after a symbol, if any."""
        if not self.sees("index"):
            return ""
        self.next()
        return self.braced_text().lstrip("\\")

    def indexed(self, node):
        """A symbol with its index and with a time such as (t^+)."""
        node.index = node.index or self.index()
        if self.sees("index"):
            raise self.error("a second index")
        if self.sees("prime"):
            raise self.error(self.unexpected())
        if self.sees("time"):
            node.time = self.next().text.strip("(t^{}) ")
        elif self.sees("of_time"):
            self.next()  # x(t) is x
        return node


def _plain(token):
    """The text of a token of an index."""
    return token.text[6:-1] if token.kind == "text" else token.text


def _numeric(node):
    """Whether a side of a fraction is a number."""
    return len(node.children) == 1 and [factor.kind for factor in node.children[0].children] == ["number"]
