"""Values of expressions at one point: a quick answer to whether a sum can be zero everywhere, before that is decided exactly."""

import math
from itertools import combinations
from zlib import crc32

# Rounding leaves about 1e-15 of the largest summand; a sum of which more than this is left is not zero everywhere.
LEFT = 1e-6

FUNCTIONS = {"sin": math.sin, "cos": math.cos, "tan": math.tan, "Abs": abs, "sign": lambda x: math.copysign(1.0, x)}


def vanishes(expressions, states):
    """Whether a sum of SymPy expressions is zero at a point where the discrete states `states` are 1; where it is not, it is not
    zero everywhere. What has no value there may be."""
    try:
        values = [value(x, states) for x in expressions]
    except (ZeroDivisionError, OverflowError, KeyError):
        return True
    return abs(sum(values)) <= LEFT * max(map(abs, values))


def at_point(form, states):
    """The value of a form at the same point; None where it has none, or a factor that is no number."""
    values = {name: 1.0 if name in states else _value_of(name) for name in form.names()}
    try:
        return float(form.evaluate(values, math.sin, math.cos, 0.0))
    except (ZeroDivisionError, OverflowError, KeyError):
        return None


def symmetric(matrix, factors):
    """Whether the values of a matrix at a point, each row times its factor, are symmetric; what is None may be anything. Where
    they are not, the matrix is not symmetric."""
    for k, l in combinations(range(len(matrix)), 2):
        parts = (factors[k], matrix[k][l], factors[l], matrix[l][k])
        if None in parts:
            continue
        left, right = parts[0] * parts[1], parts[2] * parts[3]
        if abs(left - right) > LEFT * max(abs(left), abs(right)):
            return False
    return True


def _value_of(name):
    return 0.5 + crc32(name.encode()) / 2**32


def value(expression, states):
    """The value of an expression; every symbol but the states has one of its own, between 1/2 and 3/2, which follows from its name."""
    if expression.is_Symbol:
        return 1.0 if expression.name in states else _value_of(expression.name)
    if expression.is_Number:
        return float(expression)
    if expression.is_Add:
        return math.fsum(value(x, states) for x in expression.args)
    if expression.is_Mul:
        return math.prod(value(x, states) for x in expression.args)
    if expression.is_Pow:
        return value(expression.base, states) ** value(expression.exp, states)
    return FUNCTIONS[expression.func.__name__](value(expression.args[0], states))
