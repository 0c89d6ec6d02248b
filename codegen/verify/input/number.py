"""A printed number that follows from other printed numbers; judgements/numbers.py judges it."""

from dataclasses import dataclass
from typing import Callable, Optional


@dataclass(frozen=True)
class Number:
    """A number: as printed (None if the paper does not print it), its unit as printed and as it must
    be, where it stands, and `formula(n, m)` from the numbers before it, by name (`n.M_0`) with the
    functions sqrt, sin, cos, tan, atan, asin and the constant pi of `m`. `exact` marks a number that
    is a statement (a ratio, a dimension), not a rounded result."""

    name: str
    printed: Optional[str]
    unit: str
    meaning: str
    formula: Optional[Callable] = None
    unit_printed: Optional[str] = None
    exact: bool = False
    note: str = ""
