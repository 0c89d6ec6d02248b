"""Antiderivatives of normal forms: of a power times a harmonic there is one in the class, by parts; of 1/x
there is none, and it is said."""

from fractions import Fraction

from ..normal.algebra import ONE, Form, NotInClass, Opaque


def antiderivative(form, name):
    """A form whose derivative by `name` is the form; NotInClass where the class has none."""
    total = form.ring.number(0)
    for (monomial, (kind, angle)), value in form.terms.items():
        for factor, _ in monomial:
            if isinstance(factor, Opaque) and name in factor.argument.names():
                raise NotInClass(f"the antiderivative of {factor} by {name} is not looked for")
        power = dict(monomial).get(name, 0)
        rest = Form(form.ring, {(tuple(item for item in monomial if item[0] != name), ONE): value})
        total += rest * _integral(form.ring, power, kind, dict(angle), name)
    return total


def _integral(ring, power, kind, angle, name):
    """The antiderivative of name**power times a harmonic."""
    slope = angle.get(name)
    harmonic = ring.harmonic(kind, angle)
    if not slope:
        if power == -1:
            raise NotInClass(f"the antiderivative of 1/{name} is a logarithm, which is no trigonometric polynomial")
        return ring.symbol(name) ** (power + 1) * harmonic * Fraction(1, power + 1)
    if power < 0:
        raise NotInClass(f"the antiderivative of {kind}({name})/{name} is no trigonometric polynomial")
    # by parts: the harmonic is integrated, the power differentiated
    other, sign = ("cos", -1) if kind == "sin" else ("sin", 1)
    factor = Fraction(sign) / slope
    result = ring.symbol(name) ** power * ring.harmonic(other, angle) * factor
    if power:
        result -= _integral(ring, power - 1, other, angle, name) * (factor * power)
    return result
