"""Published equations, as printed: the verdict on each, and what is found of slips that are put into them."""

import unittest

from codegen.verify import seeded
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import load
from codegen.verify.readings.lagrange import Motion
from codegen.verify.report import gather as report
from codegen.verify.report.closed import closed
from codegen.verify.report.findings import detected, repaired
from codegen.verify.seeded import PUBLISHED

# printed terms that agree with the printed energies, of all; None: no energies are printed
AGREE = {"acrobot": (17, 17), "bead_on_rotating_wire": (5, 5), "cart_pole": (8, 8), "compass_gait": None, "double_pendulum": (18, 18),
         # two terms of each equation cancel one another
         "double_pendulum_momenta": (6, 8), "equal_double_pendulum": (7, 7), "furuta_pendulum": (10, 10), "particle_on_cone": (4, 4),
         "spherical_pendulum": (3, 4), "spring_loaded_inverted_pendulum": (8, 8), "three_masses": (7, 7)}
# what is found in them: kind, slip, whether the repaired equation is proved consistent
FOUND = {"equal_double_pendulum": [("repair", "lost term", True)], "spherical_pendulum": [("repair", "power", True)],
         "three_masses": [("undefined", "", False)]}
# of the seeds, every so manieth is judged here; all of them by `verify --seeded`
EVERY = 5


class Published(unittest.TestCase):
    def test_the_verdict_on_each(self):
        self.assertEqual(sorted(folder.name for folder in PUBLISHED.iterdir()), sorted(AGREE))
        for name, agree in AGREE.items():
            with self.subTest(name):
                result = report.verify(load(PUBLISHED / name), thorough=False)
                self.assertEqual([(f.kind, f.slip, f.proved) for f in result.findings], FOUND.get(name, []))
                if agree is None:
                    self.assertIn("difference", result.unjudged)
                else:
                    found = list(result.comparisons.values())[0].values()
                    self.assertEqual((sum(len(c.agree) for c in found), sum(c.terms() for c in found)), agree)

    def test_each_says_where_it_was_read(self):
        for name in AGREE:
            text = (PUBLISHED / name / "paper.tex").read_text(encoding="utf-8")
            self.assertRegex(text, r"% source: .+\n% Read in (.+ commit [0-9a-f]{8}|the page of that address)")

    def test_the_misprint_of_the_double_pendulum_is_shown_by_its_own_other_form(self):
        # the source prints both equations with d/dt too: these are right, and what they give is what is proposed
        with_momenta, without = (load(PUBLISHED / name) for name in ("double_pendulum_momenta", "equal_double_pendulum"))
        printed = Subject(without.paper)
        found, whole = repaired(printed, Motion(without.paper, without.energies[0]))
        self.assertEqual([(repair.ordinals, repair.slip) for list_ in found.values() for repair in list_], [((), "lost term")])
        right = Subject(with_momenta.paper)
        self.assertFalse(judged := detected(right, None), judged)
        for subject, same in ((whole, True), (printed, False)):
            carried = [subject.ring.read(subject.s.m * subject.s.ell**2) * subject.total(n) for n in subject.paper.equations]
            self.assertEqual([str(form) for form in carried] == [str(right.total(n)) for n in right.paper.equations], same)


class Seeded(unittest.TestCase):
    def test_every_slip_is_found_and_undone_and_no_rewriting_is_blamed(self):
        seeds = 0
        for name, outcomes in seeded.run_published(EVERY).items():
            for outcome in outcomes:
                seed = outcome.seed
                with self.subTest(f"{name} ({seed.equation}) term {seed.term + 1}: {seed.kind}"):
                    if outcome.equivalent:
                        self.assertEqual((outcome.found, outcome.repairs), ([], []))
                    else:
                        seeds += 1
                        self.assertTrue(outcome.found)
                        self.assertTrue(outcome.repaired, outcome.repairs)
        self.assertGreater(seeds, 90)


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
