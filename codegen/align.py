"""Contacts and constraints that only some choices have: coordinates and discrete states are those of all choices.

A multiplier that a combination of choices does not use is idle: its acceleration is zero, or a mode of the reduced form holds it.
Outputs and bounds of coordinates are those of the contacts that are there.
"""

import casadi as ca

from .declarations import Declaration


KINDS = {
    "coordinates": lambda c: "multiplier" in c.extra,
    "discretes": lambda d: "of_contacts" in d.extra,
    "outputs": lambda o: o.of is not None,
}
"""What contacts and constraints add to a model: whether an entry of a list is theirs."""


def own(model, kind):
    """The entries of a list that the model file has declared."""
    return [entry for entry in getattr(model, kind) if not (kind in KINDS and KINDS[kind](entry))]


def align_bounds(models):
    """Where a gap bounds a coordinate under some choices alone, the bound is theirs, as if it depended on parameters."""
    for of in zip(*[own(model, "coordinates") for model in models]):
        for side in ("minimum", "maximum"):
            derived = [c for c in of if side in c.extra.get("bounded_by_gaps", ())]
            if derived and len({None if isinstance(b, ca.SX) else b for b in (c.extra[side] for c in of)}) > 1:
                for c in derived:
                    c.extra[side] = ca.SX(c.extra[side])


def align(models):
    """Gives all combinations of choices of a model the multipliers and discrete states of each."""
    if len(models) < 2:
        return
    for kind, make in (("coordinates", _idle_multiplier), ("discretes", _idle_discrete)):
        is_of_contacts, union = KINDS[kind], {}
        for model in models:
            for entry in getattr(model, kind):
                if is_of_contacts(entry):
                    union.setdefault(entry.name, entry)
        # Those that choose rows come last: people see a first part of all.
        ordered = sorted(union.values(), key=lambda entry: "internal" in getattr(entry, "extra", {}))
        for model in models:
            known = {entry.name: entry for entry in getattr(model, kind)}
            setattr(model, kind, own(model, kind) + [known.get(entry.name) or make(model, entry) for entry in ordered])
    values = {}
    for model in models:
        for d in model.discretes:
            if len(d.extra["values"]) > len(values.get(d.name, [])):
                values[d.name] = d.extra["values"]
    for model in models:
        for d in model.discretes:
            d.extra["values"] = values[d.name]


def _idle_multiplier(model, of):
    symbol = model._declare_motion("coordinate", of.name, of.unit)
    symbol.jerk = ca.SX.sym(of.name + ".jerk")
    for mode in model.modes:
        if mode.form is None:
            mode.held[of.name] = ca.SX(0)
        elif not any(known is symbol for known in mode.form.idle):
            mode.form.idle.append(symbol)
    return Declaration(of.name, of.unit, of.meaning, symbol, dict(of.extra))


def _idle_discrete(model, of):
    symbol = model.discrete(of.name, of.extra["values"], of.meaning)
    declaration = model.discretes.pop()
    declaration.extra.update(of.extra, idle=True)
    assert declaration.symbol is symbol
    return declaration
