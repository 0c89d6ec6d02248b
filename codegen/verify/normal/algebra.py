"""Exact normal form of trigonometric polynomials: the proof behind every verdict.

An expression is a sum of `rational number x monomial x harmonic`, where a harmonic is the sine or
cosine of a rational combination of angles. Products of harmonics become sums, (product to sum),
the sign of an angle is fixed, and a discrete state with values +1 and -1 has the square 1. What
remains is unique: polynomials times the cosines and sines of distinct angles are linearly
independent, and so are 1 and lambda on {+1, -1}. Hence two expressions are identical exactly when
their normal forms are equal, and no heuristic simplification is involved. Quotients of such polynomials
(the tangent, what was divided by a sum) are identical exactly when the terms of their difference are none:
their divisors are zero nowhere but on a set without interior.

Inside the class: sums, products, integer powers, quotients, sin and cos of rational
combinations of angles (each possibly times a discrete state, or a sign), sign and Abs of any of these
as opaque factors. Anything else raises `NotInClass`, which names the expression.

The square of a sign is 1, but where its argument is zero: identities with signs hold almost everywhere.
"""

from fractions import Fraction

from ..errors import NotInClass
from ..input.rates import Rate
from .form import ONE, Form, Opaque, expression

__all__ = ["ONE", "Form", "Opaque", "Ring", "expression"]


# Terms of a power of a sum, multiplied out: the energies of eight links have two hundred, and what is judged of thousands is read by nobody.
MOST = 1000


class Ring:
    """The symbols of a problem: `involutions` are the names whose square is 1, `first` the names
    that lead an angle and so take the positive sign in it (the alpha of alpha - theta), `moving` the names that have a rate
    (with a d before it) and an acceleration."""

    def __init__(self, involutions=(), first=(), moving=()):
        self.involutions = frozenset(involutions)
        self.chain = {d + name: "d" + d + name for name in moving for d in ("", "d")}
        self.accelerations = {"dd" + name for name in moving}
        self.first = {name: i for i, name in enumerate(first)}

    def involutive(self, name):
        """Whether the square of a factor is 1."""
        return name in self.involutions or isinstance(name, Opaque) and name.function == "sign"

    def form(self, terms):
        """The form of a dictionary of terms, without zeros; whole numbers as integers, which are
        several times faster than fractions."""
        return Form(self, {key: value.numerator if value.denominator == 1 else value
                           for key, value in terms.items() if value})

    def number(self, value):
        """A rational number (an integer or a Fraction)."""
        return self.form({((), ONE): value})

    def symbol(self, name):
        """A symbol (or an opaque factor)."""
        return Form(self, {(((name, 1),), ONE): 1})

    def power(self, name, exponent):
        """A power of a symbol."""
        return Form(self, {(((name, exponent),), ONE): 1})

    def rank(self, name):
        """Order of the names inside an angle."""
        return (self.first.get(name, len(self.first)), name)

    def harmonic(self, kind, angle):
        """sin or cos of an angle {name: rational}: its sign is fixed, so that it is unique."""
        items = sorted(((n, c) for n, c in angle.items() if c), key=lambda item: self.rank(item[0]))
        if not items:
            return self.number(1 if kind == "cos" else 0)
        sign = 1
        if items[0][1] < 0:
            items = [(n, -c) for n, c in items]
            sign = -1 if kind == "sin" else 1
        return Form(self, {((), (kind, tuple(items))): sign})

    def trigonometric(self, kind, argument):
        """sin or cos of a form that is a rational combination of angles."""
        plain, flipped, state = {}, {}, None
        if argument.over:
            raise NotInClass(f"{kind}({argument}) is not the {kind} of a rational combination of angles")
        for (monomial, harmonic), value in argument.terms.items():
            names = dict(monomial)
            states = [n for n in names if self.involutive(n)]
            others = [n for n in names if not self.involutive(n)]
            if harmonic != ONE or len(others) != 1 or names[others[0]] != 1 or len(states) > 1 \
                    or (states and state not in (None, states[0])):
                raise NotInClass(f"{kind}({argument}) is not the {kind} of a rational combination of angles")
            if states:
                state = states[0]
                flipped[others[0]] = value
            else:
                plain[others[0]] = value
        if state is None:
            return self.harmonic(kind, plain)
        # sin(A + lambda B) = sin A cos B + lambda cos A sin B, cos alike, since lambda = +1 or -1
        first = self.harmonic(kind, plain) * self.harmonic("cos", flipped)
        other = ("cos", 1) if kind == "sin" else ("sin", -1)
        second = self.harmonic(other[0], plain) * self.harmonic("sin", flipped)
        return first + self.symbol(state) * second * other[1]

    def opaque(self, function, argument):
        """sign(...) or Abs(...) of a form, with the sign of the argument fixed."""
        if not argument.terms:
            return self.number(0)
        if argument.over:
            result = self.opaque(function, argument.numerator())
            for divisor, power in argument.over:
                result = result * self.opaque(function, divisor) ** -power
            return result
        factor = self.number(1)
        if min(argument.terms.items(), key=lambda item: str(item[0]))[1] < 0:
            argument = -argument
            if function == "sign":
                factor = -factor
        for state in sorted(self.involutions):
            if all(state in dict(monomial) for monomial, _ in argument.terms):
                argument = argument * self.symbol(state)
                if function == "sign":
                    factor = factor * self.symbol(state)
        if function == "Abs" and argument.is_number():
            return argument
        return factor * self.symbol(Opaque(function, argument))

    def _power(self, base, exponent, expression):
        """The power of a form, as far as it can be multiplied out."""
        if exponent < 2 or len(base.terms) < 2:
            return base**exponent
        result = base
        for _ in range(exponent - 1):
            result = result * base
            if len(result.terms) > MOST:
                raise NotInClass(f"{expression} has more than {MOST} terms where it is multiplied out")
        return result

    def read(self, expression):
        """The normal form of a SymPy expression (or of a Python integer)."""
        import sympy

        if isinstance(expression, Form):
            return expression
        expression = sympy.sympify(expression)
        if not isinstance(expression, sympy.Expr):
            raise NotInClass(f"{expression!r} is not an expression of the symbols s.…")
        if expression.is_Symbol:
            return self.symbol(expression.name)
        if expression.is_Rational:
            return self.number(Fraction(int(expression.p), int(expression.q)))
        if expression.is_Add:
            total, quotients = {}, self.number(0)
            for argument in map(self.read, expression.args):
                if argument.over:
                    quotients += argument
                    continue
                for key, value in argument.terms.items():
                    total[key] = total.get(key, 0) + value
            return self.form(total) + quotients
        if expression.is_Mul:
            product = self.number(1)
            for argument in expression.args:
                product = product * self.read(argument)
            return product
        if expression.is_Pow and expression.exp.is_Integer:
            return self._power(self.read(expression.base), int(expression.exp), expression)
        if expression.func in (sympy.sin, sympy.cos):
            return self.trigonometric(expression.func.__name__, self.read(expression.args[0]))
        if expression.func in (sympy.tan, sympy.cot, sympy.sec, sympy.csc):
            angle = self.read(expression.args[0])
            sine, cosine = self.trigonometric("sin", angle), self.trigonometric("cos", angle)
            above = {sympy.tan: sine, sympy.cot: cosine}.get(expression.func, self.number(1))
            return above * (cosine if expression.func in (sympy.tan, sympy.sec) else sine).inverse()
        if expression.func == Rate:
            inner = self.read(expression.args[0])
            if found := sorted(inner.names() & self.accelerations):
                raise NotInClass(f"{expression}: the time derivative of an acceleration, {found[0]}, is no part of an equation of motion")
            return inner.rate(self.chain)
        if expression.func in (sympy.sign, sympy.Abs):
            return self.opaque(expression.func.__name__, self.read(expression.args[0]))
        raise NotInClass(f"{expression} is not a quotient of trigonometric polynomials: write it with +, -, *, /, integer "
                         "powers, sin, cos, tan, sign and Abs, and with exact numbers")


def ring_of(paper):
    """The ring of a paper's symbols."""
    symbols = paper.symbols.values()
    return Ring([x.name for x in symbols if x.role == "discrete"], [x.name for x in symbols if x.role == "parameter"],
                [x.name for x in symbols if x.role in ("coordinate", "input")])
