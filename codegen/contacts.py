"""Contacts, friction, ratchets and constraints as a model declares them, once; the modes follow (`reduced.py`, `multipliers.py`).

A contact has a gap g ≥ 0 with a normal force λ_N ≥ 0, one of which is zero; with a slip it has Coulomb friction, static and
kinetic. Friction without a gap acts all the time, under a normal force that the model gives. Where gaps
and slips are coordinates the reduced form is built, in which a mode is a set of contact states that freezes them, and its
reactions are the forces; else the form with multipliers. (J. J. Moreau 1988, Unilateral contact and dry friction in finite freedom
dynamics.) A ratchet is one-sided in a rate: γ ≥ 0 with a force λ ≥ 0, one of which is zero.

Signs: λ_N pushes the gap open; λ_T acts along the slip; a direction is the sign of the slip rate.
"""

from dataclasses import dataclass, field

import casadi as ca

from . import arguments, derive, graph, limits, multipliers, units
from .declarations import Requirement
from .errors import caller_location

OPEN, CLOSED, STICKS, SLIDES = "open", "closed", "sticks", "slides"
FREE, ENGAGED = "free", "engaged"

@dataclass
class Line:
    """A number that is, but for its slope, one coordinate or its rate and what parameters add: slope × coordinate + offset. The
    coordinate may be a line of its own (`lines.py`), which is solved for one of the model."""

    coordinate: ca.SX
    sign: int
    offset: ca.SX
    solved: ca.SX = None
    """The coordinate of the model that is held where the line is."""
    scale: ca.SX = None
    """The amount of the slope, of parameters; None where it is 1."""

    def __post_init__(self):
        self.solved = self.coordinate if self.solved is None else self.solved

    @property
    def name(self):
        """The name of the coordinate."""
        return self.coordinate.name()

    @property
    def slope(self):
        """How the number changes with the coordinate."""
        return self.sign if self.scale is None else self.sign * self.scale

    def value(self):
        """The coordinate (or its rate) where the number is zero."""
        return self.along(-self.offset)

    def along(self, force):
        """What changes the number by so much; the force along the number that is such a force on the coordinate."""
        return self.sign * force if self.scale is None else self.sign * force / self.scale


@dataclass
class Smooth:
    """A gap, or a slip, that is any smooth function of the coordinates."""


@dataclass
class Contact:
    """A contact, friction without a gap (`gap` is None, `normal` given), or a ratchet, whose `gap_expression` is its rate. Gap and slip
    are `Line`s where they are coordinates, else `Smooth`."""

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
    is_ratchet: bool = False
    law: list = field(default_factory=list)
    """The rates after its impacts that the model states, as (coordinate, rate)."""
    held_law: list = field(default_factory=list)
    """The same where all that touch stick before, if they are others then."""
    held: list = field(default_factory=list)
    """Of a permanent contact in the form with multipliers, the constraints that hold it: its gap, its slip rate."""
    sides: ca.SX = None
    """Of a gap that opens to two sides, the discrete state that says to which."""

    @property
    def force_name(self):
        """Name of the force that keeps the gap, or the rate, from being negative."""
        return f"{self.name}.force" if self.is_ratchet else f"{self.name}.normal"

    @property
    def impulse_name(self):
        """Name of its impulse."""
        return f"{self.name}.impulse" if self.is_ratchet else f"{self.name}.normal_impulse"

    @property
    def friction_impulse_name(self):
        """Name of the impulse of its friction."""
        return f"{self.name}.friction_impulse"

    def states(self):
        """What it can do."""
        if self.is_ratchet:
            return [ENGAGED] if self.permanent else [FREE, ENGAGED]
        slipping = [STICKS, SLIDES] if self.slip else [CLOSED]
        return slipping[:1] if self.permanent else ([OPEN] if self.gap else []) + slipping

    def hold(self, model):
        """Makes the constraints of a permanent contact."""
        if self.is_ratchet:
            self.held.append(multipliers.Constraint(self.name, self.gap_expression, self.location, True))
            return
        if self.gap is not None:
            self.held.append(multipliers.Constraint(f"{self.name}.gap", self.gap_expression, self.location, force=f"{self.name}.normal"))
        if self.slip is not None:
            rate = self.slip_rate_of(derive.configuration(model))
            self.held.append(multipliers.Constraint(f"{self.name}.slip", rate, self.location, True, force=f"{self.name}.friction"))

    def require_normal(self, mode):
        """Friction without a gap ends where its normal force pulls; one of parameters alone is what it is."""
        if self.gap is None and not limits.is_of_parameters(mode.model, self.normal):
            mode.requirements.append(Requirement(
                self.normal, f"the normal force of `{self.name}` would pull", self.location, may_vanish=True))

    def has_plain_law(self):
        """Whether its impacts are Newton's without a slip that turns back, and it is no ratchet."""
        return not self.is_ratchet and (self.permanent or not self.law and self.tangential_restitution.is_zero())

    def slip_rate_of(self, x):
        """The slip rate as an expression in coordinates and rates (`derive.Configuration`)."""
        return self.slip_expression if self.slips_by_rate else ca.jtimes(self.slip_expression, x.q, x.v)

    def slip_rate(self):
        """Positive along the slip."""
        return self.slip.slope * self.slip.coordinate.rate + self.slip.offset

    def normal_force(self, mode, **discrete):
        """λ_N in a mode where it is closed, with discrete states as given."""
        return self.normal if self.gap is None else self.gap.along(mode.reaction(self.gap.solved, **discrete))


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


def declare(model, name, gap, slip, normal, static, kinetic, restitution, tangential_restitution, switch, sides=None):
    """Adds a contact to a model; see `Model.contact` and `Model.friction`."""
    kind = "friction" if gap is None else "contact"
    what = f"{kind} `{name}`"
    _check_name(model, kind, name)
    chosen = switched(model, kind, name, switch)
    of = lambda key, value: arguments.expression(model, f"{what}: {key}", value)
    gap_expression = None if gap is None else _of_motion(model, f"{what}: its gap", of("its gap", gap), rates=False)
    if slip is None and (static is not None or kinetic is not None):
        raise model.error(f"{what}: it has friction but no `slip`: give the place or the rate along which it slips")
    if slip is None and tangential_restitution != 0:
        raise model.error(f"{what}: `tangential_restitution` is given, but no `slip` that it would turn back")
    slip_expression = None
    if slip is not None:
        if kinetic is None and static is not None:
            raise model.error(f"{what}: `static` is given, but no coefficient `kinetic`; one coefficient for both is `kinetic` alone")
        if kinetic is None:
            raise model.error(f"{what}: `slip` is given, but no coefficient `kinetic`; without friction leave "
                              + ("it out" if gap is None else "`slip` out"))
        slip_expression = _of_motion(model, f"{what}: its slip", of("its slip", slip), rates=True)
    kinetic = None if kinetic is None else of("`kinetic`", kinetic)
    static = kinetic if static is None else of("`static`", static)
    rates = ca.vertcat(*[c.symbol.rate for c in model.coordinates + model.motions])
    by_rate = slip_expression is not None and bool(rates.numel()) and ca.depends_on(slip_expression, rates)
    gap = None if gap is None else as_line(model, gap_expression, False) or Smooth()
    slip = None if slip is None else slip_line(model, slip_expression, by_rate) or Smooth()
    for known in model.contacts:
        lines = isinstance(slip, Line) and isinstance(known.slip, Line) and gap is None and known.gap is None
        if lines and known.slip.name == slip.name:
            raise model.error(f"{what}: `{known.name}` slips along `{slip.name}` too; of two friction forces along one coordinate"
                              " only the sum is determined: declare one friction with the sum of both")
    if sides is not None:
        _check_sides(model, what, gap, slip, sides)
    if chosen == OFF:
        return
    direction = None if slip is None or chosen == PERMANENT else model.discrete(
        f"{name}_direction", (+1, -1), f"sign of the slip rate of `{name}` when it slides")
    if direction is not None:
        model.discretes[-1].extra["of_contacts"] = True
    model.contacts.append(Contact(
        name, gap, gap_expression, slip, slip_expression, by_rate, None if normal is None else of("`normal`", normal), static,
        kinetic, of("`restitution`", restitution), of("`tangential_restitution`", tangential_restitution), direction,
        caller_location(model.file), chosen == PERMANENT, sides=sides))


def _check_sides(model, what, gap, slip, sides):
    """Of a gap that opens to two sides: what says to which, and that the gap is a coordinate on both."""
    declared = next((d for d in model.discretes if isinstance(sides, ca.SX) and d.symbol is sides), None)
    if declared is None or sorted(declared.values) != [-1, 1]:
        raise model.error(f"{what}: `sides` is {arguments.shown(sides)}, not a discrete state with the values +1 and -1")
    if not isinstance(gap, Line):
        raise model.error(f"{what}: it opens to two sides, so that its gap is a coordinate, positive on either side")
    if slip is not None:
        raise model.error(f"{what}: it opens to two sides and has a slip; what touches differs with the side, so that it is for two"
                          " contacts to say")


def declare_ratchet(model, name, rate, switch):
    """Adds a one-sided constraint on a rate to a model; see `Model.ratchet`."""
    what = f"ratchet `{name}`"
    _check_name(model, "ratchet", name)
    chosen = switched(model, "ratchet", name, switch)
    rate = _of_motion(model, f"{what}: its rate", arguments.expression(model, f"{what}: its rate", rate), rates=True)
    if not _is_of_rates(model, f"{what}: its rate", rate):
        raise model.error(f"{what}: its rate, `{units.short(rate)}`, does not depend on the rate of any coordinate; what is one-sided in a"
                          " place is a contact")
    if chosen == OFF:
        return
    zero = ca.SX(0)
    model.contacts.append(Contact(name, Smooth(), rate, None, None, False, None, None, None, zero, zero, None,
                                  caller_location(model.file), chosen == PERMANENT, True))


def _check_name(model, kind, name):
    arguments.name(model, kind, name)
    if any(known.name == name for known in model.contacts):
        raise model.error(f"{kind} `{name}`: there is a contact, a friction or a ratchet of this name above")


def _is_of_rates(model, what, expression):
    """Whether an expression depends on rates of coordinates, on which it must depend linearly: their factors are the directions of
    its force."""
    rates = ca.vertcat(*[c.symbol.rate for c in model.coordinates])
    slopes = ca.densify(ca.jacobian(expression, rates))
    if ca.depends_on(slopes, rates):
        raise model.error(f"{what}, `{units.short(expression)}`, is not linear in the rates, so that it has no force that follows from it")
    return not slopes.is_zero()


def declare_impact(model, name, rates, held):
    """Adds a law of the model's own for the impacts of a contact; see `Model.impact`."""
    with_gap = [c for c in model.contacts if c.gap is not None and not c.is_ratchet]
    contact = next((c for c in with_gap if c.name == name), None)
    if contact is None and (name, "contact") not in model.switched_off:
        known = ", ".join(f"`{c.name}`" for c in with_gap) or "none"
        raise model.error(f"impact: there is no contact `{name}` with a gap above (contacts: {known})")
    if contact is not None and contact.law:
        raise model.error(f"impact of `{name}`: its law is stated twice")
    law = _law(model, f"impact of `{name}`", "its rates", rates)
    if not law:
        raise model.error(f"impact of `{name}`: it lists no rates")
    held_law = [] if held is None else _law(model, f"impact of `{name}` while others stick", "`held`", held)
    # A contact that is switched off, or held for good, has no impacts.
    if contact is not None and not contact.permanent:
        contact.law, contact.held_law = law, law if held is None else held_law


def _law(model, of, what, rates):
    """Rates after an impact, as (coordinate, value)."""
    law = []
    declared = {c.symbol.rate.element_hash(): c for c in model.coordinates}
    places = [s for c in model.coordinates + model.motions for s in (c.symbol, c.symbol.rate)]
    allowed = {s.element_hash() for s in [*places, *(p.symbol for p in model.parameters), *_by_hand(model)]}
    for rate, value in arguments.pairs(model, f"{of}: {what}", rates, "(rate, value just after)"):
        coordinate = declared.get(rate.element_hash()) if isinstance(rate, ca.SX) else None
        if coordinate is None:
            raise model.error(f"{of}: {arguments.shown(rate)} is not the rate of a coordinate")
        entry = f"{of}: `{coordinate.name}.rate`"
        value = arguments.expression(model, entry, value)
        for symbol in ca.symvar(value):
            if symbol.element_hash() not in allowed:
                raise model.error(f"{entry} depends on `{symbol.name()}`; it depends on coordinates, rates, prescribed motions,"
                                  " discrete states and parameters alone")
        operation = graph.non_smooth_operation(value, [p.symbol for p in model.parameters])
        if operation:
            raise model.error(f"{entry}: `{operation}` is not smooth")
        try:
            units.dimension_of(value - rate, model.dimensions)
        except units.UnitError as error:
            raise model.error(f"{entry}: {error}") from None
        law.append((coordinate.symbol, value))
    return law


def _by_hand(model):
    """The discrete states that the model declares: only its transitions change them."""
    return [d.symbol for d in model.discretes if "of_contacts" not in d.extra]


def declare_constraint(model, name, expressions, switch):
    """Adds a constraint to a model; see `Model.constraint`."""
    arguments.name(model, "constraint", name)
    chosen = switched(model, "constraint", name, switch)
    if any(known.name == name or known.name.startswith(f"{name}.") for known in [*model.constraints, *model.contacts]):
        raise model.error(f"constraint `{name}`: there is a contact, a friction, a ratchet or a constraint of this name above")
    listed = list(expressions) if isinstance(expressions, (list, tuple)) else [expressions]
    for k, expression in enumerate(listed):
        own = name if len(listed) == 1 else f"{name}.{k + 1}"
        what = f"constraint `{own}`"
        expression = _of_motion(model, what, arguments.expression(model, what, expression), rates=True)
        is_rate = _is_of_rates(model, what, expression)
        if not is_rate and ca.depends_on(expression, ca.vertcat(ca.SX(0, 1), *[m.symbol.rate for m in model.motions])):
            raise model.error(f"{what}, `{units.short(expression)}`, depends on the rate of a prescribed motion, but on none of a coordinate")
        if chosen == OFF:
            continue
        model.constraints.append(multipliers.Constraint(own, expression, caller_location(model.file), is_rate))


def _of_motion(model, what, expression, rates):
    """An expression in coordinates, prescribed motions, discrete states and parameters, and in `rates` where these are allowed."""
    places = [c.symbol for c in model.coordinates + model.motions]
    allowed = {s.element_hash() for s in [*places, *(p.symbol for p in model.parameters), *_by_hand(model)]}
    allowed |= {s.rate.element_hash() for s in places} if rates else set()
    for symbol in ca.symvar(expression):
        if symbol.element_hash() not in allowed:
            raise model.error(f"{what}, `{units.short(expression)}`, depends on `{symbol.name()}`; it depends on coordinates"
                              f"{', rates' if rates else ''}, prescribed motions, discrete states and parameters alone")
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


def slip_line(model, expression, by_rate):
    """The slip rate as a line, from itself or from the place along which a contact slips."""
    line = as_line(model, expression, by_rate)
    return line if by_rate or line is None else Line(line.coordinate, line.sign, ca.SX(0))
