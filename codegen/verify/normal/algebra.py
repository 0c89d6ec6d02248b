"""Exact normal form of trigonometric polynomials: the proof behind every verdict.

An expression is a sum of `rational number x monomial x harmonic`, where a harmonic is the sine or
cosine of a rational combination of angles. Products of harmonics become sums, (product to sum),
the sign of an angle is fixed, and a discrete state with values +1 and -1 has the square 1. What
remains is unique: polynomials times the cosines and sines of distinct angles are linearly
independent, and so are 1 and lambda on {+1, -1}. Hence two expressions are identical exactly when
their normal forms are equal, and no heuristic simplification is involved.

Inside the class: sums, products, integer powers, division by monomials, sin and cos of rational
combinations of angles (each possibly times a discrete state, or a sign), sign and Abs of any of these
as opaque factors. Anything else raises `NotInClass`, which names the expression.

The square of a sign is 1, but where its argument is zero: identities with signs hold almost everywhere.
"""

from fractions import Fraction

from ..errors import NotInClass

ONE = ("cos", ())


class Ring:
    """The symbols of a problem: `involutions` are the names whose square is 1, `first` the names
    that lead an angle and so take the positive sign in it (the alpha of alpha - theta)."""

    def __init__(self, involutions=(), first=()):
        self.involutions = frozenset(involutions)
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

    def read(self, expression):
        """The normal form of a SymPy expression (or of a Python integer)."""
        import sympy

        if isinstance(expression, Form):
            return expression
        expression = sympy.sympify(expression)
        if expression.is_Symbol:
            return self.symbol(expression.name)
        if expression.is_Rational:
            return self.number(Fraction(int(expression.p), int(expression.q)))
        if expression.is_Add:
            total = {}
            for argument in expression.args:
                for key, value in self.read(argument).terms.items():
                    total[key] = total.get(key, 0) + value
            return self.form(total)
        if expression.is_Mul:
            product = self.number(1)
            for argument in expression.args:
                product = product * self.read(argument)
            return product
        if expression.is_Pow and expression.exp.is_Integer:
            return self.read(expression.base) ** int(expression.exp)
        if expression.func in (sympy.sin, sympy.cos):
            return self.trigonometric(expression.func.__name__, self.read(expression.args[0]))
        if expression.func in (sympy.sign, sympy.Abs):
            return self.opaque(expression.func.__name__, self.read(expression.args[0]))
        raise NotInClass(f"{expression} is not a trigonometric polynomial: write it with +, -, *, integer "
                         "powers, division by monomials, sin, cos, sign and Abs, and with exact numbers")


class Opaque:
    """`sign` or `Abs` of a form: a factor of a monomial that the algebra does not look into."""

    def __init__(self, function, argument):
        self.function = function
        self.argument = argument
        self.name = f"{function}({argument})"

    def __eq__(self, other):
        return isinstance(other, Opaque) and self.name == other.name

    def __hash__(self):
        return hash(self.name)

    def __str__(self):
        return self.name


def _multiply(ring, left, right):
    """Product of two monomials."""
    powers = dict(left)
    for name, exponent in right:
        powers[name] = powers.get(name, 0) + exponent
        if ring.involutive(name):
            powers[name] %= 2
    return tuple(sorted(((n, e) for n, e in powers.items() if e), key=lambda item: str(item[0])))


def _harmonics(ring, left, right):
    """Product of two harmonics as [(factor, harmonic)]."""
    if left == ONE:
        return [(1, right)]
    if right == ONE:
        return [(1, left)]
    sums, differences = dict(left[1]), dict(left[1])
    for name, value in right[1]:
        sums[name] = sums.get(name, 0) + value
        differences[name] = differences.get(name, 0) - value
    half = Fraction(1, 2)
    kind, signs = {
        ("cos", "cos"): ("cos", (half, half)),
        ("sin", "sin"): ("cos", (-half, half)),
        ("sin", "cos"): ("sin", (half, half)),
        ("cos", "sin"): ("sin", (half, -half)),
    }[left[0], right[0]]
    result = []
    for factor, angle in zip(signs, (sums, differences)):
        for (_, harmonic), value in ring.harmonic(kind, angle).terms.items():
            result.append((factor * value, harmonic))
    return result


class Form:
    """An expression in normal form: {(monomial, harmonic): rational}. Immutable."""

    __slots__ = ("ring", "terms")

    def __init__(self, ring, terms):
        self.ring = ring
        self.terms = terms

    def _other(self, other):
        return other if isinstance(other, Form) else self.ring.number(other)

    def __add__(self, other):
        total = dict(self.terms)
        for key, value in self._other(other).terms.items():
            total[key] = total.get(key, 0) + value
        return self.ring.form(total)

    __radd__ = __add__

    def __neg__(self):
        return Form(self.ring, {key: -value for key, value in self.terms.items()})

    def __sub__(self, other):
        return self + (-self._other(other))

    def __rsub__(self, other):
        return self._other(other) - self

    def __mul__(self, other):
        total = {}
        for (m1, h1), v1 in self.terms.items():
            for (m2, h2), v2 in self._other(other).terms.items():
                monomial = _multiply(self.ring, m1, m2)
                for factor, harmonic in _harmonics(self.ring, h1, h2):
                    key = (monomial, harmonic)
                    total[key] = total.get(key, 0) + factor * v1 * v2
        return self.ring.form(total)

    __rmul__ = __mul__

    def __pow__(self, exponent):
        if exponent < 0:
            return self.inverse() ** -exponent
        result = self.ring.number(1)
        for _ in range(exponent):
            result = result * self
        return result

    def inverse(self):
        """1 / self, of a monomial."""
        if len(self.terms) != 1 or next(iter(self.terms))[1] != ONE:
            raise NotInClass(f"1/({self}): only monomials can be divided by; multiply the equation through")
        (monomial, harmonic), value = next(iter(self.terms.items()))
        flipped = tuple((n, e if self.ring.involutive(n) else -e) for n, e in monomial)
        return self.ring.form({(flipped, harmonic): Fraction(1, value)})

    def __eq__(self, other):
        return isinstance(other, Form) and self.terms == other.terms

    def __hash__(self):
        return hash(frozenset(self.terms.items()))

    def __bool__(self):
        return bool(self.terms)

    def __str__(self):
        return " + ".join(f"{v}*{term_text(key)}" for key, v in sorted(self.terms.items(), key=str)) or "0"

    __repr__ = __str__

    def is_number(self):
        """Whether no symbol is left."""
        return all(key == ((), ONE) for key in self.terms)

    def names(self):
        """Names that occur, also inside angles and opaque factors."""
        found = set()
        for monomial, (_, angle) in self.terms:
            found.update(name for name, _ in angle)
            for name, _ in monomial:
                found |= name.argument.names() if isinstance(name, Opaque) else {name}
        return found

    def diff(self, name):
        """Partial derivative; sign(...) counts as constant, Abs(u) has sign(u) u'."""
        total = self.ring.number(0)
        for (monomial, (kind, angle)), value in self.terms.items():
            rest = Form(self.ring, {((), (kind, angle)): value})
            slope = dict(angle).get(name)
            if slope:
                other = self.ring.harmonic("cos" if kind == "sin" else "sin", dict(angle))
                total += Form(self.ring, {(monomial, ONE): value * slope * (1 if kind == "sin" else -1)}) * other
            for factor, exponent in monomial:
                inner = None
                if factor == name:
                    inner = self.ring.number(1)
                elif isinstance(factor, Opaque) and factor.function == "Abs":
                    inner = self.ring.opaque("sign", factor.argument) * factor.argument.diff(name)
                if inner:
                    lowered = _multiply(self.ring, monomial, ((factor, -1),))
                    total += Form(self.ring, {(lowered, ONE): exponent}) * inner * rest
        return total

    def rate(self, chain):
        """Time derivative, where `chain` gives the name of each varying symbol's rate."""
        total = self.ring.number(0)
        for name in sorted(self.names() & chain.keys()):
            total += self.diff(name) * self.ring.symbol(chain[name])
        return total

    def substitute(self, values):
        """Forms (or rational numbers) put in for names, in angles and opaque factors too."""
        values = {name: self._other(value) for name, value in values.items()}
        opaque = {n for monomial, _ in self.terms for n, _ in monomial if isinstance(n, Opaque)}
        if not ((self.names() | opaque) & values.keys()):
            return self
        total = self.ring.number(0)
        for (monomial, (kind, angle)), value in self.terms.items():
            product = self.ring.number(value)
            for name, exponent in monomial:
                if name in values:
                    factor = values[name]
                elif isinstance(name, Opaque):
                    factor = self.ring.opaque(name.function, name.argument.substitute(values))
                else:
                    factor = self.ring.symbol(name)
                product = product * factor**exponent
            if angle:
                argument = self.ring.number(0)
                for name, slope in angle:
                    argument += values.get(name, self.ring.symbol(name)) * slope
                product = product * self.ring.trigonometric(kind, argument)
            total += product
        return total

    def coefficient(self, name):
        """The factor of `name` where it occurs to the power 1 outside angles."""
        return self.ring.form({
            (tuple(item for item in monomial if item[0] != name), harmonic): value
            for (monomial, harmonic), value in self.terms.items() if (name, 1) in monomial
        })

    def order(self, small):
        """Lowest total degree of the Taylor expansion in the names `small`; None for zero, and for
        what has none (the modulus, or the reciprocal, of what vanishes)."""
        layer, degree = [self] if self else [], 0
        while layer:
            try:
                if any(form.substitute({name: 0 for name in small}) for form in layer):
                    return degree
            except NotInClass:
                return None
            layer = [slope for form in layer for name in small if (slope := form.diff(name))]
            degree += 1
        return None

    def evaluate(self, values, sin, cos, zero=0):
        """The value for numbers (or intervals) by name; not for opaque factors."""
        total = zero
        for (monomial, (kind, angle)), value in self.terms.items():
            product = zero + value.numerator
            product = product / value.denominator
            for name, exponent in monomial:
                product = product * values[name] ** exponent
            if angle:
                argument = zero
                for name, slope in angle:
                    argument = argument + values[name] * slope.numerator / slope.denominator
                product = product * (sin if kind == "sin" else cos)(argument)
            total = total + product
        return total


def term_text(key):
    """One term's monomial and harmonic as plain text."""
    monomial, (kind, angle) = key
    parts = [f"{n}" if e == 1 else f"{n}**{e}" for n, e in monomial]
    if angle:
        inner = " + ".join(n if c == 1 else f"({c})*{n}" for n, c in angle)
        parts.append(f"{kind}({inner})")
    return "*".join(parts) or "1"


def expression(form):
    """The SymPy expression of a form: the sum of its terms."""
    import sympy

    return sympy.Add(*[term_expression(key, value) for key, value in form.terms.items()])


def term_expression(key, value):
    """The SymPy expression of one term."""
    import sympy

    monomial, (kind, angle) = key
    result = sympy.Rational(value.numerator, value.denominator)
    for name, exponent in monomial:
        if isinstance(name, Opaque):
            factor = getattr(sympy, name.function)(expression(name.argument))
        else:
            factor = sympy.Symbol(name, real=True)
        result *= factor**exponent
    if angle:
        argument = sum(sympy.Rational(c.numerator, c.denominator) * sympy.Symbol(n, real=True) for n, c in angle)
        result *= getattr(sympy, kind)(argument)
    return result
