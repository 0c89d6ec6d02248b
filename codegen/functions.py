"""The functions that are emitted of a model, a row each: what it computes, what it takes, and who calls it.

A function of a mode, a guard or a transition is added here. `generate.py` derives and emits what the rows say, `description.py` says
where each is found in the tables of the contract; src/model/description/functions.rs reads it from there.
"""

import functools
from dataclasses import dataclass
from typing import Callable

import casadi as ca

from . import bounds, graph, outputs, signals


@dataclass(frozen=True)
class Row:
    """A function, of each mode, of each of its guards, or of each of their transitions."""

    name: str
    output: Callable
    """What it computes, in the symbols of a mode: of `OfMode`, `OfGuard` or `OfTransition`."""
    used_by: str
    """Who calls it, as a place in src/."""
    series: str = ""
    """Of what it is emitted as a Taylor series instead: of the `motion`, or of `values` along it."""
    takes_radii: bool = False
    """Whether it takes radii of what moves in place of jerks and of rates of signals."""
    is_counted: bool = False
    """Whether the description says how many results it has; those of others follow from the model."""
    in_lanes: bool = False
    """Whether it is emitted for lanes, too, of the modes that go in lanes (`analysis.goes_in_lanes`)."""
    exists: Callable = lambda of: True
    """Whether there is one."""


class OfMode:
    """A mode, and what several of its functions share."""

    def __init__(self, variant, equations, check_smooth):
        self.variant, self.model, self.equations, self.check_smooth = variant, variant.model, equations, check_smooth

    @functools.cached_property
    def system(self):
        """Mass matrix, column by column, and load of r = M a + b."""
        mass, load = self.equations.system()
        return self.without_idle(ca.vertcat(ca.vec(mass), load))

    def without_idle(self, column):
        """A column without discrete states that do not change it. Those of contacts choose rows: one that few sets have would seem to
        be idle."""
        form = self.equations.mode.form
        chosen = form.discretes() if form else []
        discretes = [(d.symbol, d.values) for d in self.model.discretes if not any(d.symbol is own for own in chosen)]
        return graph.without_idle(column, ca.vertcat(self.equations.q, self.equations.v), discretes)

    @functools.cached_property
    def motion(self):
        """The system, and the rates of what drifts."""
        return ca.vertcat(self.system, self.drift_rates)

    @functools.cached_property
    def drift_rates(self):
        """Rates of the frozen coordinates that drift."""
        drift = self.equations.mode.drift
        return self.equations.freeze(ca.vertcat(*[ca.SX(drift[c.name]) for c in self.model.coordinates if c.name in drift]))

    def autonomous(self, expression):
        """An expression where no input acts."""
        inputs = signals.of(self.model)
        return ca.substitute(expression, inputs, ca.SX.zeros(inputs.numel())) if inputs.numel() else expression

    @functools.cached_property
    def reactions(self):
        """Of all coordinates and motions of the ground; 0 where there is none."""
        reactions = ca.SX.zeros(len(self.model.coordinates) + len(self.model.motions))
        for i, reaction in self.equations.reactions:
            reactions[i] = reaction
        return reactions

    @functools.cached_property
    def requirements(self):
        """What the mode requires, then all margins."""
        required = [self.equations.place(r.expression, r.location) for r in self.equations.mode.requirements]
        return ca.vertcat(*required, *self.equations.margins)

    @property
    def requirement_roundings(self):
        """Running errors of what may vanish of them, else 0: a force that is zero may be negative by as much."""
        mode = self.equations.mode
        roundings = ca.SX.zeros(self.requirements.numel())
        for i, required in enumerate(mode.requirements):
            if required.may_vanish:
                roundings[i] = graph.running_error(self.requirements[i])
        return roundings

    @functools.cached_property
    def requirement_bounds(self):
        """Lower bounds of these while what moves stays within radii of its values."""
        equations, column = self.equations, self.requirements
        moving = ca.vertcat(equations.q, equations.v, equations.a, signals.of(self.model))
        radii = ca.vertcat(equations.radii, signals.radii(self.model))
        known = {moving[i].element_hash(): radii[i] for i in range(moving.numel())}
        drifting = [equations.held[i] for i, c in enumerate(self.model.coordinates) if c.name in equations.mode.drift]
        known.update((symbol.element_hash(), None) for symbol in drifting)
        return ca.vertcat(*[bounds.lower_bound(column[i], known) for i in range(column.numel())])


@dataclass
class OfGuard:
    """A guard of a mode."""

    mode: OfMode
    value: ca.SX
    """In the symbols of the mode."""


@dataclass
class OfTransition:
    """A transition of a mode."""

    mode: OfMode
    reset: ca.SX
    """q⁺, v⁺, d⁺ in the symbols of the mode."""
    condition: ca.SX
    """In the symbols of the target; None if there is none."""
    impulses: ca.SX
    """Those of an impact of contacts in the reduced form, each of the model; None of any other transition."""


MODE = (
    Row("residual", lambda of: of.equations.r, "integrate (Newton's method), checks of derivatives"),
    Row("jacobian", lambda of: ca.vertcat(*[ca.vec(j) for j in of.equations.jacobians()]), "integrate (the implicit method), sensitivity"),
    Row("system", lambda of: of.system, "accelerations wherever they are needed; Geometry of contacts"),
    Row("series", lambda of: of.motion, "integrate (the Taylor method)", series="motion", in_lanes=True),
    Row("autonomous_series", lambda of: of.autonomous(of.motion), "the same while no input acts", series="motion", in_lanes=True),
    Row("inertia", lambda of: of.without_idle(ca.vec(of.equations.inertia())), "hybrid::inertia"),
    Row("jerk_load", lambda of: of.equations.jerk_load(signals.of(of.model), signals.rates(of.model)), "integrate (starts of the implicit method)"),
    Row("magnitude", lambda of: of.equations.magnitude(), "hybrid::enter, integrate (rounding of the residual)"),
    Row("reactions", lambda of: of.reactions, "hybrid::outputs, limits of a scene"),
    Row("outputs", lambda of: outputs.values(of.equations, of.check_smooth), "hybrid::outputs"),
    Row("energies", lambda of: of.equations.energies(), "the ledger"),
    Row("powers", lambda of: of.equations.powers(), "the ledger"),
    Row("momenta", lambda of: of.equations.momenta(), "the ledger, at impacts on ground that moves"),
    Row("requirements", lambda of: of.requirements, "hybrid::margins"),
    Row("requirement_roundings", lambda of: of.requirement_roundings, "hybrid::margins (where they are zero)"),
    Row("requirement_bounds", lambda of: of.requirement_bounds, "hybrid::margins", takes_radii=True, in_lanes=True),
    Row("drift", lambda of: of.equations.freeze(of.equations.rates_of_held[:len(of.model.coordinates)]), "integrate (where the mode holds what drifts)"),
    Row("coordinates", lambda of: of.equations.all_coordinates(), "all coordinates, those that the mode holds among them"),
    Row("rates", lambda of: of.equations.all_rates(), "their rates"),
    Row("accelerations", lambda of: of.equations.all_accelerations(), "their accelerations"),
    Row("roundings", lambda of: of.equations.roundings(), "hybrid::start", is_counted=True,
        exists=lambda of: bool(of.equations.mode.lines)),
    Row("carried", lambda of: of.equations.carried(), "the ledger, at impacts on walls that move", is_counted=True,
        exists=lambda of: not of.equations.carried().is_zero()),
    Row("contact_values", lambda of: of.equations.contact_values(), "hybrid::contact::hold", is_counted=True,
        exists=lambda of: of.equations.mode.form is not None),
    Row("lines", lambda of: of.equations.lines(), "hybrid::contact::geometry", is_counted=True,
        exists=lambda of: of.equations.mode.form is not None),
)
"""Of each mode, but for the series of its guards, which comes behind them."""

GUARD = (
    Row("guard", lambda of: of.value, "hybrid::guards", in_lanes=True),
    Row("guard_rate", lambda of: of.mode.equations.along_the_flow(of.value, signals.of(of.mode.model), signals.rates(of.mode.model)),
        "hybrid::guards (its derivative along the motion)"),
    Row("guard_magnitude", lambda of: graph.magnitude(of.value), "hybrid::start, hybrid::typical (the size of its terms)"),
    Row("guard_rounding", lambda of: graph.running_error(of.value), "hybrid::crossing, hybrid::doubt (its rounding)"),
)
"""Of each guard of a mode."""

TRANSITION = (
    Row("reset", lambda of: of.reset, "hybrid::fire"),
    Row("condition", lambda of: of.condition, "hybrid::choice", is_counted=True, exists=lambda of: of.condition is not None),
    Row("impulses", lambda of: of.impulses, "hybrid::fire", is_counted=True, exists=lambda of: of.impulses is not None),
)
"""Of each transition of a guard. Resets that stay in the mode are for lanes, too; conditions are in the symbols of the target."""

GUARDS_OF_MODE = Row("guard_series", lambda of: ca.vertcat(*of.equations.guard_values, *of.equations.beside_guards, of.drift_rates),
                     "hybrid::search: guards that are not linear", series="values", in_lanes=True)
"""All guards of a mode; 0 in the place of one that is linear, which is as good a polynomial as the motion itself. Then what else swings with
inputs."""

ROWS = {row.name: row for row in (*MODE, *GUARD, *TRANSITION, GUARDS_OF_MODE)}

OF_EACH_MODE = (*MODE, GUARDS_OF_MODE)
"""Those that a mode has once."""
