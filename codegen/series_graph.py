"""A graph of power series in time, as statements of C: a node for each operation, with its recurrence.

Nodes that are constant in time are recognised: a constant times a series is one product an order.
Between what is not linear, an order is a linear map with coefficients that the start of the step
gives. So a coefficient of order k is held as a linear form of the terms that an order begins with:
sums and products by constants multiply its coefficients out, once a step, and an order waits for
one product and a sum instead of a chain of them. Where the mass matrix is constant, so does its
inverse.
"""

import re

import casadi as ca

from .emit_c import SIN_COS, literal, operation, parenthesized, sin_cos
from .interiors import Interiors


class Node:
    """Coefficients of a node: C text of order 0, and of order k a linear form, None where all but the first
    vanish.

    A form maps terms, C text of order k, to their constant factors. `name`: of the variable that holds
    its value, where there is one; `uses`: how often the graph refers to the node.
    """

    __slots__ = ("zeroth", "form", "name", "slot", "uses")

    def __init__(self, zeroth, term=None):
        self.zeroth, self.slot, self.uses = zeroth, None, 1
        self.form, self.name = (None, None) if term is None else ({term: ONE}, term)

    @property
    def constant(self):
        return self.form is None


VARIABLE = re.compile(r"\bt\d+\b")
_MOTION = re.compile(r"([qv])\[(\d+) \* k \+ (\d+)\]")
_NAME = re.compile(r"\b[A-Za-z]")
_DEFINITION = re.compile(r"\s*const (?:real|struct \w+) (t\d+) = ")

ONE = Node("1.0")
_MINUS_ONE = Node("-1.0")


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
        # Of numbers alone C makes one number, not one a lane.
        text = text if _NAME.search(text) else f"REAL({text})"
        self.start.append(f"  const real {name} = {text};")
        return Node(name)

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
        self.forms[node.name], node.form = form, {node.name: ONE}

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
                needed = needed | set(VARIABLE.findall(" ".join([statement, *form])))
        return kept[::-1]

    def beginning(self):
        """The statements of the first function that something needs."""
        kept, needed = [], set()
        for line in reversed(self.start):
            defined = _DEFINITION.match(line)
            if defined is None or defined.group(1) in needed:
                kept.append(line)
                needed |= set(VARIABLE.findall(line))
        return kept[::-1]

    # ---- forms --------------------------------------------------------------------------------

    def form(self, node, factor=ONE):
        """A form of the node times a constant, for another node: that of its variable where its value is
        needed more than once, or where the products by the constant would be more than one."""
        units = sum(own in (ONE, _MINUS_ONE) for own in node.form.values())
        plain = factor in (ONE, _MINUS_ONE)
        if node.name is None and len(node.form) > 1 and (node.uses > 1 or units > 1 and not plain):
            self.value(node)
        return self.times(factor, node.form)

    def text(self, form):
        """C text of a form. What is known first enters first."""
        text = ""
        for term in sorted(form, key=self._age):
            factor = form[term]
            product = term if factor in (ONE, _MINUS_ONE) else f"{self.first(factor)} * {term}"
            sign = "-" if factor is _MINUS_ONE else "+" if text else ""
            text += f" {sign} {product}" if text else f"{sign}{product}"
        return text or "REAL(0.0)"

    @staticmethod
    def _age(term):
        """When the term of an order is known, compared with others: inputs, interiors, motion, variables."""
        variable = VARIABLE.match(term)
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
        if ONE in (x, y):
            return y if x is ONE else x
        if _MINUS_ONE in (x, y):
            other = y if x is _MINUS_ONE else x
            return ONE if other is _MINUS_ONE else self.zeroth(f"-{parenthesized(other.zeroth)}")
        return self.zeroth(operation(ca.OP_MUL, [x.zeroth, y.zeroth]))

    def _sum(self, x, y):
        """The sum of two factors; None: zero."""
        if None in (x, y):
            return y if x is None else x
        if {x, y} == {ONE, _MINUS_ONE}:
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
                return Node(f"{self._sin_cos(arguments[0].zeroth)}.{SIN_COS[op]}")
            return self.zeroth(operation(op, [a.zeroth for a in arguments]))
        return _RULES[op](self, *arguments)

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
        return self.series(zeroth, self.sum({inner: ONE}, self.times(x, y.form), self.times(y, x.form)))

    def square(self, x):
        inner = self.interiors.add(self.value(x), self.value(x))
        twice = self.zeroth(f"2.0 * {x.zeroth}")
        return self.series(f"{x.zeroth} * {x.zeroth}", self.sum({inner: ONE}, self.times(twice, x.form)))

    def quotient(self, x, y):
        """z with y z = x."""
        zeroth = operation(ca.OP_DIV, [x.zeroth, y.zeroth])
        reciprocal = self.zeroth(f"1.0 / {parenthesized(y.zeroth)}")
        if y.constant:
            return self.series(zeroth, self.form(x, reciprocal))
        z = self._integral(zeroth)
        inner = self.interiors.add(self.value(y), z.name)
        rest = self.sum({inner: ONE}, self.times(z, y.form))
        self._define_quotient(z, {} if x.constant else self.form(x), rest, reciprocal)
        return z

    def inverse(self, x):
        return self.quotient(Node("1.0"), x)

    def root(self, x):
        """z with z z = x."""
        z = self._integral(f"sqrt({x.zeroth})")
        inner = self.interiors.add(z.name, z.name)
        self._define_quotient(z, self.form(x), {inner: ONE}, self.zeroth(f"0.5 / {z.zeroth}"))
        return z

    def _integral(self, zeroth):
        """A node that is defined later, by its own recurrence."""
        name = self.zeroth(zeroth).zeroth
        return Node(name, name)

    def _define_quotient(self, z, numerator, less, reciprocal):
        """Gives z the value of a difference of forms times the reciprocal of a divisor."""
        difference = self.sum(numerator, self.times(_MINUS_ONE, less))
        self.define(z, self.times(reciprocal, difference))

    def _grows(self, z, x, w, sign=ONE):
        """z with ż = ± w ẋ: k z_k = ± Σ_{j=1}^{k} j x_j w_{k-j}."""
        self.define(z, self.times(sign, self._grown(x, w)))

    def _quotient_grows(self, zeroth, x, w, sign=ONE):
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
        return {f"{inner} * inverse_k": ONE}

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
                s, c = (Node(f"{pair}.{name}", self._name()) for name in names)
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
        self.define(slope, self.times(ONE if sign == "+" else _MINUS_ONE, square))
        return z

    def _square_plus(self, x, sign, number):
        """± x² + a number."""
        square = self.square(x)
        factor = ONE if sign == "+" else _MINUS_ONE
        return self.series(f"{number} {sign} {square.zeroth}", self.times(factor, square.form))

    def arc_tangent(self, x, name="atan", sign="+"):
        """(1 ± x²) ż = ẋ."""
        return self._quotient_grows(f"{name}({x.zeroth})", x, self._square_plus(x, sign, "1.0"))

    def arc_sine(self, x, name="asin", inner=("-", "1.0"), sign=ONE):
        """√(± x² + a number) ż = ± ẋ."""
        return self._quotient_grows(f"{name}({x.zeroth})", x, self.root(self._square_plus(x, *inner)), sign)

    def _sum_of_squares(self, x, y):
        return self.operation(ca.OP_ADD, [self.operation(ca.OP_SQ, [x]), self.operation(ca.OP_SQ, [y])])

    def angle(self, y, x):
        """(x² + y²) ż = x ẏ − y ẋ."""
        z = self._integral(operation(ca.OP_ATAN2, [y.zeroth, x.zeroth]))
        squares = self._sum_of_squares(x, y)
        turns = self.sum(self._grown(y, x), self.times(_MINUS_ONE, self._grown(x, y)))
        inner = self._over_k(self.interiors.add(self._scaled(z), self.value(squares)))
        self._define_quotient(z, turns, inner, self.zeroth(f"1.0 / {squares.zeroth}"))
        return z

    def _grown(self, x, w):
        """(w ẋ)_{k-1} / k: Σ_{j=1}^{k} j x_j w_{k-j} / k."""
        if x.constant:
            return {}
        if w.constant:
            return self.form(x, w)
        inner = self._over_k(self.interiors.add(self._scaled(x), self.value(w)))
        return self.sum(inner, self.times(w, x.form))

    def exponential_less_one(self, x):
        """ż = eˣ ẋ."""
        z = self._integral(f"expm1({x.zeroth})")
        self._grows(z, x, self.exponential(x))
        return z

    def logarithm_of_one_and(self, x):
        """(1 + x) ż = ẋ."""
        return self._quotient_grows(f"log1p({x.zeroth})", x, self.series(f"1.0 + {x.zeroth}", x.form))

    def error_function(self, x):
        """ż = 2/√π e^(−x²) ẋ."""
        z = self._integral(f"erf({x.zeroth})")
        slope = self.product(Node("1.1283791670955126"), self.exponential(self._square_plus(x, "-", "0.0")))
        self._grows(z, x, slope)
        return z

    def power(self, x, exponent):
        """x ż = p ẋ z: x_0 k z_k = p k x_k z_0 + Σ_{j=1}^{k-1} (p j − (k − j)) x_j z_{k-j}. With an exponent that varies: e^(p log x)."""
        if not exponent.constant:
            return self.exponential(self.product(exponent, self.operation(ca.OP_LOG, [x])))
        whole = _whole(exponent.zeroth)
        if whole is not None:
            return self._whole_power(x, whole)
        z = self._integral(f"pow({x.zeroth}, {exponent.zeroth})")
        weighted = self._over_k(self.interiors.add(self._scaled(x), z.name))
        plain = self.interiors.add(self.value(x), z.name)
        grows = self.times(self.zeroth(f"{exponent.zeroth} * {z.zeroth}"), x.form)
        weighted = self.times(self.zeroth(f"{exponent.zeroth} + 1.0"), weighted)
        self._define_quotient(z, self.sum(grows, weighted), {plain: ONE}, self.zeroth(f"1.0 / {x.zeroth}"))
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
    ca.OP_ADD: lambda g, x, y: g.linear(ca.OP_ADD, ONE, ONE)(x, y),
    ca.OP_SUB: lambda g, x, y: g.linear(ca.OP_SUB, ONE, _MINUS_ONE)(x, y),
    ca.OP_NEG: lambda g, x: g.linear(ca.OP_NEG, _MINUS_ONE)(x),
    ca.OP_TWICE: lambda g, x: g.linear(ca.OP_TWICE, Node("2.0"))(x),
    ca.OP_ASSIGN: lambda g, x: x,
    ca.OP_MUL: Graph.product,
    ca.OP_SQ: Graph.square,
    ca.OP_DIV: Graph.quotient,
    ca.OP_INV: Graph.inverse,
    ca.OP_SQRT: Graph.root,
    ca.OP_SIN: lambda g, x: g._pair(x, ("sin", "cos"), _MINUS_ONE, 0),
    ca.OP_COS: lambda g, x: g._pair(x, ("sin", "cos"), _MINUS_ONE, 1),
    ca.OP_SINH: lambda g, x: g._pair(x, ("sinh", "cosh"), ONE, 0),
    ca.OP_COSH: lambda g, x: g._pair(x, ("sinh", "cosh"), ONE, 1),
    ca.OP_TAN: Graph.tangent,
    ca.OP_TANH: lambda g, x: g.tangent(x, "tanh", "-"),
    ca.OP_ATAN: Graph.arc_tangent,
    ca.OP_ASIN: Graph.arc_sine,
    ca.OP_ACOS: lambda g, x: g.arc_sine(x, "acos", sign=_MINUS_ONE),
    ca.OP_ATAN2: Graph.angle,
    ca.OP_HYPOT: lambda g, x, y: g.root(g._sum_of_squares(x, y)),
    ca.OP_ATANH: lambda g, x: g.arc_tangent(x, "atanh", "-"),
    ca.OP_ASINH: lambda g, x: g.arc_sine(x, "asinh", ("+", "1.0")),
    ca.OP_ACOSH: lambda g, x: g.arc_sine(x, "acosh", ("+", "-1.0")),
    ca.OP_EXP: Graph.exponential,
    ca.OP_EXPM1: Graph.exponential_less_one,
    ca.OP_LOG: Graph.logarithm,
    ca.OP_LOG1P: Graph.logarithm_of_one_and,
    ca.OP_ERF: Graph.error_function,
    ca.OP_POW: Graph.power,
    ca.OP_CONSTPOW: Graph.power,
}
"""Every smooth operation that can be emitted as C; equations and guards have no others."""


def walk(graph, place, output):
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
            work[into[0]] = Node(literal(function.instruction_constant(k)))
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
