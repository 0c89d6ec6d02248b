"""A model with an error is refused, with the line and the term."""

import unittest

from codegen.tests.scratch import BODY, HEAD, MODE, ScratchTest


class Units(ScratchTest):
    def test_a_potential_of_the_wrong_dimension(self):
        message = self.refusal(HEAD + BODY + "model.potential(k * x)\n" + MODE, 7)
        self.assertIn("potential energy: the term `(k*x)`", message)
        self.assertIn("kg m/s^2, expected kg m^2/s^2", message)

    def test_one_wrong_term_of_a_sum(self):
        message = self.refusal(HEAD + BODY + "model.potential(k * x**2 / 2 + m * x)\n" + MODE, 7)
        self.assertIn("(m*x)", message)

    def test_a_sum_inside_a_function(self):
        message = self.refusal(HEAD + BODY + "model.potential(k * x**2 * cos(x))\n" + MODE, 7)
        self.assertIn("the argument of cos, `x`, has the dimension m", message)

    def test_mass_position_force_and_dissipation(self):
        for line, what in (
            ("model.point_mass(k, position=(x, 0))\n", "body 2: mass"),
            ("model.point_mass(m, position=(k, 0))\n", "body 2: position X"),
            ("model.force(x, m)\n", "force on `x`"),
            ("model.dissipation(k * x.rate**2)\n", "dissipation"),
            ("model.kinetic(k * x.rate**2)\n", "kinetic energy"),
        ):
            with self.subTest(what=what):
                self.assertIn(what, self.refusal(HEAD + BODY + line + MODE, 7))

    def test_a_force_of_a_mode(self):
        self.assertIn("in mode `moves`", self.refusal(HEAD + BODY + MODE + "moves.force(x, k)\n", 8))

    def test_a_guard_and_a_reset(self):
        guard = 'model.transition("t", moves, moves, when=falls(x + x.rate))\n'
        self.assertIn("guard of `t`", self.refusal(HEAD + BODY + MODE + guard, 8))
        reset = 'model.transition("t", moves, moves, when=falls(x), reset=[(x.rate, x)])\n'
        self.assertIn("reset of `x.rate`", self.refusal(HEAD + BODY + MODE + reset, 8))

    def test_an_unknown_unit(self):
        message = self.refusal(HEAD + 'y = model.coordinate("y", "furlong", "place")\n', 6)
        self.assertIn("`furlong` is not known", message)


class Smoothness(ScratchTest):
    def test_functions_that_are_not_smooth(self):
        for expression in (
            "k * x * ca.fabs(x) / 2", "ca.if_else(x > 0, k, 2 * k) * x**2", "k * x**2 * ca.sign(x)",
            "k * ca.fmax(x, 0)**2",
        ):
            with self.subTest(expression=expression):
                with self.assertRaises(Exception) as caught:
                    self.generate(HEAD + BODY + f"model.potential({expression})\n" + MODE)
                self.assertIn("is not smooth", str(caught.exception))
                self.assertIn("model.py", str(caught.exception))

    def test_a_guard_that_is_not_smooth(self):
        guard = 'model.transition("t", moves, moves, when=falls(ca.fabs(x) - x / 2))\n'
        self.assertIn("is not smooth", self.refusal(HEAD + BODY + MODE + guard, 8))

    def test_parameters_alone_may_be_anything(self):
        self.generate(HEAD + BODY + "model.potential(ca.fabs(k) * x**2)\n" + MODE)


class Structure(ScratchTest):
    def test_a_name_twice(self):
        self.assertIn("declared twice", self.refusal(HEAD + 'y = model.coordinate("x", "m", "again")\n', 6))

    def test_a_reaction_of_a_free_coordinate(self):
        message = self.refusal(HEAD + BODY + MODE + "model.requires(moves, moves.reaction(x), \"\")\n", 8)
        self.assertIn("`x` is free, it has no reaction", message)

    def test_a_python_error(self):
        self.assertIn("NameError", self.refusal(HEAD + BODY + "model.potential(unknown)\n", 7))

    def test_a_syntax_error(self):
        self.assertIn("SyntaxError", self.refusal(HEAD + "model.potential(\n", 6))

    def test_no_model(self):
        with self.assertRaisesRegex(Exception, "no Model"):
            self.generate("from codegen.model import *\n")


if __name__ == "__main__":
    unittest.main()
