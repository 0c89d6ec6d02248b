"""Gaps, slips and constraints that solve for a coordinate: lines w = q_p + ρ(q, z), of which q_p is what the others leave.

Of a wheel that may slip on a rail, x − r φ is the place along which it slips. It is as good a coordinate as x; where the wheel sticks,
it is held, and x *depends* on φ, as on the prescribed motion z of a belt or a table what lies on it. With w in place of q_p for each of
these lines, forces, momenta and impacts are those of contacts along coordinates (`reduced.py`). What is integrated and shown stays what
the model declares: in a mode that holds w, q_p is among the coordinates that are held, though it moves.
"""

import itertools
from dataclasses import dataclass

import casadi as ca

from . import derive, limits
from .contacts import Line, as_line, slip_line
from .declarations import Coordinate
from .exact import Exact, lifted


class NotSolved(Exception):
    """Why lines do not solve for coordinates."""


@dataclass
class Solved:
    """A line w = q_p + ρ(q, z): `symbol` is w, with its rate; `coordinate` is q_p; `rest` is ρ, which does not depend on q_p; what the
    model declares first of it is `sign` × `scale` × w; `scale` is None where it is 1, else what parameters make of it, more than 0."""

    symbol: Coordinate
    coordinate: Coordinate
    rest: ca.SX
    sign: int
    scale: ca.SX

    @property
    def name(self):
        """The name of the coordinate that it is solved for."""
        return self.coordinate.name()

    @property
    def value(self):
        """w in the coordinates."""
        return self.coordinate + self.rest

    def rate(self, model):
        """ẇ in the coordinates and rates."""
        x = derive.configuration(model)
        return ca.jtimes(self.value, x.q, x.v)


def solve(model):
    """Gaps, slips and constraints of a model as lines; in `model.lines` those that are no coordinates themselves, each behind those
    that it depends on. Raises `NotSolved`."""
    parts = list(_parts(model))
    wanted, claimed = [], set()
    for owner, key, expression, is_rate in parts:
        line = slip_line(model, expression, is_rate) if key == "slip" else as_line(model, expression, is_rate)
        if line is None:
            wanted.append((owner, key, *_place(model, owner, expression, is_rate)))
        else:
            setattr(owner, key, line)
            claimed.add(line.name)
    if not wanted:
        return
    groups = []
    for entry in wanted:
        known = next((group for group in groups if _sign(model, group[0][2], entry[2])), None)
        groups.append([entry]) if known is None else known.append(entry)
    model.lines = _solved(model, groups, claimed)
    by_name = {line.symbol.name(): line for line in model.lines}
    for group in groups:
        line = by_name[_name(group)]
        for k, (owner, key, place, offset) in enumerate(group):
            relative = _sign(model, group[0][2], place)
            if offset is None:
                # A slip is known by its rate; the first is the line itself.
                differs = k > 0 and key != "slip"
                offset = ca.substitute(place - relative * group[0][2], derive.configuration(model).q, 0) if differs else ca.SX(0)
            setattr(owner, key, Line(line.symbol, line.sign * relative, offset, line.coordinate, line.scale))


def _parts(model):
    """(owner, which of its lines, expression, whether that is a rate) of everything that may be a line."""
    for contact in model.contacts:
        if contact.gap is not None:
            yield contact, "gap", contact.gap_expression, False
        if contact.slip is not None:
            yield contact, "slip", contact.slip_expression, contact.slips_by_rate
    for constraint in model.constraints:
        yield constraint, "line", constraint.expression, constraint.is_rate


def _place(model, owner, expression, is_rate):
    """The place whose rate a line is, and what parameters add to that rate; None where the line is a place itself."""
    x = derive.configuration(model)
    places = {c.symbol.element_hash() for c in model.coordinates + model.motions}
    if is_rate:
        slopes = ca.simplify(ca.densify(ca.jacobian(expression, x.v)))
        offset = ca.substitute(expression, x.v, 0)
        if not limits.is_of_parameters(model, slopes) or not limits.is_of_parameters(model, offset):
            raise NotSolved(f"a line of `{owner.name}` is a rate with factors that move")
        return slopes @ x.q, offset
    parameters = {p.symbol.element_hash() for p in model.parameters}
    if any(s.element_hash() not in places | parameters for s in ca.symvar(expression)):
        raise NotSolved(f"a line of `{owner.name}` depends on more than coordinates, prescribed motions and parameters")
    return expression, None


def _sign(model, one, other):
    """±1 where two places differ by that sign and a constant; 0 where they do not."""
    q = derive.configuration(model).q
    numbers = {}
    slopes = [ca.densify(ca.jacobian(lifted(place, numbers), q)) for place in (one, other)]
    for sign in (+1, -1):
        if Exact().is_zero(slopes[1] - sign * slopes[0]):
            return sign
    return 0


def _name(group):
    """The name of the line that a group of equal lines is: that of no coordinate."""
    owner, key, *_ = group[0]
    return f"{owner.name}.{key}"


def _solved(model, groups, claimed):
    """A line for each group, solved for different coordinates so that none depends on itself; `claimed` are lines themselves."""
    slopes = {}
    q = [c.symbol for c in model.coordinates]
    for k, group in enumerate(groups):
        row = ca.simplify(ca.densify(ca.jacobian(group[0][2], ca.vertcat(*q))))
        slopes[k] = {i: row[i] for i in range(len(q)) if not row[i].is_zero()}
    fit = lambda i, slope: q[i].name() not in claimed and limits.sign_of(model, slope) != 0
    # One whose slope is ±1 depends on others; of two that are alike the later depends on the earlier.
    preference = lambda i, slope: (not _is_one(slope), -i)
    candidates = [sorted((i for i in own if fit(i, own[i])), key=lambda i: preference(i, own[i])) for own in slopes.values()]
    for chosen in itertools.product(*candidates):
        order = _order(chosen, slopes)
        if order is not None:
            return [_line(model, groups[k], q[chosen[k]], slopes[k][chosen[k]]) for k in order]
    owner, *_ = next((group for group, own in zip(groups, candidates) if not own), groups[0])[0]
    raise NotSolved(f"`{owner.name}` {'and others do' if all(candidates) else 'does'} not solve for a coordinate")


def _order(chosen, slopes):
    """The lines, each behind those whose coordinates it depends on; None where there is no such order."""
    if len(set(chosen)) < len(chosen):
        return None
    order, left = [], set(range(len(chosen)))
    while left:
        ready = [k for k in sorted(left) if not any(chosen[j] in slopes[k] for j in left if j != k)]
        if not ready:
            return None
        order += ready
        left -= set(ready)
    return order


def _is_one(slope):
    """Whether a slope is ±1."""
    return slope.is_constant() and abs(float(slope)) == 1


def _line(model, group, coordinate, slope):
    """A line, solved for a coordinate in which it has this slope."""
    place, sign = group[0][2], limits.sign_of(model, slope)
    symbol = Coordinate(ca.SX.sym(_name(group)))
    symbol.rate = ca.SX.sym(_name(group) + ".rate")
    model.dimensions[symbol.name()] = model.dimensions[coordinate.name()]
    scale = None if _is_one(slope) else ca.simplify(sign * slope)
    rest = sign * ca.substitute(place, coordinate, 0)
    return Solved(symbol, coordinate, ca.simplify(rest if scale is None else rest / scale), sign, scale)
