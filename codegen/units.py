"""Physical dimensions: parsing of units and their propagation through a CasADi graph.

A dimension is a tuple of exponents over (kg, m, s) as fractions; angles are dimensionless.
"""

import re
from fractions import Fraction

import casadi as ca

BASE = ("kg", "m", "s")
NONE = (Fraction(0),) * len(BASE)

_NAMED = {
    "1": {}, "rad": {}, "-": {},
    "kg": {"kg": 1}, "m": {"m": 1}, "s": {"s": 1},
    "Hz": {"s": -1}, "N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3}, "Pa": {"kg": 1, "m": -1, "s": -2},
}
_FACTOR = re.compile(r"^([A-Za-z1-]+)(?:\^(-?\d+))?$")


class UnitError(Exception):
    """A unit that cannot be read, or a term of the wrong dimension."""


def parse(unit):
    """The dimension of a unit text such as `kg m^2/s^2`. SI units without prefixes."""
    exponents = dict.fromkeys(BASE, Fraction(0))
    parts = unit.replace("*", " ").split("/")
    for place, part in enumerate(parts):
        for factor in part.split():
            match = _FACTOR.match(factor)
            if not match or match.group(1) not in _NAMED:
                raise UnitError(
                    f"unit `{unit}`: `{factor}` is not known; use {', '.join(sorted(_NAMED))}"
                    " with integer powers (`kg m^2/s^2`)"
                )
            power = int(match.group(2) or 1) * (1 if place == 0 else -1)
            for base, exponent in _NAMED[match.group(1)].items():
                exponents[base] += power * exponent
    return tuple(exponents[base] for base in BASE)


def combine(a, b, sign=1):
    """Dimension of a product (sign 1) or a quotient (sign -1)."""
    return tuple(x + sign * y for x, y in zip(a, b))


def power(a, exponent):
    """Dimension of a power."""
    return tuple(x * exponent for x in a)


def text(dimension):
    """A dimension as text, `kg m/s^2`; `1` where there is none."""
    def side(sign):
        return " ".join(
            base if abs(e) == 1 else f"{base}^{abs(e)}"
            for base, e in zip(BASE, dimension) if e * sign > 0
        )
    above, below = side(1), side(-1)
    if not below:
        return above or "1"
    return f"{above or '1'}/{below}" if " " not in below else f"{above or '1'}/({below})"


def named(dimension, names):
    """A dimension as the one of some units that it is; in base units if it is none of them."""
    return next((name for name in names if parse(name) == dimension), text(dimension))


def force(dimension, is_rate):
    """The dimension of the force along a number of some dimension, or along what it is the rate of."""
    along = combine(dimension, parse("s")) if is_rate else dimension
    return combine(parse("kg m^2/s^2"), along, -1)


def of_force(dimension):
    """The unit of a force of some dimension, as a text."""
    return named(dimension, ("N", "N m"))


def of_impulse(dimension):
    """The unit of the impulse of a force of some dimension, as a text."""
    return named(combine(dimension, parse("s")), ("N s", "N m s"))


class _Free:
    """The dimension of an exact zero: it fits anywhere."""


FREE = _Free()


def dimension_of(expression, table):
    """Dimension of a scalar SX `expression`; `table` maps symbol names to dimensions.

    Raises UnitError naming the innermost term whose dimension is wrong.
    """
    symbols = ca.symvar(expression)
    function = ca.Function("units", symbols, [expression])
    work, terms = {}, {}
    result = NONE
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        into = function.instruction_output(k)
        source = function.instruction_input(k)
        if op == ca.OP_CONST:
            value = function.instruction_constant(k)
            work[into[0]] = FREE if value == 0 else NONE
            terms[into[0]] = ca.SX(value)
        elif op == ca.OP_INPUT:
            symbol = symbols[source[0]]
            if symbol.name() not in table:
                raise UnitError(f"symbol `{symbol.name()}` was not declared by this model")
            work[into[0]] = table[symbol.name()]
            terms[into[0]] = symbol
        elif op == ca.OP_OUTPUT:
            result = work[source[0]]
        else:
            arguments = [work[i] for i in source]
            values = [terms[i] for i in source]
            work[into[0]], terms[into[0]] = _apply(op, arguments, values)
    return NONE if result is FREE else result


_DIMENSIONLESS = {
    getattr(ca, name): name[3:].lower()
    for name in ("OP_SIN", "OP_COS", "OP_TAN", "OP_ASIN", "OP_ACOS", "OP_ATAN", "OP_EXP", "OP_LOG",
                 "OP_SINH", "OP_COSH", "OP_TANH", "OP_ASINH", "OP_ACOSH", "OP_ATANH", "OP_EXPM1",
                 "OP_LOG1P", "OP_ERF")
}


def _apply(op, dims, values):
    """Dimension and value of one operation of the graph."""
    value = ca.SX.binary(op, *values) if len(values) == 2 else ca.SX.unary(op, *values)
    if op in (ca.OP_ADD, ca.OP_SUB, ca.OP_FMIN, ca.OP_FMAX, ca.OP_HYPOT, ca.OP_FMOD):
        known = [d for d in dims if d is not FREE]
        if len(known) == 2 and known[0] != known[1]:
            raise UnitError(
                f"terms of different dimension are added: `{short(values[0])}` is {text(dims[0])}, "
                f"`{short(values[1])}` is {text(dims[1])}"
            )
        return (known[0] if known else FREE), value
    if op in (ca.OP_LT, ca.OP_LE, ca.OP_EQ, ca.OP_NE, ca.OP_NOT, ca.OP_AND, ca.OP_OR, ca.OP_SIGN):
        return NONE, value
    if op == ca.OP_IF_ELSE_ZERO:
        return dims[1], value
    if FREE in dims and op in (ca.OP_MUL, ca.OP_DIV, ca.OP_SQ, ca.OP_TWICE, ca.OP_NEG, ca.OP_FABS):
        return FREE, value
    dims = [NONE if d is FREE else d for d in dims]
    if op in (ca.OP_NEG, ca.OP_FABS, ca.OP_TWICE, ca.OP_ASSIGN, ca.OP_COPYSIGN):
        return dims[0], value
    if op == ca.OP_MUL:
        return combine(*dims), value
    if op == ca.OP_DIV:
        return combine(*dims, -1), value
    if op == ca.OP_INV:
        return power(dims[0], Fraction(-1)), value
    if op == ca.OP_SQ:
        return power(dims[0], Fraction(2)), value
    if op == ca.OP_SQRT:
        return power(dims[0], Fraction(1, 2)), value
    if op in (ca.OP_POW, ca.OP_CONSTPOW):
        if dims[1] != NONE:
            raise UnitError(f"the exponent `{short(values[1])}` has the dimension {text(dims[1])}")
        if dims[0] == NONE:
            return NONE, value
        if not values[1].is_constant():
            raise UnitError(f"`{short(values[0])}` ({text(dims[0])}) has an exponent that is not a number")
        return power(dims[0], Fraction(float(values[1])).limit_denominator(1000)), value
    if op == ca.OP_ATAN2:
        if dims[0] != dims[1]:
            raise UnitError(f"atan2 of `{short(values[0])}` and `{short(values[1])}`: dimensions differ")
        return NONE, value
    if op in _DIMENSIONLESS:
        if dims[0] != NONE:
            raise UnitError(
                f"the argument of {_DIMENSIONLESS[op]}, `{short(values[0])}`, has the dimension {text(dims[0])}"
            )
        return NONE, value
    raise UnitError(f"`{short(value)}`: the dimension of this operation is not known")


def short(expression, limit=90):
    """A term as text, its numbers with all their digits, cut where it is long."""
    precision = ca.SX.get_precision()
    ca.SX.set_precision(17)
    try:
        line = str(expression)
    finally:
        ca.SX.set_precision(precision)
    # The fewest digits that give the same number.
    line = re.sub(r"\b\d+\.\d+(e[+-]?\d+)?", lambda number: repr(float(number[0])), line)
    line = _without_names_of_atoms(line)
    return line if len(line) <= limit else line[: limit - 1] + "…"


def _without_names_of_atoms(line):
    """A text without the names that CasADi gives to numbers and symbols which it has twice: `@1=1, (@1-x)` is `(1-x)`."""
    while named := re.match(r"(.*?)(@\d+)=([\w.]+), (.*)", line):
        before, name, atom, rest = named.groups()
        line = before + re.sub(name + r"\b", atom, rest)
    return line
