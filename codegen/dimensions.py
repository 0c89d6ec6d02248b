"""Dimensions of all that a model states: energies, bodies, forces, guards, conditions, resets, requirements."""

import casadi as ca

from . import graph, limits, outputs, units
from .errors import ModelError, report


def check(model):
    """Dimensions of the energies, term by term, and of guards, forces, resets."""
    table = model.dimensions
    where = {"kinetic energy": model.kinetic_terms, "potential energy": model.potentials,
             "dissipation": model.dissipations}
    energy = units.parse("kg m^2/s^2")
    for what, expressions in where.items():
        want = units.combine(energy, units.parse("1/s")) if what == "dissipation" else energy
        for k, expression in enumerate(expressions):
            for term in graph.additive_terms(expression):
                _check_unit(term, want, table, what, model.location(expressions, k))
    for k, body in enumerate(model.bodies):
        what, location = f"body {k + 1}", model.location(model.bodies, k)
        _check_unit(body.mass, units.parse("kg"), table, what + ": mass", location)
        for axis, position in zip("XY", body.position):
            for term in graph.additive_terms(position):
                _check_unit(term, units.parse("m"), table, f"{what}: position {axis}", location)
        if body.angle is not None:
            _check_unit(body.inertia, units.parse("kg m^2"), table, what + ": inertia", location)
            _check_unit(body.angle, units.NONE, table, what + ": angle", location)
    if model.bodies:
        _check_unit(ca.SX(model.gravity_constant), units.parse("m/s^2"), table, "gravity", model.file)
    forces = [
        (c, f, f"force on `{c.name()}`", model.location(model.external, k)) for k, (c, f) in enumerate(model.external)
    ]
    for mode in model.modes:
        forces += [
            (c, f, f"force on `{c.name()}` in mode `{mode.name}`", model.location(mode.forces, k))
            for k, (c, f, _) in enumerate(mode.forces)
        ]
    forces += [
        (next(c.symbol for c in model.coordinates + model.motions if c.name == name), f, f"equation of `{name}`", model.location(model.hand_written, name))
        for name, f in model.hand_written.items() if name not in model.unchecked
    ]
    for coordinate, force, what, location in forces:
        want = units.combine(energy, table[coordinate.name()], -1)
        for term in graph.additive_terms(force):
            _check_unit(term, want, table, what, location)
    for transition in model.transitions:
        _check_unit(transition.guard, None, table, f"guard of `{transition.name}`", transition.location)
        if transition.condition is not None:
            for condition in ca.vertsplit(transition.condition):
                _check_unit(condition, None, table, f"condition of `{transition.name}`", transition.location)
        for symbol, value in transition.reset:
            _check_unit(value, table.get(symbol.name()), table,
                        f"transition `{transition.name}`: reset of `{symbol.name()}`", transition.location)
    if model.modes and model.modes[0].form is not None:
        # In the reduced form it is a force of the mode.
        _check_friction(model, energy, table)
    for mode in model.modes:
        for requirement in mode.requirements:
            _check_unit(requirement.expression, None, table, "requirement", requirement.location)
    for of in (limits, outputs):
        of.check_units(model, lambda expression, want, what, location: _check_unit(expression, want, table, what, location))


def _check_friction(model, energy, table):
    """Friction, a coefficient times a normal force, is a force along the slip."""
    def dimension(expression, what, location):
        try:
            return units.dimension_of(ca.SX(expression), table)
        except units.UnitError as error:
            report(ModelError(f"{what}: {error}", location))
    for contact in model.contacts:
        if contact.slip is None or contact.kinetic.is_zero():
            continue
        what = f"friction of `{contact.name}`"
        slip = dimension(contact.slip_expression, what, contact.location)
        if contact.gap is None:
            normal = dimension(contact.normal, what, contact.location)
        else:
            gap = dimension(contact.gap_expression, what, contact.location)
            normal = None if gap is None else units.combine(energy, gap, -1)
        coefficient = dimension(contact.kinetic, what, contact.location)
        if None in (slip, normal, coefficient):
            continue
        place = units.combine(slip, units.parse("s")) if contact.slips_by_rate else slip
        found, want = units.combine(coefficient, normal), units.combine(energy, place, -1)
        if found != want:
            report(ModelError(f"{what}: a coefficient times the normal force has the dimension {units.text(found)}, but along the slip"
                              f" it is {units.text(want)}", contact.location))


def _check_unit(expression, want, table, what, location):
    try:
        found = units.dimension_of(ca.SX(expression), table)
    except units.UnitError as error:
        report(ModelError(f"{what}: {error}", location))
        return
    if want is not None and found != want and not ca.SX(expression).is_zero():
        report(ModelError(
            f"{what}: the term `{units.short(expression)}` has the dimension {units.text(found)},"
            f" expected {units.text(want)}", location))
