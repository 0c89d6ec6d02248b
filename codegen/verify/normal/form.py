"""Sums of terms in normal form, and their quotients."""

from fractions import Fraction
from itertools import product

from ..errors import NotInClass
from .division import content, quotient

ONE = ("cos", ())


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
    """An expression in normal form: the sum of `terms`, {(monomial, harmonic): rational}, over the product of the
    powers of `over`, ((polynomial, power), ...), which is empty for a trigonometric polynomial. Immutable.

    Terms and divisors have no common factor among the divisors. A quotient is zero exactly where its terms are none; two
    are equal exactly where their difference is zero."""

    __slots__ = ("ring", "terms", "over")

    def __init__(self, ring, terms, over=()):
        self.ring = ring
        self.terms = terms
        self.over = over

    def _other(self, other):
        return other if isinstance(other, Form) else self.ring.number(other)

    def numerator(self):
        """The terms alone."""
        return Form(self.ring, self.terms) if self.over else self

    def denominator(self):
        """What the terms stand over, multiplied out."""
        result = self.ring.number(1)
        for divisor, power in self.over:
            result = result * divisor**power
        return result

    def __add__(self, other):
        other = self._other(other)
        if self.over or other.over:
            return self._add_quotient(other)
        total = dict(self.terms)
        for key, value in other.terms.items():
            total[key] = total.get(key, 0) + value
        return self.ring.form(total)

    __radd__ = __add__

    def _add_quotient(self, other):
        common = dict(self.over)
        for divisor, power in other.over:
            common[divisor] = max(power, common.get(divisor, 0))
        total = self.ring.number(0)
        for part in (self, other):
            raised, powers = part.numerator(), dict(part.over)
            for divisor, power in common.items():
                raised = raised * divisor ** (power - powers.get(divisor, 0))
            total += raised
        return total.divided(common)

    def divided(self, divisors):
        """A polynomial over {divisor: power}, without the divisors that it contains."""
        rest, over = self, []
        for divisor, power in divisors.items():
            while power and rest and (less := quotient(rest, divisor)) is not None:
                rest, power = less, power - 1
            if power and rest:
                over.append((divisor, power))
        return Form(self.ring, rest.terms, tuple(sorted(over, key=str)))

    def __neg__(self):
        return Form(self.ring, {key: -value for key, value in self.terms.items()}, self.over)

    def __sub__(self, other):
        return self + (-self._other(other))

    def __rsub__(self, other):
        return self._other(other) - self

    def __mul__(self, other):
        other = self._other(other)
        if other.is_one():
            return self
        if self.is_one():
            return other
        total = {}
        for (m1, h1), v1 in self.terms.items():
            for (m2, h2), v2 in other.terms.items():
                monomial = _multiply(self.ring, m1, m2)
                for factor, harmonic in _harmonics(self.ring, h1, h2):
                    key = (monomial, harmonic)
                    total[key] = total.get(key, 0) + factor * v1 * v2
        product = self.ring.form(total)
        if not self.over and not other.over:
            return product
        over = dict(self.over)
        for divisor, power in other.over:
            over[divisor] = over.get(divisor, 0) + power
        return product.divided(over)

    __rmul__ = __mul__

    def __pow__(self, exponent):
        if exponent < 0:
            return self.inverse() ** -exponent
        result = self.ring.number(1)
        for _ in range(exponent):
            result = result * self
        return result

    def inverse(self):
        """1 / self. What is zero for one value of a discrete state is no divisor."""
        if not self.terms:
            raise ZeroDivisionError("division by zero")
        rest = self.denominator()
        if len(self.terms) == 1 and next(iter(self.terms))[1] == ONE:
            (monomial, harmonic), value = next(iter(self.terms.items()))
            flipped = tuple((n, e if self.ring.involutive(n) else -e) for n, e in monomial)
            return rest * self.ring.form({(flipped, harmonic): Fraction(1, value)})
        top = self.numerator()
        states = sorted({n for monomial, _ in self.terms for n, _ in monomial if self.ring.involutive(n)}, key=str)
        for values in product((1, -1), repeat=len(states)):
            if not top.substitute(dict(zip(states, values))):
                at = ", ".join(f"{n} = {v:+d}" for n, v in zip(states, values))
                raise NotInClass(f"1/({self}): it is zero where {at}")
        factor, primitive = content(top)
        return (rest * factor.inverse()).divided({primitive: 1})

    def __eq__(self, other):
        if not isinstance(other, Form):
            return False
        return self.terms == other.terms if self.over == other.over else not (self - other).terms

    def __hash__(self):
        # equal quotients may be written in two ways
        return hash("quotient") if self.over else hash(frozenset(self.terms.items()))

    def __bool__(self):
        return bool(self.terms)

    def __str__(self):
        top = " + ".join(f"{v}*{term_text(key)}" for key, v in sorted(self.terms.items(), key=str)) or "0"
        return f"({top})/" + "/".join(f"({d})" + (f"**{p}" if p > 1 else "") for d, p in self.over) if self.over else top

    __repr__ = __str__

    def is_one(self):
        """Whether it is the number 1."""
        return len(self.terms) == 1 and not self.over and self.terms.get(((), ONE)) == 1

    def is_number(self):
        """Whether no symbol is left."""
        return not self.over and all(key == ((), ONE) for key in self.terms)

    def proportional(self, other):
        """Whether it is another form times a number."""
        if self.over or other.over:
            return bool(other) and (self * other.inverse()).is_number()
        if self.terms.keys() != other.terms.keys():
            return False
        return len({Fraction(value) / other.terms[key] for key, value in self.terms.items()}) <= 1

    def names(self):
        """Names that occur, also inside angles and opaque factors."""
        found = set()
        for monomial, (_, angle) in self.terms:
            found.update(name for name, _ in angle)
            for name, _ in monomial:
                found |= name.argument.names() if isinstance(name, Opaque) else {name}
        for divisor, _ in self.over:
            found |= divisor.names()
        return found

    def diff(self, name):
        """Partial derivative; sign(...) counts as constant, Abs(u) has sign(u) u'."""
        if self.over:
            result = self.numerator().diff(name).divided(dict(self.over))
            for divisor, power in self.over:
                if slope := divisor.diff(name):
                    result -= self * slope.divided({divisor: 1}) * power
            return result
        total = {}
        for (monomial, harmonic), value in self.terms.items():
            kind, angle = harmonic
            for factor, slope in angle:
                if factor == name:
                    key = (monomial, ("cos" if kind == "sin" else "sin", angle))
                    total[key] = total.get(key, 0) + value * slope * (1 if kind == "sin" else -1)
            for factor, exponent in monomial:
                if factor == name:
                    key = (_multiply(self.ring, monomial, ((factor, -1),)), harmonic)
                    total[key] = total.get(key, 0) + value * exponent
                elif isinstance(factor, Opaque) and factor.function == "Abs" and (inner := factor.argument.diff(name)):
                    lowered = Form(self.ring, {(_multiply(self.ring, monomial, ((factor, -1),)), harmonic): value * exponent})
                    for key, part in (lowered * self.ring.opaque("sign", factor.argument) * inner).terms.items():
                        total[key] = total.get(key, 0) + part
        return self.ring.form(total)

    def rate(self, chain):
        """Time derivative, where `chain` gives the name (or the form) of each varying symbol's rate."""
        total = self.ring.number(0)
        for name in sorted(self.names() & chain.keys()):
            rate = chain[name]
            total += self.diff(name) * (rate if isinstance(rate, Form) else self.ring.symbol(rate))
        return total

    def substitute(self, values):
        """Forms (or rational numbers) put in for names, in angles, opaque factors and divisors too; a divisor that becomes
        zero is a ZeroDivisionError."""
        values = {name: self._other(value) for name, value in values.items()}
        result = self._put(values)
        for divisor, power in self.over:
            result = result * divisor._put(values) ** -power
        return result

    def _put(self, values):
        opaque = {n for monomial, _ in self.terms for n, _ in monomial if isinstance(n, Opaque)}
        if not ((self.numerator().names() | opaque) & values.keys()):
            return self.numerator()
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
        """The factor of `name` where it occurs to the power 1 outside angles and divisors."""
        return self.ring.form({
            (tuple(item for item in monomial if item[0] != name), harmonic): value
            for (monomial, harmonic), value in self.terms.items() if (name, 1) in monomial
        }).divided(dict(self.over))

    def order(self, small):
        """Lowest total degree of the Taylor expansion in the names `small`; None for zero, and for
        what has none (the modulus, or the reciprocal, of what vanishes)."""
        if self.over:
            degrees = [self.numerator().order(small), self.denominator().order(small)]
            return degrees[0] - degrees[1] if None not in degrees and degrees[0] >= degrees[1] else None
        layer, degree = [self] if self else [], 0
        while layer:
            try:
                if any(form.substitute({name: 0 for name in small}) for form in layer):
                    return degree
            except (NotInClass, ZeroDivisionError):
                return None
            layer = [slope for form in layer for name in small if (slope := form.diff(name))]
            degree += 1
        return None

    def evaluate(self, values, sin, cos, zero=0, harmonics=None):
        """The value for numbers (or intervals) by name; not for opaque factors. `harmonics`, {harmonic: value}, is filled with
        those that are met: whoever evaluates several forms with the same values hands the same to each."""
        harmonics = {} if harmonics is None else harmonics
        total = zero
        for (monomial, harmonic), value in self.terms.items():
            # what changes nothing is left out: an operation on intervals takes as long with 1 as with others
            product = None if value == 1 else zero + value.numerator
            if value.denominator != 1:
                product = product / value.denominator
            factors = [values[name] ** exponent if exponent != 1 else values[name] for name, exponent in monomial]
            if harmonic != ONE:
                if harmonic not in harmonics:
                    kind, angle = harmonic
                    argument = zero
                    for name, slope in angle:
                        argument = argument + (values[name] * slope.numerator / slope.denominator if slope != 1 else values[name])
                    harmonics[harmonic] = (sin if kind == "sin" else cos)(argument)
                factors.append(harmonics[harmonic])
            for factor in factors:
                product = factor if product is None else product * factor
            total = total + (zero + 1 if product is None else product)
        for divisor, power in self.over:
            total = total / divisor.evaluate(values, sin, cos, zero, harmonics) ** power
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
    """The SymPy expression of a form: the sum of its terms, over its divisors."""
    import sympy

    total = sympy.Add(*[term_expression(key, value) for key, value in form.terms.items()])
    return sympy.Mul(total, *[expression(divisor) ** -power for divisor, power in form.over])


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
