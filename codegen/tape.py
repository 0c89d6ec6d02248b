"""Expressions as tapes: lists of instructions that the program itself carries out, in an arithmetic of its own.

Generated C computes in doubles. Where the sign of a number that rounding decides is asked for, the program expands
expressions in time with bounds of the rounding of every coefficient: `src/jets/`. A tape holds the expressions as
they are derived, in the parameters themselves, so that nothing was rounded before.

An instruction refers to others by their places. Functions other than the four operations obey dz/dt = w dx/dt, where
the coefficients of order k need w only up to the order k − 1: w may stand after z in the tape, or be z itself.
"""

import casadi as ca

_BINARY = {ca.OP_ADD: "Sum", ca.OP_SUB: "Difference", ca.OP_MUL: "Product", ca.OP_DIV: "Quotient"}

_FIXED = {
    ca.OP_FMIN: "Least", ca.OP_FMAX: "Greatest", ca.OP_LT: "Less", ca.OP_LE: "NotMore", ca.OP_EQ: "Equal",
    ca.OP_NE: "Unequal", ca.OP_NOT: "Not", ca.OP_AND: "And", ca.OP_OR: "Or", ca.OP_IF_ELSE_ZERO: "Where",
    ca.OP_FABS: "Modulus", ca.OP_SIGN: "Sign", ca.OP_FLOOR: "Floor", ca.OP_CEIL: "Ceiling",
}
"""Of what depends on parameters alone: anything."""

MOST_FACTORS = 64
"""A whole power with more factors is an exponential of a logarithm."""


class Tape:
    """Instructions under construction."""

    def __init__(self):
        self.instructions, self.pairs = [], {}

    def add(self, name, *operands):
        """Appends an instruction; gives its place."""
        self.instructions.append({name: operands[0] if len(operands) == 1 else list(operands)})
        return len(self.instructions) - 1

    def constant(self, value):
        value = float(value)
        finite = value == value and abs(value) != float("inf")
        return self.add("Constant", value if finite else repr(value))

    def binary(self, name, x, y):
        return self.add(name, x, y)

    def function(self, name, x, slope):
        """z with dz/dt = w dx/dt: `slope` appends w, given the place of z, and gives its place."""
        z = self.add("Function", name, x, None)
        self.instructions[z] = {"Function": [name, x, slope(z)]}
        return z

    def pair(self, names, x, sign):
        """Sine and cosine, circular or hyperbolic."""
        key = (names[0], x)
        if key not in self.pairs:
            first = len(self.instructions)
            slope = first + 2 if sign < 0 else first
            self.add("Function", names[0], x, first + 1)
            self.add("Function", names[1], x, slope)
            if sign < 0:
                self.add("Negative", first)
            self.pairs[key] = first
        return self.pairs[key]

    def reciprocal(self, x):
        return self.binary("Quotient", self.constant(1), x)

    def one_and(self, name, x):
        return self.binary(name, self.constant(1), x)

    def square(self, x):
        return self.binary("Product", x, x)

    def root(self, x):
        return self.function("SquareRoot", x, lambda z: self.binary("Quotient", self.constant(0.5), z))

    def exponential(self, x):
        return self.function("Exponential", x, lambda z: z)

    def logarithm(self, x):
        return self.function("Logarithm", x, lambda z: self.reciprocal(x))

    def power(self, x, exponent, value):
        """x to an exponent, by its place, and its value where it is a number."""
        if value is not None and value == int(value) and abs(value) <= MOST_FACTORS:
            product = self.constant(1)
            for _ in range(abs(int(value))):
                product = self.binary("Product", product, x)
            return product if value >= 0 else self.reciprocal(product)
        return self.exponential(self.binary("Product", exponent, self.logarithm(x)))

    def operation(self, op, places, values):
        """The place of an operation; `values`: of the operands that are numbers."""
        x = places[0]
        if op in _BINARY:
            return self.binary(_BINARY[op], *places)
        if op in (ca.OP_POW, ca.OP_CONSTPOW):
            return self.power(x, places[1], values[1])
        if op in _SIMPLE:
            return _SIMPLE[op](self, x)
        if op in _FIXED:
            return self.add("Fixed", _FIXED[op], x, places[-1])
        # No rule: nothing is known about its sign.
        return self.constant(float("nan"))


_SIMPLE = {
    ca.OP_ASSIGN: lambda t, x: x,
    ca.OP_NEG: lambda t, x: t.add("Negative", x),
    ca.OP_SQ: lambda t, x: t.square(x),
    ca.OP_TWICE: lambda t, x: t.binary("Sum", x, x),
    ca.OP_INV: lambda t, x: t.reciprocal(x),
    ca.OP_SQRT: lambda t, x: t.root(x),
    ca.OP_SIN: lambda t, x: t.pair(("Sine", "Cosine"), x, -1),
    ca.OP_COS: lambda t, x: t.pair(("Sine", "Cosine"), x, -1) + 1,
    ca.OP_SINH: lambda t, x: t.pair(("HyperbolicSine", "HyperbolicCosine"), x, +1),
    ca.OP_COSH: lambda t, x: t.pair(("HyperbolicSine", "HyperbolicCosine"), x, +1) + 1,
    ca.OP_EXP: lambda t, x: t.exponential(x),
    ca.OP_LOG: lambda t, x: t.logarithm(x),
    ca.OP_TAN: lambda t, x: t.function("Tangent", x, lambda z: t.one_and("Sum", t.square(z))),
    ca.OP_TANH: lambda t, x: t.function("HyperbolicTangent", x, lambda z: t.one_and("Difference", t.square(z))),
    ca.OP_ATAN: lambda t, x: t.function("ArcTangent", x, lambda z: t.reciprocal(t.one_and("Sum", t.square(x)))),
    ca.OP_ASIN: lambda t, x: t.function(
        "ArcSine", x, lambda z: t.reciprocal(t.root(t.one_and("Difference", t.square(x))))),
    ca.OP_ACOS: lambda t, x: t.function(
        "ArcCosine", x,
        lambda z: t.binary("Quotient", t.constant(-1), t.root(t.one_and("Difference", t.square(x))))),
}


def of(column, places):
    """The tape of a column of expressions, as data. `places`: an instruction for each symbol, by its hash."""
    column = ca.densify(ca.vec(ca.SX(column)))
    symbols = ca.symvar(column)
    function = ca.Function("tape", symbols, [ca.cse(column)])
    tape, work, values, results = Tape(), {}, {}, [None] * column.numel()
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        into, source = function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            results[into[1]] = work[source[0]]
        elif op == ca.OP_CONST:
            values[into[0]] = float(function.instruction_constant(k))
            work[into[0]] = tape.constant(values[into[0]])
        else:
            # Places of the function's memory are used again.
            numbers = [values.get(i) for i in source] if op != ca.OP_INPUT else []
            values.pop(into[0], None)
            if op == ca.OP_INPUT:
                work[into[0]] = tape.add(*places[symbols[source[0]].element_hash()])
            else:
                work[into[0]] = tape.operation(op, [work[i] for i in source], numbers)
    return {"instructions": tape.instructions, "results": results}


def places(model, equations, signals):
    """The instruction for each symbol of a mode."""
    found = {}
    for i, c in enumerate(model.coordinates):
        for kind, symbol in (("Coordinate", c.symbol), ("Rate", c.symbol.rate), ("Acceleration", c.symbol.acceleration)):
            found[symbol.element_hash()] = (kind, i)
    found.update((symbol.element_hash(), ("Held", i)) for i, symbol in enumerate(ca.vertsplit(equations.held)))
    for kind, symbols in (
        ("Signal", ca.vertsplit(signals)), ("Discrete", [d.symbol for d in model.discretes]),
        ("Parameter", [p.symbol for p in model.parameters]),
    ):
        found.update((symbol.element_hash(), (kind, i)) for i, symbol in enumerate(symbols))
    return found
