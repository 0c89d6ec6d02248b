"""Bounds of expressions whose symbols stay within radii of given values.

A number is known by a centre, which is its value where the symbols have theirs, and a radius: the arithmetic
of discs (Alefeld and Herzberger 1983, Introduction to Interval Computations, chapter 5), on the real line.
Bounds are exact but for rounding.
"""

import casadi as ca


class _Unbounded(Exception):
    """An operation has no rule here."""


def lower_bound(expression, radii):
    """A value below which a scalar expression does not fall while its symbols change by at most their radii:
    as an expression in the symbols, which stand for the centres, and in the radii. −∞, or not a number, where
    nothing is known.

    `radii` maps hashes of symbols to expressions ≥ 0; None: it may be anything. The other symbols stay the
    same.
    """
    symbols = ca.symvar(expression)
    function = ca.Function("bound", symbols, [ca.cse(ca.SX(expression))])
    work = {}
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        into, source = function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_CONST:
            work[into[0]] = ca.SX(function.instruction_constant(k)), _NONE
        elif op == ca.OP_INPUT:
            symbol = symbols[source[0]]
            radius = radii.get(symbol.element_hash(), _NONE)
            if radius is None:
                return _NOTHING
            work[into[0]] = symbol, radius
        elif op == ca.OP_OUTPUT:
            centre, radius = work[source[0]]
            bound = centre - radius
        else:
            try:
                work[into[0]] = _operation(op, [work[i] for i in source])
            except _Unbounded:
                return _NOTHING
    return bound


_NONE = ca.SX(0)
_NOTHING = ca.SX(-ca.inf)


def _operation(op, arguments):
    """Centre and radius of an operation."""
    centres = [centre for centre, _ in arguments]
    centre = ca.SX.binary(op, *centres) if len(centres) == 2 else ca.SX.unary(op, *centres)
    if all(radius.is_zero() for _, radius in arguments):
        return centre, _NONE
    if op not in _RADII:
        raise _Unbounded
    return centre, _RADII[op](centre, *arguments)


def _product(_, x, y):
    (x, of_x), (y, of_y) = x, y
    return ca.fabs(x) * of_y + of_x * (ca.fabs(y) + of_y)


def _square(_, x):
    x, of_x = x
    return (2 * ca.fabs(x) + of_x) * of_x


def _inverse(centre, x):
    """Of 1/x; infinite where x may be zero."""
    x, of_x = x
    return ca.fabs(centre) * of_x / ca.fmax(ca.fabs(x) - of_x, 0)


def _quotient(_, x, y):
    inverse = 1 / y[0]
    return _product(None, x, (inverse, _inverse(inverse, y)))


def _root(centre, x):
    """Steepest downwards; not a number where x may be negative."""
    x, of_x = x
    return centre - ca.sqrt(x - of_x)


def _exponential(centre, x):
    return centre * (ca.exp(x[1]) - 1)


def _power(_, x, exponent):
    """A whole power by repeated products."""
    (exponent, of_exponent), (centre, radius) = exponent, x
    if not exponent.is_constant() or not of_exponent.is_zero() or float(exponent) not in range(2, 9):
        raise _Unbounded
    power = x
    for _ in range(int(exponent) - 1):
        power = power[0] * centre, _product(None, power, (centre, radius))
    return power[1]


def _slope_at_most_one(_, x):
    return x[1]


_RADII = {
    ca.OP_ADD: lambda _, x, y: x[1] + y[1],
    ca.OP_SUB: lambda _, x, y: x[1] + y[1],
    ca.OP_NEG: lambda _, x: x[1],
    ca.OP_TWICE: lambda _, x: 2 * x[1],
    ca.OP_MUL: _product,
    ca.OP_SQ: _square,
    ca.OP_INV: _inverse,
    ca.OP_DIV: _quotient,
    ca.OP_SQRT: _root,
    ca.OP_EXP: _exponential,
    ca.OP_POW: _power,
    ca.OP_CONSTPOW: _power,
    **{op: _slope_at_most_one for op in (
        ca.OP_ASSIGN, ca.OP_SIN, ca.OP_COS, ca.OP_ATAN, ca.OP_TANH, ca.OP_FABS)},
}
