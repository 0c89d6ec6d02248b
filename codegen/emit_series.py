"""Emission of C that computes Taylor coefficients: automatic differentiation of the time series.

A column of expressions becomes two C functions. The first gives the coefficients of order 0 of all
nodes of the expression graph; the second appends those of the orders k = 1, 2, … in turn. Each order
is one pass over the graph (Moore 1966; Jorba and Zou 2005, Experiment. Math. 14, section 2).

A product z = x y has z_k = x_0 y_k + x_k y_0 + Σ_{j=1}^{k-1} x_j y_{k-j}. The sum, the interior of
the convolution, is known before order k is begun. So is that of every other node that is not
linear, since each obeys a product rule: an order first computes all interiors (interiors.py), and
then walks the graph once in straight-line code.

Without interiors, and with so few that both halves of their sums fit into a block, the orders are unrolled:
one with its number known is straight-line code. With more the code grows beyond what a processor keeps at
hand.

Nodes that are constant in time are recognised: a constant times a series is one product an order.
Between what is not linear, an order is a linear map with coefficients that the start of the step
gives. So a coefficient of order k is held as a linear form of the terms that an order begins with:
sums and products by constants multiply its coefficients out, once a step, and an order waits for
one product and a sum instead of a chain of them. Where the mass matrix is constant, so does its
inverse.
"""

import re

import casadi as ca

from .emit_c import MOST_ORDERS, SIN_COS, literal, operation, parenthesized, sin_cos
from .interiors import Interiors


class NotAnalytic(Exception):
    """The graph has an operation for which there is no recurrence."""


class _Node:
    """Coefficients of a node: C text of order 0, and of order k a linear form, None where all but the first
    vanish.

    A form maps terms, C text of order k, to their constant factors. `name`: of the variable that holds
    its value, where there is one; `uses`: how often the graph refers to the node.
    """

    __slots__ = ("zeroth", "form", "name", "slot", "uses")

    def __init__(self, zeroth, term=None):
        self.zeroth, self.slot, self.uses = zeroth, None, 1
        self.form, self.name = (None, None) if term is None else ({term: _ONE}, term)

    @property
    def constant(self):
        return self.form is None


_VARIABLE = re.compile(r"\bt\d+\b")
_MOTION = re.compile(r"([qv])\[(\d+) \* k \+ (\d+)\]")
_DEFINITION = re.compile(r"\s*const (?:real|struct \w+) (t\d+) = ")

_ONE = _Node("1.0")
_MINUS_ONE = _Node("-1.0")


class Graph:
    """The two function bodies under construction."""

    def __init__(self):
        self.start, self.next = [], []
        self.fresh = self.slots = self.angles = 0
        self.interiors, self.pairs, self.forms = Interiors(), {}, {}

    # ---- text ---------------------------------------------------------------------------------

    def _name(self):
        self.fresh += 1
        return f"t{self.fresh - 1}"

    def zeroth(self, text):
        """A node that is constant in time."""
        name = self._name()
        self.start.append(f"  const real {name} = {text};")
        return _Node(name)

    def series(self, zeroth, form):
        """A node with coefficients of all orders."""
        node = self.zeroth(zeroth)
        node.form = form
        return node

    def first(self, node):
        """Coefficient of order 0, as text of the second function."""
        if not node.zeroth.startswith("t"):
            return node.zeroth  # a literal, or an entry of a constant array
        if node.slot is None:
            node.slot, self.slots = self.slots, self.slots + 1
            self.start.append(f"  w[{node.slot}] = {node.zeroth};")
        return f"w[{node.slot}]"

    def value(self, node):
        """Coefficient of order k, as text of the second function."""
        if node.name is None:
            node.name = self._name()
            self.define(node, node.form)
        return node.name

    def define(self, node, form):
        """Gives the variable of a node the value of a form, which may refer to interiors of the variable."""
        form = self._merged(form)
        self.state(f"const real {node.name} = %s;", form, node.name)
        self.forms[node.name], node.form = form, {node.name: _ONE}

    def state(self, statement, form=None, name=None):
        """Adds a statement of the second function: with the value of a form, if one is given, and of the
        variable of that name, if it is for one, which is left out where nothing needs it."""
        self.next.append((statement, form or {}, name))

    def statements(self, needed):
        """Those that are needed: for themselves, or by text."""
        kept = []
        for statement, form, name in reversed(self.next):
            if name is None or name in needed:
                kept.append(f"  {statement}" % ((self.text(form),) if "%s" in statement else ()))
                needed = needed | set(_VARIABLE.findall(" ".join([statement, *form])))
        return kept[::-1]

    def beginning(self):
        """The statements of the first function that something needs."""
        kept, needed = [], set()
        for line in reversed(self.start):
            defined = _DEFINITION.match(line)
            if defined is None or defined.group(1) in needed:
                kept.append(line)
                needed |= set(_VARIABLE.findall(line))
        return kept[::-1]

    # ---- forms --------------------------------------------------------------------------------

    def form(self, node, factor=_ONE):
        """A form of the node times a constant, for another node: that of its variable where its value is
        needed more than once, or where the products by the constant would be more than one."""
        units = sum(own in (_ONE, _MINUS_ONE) for own in node.form.values())
        plain = factor in (_ONE, _MINUS_ONE)
        if node.name is None and len(node.form) > 1 and (node.uses > 1 or units > 1 and not plain):
            self.value(node)
        return self.times(factor, node.form)

    def text(self, form):
        """C text of a form. What is known first enters first."""
        text = ""
        for term in sorted(form, key=self._age):
            factor = form[term]
            product = term if factor in (_ONE, _MINUS_ONE) else f"{self.first(factor)} * {term}"
            sign = "-" if factor is _MINUS_ONE else "+" if text else ""
            text += f" {sign} {product}" if text else f"{sign}{product}"
        return text or "REAL(0.0)"

    @staticmethod
    def _age(term):
        """When the term of an order is known, compared with others: inputs, interiors, motion, variables."""
        variable = _VARIABLE.match(term)
        return (3, int(variable.group()[1:])) if variable else ("uyqva".find(term[0]) // 2, 0)

    def sum(self, *forms):
        """Sum of forms."""
        total = {}
        for term, factor in (item for form in forms for item in form.items()):
            total[term] = self._sum(total.get(term), factor)
        return {term: factor for term, factor in total.items() if factor is not None}

    def times(self, factor, form):
        """A form times a constant node."""
        return {term: self._times(factor, own) for term, own in form.items()}

    def _times(self, x, y):
        if _ONE in (x, y):
            return y if x is _ONE else x
        if _MINUS_ONE in (x, y):
            other = y if x is _MINUS_ONE else x
            return _ONE if other is _MINUS_ONE else self.zeroth(f"-{parenthesized(other.zeroth)}")
        return self.zeroth(operation(ca.OP_MUL, [x.zeroth, y.zeroth]))

    def _sum(self, x, y):
        """The sum of two factors; None: zero."""
        if None in (x, y):
            return y if x is None else x
        if {x, y} == {_ONE, _MINUS_ONE}:
            return None
        return self.zeroth(operation(ca.OP_ADD, [x.zeroth, y.zeroth]))

    def _merged(self, form):
        """The form without variables whose own terms take no more room than they do."""
        for name in sorted(form, key=self._age, reverse=True):
            own = self.forms.get(name)
            if own is not None and len(form) > 1 and len({*form, *own}) <= len(form) + 1:
                rest = {term: factor for term, factor in form.items() if term != name}
                return self._merged(self.sum(rest, self.times(form[name], own)))
        return form

    # ---- operations ---------------------------------------------------------------------------

    def operation(self, op, arguments):
        """The node of an operation."""
        if all(a.constant for a in arguments):
            if op in SIN_COS:
                return _Node(f"{self._sin_cos(arguments[0].zeroth)}.{SIN_COS[op]}")
            return self.zeroth(operation(op, [a.zeroth for a in arguments]))
        rule = _RULES.get(op)
        if rule is None:
            raise NotAnalytic(f"`{_name(op)}` has no Taylor recurrence")
        return rule(self, *arguments)

    def linear(self, op, *factors):
        """An operation that is the sum of its arguments, times these factors."""
        def rule(*arguments):
            zeroth = operation(op, [a.zeroth for a in arguments])
            terms = (self.form(a, f) for f, a in zip(factors, arguments) if not a.constant)
            return self.series(zeroth, self.sum(*terms))
        return rule

    def product(self, x, y):
        zeroth = operation(ca.OP_MUL, [x.zeroth, y.zeroth])
        for constant, other in ((x, y), (y, x)):
            if constant.constant:
                return self.series(zeroth, self.form(other, constant))
        inner = self.interiors.add(self.value(x), self.value(y))
        return self.series(zeroth, self.sum({inner: _ONE}, self.times(x, y.form), self.times(y, x.form)))

    def square(self, x):
        inner = self.interiors.add(self.value(x), self.value(x))
        twice = self.zeroth(f"2.0 * {x.zeroth}")
        return self.series(f"{x.zeroth} * {x.zeroth}", self.sum({inner: _ONE}, self.times(twice, x.form)))

    def quotient(self, x, y):
        """z with y z = x."""
        zeroth = operation(ca.OP_DIV, [x.zeroth, y.zeroth])
        reciprocal = self.zeroth(f"1.0 / {parenthesized(y.zeroth)}")
        if y.constant:
            return self.series(zeroth, self.form(x, reciprocal))
        z = self._integral(zeroth)
        inner = self.interiors.add(self.value(y), z.name)
        rest = self.sum({inner: _ONE}, self.times(z, y.form))
        self._define_quotient(z, {} if x.constant else self.form(x), rest, reciprocal)
        return z

    def inverse(self, x):
        return self.quotient(_Node("1.0"), x)

    def root(self, x):
        """z with z z = x."""
        z = self._integral(f"sqrt({x.zeroth})")
        inner = self.interiors.add(z.name, z.name)
        self._define_quotient(z, self.form(x), {inner: _ONE}, self.zeroth(f"0.5 / {z.zeroth}"))
        return z

    def _integral(self, zeroth):
        """A node that is defined later, by its own recurrence."""
        name = self.zeroth(zeroth).zeroth
        return _Node(name, name)

    def _define_quotient(self, z, numerator, less, reciprocal):
        """Gives z the value of a difference of forms times the reciprocal of a divisor."""
        difference = self.sum(numerator, self.times(_MINUS_ONE, less))
        self.define(z, self.times(reciprocal, difference))

    def _grows(self, z, x, w, sign=_ONE):
        """z with ż = ± w ẋ: k z_k = ± Σ_{j=1}^{k} j x_j w_{k-j}."""
        inner = self._over_k(self.interiors.add(self._scaled(x), self.value(w)))
        self.define(z, self.times(sign, self.sum(inner, self.times(w, x.form))))

    def _quotient_grows(self, zeroth, x, w, sign=_ONE):
        """z with w ż = ± ẋ: w_0 k z_k = ± k x_k − Σ_{j=1}^{k-1} j z_j w_{k-j}."""
        z = self._integral(zeroth)
        inner = self._over_k(self.interiors.add(self._scaled(z), self.value(w)))
        self._define_quotient(z, self.times(sign, self.form(x)), inner, self.zeroth(f"1.0 / {w.zeroth}"))
        return z

    def _scaled(self, x):
        """k x_k: the derivative's coefficient of order k − 1."""
        text = self.value(x)
        moving = _MOTION.fullmatch(text)
        if moving is None:
            return f"order * {text}"
        array, width, i = moving.groups()
        return f"{'va'['qv'.index(array)]}[{width} * (k - 1) + {i}]"

    @staticmethod
    def _over_k(inner):
        return {f"{inner} * inverse_k": _ONE}

    def _sin_cos(self, angle):
        """Name of the pair of sine and cosine of order 0."""
        name = self._name()
        self.start.append(sin_cos(name, self.angles, angle))
        self.angles += 1
        return name

    def _pair(self, x, names, sign, pick):
        """sin and cos, or sinh and cosh: each is the derivative of the other, but for a sign."""
        key = (names[0], x.zeroth)
        if key not in self.pairs:
            if names[0] == "sin":
                pair = self._sin_cos(x.zeroth)
                s, c = (_Node(f"{pair}.{name}", self._name()) for name in names)
            else:
                s, c = (self._integral(f"{name}({x.zeroth})") for name in names)
            self._grows(s, x, c)
            self._grows(c, x, s, sign)
            self.pairs[key] = (s, c)
        return self.pairs[key][pick]

    def exponential(self, x):
        z = self._integral(f"exp({x.zeroth})")
        self._grows(z, x, z)
        return z

    def logarithm(self, x):
        return self._quotient_grows(f"log({x.zeroth})", x, x)

    def tangent(self, x, name="tan", sign="+"):
        """ż = (1 ± z²) ẋ."""
        z = self._integral(f"{name}({x.zeroth})")
        slope = self._integral(f"1.0 {sign} {z.zeroth} * {z.zeroth}")
        self._grows(z, x, slope)
        square = self.square(z).form
        self.define(slope, self.times(_ONE if sign == "+" else _MINUS_ONE, square))
        return z

    def arc_tangent(self, x):
        """(1 + x²) ż = ẋ."""
        square = self.square(x)
        slope = self.series(f"1.0 + {square.zeroth}", square.form)
        return self._quotient_grows(f"atan({x.zeroth})", x, slope)

    def arc_sine(self, x, name="asin", sign=_ONE):
        """√(1 − x²) ż = ± ẋ."""
        square = self.square(x)
        slope = self.root(self.series(f"1.0 - {square.zeroth}", self.times(_MINUS_ONE, square.form)))
        return self._quotient_grows(f"{name}({x.zeroth})", x, slope, sign)

    def power(self, x, exponent):
        """x ż = p ẋ z: x_0 k z_k = p k x_k z_0 + Σ_{j=1}^{k-1} (p j − (k − j)) x_j z_{k-j}."""
        if not exponent.constant:
            raise NotAnalytic("a power whose exponent varies in time has no Taylor recurrence")
        whole = _whole(exponent.zeroth)
        if whole is not None:
            return self._whole_power(x, whole)
        z = self._integral(f"pow({x.zeroth}, {exponent.zeroth})")
        weighted = self._over_k(self.interiors.add(self._scaled(x), z.name))
        plain = self.interiors.add(self.value(x), z.name)
        grows = self.times(self.zeroth(f"{exponent.zeroth} * {z.zeroth}"), x.form)
        weighted = self.times(self.zeroth(f"{exponent.zeroth} + 1.0"), weighted)
        self._define_quotient(z, self.sum(grows, weighted), {plain: _ONE}, self.zeroth(f"1.0 / {x.zeroth}"))
        return z

    def _whole_power(self, x, exponent):
        """Repeated multiplication, which is defined at x = 0 too."""
        if exponent < 0:
            return self.inverse(self._whole_power(x, -exponent))
        result = None
        while exponent:
            if exponent & 1:
                result = x if result is None else self.product(result, x)
            exponent >>= 1
            x = self.square(x) if exponent else x
        return result


def _whole(text):
    """An exponent that is a small whole number other than 0, else None."""
    try:
        value = float(text)
    except ValueError:
        return None
    return int(value) if value == int(value) and 0 < abs(value) <= 16 else None


_RULES = {
    ca.OP_ADD: lambda g, x, y: g.linear(ca.OP_ADD, _ONE, _ONE)(x, y),
    ca.OP_SUB: lambda g, x, y: g.linear(ca.OP_SUB, _ONE, _MINUS_ONE)(x, y),
    ca.OP_NEG: lambda g, x: g.linear(ca.OP_NEG, _MINUS_ONE)(x),
    ca.OP_TWICE: lambda g, x: g.linear(ca.OP_TWICE, _Node("2.0"))(x),
    ca.OP_ASSIGN: lambda g, x: x,
    ca.OP_MUL: Graph.product,
    ca.OP_SQ: Graph.square,
    ca.OP_DIV: Graph.quotient,
    ca.OP_INV: Graph.inverse,
    ca.OP_SQRT: Graph.root,
    ca.OP_SIN: lambda g, x: g._pair(x, ("sin", "cos"), _MINUS_ONE, 0),
    ca.OP_COS: lambda g, x: g._pair(x, ("sin", "cos"), _MINUS_ONE, 1),
    ca.OP_SINH: lambda g, x: g._pair(x, ("sinh", "cosh"), _ONE, 0),
    ca.OP_COSH: lambda g, x: g._pair(x, ("sinh", "cosh"), _ONE, 1),
    ca.OP_TAN: Graph.tangent,
    ca.OP_TANH: lambda g, x: g.tangent(x, "tanh", "-"),
    ca.OP_ATAN: Graph.arc_tangent,
    ca.OP_ASIN: Graph.arc_sine,
    ca.OP_ACOS: lambda g, x: g.arc_sine(x, "acos", _MINUS_ONE),
    ca.OP_EXP: Graph.exponential,
    ca.OP_LOG: Graph.logarithm,
    ca.OP_POW: Graph.power,
    ca.OP_CONSTPOW: Graph.power,
}


def _name(op):
    """Name of an operation of CasADi: `atan2`."""
    return next(name[3:].lower() for name in dir(ca) if name.startswith("OP_") and getattr(ca, name) == op)


def _walk(graph, place, output):
    """The nodes of a column of expressions; `place` maps symbols to nodes, or to functions that
    make them."""
    symbols = ca.symvar(output)
    missing = [s.name() for s in symbols if s.element_hash() not in place]
    if missing:
        raise ValueError(f"expression depends on {', '.join(missing)}, which is not an argument")
    function = ca.Function("series", symbols, [ca.cse(output)])
    uses = _uses(function)
    work, result = {}, [None] * output.numel()
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        into, source = function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            result[into[1]] = work[source[0]]
        elif op == ca.OP_CONST:
            work[into[0]] = _Node(literal(function.instruction_constant(k)))
        elif op == ca.OP_INPUT:
            work[into[0]] = place[symbols[source[0]].element_hash()]
        else:
            node = graph.operation(op, [work[i] for i in source])
            if node.name is None:
                node.uses = uses[k]
            work[into[0]] = node
    return result


def _uses(function):
    """How often the result of each instruction is used."""
    uses, owner = [0] * function.n_instructions(), {}
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        if op not in (ca.OP_INPUT, ca.OP_CONST):
            for i in function.instruction_input(k):
                uses[owner[i]] += 1
        if op != ca.OP_OUTPUT:
            owner[function.instruction_output(k)[0]] = k
    return uses


class Series:
    """The two series functions of a column of expressions.

    `moving` lists (C array, column of symbols) of what varies in time, one row of the array an
    order; `constant` what does not. `drift` maps the index of a held coordinate to the expression of
    its constant rate; the other `held` ones rest.

    `ends`: whether no coefficient of an order beyond 0, or beyond those of the arguments, differs from zero.
    """

    def __init__(self, output, moving, constant, held, drift):
        self.graph = Graph()
        self.gains = []
        """Texts of factors that the beginning of a step gives."""
        place = {}
        for array, symbols in moving:
            width = symbols.numel()
            for i in range(width):
                place[symbols[i].element_hash()] = _Node(f"{array}[{i}]", f"{array}[{width} * k + {i}]")
        for array, symbols in constant:
            for i in range(symbols.numel()):
                place[symbols[i].element_hash()] = _Node(f"{array}[{i}]")
        for i in range(held.numel()):
            place[held[i].element_hash()] = _Node(f"h[{i}]")
        if drift:
            rates = _walk(self.graph, place, ca.vertcat(*drift.values()))
            for i, rate in zip(drift, rates):
                next = f"(k == 1 ? {self.graph.first(rate)} : REAL(0.0))"
                place[held[i].element_hash()] = _Node(f"h[{i}]", next)
        self.nodes = _walk(self.graph, place, output)
        for i, node in enumerate(self.nodes):
            self.graph.start.append(f"  out[{i}] = REAL({node.zeroth});")

    def finish(self):
        """Lays out the workspace: coefficients of order 0, then a row an order with the left and the
        right factors of the interiors."""
        graph, interiors = self.graph, self.graph.interiors
        self.row = interiors.row
        self.order = ["  const double order = (double)k, inverse_k = dalembert_inverses[k];", "  (void)order, (void)inverse_k;"]
        stores = interiors.stores() if interiors else []
        needed = set(_VARIABLE.findall("\n".join([*stores, *interiors.late.values()])))
        statements = graph.statements(needed)
        self.lead = interiors.lead(graph.slots) if interiors else graph.slots
        self.operations = len(statements)
        self.order += [*(interiors.sums(self.lead) if interiors else []), *statements, *stores]

    def add_to(self, source, name):
        """Adds both functions to a `Source`; returns the names under which they can be called."""
        start = source.add_text(f"{name}_start", _SIGNATURE, _text(self.graph.beginning()))
        interiors = self.graph.interiors
        few, in_pairs = interiors.few and len(interiors), interiors.in_pairs and len(interiors)
        signature = f"const size_t k, {_SIGNATURE}" + (", real *restrict last" if few else "")
        signature += ", const dalembert_block *given" if in_pairs else ""
        signature += ", const real *gains" if self.gains else ""
        order = source.add_text(f"{name}_order", signature, _text(self.order), "DALEMBERT_INLINE")
        gains = ", gains" if self.gains else ""
        call = f"{order}(%s, q, v, a, u, x, w, out{', last' if few else ''}{gains});"
        orders = [f"  for (size_t k = 1; k < n; ++k) {call % 'k'}"]
        if in_pairs:
            pair = source.add_text(f"{name}_pair", "const size_t k, const real *q, const real *v, const real *a, const real *u, const real *w,\n"
                                   "    dalembert_block *out",
                                   "  (void)q, (void)v, (void)a, (void)u;\n" + "\n".join(interiors.pair(self.lead)), "DALEMBERT_INLINE")
            one = f"{order}(%s, q, v, a, u, x, w, out, last, %s{gains});"
            orders = [
                "  size_t k = 1;",
                # None is left over after the last two.
                f"  for (; k < 4 - n % 2 && k < n; ++k) {one % ('k', 'NULL')}",
                "  for (; k + 1 < n; k += 2) {",
                f"    dalembert_block pair[2 * {interiors.blocks}];",
                f"    {pair}(k, q, v, a, u, w, pair);",
                f"    {one % ('k', 'pair')}",
                f"    {one % ('k + 1', f'pair + {interiors.blocks}')}",
                "  }",
            ]
        if interiors.halves == 2:
            unrolled = [f"  if (n <= {k}) return;\n  {call % k}" for k in range(1, MOST_ORDERS)]
            # A vector of eight lanes fills the processor without.
            orders = ["#ifdef LANES", *orders, "#else", *unrolled, "#endif"]
        if few:
            orders.insert(0, f"  real last[{2 * few}] = {{0}};")
        if self.gains:
            orders.insert(0, f"  const real gains[] = {{{', '.join(self.gains)}}};")
        run = source.add_text(f"{name}_run", f"size_t n, {_SIGNATURE}", _text(orders), "DALEMBERT_CLONES")
        return start, run


class Outputs(Series):
    """Series of functions of a motion whose coefficients are all known."""

    def __init__(self, output, **arguments):
        super().__init__(output, **arguments)
        for i, node in enumerate(self.nodes):
            value = "0.0" if node.constant else self.graph.value(node)
            self.graph.state(f"out[{len(self.nodes)} * k + {i}] = REAL({value});")
        self.ends = not self.graph.interiors
        self.finish()


class Equations(Series):
    """The motion of r = M a + b = 0.

    Of order 0 the first function gives M (column-major) and b. Of order k,
    M_0 a_k = −(b_k + Σ_{j=1}^{k} M_j a_{k-j}), which the accelerations up to order k − 1 give: the
    second function takes the inverse of M_0 for `out`, and appends a_k, v_{k+1} and q_{k+2}.
    """

    def __init__(self, free, output, **arguments):
        super().__init__(output, **arguments)
        graph = self.graph
        masses = self.nodes[:free * free]
        self.ends = all(node.constant for node in self.nodes[:free * (free + 1)])
        residuals = []
        for i in range(free):
            load = self.nodes[free * free + i]
            forms = [] if load.constant else [graph.form(load)]
            for j, mass in enumerate(masses[i::free]):
                if not mass.constant:
                    # The acceleration is not known at the start, where factors are multiplied.
                    forms += [self._late(mass, j, free), {f"{graph.value(mass)} * a[{j}]": _ONE}]
            residuals.append(graph._merged(graph.sum(*forms)))
        if all(mass.constant for mass in masses) and self._is_cheap_to_solve(residuals):
            self._append_by_gains(residuals)
        else:
            self._append(residuals)
        self.finish()

    @staticmethod
    def _is_cheap_to_solve(residuals):
        """Whether multiplying the inverse into the factors of all terms makes no more products an order."""
        free, terms = len(residuals), sum(map(len, residuals))
        return free * len({term for form in residuals for term in form}) <= terms + free * free + free

    def _append_by_gains(self, residuals):
        """Appends an order where M is constant: rates are a linear form of the terms, with factors that the inverse
        gives at the beginning of a step. So an order waits for one product and a sum."""
        graph, free = self.graph, len(residuals)
        terms = sorted(dict.fromkeys(term for form in residuals for term in form), key=graph._age)
        for i in range(free):
            gains = []
            for term in terms:
                parts = [(f"out[{free * j + i}]", form[term]) for j, form in enumerate(residuals) if term in form]
                products = " + ".join(inverse if factor is _ONE else f"{inverse} * {graph.first(factor)}"
                                      for inverse, factor in parts)
                gains.append(f"gains[{len(self.gains)}]")
                self.gains.append(f"-({products})")
            inverse = "dalembert_inverses[k + 1]"
            products = [f"({gain} * {inverse}) * {term}" for gain, term in zip(gains, terms)]
            plain = " + ".join(f"{gain} * {term}" for gain, term in zip(gains, terms))
            # In lanes it is the number of operations that counts, not how many of them wait for each other.
            graph.state(f"""
#ifdef LANES
  const real a{i} = {plain or 'REAL(0.0)'}, v{i} = a{i} * {inverse};
#else
  const real v{i} = {' + '.join(products) or 'REAL(0.0)'}, a{i} = v{i} * (order + 1.0);
#endif""".lstrip(), dict.fromkeys(terms, _ONE))
            graph.state(f"a[{free} * k + {i}] = a{i};")
            graph.state(f"v[{free} * (k + 1) + {i}] = v{i};")
            graph.state(f"q[{free} * (k + 2) + {i}] = v{i} * dalembert_inverses[k + 2];")

    def _append(self, residuals):
        """Appends an order."""
        graph, free = self.graph, len(residuals)
        for i, residual in enumerate(residuals):
            graph.state(f"const real r{i} = REAL(%s);", residual)
        for i in range(free):
            row = "".join(f" - out[{free * j + i}] * r{j}" for j in range(free))[1:].replace("- ", "-", 1)
            graph.state(f"const real a{i} = {row};")
            graph.state(f"a[{free} * k + {i}] = a{i};")
            graph.state(f"v[{free} * (k + 1) + {i}] = a{i} * dalembert_inverses[k + 1];")
            graph.state(f"q[{free} * (k + 2) + {i}] = a{i} * (dalembert_inverses[k + 1] * dalembert_inverses[k + 2]);")

    def _late(self, mass, j, free):
        """Interior of M a. The acceleration of order k is not known at order k."""
        value = self.graph.value(mass)
        return {self.graph.interiors.add_late(value, f"acceleration {j}", f"a[{free} * (k - 1) + {j}]"): _ONE}


_SIGNATURE = ("real *restrict q, real *restrict v, real *restrict a, const real *u,\n"
              "    const struct dalembert_context *x, real *restrict w, real *restrict out")


def _text(lines):
    text = "\n".join(lines)
    arrays = "".join(
        f"  const real *const {field} = x->{field};\n"
        for field in ("d", "h", "c") if f" {field}[" in text or f"({field}[" in text
    )
    unused = "".join(f"  (void){name};\n" for name in ("q", "v", "a", "u", "x", "w", "out"))
    return unused + arrays + text
