"""Whether a model's energies see the motion of the ground: checked on the expressions, for all values at once.

Bodies see it, since their positions are relative to the ground. What `model.kinetic`, `model.potential` and the like add
must say so itself. With r the residuals of the coordinates and of the motions z of the ground (derive.py), and a translation ξ,
a set of coordinates that together move every body as the ground does:

1. The ground moves something: some r depends on z̈.
2. A constant velocity added to ground and bodies changes no force: no r depends on z or ż.
3. The reaction of the ground is the rate of the total momentum: an energy has the same momentum whether the ground moves or
   the coordinates of a translation do, Σ_ξ ∂T/∂v = ∂T/∂ż.
4. On ground that moves vertically what is heavy is inert by as much: r, guards, conditions and requirements depend on z̈ as
   they do on g. So the reaction of the ground carries the weight of all that has momentum.
"""

import copy
import itertools

import casadi as ca

from . import derive, graph, units
from .errors import ModelError
from .exact import Exact, lifted

_LENGTH = units.parse("m")


def check(model):
    """Refuses a model whose energies or forces contradict one of the four."""
    ground = _of_ground(model)
    if ground:
        check = _Check(model)
        for motion in ground:
            check.of(motion)


def _of_ground(model):
    """The motions of the ground: others are a matter of the model alone."""
    return [motion for motion in model.motions if motion.axis is not None]


class _Check:
    """A model with a symbol for each number that CasADi might round, so that what is found is exact."""

    def __init__(self, model):
        self.model, self.numbers = model, {}
        lift = lambda expressions: [self._lift(e) for e in expressions]
        self.lifted = copy.copy(model)
        self.lifted.bodies = [
            type(b)(self._lift(b.mass), tuple(lift(b.position)),
                    *(None if x is None else self._lift(x) for x in (b.inertia, b.angle)))
            for b in model.bodies]
        self.lifted.kinetic_terms, self.lifted.potentials = lift(model.kinetic_terms), lift(model.potentials)
        self.lifted.dissipations = lift(model.dissipations)
        self.lifted.external = [(c, self._lift(f)) for c, f in model.external]
        self.residual = derive.residual_from_bodies(self.lifted)
        self.exact = Exact([(d.symbol, d.values) for d in model.discretes])
        self.lengths = [i for i, c in enumerate(model.coordinates) if model.dimensions[c.name] == _LENGTH]

    def of(self, motion):
        self._bodies_are_relative(motion)
        self._acts(motion)
        self._changes_no_force_by_velocity(motion)
        self._has_its_momentum(motion)
        if motion.axis == 1:
            self._resists_what_it_weighs(motion)

    def _lift(self, expression):
        return lifted(expression, self.numbers)

    # ---- the four -----------------------------------------------------------------------------

    def _bodies_are_relative(self, motion):
        for k, body in enumerate(self.model.bodies):
            if not self.exact.is_zero(ca.jacobian(ca.vertcat(*body.position), motion.symbol)):
                raise ModelError(f"body {k + 1}: positions are relative to the ground: leave `{motion.name}` out of it",
                                 self.model.location(self.model.bodies, k))

    def _acts(self, motion):
        if self.exact.is_zero(ca.jacobian(self.residual, motion.symbol.acceleration)):
            raise ModelError(f"the ground motion `{motion.name}` moves nothing: no body and no energy of the model sees it. "
                             + self._how(motion), motion.location)

    def _changes_no_force_by_velocity(self, motion):
        where = ca.vertcat(motion.symbol, motion.symbol.rate)
        depends = lambda column: ca.jacobian(column, where)
        why = (f"makes forces depend on where the ground is or how fast it moves (`{motion.name}`), although they are the same"
               " for every observer in steady motion")
        self._refuse(depends, why, motion)
        for mode in self.model.modes:
            for k, (coordinate, force, _) in enumerate(mode.forces):
                if not self.exact.is_zero(depends(self._lift(force))):
                    raise ModelError(f"force on `{coordinate.name()}` in mode `{mode.name}`: `{units.short(force)}` {why}",
                                     self.model.location(mode.forces, k))
        for name, residual in self.model.hand_written.items():
            if name not in self.model.unchecked and not self.exact.is_zero(depends(self._lift(residual))):
                raise ModelError(f"equation of `{name}`: it {why}", self.model.location(self.model.hand_written, name))

    def _has_its_momentum(self, motion):
        rates = ca.vertcat(*[m.symbol.rate for m in _of_ground(self.model)])
        # Where a coordinate moves bodies, the translations below tell what it does.
        place = ca.vertcat(*[p for b in self.lifted.bodies for p in b.position])
        symbols = [self.model.coordinates[i].symbol for i in self.lengths]
        lengths = ca.vertcat(*[s.rate for s in symbols if self.exact.is_zero(ca.jacobian(place, s))])
        for k, term in enumerate(self.lifted.kinetic_terms):
            sees = not self.exact.is_zero(ca.jacobian(term, rates))
            relative = k in self.model.relative_terms
            if relative and sees:
                raise ModelError("kinetic energy: it is said to be relative to the ground, but depends on the ground's velocity",
                                 self.model.location(self.model.kinetic_terms, k))
            if not relative and not sees and not self.exact.is_zero(ca.jacobian(term, lengths)):
                self._refuse_kinetic(k, motion, lambda t: ca.jacobian(t, lengths),
                                     f"may have momentum, but does not see the ground motion `{motion.name}`")
        best = None
        for translation in self._translations(motion):
            wrong = [k for k in range(len(self.lifted.kinetic_terms)) if k not in self.model.relative_terms
                     and not self.exact.is_zero(self._difference(self.lifted.kinetic_terms[k], translation, motion))]
            if not wrong:
                return
            if best is None or len(wrong) < len(best[0]):
                best = wrong, translation
        if best:
            [k, *_], translation = best
            names = " and ".join(f"`{self.model.coordinates[i].name}`" for i in translation)
            self._refuse_kinetic(k, motion, lambda t: self._difference(t, translation, motion),
                                 f"has another momentum where {names} moves the bodies than where the ground motion"
                                 f" `{motion.name}` does, so that the reaction of the ground would not be the rate of the total"
                                 " momentum")

    def _resists_what_it_weighs(self, motion):
        g, model = ca.SX(self.model.gravity_constant), self.model
        if not g.is_symbolic():
            if model.potentials:
                raise ModelError(f"on ground that moves vertically (`{motion.name}`) weights are held against inertia: state"
                                 " gravity as a parameter, by model.gravity(g)", model.location(model.potentials, 0))
            return
        depends = lambda column: ca.jacobian(column, motion.symbol.acceleration) - ca.jacobian(column, g)
        why = (f"does not weigh what it resists the ground motion `{motion.name}` with: gravity `{g}` must enter as the"
               " acceleration of the ground does")
        self._refuse(depends, why, motion, f"write heights as `{self._example()} + {motion.name}`", self._inertia(depends))
        if not motion.available:
            return
        held = ca.vertcat(*[ca.SX.sym(f"{c.name}.held") for c in model.coordinates + model.motions])
        modes = {m.name: derive.ModeEquations(self.lifted, m, self.residual, held) for m in model.modes}

        def refuse(mode, expression, what, location):
            if not self.exact.is_zero(depends(modes[mode.name].place(self._lift(expression)))):
                raise ModelError(f"{what}: `{units.short(expression)}` {why}", location)
        for mode in model.modes:
            for k, (coordinate, force, _) in enumerate(mode.forces):
                refuse(mode, force, f"force on `{coordinate.name()}` in mode `{mode.name}`", model.location(mode.forces, k))
            for requirement in mode.requirements:
                refuse(mode, requirement.expression, "requirement", requirement.location)
        for t in model.transitions:
            refuse(t.source, t.guard, f"guard of `{t.name}`", t.location)
            for condition in ca.vertsplit(t.condition) if t.condition is not None else ():
                refuse(t.target, condition, f"condition of `{t.name}`", t.location)

    # ---- translations -------------------------------------------------------------------------

    def _translations(self, motion):
        """Sets of coordinates, as tuples of indices, that together move all bodies as the ground does; without bodies, all
        energies that see the ground. Coordinates that move none of these may join."""
        model = self.lifted
        place = ca.vertcat(*[p for b in model.bodies for p in b.position])
        if model.bodies:
            one = ca.vertcat(*[float(axis == motion.axis) for _ in model.bodies for axis in (0, 1)])
            moves = lambda i: ca.jacobian(place, model.coordinates[i].symbol)
        else:
            energy = sum((t for t in model.kinetic_terms if ca.depends_on(t, motion.symbol.rate)), ca.SX(0))
            one = ca.jacobian(energy, motion.symbol.rate)
            moves = lambda i: ca.jacobian(energy, model.coordinates[i].symbol.rate)
        columns = {i: moves(i) for i in self.lengths}
        movers = [i for i in self.lengths if not self.exact.is_zero(columns[i])]
        others = [i for i in self.lengths if i not in movers]
        for own in _subsets(movers):
            if own and self.exact.is_zero(sum((columns[i] for i in own), -one)):
                for further in _subsets(others):
                    yield own + further

    def _difference(self, energy, translation, motion):
        """By how much the momentum of an energy differs between a translation and the ground."""
        by_coordinates = sum((ca.jacobian(energy, self.model.coordinates[i].symbol.rate) for i in translation), ca.SX(0))
        return by_coordinates - ca.jacobian(energy, motion.symbol.rate)

    # ---- refusals -----------------------------------------------------------------------------

    def _inertia(self, depends):
        """Where the kinetic energies were written that a weight is held against."""
        model = self.model
        at = [model.location(model.kinetic_terms, k) for k in range(len(model.kinetic_terms))
              if not self.exact.is_zero(depends(self._alone("kinetic_terms", [k])))]
        return f" (the inertia is that of the kinetic energy at {', '.join(at)})" if at else ""

    def _refuse(self, difference, why, motion, how=None, beside=""):
        """Names the part of the model whose forces are at fault, if there is one."""
        if self.exact.is_zero(difference(self.residual)):
            return
        model = self.model
        for group, what in (("potentials", "potential energy"), ("kinetic_terms", "kinetic energy"),
                            ("dissipations", "dissipation"), ("external", "force"), ("bodies", "body")):
            for k in range(len(getattr(model, group))):
                if not self.exact.is_zero(difference(self._alone(group, [k]))):
                    part = getattr(model, group)[k]
                    name = f"{what} {k + 1}" if group == "bodies" else f"{what}: `{units.short(part[1] if group == 'external' else part)}`"
                    how = how or self._how(motion)
                    beside = "" if group == "kinetic_terms" else beside
                    raise ModelError(f"{name} {why}{beside}; {how}", model.location(getattr(model, group), k))
        raise ModelError(f"the model {why}; {how or self._how(motion)}", motion.location)

    def _alone(self, group, indices):
        """The residual of some of the parts of one kind."""
        part = copy.copy(self.lifted)
        for name in ("kinetic_terms", "potentials", "dissipations", "external", "bodies"):
            setattr(part, name, [getattr(self.lifted, name)[k] for k in indices] if name == group else [])
        return derive.residual_from_bodies(part)

    def _refuse_kinetic(self, k, motion, difference, why):
        """Names the terms of a kinetic energy that are at fault by themselves."""
        energy = self.model.kinetic_terms[k]
        terms = [t for t in graph.additive_terms(energy) if not self.exact.is_zero(difference(t))] or [energy]
        named = ", ".join(f"`{units.short(t)}`" for t in terms)
        raise ModelError(f"kinetic energy: {named} {why}; {self._how(motion)}; a spin or an oscillation that carries no momentum"
                         " is stated by model.kinetic(…, relative=True)", self.model.location(self.model.kinetic_terms, k))

    def _how(self, motion):
        return ("rates of coordinates are relative to the ground, energies take absolute ones, such as"
                f" `{self._example()}.rate + {motion.name}.rate`")

    def _example(self):
        names = [self.model.coordinates[i].name for i in self.lengths]
        return "y" if "y" in names else names[0] if names else "x"


def _subsets(items):
    return itertools.chain.from_iterable(itertools.combinations(items, n) for n in range(len(items) + 1))
