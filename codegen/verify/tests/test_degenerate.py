"""Where something vanishes at rest, or an equation is not printed: a verdict all the same, and the right one."""

import json
import unittest
from dataclasses import replace
from pathlib import Path

from codegen.verify import Paper, check_certificate as script, seeded
from codegen.verify.load import Case, load
from codegen.verify.report import certificate, gather, html, machine, tex, text


class Degenerate(unittest.TestCase):
    def said(self, report):
        """The report for a terminal; all other forms of it can be written, and its claims hold."""
        html.as_html(report), tex.as_latex(report), machine.as_json(report)
        content = json.loads(certificate.as_certificate(report))
        checker = script.Checker(content)
        self.assertEqual([c for c in content["claims"] if not checker.holds(c)], [])
        return text.as_text(report)

    def one(self, *terms):
        """The report of one equation in q."""
        paper = Paper("one", "none")
        paper.coordinate("q", "rad", "angle")
        paper.parameter("I", "kg*m^2", "inertia")
        paper.parameter("k", "N*m", "spring")
        paper.motion("1", of="q")(lambda s, m: [term(s, m) for term in terms])
        return gather.verify(Case("one", Path("."), paper), thorough=False)

    def test_a_divisor_that_vanishes_at_rest(self):
        report = self.one(lambda s, m: s.I / m.sin(s.q) * s.ddq, lambda s, m: s.k * s.q)
        self.assertIn("determinant at rest: none", self.said(report))
        self.assertIsNone(json.loads(machine.as_json(report))["definiteness"][0]["determinant_at_rest"])

    def test_a_mass_that_vanishes_at_rest(self):
        report = self.one(lambda s, m: s.I * m.sin(s.q)**2 * s.ddq, lambda s, m: s.I * m.sin(s.q) * m.cos(s.q) * s.dq**2, lambda s, m: s.k * s.q)
        self.assertEqual(report.findings, [])
        self.assertIn("Small motions about rest have no frequencies", self.said(report))

    def test_a_coordinate_without_an_equation_moves(self):
        """Of a right pair of equations each is right by itself: the factors of its accelerations change with the other coordinate."""
        whole = load(seeded.EXAMPLES / "double_pendulum").paper
        for number in whole.equations:
            paper = replace(whole, equations={number: whole.equations[number]})
            report = gather.verify(Case("half", Path("."), paper), thorough=False)
            self.assertEqual(report.findings, [])
            self.said(report)


if __name__ == "__main__":
    unittest.main()
