"""Exact normal forms: whether an expression is zero for every value of its symbols.

An expression becomes a quotient of polynomials with rational coefficients. Their variables are the symbols, the sine and
cosine of each angle (sums and multiples of angles multiplied out), and whatever else is not rational, such as a square root.
Of these sin² = 1 − cos², √x² = x, |x|² = x², and what the values of a discrete state obey, are used. So a zero that is found is
one. A difference may stay undecided where other relations are needed, such as between sin x and sin πx.
"""

from fractions import Fraction

import casadi as ca

MOST_MULTIPLES = 12
"""Multiples of an angle that are written in its sine and cosine: the normal form grows with them."""

_EXACT = 2**10
"""Numbers that are whole multiples of 1/1024 stay themselves: with these CasADi calculates without rounding."""


def lifted(expression, numbers):
    """The same expression with a symbol for each number that CasADi might round when it differentiates; `numbers` keeps
    the symbols, so that the same number has the same one in every expression."""
    expression = ca.densify(ca.SX(expression))
    symbols = ca.symvar(expression)
    function = ca.Function("lift", symbols, [expression])
    work, plain, out = {}, {}, [None] * expression.numel()
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        into, source = function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            out[into[1]] = work[source[0]]
            continue
        if op == ca.OP_CONST:
            value = function.instruction_constant(k)
            plain[into[0]] = ca.SX(value)
            exact = value * _EXACT == int(value * _EXACT) and abs(value) < _EXACT
            size = abs(value)
            result = ca.SX(value) if exact else (1 if value > 0 else -1) * numbers.setdefault(size, ca.SX.sym(repr(size)))
        else:
            plain.pop(into[0], None)
            if op == ca.OP_INPUT:
                result = symbols[source[0]]
            else:
                given = [work[i] for i in source]
                if op in (ca.OP_POW, ca.OP_CONSTPOW) and source[1] in plain:
                    given[1] = plain[source[1]]
                result = ca.SX.binary(op, *given) if len(given) == 2 else ca.SX.unary(op, *given)
        work[into[0]] = result
    return ca.reshape(ca.vertcat(*out), *expression.shape)


class Exact:
    """Normal forms over one set of variables. A polynomial is a dict from monomials, sorted tuples of (variable, power), to
    rational coefficients; a value is a numerator and a denominator."""

    def __init__(self, discretes=()):
        """`discretes` lists (symbol, values) of what takes no other values."""
        self.names, self.relations = {}, {}
        self.discretes = {symbol.element_hash(): [Fraction(v) for v in values] for symbol, values in discretes}
        self.kept = [symbol for symbol, _ in discretes]

    def is_zero(self, expression):
        """Whether every entry is shown to be zero."""
        return all(not numerator for numerator, _ in self.values(expression))

    def values(self, expression):
        """The normal forms of the entries."""
        expression = ca.densify(ca.SX(expression))
        symbols = ca.symvar(expression)
        # Symbols are known by where they are kept.
        self.kept += symbols
        function = ca.Function("exact", symbols, [expression])
        work, out = {}, [({}, _ONE)] * expression.numel()
        for k in range(function.n_instructions()):
            op = function.instruction_id(k)
            into, source = function.instruction_output(k), function.instruction_input(k)
            if op == ca.OP_OUTPUT:
                out[into[1]] = work[source[0]]
            elif op == ca.OP_CONST:
                work[into[0]] = self._number(function.instruction_constant(k))
            elif op == ca.OP_INPUT:
                work[into[0]] = self._symbol(symbols[source[0]])
            else:
                work[into[0]] = self._operation(op, [work[i] for i in source])
        return out

    # ---- variables ----------------------------------------------------------------------------

    def _variable(self, name):
        """The polynomial of a variable."""
        return {((self.names.setdefault(name, len(self.names)), 1),): Fraction(1)}

    def _number(self, value):
        if value != value or value in (float("inf"), float("-inf")):
            return self._variable(("number", repr(value))), _ONE
        return ({(): Fraction(value)} if value else {}), _ONE

    def _symbol(self, symbol):
        key = symbol.element_hash()
        variable = self._variable(("symbol", key))
        values = self.discretes.get(key)
        if values:
            # The product of s − value over all values is zero: its leading power is less the rest.
            product = _ONE
            for value in values:
                product = _plain_product(product, _sum(variable, {(): -value} if value else {}))
            [((index, _),)] = variable
            rest = {m: -c for m, c in product.items() if m != ((index, len(values)),)}
            self.relations.setdefault(index, (len(values), rest))
        return variable, _ONE

    def _with_square(self, name, square):
        """A variable whose square is a polynomial."""
        variable = self._variable(name)
        [((index, _),)] = variable
        self.relations.setdefault(index, (2, square))
        return variable

    # ---- polynomials --------------------------------------------------------------------------

    def _product(self, a, b):
        """The product with all relations used."""
        product, pending = {}, list(_plain_product(a, b).items())
        while pending:
            monomial, factor = pending.pop()
            for place, (variable, power) in enumerate(monomial):
                known = self.relations.get(variable)
                if known and power >= known[0]:
                    degree, rest = known
                    others = list(monomial)
                    others[place:place + 1] = [(variable, power - degree)] if power > degree else []
                    pending += _plain_product({tuple(others): factor}, rest).items()
                    break
            else:
                _add(product, monomial, factor)
        return product

    def _power(self, a, exponent):
        result = _ONE
        for _ in range(exponent):
            result = self._product(result, a)
        return result

    # ---- operations ---------------------------------------------------------------------------

    def _operation(self, op, given):
        (n, d), rest = given[0], given[1:]
        if op in (ca.OP_ADD, ca.OP_SUB):
            [(m, e)] = rest
            m = m if op == ca.OP_ADD else _negative(m)
            if d == e:
                return _quotient(_sum(n, m), d)
            return _quotient(_sum(self._product(n, e), self._product(m, d)), self._product(d, e))
        if op == ca.OP_MUL:
            [(m, e)] = rest
            return _quotient(self._product(n, m), self._product(d, e))
        if op == ca.OP_DIV and rest[0][0]:
            [(m, e)] = rest
            return _quotient(self._product(n, e), self._product(d, m))
        if op == ca.OP_INV and n:
            return _quotient(d, n)
        if op == ca.OP_SQ:
            return _quotient(self._product(n, n), self._product(d, d))
        if op == ca.OP_TWICE:
            return {m: 2 * c for m, c in n.items()}, d
        if op == ca.OP_NEG:
            return _negative(n), d
        if op == ca.OP_ASSIGN:
            return n, d
        if op in (ca.OP_SIN, ca.OP_COS):
            return self._sin_cos(n, d)[op == ca.OP_COS], _ONE
        if op == ca.OP_TAN:
            sine, cosine = self._sin_cos(n, d)
            return _quotient(sine, cosine)
        if op in (ca.OP_SQRT, ca.OP_FABS) and d == _ONE:
            square = n if op == ca.OP_SQRT else self._product(n, n)
            return self._with_square((op, _key(n, d)), square), _ONE
        if op in (ca.OP_POW, ca.OP_CONSTPOW) and _is_number(*rest[0]):
            return self._to_the(n, d, rest[0][0].get((), Fraction(0)))
        return self._variable((op, *(_key(*g) for g in given))), _ONE

    def _to_the(self, n, d, exponent):
        """A power with a constant exponent: a whole power, times one of a fractional exponent."""
        whole = exponent.numerator // exponent.denominator
        if abs(whole) > MOST_MULTIPLES or whole < 0 and not n:
            return self._variable((ca.OP_POW, _key(n, d), exponent)), _ONE
        above, below = (n, d) if whole >= 0 else (d, n)
        above, below = self._power(above, abs(whole)), self._power(below, abs(whole))
        fraction = exponent - whole
        if fraction == Fraction(1, 2) and d == _ONE:
            above = self._product(above, self._with_square((ca.OP_SQRT, _key(n, d)), n))
        elif fraction:
            above = self._product(above, self._variable((ca.OP_POW, _key(n, d), fraction)))
        return _quotient(above, below)

    def _sin_cos(self, n, d):
        """Sine and cosine of an angle: of a sum by those of its terms, of a multiple by those of the term."""
        sine, cosine = {}, _ONE
        terms = [({m: c}, d) for m, c in sorted(n.items())] if d == _ONE else [(n, d)]
        for term, below in terms:
            first = min(term)
            factor = term[first]
            whole, part = factor.numerator, Fraction(1, factor.denominator)
            if len(term) > 1 or abs(whole) > MOST_MULTIPLES:
                whole, part = (1 if factor > 0 else -1), abs(factor)
            angle = {m: part * c / factor for m, c in term.items()}
            s, c = self._multiple(_key(angle, below), abs(whole))
            s = s if whole > 0 else _negative(s)
            sine, cosine = (_sum(self._product(sine, c), self._product(cosine, s)),
                            _sum(self._product(cosine, c), _negative(self._product(sine, s))))
        return sine, cosine

    def _multiple(self, angle, times):
        c = self._variable((ca.OP_COS, angle))
        s = self._with_square((ca.OP_SIN, angle), _sum(_ONE, _negative(_plain_product(c, c))))
        sine, cosine = {}, _ONE
        for _ in range(times):
            sine, cosine = (_sum(self._product(sine, c), self._product(cosine, s)),
                            _sum(self._product(cosine, c), _negative(self._product(sine, s))))
        return sine, cosine


_ONE = {(): Fraction(1)}


def _add(polynomial, monomial, factor):
    total = polynomial.get(monomial, 0) + factor
    if total:
        polynomial[monomial] = total
    else:
        polynomial.pop(monomial, None)


def _sum(a, b):
    total = dict(a)
    for monomial, factor in b.items():
        _add(total, monomial, factor)
    return total


def _negative(a):
    return {monomial: -factor for monomial, factor in a.items()}


def _plain_product(a, b):
    product = {}
    for m, c in a.items():
        for n, d in b.items():
            powers = dict(m)
            for variable, power in n:
                powers[variable] = powers.get(variable, 0) + power
            _add(product, tuple(sorted(powers.items())), c * d)
    return product


def _quotient(n, d):
    """Numerator and denominator, the latter without a numerical factor."""
    if not n:
        return {}, _ONE
    factor = d[min(d)] if d else Fraction(1)
    return ({m: c / factor for m, c in n.items()}, {m: c / factor for m, c in d.items()}) if factor != 1 else (n, d)


def _is_number(n, d):
    return d == _ONE and set(n) <= {()}


def _key(n, d):
    return tuple(sorted(n.items())), tuple(sorted(d.items()))
