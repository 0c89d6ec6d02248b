"""Signs of forms over intervals of their symbols: proved, never sampled."""

from ..errors import PaperError
from .algebra import Opaque


def intervals(values):
    """Intervals by name from decimal strings, numbers or (low, high) pairs."""
    from mpmath import iv

    return {n: iv.mpf(list(map(str, v))) if isinstance(v, tuple) else iv.mpf(str(v)) for n, v in values.items()}


def known(values, forms):
    """Raises a PaperError where a value is lacking that forms depend on."""
    if missing := sorted(set().union(*(form.names() for form in forms)) - values.keys()):
        raise PaperError(f"the parameter sets and the box give no value for {', '.join(missing)}")


def signs(forms, values):
    """For each form +1, -1 or 0 (not decided) over intervals by name."""
    from mpmath import iv

    result = []
    for form in forms:
        if any(isinstance(name, Opaque) for monomial, _ in form.terms for name, _ in monomial):
            result.append(0)
            continue
        known(values, [form])
        value = form.evaluate(values, iv.sin, iv.cos, iv.mpf(0))
        result.append(1 if value.a > 0 else -1 if value.b < 0 else 0)
    return result
