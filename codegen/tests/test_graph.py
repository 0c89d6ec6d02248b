"""Bounds of rounding errors hold where the terms of factors cancel, too; expressions as text."""

import random
import sys
import unittest
from fractions import Fraction

import casadi as ca

from codegen import graph, units

x, y, z = (ca.SX.sym(name) for name in "xyz")

EXPRESSIONS = (
    x - y, z * (x - y), (x - y) * (z - x), -2 * (x - y) ** 2, (x - y) / z, z * (x - y + 1) - z, (z * (x - y)) * x - y * (x - z),
)


def exactly(expression, values):
    """The value of an expression of + − × ÷ without rounding."""
    if expression.is_symbolic():
        return Fraction(values[expression.name()])
    if expression.is_constant():
        return Fraction(float(expression))
    parts = [exactly(expression.dep(k), values) for k in range(expression.n_dep())]
    operations = {
        ca.OP_ADD: lambda a, b: a + b, ca.OP_SUB: lambda a, b: a - b, ca.OP_MUL: lambda a, b: a * b,
        ca.OP_DIV: lambda a, b: a / b, ca.OP_NEG: lambda a: -a, ca.OP_SQ: lambda a: a * a, ca.OP_TWICE: lambda a: 2 * a,
    }
    return operations[expression.op()](*parts)


class Parity(unittest.TestCase):
    def test_signs_cancel_where_they_do(self):
        even = (x * x, (x * y) * (x * z) + y, ca.fabs(x / y), (x * z) ** 2 * y, y - z, (x + x * y) / x, (-x) * (x * ca.sin(y)))
        odd_or_neither = (x, x + y, (x + y) ** 2, ca.cos(x * y), (x * y) / z, ca.vertcat(y, x), x**2 * x)
        for expression in even:
            self.assertTrue(graph.is_even(expression, x), expression)
        for expression in odd_or_neither:
            self.assertFalse(graph.is_even(expression, x), expression)

    def test_what_is_even_has_the_same_bits(self):
        draw = random.Random(2)
        expression = ca.vertcat((x * y) * (x * z) + y / z, (x * ca.sin(y)) ** 2, (x * y - x / z) / (x + x * z))
        self.assertTrue(graph.is_even(expression, x))
        values = ca.Function("values", [x, y, z], [expression])
        for _ in range(1000):
            a, b, c = (draw.uniform(-2, 2) for _ in range(3))
            self.assertEqual(*(values(s * a, b, c).full().tolist() for s in (+1, -1)))


class Rounding(unittest.TestCase):
    def test_terms_of_factors_count(self):
        size = ca.Function("size", [x, y, z], [graph.magnitude(z * (x - y)), graph.rounding(z * (x - y))])
        self.assertEqual([float(v) for v in size(3, 3, -2)], [12, 36])

    def test_no_error_is_larger(self):
        draw = random.Random(1)
        for expression in EXPRESSIONS:
            function = ca.Function("value", [x, y, z], [expression, graph.rounding(expression)])
            for _ in range(300):
                first = draw.uniform(1, 2)
                # Cancels to a few last places.
                at = [first, first * (1 + draw.choice((0, 1e-15, 1e-8, 0.1))), draw.uniform(1, 2)]
                value, bound = (float(v) for v in function(*at))
                error = abs(Fraction(value) - exactly(expression, dict(zip("xyz", at))))
                self.assertLessEqual(error, bound * sys.float_info.epsilon / 2, f"{expression} at {at}")


class Text(unittest.TestCase):
    def test_numbers_and_symbols_have_no_names_of_their_own(self):
        one, twelve = ca.SX(1), ca.SX(12)
        self.assertEqual(units.short((one - x) * (one - ca.cos(y))), "((1-x)*(1-cos(y)))")
        self.assertEqual(units.short(twelve * x - twelve * y), "((12*x)-(12*y))")


if __name__ == "__main__":
    unittest.main()
