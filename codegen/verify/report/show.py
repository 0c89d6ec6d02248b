"""Normal forms for people: as plain text for terminals and as LaTeX."""

import re

from ..input.latex import ENTITIES
from ..input.printed import latex_name
from ..normal.form import Form, Opaque

class Unit(str):
    """A unit such as `kg*m^2`, which pages typeset."""


class Quantity(str):
    """A number and its unit, with a space between."""


# combining marks above
OVER = {"bar": "\u0304", "hat": "\u0302", "tilde": "\u0303"}
# combining dots above, by their number
ACCENTS = {1: "\u0307", 2: "\u0308", 3: "\u20db"}


def _split(name, paper):
    """A name as (dots, symbol name): `ddx_I` is (2, `x_I`)."""
    if name in paper.symbols:
        return 0, name
    found = [dots for dots in (1, 2, 3) if name.startswith("d" * dots)]
    # of a coordinate that only the energies have, the dots are all that is known
    dots = next((k for k in found if name[k:] in paper.symbols), found[-1] if found else 0)
    return dots, name[dots:]


def symbol_latex(name, paper):
    """LaTeX of a symbol, a rate or an opaque factor."""
    if isinstance(name, Opaque):
        inner = form_latex(name.argument, paper)
        return f"|{inner}|" if name.function == "Abs" else rf"\operatorname{{sign}}({inner})"
    dots, base = _split(name, paper)
    latex = paper.symbols[base].latex if base in paper.symbols else latex_name(base)
    if base in paper.symbols and paper.symbols[base].velocity:
        dots = max(dots - 1, 0)
    if dots:
        head, _, index = latex.partition("_")
        latex = rf"\{'d' * dots}ot{{{head}}}" + (f"_{index}" if index else "")
    return latex


def _order(name, paper):
    """Factors in the usual order: lambda, parameters, coordinates, then rates, then opaque ones."""
    if isinstance(name, Opaque):
        return (4, 0, str(name))
    dots, base = _split(name, paper)
    names = list(paper.symbols)
    roles = {"discrete": 0, "parameter": 1, "force": 1, "coordinate": 2, "input": 2}
    role = roles[paper.symbols[base].role] if base in paper.symbols else 2
    return (3 + dots if dots else role, names.index(base) if base in names else len(names), str(name))


def term_latex(key, value, paper):
    """LaTeX of one term without its sign."""
    monomial, (kind, angle) = key
    value = abs(value)
    factors = sorted(monomial, key=lambda item: _order(item[0], paper))
    still = [_power(n, e, paper) for n, e in factors if _order(n, paper)[0] < 3]
    moving = [_power(n, e, paper) for n, e in factors if _order(n, paper)[0] >= 3]
    if angle:
        parts = []
        for name, slope in angle:
            size = abs(slope)
            text = (f"{size.numerator} " if size != 1 and size.denominator == 1 else
                    rf"\frac{{{size.numerator}}}{{{size.denominator}}} " if size != 1 else "") + symbol_latex(name, paper)
            parts.append(("-" if slope < 0 else "+" if parts else "") + text)
        inner = " ".join(parts)
        still.append(rf"\{kind} {inner}" if len(angle) == 1 and angle[0][1] == 1 else rf"\{kind}({inner})")
    if value != 1 or not still + moving:
        number = str(value.numerator) if value.denominator == 1 else rf"\frac{{{value.numerator}}}{{{value.denominator}}}"
        still.insert(0, number)
    return " ".join(still + moving)


def _power(name, exponent, paper):
    """LaTeX of a power of a symbol."""
    text, power = symbol_latex(name, paper), f"^{{{abs(exponent)}}}" if abs(exponent) > 9 else f"^{abs(exponent)}"
    raised = text if abs(exponent) == 1 else text + power
    if isinstance(name, Opaque) and name.function == "sign" and abs(exponent) != 1:
        raised = text.replace("{sign}", "{sign}" + power, 1)
    return raised if exponent > 0 else rf"\frac{{1}}{{{raised}}}"


def form_latex(form, paper):
    """LaTeX of a form."""
    if form.over:
        below = " ".join(_divisor_latex(divisor, power, len(form.over), paper) for divisor, power in form.over)
        return rf"\frac{{{form_latex(form.numerator(), paper)}}}{{{below}}}"
    parts = []
    for key, value in sorted(form.terms.items(), key=lambda item: str(item[0])):
        sign = "- " if value < 0 else "+ " if parts else ""
        parts.append(sign + term_latex(key, value, paper))
    return " ".join(parts) or "0"


def _divisor_latex(divisor, power, count, paper):
    """LaTeX of a power of a sum below a fraction stroke."""
    latex = form_latex(divisor, paper)
    if len(divisor.terms) > 1 and (power > 1 or count > 1) or power > 1:
        latex = rf"\left({latex}\right)"
    return latex if power == 1 else f"{latex}^{power}"


def expression_latex(expression, paper):
    """LaTeX of a SymPy expression in the symbols of a paper."""
    import sympy

    names = {symbol: symbol_latex(symbol.name, paper) for symbol in expression.free_symbols}
    return sympy.latex(expression, symbol_names=names, fold_func_brackets=True)


def unit_latex(unit):
    """LaTeX of a unit or a dimension: `kg*m^-2` is kg m^{-2}, upright."""
    text = re.sub(r"\^(-?[\d/]+)", r"^{\1}", str(unit)).replace("*", r"\,")
    return rf"\mathrm{{{text}}}"


def plain(latex):
    """LaTeX as plain text with Greek letters and dots over the symbols."""
    text = re.sub(r"\\(d+)ot\{\\?(\w+)\}", lambda x: ENTITIES.get(x[2], x[2]) + ACCENTS[len(x[1])], latex)
    text = re.sub(r"\\(bar|hat|tilde)\s*\{?\\?([A-Za-z]+)\}?", lambda x: ENTITIES.get(x[2], x[2]) + OVER[x[1]], text)
    text = re.sub(r"_\{(\w+)\}", r"_\1", text)
    text = re.sub(r"\\frac\{(\w+)\}\{([^{}]+)\}", r"\1/\2", text)
    text = re.sub(r"\\operatorname\{(\w+)\}", r"\1", text)
    text = re.sub(r"\\(sin|cos)", r"\1", text)
    text = re.sub(r"\\([A-Za-z]+)", lambda x: ENTITIES.get(x[1], x[1]), text)
    text = text.replace("^2", "²").replace("^3", "³").replace("-", "−")
    return re.sub(r"\s+", " ", text).strip()


def form_text(form, paper):
    """A form as plain text."""
    if form.over:
        above, below = form.numerator(), form.denominator()
        return "/".join(f"({form_text(part, paper)})" if len(part.terms) > 1 else form_text(part, paper) for part in (above, below))
    return plain(form_latex(form, paper))


def shown(part, paper):
    """A form, a dimension, a unit, a SymPy expression, or words, as plain text."""
    return form_text(part, paper) if isinstance(part, Form) else str(part)


def message_text(message, paper):
    """A violation's message as plain text."""
    return "".join(shown(part, paper) for part in message)
