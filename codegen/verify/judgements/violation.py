"""What a judgement objects to."""

from dataclasses import dataclass, field
from typing import Tuple


@dataclass
class Violation:
    """What one judgement objects to: equation numbers, ordinals of the terms to blame (from 0,
    within the first equation; empty if the whole is to blame) and the message, a list of strings
    and normal forms. `missing` lists what a lost term may have been: (equation number, form)."""

    judgement: str
    equations: Tuple[str, ...]
    terms: Tuple[int, ...]
    message: list
    missing: list = field(default_factory=list)
