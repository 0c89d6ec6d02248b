"""Of a model with choices the variant that a scene asks for is derived alone, whichever it is."""

import json
import unittest

from codegen import generate
from codegen.tests.scratch import ScratchTest

TEXT = """\
from codegen.model import *
model = Model("Test", source="this test")
place = model.choice("place", ("elongation", "height"), "coordinate", default="elongation")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness")
l = model.parameter("l", "m", 1.0, "length")
x = model.coordinate("x", "m", "place")
model.point_mass(m, position=(x, 0))
model.potential(k * (x if place == "elongation" else x - l) ** 2 / 2)
model.mode("moves")
"""


class Variants(ScratchTest):
    def test_each_is_derived_alone(self):
        self.generate(TEXT)
        for number, place in enumerate(("elongation", "height")):
            files = generate.generate(self.folder, named={"place": place})
            manifest = json.loads(files["manifest.json"])
            self.assertEqual(manifest["derived"], [number])
            self.assertEqual({name.split(":")[0] for name in manifest["operations"]}, {place})


if __name__ == "__main__":
    unittest.main()

    def test_a_coordinate_that_means_something_else_is_refused(self):
        for given, what in (
            ('"place" if place == "elongation" else "height"', "meaning differs between choices: 'place', but 'height' with place = height"),
            ('"place", scale=1.0 if place == "elongation" else 2.0', "scale differs between choices: 1.0, but 2.0 with place = height"),
        ):
            with self.subTest(what=what):
                self.assertIn(f"`x`: its {what}", self.refusal(TEXT.replace('"place")\nmodel.point', given + ")\nmodel.point"), 7))
