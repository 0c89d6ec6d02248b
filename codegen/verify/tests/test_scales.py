"""Correct equations in other forms than Lagrange's: divided by a mass or by m l^2, with a sign in an
angle. They are judged right, their slips are found, and what they were divided by is said."""

import json
import unittest
from dataclasses import replace
from pathlib import Path

from codegen.verify import seeded, Paper
from codegen.verify.input import transcription
from codegen.verify.input.energies import Energies
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import Case, load
from codegen.verify.readings.lagrange import Motion
from codegen.verify.report import gather as report, html, machine, text, words
from codegen.verify.report.findings import judge

DIVISORS = (
    (lambda s: s.m_2 * s.l_1**2, lambda s: s.m_2 * s.l_2**2), (lambda s: s.m_2 * s.l_1, lambda s: s.m_2 * s.l_2),
    (lambda s: s.l_1, lambda s: 1), (lambda s: 2 * s.m_1, lambda s: s.m_2), (lambda s: 1, lambda s: s.l_2 * s.m_2 * s.g),
)


def divided(equation, divisor, change=lambda terms, s: terms):
    """An equation over a divisor, then changed."""
    return replace(equation, latex="", function=lambda s, m: change([t / divisor(s) for t in equation.function(s, m)], s))


class Divided(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = load(seeded.EXAMPLES / "double_pendulum", "double_pendulum")

    def judged(self, divisors, change=lambda terms, s: terms, energies=True):
        first, second = self.case.paper.equations["1"], self.case.paper.equations["2"]
        paper = self.case.paper.with_equations([divided(first, divisors[0], change), divided(second, divisors[1])])
        case = replace(self.case, paper=paper, energies=self.case.energies if energies else [])
        return report.verify(case, thorough=False)

    def test_nothing_is_found_in_a_right_equation_over_a_monomial(self):
        for divisors in DIVISORS:
            for energies in (True, False):
                result = self.judged(divisors, energies=energies)
                self.assertEqual(result.findings, [])
                self.assertEqual({n for n, v in result.violations.items() if v}, set())

    def test_the_multiplier_is_said(self):
        result = self.judged(DIVISORS[0])
        self.assertEqual(["".join(map(str, line)) for line in words.scale_lines(result)], ["Equation (1) is judged as multiplied by 1*l_1**2*m_2.",
                                                         "Equation (2) is judged as multiplied by 1*l_2**2*m_2."])
        data = json.loads(machine.as_json(result))
        self.assertEqual(sorted(data["multipliers"]), ["1", "2"])
        self.assertIn("Equation (1) is judged as multiplied by", text.as_text(result))
        self.assertIn("Equation (1) is judged as multiplied by", html.as_html(result))
        plain = report.verify(self.case, thorough=False)
        self.assertEqual((words.scale_lines(plain), json.loads(machine.as_json(plain))["multipliers"]), ([], {}))

    def test_a_slip_in_a_divided_equation_is_found_and_undone(self):
        changes = [("sign", lambda terms, s: [*terms[:2], -terms[2], *terms[3:]]), ("number", lambda terms, s: [2 * terms[0], *terms[1:]]),
                   ("symbol", lambda terms, s: [*terms[:2], terms[2] * s.m_1 / s.m_2, *terms[3:]]), ("lost term", lambda terms, s: terms[:-1]),
                   ("dot", lambda terms, s: [*terms[:2], terms[2] / s.ddtheta_2 * s.dtheta_2, *terms[3:]])]
        for divisors in DIVISORS:
            for slip, change in changes:
                if slip == "symbol" and divisors is DIVISORS[3]:
                    continue  # over m_1, the wrong mass cancels: two factors are lost
                result = self.judged(divisors, change)
                self.assertEqual([(f.equation, f.slip, f.proved) for f in result.findings], [("1", slip, True)], slip)

    def test_one_divided_term_is_no_divided_equation(self):
        # not a multiplier of the equation, which has other terms
        for energies in (True, False):
            for k in range(5):
                change = lambda terms, s, k=k: [t / s.m_1 if i == k else t for i, t in enumerate(terms)]
                result = self.judged((lambda s: 1, lambda s: 1), change, energies)
                self.assertTrue(result.findings)
                self.assertTrue(result.violations["dimensions"])


class Spherical(unittest.TestCase):
    def test_a_spherical_pendulum_over_m_l_squared(self):
        paper = Paper("Spherical pendulum", "any textbook")
        paper.coordinate("theta", "rad", "angle from the vertical")
        paper.coordinate("phi", "rad", "azimuth", mirror=-1)
        for name, unit in (("m", "kg"), ("l", "m"), ("g", "m/s^2")):
            paper.parameter(name, unit, name)
        paper.motion("1", of="theta", latex=r"\ddot{\theta} = \sin \theta \cos \theta \dot{\phi}^2 - \frac{g}{l} \sin \theta")(
            lambda s, m: [s.ddtheta, -m.sin(s.theta) * m.cos(s.theta) * s.dphi**2, s.g / s.l * m.sin(s.theta)])
        paper.motion("2", of="phi", latex=r"\sin^2 \theta \ddot{\phi} + 2 \sin \theta \cos \theta \dot{\theta} \dot{\phi} = 0")(
            lambda s, m: [m.sin(s.theta)**2 * s.ddphi, 2 * m.sin(s.theta) * m.cos(s.theta) * s.dtheta * s.dphi])
        energies = Energies("point mass", "", lambda s, m: s.m * s.l**2 * (s.dtheta**2 + m.sin(s.theta)**2 * s.dphi**2) / 2,
                            lambda s, m: -s.m * s.g * s.l * m.cos(s.theta))
        for given in ([energies], []):
            result = report.verify(Case("spherical", Path("."), paper, given))
            self.assertEqual((result.findings, result.transcribed), ([], ["1", "2"]))
            self.assertEqual(len(words.scale_lines(result)), 2)


class SignInAnAngle(unittest.TestCase):
    def test_housner_s_block_with_a_sign_in_its_sine(self):
        def paper(sign):
            result = Paper("Rocking block", "any textbook")
            result.coordinate("theta", "rad", "tilt", mirror=-1)
            result.input("z", "m", "displacement of the ground", mirror=-1)
            for name, unit in (("I", "kg*m^2"), ("m", "kg"), ("R", "m"), ("alpha", "rad"), ("g", "m/s^2")):
                result.parameter(name, unit, name)
            result.motion("1", of="theta", latex=r"I \ddot{\theta} + m g R \sin(\alpha \operatorname{sign}(\theta) - \theta) = "
                          r"-m R \ddot{z} \cos(\alpha \operatorname{sign}(\theta) - \theta)")(
                lambda s, m: [s.I * s.ddtheta, s.m * s.g * s.R * m.sin(s.alpha * m.sign(s.theta) - s.theta),
                              sign * s.m * s.R * s.ddz * m.cos(s.alpha * m.sign(s.theta) - s.theta)])
            return result

        # the potential whose slope this is, on either side of zero
        energies = Energies("block", "", lambda s, m: s.I * s.dtheta**2 / 2,
                            lambda s, m: s.m * s.g * s.R * m.cos(s.alpha * m.sign(s.theta) - s.theta),
                            forces={"theta": lambda s, m: -s.m * s.R * s.ddz * m.cos(s.alpha * m.sign(s.theta) - s.theta)})
        result = report.verify(Case("block", Path("."), paper(1), [energies]))
        self.assertEqual((result.findings, result.transcribed), ([], ["1"]))
        wrong = report.Subject(paper(-1))
        with self.assertRaisesRegex(Exception, "differ from term 3"):
            transcription.proved(wrong)
        self.assertTrue(judge(Subject(paper(-1)), Motion(paper(-1), energies))["difference"])


if __name__ == "__main__":
    unittest.main()
