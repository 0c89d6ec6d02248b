"""What people see of contacts and constraints: gaps, slip rates and forces as outputs of the model, and their laws as text.

Of a contact `left` the outputs are `left.gap`, `left.slip` (the slip rate), `left.normal` (λ_N ≥ 0, pushes the gap open) and
`left.friction` (λ_T, along the slip); of a ratchet `pawl` they are `pawl.rate` and `pawl.force` (≥ 0, along the rate); of one equation
of a constraint `pin` its force, `pin.force` (along what it holds at zero).
They are the same for both forms of equations. Impulses are `left.normal_impulse`, `left.friction_impulse`, `pin.impulse`: in the record of
an impact what they are there, and with multipliers outputs, too, the forces integrated over time since the start.
"""

import casadi as ca

from . import derive, units
from .declarations import Impulse
from .outputs import Output


def add(model):
    """Adds the outputs of all contacts and constraints of a model."""
    for contact in model.contacts:
        for entry in _of_contact(model, contact):
            model.outputs.append(entry)
    for constraint in model.constraints:
        force = lambda equations, of=constraint: _of_constraint(equations, of)
        model.outputs.append(Output(
            f"{constraint.name}.force", _force_unit(model, constraint.expression, constraint.is_rate),
            "force of the constraint, positive where it pushes the expression to grow", ca.SX(0), constraint.location, "λ", force))
    model.impulses = list(_impulses(model))
    for impulse in model.impulses:
        if impulse.multiplier is not None:
            since = lambda equations, of=impulse: of.multiplier.rate
            model.outputs.append(Output(
                impulse.name, impulse.unit, impulse.meaning + " since the start", ca.SX(0), impulse.location, "∫ λ dt", since))


def _impulses(model):
    """The impulses that an impact may have, those of multipliers in the order of these. The names are the same in both forms."""
    if model.modes[0].form is not None:
        yield from (c.extra["impulse"] for c in model.coordinates if "impulse" in c.extra)
        return
    def along(name, expression, is_rate, meaning, location):
        unit = units.of_impulse(units.force(units.dimension_of(expression, model.dimensions), is_rate))
        return Impulse(name, unit, meaning, location, expression, is_rate)

    for contact in model.contacts:
        if contact.gap is not None:
            yield along(contact.impulse_name, contact.gap_expression, contact.is_ratchet, "impulse of the normal force", contact.location)
        if contact.slip is not None:
            yield along(contact.friction_impulse_name, contact.slip_expression, contact.slips_by_rate, "impulse of the friction force",
                        contact.location)
    for constraint in model.constraints:
        yield along(constraint.impulse_name, constraint.expression, constraint.is_rate, "impulse of the force", constraint.location)


def _of_contact(model, contact):
    name = contact.name
    if contact.gap is not None:
        value, meaning = ("rate", "0 where it is engaged") if contact.is_ratchet else ("gap", "0 where it is closed")
        unit = units.text(units.dimension_of(contact.gap_expression, model.dimensions))
        yield Output(f"{name}.{value}", unit, meaning, contact.gap_expression, contact.location, "",
                     lambda equations: equations.freeze(contact.gap_expression))
    if contact.slip is not None:
        rate = contact.slip_rate_of(derive.configuration(model))
        unit = units.text(units.dimension_of(rate, model.dimensions))
        yield Output(f"{name}.slip", unit, "slip rate", rate, contact.location, "",
                     lambda equations: equations.freeze(rate))
    if contact.gap is not None:
        meaning = "force along its rate, not negative" if contact.is_ratchet else "normal force, pushes the gap open"
        yield Output(contact.force_name, _force_unit(model, contact.gap_expression, contact.is_ratchet), meaning,
                     ca.SX(0), contact.location, "λ_N", lambda equations: _normal(equations, contact))
    if contact.slip is not None and not _shares_its_slip(model, contact):
        yield Output(f"{name}.friction", _force_unit(model, contact.slip_expression, contact.slips_by_rate), "friction force, along the slip", ca.SX(0), contact.location,
                     "λ_T", lambda equations: _friction(equations, contact))


def _shares_its_slip(model, contact):
    """Whether it slips along the gap of another contact in the reduced form, so that only a sum of forces is determined."""
    return contact.slip is not None and model.modes[0].form is None and any(
        other.gap is not None and other.gap.name == contact.slip.name for other in model.contacts)


def _of_constraint(equations, constraint):
    if equations.mode.form is not None:
        return constraint.multiplier.acceleration
    return equations.place(constraint.force_of_line(equations.mode))


def _normal(equations, contact):
    mode, form = equations.mode, equations.mode.form
    if form is not None:
        return contact.held[0].multiplier.acceleration if contact.held else equations.terms[form.contacts.index(contact)].normal
    return ca.SX(0) if _state(mode, contact) == "open" else equations.place(contact.normal_force(mode))


def _friction(equations, contact):
    mode, form = equations.mode, equations.mode.form
    if form is not None and contact.permanent:
        slips = [constraint.multiplier.acceleration for constraint in contact.held if constraint.is_rate]
        return slips[0] if slips else ca.SX(0)
    if form is not None:
        return equations.terms[form.contacts.index(contact)].tangent
    state = _state(mode, contact)
    if state == "open":
        return ca.SX(0)
    if state == "sticks":
        return equations.place(contact.slip.along(mode.reaction(contact.slip.solved)))
    return equations.place(-contact.kinetic * contact.direction * contact.normal_force(mode))


def _state(mode, contact):
    """What a contact does in a mode of the reduced form."""
    return mode.contact_states[contact.name]


def _force_unit(model, expression, is_rate):
    """Unit of the force along an expression, or along what it is the rate of."""
    return units.of_force(units.force(units.dimension_of(expression, model.dimensions), is_rate))


# ---- what is declared, as text --------------------------------------------------------------------


def described(model):
    """Contacts, friction elements and constraints of a model as data, for people."""
    text = lambda expression: None if expression is None else units.short(ca.SX(expression), 200)
    found = []
    for contact in model.contacts:
        found.append({
            "name": contact.name, "kind": "ratchet" if contact.is_ratchet else "friction" if contact.gap is None else "contact",
            "gap": text(contact.gap_expression) if contact.sides is None else f"{text(contact.gap_expression)} to either side, {contact.sides.name()}",
            "slip": text(contact.slip_expression), "normal": text(contact.normal) if contact.gap is None else None,
            "static": text(contact.static), "kinetic": text(contact.kinetic),
            "restitution": _restitution(contact, text), "states": contact.states()})
    for constraint in model.constraints:
        found.append({
            "name": constraint.name, "kind": "constraint", "gap": text(constraint.expression), "slip": None, "normal": None,
            "static": None, "kinetic": None, "restitution": None, "states": ["holds"]})
    nothing = dict.fromkeys(("gap", "slip", "normal", "static", "kinetic", "restitution"))
    for name, kind in model.switched_off:
        found.append({"name": name, "kind": kind, **nothing, "states": ["switched off"]})
    return found


def _restitution(contact, text):
    """What an impact of a contact turns back, as text; None of what has no impacts."""
    if contact.gap is None or contact.is_ratchet:
        return None
    if contact.law:
        return "a law of the model"
    along = contact.tangential_restitution
    return text(contact.restitution) if along is None or ca.SX(along).is_zero() else f"{text(contact.restitution)}, {text(along)} along the slip"
