"""Printed equations in normal form: what the judgements judge."""

from fractions import Fraction
from functools import cached_property
from itertools import product

from sympy import Expr, Mul, cos, sin, sympify

from ..errors import NotInClass, PaperError, UnitError
from ..input import units
from ..input.namespace import Mathematics, sympy_namespace
from ..normal.algebra import ring_of
from ..normal.points import at_point, symmetric
from ..normal.quasi import Quasi
from ..normal.scales import scales
from .helmholtz import lagrangian
from .singular import singular


class Subject:
    """Printed equations in normal form: `forms[number]` lists one form for each term."""

    def __init__(self, paper, base=None):
        """`base` is a subject that shares all but a few equations: their forms are not redone."""
        if not base:
            paper.check()
        self.paper = paper
        self.ring = base.ring if base else ring_of(paper)
        self.s = base.s if base else sympy_namespace(paper)
        self.m = base.m if base else Mathematics()
        self.dimension = base.dimension if base else units.table(paper.symbols.values())
        self.known = base.known if base else {}
        self.shared = base.shared if base else {}  # what is made once for a paper, by name
        self.quasi = base.quasi if base else Quasi(paper, self.ring, self.s, self.m) if paper.quasi else None
        self.singular = base.singular if base else singular(paper, self.ring, self.s, self.m)
        self.expressions, self.forms, self.memo = {}, {}, {}
        kept = set()
        for number, equation in paper.equations.items():
            if base and base.paper.equations.get(number) is equation:
                self.expressions[number], self.forms[number] = base.expressions[number], base.forms[number]
                kept.add(number)
            else:
                self.expressions[number] = self._terms(equation)
                self.forms[number] = [self._form(number, k, term) for k, term in enumerate(self.expressions[number], 1)]
            if not base and not self.forms[number]:
                raise PaperError(f"equation ({number}) has no terms")
        if base:
            # a key's second part is the number of the equation that its value depends on, or several, or None
            self.memo = {key: value for key, value in base.memo.items()
                         if key[1] is None or key[1] in kept or isinstance(key[1], tuple) and kept.issuperset(key[1])}

    def _terms(self, equation):
        """The terms of an equation as SymPy expressions; an error in its function names it."""
        try:
            terms = equation.terms(self.s, self.m)
        except Exception as error:  # whatever a model file does wrong is its author's to read
            raise PaperError(f"equation ({equation.number}): {error}") from error
        known, result = set(self.paper.names()), []
        for k, term in enumerate(terms, 1):
            # text would be read as a formula of other symbols, a list as no formula at all
            if not isinstance(term, (Expr, int, Fraction)) or isinstance(term, bool):
                raise PaperError(f"equation ({equation.number}), term {k}: {term!r} is not an expression of the symbols s.… "
                                 "with exact numbers" + ("; write *group(...)" if isinstance(term, (list, tuple)) else ""))
            result.append(sympify(term))
            for symbol in sorted(result[-1].free_symbols, key=lambda x: x.name):
                if symbol.name not in known:
                    raise PaperError(f"equation ({equation.number}), term {k}: the symbol '{symbol}' is not declared")
        return result

    def _form(self, number, k, term):
        """The form of a term; an error names it."""
        try:
            return self.read(term)
        except NotInClass as error:
            raise NotInClass(f"equation ({number}), term {k}: {error}") from error

    def read(self, term):
        """The form of an expression, read once."""
        if term not in self.known:
            self.known[term] = self.ring.read(term)
        return self.known[term]

    def measure(self, term):
        """The dimension of a term, measured once; a UnitError where it has none."""
        known = self.shared.setdefault("dimensions", {})
        if term not in known:
            try:
                known[term] = units.measure(term, self.dimension)
            except UnitError as error:
                known[term] = error
        if isinstance(known[term], UnitError):
            raise known[term]
        return known[term]

    def units(self):
        """The sines, cosines and their products that the paper prints and the algebra takes apart."""
        found = {}
        for terms in self.expressions.values():
            for term in terms:
                factors = [f for f in Mul.make_args(term) if f.as_base_exp()[0].func in (sin, cos)]
                form = self.read(Mul(*factors))
                if len(form.terms) > 1:
                    found[form] = True
        return list(found)

    def each(self, name, judge, *context):
        """The violations of all equations, where `judge(number)` gives those of one: what is known
        from the base about an equation that has not changed is not judged again."""
        violations = []
        for number in self.paper.equations:
            key = (name, number, *context)
            if key not in self.memo:
                self.memo[key] = judge(number)
            violations += self.memo[key]
        return violations

    def remembered(self, key, make):
        """What `make()` gives, made once for the equations that the key names."""
        if key not in self.memo:
            self.memo[key] = make()
        return self.memo[key]

    def total(self, number):
        """The sum of an equation's terms."""
        return self.remembered(("total", number), lambda: sum(self.forms[number], self.ring.number(0)))

    def slope(self, number, name):
        """The derivative of the sum of an equation's terms by a name."""
        return self.remembered(("slope", number, name), lambda: self.total(number).diff(name))

    def conservative(self, number):
        """The sum without what is declared dissipative."""
        return self.remembered(("conservative", number), lambda: self.total(number).substitute(
            {x.name: 0 for x in self.paper.symbols.values() if x.dissipative}))

    def factors(self):
        """The constants that an equation may have been multiplied by: 1, -1 and these times
        each discrete state."""
        one = self.ring.number(1)
        return [one, -one] + [sign * self.ring.symbol(n) for n in sorted(self.ring.involutions) for sign in (one, -one)]

    def in_order(self, rows):
        """What belongs to the equations of motion, in the order of the coordinates; nothing is zero."""
        of = {e.of: row for e, row in zip(self.paper.motions(), rows)}
        return [of.get(name, self.ring.number(0)) for name in self.paper.coordinates()]

    @cached_property
    def solved(self):
        """Whether the equations of motion are solved for the accelerations: none has that of another, and there is a divisor, a
        sum that depends on the coordinates. A mass matrix is then not what they show."""
        motions, q = self.paper.motions(), set(self.paper.coordinates())
        alone = not any(self.slope(e.number, "dd" + f.of) for e in motions for f in motions if e is not f)
        return len(motions) > 1 and alone and any(len(divisor.terms) > 1 and divisor.names() & q for e in motions
                                                  for form in self.forms[e.number] for divisor, _ in form.over)

    @cached_property
    def scales(self):
        """The factor of each equation of motion, by number (normal/scales.py)."""
        return scales(self)

    @cached_property
    def multipliers(self):
        """For each equation of motion, its scale times the constant that makes the mass matrix most
        nearly symmetric; the first equation keeps 1, and 1 is preferred."""
        motions = self.paper.motions()
        rows = [[self.scales[e.number] * self.slope(e.number, "dd" + f.of) for f in motions] for e in motions]
        if not motions or not any(row[i] != rows[i][j] for j, row in enumerate(rows) for i in range(len(motions))):
            return self._uncoupled(dict(self.scales), motions, rows)
        cost, choice = self._most_symmetric(rows)
        found = {e.number: factor * self.scales[e.number] for e, factor in zip(motions, choice)}
        return self._uncoupled(cost and self._common_functions(motions, rows) or found, motions, rows)

    def _most_symmetric(self, rows):
        """(terms in which a matrix is not symmetric, the constants of its rows with which these are fewest): the first is 1, and of
        equals 1 is preferred."""
        factors, costs = self.factors(), {}

        def apart(i, j, one, other):
            """The terms in which two couplings differ, each times its constant, by places of these."""
            # constants are their own reciprocals: their product alone counts
            if (i, j, one, other) not in costs:
                costs[i, j, one, other] = len((factors[one] * factors[other] * rows[i][j] - rows[j][i]).terms)
            return costs[i, j, one, other]

        best, left = None, [(0, (0,))]
        while left:
            cost, choice = left.pop()
            if best is not None and cost >= best[0]:
                continue  # further rows cost nothing less
            if len(choice) == len(rows):
                best = (cost, choice)
                continue
            i = len(choice)
            left += [(cost + sum(apart(i, j, one, other) for j, other in enumerate(choice)), (*choice, one))
                     for one in reversed(range(len(factors)))]
        return best[0], [factors[k] for k in best[1]]

    def _common_functions(self, motions, rows):
        """The multipliers, where they are functions of the coordinates with which all Helmholtz conditions hold; or
        None. What couples two equations says what one of them was divided by."""
        points, one = [[at_point(form, self.ring.involutions) for form in row] for row in rows], self.ring.number(1)
        for i in range(len(motions)):
            # a number is a slip in a coupling
            divided = [i != j and rows[i][j] and rows[j][i] and not rows[j][i].names() & self.ring.involutions
                       and not rows[i][j].proportional(rows[j][i]) for j in range(len(motions))]
            ratios = [points[i][j] / points[j][i] if points[i][j] is not None and points[j][i] else None for j in range(len(motions))]
            if not symmetric(points, [ratio if known else 1.0 for known, ratio in zip(divided, ratios)]):
                continue
            found = {e.number: self.scales[e.number] * (rows[i][j] * rows[j][i].inverse() if divided[j] else one)
                     for j, e in enumerate(motions)}
            self.multipliers = found
            if not lagrangian(self):
                return found
        return None

    def _uncoupled(self, found, motions, rows):
        """The multipliers, where the mass matrix couples some equations to no others, and so says nothing of their common
        constant: that with which least is left of the Helmholtz conditions, and then positive inertias. What the terms in rates and
        coordinates of another equation show that one of them was divided by counts where nothing is left with it."""
        # an equation that has the unit of the energies keeps its constant, where another can be multiplied
        blocks = sorted(_blocks(rows), key=lambda block: all(self.scales[motions[i].number].is_number() for i in block))
        for block in blocks if len(blocks) > 1 else ():
            costs = []
            for factor in self.factors():
                self.multipliers = {**found, **{motions[i].number: factor * found[motions[i].number] for i in block}}
                left = sum(len(part.terms) for v in lagrangian(self) for part in v.message if not isinstance(part, str))
                own = [self.multipliers[motions[i].number] * rows[i][i] for i in block]
                costs.append((left, sum(all(value < 0 for value in form.terms.values()) for form in own), self.multipliers))
            best = min(costs, key=lambda cost: cost[:2])
            found = best[2]
            for ratio in self._shown(found, motions, block[0]) if best[0] and len(block) == 1 else ():
                self.multipliers = {**found, motions[block[0]].number: ratio}
                if not lagrangian(self):
                    found = self.multipliers
                    break
        return self._positive(found, motions, rows, blocks) if len(blocks) > 1 else found

    def _positive(self, found, motions, rows, blocks):
        """The multipliers with another sign for what has a negative inertia, where as little is left of the Helmholtz conditions."""
        negative = [motions[i].number for block in blocks for i in block if
                    all(value < 0 for j in block for value in (found[motions[j].number] * rows[j][j]).terms.values())]
        turned = {**found, **{number: -found[number] for number in negative}}
        self.multipliers = found
        left = len(lagrangian(self))
        self.multipliers = turned
        return turned if negative and len(lagrangian(self)) <= left else found

    def _shown(self, found, motions, i):
        """The multipliers of an equation with which a term in a rate or a coordinate is what another equation needs: monomials or
        functions of parameters."""
        mine, result = self.conservative(motions[i].number), []
        for other in motions[:i] + motions[i + 1:]:
            theirs = found[other.number] * self.conservative(other.number)
            for d, sign in (("d", -1), ("", 1)):
                below, above = mine.diff(d + other.of), theirs.diff(d + motions[i].of)
                if below and above and not below.names() & self.ring.involutions:
                    result.append(above * below.inverse() * sign)
        # a number is a slip in a coupling, but where there is one term alone
        alone = len(self.forms[motions[i].number]) == 1
        return [ratio for ratio in result if not ratio.names() - self.ring.first.keys() and (alone or not ratio.is_number())]


def _blocks(rows):
    """The sets of equations that a mass matrix couples, as lists of their places."""
    blocks = []
    for i, row in enumerate(rows):
        joined = [block for block in blocks if any(row[j] or rows[j][i] for j in block)]
        blocks = [block for block in blocks if block not in joined] + [sorted(sum(joined, []) + [i])]
    return blocks
