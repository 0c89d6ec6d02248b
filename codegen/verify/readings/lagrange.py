"""Equations of motion and reactions from energies, by Lagrange's equations, in normal form."""

from ..errors import NotInClass, PaperError
from ..input.namespace import Mathematics, sympy_namespace
from ..judgements.singular import singular
from ..normal.algebra import ring_of
from ..normal.intervals import intervals, signs
from ..normal.quasi import Quasi
from ..normal.solved import solved


class Motion:
    """What follows from energies: equations of motion, mass matrix, reactions (normal forms)."""

    def __init__(self, paper, energies):
        self.paper, self.energies = paper, energies
        for name in energies.extra:
            if name in paper.symbols:
                raise PaperError(f"the energies '{energies.name}' redeclare the symbol '{name}'")
        self.ring = ring_of(paper)
        self.s = sympy_namespace(paper, energies.extra)
        self.m = Mathematics()
        self.coordinates = paper.coordinates() + list(energies.extra)
        moving = list(dict.fromkeys(self.coordinates + paper.positions() + [x.name for x in paper.symbols.values() if x.role == "input"]))
        self.chain = {n: "d" + n for n in moving}
        self.chain.update({"d" + n: "dd" + n for n in moving})
        self.kinetic = self._read(energies.kinetic)
        self.potential = self._read(energies.potential)
        self.dissipation = self._read(energies.dissipation) if energies.dissipation else self.ring.number(0)
        self.quasi = Quasi(paper, self.ring, self.s, self.m) if paper.quasi else None
        if self.quasi and energies.extra:
            raise PaperError(f"the energies '{energies.name}' have a coordinate that the paper has not, and the paper has quasi-velocities")
        if self.quasi:
            self._moved = self.quasi.in_positions(self.kinetic)
            self.kinetic, self.dissipation = self.quasi.in_quasi(self.kinetic), self.quasi.in_quasi(self.dissipation)
        self.singular = singular(paper, self.ring, self.s, self.m)
        self.held = {p + n: 0 for n in energies.extra for p in ("", "d", "dd")}
        self._residuals, self._solved, self._units = {}, {}, None
        self._check(moving)

    def _check(self, moving):
        """Raises a PaperError where Lagrange's equations would not be what `residual` computes."""
        rates, accelerations = {"d" + n for n in moving}, {"dd" + n for n in moving}
        wrong = [("kinetic energy", self.kinetic, accelerations), ("potential", self.potential, rates | accelerations),
                 ("dissipation", self.dissipation, accelerations)]
        for what, form, names in wrong:
            if found := sorted(form.names() & names):
                raise PaperError(f"the {what} of '{self.energies.name}' contains {', '.join(found)}")
        for name in self.energies.forces:
            if name not in [*self.coordinates, *self.paper.positions()]:
                raise PaperError(f"'{self.energies.name}' has a force on '{name}', which is no coordinate")
        for number in [*self.energies.references, *self.energies.scales]:
            if number not in self.paper.equations:
                raise PaperError(f"'{self.energies.name}' has a reference for equation ({number}), which the paper does not have")

    def _read(self, function, *context):
        """The form of a function of the namespaces."""
        return self.ring.read(self.energies.called(function, self.s, self.m, *context))

    def squares(self):
        """The declared squares, [(coefficient, velocity)] as forms."""
        found = self.energies.called(lambda s, m: [(coefficient, velocity) for coefficient, velocity in self.energies.squares(s, m)], self.s, self.m)
        return [(self.ring.read(coefficient), self.ring.read(velocity)) for coefficient, velocity in found]

    def units(self):
        """What is printed as one: sums that have a symbol, and sines, cosines and their products in the kinetic energy."""
        if self._units is None:
            import sympy

            products = sympy.preorder_traversal(sympy.sympify(self.energies.kinetic(self.s, self.m)))
            found = [sympy.Mul(*[f for f in sympy.Mul.make_args(x) if f.as_base_exp()[0].func in (sympy.sin, sympy.cos)])
                     for x in products if x.is_Mul or x.is_Pow]
            found += [reading(self.s, self.m) for reading in self.paper.definitions.values()]
            forms = []
            for written in found:
                try:
                    forms.append(self.ring.read(written))
                except NotInClass:
                    continue  # a root that occurs by its square alone
            self._units = [form for form in dict.fromkeys(forms) if len(form.terms) > 1 and not form.over]
        return self._units

    def residual(self, name):
        """d/dt dT/dv - dT/dq + dV/dq + dD/dv - Q of a coordinate, which is its reaction where it
        is held; the further coordinates of the energies at zero."""
        if name not in self._residuals:
            if self.quasi:
                rows = [self._moved.diff("d" + x).rate(self.chain) - self._moved.diff(x) + self.potential.diff(x) for x in self.quasi.positions]
                for k, x in enumerate(self.quasi.positions):
                    rows[k] -= self._read(self.energies.forces[x]) if x in self.energies.forces else 0
                form = self.quasi.projected(name, rows)
            else:
                form = self.kinetic.diff("d" + name).rate(self.chain) - self.kinetic.diff(name) + self.potential.diff(name)
            form += self.dissipation.diff("d" + name)
            if name in self.energies.forces:
                form -= self._read(self.energies.forces[name])
            self._residuals[name] = form.substitute(self.held)
        return self._residuals[name]

    def solved(self, name):
        """The acceleration of a coordinate minus what gives it: the equations of motion solved for it."""
        if name not in self._solved:
            rows = self.paper.coordinates()
            loads = [self.residual(row).substitute({"dd" + n: 0 for n in rows}) for row in rows]
            accelerations = [self.ring.symbol("dd" + n) for n in rows]
            self._solved[name] = solved(self.mass(), loads, rows.index(name), accelerations)
        return self._solved[name]

    def at_rest(self, name, *held):
        """The reaction of a coordinate while the coordinates `held` stay still at zero."""
        return self.residual(name).substitute({p + n: 0 for n in held for p in ("", "d", "dd")})

    def frozen(self, name, *frozen):
        """The reaction of a coordinate while the coordinates `frozen` do not move."""
        return self.residual(name).substitute({p + n: 0 for n in frozen for p in ("d", "dd")})

    def reference(self, equation):
        """The normal form that an equation must have: its equation of motion, or what the
        energies' reference says; None where nothing is known."""
        if equation.number in self.energies.references:
            form = self._read(self.energies.references[equation.number], self)
            if equation.kind == "value" and equation.of in form.names():
                raise PaperError(f"the reference of '{self.energies.name}' for ({equation.number}) gives {equation.of} by itself")
            return form
        if equation.kind == "motion":
            return self.residual(equation.of)
        return None

    def scale(self, number):
        """The factor of the printed terms of a sign rule, proved positive for every parameter set."""
        function = self.energies.scales.get(number)
        if not function:
            return self.ring.number(1)
        factor = self._read(function)
        if not self.paper.sets or any(signs([factor], intervals(values)) != [1] for values in self.paper.sets.values()):
            raise PaperError(f"the scale of the reference for ({number}) is not shown to be positive: it must be so for every one "
                             "of the paper's parameter sets, of which there is at least one")
        return factor

    def mass(self):
        """Mass matrix of the paper's coordinates, as a list of rows."""
        rows = self.paper.coordinates()
        return [[self.kinetic.diff("d" + i).diff("d" + j).substitute(self.held) for j in rows] for i in rows]
