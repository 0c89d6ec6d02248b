"""Contacts and friction, declared once: the modes, guards, impacts and rests that follow.

A contact has a gap g ≥ 0 with a normal force λ_N ≥ 0, one of which is zero; with a slip it has Coulomb friction, static and
kinetic. Friction without a gap acts all the time, under a normal force that the model gives. Where gaps
and slips are coordinates the reduced form is built, in which a mode is a set of contact states that freezes them, and its
reactions are the forces; else the form with multipliers (`multipliers.py`). (J. J. Moreau 1988, Unilateral contact and dry
friction in finite freedom dynamics.)

Signs: λ_N pushes the gap open; λ_T acts along the slip; a direction is the sign of the slip rate.
"""

import itertools
from dataclasses import dataclass, field

import casadi as ca

from . import arguments, contact_outputs, derive, graph, limits, multipliers, units
from .declarations import Transition
from .errors import ModelError, caller_location

OPEN, CLOSED, STICKS, SLIDES = "open", "closed", "sticks", "slides"

MOST_MODES = 16
"""Most sets of contact states for which modes are generated, each with its own code."""


@dataclass
class Line:
    """A number that is, but for its sign, one coordinate or its rate and what parameters add: sign × coordinate + offset."""

    coordinate: ca.SX
    sign: int
    offset: ca.SX

    @property
    def name(self):
        """The name of the coordinate."""
        return self.coordinate.name()

    def value(self):
        """The coordinate (or its rate) where the number is zero."""
        return -self.sign * self.offset


class NotReducible(ModelError):
    """Why contacts have no reduced form."""


@dataclass
class Smooth:
    """A gap, or a slip, that is any smooth function of the coordinates."""


@dataclass
class Contact:
    """A contact, or friction without a gap (`gap` is None, `normal` given). Gap and slip are `Line`s where they are coordinates,
    else `Smooth`."""

    name: str
    gap: object
    gap_expression: ca.SX
    slip: object
    slip_expression: ca.SX
    slips_by_rate: bool
    normal: ca.SX
    static: ca.SX
    kinetic: ca.SX
    restitution: ca.SX
    tangential_restitution: ca.SX
    direction: ca.SX
    location: str
    permanent: bool = False
    law: list = field(default_factory=list)
    """The rates after its impacts that the model states, as (coordinate, rate)."""
    held: list = field(default_factory=list)
    """Of a permanent contact in the form with multipliers, the constraints that hold it: its gap, its slip rate."""

    def states(self):
        """What it can do."""
        slipping = [STICKS, SLIDES] if self.slip else [CLOSED]
        return slipping[:1] if self.permanent else ([OPEN] if self.gap else []) + slipping

    def hold(self, model):
        """Makes the constraints of a permanent contact."""
        if self.gap is not None:
            self.held.append(multipliers.Constraint(f"{self.name}.gap", self.gap_expression, self.location, force=f"{self.name}.normal"))
        if self.slip is not None:
            rate = self.slip_rate_of(derive.configuration(model))
            self.held.append(multipliers.Constraint(f"{self.name}.slip", rate, self.location, True, force=f"{self.name}.friction"))

    def is_reducible(self):
        """Whether its gap and its slip are coordinates, and its impacts are Newton's without a slip that turns back."""
        plain = self.permanent or not self.law and self.tangential_restitution.is_zero()
        return plain and isinstance(self.gap, Line | None) and isinstance(self.slip, Line | None)

    def slip_rate_of(self, x):
        """The slip rate as an expression in coordinates and rates (`derive.Configuration`)."""
        return self.slip_expression if self.slips_by_rate else ca.jtimes(self.slip_expression, x.q, x.v)

    def slip_rate(self):
        """Positive along the slip."""
        return self.slip.sign * self.slip.coordinate.rate + self.slip.offset

    def normal_force(self, mode):
        """λ_N in a mode where it is closed."""
        return self.normal if self.gap is None else self.gap.sign * mode.reaction(self.gap.coordinate)


# ---- declarations ---------------------------------------------------------------------------------


ON, OFF, PERMANENT = "on", "off", "permanent"


def switched(model, kind, name, switch):
    """Which option of a contact or a constraint that scenes may switch is being built."""
    if not switch:
        return ON
    options = [ON, OFF] if kind == "constraint" else [ON, OFF, PERMANENT]
    meaning = f"{kind} `{name}`: as declared, left out" + ("" if kind == "constraint" else ", or held for good")
    chosen = model._choose(f"contacts.{name}", options, meaning)
    if chosen == OFF:
        model.switched_off.append((name, kind))
    return chosen


def declare(model, name, gap, slip, normal, static, kinetic, restitution, tangential_restitution, switch):
    """Adds a contact to a model; see `Model.contact` and `Model.friction`."""
    kind = "friction" if gap is None else "contact"
    what = f"{kind} `{name}`"
    arguments.name(model, kind, name)
    if any(known.name == name for known in model.contacts):
        raise model.error(f"{what}: there is a contact or a friction of this name above")
    chosen = switched(model, kind, name, switch)
    of = lambda key, value: arguments.expression(model, f"{what}: {key}", value)
    gap_expression = None if gap is None else _of_motion(model, f"{what}: its gap", of("its gap", gap), rates=False)
    if slip is None and (static is not None or kinetic is not None):
        raise model.error(f"{what}: it has friction but no `slip`: give the place or the rate along which it slips")
    if slip is None and tangential_restitution != 0:
        raise model.error(f"{what}: `tangential_restitution` is given, but no `slip` that it would turn back")
    slip_expression = None
    if slip is not None:
        if kinetic is None:
            raise model.error(f"{what}: `slip` is given, but no coefficient `kinetic`; without friction leave `slip` out")
        slip_expression = _of_motion(model, f"{what}: its slip", of("its slip", slip), rates=True)
    kinetic = None if kinetic is None else of("`kinetic`", kinetic)
    static = kinetic if static is None else of("`static`", static)
    rates = ca.vertcat(*[c.symbol.rate for c in model.coordinates + model.motions])
    by_rate = slip_expression is not None and bool(rates.numel()) and ca.depends_on(slip_expression, rates)
    gap = None if gap is None else as_line(model, gap_expression, False) or Smooth()
    slip = None if slip is None else _slip_line(model, slip_expression, by_rate) or Smooth()
    for known in model.contacts:
        lines = isinstance(slip, Line) and isinstance(known.slip, Line) and gap is None and known.gap is None
        if lines and known.slip.name == slip.name:
            raise model.error(f"{what}: `{known.name}` slips along `{slip.name}` too; of two friction forces along one coordinate"
                              " only the sum is determined: declare one friction with the sum of both")
    if chosen == OFF:
        return
    direction = None if slip is None or chosen == PERMANENT else model.discrete(
        f"{name}_direction", (+1, -1), f"sign of the slip rate of `{name}` when it slides")
    if direction is not None:
        model.discretes[-1].extra["of_contacts"] = True
    model.contacts.append(Contact(
        name, gap, gap_expression, slip, slip_expression, by_rate, None if normal is None else of("`normal`", normal), static,
        kinetic, of("`restitution`", restitution), of("`tangential_restitution`", tangential_restitution), direction,
        caller_location(model.file), chosen == PERMANENT))


def declare_impact(model, name, rates):
    """Adds a law of the model's own for the impacts of a contact; see `Model.impact`."""
    contact = next((c for c in model.contacts if c.name == name and c.gap is not None), None)
    if contact is None and (name, "contact") not in model.switched_off:
        known = ", ".join(f"`{c.name}`" for c in model.contacts if c.gap is not None) or "none"
        raise model.error(f"impact: there is no contact `{name}` with a gap above (contacts: {known})")
    if contact is not None and contact.law:
        raise model.error(f"impact of `{name}`: its law is stated twice")
    law = []
    declared = {c.symbol.rate.element_hash(): c for c in model.coordinates}
    places = [s for c in model.coordinates + model.motions for s in (c.symbol, c.symbol.rate)]
    allowed = {s.element_hash() for s in [*places, *(p.symbol for p in model.parameters)]}
    for rate, value in arguments.pairs(model, f"impact of `{name}`: its rates", rates, "(rate, value just after)"):
        of = declared.get(rate.element_hash()) if isinstance(rate, ca.SX) else None
        if of is None:
            raise model.error(f"impact of `{name}`: {arguments.shown(rate)} is not the rate of a coordinate")
        what = f"impact of `{name}`: `{of.name}.rate`"
        value = arguments.expression(model, what, value)
        for symbol in ca.symvar(value):
            if symbol.element_hash() not in allowed:
                raise model.error(f"{what} depends on `{symbol.name()}`; it depends on coordinates, rates, motions of the ground and"
                                  " parameters alone")
        operation = graph.non_smooth_operation(value, [p.symbol for p in model.parameters])
        if operation:
            raise model.error(f"{what}: `{operation}` is not smooth")
        try:
            units.dimension_of(value - rate, model.dimensions)
        except units.UnitError as error:
            raise model.error(f"{what}: {error}") from None
        law.append((of.symbol, value))
    if not law:
        raise model.error(f"impact of `{name}`: it lists no rates")
    # A contact that is switched off, or held for good, has no impacts.
    if contact is not None and not contact.permanent:
        contact.law = law


def declare_constraint(model, name, expressions, switch):
    """Adds a constraint to a model; see `Model.constraint`."""
    arguments.name(model, "constraint", name)
    chosen = switched(model, "constraint", name, switch)
    if any(known.name == name or known.name.startswith(f"{name}.") for known in [*model.constraints, *model.contacts]):
        raise model.error(f"constraint `{name}`: there is a contact, a friction or a constraint of this name above")
    listed = list(expressions) if isinstance(expressions, (list, tuple)) else [expressions]
    for k, expression in enumerate(listed):
        own = name if len(listed) == 1 else f"{name}.{k + 1}"
        what = f"constraint `{own}`"
        expression = _of_motion(model, what, arguments.expression(model, what, expression), rates=False)
        if chosen == OFF:
            continue
        model.constraints.append(multipliers.Constraint(own, expression, caller_location(model.file)))


def _of_motion(model, what, expression, rates):
    """An expression in coordinates, motions of the ground and parameters, and in `rates` where these are allowed."""
    places = [c.symbol for c in model.coordinates + model.motions]
    allowed = {s.element_hash() for s in [*places, *(p.symbol for p in model.parameters)]}
    allowed |= {s.rate.element_hash() for s in places} if rates else set()
    for symbol in ca.symvar(expression):
        if symbol.element_hash() not in allowed:
            raise model.error(f"{what}, `{units.short(expression)}`, depends on `{symbol.name()}`; it depends on coordinates"
                              f"{', rates' if rates else ''}, motions of the ground and parameters alone")
    operation = graph.non_smooth_operation(expression, [p.symbol for p in model.parameters])
    if operation:
        raise model.error(f"{what}, `{units.short(expression)}`: `{operation}` is not smooth; declare one contact or constraint for each"
                          " smooth piece")
    try:
        units.dimension_of(expression, model.dimensions)
    except units.UnitError as error:
        raise model.error(f"{what}: {error}") from None
    moving = ca.vertcat(*[e for c in model.coordinates for e in (c.symbol, c.symbol.rate)])
    if not moving.numel() or not ca.depends_on(expression, moving):
        raise model.error(f"{what}, `{units.short(expression)}`, does not depend on any coordinate")
    return expression


def as_line(model, expression, of_rates):
    """An expression as a coordinate, or a rate, and what parameters add; None where it is not."""
    symbols = [c.symbol for c in model.coordinates]
    column = ca.vertcat(*[s.rate if of_rates else s for s in symbols])
    slopes = ca.densify(ca.jacobian(expression, column))
    moving = [i for i in range(len(symbols)) if not slopes[i].is_zero()]
    if len(moving) == 1 and slopes[moving[0]].is_constant() and abs(float(slopes[moving[0]])) == 1:
        offset = ca.substitute(expression, column[moving[0]], 0)
        if limits.is_of_parameters(model, offset):
            line = Line(symbols[moving[0]], int(float(slopes[moving[0]])), offset)
            model._constant("where it is zero", line.value(), line.name + (".rate" if of_rates else ""))
            return line
    return None


def _slip_line(model, expression, by_rate):
    """The slip rate as a line, from itself or from the place along which a contact slips."""
    line = as_line(model, expression, by_rate)
    return line if by_rate or line is None else Line(line.coordinate, line.sign, ca.SX(0))


def _bound(model, contact):
    """A gap is not negative: a bound of its coordinate, where the model has given none."""
    declaration = next(c for c in model.coordinates if c.name == contact.gap.name)
    side = "minimum" if contact.gap.sign > 0 else "maximum"
    if declaration.extra[side] is None:
        value = contact.gap.value()
        declaration.extra[side] = float(value) if value.is_constant() else value


# ---- modes ----------------------------------------------------------------------------------------


def expand(model):
    """Adds the modes, transitions and rests of a model with contacts or constraints; those of any other stay as they are."""
    if not model.contacts and not model.constraints:
        if model.switched_off and not model.modes:
            model._mode("moves", "all contacts are switched off", [], []).location = model.location_of_model
        return
    if model.modes:
        raise ModelError("the model has contacts and modes by hand; contacts make all modes: leave `model.mode(…)` out, or write"
                         " all of it by hand", model.modes[0].location)
    if not _reduce(model):
        multipliers.build(model)
    contact_outputs.add(model)


def _reduce(model):
    """Adds the modes of the reduced form; whether there is one."""
    if model.by_multipliers or model.constraints or not all(contact.is_reducible() for contact in model.contacts):
        return False
    try:
        Expansion(model).build()
    except NotReducible:
        model.modes, model.transitions, model.rests, model.placeholders = [], [], [], {}
        return False
    return True


class Expansion:
    """The modes of all sets of contact states that can be."""

    def __init__(self, model):
        self.model, self.contacts = model, model.contacts
        self.modes = {}
        self.mass = _mass(model)

    def build(self):
        """Adds everything to the model."""
        sets = [states for states in itertools.product(*[c.states() for c in self.contacts]) if self._can_be(states)]
        if len(sets) > MOST_MODES:
            raise NotReducible(f"{len(sets)} sets of contact states")
        for states in sets:
            self.modes[states] = self._mode(states)
        for states in sets:
            for i, contact in enumerate(self.contacts):
                self._transitions(states, i, contact)
        for contact in self.contacts:
            if contact.gap is not None:
                _bound(self.model, contact)

    def _can_be(self, states):
        """A coordinate is where one gap is zero, not two; friction along it holds nothing there."""
        closed = [c.gap.name for c, s in zip(self.contacts, states) if c.gap and s != OPEN]
        slides = [c.slip.name for c, s in zip(self.contacts, states) if s == SLIDES]
        return len(set(closed)) == len(closed) and not set(closed) & set(slides)

    def _holder(self, states, coordinate):
        """The closed contact that holds a coordinate."""
        return next((c for c, s in zip(self.contacts, states) if c.gap and s != OPEN and c.gap.name == coordinate), None)

    def _mode(self, states):
        model, freeze, drift = self.model, [], []
        for contact, state in zip(self.contacts, states):
            if contact.gap and state != OPEN:
                freeze.append((contact.gap.coordinate, contact.gap.value()))
        for contact, state in zip(self.contacts, states):
            if state == STICKS and not self._holder(states, contact.slip.name):
                freeze.append(contact.slip.coordinate)
                if not contact.slip.offset.is_zero():
                    drift.append((contact.slip.coordinate, contact.slip.value()))
        mode = model._mode(_words(self.contacts, states), "", freeze, drift)
        mode.location = self.contacts[0].location
        mode.contact_states = {contact.name: state for contact, state in zip(self.contacts, states)}
        for contact, state in zip(self.contacts, states):
            if state == SLIDES:
                mode.friction(contact.slip.coordinate, normal=contact.normal_force(mode), coefficient=contact.kinetic,
                              direction=contact.slip.sign * contact.direction, against=contact.slip.value())
                model.locations[id(mode.forces), len(mode.forces) - 1] = contact.location
            if contact.gap is None and not contact.permanent:
                self._require_normal(mode, contact)
        return mode

    def _require_normal(self, mode, contact):
        """Friction without a gap ends where its normal force pulls; one of parameters alone is what it is."""
        if not limits.is_of_parameters(self.model, contact.normal):
            mode.requirements.append((contact.normal, f"the normal force of `{contact.name}` would pull", contact.location))

    def _add(self, contact, verb, states, target, when, reset=(), provided=None, impact=False):
        target = self.modes.get(tuple(target))
        if target is None:
            return
        conditions = None if not provided else ca.vertcat(*provided)
        self.model.transitions.append(Transition(
            f"{contact.name} {verb}", self.modes[states], target, ca.SX(when), conditions,
            [(symbol, ca.SX(value)) for symbol, value in reset], impact, contact.location))

    def _transitions(self, states, i, contact):
        """What contact `i` can do next in a mode."""
        mode, state = self.modes[states], states[i]
        with_state = lambda new: [*states[:i], new, *states[i + 1:]]
        if state == OPEN:
            if mode.is_free(contact.gap.coordinate):
                self._strike(states, i)
                for rest in contact.states()[1:]:
                    self._rest(states, self._joined(with_state(rest), contact))
            return
        if contact.gap:
            self._opens(states, i, with_state)
        if state == STICKS and not self._holder(states, contact.slip.name):
            for direction, margin in self._holds(contact, mode).items():
                self._add(contact, "slips", states, with_state(SLIDES), margin, [(contact.direction, direction)])
        if state == SLIDES:
            stops = contact.direction * contact.slip_rate()
            sticking = self.modes.get(tuple(with_state(STICKS)))
            if sticking is not None:
                self._add(contact, "sticks", states, with_state(STICKS), stops,
                          provided=list(self._holds(contact, sticking).values()))
            self._add(contact, "reverses", states, states, stops, [(contact.direction, -contact.direction)])

    @staticmethod
    def _holds(contact, mode):
        """By direction: what is left before static friction lets a slip begin that way."""
        limit = contact.static * contact.normal_force(mode)
        force = contact.slip.sign * mode.reaction(contact.slip.coordinate)
        return {+1: limit + force, -1: limit - force}

    def _joined(self, states, contact):
        """The states once `contact` has closed: friction along the coordinate of its gap has nothing left to do."""
        return [STICKS if c.slip and c.slip.name == contact.gap.name and s == SLIDES and c is not contact else s
                for c, s in zip(self.contacts, states)]

    def _rest(self, states, target):
        source, target = self.modes[states], self.modes.get(tuple(target))
        if target is not None and set(source.held) < set(target.held):
            self.model.rests.append((source, target))

    def _opens(self, states, i, with_state):
        """The contact pushes; friction along its own gap may pull."""
        contact, mode = self.contacts[i], self.modes[states]
        target, margin, reset = with_state(OPEN), contact.normal_force(mode), []
        for k, other in enumerate(self.contacts):
            if k != i and other.slip and other.slip.name == contact.gap.name:
                margin = margin + other.static * other.normal_force(mode)
                target[k] = SLIDES
                reset.append((other.direction, contact.gap.sign * other.slip.sign))
        self._add(contact, "opens", states, target, margin, reset)

    # ---- impacts ----------------------------------------------------------------------------------

    def _strike(self, states, i):
        """The impacts of a gap that closes: Newton's law for its rate, Coulomb's for the impulses (Moreau 1988)."""
        contact = self.contacts[i]
        pressed, loose = self._reached(states, contact)
        if len(pressed) > 1 or pressed and (contact.slip or pressed[0].slip):
            raise NotReducible(f"the impact of `{contact.name}` acts on several contacts with friction")
        slides = [+1, -1] if contact.slip else []
        ways = [(opens, slip) for opens in ([True, False] if pressed else [False]) for slip in slides + [0]]
        for opens, slip in ways:
            self._outcome(states, i, (pressed, loose), opens, slip)

    def _reached(self, states, contact):
        """The closed contacts that an impulse at a gap acts on, and the coordinates whose rates it changes besides."""
        names = [c.name for c in self.model.coordinates]
        start = names.index(contact.gap.name)
        found, pressed, loose, pending = {start}, [], [], [start]
        while pending:
            row = pending.pop()
            for k in range(len(names)):
                if k in found or self.mass[row, k].is_zero():
                    continue
                found.add(k)
                holder = self._holder(states, names[k])
                if holder is not None:
                    pressed.append(holder)
                else:
                    loose.append(k)
                    pending.append(k)
        if contact.slip and names.index(contact.slip.name) not in loose:
            loose.append(names.index(contact.slip.name))
        return pressed, sorted(loose)

    def _outcome(self, states, i, reached, opens, slip):
        """One way in which an impact may end: whether the pressed contact opens, and which way this one slips (0: not)."""
        contact, (pressed, loose) = self.contacts[i], reached
        pushed = pressed[0] if pressed else None
        names = [c.name for c in self.model.coordinates]
        coordinates = [c.symbol for c in self.model.coordinates]
        gap = names.index(contact.gap.name)
        along = names.index(contact.slip.name) if contact.slip else None
        free = list(loose) + ([names.index(pushed.gap.name)] if opens else [])
        prescribed = {gap: -contact.restitution * coordinates[gap].rate}
        if contact.slip and slip == 0:
            free.remove(along)
            prescribed[along] = contact.slip.value()
        change = {k: rate - coordinates[k].rate for k, rate in prescribed.items()}
        friction = (along, -contact.kinetic * slip * contact.slip.sign * contact.gap.sign) if slip else None
        solved, _ = self._rates(gap, free, change, friction)
        conditions = []
        if slip:
            conditions.append(slip * contact.slip_rate())
            # A push that friction turns against itself has no such outcome (a self-locking wedge).
            unit = {k: ca.SX(1 if k == gap else 0) for k in change}
            _, push = self._rates(gap, free, unit, friction)
            if not push.is_constant() and not self.mass[gap, along].is_zero():
                conditions.append(push)
        target = list(states)
        keeps = contact.restitution.is_zero()
        if keeps:
            target[i] = CLOSED if not contact.slip else SLIDES if slip else STICKS
            target = self._joined(target, contact)
        reset = [(contact.gap.coordinate, contact.gap.value())]
        after = {**{k: coordinates[k].rate + delta for k, delta in solved.items()}, **prescribed}
        reset += [(coordinates[k].rate, after[k]) for k in sorted(after)]
        if slip:
            reset.append((contact.direction, slip))
        if opens:
            target[self.contacts.index(pushed)] = OPEN
            conditions.append(pushed.gap.sign * pushed.gap.coordinate.rate)
        for k, other in enumerate(self.contacts):
            place = names.index(other.slip.name) if other.slip else None
            if k == i or place not in after or states[k] == OPEN or target[k] == STICKS and keeps and place == gap:
                continue
            # Friction without an impulse of its own does not hold against one.
            target[k] = SLIDES
            rate = other.slip.sign * after[place] + other.slip.offset
            # Where the impact leaves no slip rate, the direction stays as it was.
            reset.append((other.direction, other.direction * (1 - 2 * (other.direction * rate < 0))))
        if keeps:
            held = self.modes.get(tuple(target))
            reset = [(s, v) for s, v in reset if not _is_held(held, s)]
        self._add(contact, "strikes", states, target, contact.gap.sign * contact.gap.coordinate + contact.gap.offset,
                  reset, conditions, impact=True)

    def _rates(self, gap, free, change, friction):
        """How the rates of coordinates `free` change when others do by `change`, and the push that it takes on the gap.

        Momentum: M Δv is zero along what is free, but for the friction impulse, a multiple of the push M Δv along the gap.
        """
        mass, size = self.mass, len(free)
        unknown = ca.vertcat(*[ca.SX.sym(f"change{k}") for k in range(size)]) if size else ca.SX(0, 1)
        deltas = {**change, **{k: unknown[n] for n, k in enumerate(free)}}
        impulse = lambda row: sum((mass[row, k] * delta for k, delta in deltas.items()), ca.SX(0))
        rows = []
        for k in free:
            force = friction[1] * impulse(gap) if friction and friction[0] == k else 0
            rows.append(impulse(k) - force)
        solved = {}
        if size:
            column = ca.vertcat(*rows)
            matrix = ca.densify(ca.jacobian(column, unknown))
            load = ca.substitute(column, unknown, ca.SX.zeros(size))
            solution = -(ca.inv_minor(matrix) @ load) if size > 1 else -load / matrix
            solved = {k: solution[n] for n, k in enumerate(free)}
        push = impulse(gap)
        if size:
            push = ca.substitute(push, unknown, ca.vertcat(*[solved[k] for k in free]))
        return solved, push


def _is_held(mode, symbol):
    """Whether a reset of a coordinate or a rate is what a mode holds anyway."""
    return mode is not None and any(
        c.symbol.element_hash() == symbol.element_hash() or c.symbol.rate.element_hash() == symbol.element_hash()
        for c in mode.model.coordinates if c.name in mode.held)


def _mass(model):
    """∂²T/∂v² of all coordinates, frozen or not."""
    from .derive import kinetic_energy
    rates = ca.vertcat(*[c.symbol.rate for c in model.coordinates])
    return ca.densify(ca.simplify(ca.hessian(kinetic_energy(model), rates)[0]))


def _words(contacts, states):
    """The name of a set of contact states."""
    return ", ".join(f"{contact.name} {state}" for contact, state in zip(contacts, states))
