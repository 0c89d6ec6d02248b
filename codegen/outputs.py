"""Outputs: quantities of the motion that people look at, which nothing of the motion depends on."""

from dataclasses import dataclass

import casadi as ca

from . import graph, units
from .errors import ModelError


@dataclass
class Output:
    """A named expression with its unit and meaning."""

    name: str
    unit: str
    meaning: str
    expression: ca.SX
    location: str
    text: str = ""
    """What it is, where its expression does not say it."""
    of: object = None
    """Its value from the equations of a mode, of an output that contacts add; None: its expression, placed there."""


def values(equations, check_smooth):
    """All outputs of a model in the symbols of a mode; `check_smooth(expression, what, location, parameters)`."""
    model, placed = equations.model, []
    parameters = [p.symbol for p in model.parameters]
    for output in model.outputs:
        try:
            value = output.of(equations) if output.of else equations.place(output.expression, output.location)
        except ModelError as error:
            raise ModelError(f"output `{output.name}`: {error}; model.reaction(…) is that of whatever mode there is",
                             output.location) from None
        check_smooth(value, f"output `{output.name}`", output.location, parameters)
        placed.append(value)
    return ca.SX(ca.vertcat(*placed))


def check_units(model, check):
    """Dimensions of all outputs, term by term; `check(expression, wanted, what, location)`."""
    for output in model.outputs:
        if output.of is not None:
            continue
        for term in graph.additive_terms(output.expression):
            check(term, units.parse(output.unit), f"output `{output.name}`", output.location)
