"""All independent errors of a model at once, with their places; what its modes are."""

import os
import sys
import tempfile
import unittest

from codegen.judge import judge

MODEL = """\
from codegen.model import *
model = Model("Test", source="this test")
m = model.parameter("m", "{unit}", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness")
x = model.coordinate("x", "m", "place")
model.point_mass(m, position=(x, 0))
model.potential(k * x**2 / 2{extra})
held = model.mode("held", freeze=[x])
moves = model.mode("moves")
model.transition("stops", moves, held, when=falls({guard}))
model.transition("starts", held, moves, when=falls({other}))
model.parameter_set("heavy", "more of it", m=2.0)
{end}
"""
GOOD = dict(unit="kg", extra="", guard="x.rate", other="held.reaction(x)", end="")


class Judge(unittest.TestCase):
    """What `check` prints."""

    def judge(self, **changes):
        """The judgement on the model with some of its parts changed."""
        with tempfile.TemporaryDirectory() as folder:
            folder = os.path.join(folder, "made_up")
            os.mkdir(folder)
            with open(os.path.join(folder, "model.py"), "w", encoding="utf-8") as stream:
                stream.write(MODEL.format(**{**GOOD, **changes}))
            return judge(folder)

    def errors(self, **changes):
        """Its errors, by line and beginning."""
        result = self.judge(**changes)
        self.assertFalse(result["ok"])
        self.assertEqual(result["modes"], [])
        return [(e["line"], e["message"]) for e in result["errors"]]

    def test_a_good_model_has_modes(self):
        result = self.judge()
        self.assertEqual((result["ok"], result["errors"]), (True, []))
        modes = {mode["name"]: (mode["free"], mode["guards"]) for mode in result["modes"]}
        self.assertEqual(modes, {"held": ([], ["starts"]), "moves": (["x"], ["stops"])})
        self.assertEqual(result["modes"][1]["operations"]["residual"], 3)

    def test_errors_that_do_not_depend_on_each_other_are_all_told(self):
        lines = [line for line, _ in self.errors(extra=" + m", guard="m", other="k")]
        self.assertEqual(lines, [7, 10, 11])

    def test_what_follows_from_an_error_is_not_told(self):
        found = self.errors(unit="kgg", end="model.point_mass(q, position=(x, 0))")
        self.assertEqual([line for line, _ in found], [3, 13])
        self.assertIn("`kgg` is not known", found[0][1])
        self.assertIn("name 'q' is not defined", found[1][1])

    @unittest.skipIf(sys.version_info < (3, 11), "Python tells no columns")
    def test_places_have_columns(self):
        error = self.judge(end="y = m + nothing")["errors"][0]
        self.assertEqual((error["line"], error["column"], error["end_column"]), (13, 9, 16))

    def test_what_to_do_is_apart(self):
        error = self.judge(unit="kgg")["errors"][0]
        self.assertTrue(error["help"].startswith("use -, 1, "))


if __name__ == "__main__":
    unittest.main()
