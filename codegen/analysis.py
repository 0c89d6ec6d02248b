"""What is known of a mode's functions without a call: what moves, what is constant, how a guard depends on the state."""

import casadi as ca

from . import functions, graph, signals

MOST_IN_LANES = 6
"""Most free coordinates of modes that go in lanes; `FREE` in codegen/lanes.c tells so many apart."""


def goes_in_lanes(variant, i):
    """Whether trajectories in a mode can go side by side: nothing that it holds moves, nothing is brought back to what contacts or
    constraints hold, each crossing of a guard is an event under any conditions, and few coordinates are free."""
    equations = variant.modes[i]
    guards = [any(t.condition is None for t in transitions) for _, transitions in equations.guards]
    stays = not equations.mode.drift and not equations.mode.lines and equations.mode.form is None
    return 0 < len(equations.free) <= MOST_IN_LANES and stays and all(guards) and not swinging(variant, i)


def swinging(variant, i):
    """What a step must not be longer than the series of, since it swings with time while the motion itself may not: guards that are general,
    and what else swings. Places among all series."""
    equations = variant.modes[i]
    guards = [g for g, value in enumerate(equations.guard_values) if _is_curved(variant, value) or _is_unseen(variant, i, value)]
    return guards + [len(equations.guard_values) + k for k in range(len(equations.beside_guards))]


def beside_guards(variant, i, mode):
    """What else is looked at within steps, and swings: coordinates that depend on prescribed motions, requirements and margins; of reactions
    and outputs those that are curved in prescribed motions, since an input alone tells in which windows values are looked at
    (hybrid::equations). Of a margin that is not smooth (a load of either sign), what it is made of."""
    model, equations = variant.model, variant.modes[i]
    each = lambda column: [column[k] for k in range(column.numel())]
    of_lines, coordinates = {line.name for line in equations.mode.lines}, equations.all_coordinates()
    dependent = [coordinates[k] for k, c in enumerate(model.coordinates) if c.name in of_lines]
    margins = graph.smooth_parts(each(mode.requirements), [p.symbol for p in model.parameters])
    swings = [value for value in [*dependent, *margins] if _is_curved(variant, value) or _is_unseen(variant, i, value)]
    outputs = [*each(mode.reactions), *each(variant.functions[i, "outputs"].expression)]
    return [*swings, *(o for o in outputs if _is_curved(variant, o))]


def _is_curved(variant, value):
    """Whether an expression is not linear in where and how fast prescribed motions are (a cam)."""
    inputs = [declared for declared in variant.model.inputs if declared.motion is not None]
    moved = ca.vertcat(ca.SX(0, 1), *[s for declared in inputs for s in declared.signals[1:]])
    return bool(moved.numel()) and ca.depends_on(ca.jacobian(value, moved), moved)


def _is_unseen(variant, i, value):
    """Whether an expression depends on an input that no equation of motion does (a flight over a table that shakes)."""
    equations = variant.modes[i]
    # Where nothing moves no step is longer than the inputs allow.
    if not equations.free:
        return False
    # With multipliers: what a contact asks of accelerations moves nothing while it is open.
    motion = variant.functions[i, "system"].output if equations.mode.form is None else equations.r[equations.own]
    columns = (ca.vertcat(*declared.signals) for declared in variant.model.inputs)
    return any(ca.depends_on(value, column) and not ca.depends_on(motion, column) for column in columns)


def facts(variant, i):
    """What is known of the functions of a mode, as they are emitted."""
    model, equations = variant.model, variant.modes[i]
    output = lambda what: variant.functions[i, what].output
    mass = output("system")[: len(equations.free) ** 2]
    inertia = ca.vertcat(ca.vec(mass), ca.vec(output("inertia")))
    return {
        "mass_is_constant": is_constant(model, equations, mass), "inertia_is_fixed": is_fixed(model, equations, inertia),
        "is_linear": is_constant(model, equations, output("jacobian")), "goes_in_lanes": goes_in_lanes(variant, i),
        "swinging": swinging(variant, i), "beside_guards": len(equations.beside_guards)}


def is_for_lanes(variant, slot, function):
    """Whether a function, by its slot, is emitted for lanes, too."""
    i, *_ = slot
    linear = function.row is functions.GUARDS_OF_MODE and not has_general_guards(variant, i)
    return (function.row.in_lanes and not linear or function.stays) and goes_in_lanes(variant, i)


def has_general_guards(variant, i):
    """Whether a mode has a guard that is more than a coordinate or a rate."""
    return any("general" in shape for shape in variant.modes[i].guard_shapes)


def shape(model, equations, expression):
    """The dependence of a guard or margin, as `GuardShape` in src/model/mod.rs."""
    placed = equations.place(expression)
    linear = linear_shape(model, equations, placed)
    if linear is not None:
        return {"linear": linear}
    depends = lambda *columns: bool(present(ca.symvar(placed), *columns))
    return {"general": {"accelerations": depends(equations.a), "signals": depends(signals.of(model))}}


def is_constant(model, equations, entries):
    """Whether expressions stay the same while the mode lasts."""
    return not present(ca.symvar(entries), equations.a, *_moving(model, equations))


def is_fixed(model, equations, entries):
    """Whether expressions follow from the parameters alone: also where the sign of a discrete state of +1 or -1
    cancels out of them."""
    of_sign = [d for d in model.discretes if sorted(d.values) == [-1, 1] and graph.is_even(entries, d.symbol)]
    others = ca.vertcat(*(d.symbol for d in model.discretes if d not in of_sign))
    return is_constant(model, equations, entries) and not present(ca.symvar(entries), equations.held, others)


def linear_shape(model, equations, expression):
    """`GuardShape::Linear` if the guard is a constant or discrete factor times one coordinate or rate,
    plus what does not move, else None."""
    moving = present(ca.symvar(expression), equations.a, *_moving(model, equations))
    if len(moving) != 1:
        return None
    [symbol] = moving
    slope = _factor(model, ca.simplify(ca.jacobian(expression, symbol)))
    if slope is None:
        return None
    factor, discrete = slope
    offset = not ca.simplify(ca.substitute(expression, symbol, 0)).is_zero()
    for rate, column in ((False, equations.q), (True, equations.v)):
        for index in range(column.numel()):
            if column[index].element_hash() == symbol.element_hash():
                return {"index": index, "rate": rate, "factor": factor, "discrete": discrete, "offset": offset}
    return None


def used_signals(variants, rows):
    """Of each signal, whether functions of these rows, of some mode, depend on it."""
    outputs = [f.output for v in variants for f in v.functions.values() if f.row in rows]
    found = {s.element_hash() for output in outputs for s in ca.symvar(output)}
    return [s.element_hash() in found for s in ca.vertsplit(signals.of(variants[0].model))]


def present(symbols, *columns):
    """Those of the symbols that some column contains."""
    wanted = {column[i].element_hash() for column in columns for i in range(column.numel())}
    return [s for s in symbols if s.element_hash() in wanted]


def _moving(model, equations):
    """Columns of the symbols that change while the mode lasts, accelerations left out."""
    drifting = [equations.held[i] for i, c in enumerate(model.coordinates) if c.name in equations.mode.drift]
    return equations.q, equations.v, signals.of(model), ca.vertcat(*drifting)


def _factor(model, expression):
    """(number, index of a discrete state or None) whose product an expression is, else None."""
    discretes = {d.symbol.element_hash(): k for k, d in enumerate(model.discretes)}
    factor, discrete = 1.0, None
    while not expression.is_constant():
        if expression.element_hash() in discretes:
            return (factor, discretes[expression.element_hash()]) if discrete is None else None
        op = expression.op()
        if op == ca.OP_NEG:
            factor, expression = -factor, expression.dep(0)
        elif op == ca.OP_MUL and expression.dep(0).is_constant():
            factor, expression = factor * float(expression.dep(0)), expression.dep(1)
        elif op == ca.OP_MUL and expression.dep(0).element_hash() in discretes and discrete is None:
            discrete, expression = discretes[expression.dep(0).element_hash()], expression.dep(1)
        else:
            return None
    return factor * float(expression), discrete
