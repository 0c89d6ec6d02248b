"""Work on CasADi expression graphs: smoothness, shape of the generated code, additive terms."""

import random
import struct

import casadi as ca
import numpy as np

# Operations over which the terms of their operands distribute, and of how many operands.
_DISTRIBUTES = {
    ca.OP_ADD: 2, ca.OP_SUB: 2, ca.OP_MUL: 2, ca.OP_DIV: 1, ca.OP_NEG: 1, ca.OP_SQ: 1, ca.OP_TWICE: 1,
}

_NON_SMOOTH = {
    getattr(ca, "OP_" + name): text
    for name, text in (
        ("IF_ELSE_ZERO", "if_else"), ("FABS", "fabs"), ("SIGN", "sign"), ("FMIN", "fmin"),
        ("FMAX", "fmax"), ("LT", "<"), ("LE", "<="), ("EQ", "=="), ("NE", "!="), ("NOT", "not"),
        ("AND", "and"), ("OR", "or"), ("FLOOR", "floor"), ("CEIL", "ceil"), ("FMOD", "fmod"),
        ("COPYSIGN", "copysign"), ("REMAINDER", "remainder"),
    )
}


def structure(expression):
    """What tells expressions apart, to be compared and hashed: their operations on the same symbols, in order, with
    the bits of their constants. A text would not do: CasADi prints six digits of a number.

    Symbols are known by where they are kept, so they must outlive the answer.
    """
    expression = ca.SX(expression)
    symbols = ca.symvar(expression)
    function = ca.Function("structure", symbols, [expression])
    numbers, work, rows, outputs = {}, {}, [], []
    for k in range(function.n_instructions()):
        op, source = function.instruction_id(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            outputs.append((tuple(function.instruction_output(k)), work[source[0]]))
            continue
        if op == ca.OP_CONST:
            row = op, struct.pack("<d", function.instruction_constant(k))
        elif op == ca.OP_INPUT:
            row = op, symbols[source[0]].element_hash()
        else:
            row = op, *(work[i] for i in source)
        # The same operation on the same operands has the same number, however often the graph holds it.
        if row not in numbers:
            numbers[row] = len(rows)
            rows.append(row)
        work[function.instruction_output(k)[0]] = numbers[row]
    return expression.shape, tuple(rows), tuple(outputs)


def non_smooth_operation(expression, parameters=()):
    """Name of a non-smooth operation in `expression`, or None. What depends on `parameters` alone
    is a constant of a run and may be anything."""
    constant = {p.element_hash() for p in parameters}
    symbols = ca.symvar(expression)
    function = ca.Function("smooth", symbols, [expression])
    varies = {}
    for k in range(function.n_instructions()):
        op, source = function.instruction_id(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            continue
        if op == ca.OP_CONST:
            answer = False
        elif op == ca.OP_INPUT:
            answer = symbols[source[0]].element_hash() not in constant
        else:
            answer = any(varies[i] for i in source)
            if answer and op in _NON_SMOOTH:
                return _NON_SMOOTH[op]
        varies[function.instruction_output(k)[0]] = answer
    return None


def smooth_parts(expressions, parameters):
    """The largest parts of expressions without an operation that is not smooth, each once."""
    parts, seen, waiting = [], set(), list(reversed(expressions))
    while waiting:
        part = waiting.pop()
        if part.element_hash() in seen:
            continue
        seen.add(part.element_hash())
        if non_smooth_operation(part, parameters) is None:
            parts.append(part)
        else:
            waiting += [part.dep(k) for k in reversed(range(part.n_dep()))]
    return parts


def is_even(expression, symbol):
    """Whether a column stays the same, to the bit, where `symbol` changes its sign: by the operations that carry a
    sign through, each node of the graph is even, odd, or neither."""
    symbols = ca.symvar(expression)
    function = ca.Function("parity", symbols, [expression])
    parity, answer = {}, True  # +1: even, -1: odd, 0: neither
    for k in range(function.n_instructions()):
        op, source = function.instruction_id(k), function.instruction_input(k)
        given = [parity[i] for i in source] if op not in (ca.OP_CONST, ca.OP_INPUT) else []
        if op == ca.OP_OUTPUT:
            answer = answer and given == [1]
            continue
        if op == ca.OP_INPUT:
            own = -1 if symbols[source[0]].element_hash() == symbol.element_hash() else 1
        elif op in (ca.OP_MUL, ca.OP_DIV):
            own = given[0] * given[1]
        elif op in (ca.OP_SQ, ca.OP_FABS):
            own = abs(given[0])
        elif op in (ca.OP_NEG, ca.OP_TWICE, ca.OP_INV, ca.OP_ASSIGN):
            own = given[0]
        elif op in (ca.OP_ADD, ca.OP_SUB) and given[0] == given[1]:
            own = given[0]
        else:
            own = int(all(p == 1 for p in given))
        parity[function.instruction_output(k)[0]] = own
    return answer


def additive_terms(expression):
    """The terms of a scalar sum, signs included, down to the first non-additive operations."""
    terms, stack = [], [(expression, 1)]
    while stack:
        node, sign = stack.pop()
        op = None if node.is_constant() or node.is_symbolic() else node.op()
        if op == ca.OP_ADD:
            stack += [(node.dep(1), sign), (node.dep(0), sign)]
        elif op == ca.OP_SUB:
            stack += [(node.dep(1), -sign), (node.dep(0), sign)]
        elif op == ca.OP_NEG:
            stack.append((node.dep(0), -sign))
        elif not node.is_zero():
            terms.append(node if sign > 0 else -node)
    return terms


def magnitude(expression):
    """Sum of the absolute values of the terms of a scalar expression, its products of sums multiplied out."""
    return _terms(expression)[1]


def rounding(expression):
    """What, times the unit roundoff, bounds the rounding error of a scalar expression: number of terms × sum of their
    absolute values, its products of sums multiplied out (running error, Higham 2002, §3.3 and §4.2)."""
    count, size = _terms(expression)
    return count * size


def running_error(expression):
    """What, times the unit roundoff, bounds the rounding error of a scalar expression to first order, where each of its symbols is
    known to its own rounding (running error, Higham 2002, §3.3). Unlike `rounding` it sees that a small difference stays small
    in a product."""
    known, stack = {}, [ca.SX(expression)]
    while stack:
        node = stack[-1]
        parts = [] if node.is_constant() or node.is_symbolic() else [node.dep(k) for k in range(node.n_dep())]
        unknown = [part for part in parts if part.element_hash() not in known]
        if unknown:
            stack += unknown
            continue
        inherited = [slope * known[part.element_hash()][1] for slope, part in zip(_slopes(node, parts), parts)]
        own = 0 if node.is_constant() else ca.fabs(node)
        # The node is kept, so that no other takes its hash.
        known[node.element_hash()] = node, sum(inherited, ca.SX(own))
        stack.pop()
    return known[ca.SX(expression).element_hash()][1]


def _slopes(node, parts):
    """Absolute values of the derivatives of an operation by what it is given."""
    op = node.op() if parts else None
    if op in (ca.OP_ADD, ca.OP_SUB, ca.OP_NEG):
        return [1] * len(parts)
    symbols = [ca.SX.sym("part") for _ in parts]
    own = ca.SX.unary(op, *symbols) if len(parts) == 1 else ca.SX.binary(op, *symbols) if parts else None
    return [ca.substitute(ca.fabs(ca.jacobian(own, symbol)), ca.vertcat(*symbols), ca.vertcat(*parts)) for symbol in symbols]


def _terms(expression):
    """Number of terms, and the sum of their absolute values. Terms of a product: those of its factors."""
    known, stack = {}, [expression]
    while stack:
        node = stack[-1]
        op = None if node.is_constant() or node.is_symbolic() else node.op()
        parts = [node.dep(k) for k in range(_DISTRIBUTES.get(op, 0))]
        unknown = [part for part in parts if part.element_hash() not in known]
        if unknown:
            stack += unknown
            continue
        counts, sizes = zip(*(known[part.element_hash()][1:] for part in parts)) if parts else ((), ())
        if op in (ca.OP_ADD, ca.OP_SUB):
            size = sizes[0] + sizes[1]
        elif op == ca.OP_MUL:
            size = sizes[0] * sizes[1]
        elif op == ca.OP_DIV:
            size = sizes[0] / ca.fabs(node.dep(1))
        elif op == ca.OP_SQ:
            size = sizes[0] * sizes[0]
        elif op == ca.OP_TWICE:
            size = 2 * sizes[0]
        elif op == ca.OP_NEG:
            size = sizes[0]
        else:
            size = ca.fabs(node)
        # The node is kept, so that no other takes its hash.
        known[node.element_hash()] = node, sum(counts) or int(not node.is_zero()), size
        stack.pop()
    return known[expression.element_hash()][1:]


def without_idle(column, symbols, discretes):
    """The same column with each entry rid of the `symbols` on which it does not depend, although it
    contains them: sin² + cos², or velocities whose terms cancel.

    An entry does not depend on a symbol if its derivative vanishes at several points drawn at
    random, all numbers of the order of 1, but for rounding: then it vanishes everywhere, since the
    expressions are analytic. `discretes` lists (symbol, values) of what takes no other values. What
    is not defined at a point is left as it is.
    """
    values = {symbol.element_hash(): values for symbol, values in discretes}
    draw = random.Random(0)
    known = ca.symvar(column)
    idle = [s for s in ca.vertsplit(symbols) if s.element_hash() in {k.element_hash() for k in known}]
    if not idle:
        return column
    column = ca.densify(column)
    jacobian = ca.jacobian(column, ca.vertcat(*idle))
    value = ca.Function("value", known, [column, jacobian])
    entries = list(zip(*jacobian.sparsity().get_triplet()))
    depends = np.zeros(len(entries), dtype=bool)
    for _ in range(8):
        point = [draw.choice(values[k.element_hash()]) if k.element_hash() in values else draw.uniform(0.5, 1.5)
                 for k in known]
        sizes, slopes = (np.array(found.nonzeros()) for found in value(*point))
        bounds = 1e-12 * (1.0 + np.abs(sizes[[i for i, _ in entries]]))
        # A NaN counts as dependence.
        depends |= ~(np.abs(slopes) <= bounds)
    gone = [[] for _ in range(column.numel())]
    for (i, j), dependent in zip(entries, depends):
        if not dependent:
            gone[i].append(idle[j])
    rows = [ca.substitute(entry, ca.vertcat(*symbols), ca.SX.zeros(len(symbols))) if symbols else entry
            for entry, symbols in zip(ca.vertsplit(column), gone)]
    return ca.vertcat(*rows)


class _Value:
    """A scalar as coefficient × rest, and, where it is a sum, as offset + variable.

    `coefficient` and `offset` depend on parameters alone; `rest` is None for a parametric value.
    """

    __slots__ = ("coefficient", "rest", "offset", "variable")

    def __init__(self, coefficient, rest=None, offset=None, variable=None):
        self.coefficient, self.rest = coefficient, rest
        self.offset, self.variable = offset, variable

    @property
    def parametric(self):
        return self.rest is None

    def expression(self):
        if self.rest is None:
            return self.coefficient
        if self.coefficient.is_one():
            return self.rest
        if self.coefficient.is_minus_one():
            return -self.rest
        return self.coefficient * self.rest


def arrange(expressions, parameters):
    """The same column of expressions, arranged for cheap code.

    Factors that depend on parameters alone are gathered, so that they can be computed once a run,
    and sin/cos of (parametric phase ± angle) are expanded, so that one angle costs one sin/cos pair.
    """
    symbols = ca.symvar(ca.vertcat(expressions, ca.vertcat(*parameters)))
    parametric = {p.element_hash() for vector in parameters for p in ca.vertsplit(vector)}
    function = ca.Function("arrange", symbols, [expressions])
    work, known, result = {}, {}, [None] * expressions.numel()
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        into, source = function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_CONST:
            key = op, struct.pack("<d", function.instruction_constant(k))
            work[into[0]] = known.setdefault(key, _Value(ca.SX(function.instruction_constant(k))))
        elif op == ca.OP_INPUT:
            symbol = symbols[source[0]]
            value = _Value(symbol) if symbol.element_hash() in parametric else _Value(ca.SX(1), symbol)
            work[into[0]] = known.setdefault((op, source[0]), value)
        elif op == ca.OP_OUTPUT:
            result[into[1]] = work[source[0]].expression()
        else:
            # What stands there several times is arranged once: derivatives repeat themselves, the more the larger a mode is.
            key = op, *(id(work[i]) for i in source)
            if key not in known:
                known[key] = _arranged(op, [work[i] for i in source])
            work[into[0]] = known[key]
    nonzeros = ca.SX(expressions.sparsity(), ca.vertcat(*result[: expressions.nnz()]))
    return ca.densify(nonzeros)


def _arranged(op, arguments):
    if all(a.parametric for a in arguments):
        values = [a.coefficient for a in arguments]
        return _Value(ca.SX.binary(op, *values) if len(values) == 2 else ca.SX.unary(op, *values))
    one = ca.SX(1)
    if op == ca.OP_MUL:
        a, b = arguments
        rest = a.rest if b.parametric else b.rest if a.parametric else a.rest * b.rest
        return _Value(a.coefficient * b.coefficient, rest)
    if op == ca.OP_DIV:
        a, b = arguments
        if b.parametric:
            return _Value(a.coefficient / b.coefficient, a.rest)
        return _Value(a.coefficient / b.coefficient, (one if a.parametric else a.rest) / b.rest)
    if op == ca.OP_SQ:
        return _Value(arguments[0].coefficient ** 2, arguments[0].rest ** 2)
    if op == ca.OP_TWICE:
        return _Value(2 * arguments[0].coefficient, arguments[0].rest)
    if op == ca.OP_NEG:
        return _Value(-arguments[0].coefficient, arguments[0].rest)
    if op in (ca.OP_ADD, ca.OP_SUB):
        a, b = arguments
        sign = 1 if op == ca.OP_ADD else -1
        offset = ca.SX(0)
        variable = ca.SX(0)
        for value, s in ((a, 1), (b, sign)):
            if value.parametric:
                offset += s * value.coefficient
            elif value.offset is not None:
                offset += s * value.offset
                variable += s * value.variable
            else:
                variable += s * value.expression()
        total = a.expression() + b.expression() if sign > 0 else a.expression() - b.expression()
        return _Value(one, total, offset, variable)
    if op in (ca.OP_SIN, ca.OP_COS):
        a = arguments[0]
        if a.offset is not None and not a.offset.is_zero():
            return _Value(one, _expanded(op, a.offset, a.variable))
        return _Value(one, _odd_even(op, a.expression()))
    values = [a.expression() for a in arguments]
    return _Value(one, ca.SX.binary(op, *values) if len(values) == 2 else ca.SX.unary(op, *values))


def _odd_even(op, angle):
    """sin or cos of an angle, with a leading minus sign taken out."""
    if not angle.is_symbolic() and not angle.is_constant() and angle.op() == ca.OP_NEG:
        inner = angle.dep(0)
        return -ca.sin(inner) if op == ca.OP_SIN else ca.cos(inner)
    return ca.sin(angle) if op == ca.OP_SIN else ca.cos(angle)


def _expanded(op, phase, angle):
    """Addition theorem for sin or cos of (phase + angle)."""
    s, c = _odd_even(ca.OP_SIN, angle), _odd_even(ca.OP_COS, angle)
    if op == ca.OP_SIN:
        return ca.sin(phase) * c + ca.cos(phase) * s
    return ca.cos(phase) * c - ca.sin(phase) * s
