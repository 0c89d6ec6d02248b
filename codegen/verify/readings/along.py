"""Reactions along the motion of a release, computed: the least of each until the time is over or a one-sided coordinate comes to its
bound. No proof, as the reactions at the start are (ranking.py): by the classical method of Runge and Kutta, twice, with steps of which
the second half as long; the difference is the uncertainty."""

from dataclasses import dataclass
from typing import Dict

from ..normal.algebra import expression

# steps of the first run: a vibration of which a release lasts ten periods is off by some thousandths of its amplitude
STEPS = 128


@dataclass
class Least:
    """The least reaction along a motion, N or N m, when it is reached, s, and how far two runs differ in it."""

    value: float
    time: float
    uncertainty: float


class Along:
    """The equations of motion of energies as a function of numbers, for coordinates that are free."""

    def __init__(self, motion, free):
        from sympy import Symbol, lambdify

        self.motion, self.free, self.pushes = motion, free, motion.energies.pushes
        rows = [motion.residual(n) for n in free]
        still = {"dd" + n: 0 for n in free}
        forms = [row.diff("dd" + n) for row in rows for n in free] + [row.substitute(still) for row in rows]
        for name in self.pushes:
            reaction = motion.residual(name)
            forms += [reaction.diff("dd" + n) for n in free] + [reaction.substitute(still)]
        moving = [d + n for d in ("", "d") for n in free]
        self.others = sorted(set().union(*(form.names() for form in forms)) - set(moving))
        symbols = [Symbol(n, real=True) for n in [*moving, *self.others]]
        self._function = lambdify(symbols, [expression(form) for form in forms], "math", cse=True)

    def at(self, state, others):
        """(accelerations, reactions) of a state: coordinates, then rates."""
        n = len(self.free)
        found = self._function(*state, *others)
        a = _solved([list(found[i * n:(i + 1) * n]) for i in range(n)], [-x for x in found[n * n:n * n + n]])
        rest = found[n * n + n:]
        reactions = [sum(s * x for s, x in zip(rest[k:k + n], a)) + rest[k + n] for k in range(0, len(rest), n + 1)]
        return a, reactions

    def least(self, values: Dict[str, float], start: Dict[str, float], duration: float) -> Dict[str, Least]:
        """The least reactions, by coordinate, where numbers are given by name; what has none is zero. Empty where the equations become
        singular on the way."""
        others = [values.get(n, 0.0) for n in self.others]
        begin = [start.get(n, 0.0) for n in self.free] + [0.0] * len(self.free)
        try:
            coarse, fine = (self._run(begin, others, duration, steps) for steps in (STEPS, 2 * STEPS))
        except (ZeroDivisionError, OverflowError, ValueError):
            return {}
        return {name: Least(value, time, abs(value - other)) for name, (value, time), (other, _) in zip(self.pushes, fine, coarse)}

    def _run(self, state, others, duration, steps):
        """The least value of each reaction, and its time."""
        n, h, bounds = len(self.free), duration / steps, [self.motion.paper.symbols[name].minimum for name in self.free]

        def slope(state):
            a, reactions = self.at(state, others)
            return [*state[n:], *a], reactions

        found = None
        for k in range(steps + 1):
            first, reactions = slope(state)
            found = [min(old, (new, k * h)) for old, new in zip(found, reactions)] if found else [(new, 0.0) for new in reactions]
            second, _ = slope([x + h / 2 * d for x, d in zip(state, first)])
            third, _ = slope([x + h / 2 * d for x, d in zip(state, second)])
            fourth, _ = slope([x + h * d for x, d in zip(state, third)])
            state = [x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip(state, first, second, third, fourth)]
            if any(bound is not None and x < bound for x, bound in zip(state, bounds)):
                break
        return found


def _solved(matrix, load):
    """The solution of linear equations, by elimination with pivots."""
    n = len(load)
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(matrix[i][k]))
        matrix[k], matrix[p], load[k], load[p] = matrix[p], matrix[k], load[p], load[k]
        for i in range(k + 1, n):
            factor = matrix[i][k] / matrix[k][k]
            load[i] -= factor * load[k]
            for j in range(k, n):
                matrix[i][j] -= factor * matrix[k][j]
    for k in reversed(range(n)):
        load[k] = (load[k] - sum(matrix[k][j] * load[j] for j in range(k + 1, n))) / matrix[k][k]
    return load
