"""The LaTeX of a printed equation as a list of tokens, each with its place; errors show the place."""

import re
from dataclasses import dataclass

from ..errors import LatexError, Place
from .macros import applied, braced, expanded


class Placed(str):
    """A part of a file's text that knows where it stands: `file`, the `whole` text, its `offset`, and the `macros` of the file."""

    def __new__(cls, whole, start, end, file, macros=None):
        result = super().__new__(cls, whole[start:end])
        result.whole, result.offset, result.file, result.macros = whole, start, file, macros or {}
        return result


def error_at(latex, at, what):
    """A LatexError about a place of a text: line, column, the line itself and a caret below it."""
    whole, at = getattr(latex, "whole", latex), at + getattr(latex, "offset", 0)
    start = whole.rfind("\n", 0, at) + 1
    end = whole.find("\n", at)
    line, column = whole.count("\n", 0, at) + 1, at - start + 1
    shown = whole[start:end if end >= 0 else len(whole)].replace("\t", " ")
    file = getattr(latex, "file", "")
    return LatexError(what, Place(file, line, column), f"    {shown}\n    {' ' * (column - 1)}^")


@dataclass
class Token:
    """A token: `kind` is what the parser asks for, `at` the offset of its first character."""

    kind: str
    text: str
    at: int


GREEK = {"lambda": "λ", "theta": "θ", "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε",
         "zeta": "ζ", "eta": "η", "iota": "ι", "kappa": "κ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ",
         "tau": "τ", "upsilon": "υ", "phi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ",
         "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π", "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω", "varphi": "ϕ", "vartheta": "ϑ",
         "varepsilon": "ϵ", "ell": "ℓ"}

FRAMES = "aligned|alignedat|align|gather|gathered|split|equation|multline|displaymath|math|eqnarray"

TOKEN = re.compile(
    r"(?:\s|~|%[^\n]*(?:\n|$))+|&|(?P<break>\\\\\*?(?:\[[^\]]*\])?)|(?P<skip>\\[,;:!> ]|\\/)"
    rf"|(?P<frame>\\(?:begin|end)\{{(?:{FRAMES})\*?\}}|\\\[|\\\]|\$\$?)"
    r"|(?P<place>\\(?:label|tag\*?|[hvm]space\*?|[hv]?phantom|color)\{[^{}]*\}|\\(?:hskip|kern|mkern|mskip)\s*-?[\d.]+\s*[a-z]{2}(?![a-z]))"
    r"|(?P<shown>\\(?:boxed|ensuremath|smash|mathop|textcolor\{[^{}]*\})\s*(?=\{))"
    r"|(?P<roman>\\(?:text|textrm|textnormal|mathrm|mathit|mathnormal|mathcal|mathscr|mathsf|operatorname\*?|mbox)"
    r"(?:\s*\{(?P<word>[^{}]*)\}|\s+(?P<letter>[A-Za-z])))"
    r"|(?P<time>\(t\s*\^\s*\{?[+-]\}?\))|(?P<of_time>\(t\)|\\left\s*\(\s*t\s*\\right\s*\))"
    r"|(?P<command>\\(?:[A-Za-z]+|[|{}]))|(?P<symbol>[A-Za-z]|[α-ωΑ-Ωϕϑϵℓ])|(?P<number>\d+(?:\.\d+)?|\.\d+)|(?P<open>[(\[])|(?P<close>[)\]])"
    r"|(?P<bar>\|)|(?P<relation>:=|[=<>≤≥])|(?P<sign>[+−-])|(?P<power>\^)|(?P<index>_)|(?P<brace>[{}])|(?P<slash>/)|(?P<times>[*·×])"
    r"|(?P<end>[.,;:])|(?P<prime>['’])")

# braces that change nothing that shows: around a sign, around nothing before an index or power, around one upright word
LONE = re.compile(r"\{(?P<inner>\s*(?:[+−=-]\s*\}|\}(?=\s*[\^_])|\\rm\s+(?P<upright>[A-Za-z]+)\s*\}))")

# what takes braces as its argument
TAKES_BRACES = ("frac", "dots", "accent", "power", "index", "function")

# what a command is; any other is a symbol, which must be declared
COMMANDS = {
    "quad": "skip", "qquad": "skip", "displaystyle": "skip", "textstyle": "skip", "nonumber": "skip", "notag": "skip",
    "mathstrut": "skip", "strut": "skip", "enspace": "skip", "allowbreak": "skip", "hfill": "skip", "scriptstyle": "skip", "rm": "skip", "it": "skip", "centering": "skip", "thinspace": "skip", "limits": "skip", "left": "size", "right": "size", "middle": "size",
    "sin": "function", "cos": "function", "tan": "function", "cot": "function", "sec": "function", "csc": "function",
    "sign": "function", "sgn": "function",
    "dot": "dots", "ddot": "dots", "dddot": "dots", "frac": "frac", "dfrac": "frac", "tfrac": "frac", "cfrac": "frac",
    "nicefrac": "frac", "sfrac": "frac", "cdot": "times", "cdotp": "times", "times": "times", "ast": "times", "lvert": "bar", "rvert": "bar", "vert": "bar",
    "bar": "accent", "hat": "accent", "tilde": "accent", "overline": "accent", "widetilde": "accent", "widehat": "accent",
    "lt": "relation", "gt": "relation", "le": "relation", "leq": "relation", "ge": "relation", "geq": "relation",
    "leqslant": "relation", "geqslant": "relation", "equiv": "relation", "triangleq": "relation", "coloneqq": "relation",
    "coloneq": "relation", "{": "open", "lbrace": "open", "lbrack": "open", "lparen": "open",
    "}": "close", "rbrace": "close", "rbrack": "close", "rparen": "close",
    **{name: "size" for name in ("big", "Big", "bigg", "Bigg", "bigl", "bigr", "Bigl", "Bigr", "biggl", "biggr", "Biggl", "Biggr")},
}

# what is refused, and what to write instead
REFUSED = {
    "sqrt": "a root is no trigonometric polynomial: multiply the equation out, or declare the root as a symbol",
    "exp": "an exponential is no trigonometric polynomial: declare it as a symbol",
    "ln": "a logarithm is no trigonometric polynomial: declare it as a symbol",
    "log": "a logarithm is no trigonometric polynomial: declare it as a symbol",
    "arcsin": "an inverse function is no trigonometric polynomial: declare the angle as a symbol",
    "arccos": "an inverse function is no trigonometric polynomial: declare the angle as a symbol",
    "arctan": "an inverse function is no trigonometric polynomial: declare the angle as a symbol",
    "sinh": "a hyperbolic function is no trigonometric polynomial: declare it as a symbol",
    "cosh": "a hyperbolic function is no trigonometric polynomial: declare it as a symbol",
    "tanh": "a hyperbolic function is no trigonometric polynomial: declare it as a symbol",
    **{name: "what follows from an equation is an equation of its own: give it a display" for name in (
        "Rightarrow", "Longrightarrow", "implies", "iff", "Leftrightarrow", "rightarrow", "to", "therefore", "longrightarrow")},
    **{name: "write the sign or symbol alone" for name in ("stackrel", "overset", "underset")},
    "int": "an integral cannot be judged: carry it out", "sum": "write the terms of the sum", "prod": "write the factors of the product",
    "partial": "carry the derivative out: only rates in time are known, \\dot and \\ddot", "nabla": "carry the derivative out",
    "pm": "two equations in one: write one for each sign, or declare a sign symbol",
    "mp": "two equations in one: write one for each sign, or declare a sign symbol",
    "approx": "an approximation is no equation: write = or a relation", "simeq": "an approximation is no equation: write = or a relation",
    "neq": "that two things differ cannot be judged: write < or >", "ne": "that two things differ cannot be judged: "
    "write < or >", "propto": "a proportion is no equation: write the factor", "ll": "write <", "gg": "write >",
    "over": "write \\frac{...}{...}", "vec": "a vector cannot be judged: write its components", "mathbf": "a vector cannot be judged: "
    "write its components", "boldsymbol": "a vector cannot be judged: write its components", "bm": "a vector cannot be judged: write "
    "its components", "prime": "a prime can be a derivative or a name: write \\dot, or an index", "|": "write | for a modulus",
    "langle": "write ( or |", "rangle": "write ) or |", "ldots": "write all terms", "dots": "write all terms", "cdots": "write all terms",
    "max": "write one condition for each case", "min": "write one condition for each case", "ddddot": "equations of motion have two dots "
    "at most", "div": "write \\frac{...}{...}", "circ": "write angles in radians", "underbrace": "write what is above the brace alone",
    "begin": "write each case or component as an equation of its own", "end": "an end "
    "without its beginning",
}

FUNCTIONS = {"sin": "sin", "cos": "cos", "tan": "tan", "cot": "cot", "sec": "sec", "csc": "csc", "sign": "sign", "sgn": "sign", "signum": "sign"}
RELATIONS = {"lt": "<", "gt": ">", "le": "≤", "leq": "≤", "leqslant": "≤", "ge": "≥", "geq": "≥", "geqslant": "≥",
             "equiv": "=", "triangleq": "=", "coloneqq": "=", "coloneq": "="}
BRACKETS = {r"\lbrace": r"\{", r"\rbrace": r"\}", r"\lbrack": "[", r"\rbrack": "]", r"\lparen": "(", r"\rparen": ")"}


def tokens(latex):
    """The tokens of a text; what does not show in print is left out, and macros are put in."""
    found, place, unseen, macros = [], 0, set(), getattr(latex, "macros", {})
    while place < len(latex):
        if place in unseen:
            place += 1
            continue
        match = TOKEN.match(latex, place)
        if not match:
            raise error_at(latex, place, f"{latex[place]!r} cannot be read here")
        kind, text, at = match.lastgroup, match.group(), place
        place = match.end()
        if text == "{" and (lone := LONE.match(latex, at)) and not _argument(found, lone):
            unseen.add(lone.end() - 1)
            place = lone.start("inner")
            if lone.group("upright"):
                found.append(Token(*_roman("", lone.group("upright")), at))
                place = lone.end()
            continue
        if kind == "command" and text[1:] in macros:
            made, place = _macro(latex, text, at, place, macros)
            found += made
            continue
        if kind == "shown" and (inner := braced(latex, place)) is not None:
            unseen |= {place, place + 1 + len(inner)}
            continue
        if kind == "command":
            kind, text = _command(latex, text, at)
        elif kind == "roman":
            kind, text = _roman(text, (match.group("word") or match.group("letter") or "").strip())
        elif kind == "symbol" and not text.isascii():
            text = "\\" + next(name for name, letter in GREEK.items() if letter == text) if text in GREEK.values() else text
        elif kind == "sign":
            text = "+" if text == "+" else "-"
        elif text == ":=":
            text = "="
        if kind == "size":
            rest = latex[place:].lstrip()
            if rest.startswith("."):
                raise error_at(latex, at, "a bracket that does not show: write both brackets, or none")
            continue
        if kind not in (None, "skip", "frame", "place"):
            found.append(Token(kind, text, at))
    return found


def _argument(found, lone):
    """Whether braces after these tokens may be an argument; a sign, or nothing, is none that could stand after another argument."""
    return bool(found) and (found[-1].kind in TAKES_BRACES or found[-1].text == "}" and lone.group("upright") is not None)


def _macro(latex, text, at, place, macros):
    """The tokens that a macro stands for, all at its place, and where its arguments end."""
    try:
        value, end = applied(macros[text[1:]], latex, place)
        value = expanded(value, macros)
        return [Token(token.kind, token.text, at) for token in tokens(value)], end
    except LatexError as error:
        raise error_at(latex, at, f"the macro {text}: {error.what}") from error


def _command(latex, text, at):
    """What a command is, and how it is written in the tree."""
    name = text[1:]
    if name in REFUSED:
        raise error_at(latex, at, f"{text}: {REFUSED[name]}")
    kind = COMMANDS.get(name, "symbol")
    if kind == "function":
        text = "\\" + FUNCTIONS[name]
    elif kind == "relation":
        text = RELATIONS[name]
    elif kind == "bar":
        text = "|"
    return kind, BRACKETS.get(text, text)


def _roman(text, word):
    """Upright words: a function, a name, or words between equations."""
    if word in tuple(".,;:"):
        return "end", word
    if not text.startswith((r"\text", r"\mbox")) or word in FUNCTIONS or word == "d":
        return ("function", "\\" + FUNCTIONS[word]) if word in FUNCTIONS else ("upright", word)
    return "text", rf"\text{{{word}}}"
