"""Contacts, friction and constraints by multipliers: one mode serves all sets of contact states. Of a model with modes by hand each of
them does, with its own forces and transitions.

    M q̈ + h = W_N λ_N + W_T λ_T + Gᵀ λ_C

A multiplier is the acceleration of a coordinate on which nothing depends (C. W. Gear 1988: an algebraic variable that is
replaced by a derivative lowers the index), so its rate is the impulse delivered so far, and the mode's equations are

    r = M q̈ + h − W λ,    c g̈ + (1 − c) λ_N,    s γ̇ + (1 − s) (λ_T + μ_k d λ_N − l L),    φ̈

where the discrete states of each contact choose its rows: c, whether it is closed; d, the direction in which it slides, 0 where it
sticks; s = c (1 − d²), but 0 where the tangent is dropped because others hold it already. Then its friction is not determined:
it is none, or the most that it can hold, L = μ_s λ_N, in the direction l. The matrix of r is neither symmetric
nor definite; it is the same at all orders of a series. Which set follows an event is decided in src/hybrid/contact/.

Signs: λ_N pushes the gap g open; λ_T acts along the slip, whose rate is γ; λ_C acts where φ grows.
"""

import itertools
import random
from dataclasses import dataclass, field

import casadi as ca
import numpy as np

from . import derive, graph, limits, units
from .declarations import Declaration, Impulse, Transition
from .errors import Contradiction, ModelError

MOST_CONTACTS = 16
"""Most contacts of a model: each two of them with friction have a discrete state, which says whether one holds the other."""


@dataclass
class Constraint:
    """φ(q, t) = 0, one equation of it."""

    name: str
    expression: ca.SX
    location: str
    is_rate: bool = False
    """Whether the expression is a rate that is zero, not a place."""
    multiplier: object = None
    force: str = ""
    """Name of its multiplier, if it is that of a contact."""
    line: object = None
    """In the reduced form, the coordinate that it holds, or the rate."""

    @property
    def impulse_name(self):
        """Name of its impulse."""
        return f"{self.force}_impulse" if self.force else f"{self.name}.impulse"

    def force_of_line(self, mode):
        """Its force in a mode of the reduced form."""
        return self.line.along(mode.reaction(self.line.solved))

    def gradient(self, places, rates):
        """How what it holds changes with coordinates, or with their rates."""
        return ca.densify(ca.jacobian(self.expression, rates if self.is_rate else places))


@dataclass
class Form:
    """The multipliers and discrete states of a model's contacts and constraints."""

    contacts: list
    constraints: list
    normals: list = field(default_factory=list)
    tangents: list = field(default_factory=list)
    closed: list = field(default_factory=list)
    directions: list = field(default_factory=list)
    shares: list = field(default_factory=list)
    """Of contacts, then of constraints."""
    dropped: list = field(default_factory=list)
    at_limit: list = field(default_factory=list)
    joined: dict = field(default_factory=dict)
    idle: list = field(default_factory=list)
    """Multipliers that other choices use."""

    def discretes(self):
        """The discrete states that choose rows."""
        all_of_them = [*self.closed, *self.directions, *self.shares, *self.dropped, *self.at_limit, *self.joined.values()]
        return [symbol for symbol in all_of_them if symbol is not None]

    def equations(self, *arguments):
        """The equations of the mode."""
        return MultiplierEquations(self, *arguments)


def build(model):
    """Adds contacts and constraints that are held by multipliers to each mode of a model, or to the one that it needs."""
    for mode in model.modes:
        if mode.held:
            raise ModelError(f"mode `{mode.name}` freezes `{next(iter(mode.held))}`: beside contacts and constraints all coordinates are free;"
                             " what holds one is a contact, a friction or a constraint, too", mode.location)
    for contact in model.contacts:
        if contact.permanent:
            contact.hold(model)
    contacts = [contact for contact in model.contacts if not contact.permanent]
    constraints = list(model.constraints)
    for contact in model.contacts:
        for constraint in list(contact.held):
            # Of two that stick side by side the sum of the forces is determined: the first has it.
            if constraint.is_rate and _rank(model, [*constraints, constraint]) == len(constraints):
                contact.held.remove(constraint)
            else:
                constraints.append(constraint)
    if len(contacts) > MOST_CONTACTS:
        raise ModelError(f"the model has {len(contacts)} contacts; at most {MOST_CONTACTS} are: leave out contacts"
                         " that the model does not need", contacts[MOST_CONTACTS].location)
    _check_independent(model, constraints)
    form = Form(contacts, constraints)
    for contact in contacts:
        form.normals.append(None if contact.gap is None else _multiplier(
            model, contact.force_name, contact.gap_expression, contact.is_ratchet, "impulse of the normal force", contact,
            contact.impulse_name))
        form.tangents.append(None if contact.slip is None else _multiplier(
            model, f"{contact.name}.friction", contact.slip_expression, contact.slips_by_rate,
            "impulse of the friction force", contact, contact.friction_impulse_name))
    for constraint in constraints:
        constraint.multiplier = _multiplier(
            model, constraint.force or f"{constraint.name}.force", constraint.expression, constraint.is_rate,
            "impulse of the force", constraint, constraint.impulse_name)
    for contact in contacts:
        if contact.direction is not None:
            declared = next(d for d in model.discretes if d.symbol is contact.direction)
            declared.extra["values"] = [0.0, 1.0, -1.0]
            declared.meaning = f"sign of the slip rate of `{contact.name}` when it slides, else 0"
        form.directions.append(contact.direction)

    # Those that people see come first. What sticks may depend on any other line that holds.
    held = [*contacts, *constraints]
    is_shared = any(contact.slip is not None for contact in contacts) and len(held) > 1
    for of in held:
        form.shares.append(model.discrete(
            f"{of.name}_shares", (0, 1), f"1 where the forces of `{of.name}` are not determined, but for what they and those of"
            " others come to together") if is_shared else None)
        if is_shared:
            model.discretes[-1].extra.update(of_contacts=True)

    def internal(name, meaning, values=(0, 1)):
        symbol = model.discrete(name, values, meaning)
        model.discretes[-1].extra.update(internal=True, of_contacts=True)
        return symbol

    for contact in contacts:
        name, shares = contact.name, is_shared and contact.slip is not None
        form.closed.append(None if contact.gap is None else internal(f"{name}.closed", f"1 where `{name}` is closed"))
        form.dropped.append(internal(f"{name}.dropped", f"1 where others hold the slip of `{name}`") if shares else None)
        form.at_limit.append(internal(
            f"{name}.at_limit", f"direction of the friction of `{name}` where others hold its slip and it is the most that it can be",
            (0, 1, -1)) if shares else None)
    for i, first in enumerate(contacts):
        for j, second in enumerate(contacts):
            if i != j and first.slip is not None and second.slip is not None:
                form.joined[i, j] = internal(f"{first.name}.holds.{second.name}",
                                             f"1 where the friction of `{second.name}` is part of that of `{first.name}`")
    if not model.modes:
        mode = model._mode("moves", "all sets of contact states, by multipliers", [], [])
        mode.location = (model.contacts + model.constraints)[0].location
    for mode in model.modes:
        mode.form = form
        for name, guard, resets, location in model.charts:
            model.transitions.append(Transition(name, mode, mode, guard, None, resets, False, location, is_chart=True))
        for contact in contacts:
            contact.require_normal(mode)


def _check_independent(model, constraints):
    """Refuses constraints whose gradients depend on each other wherever coordinates and parameters are: their forces would not be
    determined."""
    for k, constraint in enumerate(constraints):
        rank = _rank(model, constraints[: k + 1])
        if rank < k + 1:
            before = ", ".join(f"`{c.name}`" for c in constraints[:k])
            raise Contradiction(f"constraint `{constraint.name}`: it depends on those before it ({before}): of {k + 1} equations {rank}"
                                " are independent, so that it is redundant or contradicts them; leave it out", constraint.location)


def _rank(model, constraints):
    """How many constraints are independent: most of several places, drawn at random, all numbers of the order of one. Where none
    of them is in the domain of the constraints, nothing is known against any."""
    places, rates = [ca.vertcat(*[of(c.symbol) for c in model.coordinates if "multiplier" not in c.extra])
                     for of in (lambda q: q, lambda q: q.rate)]
    gradients = ca.vertcat(ca.SX(0, places.numel()), *[c.gradient(places, rates) for c in constraints])
    others = ca.symvar(gradients)
    value, draw = ca.Function("gradients", others, [gradients]), random.Random(0)
    drawn = (np.array(ca.densify(value.call([ca.DM(draw.uniform(0.5, 1.5)) for _ in others])[0])) for _ in range(64))
    inside = itertools.islice((place for place in drawn if np.isfinite(place).all()), 4)
    return max((np.linalg.matrix_rank(place) for place in inside), default=len(constraints)) if constraints else 0


def _multiplier(model, name, expression, is_rate, meaning, declared, impulse):
    """A coordinate whose acceleration is the force along an expression, or along what it is the rate of. Its rate is the impulse."""
    try:
        force = units.force(units.dimension_of(expression, model.dimensions), is_rate)
    except units.UnitError as error:
        raise ModelError(f"`{declared.name}`: {error}", declared.location) from None
    unit = units.text(units.combine(force, units.parse("s^2")))
    symbol = model._declare_motion("coordinate", name, unit)
    symbol.jerk = ca.SX.sym(name + ".jerk")
    model.coordinates.append(Declaration(name, unit, meaning + ", integrated over time", symbol, dict(
        minimum=None, maximum=None, scale=1.0, rate_scale=1.0, multiplier=units.of_force(force),
        impulse=Impulse(impulse, units.of_impulse(force), meaning, declared.location, expression, is_rate, symbol))))
    return symbol


@dataclass
class Terms:
    """What a contact's laws are about, in the symbols of a mode."""

    gap: ca.SX
    gap_rate: ca.SX
    gap_acceleration: ca.SX
    slip_rate: ca.SX
    slip_acceleration: ca.SX
    normal: ca.SX
    tangent: ca.SX
    static: ca.SX
    kinetic: ca.SX
    restitution: ca.SX
    tangential_restitution: ca.SX
    closed: ca.SX
    direction: ca.SX
    sticks: ca.SX
    at_limit: ca.SX


class MultiplierEquations(derive.ModeEquations):
    """The equations of a mode."""

    def __init__(self, form, model, mode, residual, held, absent=()):
        super().__init__(model, mode, residual, held, absent)
        self.form = form
        x = derive.configuration(model)
        self.terms = [self._terms(k, x) for k in range(len(form.contacts))]
        self.held_terms = [self._held(c, x) for c in form.constraints]
        count = len(model.coordinates)
        self.own = [i for i, c in enumerate(model.coordinates) if "multiplier" not in c.extra]
        loaded, rates, powers = ca.SX(self.r), ca.vertcat(x.v), ca.SX(0)
        rows = {}
        name = lambda symbol: next(i for i, c in enumerate(model.coordinates) if c.symbol is symbol)
        for k, of in enumerate(self.terms):
            if form.normals[k] is not None:
                along = self._along(form.contacts[k].gap_expression, x.v if form.contacts[k].is_ratchet else x.q)
                rows[name(form.normals[k])] = of.closed * of.gap_acceleration + (1 - of.closed) * of.normal
                loaded, powers = self._push(loaded, along, of.normal), powers + of.normal * ca.dot(along, rates)
            if form.tangents[k] is not None:
                along = self._along(form.contacts[k].slip_rate_of(x), x.v)
                free = of.tangent + of.kinetic * of.direction * of.normal - of.at_limit * self._limit(k)
                rows[name(form.tangents[k])] = of.sticks * of.slip_acceleration + (1 - of.sticks) * free
                loaded = self._push(loaded, along, of.tangent)
                powers += of.tangent * (ca.dot(along, rates) - of.slip_rate)
        for constraint, (_, _, acceleration) in zip(form.constraints, self.held_terms):
            along = constraint.gradient(x.q, x.v).T
            force = constraint.multiplier.acceleration
            rows[name(constraint.multiplier)] = acceleration
            loaded, powers = self._push(loaded, along, force), powers + force * ca.dot(along, rates)
        for symbol in form.idle:
            rows[name(symbol)] = symbol.acceleration
        for i, row in rows.items():
            loaded[i] = row
        self.r = ca.densify(loaded)
        self.moving_partners = self.freeze(powers)
        self.reactions += [(i, model.coordinates[i].symbol.acceleration) for i in range(count) if i not in self.own]
        self._check_linear_in_accelerations()

    def _along(self, expression, symbols):
        """How an expression changes with coordinates, or rates, of the model and of the ground."""
        return ca.densify(ca.jacobian(expression, symbols)).T

    def _push(self, column, along, force):
        """The residual with a force along something; the ground's reaction is without it."""
        along = self.freeze(along)
        count = len(self.model.coordinates)
        self.reactions = [(i, r - force * along[i] if i >= count else r) for i, r in self.reactions]
        return column - force * along[:count]

    def _rates(self, expression, x):
        """An expression, its rate and its acceleration."""
        rate = ca.jtimes(expression, x.q, x.v)
        return [self.freeze(e) for e in (expression, rate, derive.total_time_derivative(rate, x))]

    def _of_rate(self, expression, x):
        """The same of a rate, of which there is no place."""
        return [ca.SX(0), self.freeze(expression), self.freeze(derive.total_time_derivative(expression, x))]

    def _held(self, constraint, x):
        """What a constraint holds, its rate and its acceleration."""
        return (self._of_rate if constraint.is_rate else self._rates)(constraint.expression, x)

    def _terms(self, k, x):
        form, contact = self.form, self.form.contacts[k]
        zero, one = ca.SX(0), ca.SX(1)
        gap = [zero, zero, zero]
        if contact.gap is not None:
            gap = (self._of_rate if contact.is_ratchet else self._rates)(contact.gap_expression, x)
        slip = [zero, zero]
        if contact.slip is not None:
            rate = contact.slip_rate_of(x)
            slip = [self.freeze(rate), self.freeze(derive.total_time_derivative(rate, x))]
        given = lambda value: zero if value is None else self.freeze(value)
        normal = given(contact.normal) if contact.gap is None else form.normals[k].acceleration
        closed = one if contact.gap is None else form.closed[k]
        direction = zero if contact.slip is None else form.directions[k]
        dropped, at_limit = (zero if of[k] is None else of[k] for of in (form.dropped, form.at_limit))
        return Terms(
            *gap, *slip, normal, zero if contact.slip is None else form.tangents[k].acceleration, given(contact.static),
            given(contact.kinetic), given(contact.restitution), given(contact.tangential_restitution), closed, direction,
            closed * (1 - direction ** 2) * (1 - dropped), at_limit)

    def _limit(self, k):
        """What friction can hold at most at a contact, and at those whose friction is part of its own."""
        own = self.terms[k]
        others = [(self.form.joined.get((k, j)), of) for j, of in enumerate(self.terms)]
        return own.static * own.normal + sum((joined * of.static * of.normal for joined, of in others if joined is not None), ca.SX(0))

    def contact_guards(self):
        """Three a contact, each positive while the contact stays in its state, and smooth in each of its states: what pushes, or
        the gap (of a ratchet the rate); what is left before it slips forwards, or the slip rate along its direction; what is left
        before it slips backwards."""
        guards = []
        for k, of in enumerate(self.terms):
            limit, slides = self._limit(k), of.closed * of.direction ** 2
            opening = of.gap_rate if self.form.contacts[k].is_ratchet else of.gap
            guards += [
                of.closed * of.normal + (1 - of.closed) * opening if self.form.normals[k] is not None else ca.SX(1),
                of.sticks * (limit - of.tangent) + of.closed * of.direction * of.slip_rate + (1 - of.sticks - slides),
                of.sticks * (limit + of.tangent) + (1 - of.sticks)]
        return guards

    def decisions(self):
        """What decides, on the accelerations, whether a set of contact states may go on, five a contact: λ_N, g̈, what is left
        before it slips forwards and backwards, γ̇."""
        columns = [ca.vertcat(of.normal, of.gap_acceleration, self._limit(k) - of.tangent, self._limit(k) + of.tangent,
                              of.slip_acceleration) for k, of in enumerate(self.terms)]
        return ca.vertcat(*columns) if columns else ca.SX(0, 1)

    def contact_values(self):
        """Ten a contact: g, ġ, γ, μ_s, μ_k, e, e_T, and what times the unit roundoff bounds the rounding of the first three; four
        a constraint: φ, φ̇ and the same of these; the rates after impacts that the model states, of each contact those and those where
        all that touch stick."""
        columns = [ca.SX(0, 1)]
        for of in self.terms:
            three = [of.gap, of.gap_rate, of.slip_rate]
            columns += [*three, of.static, of.kinetic, of.restitution, of.tangential_restitution, *[graph.running_error(e) for e in three]]
        for value, rate, _ in self.held_terms:
            columns += [value, rate, graph.running_error(value), graph.running_error(rate)]
        columns += [self.freeze(value) for contact in self.form.contacts for law in (contact.law, contact.held_law) for _, value in law]
        return ca.vertcat(*columns)

    def lines(self):
        """How equations change with the accelerations of coordinates that are no multipliers of this choice, row by row, where every contact
        sticks: those of these coordinates (their inertia), then what the lines are about, along gap and slip of each contact and along
        each constraint."""
        form = self.form
        index = lambda symbol: next(i for i, c in enumerate(self.model.coordinates) if c.symbol is symbol)
        chosen = form.discretes()
        sticks = [ca.SX(1 if any(symbol is closed for closed in form.closed) else 0) for symbol in chosen]
        residual = derive.Substitution(chosen, sticks)(self.r)
        of_contacts = [symbol for pair in zip(form.normals, form.tangents) for symbol in pair if symbol is not None]
        of_lines = [index(symbol) for symbol in [*of_contacts, *[c.multiplier for c in form.constraints]]]
        others = [i for i in range(len(self.model.coordinates)) if i not in of_lines]
        slopes = ca.densify(ca.jacobian(residual, ca.vertcat(*[self.a[i] for i in others])))
        rows = others + of_lines
        return ca.vec(slopes[rows, :].T)

    def inertia(self):
        """∂²T/∂v², and for a multiplier one: positive definite as that is."""
        inertia = super().inertia()
        for i in range(inertia.shape[0]):
            if i not in self.own:
                inertia[i, i] = 1
        return inertia

    def powers(self):
        """As for any mode; friction dissipates its force times the slip rate, the rest is work of a moving partner."""
        friction = sum((-of.tangent * of.slip_rate for of in self.terms), ca.SX(0))
        return super().powers() + ca.vertcat(friction, self.moving_partners)

    def describe(self, model):
        """What the program needs to know of contacts and constraints, but for the tape."""
        coordinate = lambda symbol: None if symbol is None else next(i for i, c in enumerate(model.coordinates) if c.symbol is symbol)
        discrete = lambda symbol: None if symbol is None else next(i for i, d in enumerate(model.discretes) if d.symbol is symbol)
        form, count = self.form, len(self.form.contacts)
        ground = ca.vertcat(ca.SX(0, 1), *[s for m in model.motions for s in (m.symbol, m.symbol.rate)])
        places = [c.gap_expression for c in form.contacts if c.gap is not None] + [c.expression for c in form.constraints]
        return {
            "moved": any(ca.depends_on(place, ground) for place in places) if ground.numel() else False,
            "contacts": [{
                "name": contact.name, "is_ratchet": contact.is_ratchet, "normal": coordinate(form.normals[k]), "tangent": coordinate(form.tangents[k]),
                "closed": discrete(form.closed[k]), "direction": discrete(form.directions[k]),
                "shares": discrete(form.shares[k]), "dropped": discrete(form.dropped[k]), "at_limit": discrete(form.at_limit[k]),
                "joined": [discrete(form.joined.get((k, j))) for j in range(count)],
                "law": [coordinate(symbol) for symbol, _ in contact.law],
                "held_law": [coordinate(symbol) for symbol, _ in contact.held_law],
            } for k, contact in enumerate(form.contacts)],
            "constraints": [{
                "name": c.name, "multiplier": coordinate(c.multiplier), "shares": discrete(form.shares[count + k]),
            } for k, c in enumerate(form.constraints)],
        }
