"""What an impact law does to the energy, to the momenta and to the bound of its coordinate, with the kinetic energy
of a reading: at the bound, in the frame of the ground, all rates that the law does not name kept as they are.

The change of the kinetic energy is a quadratic form in the rates before the impact. Where it can be positive, a
witness is given: rates of an approach for which the sign is proved by interval arithmetic.
"""

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Dict, Optional

from ..judgements.definite import rest, states
from ..normal.intervals import intervals, signs
from ..normal.matrices import minors

HALF = Fraction(1, 2)

# A witness is rounded to this many digits: it need not lie on the axis along which most energy is gained.
DIGITS = 3


@dataclass
class Impact:
    """`change` of the kinetic energy in the rates before; `rises` where it can be positive: (case, {rate: value}),
    None where it is proved never to be so in any case, () where that is not decided; `impulses` on the other coordinates, as changes of their
    momenta; `penetrates` the case in which the coordinate goes on below its bound (None: in none); `law` the rate after."""

    number: str
    of: str
    law: object
    change: object
    rises: Optional[tuple]
    impulses: Dict[str, object] = field(default_factory=dict)
    penetrates: Optional[str] = None


def impact(subject, number, kinetic):
    """The judgement on one impact law, with a kinetic energy."""
    paper, ring = subject.paper, subject.ring
    equation = paper.equations[number]
    symbol, law = paper.symbols[equation.of], subject.total(number)
    still = {d + n: 0 for n, x in paper.symbols.items() if x.role == "input" for d in ("", "d", "dd")}
    at = {**still, **({equation.of: Fraction(str(symbol.minimum))} if symbol.minimum == 0 else {})}
    kinetic, law = kinetic.substitute(at), law.substitute(at)
    after = {"d" + equation.of: law, **{name: -ring.symbol(name) for name in equation.flips}}
    change = kinetic.substitute(after) - kinetic
    impulses = {}
    for name in paper.coordinates():
        momentum = kinetic.diff("d" + name)
        if name != equation.of and (jump := momentum.substitute(after) - momentum):
            impulses[name] = jump
    return Impact(number, equation.of, law, change, _rises(paper, change, equation), impulses, _penetrates(paper, law, symbol))


def _cases(paper, forms):
    """(name, values) of all parameter sets and states, the coordinates at rest."""
    zeros, places = rest(paper)
    for name, values in paper.sets.items():
        for state in states(paper, forms):
            put = {n: v for n, v in {**values, **places, **state}.items()}
            yield ", ".join([name] + [f"{n} = {v:+d}" for n, v in state.items()]), {**put, **{n: 0 for n in zeros if not n.startswith("d")}}


def _rises(paper, change, equation):
    """Where the change can be positive."""
    rates = ["d" + n for n in paper.coordinates() if "d" + n in change.names()]
    matrix = [[change.diff(i).diff(j) * HALF for j in rates] for i in rates]
    fallen = []
    for name, values in _cases(paper, [change]):
        witness = _witness(matrix, rates, values, "d" + equation.of)
        put = {**values, **witness} if witness else None
        if put and signs([change], intervals({n: v for n, v in put.items()})) == [1]:
            return name, witness
        negative = minors([[-x for x in row] for row in matrix]) if matrix else []
        fallen.append(all(sign == 1 for sign in signs(negative, intervals(values))))
    return None if fallen and all(fallen) or not change else ()


def _witness(matrix, rates, values, own):
    """Rates along which a quadratic form is largest, towards the impact; None where it is nowhere positive."""
    from mpmath import eigsy, matrix as numbers

    import math

    if not rates:
        return None
    put = {n: float(v) for n, v in values.items()}
    entries = numbers([[form.evaluate(put, math.sin, math.cos, 0.0) for form in row] for row in matrix])
    sizes, axes = eigsy(entries)
    k = max(range(len(rates)), key=lambda i: sizes[i])
    if sizes[k] <= 0:
        return None
    sign = -1 if own in rates and axes[rates.index(own), k] > 0 else 1
    return {name: round(float(sign * axes[i, k]), DIGITS) for i, name in enumerate(rates)}


def _penetrates(paper, law, symbol):
    """The case in which the rate after the impact leads below the bound; the others do not matter then."""
    if symbol.minimum is None:
        return None
    factor = law.diff("d" + symbol.name)
    for name, values in _cases(paper, [factor]):
        if factor.names() <= values.keys() and signs([factor], intervals(values)) == [1]:
            return name
    return None
