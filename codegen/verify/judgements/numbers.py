"""Printed numbers against what the other printed numbers give, with the rounding of both.

A printed number stands for all numbers that round to it. The recomputed value is an interval over
the roundings of what it is computed from; the two agree if they have a point in common. Where the
recomputed interval is unbounded (a divisor may be zero), nothing is decided.
"""

from dataclasses import dataclass
from decimal import Decimal
from typing import Optional

from ..errors import PaperError
from ..input import units
from ..input.number import Number


@dataclass
class Checked:
    """The verdict on a number: `low` and `high` bound the recomputed value; `agrees` is None where
    there is nothing to compare, or nothing is decided."""

    number: Number
    low: Optional[float]
    high: Optional[float]
    agrees: Optional[bool]
    unit_agrees: bool


class _Intervals:
    """Interval functions by name."""

    def __init__(self):
        from mpmath import iv

        self.pi = iv.pi
        self.sqrt, self.sin, self.cos, self.tan = iv.sqrt, iv.sin, iv.cos, iv.tan

    def atan(self, x):
        return self._monotone("atan", x)

    def asin(self, x):
        if not (x.a >= -1 and x.b <= 1):
            raise ValueError(f"asin of {x}, which is not between -1 and 1")
        return self._monotone("asin", x)

    def _monotone(self, name, x):
        from mpmath import iv, mp

        function, x = getattr(mp, name), iv.mpf(x)
        # rounded outwards: the bounds hold
        return iv.mpf([function(mp.mpf(x.a), rounding="f"), function(mp.mpf(x.b), rounding="c")])


class _Known:
    """Numbers by attribute."""

    def __getattr__(self, name):
        raise PaperError(f"the number '{name}' is not given before it is used")


def rounding(printed, exact=False):
    """The interval of all numbers that are printed so."""
    from mpmath import iv

    value = Decimal(printed)
    if exact:
        return iv.mpf(printed)
    half = Decimal((0, (5,), value.as_tuple().exponent - 1))
    return iv.mpf([str(value - half), str(value + half)])


def check(numbers):
    """Verdicts in order."""
    from mpmath import iv, mp

    known, m, result = _Known(), _Intervals(), []
    for number in numbers:
        try:
            computed = iv.mpf(number.formula(known, m)) if number.formula else None
            stated = rounding(number.printed, number.exact) if number.printed else None
        except Exception as error:  # whatever a model file does wrong is its author's to read
            raise PaperError(f"the number '{number.name}': {error}") from error
        agrees = None
        if computed is not None and stated is not None and mp.isfinite(mp.mpf(computed.a)) and mp.isfinite(mp.mpf(computed.b)):
            agrees = bool(computed.a <= stated.b and stated.a <= computed.b)
        setattr(known, number.name, stated if stated is not None else computed)
        unit_agrees = number.unit_printed is None or units.parse(number.unit_printed) == units.parse(number.unit)
        low, high = (float(computed.a), float(computed.b)) if computed is not None else (None, None)
        result.append(Checked(number, low, high, agrees, unit_agrees))
    return result
