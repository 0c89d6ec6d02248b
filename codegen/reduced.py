"""The modes that follow from contacts: one for each set of contact states where gaps and slips solve for coordinates, which it freezes.

This is the reduced form: reactions of frozen coordinates are the forces; guards, impacts (Newton's law) and rests follow. Constraints
freeze theirs in all modes. Where there is no such form, one mode serves all sets (`multipliers.py`). It is written in the coordinates
of `lines.py`, where each gap and each slip is one.
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
    """Adds the modes, transitions and rests of a model with contacts or constraints; those of any other stay as they are."""
    if model.contacts or model.constraints:
        why_not = _reduce(model)
        if why_not:
            _need_no_sides(model, why_not)
            multipliers.build(model)
        contact_outputs.add(model)
    elif model.charts:
        name, _, _, location = model.charts[0]
        raise ModelError(f"chart `{name}`: the model has no contacts; a change of coordinates by hand is a transition", location)
    elif model.switched_off and not model.modes:
        model._mode("moves", "all contacts are switched off", [], []).location = model.location_of_model
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


class Expansion:
    """The modes of all sets of contact states that can be."""

    def __init__(self, model):
        self.model, self.contacts = model, model.contacts
        self.constrained = _constrained(model)
        self.modes = {}
        by = {line.name: line.symbol for line in model.lines}
        self.coordinates = [by.get(c.name, c.symbol) for c in model.coordinates]
        self.names = [symbol.name() for symbol in self.coordinates]
        self.mass = _mass(model)

    def build(self):
        """Adds everything to the model."""
        self._check_friction()
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
                force = -contact.kinetic * contact.normal_force(mode) * contact.slip.sign * contact.direction
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

    def _add(self, contact, verb, states, target, when, reset=(), provided=None, impact=False, direction=None):
        target = self.modes.get(tuple(target))
        if target is None:
            return
        conditions = None if not provided else self._in_coordinates(ca.vertcat(*provided))
        self.model.transitions.append(Transition(
            f"{contact.name} {verb}", self.modes[states], target, self._in_coordinates(ca.SX(when)), conditions,
            self._reset(reset, target if impact else None), impact, contact.location, direction=direction))

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
        force = contact.slip.sign * mode.reaction(contact.slip.solved)
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

    def _strike(self, states, i):
        """The impacts of a gap that closes: Newton's law for its rate, Coulomb's for the impulses (Moreau 1988)."""
        contact = self.contacts[i]
        pressed, loose, beyond = self._reached(states, contact)
        if len(pressed) > 1 or pressed and (contact.slip or pressed[0].slip):
            raise NotReducible(f"the impact of `{contact.name}` acts on several contacts with friction")
        if contact.sides is not None and (pressed or loose):
            raise NotReducible(f"the impact of `{contact.name}`, which opens to two sides, changes other rates")
        slides = [+1, -1] if contact.slip else []
        ways = [(opens, slip) for opens in ([True, False] if pressed else [False]) for slip in slides + [0]]
        for opens, slip in ways:
            self._outcome(states, i, (pressed, sorted(loose + beyond) if opens else loose), opens, slip)

    def _reached(self, states, contact):
        """The closed contacts that an impulse at a gap acts on, the coordinates whose rates it changes besides, and those whose rates
        it changes where such a contact opens."""
        names, beyond = self.names, set()
        start = names.index(contact.gap.name)
        pressed, loose = self._moved(states, [start])
        if pressed:
            # Each may open, and pass the impulse on.
            opened = [names.index(other.gap.name) for other in pressed]
            behind, more = self._moved(states, [start, *opened])
            if behind:
                raise NotReducible(f"the impact of `{contact.name}` acts on contacts behind others")
            beyond = set(more) - set(loose)
        if contact.slip and names.index(contact.slip.name) not in loose:
            loose.append(names.index(contact.slip.name))
        return pressed, sorted(loose), sorted(beyond)

    def _moved(self, states, rows):
        """The closed contacts that impulses along some coordinates act on, and the coordinates besides whose rates they change."""
        found, pressed, loose, pending = set(rows), [], [], list(rows)
        while pending:
            row = pending.pop()
            for k, name in enumerate(self.names):
                if k in found or self.mass[row, k].is_zero() or name in self.constrained:
                    continue
                found.add(k)
                holder = self._holder(states, name)
                if holder is not None:
                    pressed.append(holder)
                else:
                    loose.append(k)
                    pending.append(k)
        return pressed, loose

    def _outcome(self, states, i, reached, opens, slip):
        """One way in which an impact may end: whether the pressed contact opens, and which way this one slips (0: not)."""
        contact, (pressed, loose) = self.contacts[i], reached
        pushed = pressed[0] if pressed else None
        names, coordinates = self.names, self.coordinates
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
        if contact.sides is not None:
            reset.append((contact.sides, -contact.sides))
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


def _mass(model):
    """∂²T/∂v² of all coordinates, frozen or not, those of lines among them."""
    rates = ca.vertcat(*[c.symbol.rate for c in model.coordinates])
    mass = ca.densify(ca.simplify(ca.hessian(derive.kinetic_energy(model), rates)[0]))
    if not model.lines:
        return mass
    along = derive.along_lines(model, model.lines)
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
