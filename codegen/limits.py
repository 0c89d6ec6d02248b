"""Limit states, where a model is valid, and bounds of coordinates: what is watched besides guards.

Each is a margin: an expression that is not negative as long as nothing is reached or left.
"""

import math
from dataclasses import dataclass

import casadi as ca

from . import units
from .errors import ModelError


@dataclass
class Limit:
    """A limit state, reached where its margin falls below zero; `modes`: None for all of them."""

    name: str
    message: str
    margin: ca.SX
    text: str
    ends: bool
    modes: object
    location: str


@dataclass
class Validity:
    """A condition under which the model is meant, left where its margin falls below zero."""

    sentence: str
    margin: ca.SX
    text: str
    modes: object
    location: str


def comparison(condition, what, location):
    """The margin by which a comparison such as `theta < alpha` holds, and the comparison as text."""
    try:
        condition = ca.SX(condition)
    except (NotImplementedError, TypeError):
        raise ModelError(f"{what}: {condition!r} is no comparison; write one such as `theta < alpha / 2`", location) from None
    if condition.numel() != 1 or condition.op() not in (ca.OP_LT, ca.OP_LE):
        raise ModelError(
            f"{what}: `{units.short(condition)}` is no comparison; write one of two expressions that move or depend on"
            " parameters, such as `theta < alpha / 2`", location)
    less, more = condition.dep(0), condition.dep(1)
    sign = "<" if condition.op() == ca.OP_LT else "<="
    if less.is_constant():
        return more - less, f"{units.short(more)} {sign.replace('<', '>')} {units.short(less)}"
    return more - less, f"{units.short(less)} {sign} {units.short(more)}"


def is_of_parameters(model, expression):
    """Whether an expression depends on parameters alone."""
    parameters = {p.symbol.element_hash() for p in model.parameters}
    return all(symbol.element_hash() in parameters for symbol in ca.symvar(ca.SX(expression)))


def sign_of(model, expression):
    """+1 or −1 where an expression in parameters has that sign whatever a scene gives them; 0 where it may have either, or be zero."""
    expression = ca.SX(expression)
    if expression.is_constant():
        value = float(expression)
        return int(value > 0) - int(value < 0)
    bounds = {p.symbol.element_hash(): p.extra for p in model.parameters}
    if expression.is_symbolic():
        of = bounds.get(expression.element_hash())
        least, most = (of["minimum"], of["maximum"]) if of else (-math.inf, math.inf)
        return int(least > 0 or least == 0 and of["exclusive"]) - int(most < 0)
    signs = [sign_of(model, expression.dep(k)) for k in range(expression.n_dep())]
    return _SIGNS.get(expression.op(), lambda *_: 0)(*signs)


_SIGNS = {
    ca.OP_MUL: lambda a, b: a * b, ca.OP_DIV: lambda a, b: a * b, ca.OP_NEG: lambda a: -a, ca.OP_INV: lambda a: a, ca.OP_TWICE: lambda a: a,
    ca.OP_SQ: abs, ca.OP_SQRT: lambda a: a * (a > 0), ca.OP_EXP: lambda a: 1, ca.OP_ADD: lambda a, b: a * (a == b),
    ca.OP_SUB: lambda a, b: a * (a == -b)}


def of_motion(model):
    """The entries that are watched as a run goes: limits, then what of the validity depends on the motion."""
    return model.limits + [entry for entry in model.validity if not is_of_parameters(model, entry.margin)]


def margins(equations):
    """Of each of these, its margin in the symbols of a mode; 1 where it is not about this mode."""
    def place(entry):
        if entry.modes is not None and all(mode is not equations.mode for mode in entry.modes):
            return ca.SX(1)
        try:
            return equations.place(entry.margin)
        except ModelError as error:
            raise ModelError(str(error), entry.location) from None
    return [place(entry) for entry in of_motion(equations.model)]


def of_parameters(model):
    """What depends on parameters alone: margins of the validity, then bounds of coordinates that are expressions."""
    fixed = [entry.margin for entry in model.validity if is_of_parameters(model, entry.margin)]
    return ca.SX(ca.vertcat(*fixed, *[bound for _, _, bound in bounds(model)]))


def bounds(model):
    """The bounds of coordinates that are expressions in parameters: (index of the coordinate, whether it is the upper
    one, bound)."""
    return [(i, upper, bound)
            for i, c in enumerate(model.coordinates)
            for upper, bound in ((False, c.minimum), (True, c.maximum)) if isinstance(bound, ca.SX)]


def bound(model, name, value, location):
    """A bound of a coordinate: a number, an expression in parameters, or None."""
    if value is None or not isinstance(value, ca.SX):
        return None if value is None else float(value)
    if not is_of_parameters(model, value):
        raise ModelError(f"`{name}`: a bound of a coordinate is a number or an expression in parameters,"
                         f" not `{units.short(value)}`", location)
    return ca.SX(value)


def check_units(model, check):
    """Dimensions of all margins and bounds; `check(expression, wanted, what, location)`."""
    for limit in model.limits:
        check(limit.margin, None, f"limit `{limit.name}`", limit.location)
    for entry in model.validity:
        check(entry.margin, None, "validity", entry.location)
    for i, _, value in bounds(model):
        coordinate = model.coordinates[i]
        check(value, model.dimensions[coordinate.name], f"bound of `{coordinate.name}`", model.file)
