"""Zeros are proved, and nothing else is called zero."""

import math
import random
import unittest

import casadi as ca

from codegen.exact import Exact, lifted

X, Y, P = ca.SX.sym("x"), ca.SX.sym("y"), ca.SX.sym("p")
SIDE = ca.SX.sym("side")


class Zeros(unittest.TestCase):
    def test_identities_are_shown(self):
        for zero in (
            ca.sin(X) ** 2 + ca.cos(X) ** 2 - 1,
            ca.sin(X + Y) - ca.sin(X) * ca.cos(Y) - ca.cos(X) * ca.sin(Y),
            ca.cos(P - X) - ca.cos(X - P),
            ca.sin(3 * X) - 3 * ca.sin(X) + 4 * ca.sin(X) ** 3,
            ca.sin(X / 2 + X / 2) - 2 * ca.sin(X / 2) * ca.cos(X / 2) - ca.sin(X) + 2 * ca.sin(X / 2) * ca.cos(X / 2),
            ca.tan(X) * ca.cos(X) - ca.sin(X),
            1 / (X - Y) - 1 / (X + Y) - 2 * Y / (X**2 - Y**2),
            ca.sqrt(X) * ca.sqrt(X) - X,
            X**1.5 / ca.sqrt(X) - X,
            ca.gradient(ca.exp(X * Y), X) - Y * ca.exp(X * Y),
            SIDE**2 - 1,
            SIDE**3 * X - SIDE * X,
        ):
            with self.subTest(zero=str(zero)):
                self.assertTrue(Exact([(SIDE, (1, -1))]).is_zero(zero))

    def test_what_is_not_zero_is_not_called_zero(self):
        for other in (
            X, X - Y, ca.sin(X) - X, ca.sin(X) ** 2 + ca.cos(Y) ** 2 - 1, SIDE - 1, 1e-300 * X, X - (1 + 2**-52) * X,
            ca.sqrt(X**2) - X, ca.fabs(X) - X, (X**2 - Y**2) / (X - Y) - X, 1 - ca.cos(X) ** 2,
        ):
            with self.subTest(other=str(other)):
                self.assertFalse(Exact([(SIDE, (1, -1))]).is_zero(other))

    def test_numbers_that_are_rounded_are_lifted_before_the_derivative(self):
        numbers = {}
        energy = lifted(0.1 * X**3 * ca.sin(0.3 * X), numbers)
        rate = lifted(0.1 * X**2 * (3 * ca.sin(0.3 * X) + 0.3 * X * ca.cos(0.3 * X)), numbers)
        self.assertTrue(Exact().is_zero(ca.gradient(energy, X) - rate))
        self.assertTrue(Exact().is_zero(lifted(X - 0.3 * Y, numbers) - lifted(-0.3 * Y + X, numbers)))

    def test_random_expressions_agree_with_their_values(self):
        """A random expression less itself multiplied out is zero; changed in one coefficient it is not."""
        draw = random.Random(1)
        for _ in range(100):
            factors = [draw.choice((X, Y, ca.sin(X), ca.cos(X + Y), P, SIDE, X + P, ca.sqrt(P))) for _ in range(4)]
            a, b, c, d = factors
            product, expanded = (a + b) * (c + d), a * c + a * d + b * c + b * d
            field = Exact([(SIDE, (1, -1))])
            self.assertTrue(field.is_zero(product - expanded))
            changed = product - expanded - 1e-12 * a * c
            at = ca.Function("at", [X, Y, P, SIDE], [a * c])(0.37, 0.61, 0.83, 1)
            self.assertTrue(math.isfinite(float(at)) and float(at) != 0)
            self.assertFalse(field.is_zero(changed))


if __name__ == "__main__":
    unittest.main()
