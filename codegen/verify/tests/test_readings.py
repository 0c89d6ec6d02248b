"""Readings of the tank's paper: their order and its reasons, what is wrong in every one and what only in some, and that
the corrections of each are exactly its energies."""

import math
import unittest
from dataclasses import replace
from pathlib import Path

from codegen.verify import Energies, Paper
from codegen.verify.errors import PaperError
from codegen.verify.input.corrections import apply
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import load
from codegen.verify.readings.lagrange import Motion
from codegen.verify.readings.ranking import ranked
from codegen.verify.report import gather
from codegen.verify.report.findings import judge

MODELS = Path(__file__).resolve().parents[3] / "models"


class Tank(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = load(MODELS / "walking_tank")
        cls.report = gather.verify(cls.case, thorough=False)
        cls.readings = {r.name: r for r in cls.report.readings}

    def test_the_energy_consistent_reading_comes_first_though_others_agree_with_more_terms(self):
        best = self.report.readings[0]
        self.assertEqual((best.name, best.verdict(), best.agree, best.terms, best.absent), ("energy-consistent bodies", "squares", 39, 62, 35))
        most = max(self.report.readings, key=lambda r: r.agree)
        self.assertEqual((most.name, most.agree, most.verdict()), ("bulging M_I, rocking M_E", 44, "refuted"))

    def test_the_reading_with_most_terms_makes_the_tank_pull_on_the_ground(self):
        # by hand, with the parameters of the full plate at theta = 0.02, x_I = 0, without friction
        low = min(self.readings["bulging M_I, rocking M_E"].reactions, key=lambda x: x.low)
        self.assertEqual((round(low.low), round(low.high), low.case[:10]), (-247, -247, "full_plate"))
        self.assertFalse(self.readings["energy-consistent bodies"].pulls())
        self.assertEqual(len(self.readings["energy-consistent bodies"].reactions), 8)

    def test_a_reaction_is_that_of_the_solved_equations(self):
        import sympy

        reading = self.readings["energy-consistent bodies"]
        values = {n: sympy.Float(v, 30) for n, v in self.case.paper.sets["doughnut"].items()}
        values.update(theta=sympy.Float("0.02", 30), lam=-1)
        zero = {d + n: 0 for n in ("x_I", "x", "theta", "z_h") for d in ("", "d", "dd") if d + n != "theta"}
        s, m = reading.motion.s, reading.motion.m
        kinetic, potential = reading.motion.energies.kinetic(s, m), reading.motion.energies.potential(s, m)
        q = ["theta", "x_I", "x", "y"]
        symbol = {d + n: sympy.Symbol(d + n, real=True) for n in [*q, "z_h"] for d in ("", "d", "dd")}

        def rate(form):
            return sum(form.diff(symbol[d + n]) * symbol["d" + d + n] for n in [*q, "z_h"] for d in ("", "d"))

        rows = {n: rate(kinetic.diff(symbol["d" + n])) - kinetic.diff(symbol[n]) + potential.diff(symbol[n]) for n in q}
        accelerations = [symbol["dd" + n] for n in ("theta", "x_I", "x")]
        put = {sympy.Symbol(n, real=True): v for n, v in {**values, **zero, "y": 0, "dy": 0, "ddy": 0}.items()
               if sympy.Symbol(n, real=True) not in accelerations}
        solved = sympy.solve([rows[n].subs(put) for n in ("theta", "x_I", "x")], accelerations)
        normal = rows["y"].subs(put).subs(solved)
        found = next(r for r in reading.reactions if r.release.endswith("without friction") and r.case == "doughnut, lam = -1")
        self.assertAlmostEqual(float(normal), found.low, places=9)
        self.assertLess(found.high - found.low, 1e-9)

    def test_sixteen_terms_are_wrong_in_every_reading_and_eighteen_in_some(self):
        always, sometimes = self.report.wrong_terms()
        self.assertEqual((len(always), len(sometimes)), (16, 18))
        # the findings that hold in every reading cover all of the sixteen
        held = {(f.equation, k) for f in self.report.findings for k in f.ordinals if f.readings and len(f.readings) == 6}
        self.assertEqual(always - held, set())

    def test_what_depends_on_the_reading_is_a_choice_and_comes_after_what_does_not(self):
        kinds = [(f.kind, f.readings is None or len(f.readings) == 6) for f in self.report.findings if f.equation != "text"]
        self.assertEqual([whole for kind, whole in kinds if kind != "choice"], [True] * sum(kind != "choice" for kind, _ in kinds))
        first_choice = [kind for kind, _ in kinds].index("choice")
        self.assertNotIn("misprint", [kind for kind, _ in kinds[first_choice:]])
        moment = next(f for f in self.report.findings if f.key == "1-moment")
        self.assertEqual({name for name in self.readings if name not in moment.readings}, {"bulging M_rb, rocking M_I", "bulging M_I, rocking M_I"})
        self.assertEqual(set(moment.alternatives), {"bulging M_rb, rocking M_E", "bulging M_I, rocking M_E"})

    def test_the_corrections_of_each_reading_make_the_equations_exactly_its_own(self):
        self.assertEqual(set(self.case.readings), set(self.readings))
        for energies in self.case.energies:
            whole = Subject(apply(self.case.paper, self.case.readings[energies.name]), self.report.printed)
            left = judge(whole, Motion(self.case.paper, energies))
            # two readings have no positive definite kinetic energy: that is theirs, not the corrections'
            self.assertEqual({name for name, found in left.items() if found} - {"definite"}, set(), energies.name)

    def test_the_bodies_are_the_reading_with_M_rb_in_both_places(self):
        from printed_walking_tank.paper_energies import reading

        same = Motion(self.case.paper, reading("M_rb", "M_rb"))
        bodies = self.readings["energy-consistent bodies"].motion
        self.assertEqual((same.kinetic, same.potential), (bodies.kinetic, bodies.potential))

    def test_split_masses_and_gained_energy_are_findings(self):
        found = {f.key: f for f in self.report.findings if f.kind == "principle"}
        self.assertEqual(set(found), {"split-3", "split-8", "impact-10"})
        self.assertEqual((found["split-3"].ordinals, found["split-8"].ordinals), ((2, 6), (0, 2)))
        self.assertEqual(len(found["impact-10"].readings), 6)

    def test_where_a_negative_coefficient_stands_the_sum_of_squares_proves_nothing(self):
        consistent = self.case.energies[0]
        paper = replace(self.case.paper, sets={"odd": {**self.case.paper.sets["doughnut"], "M_rb": "39.34"}})
        self.assertFalse(ranked(Subject(paper), [consistent], False)[0].squares)

    def test_corrections_of_a_reading_that_does_not_exist_are_refused(self):
        import shutil
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            model = Path(shutil.copytree(MODELS / "walking_tank", Path(folder) / "walking_tank"))
            with (model / "corrections.py").open("a") as stream:
                stream.write('\nreadings["another"] = []\n')
            with self.assertRaisesRegex(PaperError, "'another'"):
                load(model)


class Along(unittest.TestCase):
    """A particle on a ball of radius l, released at 0.5 rad from its top: the ball pushes it with m g (3 cos q - 2 cos 0.5)."""

    def paper(self, duration, minimum=None):
        paper = Paper("particle on a ball", "none", sets={"one": {"m": "2", "l": "1.5", "g": "9.81"}}, box={"q": (-1.0, 1.0)})
        paper.coordinate("q", "rad", "angle from the top", minimum=minimum)
        for name, unit in (("m", "kg"), ("l", "m"), ("g", "m/s^2")):
            paper.parameter(name, unit, name)
        paper.motion("1", of="q")(lambda s, m: [s.m * s.l**2 * s.ddq, -s.m * s.g * s.l * m.sin(s.q)])
        paper.release("from 0.5 rad", at={"q": "0.5"}, duration=duration)
        return paper

    def reading(self, paper, thorough=True):
        energies = Energies("ball", "", lambda s, m: s.m * (s.dr**2 + (s.l + s.r)**2 * s.dq**2) / 2, lambda s, m: s.m * s.g * (s.l + s.r) * m.cos(s.q))
        energies.coordinate("r", "m", "distance from the ball", pushes=True)
        return ranked(Subject(paper), [energies], thorough)[0]

    def test_the_least_is_that_of_the_motion(self):
        from mpmath import cos, mp, odefun, sin

        with mp.workdps(20):
            at = odefun(lambda t, y: [y[1], mp.mpf("9.81") / mp.mpf("1.5") * sin(y[0])], 0, [mp.mpf("0.5"), mp.mpf(0)])
            expected = {t: 2 * mp.mpf("9.81") * (3 * cos(at(t)[0]) - 2 * cos(mp.mpf("0.5"))) for t in (0.25, 0.6)}
        for duration, pushes in ((0.25, True), (0.6, False)):
            (r,) = self.reading(self.paper(duration)).reactions
            self.assertAlmostEqual(r.low, 2 * 9.81 * math.cos(0.5), places=9)
            self.assertEqual((r.least.time, r.pushes()), (duration, pushes))
            self.assertLess(abs(r.least.value - expected[duration]), 1e-7)
            self.assertLess(r.least.uncertainty, 1e-6)

    def test_it_is_looked_at_where_it_is_asked_for_and_up_to_a_bound(self):
        self.assertIsNone(self.reading(self.paper(0.0)).reactions[0].least)
        self.assertIsNone(self.reading(self.paper(0.5), thorough=False).reactions[0].least)
        self.assertLess(self.reading(self.paper(0.6, minimum=0.499)).reactions[0].least.value, 0)
        paper = self.paper(0.5, minimum=0.51)
        self.assertEqual(self.reading(paper).reactions[0].least.time, 0.0)
        for duration in (-1, "long", float("inf")):
            with self.assertRaisesRegex(PaperError, "duration"):
                self.paper(duration)

    def test_a_reading_that_pulls_on_the_way_comes_after_one_that_does_not(self):
        paper = self.paper(0.6)
        heavy = Energies("bead on the ball", "", lambda s, m: s.m * (s.dr**2 + s.l**2 * s.dq**2) / 2, lambda s, m: s.m * s.g * s.l * m.cos(s.q) + s.m * s.g * s.r)
        light = Energies("ball", "", lambda s, m: s.m * (s.dr**2 + (s.l + s.r)**2 * s.dq**2) / 2, lambda s, m: s.m * s.g * (s.l + s.r) * m.cos(s.q))
        for energies in (heavy, light):
            energies.coordinate("r", "m", "distance from the ball", pushes=True)
        self.assertEqual([r.name for r in ranked(Subject(paper), [light, heavy])], ["bead on the ball", "ball"])


if __name__ == "__main__":
    unittest.main()
