"""Dimensions: exponents of kg, m and s, read from units and from expressions."""

import re
from fractions import Fraction

from ..errors import UnitError

BASE = ("kg", "m", "s")
DERIVED = {"1": {}, "rad": {}, "N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2},
           "W": {"kg": 1, "m": 2, "s": -3}, "Hz": {"s": -1}, "Pa": {"kg": 1, "m": -1, "s": -2}}


class Dimension(tuple):
    """Exponents (kg, m, s)."""

    @staticmethod
    def of(**exponents):
        """The dimension with these exponents."""
        return Dimension(exponents.get(base, 0) for base in BASE)

    def times(self, other, power=1):
        """self * other**power."""
        return Dimension(a + b * power for a, b in zip(self, other))

    def __str__(self):
        parts = [base if e == 1 else f"{base}^{e}" for base, e in zip(BASE, self) if e]
        return "*".join(parts) or "1"


NONE = Dimension.of()


def parse(unit):
    """The dimension of a unit such as `kg*m^2`, `m/s^2`, `N*s/m`, `rad`, `1`."""
    result, sign = NONE, 1
    for token in re.split(r"([*/])", unit.replace(" ", "")):
        if token in "*/":
            sign = 1 if token == "*" else -1
            continue
        match = re.fullmatch(r"([A-Za-z]+|1)(?:\^(-?\d+))?", token)
        name = match and match.group(1)
        if not match or (name not in BASE and name not in DERIVED):
            raise UnitError(f"the unit '{unit}' is not made of {', '.join([*BASE, *DERIVED])} with *, / and ^")
        dimension = Dimension.of(**(DERIVED.get(name, {name: 1})))
        result = result.times(dimension, sign * int(match.group(2) or 1))
    return result


def table(symbols):
    """Dimension by name of symbols, their rates and their accelerations."""
    known = {}
    for symbol in symbols:
        base = parse(symbol.unit)
        known[symbol.name] = base
        known["d" + symbol.name] = base.times(parse("s"), -1)
        known["dd" + symbol.name] = base.times(parse("s"), -2)
    return known


def measure(expression, known):
    """The dimension of a SymPy expression; UnitError where a sum or a function does not fit."""
    import sympy

    from .rates import Rate

    if expression.is_Symbol:
        return known[expression.name]
    if expression.is_number:
        return NONE
    if expression.is_Add:
        parts = [measure(argument, known) for argument in expression.args]
        if len(set(parts)) > 1:
            raise UnitError("a sum of " + " and ".join(sorted({str(part) for part in parts})))
        return parts[0]
    if expression.is_Mul:
        result = NONE
        for argument in expression.args:
            result = result.times(measure(argument, known))
        return result
    if expression.is_Pow and expression.exp.is_Rational:
        return NONE.times(measure(expression.base, known), Fraction(int(expression.exp.p), int(expression.exp.q)))
    inner = measure(expression.args[0], known)
    if expression.func == sympy.sign:
        return NONE
    if expression.func == sympy.Abs:
        return inner
    if expression.func == Rate:
        return inner.times(parse("s"), -1)
    if inner != NONE:
        raise UnitError(f"{expression.func.__name__} of an argument in {inner}")
    return NONE
