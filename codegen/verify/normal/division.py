"""Exact division of trigonometric polynomials.

With z = exp(i angle) they are Laurent polynomials, which have no zero divisors; the leading term of a product is the
product of the leading terms. So a quotient is found term by term from the top, or there is none.
"""

from fractions import Fraction


def quotient(form, divisor):
    """The form q with q * divisor = form, or None where there is none; both without denominators. Discrete
    states have the square 1, which makes zero divisors: by a divisor with such a factor nothing is divided."""
    ring = form.ring
    if any(ring.involutive(name) for monomial, _ in divisor.terms for name, _ in monomial):
        return None
    lowest = _lowest(divisor)
    divisor = divisor * _monomial(ring, lowest, -1)
    low = _lowest(form)
    rest, result = form * _monomial(ring, low, -1), ring.number(0)
    angles = sorted({n for f in (rest, divisor) for _, (_, angle) in f.terms for n, _ in angle}, key=ring.rank)
    names = sorted({n for f in (rest, divisor) for monomial, _ in f.terms for n, _ in monomial}, key=str)
    # the quotient reaches just so far
    bounds = [_reach(rest, angles, names, k) - _reach(divisor, angles, names, k) for k in range(len(angles) + len(names))]
    top, scale = _leading(divisor, angles, names)
    while rest:
        at, amplitude = _leading(rest, angles, names)
        step = tuple(a - b for a, b in zip(at, top))
        turn, powers = step[:len(angles)], step[len(angles):]
        if any(power < 0 for power in powers) or next((x for x in turn if x), 0) < 0 \
                or any(abs(x) > bound for x, bound in zip(step, bounds)):
            return None
        real, imaginary = _over(amplitude, scale)
        if not any(turn):
            if imaginary:
                return None
            part = ring.number(real)
        else:
            angle = dict(zip(angles, turn))
            part = ring.harmonic("cos", angle) * (2 * real) + ring.harmonic("sin", angle) * (-2 * imaginary)
        part = part * _monomial(ring, dict(zip(names, powers)), 1)
        result += part
        rest -= part * divisor
    return result * _monomial(ring, low, 1) * _monomial(ring, lowest, -1)


def common(forms):
    """A polynomial by which each of the forms becomes a polynomial: the divisors that no other contains."""
    powers = {}
    for form in forms:
        for divisor, power in form.over:
            powers[divisor] = max(power, powers.get(divisor, 0))
    result = forms[0].ring.number(1)
    for divisor, power in powers.items():
        if not any(power <= powers[other] and quotient(other, divisor) for other in powers if other != divisor):
            result = result * divisor**power
    return result


def content(form):
    """(factor, primitive form): the monomial with the rational number that all terms have in common, and the rest,
    whose first term has the coefficient 1."""
    factor = _monomial(form.ring, _lowest(form), 1) * form.terms[min(form.terms, key=str)]
    return factor, form * factor.inverse()


def _lowest(form):
    """The lowest power of each name, over all terms; discrete states are left where they are."""
    found = None
    for monomial, _ in form.terms:
        powers = {n: e for n, e in monomial if not form.ring.involutive(n)}
        found = powers if found is None else {n: min(powers.get(n, 0), found.get(n, 0)) for n in powers.keys() | found.keys()}
    return {n: e for n, e in (found or {}).items() if e}


def _monomial(ring, powers, sign):
    """The product of powers of names, or its reciprocal."""
    result = ring.number(1)
    for name, exponent in powers.items():
        result = result * ring.power(name, sign * exponent)
    return result


def _reach(form, angles, names, k):
    """How far a form extends in one angle or name: what it reaches in a product is a sum."""
    if k < len(angles):
        return max(abs(dict(angle).get(angles[k], 0)) for _, (_, angle) in form.terms)
    return max(dict(monomial).get(names[k - len(angles)], 0) for monomial, _ in form.terms)


def _leading(form, angles, names):
    """The highest exponents, of the z of each angle and of each name, with the complex amplitude there."""
    def exponents(key):
        turn, powers = dict(key[1][1]), dict(key[0])
        return tuple(turn.get(n, 0) for n in angles) + tuple(powers.get(n, 0) for n in names)

    best, real, imaginary = None, 0, 0
    for key, value in form.terms.items():
        at = exponents(key)
        if best is None or at > best:
            best, real, imaginary = at, 0, 0
        if at == best:
            half = Fraction(value) / (2 if key[1][1] else 1)
            if key[1][0] == "sin":
                imaginary -= half
            else:
                real += half
    return best, (real, imaginary)


def _over(left, right):
    """The quotient of two complex numbers, (real, imaginary)."""
    (a, b), (c, d) = left, right
    size = c * c + d * d
    return Fraction(a * c + b * d) / size, Fraction(b * c - a * d) / size
