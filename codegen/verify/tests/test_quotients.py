"""Equations with divisors that are no monomials: solved for the accelerations, over sums and common functions, tangents."""

import random
import unittest
from dataclasses import replace
from pathlib import Path

import sympy

from codegen.verify import Energies, Paper, group, seeded
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import Case, load
from codegen.verify.normal.algebra import Ring, expression
from codegen.verify.normal.division import quotient
from codegen.verify.readings.lagrange import Motion
from codegen.verify.report import gather as report, html, machine, text, words
from codegen.verify.report.findings import detected, repaired

A, M, X, Y, LAM = sympy.symbols("a m x y lam", real=True)
sin, cos, tan = sympy.sin, sympy.cos, sympy.tan


class Quotients(unittest.TestCase):
    def setUp(self):
        self.ring = Ring(["lam"], ["a", "m"])
        self.random = random.Random(1)

    def polynomial(self, states=False):
        """A random trigonometric polynomial, not zero."""
        atoms = [X, Y, M, A, sin(X), cos(X), sin(X - Y), cos(2 * X), cos(A - X), M**2, sympy.Rational(2, 3)]
        while True:
            terms = [self.random.choice([1, -2, 3]) * self.random.choice(atoms) * self.random.choice(atoms)
                     * (self.random.choice([1, LAM]) if states else 1) for _ in range(3)]
            if form := self.ring.read(sum(terms)):
                return form

    def test_a_product_is_divided_by_its_factor_and_what_is_none_is_not(self):
        for _ in range(60):
            first, second = self.polynomial(states=True), self.polynomial()
            self.assertEqual(quotient(first * second, second), first)
            # a polynomial of higher degree is no factor of one that it does not divide
            other = first * second + self.ring.read(Y**5)
            found = quotient(other, second)
            self.assertTrue(found is None or found * second == other)

    def test_identities_of_quotients_are_decided(self):
        same = [(1 + tan(X)**2, 1 / cos(X)**2), (1 / (M + A) + 1 / (M - A), 2 * M / (M**2 - A**2)), ((M**2 - A**2) / (M + A), M - A),
                (sin(2 * X) / cos(X), 2 * sin(X)), (tan(X), 1 / sympy.cot(X)), (sympy.sec(X)**2 - tan(X)**2, sympy.Integer(1)),
                (sympy.sign(X / (M + A)), sympy.sign(X) * sympy.sign(M + A)), (1 / (2 + LAM), (2 - LAM) / 3)]
        for left, right in same:
            with self.subTest(left):
                self.assertEqual(self.ring.read(left), self.ring.read(right))
                self.assertEqual(self.ring.read(expression(self.ring.read(left))), self.ring.read(right))
        for left, right in [(tan(X), sin(X)), (1 / (M + A), 1 / (M - A)), (tan(2 * X), 2 * tan(X))]:
            self.assertNotEqual(self.ring.read(left), self.ring.read(right))

    def test_derivatives_are_those_of_sympy(self):
        for term in (tan(X), X**2 / (M + cos(X - Y)), sin(X) / (1 + X**2)**2, Y / (X * (A + X))):
            for name in (X, Y):
                self.assertEqual(self.ring.read(term).diff(name.name), self.ring.read(sympy.diff(term, name)))
        self.assertEqual(self.ring.read(tan(X)**3 / (M + X)).order(["x"]), 3)
        self.assertIsNone(self.ring.read(1 / tan(X)).order(["x"]))


def explicit():
    """The double pendulum, solved for its accelerations, as the textbooks of computer animation print it."""
    case = load(seeded.EXAMPLES / "double_pendulum", "double_pendulum")
    paper = replace(case.paper, equations={})
    below = lambda s, m: 2 * s.m_1 + s.m_2 - s.m_2 * m.cos(2 * s.theta_1 - 2 * s.theta_2)

    @paper.motion("1", of="theta_1")
    def first(s, m):
        d, e = s.theta_1 - s.theta_2, s.l_1 * below(s, m)
        return [s.ddtheta_1, *group(s.g * m.sin(s.theta_1) / e, 2 * s.m_1, s.m_2), s.m_2 * s.g * m.sin(s.theta_1 - 2 * s.theta_2) / e,
                2 * m.sin(d) * s.m_2 * s.dtheta_2**2 * s.l_2 / e, 2 * m.sin(d) * s.m_2 * s.dtheta_1**2 * s.l_1 * m.cos(d) / e]

    @paper.motion("2", of="theta_2")
    def second(s, m):
        d, e = s.theta_1 - s.theta_2, s.l_2 * below(s, m)
        return [s.ddtheta_2, *group(-2 * m.sin(d) * s.dtheta_1**2 * s.l_1 / e, s.m_1, s.m_2),
                *group(-2 * m.sin(d) * s.g * m.cos(s.theta_1) / e, s.m_1, s.m_2),
                -2 * m.sin(d) * s.dtheta_2**2 * s.l_2 * s.m_2 * m.cos(d) / e]

    return replace(case, paper=paper)


class Explicit(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = explicit()

    def test_right_equations_are_agreed_to_and_what_was_done_is_said(self):
        result = report.verify(self.case, thorough=False)
        self.assertEqual(result.findings, [])
        found = result.comparisons[self.case.energies[0].name].values()
        self.assertEqual([(len(c.agree), c.terms(), c.solved) for c in found], [(6, 6, True), (6, 6, True)])
        for shown in (text.as_text(result), html.as_html(result)):
            self.assertIn("Equation (1) is judged as solved for the acceleration", shown)
        self.assertTrue(machine.as_json(result))

    def test_without_energies_nothing_is_objected_to_and_it_is_said(self):
        result = report.verify(replace(self.case, energies=[]))
        self.assertEqual(result.findings, [])
        self.assertIn("solved for the accelerations", result.unjudged["lagrangian"])

    def test_slips_are_found_and_undone(self):
        subject, motion = Subject(self.case.paper), Motion(self.case.paper, self.case.energies[0])
        outcomes = seeded.outcomes("explicit", subject, motion)
        errors = [o for o in outcomes if not o.equivalent]
        self.assertGreater(len(errors), 50)
        for outcome in errors:
            with self.subTest(f"({outcome.seed.equation}) term {outcome.seed.term + 1}: {outcome.seed.kind}"):
                self.assertTrue(outcome.found)
                self.assertTrue(outcome.repaired, outcome.repairs)
        for outcome in outcomes:
            if outcome.equivalent:
                self.assertEqual((outcome.found, outcome.repairs), ([], []))

    def test_a_slip_in_the_divisor_is_one_slip(self):
        first = self.case.paper.equations["1"]
        wrong = lambda s, m: [t.subs(m.cos(2 * s.theta_1 - 2 * s.theta_2), m.sin(2 * s.theta_1 - 2 * s.theta_2)) for t in first.function(s, m)]
        subject = Subject(self.case.paper.with_equations([replace(first, function=wrong)]))
        motion = Motion(self.case.paper, self.case.energies[0])
        found, whole = repaired(subject, motion)
        self.assertEqual([(r.ordinals, r.slip) for r in found["1"]], [((1, 2, 3, 4, 5), "function")])
        self.assertEqual(detected(whole, motion), [])


class Divided(unittest.TestCase):
    """Correct equations over a sum and over common functions of the coordinates."""

    DIVISORS = (lambda s, m: s.m_1 + s.m_2, lambda s, m: (s.m_1 + s.m_2) * s.l_1**2, lambda s, m: m.cos(s.theta_1),
                lambda s, m: s.m_2 * s.l_1 * m.cos(s.theta_1 - s.theta_2), lambda s, m: s.m_1 + s.m_2 * m.sin(s.theta_1 - s.theta_2)**2)

    @classmethod
    def setUpClass(cls):
        cls.case = load(seeded.EXAMPLES / "double_pendulum", "double_pendulum")

    def judged(self, divisor, change=lambda terms: terms, energies=True):
        first = self.case.paper.equations["1"]
        function = lambda s, m: change([term / divisor(s, m) for term in first.function(s, m)])
        paper = self.case.paper.with_equations([replace(first, latex="", function=function)])
        return report.verify(replace(self.case, paper=paper, energies=self.case.energies if energies else []), thorough=False)

    def test_nothing_is_found(self):
        for k, divisor in enumerate(self.DIVISORS):
            for energies in (True, False):
                with self.subTest(f"{k}, energies {energies}"):
                    result = self.judged(divisor, energies=energies)
                    self.assertEqual(result.findings, [])
                    self.assertEqual(len(words.scale_lines(result)), 1)

    def test_a_slip_is_found_and_undone(self):
        for k, divisor in enumerate(self.DIVISORS):
            for slip, change in (("sign", lambda terms: [*terms[:2], -terms[2], *terms[3:]]), ("lost term", lambda terms: terms[:-1])):
                with self.subTest(f"{k}, {slip}"):
                    result = self.judged(divisor, change)
                    self.assertEqual([(f.equation, f.slip, f.proved) for f in result.findings], [("1", slip, True)])


class Tangent(unittest.TestCase):
    def test_a_tangent_in_latex_is_judged(self):
        paper = Paper("Mass on a guided spring", "made for this test")
        paper.coordinate("theta", "rad", "angle", mirror=-1)
        for name, unit in (("m", "kg"), ("l", "m"), ("k", "N/m")):
            paper.parameter(name, unit, name)
        paper.motion("1", of="theta", latex=r"m l^2 \ddot\theta + k l^2 \tan\theta (1 + \tan^2\theta) = 0")
        energies = Energies("spring", "", lambda s, m: s.m * s.l**2 * s.dtheta**2 / 2, lambda s, m: s.k * s.l**2 * m.tan(s.theta)**2 / 2)
        for given in ([energies], []):
            result = report.verify(Case("tangent", Path("."), paper, given))
            self.assertEqual(result.findings, [])
        wrong = replace(paper.equations["1"], latex=r"m l^2 \ddot\theta + k l^2 \tan\theta (1 - \tan^2\theta) = 0")
        result = report.verify(Case("tangent", Path("."), paper.with_equations([wrong]), [energies]))
        self.assertEqual([(f.slip, f.proved) for f in result.findings], [("sign", True)])


if __name__ == "__main__":
    unittest.main()
