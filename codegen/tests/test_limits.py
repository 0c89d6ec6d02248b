"""Limit states, validity and bounds of coordinates: what is no comparison is refused, with its line."""

import unittest

from codegen.tests.scratch import BODY, HEAD, MODE, ScratchTest

WHOLE = HEAD + BODY + MODE


class Limits(ScratchTest):
    def test_what_is_no_comparison(self):
        for line in ('model.limit("far", "far", when=x)\n', 'model.valid(x, "near")\n',
                     'model.limit("far", "far", when=falls(x).expression)\n'):
            with self.subTest(line=line):
                self.assertIn("is no comparison", self.refusal(WHOLE + line, 8))

    def test_sides_of_different_dimensions(self):
        self.assertIn("limit `far`", self.refusal(WHOLE + 'model.limit("far", "far", when=x > m)\n', 8))
        self.assertIn("validity", self.refusal(WHOLE + 'model.valid(x < m, "near")\n', 8))

    def test_a_name_that_is_there(self):
        twice = 'model.limit("far", "far", when=x > 0)\n' * 2
        self.assertIn("declared twice", self.refusal(WHOLE + twice, 9))

    def test_a_reaction_of_another_mode(self):
        line = 'held = model.mode("held", freeze=[x])\nmodel.limit("torn", "torn", when=held.reaction(x) > 0)\n'
        self.assertIn("of mode `held` is used in mode `moves`", self.refusal(WHOLE + line, 9))

    def test_a_reaction_in_its_mode(self):
        line = ('held = model.mode("held", freeze=[x])\n'
                'model.limit("torn", "torn", when=held.reaction(x) > 0, modes=[held])\n')
        [limit] = self.described(WHOLE + line)["variants"][0]["limits"]
        self.assertEqual((limit["name"], limit["message"]), ("torn", "torn"))

    def test_conditions_of_parameters_are_no_margins(self):
        [variant] = self.described(WHOLE + 'model.valid(m > 0, "light")\nmodel.valid(x < 0, "near")\n')["variants"]
        self.assertEqual([entry["sentence"] for entry in variant["valid_parameters"]], ["light"])
        self.assertEqual([entry["sentence"] for entry in variant["valid_motion"]], ["near"])
        self.assertEqual(list(variant["modes"][0]["margins"][0]), ["linear"])

    def test_a_bound_that_moves(self):
        self.assertIn("a bound of a coordinate", self.refusal(
            HEAD + 'y = model.coordinate("y", "m", "place", maximum=x)\n', 6))

    def test_a_bound_that_depends_on_parameters(self):
        wall = 'wall = model.parameter("wall", "m", 1.0, "wall")\n'
        head = HEAD.replace("x = ", wall + "x = ").replace('"place")', '"place", minimum=-1, maximum=2 * wall)')
        described = self.described(head + BODY + MODE)
        [coordinate] = described["coordinates"]
        self.assertEqual((coordinate["minimum"], coordinate["maximum"]), (-1.0, None))
        [bound] = described["variants"][0]["bounds"]
        self.assertEqual(bound, {"coordinate": 0, "upper": True, "text": "(2.*wall)"})


if __name__ == "__main__":
    unittest.main()
