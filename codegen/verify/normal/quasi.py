"""Quasi-velocities: linear functions of the rates of the coordinates in which equations of motion are printed (the velocities of a
vehicle in the axes of its body). Equation k is then the sum of Lagrange's equations of the coordinates, each times the slope of the
coordinate's rate by quasi-velocity k (Boltzmann 1902, Hamel 1904).

To each quasi-velocity belongs a coordinate that has no values, only a rate, which is the quasi-velocity, and an acceleration.
"""

from ..errors import PaperError
from .matrices import determinant


class Quasi:
    """The quasi-velocities of a paper: with `positions` the coordinates x and `names` those of the quasi-velocities, w = A dx/dt."""

    def __init__(self, paper, ring, s, m):
        self.positions, self.names, self.ring = paper.positions(), paper.coordinates(), ring
        if len(self.positions) != len(self.names):
            raise PaperError(f"there are {len(self.positions)} coordinates and {len(self.names)} quasi-velocities: as many of these are "
                             "needed, each defined by rates of coordinates")
        self.defined = {name: ring.read(paper.quasi[name](s, m)) for name in self.names}
        self.a = [[self.defined[k].diff("d" + j) for j in self.positions] for k in self.names]
        for name, row in zip(self.names, self.a):
            left = self.defined[name] - sum((entry * ring.symbol("d" + j) for j, entry in zip(self.positions, row)), ring.number(0))
            if left or any({"d" + j for j in self.positions} & entry.names() for entry in row):
                raise PaperError(f"the quasi-velocity {paper.shown(name)} is no linear function of the rates of {', '.join(self.positions)}")
        whole = determinant(self.a)
        if not whole:
            raise PaperError("the quasi-velocities depend on one another: the rates of the coordinates do not follow from them")
        size = range(len(self.names))
        self.b = [[self._minor(k, j) * (-1) ** (j + k) * whole.inverse() for k in size] for j in size]
        rates = [sum((entry * ring.symbol("d" + k) for k, entry in zip(self.names, row)), ring.number(0)) for row in self.b]
        chain = {**dict(zip(self.positions, rates)), **{"d" + k: "dd" + k for k in self.names}}
        self._to_quasi = {**{"d" + j: rate for j, rate in zip(self.positions, rates)},
                          **{"dd" + j: rate.rate(chain) for j, rate in zip(self.positions, rates)}}
        moving = {d + j: "d" + d + j for j in self.positions for d in ("", "d")}
        self._to_positions = {**{"d" + k: form for k, form in self.defined.items()},
                              **{"dd" + k: form.rate(moving) for k, form in self.defined.items()}}

    def _minor(self, row, column):
        """The determinant of A without a row and a column."""
        rest = [[entry for j, entry in enumerate(line) if j != column] for i, line in enumerate(self.a) if i != row]
        return determinant(rest) if rest else self.ring.number(1)

    def in_quasi(self, form):
        """A form with the rates and accelerations of the coordinates put in."""
        return form.substitute(self._to_quasi)

    def in_positions(self, form):
        """A form with the quasi-velocities and their rates put in."""
        return form.substitute(self._to_positions)

    def projected(self, name, rows):
        """The equation of a quasi-velocity from Lagrange's equations of the coordinates."""
        k = self.names.index(name)
        return self.in_quasi(sum((self.b[j][k] * row for j, row in enumerate(rows)), self.ring.number(0)))

    def unprojected(self, rows):
        """The equations of the coordinates from those of the quasi-velocities, in their order."""
        rows = [self.in_positions(row) for row in rows]
        return [sum((self.a[k][j] * row for k, row in enumerate(rows)), self.ring.number(0)) for j in range(len(self.positions))]
