"""The model interface: what a `models/NAME/model.py` is written in.

A model states coordinates, parameters, inputs, discrete states, bodies or energies, dissipation,
modes, guards, transitions and resets. Nothing is derived here; see `derive.py`.

Signs: X horizontal to the right, Y up. A reaction is the force that the constraint exerts on the
system along the frozen coordinate; a base reaction is the force of the ground on the system.
"""

import re

import casadi as ca
from casadi import atan2, cos, exp, pi, sin, sqrt, tan  # noqa: F401  (for model files)

from . import arguments, contacts, drawing, limits, outputs, units
from .context import CONTEXT
from .declarations import Body, Coordinate, Declaration, Discrete, Falls, Requirement, Transition
from .errors import ModelError, caller_location
from .graph import structure  # noqa: F401  (for model files)

HELD = None
"""Value for `freeze`: the coordinate is held wherever it was."""


def falls(expression):
    """Guard that triggers when `expression` falls through zero."""
    return Falls(expression)


def rises(expression):
    """Guard that triggers when `expression` rises through zero."""
    return Falls(-expression if isinstance(expression, (ca.SX, float, int)) else expression)


class Mode:
    """Which coordinates are free, and the law on each of the others."""

    def __init__(self, model, name, meaning, freeze, drift):
        self.model, self.name, self.meaning = model, name, meaning
        self.held, self.drift = freeze, drift
        self.location = caller_location(model.file)
        self.forces, self.requirements = [], []
        self.form = None
        self.contact_states = {}
        self.lines, self.line_drift = [], {}

    @property
    def identifier(self):
        """Its name as part of names in generated code."""
        return re.sub(r"\W", "_", self.name)

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
        self.force(coordinate, -coefficient * normal * direction, against)

    def force(self, coordinate, expression, against=0):
        """A dissipative force on a free coordinate, in this mode only (as `friction`)."""
        model, what = self.model, f"mode `{self.name}`: what the force acts on"
        coordinate = arguments.coordinate(model, what, coordinate)
        if not self.is_free(coordinate):
            raise model.error(f"mode `{self.name}`: coordinate `{coordinate.name()}` is frozen, no force acts on it")
        model._locate(self.forces)
        what = f"force on `{coordinate.name()}` in mode `{self.name}`"
        self.forces.append((coordinate, *(arguments.expression(model, what, x) for x in (expression, against))))


class Model:
    """A model under construction; see the module documentation."""

    def __init__(self, title, *, source):
        context = CONTEXT[-1]
        self.name, self.file = context.name, context.file
        if context.model is not None:
            raise self.error("a model file makes one Model(…), and has made one above")
        self.location_of_model = caller_location(self.file)
        self.title, self.source = (arguments.text(self, f"the {what} of the model", given)
                                   for what, given in (("title", title), ("source", source)))
        self.parameters, self.parameter_sets = [], []
        self.coordinates, self.motions, self.inputs = [], [], []
        self.discretes, self.choices = [], []
        self.bodies, self.kinetic_terms, self.potentials, self.dissipations = [], [], [], []
        self.relative_terms = set()
        self.external, self.hand_written, self.unchecked = [], {}, set()
        self.locations = {}
        self.modes, self.transitions, self.rests = [], [], []
        self.contacts, self.constraints, self.switched_off, self.by_multipliers = [], [], [], False
        self.charts, self.requirements, self.lines, self.impulses, self.tied = [], [], [], [], []
        self.limits, self.validity, self.outputs = [], [], []
        self.placeholders = {}
        self.gravity_constant = ca.SX(0)
        self.shapes = []
        self.dimensions, self.symbols = {}, {}
        context.model = self

    # ---- declarations -------------------------------------------------------------------------

    def parameter(self, name, unit, default, meaning, *, above=None, minimum=None, maximum=None, at_most=None):
        """A parameter; `above` is an exclusive lower bound, `at_most` another parameter."""
        symbol = self._declare("parameter", name, unit)
        self._text("parameter", name, meaning)
        limits = dict(above=above, minimum=minimum, maximum=maximum)
        for limit, value in dict(default=default, **limits).items():
            if isinstance(value, str) or isinstance(value, ca.SX) or value is None and limit == "default":
                raise self.error(f"parameter `{name}`: `{limit}` is {arguments.shown(value)}, not a number")
        if at_most is not None:
            at_most = arguments.parameter(self, f"parameter `{name}`: `at_most`", at_most).symbol
            if self.dimensions[at_most.name()] != self.dimensions[name]:
                raise self.error(f"parameter `{name}`: `at_most` is `{at_most.name()}`, which has another unit")
        if above is not None and not default > above or minimum is not None and not default >= minimum or (
                maximum is not None and not default <= maximum):
            raise self.error(f"parameter `{name}`: its default {default} is not within its own limits")
        self.parameters.append(Declaration(name, unit, meaning, symbol, dict(
            default=float(default), exclusive=above is not None,
            minimum=float(above if above is not None else minimum if minimum is not None else "-inf"),
            maximum=float("inf" if maximum is None else maximum),
            at_most=at_most.name() if at_most is not None else None)))
        return symbol

    def parameter_set(self, name, meaning, **values):
        """Named values for some of the parameters, which a scene can choose by `set`."""
        self._text("parameter set", name, meaning)
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
        symbol = self._declare_motion("coordinate", name, unit)
        self._text("coordinate", name, meaning)
        symbol.jerk = ca.SX.sym(name + ".jerk")
        minimum, maximum = (limits.bound(self, name, b, caller_location(self.file)) for b in (minimum, maximum))
        self.coordinates.append(Declaration(name, unit, meaning, symbol, dict(
            minimum=minimum, maximum=maximum, scale=float(scale),
            rate_scale=float(scale if rate_scale is None else rate_scale))))
        return symbol

    def discrete(self, name, values, meaning):
        """A discrete state with its admissible values, the first of which is the default."""
        symbol = Discrete(self._declare("discrete state", name, "1"))
        self._text("discrete state", name, meaning)
        if isinstance(values, (str, ca.SX)) or not values:
            raise self.error(f"discrete state `{name}`: its values are {arguments.shown(values)}, not a list of numbers")
        self.discretes.append(Declaration(name, "1", meaning, symbol, dict(values=[float(v) for v in values])))
        return symbol

    def input(self, name, unit, meaning):
        """A prescribed function of time, such as a force."""
        symbol = self._declare("input", name, unit)
        self._text("input", name, meaning)
        self.inputs.append(Declaration(name, unit, meaning, symbol, dict(signals=[symbol], motion=None)))
        return symbol

    def ground(self, name, meaning, *, input, axis="x", unit="m", optional=False, available=True):
        """A prescribed motion of the ground along `axis`; a scene gives its acceleration.

        Positions of bodies are relative to the ground. Returns the motion, whose `.rate` and
        `.acceleration` are symbols, and whose base reaction is `mode.reaction(motion)`.

        For an `optional` one there is code with and without it, so that scenes that do not give it pay nothing. One that
        is not `available` under the choices made so far may not be given.
        """
        if axis not in ("x", "y"):
            raise self.error(f"ground `{name}`: there is no axis {axis!r}, but 'x' (to the right) and 'y' (upwards)")
        return self._prescribe("ground motion", name, meaning, input, unit, "xy".index(axis), optional, available)

    def motion(self, name, meaning, *, input, unit="m", optional=False, available=True):
        """A prescribed motion of something else than the ground: a belt, a table beside the ground, a driven crank
        (`unit="rad"`). A scene gives its acceleration, and under `initial` where it is and how fast it moves at first.

        Positions and energies, forces, gaps, slips and constraints may depend on it. Returns the motion as `ground` does;
        `mode.reaction(motion)` is the force that it takes. `optional` and `available` as there.
        """
        return self._prescribe("motion", name, meaning, input, unit, None, optional, available)

    def _prescribe(self, what, name, meaning, input, unit, axis, optional, available):
        """Declares a prescribed motion, of the ground where it has an axis, and its input."""
        symbol = self._declare_motion(what, name, unit)
        self._text(what, name, meaning)
        self._declare("input", input, unit + "/s^2")
        self.motions.append(Declaration(name, unit, meaning, symbol, dict(
            axis=axis, optional=optional, available=available, location=caller_location(self.file))))
        self.inputs.append(Declaration(input, unit + "/s^2", meaning, symbol.acceleration, dict(
            signals=[symbol.acceleration, symbol.rate, symbol], motion=name)))
        return symbol

    def choice(self, name, options, meaning, *, default=None):
        """A modelling choice of the scene; returns the option under construction.

        The model file is run once for every combination of options. `options` and `default` may
        depend on the choices made before; the first run must see all options.
        """
        arguments.name(self, "choice", name)
        self._text("choice", name, meaning)
        return self._choose(name, list(options), meaning, default)

    # ---- energies -----------------------------------------------------------------------------

    def gravity(self, g):
        """Weight of all bodies along −Y."""
        self.gravity_constant = arguments.expression(self, "gravity", g)

    def point_mass(self, mass, position):
        """A point mass at `position` = (X, Y) relative to the ground."""
        self._locate(self.bodies)
        self.bodies.append(Body(self._expression("mass", mass), self._position(position)))

    def rigid_body(self, mass, inertia, position, angle):
        """A rigid body: mass, inertia about its centre, position of the centre, angle."""
        self._locate(self.bodies)
        self.bodies.append(Body(self._expression("mass", mass), self._position(position),
                                self._expression("inertia", inertia), self._expression("angle", angle)))

    def kinetic(self, energy, *, relative=False):
        """Kinetic energy that is not a body's, as an expression in coordinates and absolute rates: `y.rate + z.rate` on
        ground that moves by z. `relative`: of a spin or an oscillation relative to the ground, without momentum."""
        self._locate(self.kinetic_terms)
        if relative:
            self.relative_terms.add(len(self.kinetic_terms))
        self.kinetic_terms.append(self._expression("kinetic energy", energy))

    def potential(self, energy):
        """Potential energy besides the weight of the bodies."""
        self._locate(self.potentials)
        self.potentials.append(self._expression("potential energy", energy))

    def dissipation(self, rayleigh):
        """Rayleigh's function D(q, v): the force −∂D/∂v acts, the power v·∂D/∂v is dissipated."""
        self._locate(self.dissipations)
        self.dissipations.append(self._expression("dissipation", rayleigh))

    def force(self, coordinate, expression):
        """A generalized force on a coordinate; its power counts as input work."""
        self._locate(self.external)
        coordinate = arguments.coordinate(self, "what the force acts on", coordinate)
        self.external.append((coordinate, self._expression(f"force on `{coordinate.name()}`", expression)))

    def by_hand(self, coordinate, residual, *, check_units=True):
        """Replaces the derived equation of a coordinate by a hand-written one, `residual` = 0.

        For a frozen coordinate the residual is its reaction. Without `check_units` its terms may
        have any dimension: for printed equations that are to be run with their misprints.
        """
        coordinate = arguments.coordinate(self, "what the equation is for", coordinate, motions=True)
        self.locations[id(self.hand_written), coordinate.name()] = caller_location(self.file)
        self.hand_written[coordinate.name()] = self._expression(f"equation of `{coordinate.name()}`", residual)
        if not check_units:
            self.unchecked.add(coordinate.name())

    # ---- contacts -----------------------------------------------------------------------------

    def contact(self, name, *, gap, slip=None, static=None, kinetic=None, restitution=0, tangential_restitution=0, sides=None,
                switch=False):
        """A contact: `gap` ≥ 0, and a force that pushes where it is zero.

        With `slip`, a place along the contact or its slip rate, it has Coulomb friction, `static` (`kinetic` where it is
        not given) and `kinetic`. An impact multiplies the rate of the gap by −`restitution` (Newton's law); friction impulses
        keep within the kinetic coefficient; an impact that sticks turns the slip rate back by −`tangential_restitution` times
        it. Modes, guards, impacts and rests follow; see docs/models.md.

        A gap that opens to two `sides`, as that under a body which rocks about either edge, is a coordinate that is positive on
        both; this discrete state, +1 or −1, says on which it is. It opens to the side on which the force that keeps it closed
        vanishes, and after an impact the motion goes on on the other side.

        With `switch=True` a scene may leave it out (`"contacts": {name: "off"}`), or hold it for good (`"permanent"`: it
        neither opens nor slips); there is code of its own for each, so that what is off costs nothing.
        """
        contacts.declare(self, name, gap, slip, None, static, kinetic, restitution, tangential_restitution, switch, sides)

    def friction(self, name, *, slip, normal, kinetic=None, static=None, switch=False):
        """Coulomb friction without a gap: along `slip` (a place or a rate), under the force `normal`, N. `switch` as for
        contacts."""
        contacts.declare(self, name, None, slip, normal, static, kinetic, 0, 0, switch)

    def impact(self, contact, rates, *, held=None):
        """A law of the model's own for what happens when a contact, by its name, strikes, in place of the general one: a list of
        (rate, value just after), in terms of the state just before. What it does not list stays. No gap may close after it.
        `held` is such a list for where all friction of what touched before sticks, if that is another."""
        contacts.declare_impact(self, contact, rates, held)

    def multipliers(self):
        """Contacts are held by multipliers, even where coordinates would do: as for a law of impact other than Newton's, which
        a scene may ask for."""
        self.by_multipliers = True

    def ratchet(self, name, *, rate, switch=False):
        """A one-sided constraint on a velocity, as of a ratchet or an overrunning clutch: `rate` ≥ 0, and a force along it that
        pushes it to grow where it is zero. It is linear in rates of coordinates. Where an impact, whatever strikes, would turn the
        rate round, the ratchet takes part with an impulse of its own, without restitution. `switch` as for contacts; held for
        good the rate is zero."""
        contacts.declare_ratchet(self, name, rate, switch)

    def constraint(self, name, expressions, *, switch=False):
        """A constraint that always holds: each of the expressions is zero. What depends on rates, linearly, is a constraint on a
        velocity (a blade on ice, a wheel that rolls). Its multipliers are the reactions: forces along what the expressions
        measure, positive where they push it to grow. With `switch=True` a scene may leave it out."""
        contacts.declare_constraint(self, name, expressions, switch)

    # ---- hybrid structure ---------------------------------------------------------------------

    def mode(self, name, meaning="", *, freeze=(), drift=None):
        """A mode. `freeze` lists coordinates with the value they are held at, a number or what follows from the
        parameters; without a value (or with HELD) they are held wherever they were. `drift` lists frozen coordinates with
        a constant rate (a belt) instead of rest."""
        arguments.name(self, "mode", name)
        self._text("mode", name, meaning)
        return self._mode(name, meaning, freeze, drift)

    def _mode(self, name, meaning, freeze, drift):
        if any(m.name == name for m in self.modes):
            raise self.error(f"mode `{name}` is declared twice")
        if isinstance(freeze, dict):
            raise self.error(f"mode `{name}`: `freeze` is a list, [(coordinate, value), …], not a dict")
        held = {}
        for entry in freeze if isinstance(freeze, (list, tuple)) else [freeze]:
            pair = entry if isinstance(entry, tuple) and len(entry) == 2 else (entry, HELD)
            coordinate = arguments.coordinate(self, f"mode `{name}`: what `freeze` names", pair[0])
            if coordinate.name() in held:
                raise self.error(f"mode `{name}`: `{coordinate.name()}` is frozen twice")
            held[coordinate.name()] = pair[1] if pair[1] is HELD else self._constant(
                f"mode `{name}`: where `{coordinate.name()}` is held", pair[1], coordinate.name())
        drifting = {}
        for coordinate, rate in arguments.pairs(self, f"mode `{name}`: `drift`", drift or [], "(coordinate, rate)"):
            coordinate = arguments.coordinate(self, f"mode `{name}`: what `drift` names", coordinate)
            if held.get(coordinate.name(), 0) is not HELD:
                raise self.error(f"mode `{name}`: `{coordinate.name()}` drifts, so it must be frozen as HELD")
            drifting[coordinate.name()] = self._constant(
                f"mode `{name}`: the rate of `{coordinate.name()}`", rate, coordinate.name() + ".rate")
        mode = Mode(self, name, meaning, held, drifting)
        self.modes.append(mode)
        return mode

    def transition(self, name, source, target, *, when, reset=(), provided=None, impact=False):
        """Transition `source` → `target` when the guard falls through zero.

        `reset` lists (coordinate | coordinate.rate | discrete, expression in the state before).
        `provided` (one expression or several) must be ≥ 0 for the transition to be taken; it is
        evaluated in `target` after the reset. Of several transitions with one guard the first whose condition holds is taken.
        """
        arguments.name(self, "transition", name)
        what = f"transition `{name}`"
        arguments.mode(self, f"{what}: its source", source)
        arguments.mode(self, f"{what}: its target", target)
        guard, resets = self._guard_and_resets(what, when, reset)
        conditions = [] if provided is None else provided if isinstance(provided, (list, tuple)) else [provided]
        conditions = [arguments.expression(self, f"{what}: a condition", c) for c in conditions]
        self.transitions.append(Transition(
            name, source, target, guard, ca.vertcat(*conditions) if conditions else None, resets, impact, caller_location(self.file)))

    def chart(self, name, *, when, reset):
        """Other coordinates of the same state, where those so far end, of a model with contacts: when the guard falls through zero,
        in every mode, what `reset` lists is set, in terms of the values before.

        Nothing moves by it, and it is no event: it is neither recorded nor counted. Gaps and slips must be the same before
        and after, and energies, but for their rounding; a discrete state says which coordinates they are. (A tank that rocks about one
        of two edges: an uplift angle, the place of the present edge, and which edge that is.)
        """
        arguments.name(self, "chart", name)
        guard, resets = self._guard_and_resets(f"chart `{name}`", when, reset)
        if not resets:
            raise self.error(f"chart `{name}`: `reset` is empty; it lists what the other coordinates of the same state are")
        self.charts.append((name, guard, resets, caller_location(self.file)))

    def _guard_and_resets(self, what, when, reset):
        if not isinstance(when, Falls):
            raise self.error(f"{what}: `when` must be falls(…) or rises(…)")
        resets = arguments.pairs(self, f"{what}: `reset`", reset, "(coordinate, rate or discrete state, value)")
        return arguments.expression(self, f"{what}: its guard", when.expression), [
            (symbol, arguments.expression(self, f"{what}: what {arguments.shown(symbol)} is reset to", value))
            for symbol, value in resets]

    def rest(self, source, target):
        """A mode at the limit of infinitely many events in finite time, some of which lead to `source`.

        It is entered where the limit satisfies what `target` holds: values and rates. A source may have
        several; the one that holds the most is taken, the first in the order of the file among equals. Of impacts at a stop the rest
        follows where the model has one mode for it (rests.py).
        """
        arguments.mode(self, "rest: its source", source)
        arguments.mode(self, "rest: its target", target)
        freed = [name for name in source.held if name not in target.held]
        if freed or len(target.held) == len(source.held):
            what = f"lets `{freed[0]}` move, which `{source.name}` holds" if freed else f"holds no more than `{source.name}`"
            raise self.error(f"rest of `{source.name}` in `{target.name}`: `{target.name}` {what}; what comes to rest"
                             " is held in the target, and what was held stays so")
        if (source, target) in self.rests:
            raise self.error(f"rest of `{source.name}` in `{target.name}` is declared twice")
        self.rests.append((source, target))

    def requires(self, mode, positive, failure):
        """Stops the run with the reason `failure` where `positive` is not > 0. Where `mode` is None this holds in every mode which
        has the reactions that it names, by `model.reaction(…)`."""
        if mode is not None:
            arguments.mode(self, "what a requirement is of", mode)
        arguments.text(self, "requirement: what its failure means", failure)
        requirements = self.requirements if mode is None else mode.requirements
        requirements.append(Requirement(self._expression("requirement", positive), failure, caller_location(self.file)))

    def limit(self, name, message, *, when, ends=True, modes=None):
        """A limit state: reached where the comparison `when`, such as `theta > pi / 2`, first holds.

        A run ends there, unless the scene lets it go on; one that does not end by itself (`ends=False`) is noted,
        unless the scene lets it end. Reactions are those of one mode: `modes` says in which it is watched.
        """
        location = caller_location(self.file)
        arguments.text(self, "the name of a limit", name)
        arguments.text(self, f"limit `{name}`: its message", message)
        if any(known.name == name for known in self.limits):
            raise self.error(f"limit `{name}` is declared twice")
        margin, text = limits.comparison(when, f"limit `{name}`", location)
        self.limits.append(limits.Limit(name, message, -margin, text, ends, modes, location))

    def valid(self, condition, sentence, *, modes=None):
        """A condition under which the model is meant, a comparison of parameters or of the motion, and a sentence
        that says what it assumes. A run that leaves it goes on, and says so."""
        location = caller_location(self.file)
        arguments.text(self, "valid: its sentence", sentence)
        margin, text = limits.comparison(condition, "valid", location)
        self.validity.append(limits.Validity(sentence, margin, text, modes, location))

    # ---- outputs ------------------------------------------------------------------------------

    def output(self, name, unit, expression, meaning):
        """A quantity that people look at: recorded, plotted, with its extremes, and usable in limit states.

        `expression` may hold coordinates, rates, accelerations, motions of the ground, inputs, discrete states, parameters,
        other outputs, and `model.reaction(…)`; it is smooth within a mode. Returns the expression.
        """
        arguments.name(self, "output", name)
        what = f"output `{name}`"
        self._text("output", name, meaning)
        self._declare("output", name, unit)
        value = arguments.expression(self, what, expression)
        self.outputs.append(outputs.Output(name, unit, meaning, value, caller_location(self.file)))
        return value

    def reaction(self, coordinate):
        """In outputs, limit states, validity and what every mode requires: the reaction of a coordinate or ground motion in whatever mode there is,
        0 while the coordinate is free."""
        coordinate = arguments.coordinate(self, "what a reaction is asked of", coordinate, motions=True)
        return self._reaction_placeholder(f"R({coordinate.name()})", None, coordinate.name(), {})

    # ---- drawing ------------------------------------------------------------------------------

    def draw(self, name, points, *, kind="body", radius=None, force=None, states=None, of=None, along=None):
        """A shape of the drawing that pages animate; `points` are (X, Y) in m, in the frame of the ground.

        Kinds: `body` and `liquid` (closed outlines), `line`, `spring`, `fixed` (ground or wall, hatched to the right of
        the way along it), `point` (a disc; `radius` in m), `contact` (where a body touches the ground). Of a contact
        `force` is a pair of coordinates or motions of the ground, whose reactions act at it along X and Y (or None),
        and `states` lists (mode, `closed`, `sticks` or `slides`); in other modes it is open.

        Instead, `of` names a contact, friction or constraint declared above, which has a state and forces of its own. `along`
        lists the directions (X, Y) in which its forces act on what is drawn: normal force and friction, upwards and to the
        right where nothing is said, none where the list is empty; the forces of a constraint of two expressions, to the right and upwards.
        """
        self.shapes.append(drawing.shape(
            self, name, points, kind, radius, caller_location(self.file), force, states, of, along))

    # ---- helpers ------------------------------------------------------------------------------

    def _choose(self, name, options, meaning, default=None):
        option = CONTEXT[-1].choose(name, options)
        self.choices.append((name, options, meaning, option, default or options[0]))
        return option

    def impact_velocities(self, *, before, after, prescribed, conserve):
        """Velocities after an impact that prescribes some rates and conserves some momenta.

        `before` and `after` map discrete states to their values on either side (or to symbols);
        `prescribed` lists (coordinate, rate after); `conserve` lists the coordinates whose
        ∂T/∂v is the same before and after; all others come to rest relative to the ground.
        """
        from .derive import impact_velocities
        for group, form in ((before, "(discrete state, value)"), (after, "(discrete state, value)"),
                            (prescribed, "(coordinate, rate)")):
            arguments.pairs(self, "impact_velocities: what is passed", group, form)
        prescribed = [(arguments.coordinate(self, "impact_velocities: what is prescribed", c), rate) for c, rate in prescribed]
        conserve = [arguments.coordinate(self, "impact_velocities: whose momentum is conserved", c) for c in conserve]
        return impact_velocities(self, before, after, prescribed, conserve)

    def location(self, group, index):
        """Where entry `index` of one of the lists above was declared."""
        return self.locations.get((id(group), index), self.file)

    def _locate(self, group):
        self.locations[id(group), len(group)] = caller_location(self.file)

    def error(self, message):
        """A ModelError that points at the line of the model file being run."""
        return ModelError(message, caller_location(self.file))

    def _text(self, what, name, meaning):
        arguments.text(self, f"{what} `{name}`: its meaning", meaning)

    def _declare(self, what, name, unit, of=""):
        if not of:
            arguments.name(self, what, name)
        if not isinstance(unit, str):
            raise self.error(f"`{name}`: its unit is a text such as \"m/s\", not {arguments.shown(unit)}")
        if name in self.dimensions:
            raise self.error(f"`{name}` is declared twice")
        try:
            self.dimensions[name] = units.parse(unit)
        except units.UnitError as error:
            raise self.error(f"`{name}`: {error}") from None
        self.symbols[name] = ca.SX.sym(name)
        self.locations[name] = caller_location(self.file)
        return self.symbols[name]

    def _declare_motion(self, what, name, unit):
        symbol = Coordinate(self._declare(what, name, unit))
        symbol.rate = self._declare(what, name + ".rate", unit + "/s", of=name)
        symbol.acceleration = self._declare(what, name + ".acceleration", unit + "/s^2", of=name)
        return symbol

    def _expression(self, what, value):
        return arguments.expression(self, what, value)

    def _position(self, position):
        if not isinstance(position, (list, tuple)) or len(position) != 2:
            raise self.error(f"body {len(self.bodies) + 1}: its position is {arguments.shown(position)}, not a pair (X, Y)")
        return tuple(self._expression(f"body {len(self.bodies) + 1}: position {a}", p) for a, p in zip("XY", position))

    def _constant(self, what, value, like):
        """An expression in parameters alone, of the dimension of what is called `like`; a number stays one."""
        expression = self._expression(what, value)
        own = {p.symbol.element_hash() for p in self.parameters}
        for symbol in ca.symvar(expression):
            if symbol.element_hash() not in own:
                raise self.error(f"{what}: `{symbol.name()}` is not a parameter; a value that stays the same follows from"
                                 " numbers and parameters alone")
        if not expression.is_constant():
            found = units.dimension_of(expression, self.dimensions)
            if found != self.dimensions[like]:
                raise self.error(f"{what}: `{units.short(expression)}` has the dimension {units.text(found)}, expected"
                                 f" {units.text(self.dimensions[like])}")
        return expression

    def _placeholder(self, mode, coordinate, discrete):
        coordinate = arguments.coordinate(self, f"mode `{mode.name}`: what a reaction is asked of", coordinate, motions=True)
        name = coordinate.name()
        if mode.is_free(coordinate) and all(m.name != name for m in self.motions):
            raise self.error(f"mode `{mode.name}`: coordinate `{name}` is free, it has no reaction")
        for key in discrete:
            if all(d.name != key for d in self.discretes):
                raise self.error(f"reaction of `{name}`: there is no discrete state `{key}`")
        settings = "".join(f", {k}={v:+.17g}" for k, v in sorted(discrete.items()))
        key = f"R({name}{settings})@{mode.name}"
        return self._reaction_placeholder(key, mode, name, discrete)

    def _reaction_placeholder(self, key, mode, name, discrete):
        """A symbol that stands for a reaction of a mode, or with `None` of whatever mode there is."""
        if key not in self.placeholders:
            symbol = ca.SX.sym(key)
            declaration = next(c for c in self.coordinates + self.motions if c.name == name)
            energy = units.parse("kg m^2/s^2")
            self.dimensions[key] = units.combine(energy, self.dimensions[declaration.name], -1)
            self.placeholders[key] = (symbol, mode, name, dict(discrete))
        return self.placeholders[key][0]
