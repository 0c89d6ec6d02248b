"""Published equations, as printed: the verdict on each, and what is found of slips that are put into them."""

import unittest

from codegen.verify import seeded
from codegen.verify.input.load import load
from codegen.verify.report import gather as report
from codegen.verify.report.closed import closed
from codegen.verify.seeded import PUBLISHED

# printed terms that agree with the printed energies, of all; None: no energies are printed
AGREE = {"acrobot": (17, 17), "cart_pole": (8, 8), "compass_gait": None, "double_pendulum": (18, 18),
         "spring_loaded_inverted_pendulum": (8, 8)}


class Published(unittest.TestCase):
    def test_the_verdict_on_each(self):
        self.assertEqual(sorted(folder.name for folder in PUBLISHED.iterdir()), sorted(AGREE))
        for name, agree in AGREE.items():
            with self.subTest(name):
                result = report.verify(load(PUBLISHED / name), thorough=False)
                self.assertEqual(result.findings, [])
                if agree is None:
                    self.assertIn("difference", result.unjudged)
                else:
                    found = list(result.comparisons.values())[0].values()
                    self.assertEqual((sum(len(c.agree) for c in found), sum(c.terms() for c in found)), agree)

    def test_each_says_where_it_was_read(self):
        for name in AGREE:
            text = (PUBLISHED / name / "paper.tex").read_text(encoding="utf-8")
            self.assertRegex(text, r"% source: .+\n% Read in .+ commit [0-9a-f]{8}")


class Seeded(unittest.TestCase):
    def test_every_slip_is_found_and_undone_and_no_rewriting_is_blamed(self):
        seeds = 0
        for name, agree in AGREE.items():
            if agree is None:
                continue  # without energies slips are located, not undone: test_locate.py
            for outcome in seeded.run(name, PUBLISHED / name):
                seed = outcome.seed
                with self.subTest(f"{name} ({seed.equation}) term {seed.term + 1}: {seed.kind}"):
                    if outcome.equivalent:
                        self.assertEqual((outcome.found, outcome.repairs), ([], []))
                    else:
                        seeds += 1
                        self.assertTrue(outcome.found)
                        self.assertTrue(outcome.repaired, outcome.repairs)
        self.assertGreater(seeds, 200)


class Rest(unittest.TestCase):
    def test_a_coordinate_whose_box_has_no_zero_does_not_rest_there(self):
        result = report.verify(load(PUBLISHED / "spring_loaded_inverted_pendulum"))
        self.assertEqual(str(closed(result.definiteness[0].at_rest)), "m**2*r**2")
        self.assertEqual([v.status for v in result.definiteness[1].boxes.values()], ["proved"])

    def test_without_bounds_nothing_is_said_of_a_box(self):
        result = report.verify(load(PUBLISHED / "acrobot"))
        self.assertEqual(result.definiteness[1].boxes, {})


if __name__ == "__main__":
    unittest.main()
