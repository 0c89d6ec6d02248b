"""From energies to the equations of each mode.

With the motions z of the ground appended as prescribed coordinates, the residual of coordinate i is

    r_i = Σ_bodies m J_iᵀ(J a + J̇ v) + I φ_i φ̈ + d/dt ∂T/∂v_i − ∂T/∂q_i + ∂V/∂q_i + ∂D/∂v_i − Q_i

(virtual power over the bodies; Lagrange's equations for what is not a body). A frozen coordinate
stays in the energies and only its motion is removed, so that its r_i is the reaction. One that a mode holds along a line
(`lines.py`) depends on free ones and motions, and is replaced by what it is of them; by the power that is left, Jᵀ r of J = ∂q/∂y takes
the place of r, where y has the lines in place of what depends on others.
"""

from dataclasses import dataclass

import casadi as ca

from . import graph, signals, units
from .errors import ModelError

ENERGY = units.parse("kg m^2/s^2")


@dataclass
class Configuration:
    """Coordinates, rates and accelerations with the prescribed motions appended, as columns."""

    q: ca.SX
    v: ca.SX
    a: ca.SX


def configuration(model):
    """All coordinates and prescribed motions of a model."""
    symbols = [c.symbol for c in model.coordinates + model.motions]
    return Configuration(
        ca.vertcat(*symbols) if symbols else ca.SX(0, 1),
        ca.vertcat(*[s.rate for s in symbols]),
        ca.vertcat(*[s.acceleration for s in symbols]),
    )


def inertial_position(model, body):
    """Position of a body in the inertial frame: relative position plus the motions of the ground."""
    position = list(body.position)
    for motion in model.motions:
        if motion.axis is not None:
            position[motion.axis] = position[motion.axis] + motion.symbol
    return ca.vertcat(*position)


def total_time_derivative(expression, x):
    """d/dt of an expression in (q, v)."""
    return ca.jtimes(expression, x.q, x.v) + ca.jtimes(expression, x.v, x.a)


def kinetic_energy(model):
    """T in the inertial frame, as a scalar expression."""
    x = configuration(model)
    energy = sum(model.kinetic_terms, ca.SX(0))
    for body in model.bodies:
        velocity = ca.jtimes(inertial_position(model, body), x.q, x.v)
        energy += body.mass * ca.dot(velocity, velocity) / 2
        if body.angle is not None:
            energy += body.inertia * ca.jtimes(body.angle, x.q, x.v) ** 2 / 2
    return energy


def potential_energy(model):
    """V: weight of the bodies and the declared potentials."""
    energy = sum(model.potentials, ca.SX(0))
    for body in model.bodies:
        energy += body.mass * model.gravity_constant * inertial_position(model, body)[1]
    return energy


def residual_from_bodies(model):
    """r by virtual power over the bodies (the form that gives the cheapest code)."""
    x = configuration(model)
    residual = _lagrange(model, sum(model.kinetic_terms, ca.SX(0)), sum(model.potentials, ca.SX(0)), x)
    weight = ca.vertcat(0, model.gravity_constant)
    for body in model.bodies:
        residual += body.mass * _virtual_power(inertial_position(model, body), x, weight)
        if body.angle is not None:
            residual += body.inertia * _virtual_power(body.angle, x, 0)
    return residual


def residual_from_energies(model):
    """r by Lagrange's equations from T and V as expressions; the check of the body form."""
    return _lagrange(model, kinetic_energy(model), potential_energy(model), configuration(model))


def _virtual_power(place, x, weight):
    """Jᵀ(J a + J̇ v + weight) of a position or an angle."""
    jacobian = ca.jacobian(place, x.q)
    velocity = jacobian @ x.v
    acceleration = jacobian @ x.a + ca.jtimes(velocity, x.q, x.v)
    return jacobian.T @ (acceleration + weight)


def _lagrange(model, kinetic, potential, x):
    momentum = ca.jacobian(kinetic, x.v).T
    residual = total_time_derivative(momentum, x) - ca.jacobian(kinetic, x.q).T
    residual += ca.jacobian(potential, x.q).T
    residual += ca.jacobian(sum(model.dissipations, ca.SX(0)), x.v).T
    for coordinate, force in model.external:
        residual[_index(model, coordinate.name())] -= force
    return ca.densify(residual)


def _index(model, name):
    return next(i for i, c in enumerate(model.coordinates + model.motions) if c.name == name)


def along_lines(model, lines):
    """∂q/∂y, of coordinates and prescribed motions, where of the coordinates in y those that `lines` are solved for stand for these lines."""
    q = configuration(model).q
    size = q.numel()
    result = ca.SX.eye(size)
    for line in lines:
        unit = ca.SX.zeros(1, size)
        unit[_index(model, line.name)] = 1
        result[_index(model, line.name), :] = unit - ca.jacobian(line.rest, q) @ result
    return ca.densify(ca.simplify(result))


@dataclass
class Substitution:
    """Replacement of symbols by expressions."""

    old: list
    new: list

    def __call__(self, expression):
        if not self.old:
            return expression
        return ca.substitute(expression, ca.vertcat(*self.old), ca.vertcat(*self.new))


class ModeEquations:
    """Everything that is generated for one mode, as expressions in its own symbols.

    `held` are the symbols of the coordinates, then of the prescribed motions, as the mode began; `absent` are the motions of the ground that
    never act; `radii` are the symbols of what coordinates, velocities and accelerations may differ by from given ones,
    for bounds.
    """

    def __init__(self, model, mode, full_residual, held, absent=()):
        self.model, self.mode, self.absent = model, mode, absent
        count = len(model.coordinates)
        self.free = [i for i, c in enumerate(model.coordinates) if c.name not in mode.held]
        self.freeze = self._freeze(held)
        residual = full_residual
        for name, expression in model.hand_written.items():
            residual[_index(model, name)] = expression
        residual = self.freeze(residual)
        self.raw_reactions = self._along_lines(residual, model.lines)
        self.placeholders = self._placeholders()
        frictionless = self._along_lines(residual, mode.lines)
        residual = ca.SX(residual)
        for k, (coordinate, force, _) in enumerate(mode.forces):
            direction = self.freeze(self._direction(coordinate))
            residual -= direction * self.place(force, model.location(mode.forces, k))
        residual = self._along_lines(residual, mode.lines)
        if mode.lines:
            # What holds a line acts along it alone: friction along another, which it does not hold, is none of it.
            for i in set(range(count)) - set(self.free):
                residual[i] = self.raw_reactions[i]

        symbols = [c.symbol for c in model.coordinates]
        pick = lambda column: ca.vertcat(*[column[i] for i in self.free]) if self.free else ca.SX(0, 1)
        self.q = pick(symbols)
        self.v = pick([s.rate for s in symbols])
        self.a = pick([s.acceleration for s in symbols])
        self.j = pick([s.jerk for s in symbols])
        self.radii = ca.SX.sym("radius", 3 * len(self.free))
        self.r = pick(ca.vertsplit(residual)) if self.free else ca.SX(0, 1)
        self.frictionless = pick(ca.vertsplit(frictionless)) if self.free else ca.SX(0, 1)
        self.reactions = [
            (i, ca.SX(residual[i])) for i in range(count + len(model.motions)) if i not in self.free
        ]
        self.held = held
        self.rates_of_held = ca.vertcat(*[
            mode.drift.get(c.name, ca.SX(0)) for c in model.coordinates + model.motions
        ])
        self._check_linear_in_accelerations()

    def place(self, expression, location=None):
        """An expression of the model file, written there, in the symbols of this mode: frozen coordinates and
        reactions put in."""
        expression = self.freeze(ca.SX(expression))
        for symbol in ca.symvar(expression):
            entry = self.model.placeholders.get(symbol.name())
            if entry is not None and entry[1] not in (None, self.mode):
                raise ModelError(
                    f"the reaction `{symbol.name()}` of mode `{entry[1].name}` is used in mode `{self.mode.name}`, where it is not"
                    f" defined: take the one of that mode, {self.mode.name}.reaction({entry[2]})", location)
        return self.placeholders(expression)

    def _direction(self, coordinate):
        """How a coordinate, or a line, changes with the coordinates of the model and the prescribed motions."""
        line = next((line for line in self.model.lines if line.symbol is coordinate), None)
        place = coordinate if line is None else line.value
        return ca.densify(ca.jacobian(place, configuration(self.model).q)).T

    def _along_lines(self, residual, of):
        """The residual of the coordinates of which lines stand for those they are solved for."""
        if not of:
            return residual
        return ca.densify(self.freeze(along_lines(self.model, of)).T @ residual)

    def _freeze(self, held):
        old, new = [], []
        depending = {line.name for line in self.mode.lines}
        for i, declaration in enumerate(self.model.coordinates):
            if declaration.name not in self.mode.held or declaration.name in depending:
                continue
            value = self.mode.held[declaration.name]
            symbol = declaration.symbol
            old += [symbol, symbol.rate, symbol.acceleration, symbol.jerk]
            new += [
                held[i] if value is None else ca.SX(value),
                self.mode.drift.get(declaration.name, ca.SX(0)), ca.SX(0), ca.SX(0),
            ]
        for motion in self.absent:
            symbol = motion.symbol
            old += [symbol, symbol.rate, symbol.acceleration]
            new += [ca.SX(0)] * 3
        for line in self.mode.lines:
            symbol, place = line.coordinate, self._dependent(line, held, Substitution(old, new))
            rates = [place]
            for _ in range(3):
                rates.append(self._rate(rates[-1], held))
            old += [symbol, symbol.rate, symbol.acceleration, symbol.jerk]
            new += rates
        return Substitution(old, new)

    def _dependent(self, line, held, known):
        """What the coordinate is that a line is solved for, in those that are free: where the line is held, or was as the mode began."""
        value = self.mode.held[line.name]
        at = ca.substitute(line.value, configuration(self.model).q, held) if value is None else ca.SX(value)
        return at - known(line.rest)

    def _rate(self, expression, held):
        """The rate of what depends on free coordinates, prescribed motions, their derivatives, and what drifts."""
        moving = [c.symbol for c in self.model.coordinates if c.name not in self.mode.held]
        motions = [m.symbol for m in self.model.motions]
        column = lambda pick: ca.vertcat(ca.SX(0, 1), *[pick(symbol) for symbol in moving + motions])
        q, v, a = column(lambda s: s), column(lambda s: s.rate), column(lambda s: s.acceleration)
        accelerations, jerks = signals.of(self.model), signals.rates(self.model)
        jerk = lambda motion: next(j for s, j in zip(ca.vertsplit(accelerations), ca.vertsplit(jerks))
                                   if s.element_hash() == motion.acceleration.element_hash())
        j = ca.vertcat(ca.SX(0, 1), *[s.jerk for s in moving], *[jerk(s) for s in motions])
        drift = ca.vertcat(*[ca.SX(self.mode.drift.get(c.name, 0)) for c in self.model.coordinates + self.model.motions])
        result = ca.SX(0)
        for of, rates in ((q, v), (v, a), (a, j), (held, drift)):
            if of.numel():
                result += ca.jtimes(expression, of, rates)
        return result

    def _placeholders(self):
        old, new = [], []
        for symbol, mode, name, settings in self.model.placeholders.values():
            if mode is None and _index(self.model, name) in self.free:
                old.append(symbol)
                new.append(ca.SX(0))
            elif mode in (None, self.mode):
                value = ca.SX(self.raw_reactions[_index(self.model, name)])
                for key, setting in settings.items():
                    discrete = next(d.symbol for d in self.model.discretes if d.name == key)
                    value = ca.substitute(value, discrete, ca.SX(float(setting)))
                old.append(symbol)
                new.append(value)
        return Substitution(old, new)

    def all_coordinates(self):
        """Every coordinate, those that the mode holds among them."""
        return self.freeze(ca.vertcat(ca.SX(0, 1), *[c.symbol for c in self.model.coordinates]))

    def all_rates(self):
        """Their rates."""
        return self.freeze(ca.vertcat(ca.SX(0, 1), *[c.symbol.rate for c in self.model.coordinates]))

    def all_accelerations(self):
        """Their accelerations."""
        return self.freeze(ca.vertcat(ca.SX(0, 1), *[c.symbol.acceleration for c in self.model.coordinates]))

    def roundings(self):
        """What, times the unit roundoff, bounds the rounding of each coordinate that depends on others, then of its rate; 0 of those
        that do not."""
        of = {line.name for line in self.mode.lines}
        chosen = [ca.SX(s if c.name in of else 0) for rate in (False, True) for c in self.model.coordinates
                  for s in [c.symbol.rate if rate else c.symbol]]
        return ca.vertcat(*[graph.running_error(self.freeze(entry)) for entry in chosen])

    def _check_linear_in_accelerations(self):
        mass = ca.jacobian(self.r, self.a)
        if any(ca.which_depends(ca.vec(mass), self.a, 1, False)) if self.free and mass.nnz() else False:
            raise ModelError(f"mode `{self.mode.name}`: the equations are not linear in the accelerations: a force is multiplied"
                             " by what contains an acceleration or a reaction", self.mode.location)

    def system(self):
        """Mass matrix M and b with r = M a + b."""
        zero = ca.SX.zeros(len(self.free))
        return ca.densify(ca.jacobian(self.r, self.a)), ca.substitute(self.r, self.a, zero)

    def inertia(self):
        """Mass matrix without the forces of the mode: ∂²T/∂v² on the free coordinates, or what
        hand-written equations put in its place."""
        return ca.densify(ca.jacobian(self.frictionless, self.a))

    def jacobians(self):
        """∂r/∂a, ∂r/∂v, ∂r/∂q as dense matrices."""
        return [ca.densify(ca.jacobian(self.r, s)) for s in (self.a, self.v, self.q)]

    def along_the_flow(self, expression, signals, signal_rates):
        """d/dt of an expression in (q, v, a, signals, held), with the jerk of the free coordinates."""
        derivative = ca.SX.zeros(expression.shape)
        for symbols, rates in (
            (self.q, self.v), (self.v, self.a), (self.a, self.j),
            (signals, signal_rates), (self.held, self.freeze(self.rates_of_held)),
        ):
            if symbols.numel():
                derivative += ca.jtimes(expression, symbols, rates)
        return derivative

    def jerk_load(self, signals, signal_rates):
        """b with M j + b = 0 for the jerk j: the derivative of r along the flow without M j."""
        total = self.along_the_flow(self.r, signals, signal_rates)
        return ca.substitute(total, self.j, ca.SX.zeros(len(self.free)))

    def magnitude(self):
        """Per equation: what, times the unit roundoff, bounds the rounding error of the residual at given
        accelerations."""
        rows = [graph.rounding(row) for row in ca.vertsplit(self.r)] if self.free else []
        return ca.vertcat(*rows) if rows else ca.SX(0, 1)

    def energies(self):
        """Kinetic and potential energy."""
        return self.freeze(ca.vertcat(kinetic_energy(self.model), potential_energy(self.model)))

    def momenta(self):
        """∂T/∂v for every coordinate and ground motion."""
        x = configuration(self.model)
        return ca.densify(self.freeze(ca.jacobian(kinetic_energy(self.model), x.v).T))

    def carried(self):
        """Rates of what impulses act along where no coordinate moves: those of walls, belts and constraints that do."""
        x = configuration(self.model)
        rates = [c.symbol.rate for c in self.model.coordinates]
        at_rest = Substitution(rates, [ca.SX(0)] * len(rates))
        return ca.vertcat(ca.SX(0, 1), *[
            self.freeze(at_rest(ca.SX(impulse.expression if impulse.is_rate else ca.jtimes(impulse.expression, x.q, x.v))))
            for impulse in self.model.impulses])

    def powers(self):
        """Dissipated power and input power.

        Input power is the power of external forces, of ground reactions on the moving ground, of
        the reactions of drifting coordinates and of moving friction partners.
        """
        model, mode = self.model, self.mode
        x = configuration(model)
        rayleigh = sum(model.dissipations, ca.SX(0))
        dissipated = ca.dot(ca.jacobian(rayleigh, x.v).T, x.v)
        power_in = ca.SX(0)
        for coordinate, force in model.external:
            power_in += force * coordinate.rate
        for coordinate, force, against in mode.forces:
            force = self.place(force)
            rate = ca.dot(self._direction(coordinate), x.v)
            dissipated -= force * (rate - against)
            power_in += force * against
        count = len(model.coordinates)
        for i, reaction in self.reactions:
            if i >= count:
                power_in += reaction * model.motions[i - count].symbol.rate
            elif model.coordinates[i].name in mode.drift:
                name = model.coordinates[i].name
                power_in += reaction * mode.line_drift.get(name, mode.drift[name])
        return self.freeze(ca.vertcat(dissipated, power_in))


def impact_velocities(model, before, after, prescribed, conserve):
    """See Model.impact_velocities."""
    if not conserve:
        return [(coordinate.rate, ca.SX(rate)) for coordinate, rate in prescribed]
    x = configuration(model)
    kinetic = kinetic_energy(model)
    momentum = ca.jacobian(kinetic, x.v).T
    coordinates = [c.symbol for c in model.coordinates]
    rates = {c.name(): ca.SX(0) for c in coordinates}
    for coordinate, rate in prescribed:
        rates[coordinate.name()] = ca.SX(rate)
    unknown = [ca.SX.sym(c.name() + ".after") for c in conserve]
    for coordinate, symbol in zip(conserve, unknown):
        rates[coordinate.name()] = symbol
    old = ca.vertcat(*[c.rate for c in coordinates])
    new = ca.vertcat(*[rates[c.name()] for c in coordinates])
    rows = [_index(model, c.name()) for c in conserve]

    def with_discretes(expression, settings):
        for discrete, value in settings:
            expression = ca.substitute(expression, discrete, ca.SX(value))
        return expression

    momenta_before = with_discretes(ca.vertcat(*[momentum[i] for i in rows]), before)
    momenta_after = ca.substitute(
        with_discretes(ca.vertcat(*[momentum[i] for i in rows]), after), old, new)
    column = ca.vertcat(*unknown)
    mass = ca.jacobian(momenta_after, column)
    load = momenta_before - ca.substitute(momenta_after, column, ca.SX.zeros(len(unknown)))
    solution = ca.inv_minor(ca.densify(mass)) @ load
    result = [(coordinate.rate, rate) for coordinate, rate in prescribed]
    return result + [(c.rate, solution[i]) for i, c in enumerate(conserve)]
