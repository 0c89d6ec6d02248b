"""What a model draws: shapes whose points are expressions of state and parameters, as a small program.

The page of a run evaluates the program at its key frames (`src/page/`), so that a drawing needs no
generated C. X to the right, Y up, in metres, in the frame of the ground.
"""

import json
from dataclasses import dataclass, field

import casadi as ca

from . import arguments, graph, units
from .errors import ModelError

POINTS = {"body": (3, None), "liquid": (3, None), "line": (2, None), "fixed": (2, None), "spring": (2, 2),
          "point": (1, 1), "contact": (1, 1)}
"""Kinds of shapes, with the least and the largest number of their points: closed outlines of bodies and of liquid, open
lines, ground and walls (hatched to the right of the way from their first point to the last), springs, discs, places
where a body touches the ground."""

_NAMES = {
    ca.OP_ADD: "add", ca.OP_SUB: "sub", ca.OP_MUL: "mul", ca.OP_DIV: "div", ca.OP_NEG: "neg", ca.OP_SQ: "sq",
    ca.OP_TWICE: "twice", ca.OP_INV: "inv", ca.OP_SIN: "sin", ca.OP_COS: "cos", ca.OP_TAN: "tan", ca.OP_EXP: "exp",
    ca.OP_LOG: "log", ca.OP_SQRT: "sqrt", ca.OP_ATAN2: "atan2", ca.OP_FABS: "abs", ca.OP_SIGN: "sign",
    ca.OP_FMIN: "min", ca.OP_FMAX: "max", ca.OP_POW: "pow", ca.OP_CONSTPOW: "pow", ca.OP_ATAN: "atan",
    ca.OP_ASIN: "asin", ca.OP_ACOS: "acos",
}
"""Operations of a program, as the page knows them."""


@dataclass
class Shape:
    """A shape of the drawing."""

    name: str
    kind: str
    points: list
    radius: object
    location: str
    force: list
    """Of a contact the names of the reactions that act at it along X and Y."""
    states: dict
    """Of a contact its state by the name of the mode, where it is not open."""
    of: object = None
    """Name of the declared contact, friction or constraint that it shows, if any."""
    pushes: list = field(default_factory=list)
    """Its forces: name of the column, and direction (X, Y)."""

    def values(self):
        """All expressions of it, as the program gives them."""
        directions = [value for _, direction in self.pushes for value in direction]
        return [value for pair in self.points for value in pair] + ([] if self.radius is None else [self.radius]) + directions


STATES = ("closed", "sticks", "slides")
"""States of contacts, besides `open`."""


def shape(model, name, points, kind, radius, location, force=None, states=None, of=None, along=None):
    """A checked shape."""
    arguments.text(model, "the name of what is drawn", name)
    what = f"drawing of `{name}`"
    if kind not in POINTS:
        raise ModelError(f"{what}: there is no kind `{kind}`; write one of {', '.join(POINTS)}", location)
    least, most = POINTS[kind]
    try:
        pairs = [(ca.SX(x), ca.SX(y)) for x, y in points]
    except (TypeError, ValueError, NotImplementedError):
        raise ModelError(f"{what}: points are a list of pairs (X, Y)", location) from None
    if len(pairs) < least or most is not None and len(pairs) > most:
        wanted = f"{least}" if least == most else f"at least {least}"
        raise ModelError(f"{what}: a `{kind}` has {wanted} points, not {len(pairs)}", location)
    if radius is not None and kind != "point":
        raise ModelError(f"{what}: only a `point` has a radius", location)
    lengths = [value for pair in pairs for value in pair] + ([] if radius is None else [ca.SX(radius)])
    # A number is metres: how large a picture is drawn is not physics.
    _of_motion(model, what, lengths, "m", "m (numbers alone are metres)", location)
    made = Shape(name, kind, pairs, None if radius is None else ca.SX(radius), location,
                 *_contact(model, what, kind, force, states, location))
    if of is not None:
        if kind != "contact" or force is not None or states is not None:
            raise ModelError(f"{what}: `of` is for a `contact`, which then has no `force` and no `states` of its own", location)
        made.of, made.pushes = of, _pushes(model, what, of, along, location)
    elif along is not None:
        raise ModelError(f"{what}: `along` belongs to `of`, which names a contact, a friction or a constraint", location)
    return made


def _pushes(model, what, of, along, location):
    """The forces of a declared contact, friction or constraint, with their directions, checked."""
    contact = next((c for c in model.contacts if c.name == of), None)
    held = [c.name for c in model.constraints if c.name == of or isinstance(of, str) and c.name.startswith(f"{of}.")]
    if contact is not None:
        forces = {contact.force_name: (0, 1)} if contact.gap is not None else {}
        forces |= {f"{of}.friction": (1, 0)} if contact.slip is not None else {}
    elif any(of == name for name, _ in model.switched_off):
        return []
    elif held:
        forces = dict.fromkeys((f"{name}.force" for name in held), None)
        if len(held) == 2:
            forces = dict(zip(forces, ((1, 0), (0, 1))))
        elif along is None:
            raise ModelError(f"{what}: say by `along` in which directions the forces of `{of}` act, a list of {len(held)} pairs (X, Y)",
                             location)
    else:
        known = ", ".join(f"`{c.name}`" for c in [*model.contacts, *model.constraints]) or "none"
        raise ModelError(f"{what}: there is no contact, friction or constraint {arguments.shown(of)} above (there are: {known})",
                         location)
    given = list(forces.values()) if along is None else along
    if isinstance(given, list) and not given:
        return []
    try:
        directions = [(ca.SX(x), ca.SX(y)) for x, y in given]
    except (TypeError, ValueError, NotImplementedError):
        raise ModelError(f"{what}: `along` is a list of pairs (X, Y)", location) from None
    if len(directions) != len(forces):
        names = ", ".join(f"`{name}`" for name in forces)
        raise ModelError(f"{what}: `along` has {len(directions)} directions, but the forces of `{of}` are {names}", location)
    _of_motion(model, what, [value for pair in directions for value in pair], "1", "1, as a direction has it", location)
    return list(zip(forces, directions))


def _of_motion(model, what, values, unit, expected, location):
    """Checks that values depend on what pages know, and have this dimension."""
    known = {s.element_hash() for s in symbols(model)[1]}
    for value in values:
        for symbol in ca.symvar(value):
            if symbol.element_hash() not in known:
                raise ModelError(
                    f"{what}: `{symbol.name()}` is no coordinate, parameter or discrete state", location)
        for term in graph.additive_terms(value):
            if ca.SX(term).is_constant():
                continue
            try:
                found = units.dimension_of(ca.SX(term), model.dimensions)
            except units.UnitError as error:
                raise ModelError(f"{what}: {error}", location) from None
            if found != units.parse(unit) and not ca.SX(term).is_zero():
                raise ModelError(
                    f"{what}: the term `{units.short(term)}` has the dimension {units.text(found)}, expected {expected}", location)


def _contact(model, what, kind, force, states, location):
    """Forces and states of a contact, checked."""
    if kind != "contact" and (force is not None or states is not None):
        raise ModelError(f"{what}: only a `contact` has a force and states", location)
    parts = (None, None) if force is None else force
    if not isinstance(parts, (tuple, list)) or len(parts) != 2:
        raise ModelError(f"{what}: its force is a pair, what has the reactions along X and Y, or None for one of them", location)
    names = [None if part is None else "reaction." + arguments.coordinate(model, f"{what}: its force", part, motions=True).name()
             for part in parts]
    named = {}
    for mode, state in arguments.pairs(model, f"{what}: its states", states or [], "(mode, state)"):
        if state not in STATES:
            raise ModelError(f"{what}: there is no state {state!r}; write one of {', '.join(STATES)}; in other modes it is open",
                             location)
        named[arguments.mode(model, f"{what}: its states", mode).name] = state
    return ([] if force is None else names), named


def symbols(model):
    """Names and symbols that a drawing may depend on."""
    declared = [(d.name, d.symbol) for d in (*model.coordinates, *model.discretes, *model.parameters)]
    return [name for name, _ in declared], [symbol for _, symbol in declared]


def program(model):
    """The drawing as JSON: names of the symbols, instructions on registers, and shapes by the registers of their
    points; the empty text where nothing is drawn."""
    if not model.shapes:
        return ""
    names, all_symbols = symbols(model)
    outputs, shapes = [], []
    for s in model.shapes:
        start = len(outputs)
        outputs += s.values()
        shapes.append((s, start))
    used = {symbol.element_hash() for symbol in ca.symvar(ca.vertcat(*outputs))}
    chosen = [(n, s) for n, s in zip(names, all_symbols) if s.element_hash() in used]
    function = ca.Function("drawing", [s for _, s in chosen], [ca.densify(ca.cse(ca.vertcat(*outputs)))])
    instructions = []
    for k in range(function.n_instructions()):
        op, given = function.instruction_id(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            instructions.append(["out", function.instruction_output(k)[1], given[0]])
            continue
        to = function.instruction_output(k)[0]
        if op == ca.OP_CONST:
            instructions.append(["const", to, function.instruction_constant(k)])
        elif op == ca.OP_INPUT:
            instructions.append(["in", to, given[0]])
        elif op in _NAMES:
            instructions.append([_NAMES[op], to, *given])
        else:
            raise ModelError(
                f"drawing: an operation of it is not known to pages; write it with {', '.join(sorted(set(_NAMES.values())))}",
                model.shapes[0].location)
    return json.dumps({
        "symbols": [name for name, _ in chosen],
        "registers": function.sz_w(), "outputs": len(outputs), "program": instructions,
        "shapes": [dict(name=s.name, kind=s.kind, start=start, points=len(s.points), radius=s.radius is not None,
                        **({"force": s.force} if s.force else {}), **({"states": s.states} if s.states else {}),
                        **({"of": s.of, "pushes": [name for name, _ in s.pushes]} if s.of else {}))
                   for s, start in shapes],
    }, separators=(",", ":"))
