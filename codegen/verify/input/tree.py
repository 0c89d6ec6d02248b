"""The tree of a printed equation."""

from dataclasses import dataclass, field
from typing import List, Optional


@dataclass
class Node:
    """A node of the tree: `kind` is equation, sum, product, symbol, number, call, group, modulus,
    power, fraction, rate (d/dt of a bracket), relation or text; `time` is + or - after (t^+) or (t^-), `text` of a fraction / where it
    is printed so, `lead` the sign, relation or dot that is printed before it, `accent` what stands over a symbol, `at` the offset
    in the LaTeX. `ordinal` numbers the terms from 0 and `side` is the sign that their side of the equation gives them (transcription.py)."""

    kind: str
    text: str = ""
    children: List["Node"] = field(default_factory=list)
    dots: int = 0
    index: str = ""
    time: str = ""
    accent: str = ""
    sign: int = 1
    lead: str = ""
    broken: bool = False
    ordinal: Optional[int] = None
    side: int = 0
    at: int = 0
