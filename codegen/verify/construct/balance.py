"""What becomes of energy and momenta along the motion, as identities: the rate of each, less a combination of
the equations of motion that are zero, is what does work or acts on it."""

from dataclasses import dataclass
from typing import List

from .lagrangian import motion_rows


@dataclass
class Balance:
    """`quantity`, `rate` along every motion (zero: conserved) and `factors`, with which the equations of
    motion, each times its multiplier, are taken off the time derivative of the quantity to leave `rate`."""

    name: str
    quantity: object
    rate: object
    factors: List


def energy_balance(subject, lagrangian):
    """How Jacobi's function changes: by what is dissipated, by forces, by what moves the frame."""
    return _balance(subject, lagrangian, "energy", lagrangian.energy(), [subject.ring.symbol("d" + n) for n in lagrangian.coordinates])


def momentum_balances(subject, lagrangian):
    """The momenta of the cyclic coordinates: those that the Lagrangian does not contain (Routh 1877)."""
    result, whole = [], lagrangian.whole
    for k, name in enumerate(lagrangian.coordinates):
        if not whole.diff(name):
            factors = [subject.ring.number(int(i == k)) for i in range(len(lagrangian.coordinates))]
            result.append(_balance(subject, lagrangian, name, whole.diff("d" + name), factors))
    return result


def _balance(subject, lagrangian, name, quantity, factors):
    _, _, rows = motion_rows(subject, conservative=False)
    rate = quantity.rate(lagrangian.chain) - sum((f * row for f, row in zip(factors, rows)), subject.ring.number(0))
    return Balance(name, quantity, rate, factors)
