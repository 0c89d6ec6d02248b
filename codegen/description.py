"""What a model is besides its functions: names, units, meanings, modes, guards, and where each function is found in the
tables of the contract (contract.h).

The result is data alone, written as JSON into the compiled model; src/model/description/ reads it and checks it. Keys are
the names of the fields there.
"""

import casadi as ca

from . import analysis, contact_outputs, drawing, functions, limits, signals, units
from .emit_c import KEPT_ANGLES

class Tables:
    """The tables of functions: places by symbol."""

    def __init__(self):
        self.values, self.series = {}, {}

    def value(self, symbol):
        """The place of a function by its C name."""
        return self.values.setdefault(symbol, len(self.values))

    def pair(self, symbols):
        """The place of the two functions of a series."""
        return self.series.setdefault(symbols, len(self.series))


def describe(name, models, chosen, constants, for_tests):
    """(description, tables) of a model: its combinations of choices, the variants of those that were derived, the C function of the
    constants and their number."""
    model, tables = chosen[0].model, Tables()
    variants = [v for variant in chosen for v in (variant, variant.lean) if v]
    requirements = functions.ROWS["requirements"]
    required = analysis.used_signals(variants, [requirements])
    description = {
        "name": name, "title": model.title, "source": model.source, "for_tests": for_tests,
        "dimensions": {
            "coordinates": len(model.coordinates), "motions": _signals_of_motions(model), "signals": signals.of(model).numel(),
            "discretes": len(model.discretes), "parameters": len(model.parameters), "constants": constants[1],
            "angles": KEPT_ANGLES,
            "expanded": analysis.used_signals(variants, [row for row in functions.ROWS.values() if row.series or row is requirements]),
            "required": [i for i, used in enumerate(required) if used],
        },
        "coordinates": [_coordinate(model, c) for c in model.coordinates],
        "motions": [{"name": m.name, "unit": m.unit, "reaction_unit": _reaction_unit(m.unit), "meaning": m.meaning,
                     "is_ground": m.axis is not None, "input": next(k for k, i in enumerate(model.inputs) if i.motion == m.name)}
                    for m in model.motions],
        "parameters": [parameter(p) for p in model.parameters],
        "parameter_sets": [
            {"name": set_name, "meaning": meaning, "values": [[k, _number(v)] for k, v in values.items()]}
            for set_name, meaning, values in model.parameter_sets],
        "inputs": list(_inputs(model)),
        "discretes": [{"name": d.name, "values": [_number(v) for v in d.values], "meaning": d.meaning,
                       "given": _is_given(variants, d.name)}
                      for d in model.discretes],
        "choices": [{"name": c[0], "options": list(c[1]), "meaning": c[2]} for c in model.choices],
        "combinations": [[c[3] for c in m.choices] for m in models],
        "constants": {"function": tables.value(constants[0]), "count": constants[1]},
        "variants": [_variant(variant, tables) for variant in chosen],
    }
    return description, tables


def _number(value):
    """A number as JSON can hold it."""
    value = float(value)
    if value != value or abs(value) == float("inf"):
        return repr(value)
    return value


def _reaction_unit(unit):
    """Unit of the generalized force of a coordinate: N for lengths, N m for angles."""
    return units.named(units.combine(units.parse("N m"), units.parse(unit), -1), ("N", "N m"))


def meant(d):
    """What every declaration has beside its name."""
    return {"unit": d.unit, "meaning": d.meaning}


def declared_coordinate(c):
    """What a model file says of a coordinate."""
    return {**meant(c), "scale": _number(c.scale), "rate_scale": _number(c.rate_scale),
            "minimum": _fixed_bound(c.minimum), "maximum": _fixed_bound(c.maximum)}


def _coordinate(model, c):
    reaction_unit = c.extra.get("multiplier") or _reaction_unit(c.unit)
    return {"name": c.name, **declared_coordinate(c), "reaction_unit": reaction_unit,
            "multiplier": "multiplier" in c.extra}


def _fixed_bound(bound):
    """A bound that does not depend on parameters."""
    return None if bound is None or isinstance(bound, ca.SX) else _number(bound)


def parameter(p):
    """What a model file says of a parameter."""
    return {"name": p.name, "unit": p.unit, "meaning": p.meaning, "default": _number(p.default),
            "minimum": _number(p.minimum), "minimum_exclusive": bool(p.exclusive), "maximum": _number(p.maximum),
            "at_most": p.at_most}


def _inputs(model):
    signal = 0
    for i in model.inputs:
        kind = "value" if i.motion is None else "acceleration"
        yield {"name": i.name, "unit": i.unit, "meaning": i.meaning, "kind": kind, "signal": signal}
        signal += len(i.signals)


def _signals_of_motions(model):
    """Of each prescribed motion, the signal that is its place."""
    places = {symbol.element_hash(): k for k, symbol in enumerate(ca.vertsplit(signals.of(model)))}
    return [places[m.symbol.element_hash()] for m in model.motions]


def _held_at(mode, name):
    """Where a coordinate is held; None: wherever it was, or on a line that is held wherever it was."""
    value = mode.held.get(name)
    if value is None:
        return None
    line = next((line for line in mode.lines if line.name == name), None)
    value = ca.SX(value) if line is None else ca.simplify(ca.SX(value) - line.rest)
    return {"number": _number(value)} if value.is_constant() else {"expression": units.short(value)}


def _is_given(variants, name):
    """Whether a scene may give a discrete state: not one of contacts whose states say all."""
    declared = ((variant, d) for variant in variants for d in variant.model.discretes if d.name == name)
    return any("of_contacts" not in d.extra or "idle" not in d.extra and variant.model.modes[0].form is None for variant, d in declared)


def _is_seen(variant, discrete):
    """Whether people see a discrete state: one that says more than other states do, and that something depends on."""
    if "internal" in discrete.extra or "idle" in discrete.extra:
        return False
    if "of_contacts" in discrete.extra:
        return True
    own = [f.expression for f in variant.functions.values() if f.row.name != "reset"]
    set_by_hand = any(symbol is discrete.symbol for t in variant.model.transitions for symbol, _ in t.reset)
    return set_by_hand or any(ca.depends_on(expression, discrete.symbol) for expression in own)


def _place(model, symbol):
    """The index of a coordinate; None where there is none."""
    return None if symbol is None else next(i for i, c in enumerate(model.coordinates) if c.symbol is symbol)


def _variant(variant, tables, seen=None):
    model, lean = variant.model, variant.lean
    if seen is None:
        seen = [i for i, d in enumerate(model.discretes) if _is_seen(variant, d)]
    barred = [k for k, i in enumerate(model.inputs) for m in model.motions if m.name == i.motion and not m.available]
    index = {m.name: k for k, m in enumerate(model.modes)}
    validity = [(limits.is_of_parameters(model, entry.margin), {"condition": entry.text, "sentence": entry.sentence})
                for entry in model.validity]
    return {
        "options": [c[3] for c in model.choices],
        "defaults": [c[3] == c[4] for c in model.choices],
        "drawing": drawing.program(model),
        "barred": barred,
        "modes": [_mode(variant, i, equations, tables) for i, equations in enumerate(variant.modes)],
        "rests": [{"source": index[s.name], "target": index[t.name]} for s, t in model.rests],
        "contacts": contact_outputs.described(model),
        "limits": [{"name": limit.name, "message": limit.message, "text": limit.text, "ends": bool(limit.ends)}
                   for limit in model.limits],
        "discretes": seen,
        "outputs": [{"name": o.name, "unit": o.unit, "meaning": o.meaning, "text": o.text or units.short(o.expression, 200)}
                    for o in model.outputs],
        "impulses": [{"name": i.name, "unit": i.unit, "meaning": i.meaning, "multiplier": _place(model, i.multiplier)}
                     for i in model.impulses],
        "valid_motion": [entry for of_parameters, entry in validity if not of_parameters],
        "valid_parameters": [entry for of_parameters, entry in validity if of_parameters],
        "bounds": [{"coordinate": i, "upper": bool(upper), "text": units.short(bound)}
                   for i, upper, bound in limits.bounds(model)],
        "declared": {"function": tables.value(variant.declared), "count": limits.of_parameters(model).numel()},
        "lean": None if lean is None else {
            "without": [k for k, i in enumerate(model.inputs) if i.motion in [m.name for m in lean.modes[0].absent]],
            "variant": _variant(lean, tables, seen)},
    }


def _mode(variant, i, equations, tables):
    model, mode = variant.model, equations.mode
    derived = {slot[1:]: f for slot, f in variant.functions.items() if slot[0] == i}
    kernel = {row.name: _found(row, derived.get((row.name,)), tables) for row in functions.OF_EACH_MODE}
    kernel |= analysis.facts(variant, i)
    return {
        "name": mode.name, "meaning": mode.meaning, "free": list(equations.free),
        "held_at": [_held_at(mode, c.name) for c in model.coordinates],
        "drifts": [c.name in mode.drift for c in model.coordinates],
        "depends": [any(line.name == c.name for line in mode.lines) for c in model.coordinates],
        "guards": [_guard(variant, i, g, derived, tables) for g in range(len(equations.guards))],
        "frictions": _frictions(variant, i),
        "requirements": [
            {"text": units.short(r.expression, 200), "failure": r.failure, "unit": _unit(model, r.expression),
             "may_vanish": r.may_vanish} for r in mode.requirements],
        "margins": equations.margin_shapes,
        "system": variant.tapes[i, "system"], "guard_values": variant.tapes[i, "guards"],
        "contacts": None if mode.form is None else {
            **equations.describe(model), "decisions": variant.tapes[i, "decisions"]},
        "kernel": kernel,
        "operations": [[what[0] if len(what) == 1 else " ".join(map(str, what)), f.operations]
                       for what, f in derived.items()],
    }


def _frictions(variant, i):
    """What the frictions that may change at one instant do next in a mode, each by two transitions: where it sticks it slips forwards or
    backwards, where it slides it sticks or reverses. A transition is the places of its guard and of itself in this; None where it is not."""
    found = {}
    for g, (_, transitions) in enumerate(variant.modes[i].guards):
        for t, transition in enumerate(transitions):
            found.setdefault(transition.name, []).append([g, t])
    frictions = []
    for name in variant.model.tied:
        slips, stops = found.get(f"{name} slips"), [found.get(f"{name} {verb}", [None])[0] for verb in ("sticks", "reverses")]
        if slips or any(stops):
            frictions.append({"name": name, "sticks": bool(slips), "changes": slips or stops})
    return frictions if len(frictions) > 1 else []


def _guard(variant, i, g, derived, tables):
    model, equations = variant.model, variant.modes[i]
    expression, transitions = equations.guards[g]
    is_contact = equations.mode.form is not None and g < 3 * len(equations.form.contacts)
    return {
        "name": " / ".join(dict.fromkeys(t.name for t in transitions)) if not is_contact
        else equations.form.contacts[g // 3].name,
        "text": units.short(expression, 200), "unit": "1" if is_contact else _unit(model, expression), "shape": equations.guard_shapes[g],
        "of_forces": is_contact or units.dimension_of(ca.SX(expression), model.dimensions)[units.BASE.index("s")] == -2,
        "direction": next((d for d, declared in enumerate(model.discretes) for t in transitions if declared.symbol is t.direction), None),
        **{row.name: _found(row, derived[row.name, g], tables) for row in functions.GUARD},
        "transitions": [_transition(variant, i, g, t, derived, tables) for t in range(len(transitions))],
    }


def _transition(variant, i, g, t, derived, tables):
    transition = variant.modes[i].guards[g][1][t]
    return {
        "name": transition.name,
        "target": [m.name for m in variant.model.modes].index(transition.target.name),
        "changes": list(transition.changes), "impact": bool(transition.impact), "is_chart": bool(transition.is_chart),
        "stays": bool(derived["reset", g, t].stays),
        **{row.name: _found(row, derived.get((row.name, g, t)), tables) for row in functions.TRANSITION},
        "conditions": variant.tapes[i, "conditions", g, t],
    }


def _found(row, function, tables):
    """Where a function is found in the tables; None where there is none."""
    if function is None or not function.symbol:
        return None
    if row.series:
        return _series(function, tables)
    place = tables.value(function.symbol)
    return {"function": place, "count": function.output.numel()} if row.is_counted else place


def _series(function, tables):
    """A Taylor series."""
    lead, row, convolutions, ends = function.workspace
    return {"functions": tables.pair(function.symbol), "lead": lead, "row": row, "convolutions": convolutions,
            "ends": bool(ends)}


def _unit(model, expression):
    return units.text(units.dimension_of(ca.SX(expression), model.dimensions))
