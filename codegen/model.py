"""The model interface: what a `models/NAME/model.py` is written in.

A model states coordinates, parameters, inputs, discrete states, bodies or energies, dissipation,
modes, guards, transitions and resets. Nothing is derived here; see `derive.py`.

Signs: X horizontal to the right, Y up. A reaction is the force that the constraint exerts on the
system along the frozen coordinate; a base reaction is the force of the ground on the system.
"""

import sys
from dataclasses import dataclass, field

import casadi as ca
from casadi import atan2, cos, exp, pi, sin, sqrt, tan  # noqa: F401  (for model files)

from . import drawing, limits, units
from .errors import ModelError, caller_location

HELD = None
"""Value for `freeze`: the coordinate is held wherever it was."""


class Named(ca.SX):
    """A symbol that knows its declaration."""


class Coordinate(Named):
    """A generalized coordinate; `.rate` and `.acceleration` are its derivatives."""


class Discrete(Named):
    """A discrete state."""


@dataclass
class Declaration:
    """What is common to everything that has a name, a unit and a meaning."""

    name: str
    unit: str
    meaning: str
    symbol: ca.SX
    extra: dict = field(default_factory=dict)

    def __getattr__(self, key):
        try:
            return self.__dict__["extra"][key]
        except KeyError:
            raise AttributeError(key) from None


@dataclass
class Body:
    """A body of the plane: mass, position of its centre, inertia about it, angle."""

    mass: ca.SX
    position: tuple
    inertia: ca.SX = None
    angle: ca.SX = None


@dataclass
class Falls:
    """A guard: the mode is inadmissible once `expression` falls through zero."""

    expression: ca.SX


def falls(expression):
    """Guard that triggers when `expression` falls through zero."""
    return Falls(ca.SX(expression))


def rises(expression):
    """Guard that triggers when `expression` rises through zero."""
    return Falls(-ca.SX(expression))


@dataclass
class Transition:
    """Guard → next mode; built by `Model.transition`."""

    name: str
    source: "Mode"
    target: "Mode"
    guard: ca.SX
    condition: ca.SX
    reset: list
    impact: bool
    location: str


class Mode:
    """Which coordinates are free, and the law on each of the others."""

    def __init__(self, model, name, meaning, freeze, drift):
        self.model, self.name, self.meaning = model, name, meaning
        self.held, self.drift = freeze, drift
        self.forces, self.requirements = [], []

    def is_free(self, coordinate):
        """Whether the coordinate is integrated in this mode."""
        return coordinate.name() not in self.held

    def reaction(self, coordinate, **discrete):
        """Reaction of a frozen coordinate or ground motion, with discrete states set as given.

        The force that the constraint exerts on the system; it depends on the state, the
        accelerations of the free coordinates and the inputs.
        """
        return self.model._placeholder(self, coordinate, discrete)

    def friction(self, coordinate, *, normal, coefficient, direction, against=0):
        """Coulomb friction −coefficient × normal × direction on a free coordinate.

        `direction` is the sign of the slip rate (coordinate rate − `against`); the power
        normal·coefficient·|slip rate| is dissipated, the rest is work of the moving partner.
        """
        self._check_free(coordinate)
        self.model._locate(self.forces)
        self.forces.append((coordinate, -coefficient * normal * direction, ca.SX(against)))

    def force(self, coordinate, expression, against=0):
        """A dissipative force on a free coordinate, in this mode only (as `friction`)."""
        self._check_free(coordinate)
        self.model._locate(self.forces)
        self.forces.append((coordinate, ca.SX(expression), ca.SX(against)))

    def _check_free(self, coordinate):
        if not self.is_free(coordinate):
            raise self.model.error(f"mode `{self.name}`: coordinate `{coordinate.name()}` is frozen, no force acts on it")


class Model:
    """A model under construction; see the module documentation."""

    def __init__(self, title, *, source):
        context = _CONTEXT[-1]
        self.name, self.file = context.name, context.file
        self.title, self.source = title, source
        self.parameters, self.parameter_sets = [], []
        self.coordinates, self.motions, self.inputs = [], [], []
        self.discretes, self.choices = [], []
        self.bodies, self.kinetic_terms, self.potentials, self.dissipations = [], [], [], []
        self.external, self.hand_written, self.unchecked = [], {}, set()
        self.locations = {}
        self.modes, self.transitions, self.rests = [], [], []
        self.limits, self.validity = [], []
        self.placeholders = {}
        self.gravity_constant = ca.SX(0)
        self.shapes = []
        self.dimensions = {}
        context.model = self

    # ---- declarations -------------------------------------------------------------------------

    def parameter(self, name, unit, default, meaning, *, above=None, minimum=None, maximum=None, at_most=None):
        """A parameter; `above` is an exclusive lower bound, `at_most` another parameter."""
        symbol = self._declare(name, unit, ca.SX.sym(name))
        self.parameters.append(Declaration(name, unit, meaning, symbol, dict(
            default=float(default), exclusive=above is not None,
            minimum=float(above if above is not None else minimum if minimum is not None else "-inf"),
            maximum=float("inf" if maximum is None else maximum),
            at_most=at_most.name() if at_most is not None else None)))
        return symbol

    def parameter_set(self, name, meaning, **values):
        """Named values for some of the parameters, which a scene can choose by `set`."""
        known = {p.name for p in self.parameters}
        for key in values:
            if key not in known:
                raise self.error(f"parameter set `{name}`: there is no parameter `{key}`")
        self.parameter_sets.append((name, meaning, values))

    def coordinate(self, name, unit, meaning, *, minimum=None, maximum=None, scale=1.0, rate_scale=None):
        """A generalized coordinate with its velocity.

        `minimum` and `maximum` are bounds of every admissible state, such as a stop: numbers, or expressions in
        parameters. A state beyond them is refused.
        `scale` and `rate_scale` (per second) are typical magnitudes: a scene that gives no
        absolute tolerance gets relative tolerance × scale.
        """
        symbol = Coordinate(self._declare(name, unit, ca.SX.sym(name)))
        symbol.rate = self._declare(name + ".rate", unit + "/s", ca.SX.sym(name + ".rate"))
        symbol.acceleration = self._declare(
            name + ".acceleration", unit + "/s^2", ca.SX.sym(name + ".acceleration"))
        symbol.jerk = ca.SX.sym(name + ".jerk")
        minimum, maximum = (limits.bound(self, name, b, caller_location(self.file)) for b in (minimum, maximum))
        self.coordinates.append(Declaration(name, unit, meaning, symbol, dict(
            minimum=minimum, maximum=maximum, scale=float(scale),
            rate_scale=float(scale if rate_scale is None else rate_scale))))
        return symbol

    def discrete(self, name, values, meaning):
        """A discrete state with its admissible values, the first of which is the default."""
        symbol = Discrete(self._declare(name, "1", ca.SX.sym(name)))
        self.discretes.append(Declaration(name, "1", meaning, symbol, dict(values=[float(v) for v in values])))
        return symbol

    def input(self, name, unit, meaning):
        """A prescribed function of time, such as a force."""
        symbol = self._declare(name, unit, ca.SX.sym(name))
        self.inputs.append(Declaration(name, unit, meaning, symbol, dict(signals=[symbol], motion=None)))
        return symbol

    def ground(self, name, meaning, *, input, axis="x", unit="m"):
        """A prescribed motion of the ground along `axis`; a scene gives its acceleration.

        Positions of bodies are relative to the ground. Returns the motion, whose `.rate` and
        `.acceleration` are symbols, and whose base reaction is `mode.reaction(motion)`.
        """
        symbol = Coordinate(self._declare(name, unit, ca.SX.sym(name)))
        symbol.rate = self._declare(name + ".rate", unit + "/s", ca.SX.sym(name + ".rate"))
        symbol.acceleration = self._declare(
            name + ".acceleration", unit + "/s^2", ca.SX.sym(name + ".acceleration"))
        self.motions.append(Declaration(name, unit, meaning, symbol, dict(axis="xy".index(axis))))
        self.inputs.append(Declaration(input, unit + "/s^2", meaning, symbol.acceleration, dict(
            signals=[symbol.acceleration, symbol.rate, symbol], motion=name)))
        return symbol

    def choice(self, name, options, meaning, *, default=None):
        """A modelling choice of the scene; returns the option under construction.

        The model file is run once for every combination of options. `options` and `default` may
        depend on the choices made before; the first run must see all options.
        """
        option = _CONTEXT[-1].choose(name, list(options))
        self.choices.append((name, list(options), meaning, option, default or options[0]))
        return option

    # ---- energies -----------------------------------------------------------------------------

    def gravity(self, g):
        """Weight of all bodies along −Y."""
        self.gravity_constant = g

    def point_mass(self, mass, position):
        """A point mass at `position` = (X, Y) relative to the ground."""
        self._locate(self.bodies)
        self.bodies.append(Body(ca.SX(mass), tuple(ca.SX(p) for p in position)))

    def rigid_body(self, mass, inertia, position, angle):
        """A rigid body: mass, inertia about its centre, position of the centre, angle."""
        self._locate(self.bodies)
        self.bodies.append(Body(ca.SX(mass), tuple(ca.SX(p) for p in position), ca.SX(inertia), ca.SX(angle)))

    def kinetic(self, energy):
        """Kinetic energy that is not a body's, as an expression in coordinates and rates."""
        self._locate(self.kinetic_terms)
        self.kinetic_terms.append(ca.SX(energy))

    def potential(self, energy):
        """Potential energy besides the weight of the bodies."""
        self._locate(self.potentials)
        self.potentials.append(ca.SX(energy))

    def dissipation(self, rayleigh):
        """Rayleigh's function D(q, v): the force −∂D/∂v acts, the power v·∂D/∂v is dissipated."""
        self._locate(self.dissipations)
        self.dissipations.append(ca.SX(rayleigh))

    def force(self, coordinate, expression):
        """A generalized force on a coordinate; its power counts as input work."""
        self._locate(self.external)
        self.external.append((coordinate, ca.SX(expression)))

    def by_hand(self, coordinate, residual, *, check_units=True):
        """Replaces the derived equation of a coordinate by a hand-written one, `residual` = 0.

        For a frozen coordinate the residual is its reaction. Without `check_units` its terms may
        have any dimension: for printed equations that are to be run with their misprints.
        """
        self.hand_written[coordinate.name()] = ca.SX(residual)
        if not check_units:
            self.unchecked.add(coordinate.name())

    # ---- hybrid structure ---------------------------------------------------------------------

    def mode(self, name, meaning="", *, freeze=(), drift=None):
        """A mode. `freeze` maps coordinates to the value they are held at (or HELD: wherever they
        were); `drift` maps frozen coordinates to a constant rate (a belt) instead of rest."""
        pairs = freeze if isinstance(freeze, (list, tuple)) else [freeze]
        held = {}
        for entry in pairs:
            coordinate, value = entry if isinstance(entry, tuple) else (entry, HELD)
            held[coordinate.name()] = value
        drifting = {c.name(): ca.SX(rate) for c, rate in (drift or [])}
        for name_ in drifting:
            if held.get(name_, 0) is not HELD:
                raise self.error(f"mode `{name}`: `{name_}` drifts, so it must be frozen as HELD")
        mode = Mode(self, name, meaning, held, drifting)
        if any(m.name == name for m in self.modes):
            raise self.error(f"mode `{name}` is declared twice")
        self.modes.append(mode)
        return mode

    def transition(self, name, source, target, *, when, reset=(), provided=None, impact=False):
        """Transition `source` → `target` when the guard falls through zero.

        `reset` lists (coordinate | coordinate.rate | discrete, expression in the state before).
        `provided` (one expression or several) must be ≥ 0 for the transition to be taken; it is
        evaluated in `target` after the reset. Of several transitions with one guard the first whose condition holds is taken.
        """
        if not isinstance(when, Falls):
            raise self.error(f"transition `{name}`: `when` must be falls(…) or rises(…)")
        self.transitions.append(Transition(
            name, source, target, when.expression,
            None if provided is None else ca.vertcat(*provided) if isinstance(provided, (list, tuple)) else ca.SX(provided),
            [(symbol, ca.SX(value)) for symbol, value in reset], impact,
            caller_location(self.file)))

    def rest(self, source, target):
        """A mode at the limit of infinitely many events in finite time, some of which lead to `source`.

        It is entered where the limit satisfies what `target` holds: values and rates. A source may have
        several; the one that holds the most is taken, the first in the order of the file among equals.
        """
        for mode in (source, target):
            if not isinstance(mode, Mode):
                raise self.error(f"rest: `{mode}` is not a mode; give what model.mode(…) returned")
        freed = [name for name in source.held if name not in target.held]
        if freed or len(target.held) == len(source.held):
            what = f"lets `{freed[0]}` move, which `{source.name}` holds" if freed else f"holds no more than `{source.name}`"
            raise self.error(f"rest of `{source.name}` in `{target.name}`: `{target.name}` {what}; what comes to rest"
                             " is held in the target, and what was held stays so")
        if (source, target) in self.rests:
            raise self.error(f"rest of `{source.name}` in `{target.name}` is declared twice")
        self.rests.append((source, target))

    def requires(self, mode, positive, failure):
        """Stops the run with the reason `failure` where `positive` is not > 0."""
        mode.requirements.append((ca.SX(positive), failure, caller_location(self.file)))

    def limit(self, name, message, *, when, ends=True, modes=None):
        """A limit state: reached where the comparison `when`, such as `theta > pi / 2`, first holds.

        A run ends there, unless the scene lets it go on; one that does not end by itself (`ends=False`) is noted,
        unless the scene lets it end. Reactions are those of one mode: `modes` says in which it is watched.
        """
        location = caller_location(self.file)
        if any(known.name == name for known in self.limits):
            raise self.error(f"limit `{name}` is declared twice")
        margin, text = limits.comparison(when, f"limit `{name}`", location)
        self.limits.append(limits.Limit(name, message, -margin, text, ends, modes, location))

    def valid(self, condition, sentence, *, modes=None):
        """A condition under which the model is meant, a comparison of parameters or of the motion, and a sentence
        that says what it assumes. A run that leaves it goes on, and says so."""
        location = caller_location(self.file)
        margin, text = limits.comparison(condition, "valid", location)
        self.validity.append(limits.Validity(sentence, margin, text, modes, location))

    # ---- drawing ------------------------------------------------------------------------------

    def draw(self, name, points, *, kind="body", radius=None):
        """A shape of the drawing that pages animate; `points` are (X, Y) in m, in the frame of the ground.

        Kinds: `body` and `liquid` (closed outlines), `line`, `spring`, `fixed` (ground or wall, hatched to the right of
        the way along it), `point` (a disc; `radius` in m), `contact` (where a body touches the ground).
        """
        self.shapes.append(drawing.shape(self, name, points, kind, radius, caller_location(self.file)))

    # ---- helpers ------------------------------------------------------------------------------

    def impact_velocities(self, *, before, after, prescribed, conserve):
        """Velocities after an impact that prescribes some rates and conserves some momenta.

        `before` and `after` map discrete states to their values on either side (or to symbols);
        `prescribed` lists (coordinate, rate after); `conserve` lists the coordinates whose
        ∂T/∂v is the same before and after; all others come to rest relative to the ground.
        """
        from .derive import impact_velocities
        return impact_velocities(self, before, after, prescribed, conserve)

    def location(self, group, index):
        """Where entry `index` of one of the lists above was declared."""
        return self.locations.get((id(group), index), self.file)

    def _locate(self, group):
        self.locations[id(group), len(group)] = caller_location(self.file)

    def error(self, message):
        """A ModelError that points at the line of the model file being run."""
        return ModelError(message, caller_location(self.file))

    def _declare(self, name, unit, symbol):
        if name in self.dimensions:
            raise self.error(f"`{name}` is declared twice")
        if not name.replace(".", "_").isidentifier() or "__" in name:
            raise self.error(f"`{name}` is not a name (letters, digits, single underscores)")
        try:
            self.dimensions[name] = units.parse(unit)
        except units.UnitError as error:
            raise self.error(f"`{name}`: {error}") from None
        return symbol

    def _placeholder(self, mode, coordinate, discrete):
        name = coordinate.name()
        if mode.is_free(coordinate) and all(m.name != name for m in self.motions):
            raise self.error(f"mode `{mode.name}`: coordinate `{name}` is free, it has no reaction")
        for key in discrete:
            if all(d.name != key for d in self.discretes):
                raise self.error(f"reaction of `{name}`: there is no discrete state `{key}`")
        settings = "".join(f", {k}={v:+g}" for k, v in sorted(discrete.items()))
        key = f"R({name}{settings})@{mode.name}"
        if key not in self.placeholders:
            symbol = ca.SX.sym(key)
            declaration = next(c for c in self.coordinates + self.motions if c.name == name)
            energy = units.parse("kg m^2/s^2")
            self.dimensions[key] = units.combine(energy, self.dimensions[declaration.name], -1)
            self.placeholders[key] = (symbol, mode, name, dict(discrete))
        return self.placeholders[key][0]


class BuildContext:
    """One run of a model file: its name, and the options of the choices made so far."""

    def __init__(self, name, file, options):
        self.name, self.file, self.options = name, file, options
        self.open, self.model = [], None

    def choose(self, name, options):
        if name not in self.options:
            self.options[name] = options[0]
            self.open.append((name, options[1:]))
        return self.options[name]


_CONTEXT = []


def build(name, file, source):
    """Runs a model file (its text) for every combination of choices; returns the models."""
    code = compile(source, file, "exec")
    models, pending = [], [{}]
    while pending:
        context = BuildContext(name, file, dict(pending.pop(0)))
        _CONTEXT.append(context)
        path = list(sys.path)
        try:
            exec(code, {"__name__": f"models.{name}", "__file__": file})
        finally:
            _CONTEXT.pop()
            sys.path[:] = path
        if context.model is None:
            raise ModelError("no Model(…) is made here", file)
        models.append(context.model)
        made = dict(context.options)
        for choice, others in context.open:
            prefix = {}
            for key, value in made.items():
                if key == choice:
                    break
                prefix[key] = value
            pending += [{**prefix, choice: other} for other in others]
    return models
