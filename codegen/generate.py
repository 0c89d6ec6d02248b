"""One model folder → C, and a manifest."""

import functools
import hashlib
import itertools
import json
import os
from dataclasses import dataclass, field

import casadi as ca

from . import (analysis, check, combinations, derive, description, dimensions, emit_model, emit_series, functions, graph, limits,
               momentum, signals, tape)
from .align import align, align_bounds, own
from .context import build
from .emit_c import Source
from .errors import ModelError, error_location


@dataclass
class Function:
    """A function to be emitted: where its arguments live and what it computes."""

    name: str
    row: functions.Row
    expression: ca.SX
    """As it was derived."""
    equations: object
    symbol: str = ""
    operations: int = 0
    workspace: tuple = ()
    stays: bool = False
    """A reset that leads to the same mode and changes nothing that the mode holds: see `_stays`."""

    @functools.cached_property
    def output(self):
        """What is emitted: the expression, arranged for few operations. That takes longer than all the rest, and a judgement
        can do without."""
        return graph.arrange(self.expression, [p.symbol for p in self.equations.model.parameters])


@dataclass
class Variant:
    """The equations of a model for one combination of choices."""

    model: object
    modes: list
    functions: dict = field(default_factory=dict)
    tapes: dict = field(default_factory=dict)
    """What the program expands itself, by slot as the functions."""
    declared: str = ""
    """The C function of what follows from parameters alone: see `limits.of_parameters`."""
    lean: object = None
    """The same where no optional motion of the ground acts, if there is one."""


def load(folder, name=None, build=build):
    """The models (one a combination of choices) of a model folder, by the name of the folder if none is given."""
    name = name or os.path.basename(os.path.abspath(folder))
    file = os.path.abspath(os.path.join(folder, "model.py"))
    if not name.isidentifier() or not name.isascii() or "__" in name:
        raise ModelError(f"`{name}` cannot be the name of a model: it is part of the names of functions in C; take another one, of"
                         " letters, digits and single underscores", file)
    try:
        with open(file, encoding="utf-8") as stream:
            source = stream.read()
    except OSError as error:
        raise ModelError(f"the model folder has no readable model.py: {error.strerror}", file) from None
    try:
        models = build(name, file, source)
    except Exception as error:
        raise as_model_error(error, file) from error
    align_bounds(models)
    return models


def as_model_error(error, file):
    """What ended the run of a model file, as an error with its place."""
    if isinstance(error, ModelError):
        error.location = error.location or error_location(error, file)
        return error
    message = f"{type(error).__name__}: {error}"
    if isinstance(error, SyntaxError):
        message = f"{type(error).__name__}: {error.msg}"
    if "truth value" in message:
        message = ("an `if`, `and`, `or`, `not`, `min`, `max` or the like asks whether an expression is true, which is not known"
                   " before the run: write one mode or one guard for each case instead")
    return ModelError(message, error_location(error, file))


def generate(folder, for_tests=False, named=None, owner="", name=None):
    """All files of a model: a dict from file name to text. With `named`, options by choices, that of the fitting variant alone.

    What is linked has names that begin with `owner`, so that two crates of one program may have models of one name.
    """
    models = load(folder, name)
    name = models[0].name
    check_same_declarations(models)
    derived = models if named is None else [combinations.fitting(models, named)]
    align(derived)
    chosen = [variants_of(model) for model in derived]
    variants = [v for variant in chosen for v in (variant, variant.lean) if v]
    constants = _extract_constants(variants)
    source = Source()
    prefix = f"dalembert_{owner + '_' if owner else ''}{name}"
    # The symbols of the first variant that is derived, in which constants are written.
    parameters = ca.vertcat(*[p.symbol for p in derived[0].parameters])
    constants_symbol = source.add(f"{prefix}_constants", [("q", parameters)], constants.values)
    for variant in variants:
        for function in variant.functions.values():
            equations = function.equations
            if function.row.series:
                _emit_series(source, prefix, variant, function, constants)
                continue
            takes_radii, of = function.row.takes_radii, variant.model
            arguments = [
                ("q", equations.q), ("v", equations.v), ("a", equations.a),
                ("j", equations.radii if takes_radii else equations.j), ("u", signals.of(of)),
                ("u_dot", signals.radii(of) if takes_radii else signals.rates(of)),
                ("d", _discretes(of)), ("h", equations.held), ("c", constants.symbols),
            ]
            function.symbol = source.add(f"{prefix}_{function.name}", arguments, function.output)
            function.operations = source.operations[f"{prefix}_{function.name}"]
    for variant in chosen:
        own = ca.vertcat(*[p.symbol for p in variant.model.parameters])
        variant.declared = source.add(
            f"{prefix}_{_tag(variant.model)}declared", [("q", own)], limits.of_parameters(variant.model))
        if variant.lean is not None:
            variant.lean.declared = variant.declared
    c_texts = source.texts(name)
    sources = [f"{name}.c"] + [f"{name}_{k + 1}.c" for k in range(1, len(c_texts))]
    described, tables = description.describe(name, models, chosen, (constants_symbol, constants.values.numel()), for_tests)
    for_lanes = _lane_functions(variants)
    lanes_text = source.lanes_text(name, for_lanes, emit_model.lanes_text(prefix, tables, for_lanes))
    model_text = emit_model.model_text(name, prefix, described, tables, bool(lanes_text))
    manifest = {
        "name": name,
        "sources": sources,
        "tables": f"{name}_model.c",
        "lanes": [f"{name}_lanes.c"] if lanes_text else [],
        **combinations.table(models),
        "derived": [models.index(model) for model in derived],
        "casadi": ca.__version__,
        "content": hashlib.sha256(("".join(c_texts) + (lanes_text or "") + model_text).encode()).hexdigest(),
        "operations": {
            f"{'/'.join(c[3] for c in v.model.choices)}:{f.name}" if v.model.choices else f.name: f.operations
            for v in variants for f in v.functions.values()
        },
    }
    files = {
        **dict(zip(sources, c_texts)), f"{name}_model.c": model_text,
        "description.json": json.dumps(described, indent=1, ensure_ascii=False, allow_nan=False) + "\n",
        "manifest.json": json.dumps(manifest, indent=1) + "\n"}
    return files | ({f"{name}_lanes.c": lanes_text} if lanes_text else {})


def _lane_functions(variants):
    """Names of the C functions that the modes which go in lanes need there."""
    names = set()
    for variant in variants:
        for slot, function in variant.functions.items():
            if analysis.is_for_lanes(variant, slot, function):
                names.update([function.symbol] if isinstance(function.symbol, str) else function.symbol)
    return names


def _emit_series(source, prefix, variant, function, constants):
    """Emits Taylor series."""
    equations, model = function.equations, variant.model
    drifting = [i for i, c in enumerate(model.coordinates) if c.name in equations.mode.drift]
    count = function.output.numel() - len(drifting)
    arguments = dict(
        output=function.output[:count],
        moving=[("q", equations.q), ("v", equations.v), ("u", signals.of(model))],
        constant=[("d", _discretes(model)), ("c", constants.symbols)],
        held=equations.held,
        drift={i: function.output[count + n] for n, i in enumerate(drifting)})
    if function.row.series == "motion":
        series = emit_series.Equations(len(equations.free), **arguments)
    else:
        arguments["moving"].append(("a", equations.a))
        series = emit_series.Outputs(**arguments)
    function.symbol = series.add_to(source, f"{prefix}_{function.name}")
    function.workspace = (series.lead, series.row, len(series.graph.interiors), series.ends)
    function.operations = series.operations


def check_same_declarations(models):
    """All combinations of choices declare the same: a scene, its record and its plots know a name before a choice is made."""
    kinds = {
        "parameters": description.parameter,
        "coordinates": description.declared_coordinate,
        "motions": description.meant,
        "inputs": description.meant,
        "discretes": lambda d: {**description.meant(d), "values": d.values},
        "outputs": lambda o: {"unit": o.unit},
    }
    first = models[0]
    for (kind, described), model in itertools.product(kinds.items(), models[1:]):
        known, others = ({d.name: described(d) for d in own(of, kind)} for of in (first, model))
        if list(known) != list(others):
            raise ModelError(
                "declarations differ between choices: parameters, coordinates, inputs, discrete"
                " states, and names and units of outputs must be the same for all of them", first.file)
        for name in known:
            for what, value in known[name].items():
                if value != others[name][what]:
                    options = ", ".join(f"{c[0]} = {c[3]}" for c in model.choices)
                    raise ModelError(
                        f"`{name}`: its {what.replace('_', ' ')} differs between choices: {value!r}, but {others[name][what]!r}"
                        f" with {options}; declare what holds for all of them, or two names", model.locations.get(name, model.file))


def _discretes(model):
    return ca.vertcat(*[d.symbol for d in model.discretes])


def variants_of(model):
    """The variant of a model with all motions of the ground that may be given, and in it the one without the optional ones
    among them."""
    check.check(model)
    dimensions.check(model)
    momentum.check(model)
    variant = derive_variant(model)
    optional = [m for m in model.motions if m.optional and m.available]
    if optional:
        variant.lean = _variant(model, _barred(model) + optional)
    return variant


def derive_variant(model):
    """The variant of a model that was checked, with all motions of the ground that may be given."""
    moved = any(m.optional and m.available for m in model.motions)
    return _variant(model, _barred(model), "moved_" if moved else "")


def _barred(model):
    return [m for m in model.motions if not m.available]


def _variant(model, absent, kind=""):
    """Derives and checks the equations of every mode, and lists the functions to emit."""
    residual = derive.residual_from_bodies(model)
    held = ca.vertcat(*[ca.SX.sym(f"{c.name}.held") for c in model.coordinates + model.motions])
    modes = [(mode.form.equations if mode.form else derive.ModeEquations)(model, mode, residual, held, absent)
             for mode in model.modes]
    check.check_equations(model, modes)
    variant = Variant(model, modes)
    parameters = [p.symbol for p in model.parameters]
    names = [m.identifier for m in model.modes]
    index = {m.name: i for i, m in enumerate(model.modes)}
    for i, equations in enumerate(modes):
        prefix = f"{_tag(model)}{kind}{names[i]}_"
        if equations.free:
            name = equations.mode.name
            _check_smooth(equations.r, f"equations of mode `{name}`", equations.mode.location, parameters)
        equations.margins = limits.margins(equations)
        equations.margin_shapes = [
            None if analysis.is_constant(model, equations, margin) else analysis.shape(model, equations, margin)
            for margin in equations.margins]
        equations.guards = _guards(model, equations)
        equations.guard_shapes, equations.guard_values = [], []
        mode = functions.OfMode(variant, equations, _check_smooth)
        _add(variant, prefix, functions.MODE, mode, equations, (i,))
        for g, (expression, transitions) in enumerate(equations.guards):
            placed = equations.place(expression, transitions[0].location if transitions else None)
            if transitions:
                _check_smooth(placed, f"guard of `{transitions[0].name}`", transitions[0].location, parameters)
            guard = functions.OfGuard(mode, placed)
            _add(variant, prefix, functions.GUARD, guard, equations, (i,), g)
            shape = analysis.shape(model, equations, expression)
            equations.guard_shapes.append(shape)
            equations.guard_values.append(placed if "general" in shape else ca.SX(0))
            for t, transition in enumerate(transitions):
                target = modes[index[transition.target.name]]
                condition = None
                if transition.condition is not None:
                    condition = target.place(transition.condition, transition.location)
                    _check_smooth(condition, f"condition of `{transition.name}`", transition.location, parameters)
                of = functions.OfTransition(mode, _reset(model, equations, target, transition), condition, _impulses(model, equations, transition))
                _add(variant, prefix, functions.TRANSITION, of, equations, (i,), g, t)
                variant.functions[i, "reset", g, t].stays = target is equations and not _is_tied(model, transition) and _stays(model, equations, of.reset)
                if condition is not None:
                    variant.functions[i, "condition", g, t].equations = target
        _tapes(variant, i, index)
        equations.beside_guards = analysis.beside_guards(variant, i, mode)
        _add(variant, prefix, (functions.GUARDS_OF_MODE,), mode, equations, (i,))
    return variant


def _tag(model):
    """What names of functions begin with: the options of the variant, by their places."""
    tag = "_".join(str(c[1].index(c[3])) for c in model.choices)
    return f"v{tag}_" if tag else ""


def _add(variant, prefix, rows, of, equations, mode, *places):
    """Adds the functions of some rows: of a mode, or of a guard or a transition of it, by their `places`."""
    for row in rows:
        if row.exists(of):
            output = ca.densify(ca.vec(ca.SX(row.output(of))))
            variant.functions[*mode, row.name, *places] = Function(prefix + _name(row, *places), row, output, equations)


def _name(row, *places):
    """What a function is called in C, behind its mode."""
    match places:
        case ():
            return row.name
        case (g,):
            return row.name.replace("guard", f"guard{g}")
        case (g, t):
            return f"guard{g}_{row.name}{t}"


def _tapes(variant, i, index):
    """Adds the tapes of a mode: its system, its guards, and the conditions of its transitions in their targets."""
    model, equations = variant.model, variant.modes[i]
    places = lambda of: tape.places(model, of, signals.of(model))
    mass, load = equations.system()
    variant.tapes[i, "system"] = tape.of(ca.vertcat(ca.vec(mass), load), places(equations))
    guards = ca.vertcat(*[equations.place(expression) for expression, _ in equations.guards])
    variant.tapes[i, "guards"] = tape.of(guards, places(equations))
    for g, (_, transitions) in enumerate(equations.guards):
        for t, transition in enumerate(transitions):
            target = variant.modes[index[transition.target.name]]
            conditions = ca.SX(0, 1) if transition.condition is None else target.place(transition.condition)
            variant.tapes[i, "conditions", g, t] = tape.of(conditions, places(target))
    if equations.mode.form is not None:
        variant.tapes[i, "decisions"] = tape.of(equations.decisions(), places(equations))


def _check_smooth(expression, what, location, parameters):
    for row in ca.vertsplit(ca.densify(ca.vec(expression))):
        operation = graph.non_smooth_operation(row, parameters)
        if operation:
            raise ModelError(
                f"{what}: `{operation}` is not smooth; write one mode or one guard for each smooth"
                " piece instead", location)


def _guards(model, equations):
    """Transitions of a mode grouped by guard: a list of (expression, transitions). Those of contacts, which come first, have no
    transitions: what follows is decided where they fall."""
    of_contacts = [] if equations.mode.form is None else [(guard, []) for guard in equations.contact_guards()]
    groups = {}
    for transition in model.transitions:
        if transition.source is equations.mode:
            groups.setdefault(graph.structure(transition.guard), (transition.guard, []))[1].append(transition)
    return of_contacts + list(groups.values())


def _reset(model, source, target, transition):
    """Column of q⁺, v⁺, d⁺ in the symbols of the source mode."""
    values = {}
    for c in model.coordinates:
        values[c.name], values[c.name + ".rate"] = c.symbol, c.symbol.rate
    for d in model.discretes:
        values[d.name] = d.symbol
    values.update((symbol.name(), expression) for symbol, expression in transition.reset)
    transition.changes = [symbol.name() for symbol, _ in transition.reset]
    depending = {line.name for line in target.mode.lines}
    for c in model.coordinates:
        if c.name in target.mode.held and c.name not in depending:
            value = target.mode.held[c.name]
            if value is not None:
                values[c.name] = ca.SX(value)
            values[c.name + ".rate"] = target.mode.drift.get(c.name, ca.SX(0))
    order = [c.name for c in model.coordinates]
    order += [c.name + ".rate" for c in model.coordinates] + [d.name for d in model.discretes]
    after = ca.vertcat(*[values[key] for key in order])
    if depending:
        after = _with_dependent(model, target, after, depending)
    return source.place(after, transition.location)


def _impulses(model, source, transition):
    """All impulses of an impact in the symbols of the source mode; None where it has none."""
    if transition.impulses is None:
        return None
    return source.place(ca.vertcat(*[ca.SX(transition.impulses.get(impulse.name, 0)) for impulse in model.impulses]), transition.location)


def _with_dependent(model, target, after, depending):
    """A column of q⁺, v⁺, d⁺ with the coordinates that depend on others in the target as they follow from these."""
    count, names = len(model.coordinates), [c.name for c in model.coordinates]
    state = [c.symbol for c in model.coordinates] + [c.symbol.rate for c in model.coordinates]
    known = ca.vertcat(*state, target.held)
    values = ca.densify(ca.vertcat(after[:2 * count], after[:count], *[m.symbol for m in model.motions]))
    every = ca.vertcat(target.all_coordinates(), target.all_rates())
    chosen = [k for k in range(2 * count) if names[k % count] in depending]
    followed = ca.substitute(every[chosen], known, values)
    result = ca.SX(after)
    for k, value in zip(chosen, ca.vertsplit(followed)):
        result[k] = value
    return result


def _is_tied(model, transition):
    """Whether it is that of a friction which others may decide, too: it is taken outside of lanes."""
    return any(transition.name == f"{name} reverses" for name in model.tied)


def _stays(model, equations, reset):
    """Whether a reset that leads back to its mode changes nothing but free coordinates, their rates and
    discrete states, and depends on no signal: then it needs no more than what lanes have."""
    n = len(model.coordinates)
    held = [(i, c) for i, c in enumerate(model.coordinates) if i not in equations.free]
    before = [(k, equations.place(x)) for i, c in held for k, x in ((i, c.symbol), (n + i, c.symbol.rate))]
    return (all(_is_same(reset[k], x) for k, x in before)
            and not analysis.present(ca.symvar(reset), signals.of(model), signals.rates(model), equations.j))


def _is_same(one, other):
    """Whether two expressions are the same constant or the same symbol."""
    if one.is_constant() and other.is_constant():
        return float(one) == float(other)
    return one.is_symbolic() and other.is_symbolic() and one.element_hash() == other.element_hash()


@dataclass
class Constants:
    """Symbols of the constants, and their values as expressions in the parameters."""

    symbols: ca.SX
    values: ca.SX


def _extract_constants(variants):
    """Replaces sub-expressions of parameters alone, over all functions of all variants."""
    canonical = ca.vertcat(*[p.symbol for p in variants[0].model.parameters])
    columns, functions = [], []
    for variant in variants:
        own = ca.vertcat(*[p.symbol for p in variant.model.parameters])
        for function in variant.functions.values():
            column = function.output
            if own.numel():
                column = ca.substitute(column, own, canonical)
            columns.append(column)
            functions.append(function)
    joint = ca.vertcat(*columns)
    if not canonical.numel():
        return Constants(ca.SX(0, 1), ca.SX(0, 1))
    extracted, symbols, values = ca.extract_parametric(
        ca.cse(joint), canonical, {"extract_trivial": True})
    start = 0
    for function, column in zip(functions, columns):
        function.output = extracted[start: start + column.numel()]
        start += column.numel()
    return Constants(ca.vertcat(*symbols) if symbols else ca.SX(0, 1),
                     ca.vertcat(*values) if values else ca.SX(0, 1))
