"""The modes that follow from contacts: one for each set of contact states where gaps and slips solve for coordinates, which it freezes.

This is the reduced form: reactions of frozen coordinates are the forces; guards, impacts and rests follow. Constraints
freeze theirs in all modes. It is written in the coordinates of `lines.py`, where each gap and each slip is one. Inertia couples no
gap with another or with friction that follows from it: so one impact happens, whatever law decides it, and whatever closes at the same
instant. Where there is no such form, one mode serves all sets (`multipliers.py`).
"""

import itertools

import casadi as ca

from . import contact_outputs, derive, limits, lines, multipliers
from .contacts import CLOSED, OPEN, SLIDES, STICKS
from .declarations import Requirement, Transition
from .errors import ModelError
from .exact import Exact, lifted

MOST_MODES = 16
"""Most sets of contact states for which modes are generated, each with its own code."""


class NotReducible(ModelError):
    """Why contacts have no reduced form."""


def expand(model):
    """Adds the modes, transitions and rests of a model with contacts or constraints; of any other the mode in which all moves, unless
    it has modes by hand."""
    if model.contacts or model.constraints:
        why_not = _reduce(model)
        if why_not:
            _need_no_sides(model, why_not)
            multipliers.build(model)
        contact_outputs.add(model)
    elif model.charts:
        name, _, _, location = model.charts[0]
        raise ModelError(f"chart `{name}`: the model has no contacts; a change of coordinates by hand is a transition", location)
    elif not model.modes:
        meaning = "all contacts are switched off" if model.switched_off else "all coordinates are free"
        model._mode("moves", meaning, [], []).location = model.location_of_model
    _require(model)


def _reduce(model):
    """Adds the modes of the reduced form, or says why there is none."""
    if model.modes or model.charts:
        # Modes by hand have all sets of contact states each.
        return "it has modes by hand or charts"
    if model.by_multipliers:
        return "multipliers are asked for"
    bent = next((contact for contact in model.contacts if not contact.has_plain_law()), None)
    if bent is not None:
        return f"`{bent.name}` is a ratchet, has a law of its own or a tangential restitution"
    placeholders = dict(model.placeholders)
    try:
        lines.solve(model)
        _check_reactions(model)
        Expansion(model).build()
    except (NotReducible, lines.NotSolved) as why:
        model.modes, model.transitions, model.rests, model.placeholders, model.lines = [], [], [], placeholders, []
        return str(why)
    return ""


def _check_reactions(model):
    """The reaction of a coordinate that a line is solved for is the force along the line: another one than a model means that asks for
    it, or for the equations, by its name."""
    solved = {line.name for line in model.lines}
    asked = {name for _, _, name, _ in model.placeholders.values()} | model.hand_written.keys()
    for name in sorted(solved & asked):
        raise NotReducible(f"the model says what holds `{name}`, which depends on others")
    if any(contact.sides is not None for contact in model.contacts) and solved:
        raise NotReducible("a gap opens to two sides, and another line depends on several coordinates")


def _need_no_sides(model, why_not):
    """With multipliers a gap has one side."""
    for contact in model.contacts:
        if contact.sides is not None:
            raise ModelError(f"contact `{contact.name}`: a gap that opens to two sides needs a model in which every gap, slip and"
                             f" constraint is a coordinate; here {why_not}", contact.location)


def _bound(model, contact):
    """A gap is not negative: a bound of its coordinate, where the model has given none."""
    declaration = next((c for c in model.coordinates if c.name == contact.gap.name), None)
    if declaration is None:
        return
    side = "minimum" if contact.gap.sign > 0 else "maximum"
    if declaration.extra[side] is None:
        value = contact.gap.value()
        declaration.extra[side] = float(value) if value.is_constant() else value
        declaration.extra.setdefault("bounded_by_gaps", []).append(side)


class Expansion:
    """The modes of all sets of contact states that can be."""

    def __init__(self, model):
        self.model, self.contacts = model, model.contacts
        self.always_held = _constrained(model) | {line.name for c in model.contacts if c.permanent for line in (c.gap, c.slip) if line}
        self.modes = {}
        by = {line.name: line.symbol for line in model.lines}
        self.coordinates = [by.get(c.name, c.symbol) for c in model.coordinates]
        self.names = [symbol.name() for symbol in self.coordinates]
        self.mass = _mass(model)

    def build(self):
        """Adds everything to the model."""
        self._check_friction()
        self._check_impacts()
        sets = [states for states in itertools.product(*[c.states() for c in self.contacts]) if self._can_be(states)]
        if len(sets) > MOST_MODES:
            raise NotReducible(f"{len(sets)} sets of contact states")
        self.model.tied = self._tied()
        for states in sets:
            self.modes[states] = self._mode(states)
        for states in sets:
            for i, contact in enumerate(self.contacts):
                self._transitions(states, i, contact)
        for contact in self.contacts:
            if contact.gap is not None:
                _bound(self.model, contact)

    def _check_friction(self):
        """Where a gap holds a coordinate, friction along it has nothing to do, unless its partner moves. And a normal force that follows
        from the motion, and friction of something else along its gap or its slip, are not determined apart from each other. Both is
        decided by forces along each of them (`multipliers.py`)."""
        with_gap = [contact for contact in self.contacts if contact.gap is not None]
        for contact, other in itertools.product(with_gap, self.contacts):
            if other is contact:
                continue
            along_gap = other.slip is not None and other.slip.name == contact.gap.name
            if along_gap and not other.slip.offset.is_zero():
                raise NotReducible(f"friction of `{other.name}` against what moves acts along the gap of `{contact.name}`")
            lines = [line.name for line in (other.gap, other.slip) if line]
            if contact.slip is not None and (along_gap or contact.slip.name in lines):
                raise NotReducible(f"friction of `{contact.name}` and `{other.name}` acts along one coordinate")
        slips = [contact.slip.name for contact in self.contacts if contact.slip is not None and contact.gap is None]
        for contact in self.contacts:
            if contact.gap is None and slips.count(contact.slip.name) > 1:
                raise NotReducible(f"friction of `{contact.name}` and of another acts along one coordinate")

    def _tied(self):
        """Names of the contacts whose slips inertia couples with that of another, where one of them sticks with more than it slides with:
        which of several that reach their limits at one instant slip, no one of them decides alone."""
        slipping = [contact for contact in self.contacts if contact.slip is not None and not contact.permanent]
        drops = lambda contact: not Exact().is_zero(ca.SX(contact.static) - contact.kinetic)
        coupled = lambda one, other: one is not other and one.slip.name in self._moved(other.slip.name)
        return [one.name for one in slipping if any(coupled(one, other) and (drops(one) or drops(other)) for other in slipping)]

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
        for constraint in model.constraints:
            line = constraint.line
            freeze.append(line.solved if constraint.is_rate else (line.solved, line.value()))
            if constraint.is_rate and not line.offset.is_zero():
                drift.append((line.solved, line.value()))
        for contact, state in zip(self.contacts, states):
            if contact.gap and state != OPEN:
                freeze.append((contact.gap.solved, contact.gap.value()))
        for contact, state in zip(self.contacts, states):
            if state == STICKS and not self._holder(states, contact.slip.name):
                freeze.append(contact.slip.solved)
                if not contact.slip.offset.is_zero():
                    drift.append((contact.slip.solved, contact.slip.value()))
        mode = model._mode(_words(self.contacts, states), "", freeze, drift)
        mode.lines = [line for line in model.lines if line.name in mode.held]
        self._drift(mode)
        mode.location = [*self.contacts, *model.constraints][0].location
        mode.contact_states = {contact.name: state for contact, state in zip(self.contacts, states)}
        for constraint in model.constraints:
            constraint.force_of_line(mode)  # an output: reactions are known before equations are made
        for contact, state in zip(self.contacts, states):
            if state == SLIDES:
                force = -contact.kinetic * contact.normal_force(mode) * contact.slip.slope * contact.direction
                mode.forces.append((contact.slip.coordinate, force, ca.SX(contact.slip.value())))
                model.locations[id(mode.forces), len(mode.forces) - 1] = contact.location
            if not contact.permanent:
                contact.require_normal(mode)
        return mode

    def _drift(self, mode):
        """Where a line is held that was where it is, the coordinate that it is solved for was there with all others that drift."""
        x = derive.configuration(self.model)
        for line in mode.lines:
            own = mode.drift.get(line.name, ca.SX(0))
            mode.line_drift[line.name] = own
            slopes = ca.jacobian(line.rest, x.q)
            along = sum((slopes[k] * mode.drift[c.name] for k, c in enumerate(self.model.coordinates) if c.name in mode.drift), ca.SX(0))
            if mode.held[line.name] is not None or along.is_zero():
                continue
            if not limits.is_of_parameters(self.model, along):
                raise NotReducible(f"`{line.name}` is held on a line that depends on what drifts, and bends")
            mode.drift[line.name] = own - along

    def _add(self, contact, verb, states, target, when, reset=(), provided=None, impulses=None, direction=None):
        """Adds a transition, unless there is no such target; one with `impulses` is an impact."""
        target = self.modes.get(tuple(target))
        if target is None:
            return
        conditions = None if not provided else self._in_coordinates(ca.vertcat(*provided))
        self.model.transitions.append(Transition(
            f"{contact.name} {verb}", self.modes[states], target, self._in_coordinates(ca.SX(when)), conditions,
            self._reset(reset, None if impulses is None else target), impulses is not None, contact.location, direction=direction,
            impulses=impulses and {name: self._in_coordinates(impulse) for name, impulse in impulses.items()}))

    def _in_coordinates(self, expression):
        """An expression with lines and their rates in the coordinates of the model and their rates."""
        of = self.model.lines
        if not of:
            return expression
        symbols = [symbol for line in of for symbol in (line.symbol, line.symbol.rate)]
        values = [value for line in of for value in (line.value, line.rate(self.model))]
        return ca.substitute(expression, ca.vertcat(*symbols), ca.vertcat(*values))

    def _reset(self, reset, target):
        """What is reset, lines and their rates among it, in the coordinates of the model: those that lines are solved for follow. What the
        target of an impact holds is left out."""
        given = {symbol.name(): (symbol, self._in_coordinates(ca.SX(value))) for symbol, value in reset}
        x = derive.configuration(self.model)
        for line in self.model.lines:
            place, rate = line.symbol, line.symbol.rate
            if place.name() in given:
                _, value = given.pop(place.name())
                given[line.name] = (line.coordinate, value - line.rest)
            slopes = ca.jacobian(line.rest, x.q)
            along = [symbol for k, symbol in enumerate(ca.vertsplit(x.v)) if not slopes[k].is_zero()]
            if rate.name() in given or any(symbol.name() in given for symbol in along):
                _, value = given.pop(rate.name(), (None, line.rate(self.model)))
                after = ca.vertcat(*[given[s.name()][1] if s.name() in given else s for s in ca.vertsplit(x.v)])
                given[line.coordinate.rate.name()] = (line.coordinate.rate, value - slopes @ after)
        held = [symbol.element_hash() for c in self.model.coordinates if target is not None and c.name in target.held
                for symbol in (c.symbol, c.symbol.rate)]
        return [(symbol, value) for symbol, value in given.values() if symbol.element_hash() not in held]

    def _transitions(self, states, i, contact):
        """What contact `i` can do next in a mode."""
        mode, state = self.modes[states], states[i]
        with_state = lambda new: [*states[:i], new, *states[i + 1:]]
        if state == OPEN:
            if mode.is_free(contact.gap.solved):
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
            # The slip rate is zero there but for the landing's rounding; where it starts at zero exactly the guard's root is divided out.
            self._add(contact, "reverses", states, states, stops,
                      [(contact.direction, -contact.direction), (contact.slip.coordinate.rate, contact.slip.value())],
                      direction=contact.direction)

    @staticmethod
    def _holds(contact, mode):
        """By direction: what is left before static friction lets a slip begin that way."""
        limit = contact.static * contact.normal_force(mode)
        force = contact.slip.along(mode.reaction(contact.slip.solved))
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
        if contact.sides is None:
            self._add(contact, "opens", states, target, margin, reset)
            return
        for side in (+1, -1):
            margin = contact.normal_force(mode, **{contact.sides.name(): side})
            self._add(contact, "opens", states, target, margin, [(contact.sides, side)])

    # ---- impacts ----------------------------------------------------------------------------------

    def _check_impacts(self):
        """Whether an impact changes no rate that another is decided by, and whether its friction leaves its push as it is. Else laws of
        impacts differ, and several contacts at once may have several motions or none, which `multipliers.py` judges."""
        gaps = [contact for contact in self.contacts if contact.gap is not None and not contact.permanent]
        for contact in gaps:
            if contact.slip and contact.slip.name in self._moved(contact.gap.name):
                raise NotReducible(f"friction of `{contact.name}` acts on its normal force")
            changed = self._changed(contact)
            for other in gaps:
                lines = {line.name for line in (other.gap, other.slip) if line}
                if other.gap.name != contact.gap.name and lines & changed:
                    raise NotReducible(f"the impacts of `{contact.name}` and `{other.name}` act on each other")
            if contact.sides is not None and len(changed) > 1:
                raise NotReducible(f"the impact of `{contact.name}`, which opens to two sides, changes other rates")

    def _moved(self, name):
        """Names of the coordinates whose rates an impulse along one of them changes; what is always held has none."""
        found, pending = {name}, [self.names.index(name)]
        while pending:
            row = pending.pop()
            for k, other in enumerate(self.names):
                if not self.mass[row, k].is_zero() and other not in found | self.always_held:
                    found.add(other)
                    pending.append(k)
        return found

    def _changed(self, contact):
        """Names of the coordinates whose rates an impact changes."""
        return self._moved(contact.gap.name) | (self._moved(contact.slip.name) if contact.slip else set())

    def _strike(self, states, i):
        """The impacts of a gap that closes: Newton's law for its rate, Coulomb's for the impulses (Moreau 1988); whether it
        slips after it, and which way, or sticks."""
        for slip in [+1, -1, 0] if self.contacts[i].slip else [0]:
            self._outcome(states, i, slip)

    def _outcome(self, states, i, slip):
        """One way in which an impact may end: which way the contact slips (0: not)."""
        contact, names, coordinates = self.contacts[i], self.names, self.coordinates
        gap = names.index(contact.gap.name)
        along = names.index(contact.slip.name) if contact.slip else None
        prescribed = {gap: -contact.restitution * coordinates[gap].rate}
        if contact.slip and slip == 0:
            prescribed[along] = contact.slip.value()
        free = sorted({names.index(name) for name in self._changed(contact)} - prescribed.keys())
        change = {k: rate - coordinates[k].rate for k, rate in prescribed.items()}
        friction = (along, contact.gap.along(-contact.kinetic * slip * contact.slip.slope)) if slip else None
        solved = self._rates(gap, free, change, friction)
        conditions = [slip * contact.slip_rate()] if slip else []
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
        if contact.sides is not None:
            reset.append((contact.sides, -contact.sides))
        for k, other in enumerate(self.contacts):
            place = names.index(other.slip.name) if other.slip else None
            if k == i or place not in after or states[k] == OPEN or target[k] == STICKS and keeps and place == gap:
                continue
            # Friction without an impulse of its own does not hold against one.
            target[k] = SLIDES
            rate = other.slip.slope * after[place] + other.slip.offset
            # Where the impact leaves no slip rate, the direction stays as it was.
            reset.append((other.direction, other.direction * (1 - 2 * (other.direction * rate < 0))))
        impulses = self._impulses(contact, {**change, **solved})
        self._add(contact, "strikes", states, target, contact.gap.slope * contact.gap.coordinate + contact.gap.offset,
                  reset, conditions, impulses=impulses)

    def _impulses(self, striking, changes):
        """The impulses of an impact that changes rates, by their names: M Δv along the lines of what strikes and of what is always held.
        No other force is as large."""
        names, found = self.names, {}
        push = lambda line: line.along(sum((self.mass[names.index(line.name), k] * delta for k, delta in changes.items()), ca.SX(0)))
        for contact in self.contacts:
            if contact is striking or contact.permanent:
                if contact.gap is not None:
                    found[contact.impulse_name] = push(contact.gap)
                if contact.slip is not None:
                    found[contact.friction_impulse_name] = push(contact.slip)
        for constraint in self.model.constraints:
            found[constraint.impulse_name] = push(constraint.line)
        return {name: impulse for name, impulse in found.items() if not impulse.is_zero()}

    def _rates(self, gap, free, change, friction):
        """How the rates of coordinates `free` change when others do by `change`.

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
        if not size:
            return {}
        column = ca.vertcat(*rows)
        matrix = ca.densify(ca.jacobian(column, unknown))
        load = ca.substitute(column, unknown, ca.SX.zeros(size))
        solution = -(ca.inv_minor(matrix) @ load) if size > 1 else -load / matrix
        return {k: solution[n] for n, k in enumerate(free)}


def _mass(model):
    """∂²T/∂v² of all coordinates, frozen or not, those of lines among them."""
    rates = ca.vertcat(*[c.symbol.rate for c in model.coordinates])
    mass = ca.densify(ca.simplify(ca.hessian(derive.kinetic_energy(model), rates)[0]))
    if model.lines:
        along = derive.along_lines(model, model.lines)[:mass.shape[0], :mass.shape[0]]
        mass = ca.densify(ca.simplify(along.T @ mass @ along))
    numbers, size = {}, mass.shape[0]
    for i, j in itertools.product(range(size), range(size)):
        if Exact().is_zero(lifted(mass[i, j], numbers)):
            mass[i, j] = 0
    return mass


def _words(contacts, states):
    """The name of a set of contact states."""
    return ", ".join(f"{contact.name} {state}" for contact, state in zip(contacts, states)) or "moves"


def _constrained(model):
    """Names of the coordinates that constraints hold, each by one alone."""
    names = []
    for constraint in model.constraints:
        names.append(constraint.line.name)
    by_contacts = {line.name for c in model.contacts for line in (c.gap, c.slip) if line}
    if len(set(names)) < len(names) or by_contacts & set(names):
        raise NotReducible("a constraint holds a coordinate that something else holds, too")
    of_sides = {c.gap.name for c in model.contacts if c.sides is not None}
    if any(c.slip and c.slip.name in of_sides for c in model.contacts):
        raise NotReducible("friction acts along a gap that opens to two sides")
    return set(names)


def _require(model):
    """What every mode requires, in those that have the reactions it names."""
    of_any = {entry[0].element_hash(): entry for entry in model.placeholders.values() if entry[1] is None}
    coordinates = {c.name: c.symbol for c in model.coordinates + model.motions}
    for requirement in model.requirements:
        found = [of_any[s.element_hash()] for s in ca.symvar(requirement.expression) if s.element_hash() in of_any]
        names = [entry[2] for entry in found]
        modes = [mode for mode in model.modes if set(names) <= mode.held.keys() | {m.name for m in model.motions}]
        if not modes:
            raise ModelError(f"what every mode requires: {' and '.join(f'`{n}`' for n in names)} {'is' if len(names) == 1 else 'are'}"
                             " free in each, so that there is no reaction", requirement.location)
        for mode in modes:
            own = [mode.reaction(coordinates[name]) for name in names]
            expression = ca.substitute([requirement.expression], [entry[0] for entry in found], own)[0]
            mode.requirements.append(Requirement(expression, requirement.failure, requirement.location))
