"""Checks of a finished model: what its parts say of each other. `arguments.py` looks at each call by itself."""

import itertools
import math
import random

import casadi as ca

from . import graph, units
from .arguments import shown
from .errors import ModelError, each


def check(model):
    """Refuses a model whose parts contradict each other."""
    if not model.coordinates:
        raise ModelError("the model has no coordinate, so that nothing moves: add model.coordinate(name, unit, meaning)",
                         model.location_of_model)
    each(lambda check: check(model), (_check_symbols, _check_energies_know_no_accelerations, _check_masses))
    each(lambda transition: _check_guard(model, transition), model.transitions)
    each(lambda transition: _check_reset(model, transition), model.transitions)


def check_equations(model, modes):
    """Refuses modes whose equations do not determine the accelerations."""
    each(lambda equations: _check_inertia(model, equations), modes)


# ---- symbols ------------------------------------------------------------------------------------


def _expressions(model):
    """All expressions of a model: what they are for, and where they were written."""
    for group, what in ((model.kinetic_terms, "kinetic energy"), (model.potentials, "potential energy"),
                        (model.dissipations, "dissipation")):
        for k, expression in enumerate(group):
            yield expression, what, model.location(group, k)
    for k, body in enumerate(model.bodies):
        for part in (body.mass, *body.position, body.inertia, body.angle):
            if part is not None:
                yield part, f"body {k + 1}", model.location(model.bodies, k)
    for k, (coordinate, force) in enumerate(model.external):
        yield force, f"force on `{coordinate.name()}`", model.location(model.external, k)
    for name, residual in model.hand_written.items():
        yield residual, f"equation of `{name}`", model.location(model.hand_written, name)
    for mode in model.modes:
        for k, (coordinate, *parts) in enumerate(mode.forces):
            for part in parts:
                yield part, f"force on `{coordinate.name()}` in mode `{mode.name}`", model.location(mode.forces, k)
        for requirement in mode.requirements:
            yield requirement.expression, "requirement", requirement.location
    for t in model.transitions:
        yield t.guard, f"guard of `{t.name}`", t.location
        if t.condition is not None:
            yield t.condition, f"condition of `{t.name}`", t.location
        for _, value in t.reset:
            yield value, f"transition `{t.name}`: reset", t.location


def _watched(model):
    """The expressions that a run is watched for, as `_expressions`: reactions may be those of whatever mode there is."""
    for output in model.outputs:
        yield output.expression, f"output `{output.name}`", output.location
    for limit in model.limits:
        yield limit.margin, f"limit `{limit.name}`", limit.location
    for entry in model.validity:
        yield entry.margin, "validity", entry.location


def _check_symbols(model):
    """Symbols are those that the model declared: one made elsewhere may have the name of one of them."""
    own = {s.element_hash() for s in [*model.symbols.values(), *(entry[0] for entry in model.placeholders.values())]}
    of_any_mode = {entry[0].element_hash(): entry[2] for entry in model.placeholders.values() if entry[1] is None}
    for expression, what, location in _expressions(model):
        for symbol in ca.symvar(expression):
            if symbol.element_hash() in of_any_mode:
                raise ModelError(f"{what}: model.reaction({of_any_mode[symbol.element_hash()]}) is for outputs, limit states and"
                                 " validity; here write the reaction of a mode, such as"
                                 f" {model.modes[0].identifier}.reaction({of_any_mode[symbol.element_hash()]})", location)
    for expression, what, location in itertools.chain(_expressions(model), _watched(model)):
        for symbol in ca.symvar(expression):
            if symbol.element_hash() not in own:
                raise ModelError(f"{what}: symbol `{symbol.name()}` was not declared by this model: use what"
                                 " model.coordinate(…), model.parameter(…) and the like return", location)


def _check_energies_know_no_accelerations(model):
    accelerations = ca.vertcat(*[c.symbol.acceleration for c in model.coordinates + model.motions])
    for group, what in ((model.kinetic_terms, "kinetic energy"), (model.potentials, "potential energy"),
                        (model.dissipations, "dissipation")):
        for k, expression in enumerate(group):
            if ca.depends_on(expression, accelerations):
                raise ModelError(f"{what}: `{units.short(expression)}` depends on an acceleration; energies depend on coordinates"
                                 " and rates", model.location(group, k))


# ---- masses -------------------------------------------------------------------------------------


def _check_masses(model):
    """Masses and inertias of bodies are positive or zero for the defaults and for every parameter set."""
    symbols = [p.symbol for p in model.parameters]
    defaults = {p.name: p.default for p in model.parameters}
    sets = [("the default parameters", {})] + [(f"the parameter set `{name}`", values) for name, _, values in model.parameter_sets]
    for k, body in enumerate(model.bodies):
        for part, what in ((body.mass, "mass"), (body.inertia, "inertia")):
            if part is None or ca.depends_on(part, ca.vertcat(*_variables(model))):
                continue
            value = ca.Function("mass", symbols, [part])
            for name, values in sets:
                numbers = {**defaults, **values}
                number = float(value.call([ca.DM(numbers[p.name]) for p in model.parameters])[0])
                if not number >= 0:
                    raise ModelError(f"body {k + 1}: its {what} `{units.short(part)}` is {number:g} with {name}; a {what} is not"
                                     " negative", model.location(model.bodies, k))


def _variables(model):
    """All symbols but the parameters."""
    parameters = {p.symbol.element_hash() for p in model.parameters}
    return [s for s in model.symbols.values() if s.element_hash() not in parameters] or [ca.SX.sym("none")]


def _check_inertia(model, equations):
    """No motion of the free coordinates is without mass, whatever the parameters."""
    inertia = equations.inertia()
    names = [model.coordinates[i].name for i in equations.free]
    bare = [name for i, name in enumerate(names) if inertia[i, :].is_zero() and inertia[:, i].is_zero()]
    if bare:
        raise ModelError(
            f"mode `{equations.mode.name}`: no mass moves with coordinate `{bare[0]}`, so its acceleration is not determined: give"
            " it a body or a kinetic energy, or freeze it in this mode", equations.mode.location)
    if names and ca.sprank(inertia) < len(names) or names and _is_singular(inertia):
        raise ModelError(
            f"mode `{equations.mode.name}`: the mass matrix of its free coordinates ({', '.join(names)}) is singular: some of them"
            " move the same bodies in the same way, or a mass is missing; leave one out, or give it a mass", equations.mode.location)


def _is_singular(matrix):
    """Whether the determinant vanishes identically. One value that is not zero beyond rounding shows that it does not."""
    draw = random.Random(0)
    symbols = ca.symvar(matrix)
    value = ca.Function("matrix", symbols, [matrix])
    for _ in range(32):
        at = ca.densify(value.call([ca.DM(draw.uniform(0.5, 1.5)) for _ in symbols])[0])
        if not _is_rounding(_least_pivot([list(map(float, at[i, :].nz)) for i in range(at.shape[0])])):
            return False
    return True


def _is_rounding(pivot):
    """Whether the pivot of a matrix whose rows have the length 1 is the rounding of zero. What is not a number is not."""
    return pivot < 1e-9


def _least_pivot(rows):
    """The last pivot of Gaussian elimination with the largest entry of all that are left for a pivot, the rows being of
    the length 1: no product of them, which becomes small for many rows whatever they are."""
    lengths = [math.hypot(*row) for row in rows]
    rows = [[x / length for x in row] if length else row for row, length in zip(rows, lengths)]
    while True:
        largest = max((abs(x), i, j) for i, row in enumerate(rows) for j, x in enumerate(row))
        pivot, i, j = largest
        if len(rows) == 1 or _is_rounding(pivot) or pivot != pivot:
            return pivot
        own = rows.pop(i)
        rows = [[x - row[j] / own[j] * y for k, (x, y) in enumerate(zip(row, own)) if k != j] for row in rows]


# ---- transitions --------------------------------------------------------------------------------


def _check_guard(model, transition):
    """A guard depends on something that may change in its mode."""
    depending = {line.name for line in transition.source.lines}
    held = {name for name, value in transition.source.held.items() if value is not None and name not in depending}
    fixed = {p.symbol.element_hash() for p in model.parameters}
    for c in model.coordinates:
        if c.name in held:
            fixed.add(c.symbol.element_hash())
        if c.name in transition.source.held and c.name not in depending:
            fixed |= {c.symbol.rate.element_hash(), c.symbol.acceleration.element_hash()}
    if all(s.element_hash() in fixed for s in ca.symvar(transition.guard)):
        raise ModelError(f"guard of `{transition.name}`: `{units.short(transition.guard)}` never changes in mode"
                         f" `{transition.source.name}`, so it never falls through zero: a guard depends on what moves there, on"
                         " inputs or on reactions", transition.location)


def _check_reset(model, transition):
    names, rates = {}, {}
    for c in model.coordinates:
        names[c.symbol.element_hash()] = c.name
        names[c.symbol.rate.element_hash()] = c.name + ".rate"
        rates[c.name], rates[c.name + ".rate"] = (c, False), (c, True)
    discretes = {d.name: d for d in model.discretes}
    names.update({d.symbol.element_hash(): d.name for d in model.discretes})
    what, target, seen = f"transition `{transition.name}`", transition.target, set()
    for symbol, value in transition.reset:
        name = names.get(symbol.element_hash()) if isinstance(symbol, ca.SX) and symbol.is_scalar() else None
        if name is None:
            raise ModelError(f"{what}: a reset can set a coordinate, its rate or a discrete state, not {shown(symbol)}: give what"
                             " model.coordinate(…) or model.discrete(…) returned, or its `.rate`", transition.location)
        if name in seen:
            raise ModelError(f"{what}: the reset sets `{name}` twice", transition.location)
        seen.add(name)
        if name in rates:
            coordinate, is_rate = rates[name]
            holds = target.drift.get(coordinate.name, ca.SX(0)) if is_rate else target.held.get(coordinate.name)
            depends = any(line.name == coordinate.name for line in target.lines)
            if coordinate.name in target.held and not depends and holds is not None and graph.structure(value) != graph.structure(holds):
                raise ModelError(
                    f"{what}: the reset sets `{name}` to `{units.short(value)}`, but mode `{target.name}` holds it at"
                    f" `{units.short(holds)}`: what a mode holds is set as it is entered; leave it out", transition.location)
        else:
            _check_discrete(discretes[name], value, model, what, transition.location)


def _check_discrete(discrete, value, model, what, location):
    """A discrete state is set to one of its values: judged by all values of what the new one is calculated from."""
    others = {d.symbol.element_hash(): d.values for d in model.discretes}
    symbols = ca.symvar(value)
    function = ca.Function("values", symbols, [value])
    choices, inputs, work = [], [], {}
    # What is compared is true or false, and from there on known.
    for k in range(function.n_instructions()):
        op, into, source = function.instruction_id(k), function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            result = work[source[0]]
            continue
        if op == ca.OP_CONST:
            work[into[0]] = ca.SX(function.instruction_constant(k))
        elif op == ca.OP_INPUT or op in (ca.OP_LT, ca.OP_LE, ca.OP_EQ, ca.OP_NE):
            symbol = symbols[source[0]] if op == ca.OP_INPUT else None
            work[into[0]] = ca.SX.sym("choice")
            inputs.append(work[into[0]])
            choices.append((0.0, 1.0) if symbol is None else others.get(symbol.element_hash()))
        else:
            given = [work[i] for i in source]
            work[into[0]] = ca.SX.binary(op, *given) if len(given) == 2 else ca.SX.unary(op, *given)
    used = {s.element_hash() for s in ca.symvar(result)}
    kept = [(i, c) for i, c in zip(inputs, choices) if i.element_hash() in used]
    allowed = ", ".join(f"{v:g}" for v in discrete.values)
    if any(c is None for _, c in kept):
        raise ModelError(f"{what}: `{discrete.name}` is one of {allowed}, but is set to `{units.short(value)}`, which may be anything:"
                         " calculate it from discrete states, numbers and comparisons", location)
    at = ca.Function("value", [i for i, _ in kept], [result])
    for values in itertools.islice(itertools.product(*[c for _, c in kept]), 4096):
        number = float(at.call([ca.DM(v) for v in values])[0])
        if number not in discrete.values:
            raise ModelError(f"{what}: `{discrete.name}` is one of {allowed}, but `{units.short(value)}` may set it to {number:g}",
                             location)
