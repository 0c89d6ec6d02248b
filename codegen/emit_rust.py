"""Emission of the Rust tables of a model: names, units, dimensions and function pointers.

The fragment is placed inside a module of `src/kernel/mod.rs`, see there for the types.
"""

import json

import casadi as ca

from . import drawing, graph, units
from .emit_c import KEPT_ANGLES

MOST_FREE = 6
"""Most free coordinates a mode may have; `ModeKernels` in src/kernel/mod.rs has one case for each."""

_MODE_FUNCTIONS = ("residual", "jacobian", "system", "inertia", "jerk_load", "magnitude", "reactions",
                   "energies", "powers", "momenta")

SERIES = ("series", "quiet_series", "guard_series")
"""What is emitted as a Taylor series."""


LANES = ("series", "quiet_series", "requirement_bounds", "guard")
"""What is emitted for lanes, too, of the modes that `goes_in_lanes` names; and resets that stay in the mode."""

LEVELS = (("v1", ""), ("v3", '#[cfg(target_arch = "x86_64")] '), ("v4", '#[cfg(target_arch = "x86_64")] '))
"""Levels of the processor for which lanes are compiled, as in build/compile.rs."""


def goes_in_lanes(variant, i):
    """Whether trajectories in a mode can go side by side: it is analytic, nothing drifts, and its guards
    are coordinates or rates that fall without further conditions."""
    equations = variant.modes[i]
    analytic = all(variant.functions[i, what].symbol for what in ("series", "quiet_series"))
    guards = [
        linear_shape(variant.model, equations, equations.place(expression)) is not None
        and all(t.condition is None for t in transitions)
        for expression, transitions in equations.guards]
    return bool(equations.free) and analytic and not equations.mode.drift and all(guards)


def is_for_lanes(variant, slot, function):
    """Whether a function, by its slot, is emitted for lanes, too."""
    return (slot[1] in LANES or function.stays) and goes_in_lanes(variant, slot[0])


def model_text(name, variants, constants_symbol, constants_count, for_tests):
    """The Rust fragment of a model."""
    model = variants[0].model
    signals = len(_signals(model))
    functions = [(slot, f) for v in variants for slot, f in v.functions.items()]
    externs = sorted({f.symbol for slot, f in functions if slot[1] not in SERIES} | {constants_symbol})
    series = [f.symbol for slot, f in functions if slot[1] in SERIES and f.symbol]
    lines = ["use crate::model::*;", "#[allow(unused_imports)]", "use crate::jets::{Instruction as I, Name, Pick, Tape};",
             "", 'unsafe extern "C" {']
    lines += [
        f"    fn {e}(q: *const f64, v: *const f64, a: *const f64, x: *const RawContext, out: *mut f64);"
        for e in externs
    ]
    arrays = "q: *mut f64, v: *mut f64, a: *mut f64, u: *const f64, x: *const RawContext, w: *mut f64, out: *mut f64"
    lines += [f"    fn {e}({arrays});" for e in sorted({start for start, _ in series})]
    lines += [f"    fn {e}(n: usize, {arrays});" for e in sorted({run for _, run in series})]
    lanes = [f for v in variants for slot, f in v.functions.items() if is_for_lanes(v, slot, f)]
    for level, only in LEVELS:
        of = lambda names: sorted({f"{only}fn {e}_{level}" for e in names})
        lines += [f"    {e}(q: *const f64, v: *const f64, a: *const f64, x: *const RawContext, out: *mut f64);"
                  for e in of(f.symbol for f in lanes if isinstance(f.symbol, str))]
        pairs = [f.symbol for f in lanes if not isinstance(f.symbol, str)]
        lines += [f"    {e}({arrays});" for e in of(start for start, _ in pairs)]
        lines += [f"    {e}(n: usize, {arrays});" for e in of(run for _, run in pairs)]
    lines += ["}", "", "static DIMENSIONS: Dimensions = Dimensions {",
              f"    coordinates: {len(model.coordinates)},", f"    motions: {len(model.motions)},",
              f"    signals: {signals},", f"    discretes: {len(model.discretes)},",
              f"    parameters: {len(model.parameters)},", f"    constants: {constants_count},",
              f"    angles: {KEPT_ANGLES},", f"    expanded: &[{_flags(_used(variants, (*SERIES, 'requirements')))}],",
              f"    required: &{[i for i, used in enumerate(_used(variants, ('requirements',))) if used]},", "};", ""]
    lines += [f"/// {model.title}.", f"pub static {name.upper()}: Model = Model {{"]
    lines += [
        f"    name: {_text(name)},", f"    title: {_text(model.title)},", f"    source: {_text(model.source)},",
        f"    coordinates: &[{', '.join(_coordinate(c) for c in model.coordinates)}],",
        f"    motions: &[{', '.join(_motion(m) for m in model.motions)}],",
        f"    parameters: &[{', '.join(_parameter(p) for p in model.parameters)}],",
        f"    parameter_sets: &[{', '.join(_parameter_set(*s) for s in model.parameter_sets)}],",
        f"    inputs: &[{', '.join(_inputs(model))}],",
        f"    discretes: &[{', '.join(_discrete(d) for d in model.discretes)}],",
        f"    choices: &[{', '.join(_choice(*c[:3]) for c in model.choices)}],",
        f"    constants: ConstantsKernel {{ dimensions: &DIMENSIONS, function: {constants_symbol} }},",
        "    variants: &[",
    ]
    for variant in variants:
        lines += _variant(variant)
    lines += ["    ],", f"    for_tests: {_bool(for_tests)},", "};"]
    return "\n".join(lines) + "\n"


def _text(value):
    return json.dumps(value, ensure_ascii=False)


def _bool(value):
    return "true" if value else "false"


def _flags(values):
    return ", ".join(map(_bool, values))


def _number(value):
    value = float(value)
    if value == float("inf"):
        return "f64::INFINITY"
    if value == float("-inf"):
        return "f64::NEG_INFINITY"
    return repr(value)


def _option(value, show):
    return "None" if value is None else f"Some({show(value)})"


def _reaction_unit(unit):
    """Unit of the generalized force of a coordinate: N for lengths, N m for angles."""
    force = units.combine(units.parse("N m"), units.parse(unit), -1)
    return next((name for name in ("N", "N m") if units.parse(name) == force), units.text(force))


def _coordinate(c):
    return (f"Coordinate {{ name: {_text(c.name)}, unit: {_text(c.unit)}, meaning: {_text(c.meaning)}, "
            f"reaction_unit: {_text(_reaction_unit(c.unit))}, scale: {_number(c.scale)}, "
            f"rate_scale: {_number(c.rate_scale)}, minimum: {_option(c.minimum, _number)} }}")


def _motion(m):
    return (f"Motion {{ name: {_text(m.name)}, unit: {_text(m.unit)}, "
            f"reaction_unit: {_text(_reaction_unit(m.unit))}, meaning: {_text(m.meaning)} }}")


def _parameter(p):
    return (f"Parameter {{ name: {_text(p.name)}, unit: {_text(p.unit)}, meaning: {_text(p.meaning)}, "
            f"default: {_number(p.default)}, minimum: {_number(p.minimum)}, "
            f"minimum_exclusive: {_bool(p.exclusive)}, maximum: {_number(p.maximum)}, "
            f"at_most: {_option(p.at_most, _text)} }}")


def _parameter_set(name, meaning, values):
    pairs = ", ".join(f"({_text(k)}, {_number(v)})" for k, v in values.items())
    return f"ParameterSet {{ name: {_text(name)}, meaning: {_text(meaning)}, values: &[{pairs}] }}"


def _inputs(model):
    signal = 0
    for i in model.inputs:
        kind = "Value" if i.motion is None else "Acceleration"
        yield (f"Input {{ name: {_text(i.name)}, unit: {_text(i.unit)}, meaning: {_text(i.meaning)}, "
               f"kind: InputKind::{kind}, signal: {signal} }}")
        signal += len(i.signals)


def _discrete(d):
    return (f"Discrete {{ name: {_text(d.name)}, values: &[{', '.join(map(_number, d.values))}], "
            f"meaning: {_text(d.meaning)} }}")


def _choice(name, options, meaning):
    return (f"Choice {{ name: {_text(name)}, options: &[{', '.join(map(_text, options))}], "
            f"meaning: {_text(meaning)} }}")


def _variant(variant):
    model = variant.model
    yield "        Variant {"
    yield f"            options: &[{', '.join(_text(c[3]) for c in model.choices)}],"
    yield f"            defaults: &[{_flags(c[3] == c[4] for c in model.choices)}],"
    yield f"            drawing: {_text(drawing.program(model))},"
    yield "            modes: &["
    for i, equations in enumerate(variant.modes):
        yield from _mode(variant, i, equations)
    yield "            ],"
    index = {m.name: k for k, m in enumerate(model.modes)}
    rests = ", ".join(f"Rest {{ source: {index[s.name]}, target: {index[t.name]} }}" for s, t in model.rests)
    yield f"            rests: &[{rests}],"
    yield "        },"


def _mode(variant, i, equations):
    model, mode = variant.model, equations.mode
    functions = {slot[1:]: f for slot, f in variant.functions.items() if slot[0] == i}
    free = len(equations.free)
    if free > MOST_FREE:
        from .errors import ModelError
        raise ModelError(f"mode `{mode.name}` has {free} free coordinates; at most {MOST_FREE} are supported", model.file)
    held = ", ".join(
        _option(mode.held.get(c.name), _number) for c in model.coordinates)
    drifts = _flags(c.name in mode.drift for c in model.coordinates)
    index = {m.name: k for k, m in enumerate(model.modes)}
    pad = " " * 16
    yield f"{pad}Mode {{"
    yield f"{pad}    name: {_text(mode.name)}, meaning: {_text(mode.meaning)},"
    yield f"{pad}    free: &{equations.free}, held_at: &[{held}], drifts: &[{drifts}],"
    yield f"{pad}    guards: &["
    for g, (expression, transitions) in enumerate(equations.guards):
        yield f"{pad}        Guard {{"
        yield f"{pad}            name: {_text(_guard_name(transitions))}, text: {_text(units.short(expression, 200))},"
        yield f"{pad}            unit: {_text(_unit(model, expression))}, shape: {_shape(model, equations, expression)},"
        yield (f"{pad}            kernel: GuardKernel {{ dimensions: &DIMENSIONS, free: {free}, value: {functions['guard', g].symbol}, "
               f"rate: {functions['guard_rate', g].symbol}, "
               f"magnitude: {functions['guard_magnitude', g].symbol} }},")
        yield f"{pad}            transitions: &["
        for t, transition in enumerate(transitions):
            condition = functions.get(("condition", g, t))
            target = index[transition.target.name]
            target_free = len(variant.modes[target].free)
            yield (f"{pad}                Transition {{ name: {_text(transition.name)}, target: {target}, "
                   f"conditional: {_bool(condition)}, changes: &[{', '.join(map(_text, transition.changes))}], "
                   f"impact: {_bool(transition.impact)}, conditions: {variant.tapes[i, 'conditions', g, t]}, kernel: TransitionKernel {{ dimensions: &DIMENSIONS, source_free: {free}, "
                   f"reset: {functions['reset', g, t].symbol}, "
                   f"condition: {_option(condition, lambda c: f'({c.symbol}, {target_free}, {c.output.numel()})')} }} }},")
        yield f"{pad}            ],"
        yield f"{pad}        }},"
    yield f"{pad}    ],"
    yield f"{pad}    requirements: &["
    for requirement, failure, _ in mode.requirements:
        yield (f"{pad}        Requirement {{ text: {_text(units.short(requirement, 200))}, "
               f"failure: {_text(failure)}, unit: {_text(_unit(model, requirement))} }},")
    yield f"{pad}    ],"
    without = functions[("series",)].without or None
    yield f"{pad}    without_series: {_option(without, _text)},"
    yield f"{pad}    system: {variant.tapes[i, 'system']}, guard_values: {variant.tapes[i, 'guards']},"
    yield f"{pad}    kernels: ModeKernels::F{free}(ModeKernel {{"
    yield f"{pad}        dimensions: &DIMENSIONS,"
    for what in _MODE_FUNCTIONS:
        yield f"{pad}        {what}: {functions[(what,)].symbol},"
    yield f"{pad}        requirements: ({functions[('requirements',)].symbol}, {len(mode.requirements)}),"
    yield f"{pad}        requirement_bounds: {functions[('requirement_bounds',)].symbol},"
    for what in SERIES:
        series = functions[(what,)]
        yield f"{pad}        {what}: {_option(series.symbol and series, _series)},"
    yield f"{pad}        guards: {len(equations.guards)},"
    mass = functions[("system",)].output[: free**2]
    jacobian = functions[("jacobian",)].output
    yield f"{pad}        mass_is_constant: {_bool(_is_constant(model, equations, mass))},"
    inertia = ca.vertcat(ca.vec(mass), ca.vec(functions[("inertia",)].output))
    yield f"{pad}        inertia_is_fixed: {_bool(_is_fixed(model, equations, inertia))},"
    yield f"{pad}        is_linear: {_bool(_is_constant(model, equations, jacobian))},"
    yield f"{pad}        held_rates: {functions[('held_rates',)].symbol},"
    yield f"{pad}        lanes: {_lanes(variant, i, functions)},"
    yield f"{pad}    }}),"
    counts = ", ".join(
        f"({_text(what[0] if len(what) == 1 else ' '.join(map(str, what)))}, {f.operations})"
        for what, f in functions.items())
    yield f"{pad}    operations: &[{counts}],"
    yield f"{pad}}},"


def _series(function, level=""):
    (start, run), (lead, row, convolutions, ends) = function.symbol, function.workspace
    return (f"SeriesKernel {{ start: {start}{level}, run: {run}{level}, lead: {lead}, row: {row}, "
            f"convolutions: {convolutions}, ends: {_bool(ends)} }}")


def _lanes(variant, i, functions):
    """The functions for lanes, one set a level."""
    if not goes_in_lanes(variant, i):
        return "&[]"
    sets = []
    for level, only in LEVELS:
        guards = ", ".join(f"{functions['guard', g].symbol}_{level}" for g in range(len(variant.modes[i].guards)))
        own = lambda reset: _option(reset if reset.stays else None, lambda f: f"{f.symbol}_{level}")
        resets = ", ".join(
            f"&[{', '.join(own(functions['reset', g, t]) for t in range(len(transitions)))}]"
            for g, (_, transitions) in enumerate(variant.modes[i].guards))
        sets.append(
            f"{only}LaneKernel {{ series: {_series(functions[('series',)], '_' + level)}, "
            f"quiet_series: {_series(functions[('quiet_series',)], '_' + level)}, "
            f"requirement_bounds: {functions[('requirement_bounds',)].symbol}_{level}, guards: &[{guards}], resets: &[{resets}] }}")
    return f"&[{', '.join(sets)}]"


def _guard_name(transitions):
    return " / ".join(dict.fromkeys(t.name for t in transitions))


def _unit(model, expression):
    return units.text(units.dimension_of(ca.SX(expression), model.dimensions))


def _shape(model, equations, expression):
    placed = equations.place(expression)
    linear = linear_shape(model, equations, placed)
    if linear is not None:
        return linear
    depends = lambda *columns: bool(present(ca.symvar(placed), *columns))
    return (f"GuardShape::General {{ accelerations: {_bool(depends(equations.a))}, "
            f"signals: {_bool(depends(ca.vertcat(*_signals(model))))} }}")


def _is_constant(model, equations, entries):
    """Whether entries of a matrix stay the same while the mode lasts."""
    return not present(ca.symvar(entries), equations.a, *_moving(model, equations))


def _is_fixed(model, equations, entries):
    """Whether entries of a matrix follow from the parameters alone: also where the sign of a discrete state of +1 or -1
    cancels out of them."""
    of_sign = [d for d in model.discretes if sorted(d.values) == [-1, 1] and graph.is_even(entries, d.symbol)]
    others = ca.vertcat(*(d.symbol for d in model.discretes if d not in of_sign))
    return _is_constant(model, equations, entries) and not present(ca.symvar(entries), equations.held, others)


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
                return (f"GuardShape::Linear {{ index: {index}, rate: {_bool(rate)}, "
                        f"factor: {_number(factor)}, discrete: {_option(discrete, str)}, offset: {_bool(offset)} }}")
    return None


def _moving(model, equations):
    """Columns of the symbols that change while the mode lasts, accelerations left out."""
    drifting = [equations.held[i] for i, c in enumerate(model.coordinates) if c.name in equations.mode.drift]
    return equations.q, equations.v, ca.vertcat(*_signals(model)), ca.vertcat(*drifting)


def _signals(model):
    return [s for i in model.inputs for s in i.signals]


def _used(variants, slots):
    """Of each signal, whether these functions of some mode depend on it."""
    outputs = [f.output for v in variants for slot, f in v.functions.items() if slot[1] in slots]
    present = {s.element_hash() for output in outputs for s in ca.symvar(output)}
    return [s.element_hash() in present for s in _signals(variants[0].model)]


def present(symbols, *columns):
    """Those of the symbols that some column contains."""
    wanted = {column[i].element_hash() for column in columns for i in range(column.numel())}
    return [s for s in symbols if s.element_hash() in wanted]


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
