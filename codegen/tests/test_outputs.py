"""Outputs: what is refused, with its line, and what a mode computes."""

import unittest

from codegen.tests.scratch import BODY, HEAD, MODE, ScratchTest

WHOLE = HEAD + BODY + MODE


class Outputs(ScratchTest):
    def refused(self, line, at=8):
        return self.refusal(WHOLE + line, at)

    def test_terms_of_another_dimension(self):
        message = self.refused('model.output("sum", "m", x + x.rate, "nonsense")\n')
        self.assertIn("output `sum`", message)
        self.assertIn("x.rate", message)
        self.assertIn("output `speed`", self.refused('model.output("speed", "m", x.rate, "rate")\n'))

    def test_units_that_are_none(self):
        self.assertIn("`mm` is not known", self.refused('model.output("far", "mm", x, "place")\n'))

    def test_names(self):
        self.assertIn("`x` is declared twice", self.refused('model.output("x", "m", 2 * x, "twice")\n'))
        self.assertIn("cannot be named `t`", self.refused('model.output("t", "m", 2 * x, "twice")\n'))
        self.assertIn("is not a name for a output", self.refused('model.output("2x", "m", 2 * x, "twice")\n'))

    def test_what_is_not_smooth(self):
        self.assertIn("output `size`: `fabs` is not smooth", self.refused(
            'import casadi\nmodel.output("size", "m", casadi.fabs(x), "modulus")\n', 9))

    def test_what_is_no_expression(self):
        self.assertIn("is not an expression", self.refused('model.output("far", "m", "x", "place")\n'))
        self.assertIn("its meaning is a text", self.refused('model.output("far", "m", x, None)\n'))

    def test_a_symbol_of_no_model(self):
        self.assertIn("output `far`: symbol `z`", self.refused('import casadi\nmodel.output("far", "m", casadi.SX.sym("z"), "")\n', 9))

    def test_the_reaction_of_one_mode(self):
        line = 'held = model.mode("held", freeze=[x])\nmodel.output("pull", "N", held.reaction(x), "force")\n'
        self.assertIn("of mode `held` is used in mode `moves`", self.refused(line, 9))

    def test_a_reaction_of_any_mode_where_one_is_meant(self):
        self.assertIn("for outputs, limit states and validity", self.refused(
            'model.requires(moves, model.reaction(x), "no")\n'))

    def test_what_is_described(self):
        [variant] = self.described(WHOLE + 'model.output("twice", "m", 2 * x, "twice the place")\n')["variants"]
        self.assertEqual(variant["outputs"], [{"name": "twice", "unit": "m", "meaning": "twice the place", "text": "(2.*x)"}])

    def test_an_output_is_an_expression_of_limits(self):
        line = 'far = model.output("far", "m", 2 * x, "twice the place")\nmodel.limit("gone", "gone", when=far > 0)\n'
        [limit] = self.described(WHOLE + line)["variants"][0]["limits"]
        self.assertEqual(limit["name"], "gone")


if __name__ == "__main__":
    unittest.main()
