"""Lower bounds hold wherever the symbols are within their radii, and are as good as they need to be."""

import random
import unittest

import casadi as ca

from codegen.bounds import lower_bound

x, y, c = (ca.SX.sym(name) for name in "xyc")
r, s = ca.SX.sym("r"), ca.SX.sym("s")
RADII = {x.element_hash(): r, y.element_hash(): s}

EXPRESSIONS = (
    c * x - y, x * y, x**2 - c * y**2, ca.sin(x) * ca.cos(c - y), x / (3 + y), 1 / (4 + x), ca.sqrt(5 + x),
    ca.exp(x - y), ca.atan(x) + ca.tanh(y), (1 + x) ** 5, -2 * x * (x - y), c + ca.sin(c) - ca.fabs(x),
)


def bound_of(expression):
    return ca.Function("bound", [x, y, c, r, s], [lower_bound(expression, RADII)])


class LowerBound(unittest.TestCase):
    def test_no_value_is_below(self):
        draw = random.Random(1)
        for expression in EXPRESSIONS:
            value, bound = ca.Function("value", [x, y, c], [expression]), bound_of(expression)
            for _ in range(300):
                at = [draw.uniform(-1, 1) for _ in range(3)]
                radii = [draw.uniform(0, 0.8) for _ in range(2)]
                low = float(bound(*at, *radii))
                for _ in range(10):
                    near = [a + draw.uniform(-1, 1) * b for a, b in zip(at, radii)]
                    self.assertGreaterEqual(float(value(*near, at[2])), low - 1e-14, expression)

    def test_without_radii_it_is_the_value(self):
        for expression in EXPRESSIONS:
            value = ca.Function("value", [x, y, c], [expression])
            self.assertEqual(float(bound_of(expression)(0.3, -0.4, 0.7, 0, 0)), float(value(0.3, -0.4, 0.7)))

    def test_a_linear_expression_reaches_it(self):
        self.assertEqual(float(bound_of(3 * x - 2 * y + c)(1, 1, 10, 0.5, 0.25)), 11 - 1.5 - 0.5)

    def test_a_divisor_that_may_vanish_and_a_root_that_may_not_exist_say_nothing(self):
        for expression in (1 / x, c / x, ca.sqrt(x)):
            low = float(bound_of(expression)(0.1, 0, 1, 0.2, 0))
            self.assertFalse(low > 0, expression)

    def test_an_operation_without_a_rule_says_nothing(self):
        for expression in (5 + ca.tan(x), 5 + x ** c):
            self.assertEqual(float(bound_of(expression)(0.5, 0, 1, 0, 0)), -float("inf"))

    def test_what_may_be_anything_says_nothing(self):
        bound = lower_bound(x**2 + 1, {x.element_hash(): None})
        self.assertEqual(float(ca.DM(bound)), -float("inf"))


if __name__ == "__main__":
    unittest.main()
