"""The macros that a manuscript defines for itself: \\newcommand, \\renewcommand, \\providecommand, \\def and \\DeclareMathOperator."""

import re

from ..errors import LatexError

DEFINED = re.compile(r"\\(?:(?:re|provide)?newcommand|providecommand|renewcommand)\*?\s*\{?\s*\\(?P<name>[A-Za-z]+)\s*\}?\s*(?:\[(?P<count>\d)\])?\s*(?=\{)"
                     r"|\\def\s*\\(?P<plain>[A-Za-z]+)\s*(?P<hashes>(?:#\d)*)\s*(?=\{)"
                     r"|\\DeclareMathOperator\*?\s*\{?\s*\\(?P<operator>[A-Za-z]+)\s*\}?\s*(?=\{)")

# a macro that needs more others in one another is one that contains itself
DEPTH = 20


def macros(text):
    """{name: (number of arguments, what it stands for)} of a text."""
    found = {}
    for match in DEFINED.finditer(text):
        body = braced(text, match.end())
        name = match["name"] or match["plain"] or match["operator"]
        count = int(match["count"] or 0) if match["name"] else len(match["hashes"] or "") // 2
        found[name] = (count, rf"\operatorname{{{body}}}" if match["operator"] else body)
    return found


def braced(text, start):
    """What stands in the braces that open at a place, without them; or None where they do not close."""
    depth = 0
    for match in re.compile(r"\\.|[{}]", re.DOTALL).finditer(text, start):
        depth += {"{": 1, "}": -1}.get(match.group(), 0)
        if not depth:
            return text[start + 1:match.start()]
    return None


def expanded(text, known, depth=0):
    """A text with its macros put in."""
    if depth > DEPTH:
        raise LatexError("a macro contains itself")
    for match in re.compile(r"\\([A-Za-z]+)\s*").finditer(text):
        if match[1] in known:
            value, end = applied(known[match[1]], text, match.end())
            gap = " " if value[-1:].isalpha() and text[end:end + 1].isalpha() else ""
            return text[:match.start()] + expanded(value, known, depth + 1) + gap + expanded(text[end:], known, depth)
    return text


def applied(macro, text, start):
    """(what a macro stands for with its arguments, where these end)."""
    count, body = macro
    arguments = []
    for _ in range(count):
        start += len(text[start:]) - len(text[start:].lstrip())
        inner = braced(text, start) if text[start:start + 1] == "{" else re.match(r"\\[A-Za-z]+|.?", text[start:]).group()
        if not inner and text[start:start + 1] != "{":
            raise LatexError("an argument of a macro is missing")
        arguments.append(inner)
        start += len(inner) + 2 * (text[start:start + 1] == "{")
    return re.sub(r"#(\d)", lambda match: arguments[int(match[1]) - 1], body), start
