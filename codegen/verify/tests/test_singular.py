"""Singular configurations that are declared: what is said of everywhere else, and of equations that were divided by what is zero there."""

import json
import shutil
import tempfile
import unittest
from pathlib import Path

from codegen.verify import Energies, Paper, check_certificate as script
from codegen.verify.errors import PaperError, VerifyError
from codegen.verify.load import Case, load
from codegen.verify.report import certificate, gather, text
from codegen.verify.tests.cases import ROOT, report_of

PENDULUM = ROOT / "codegen/verify/published/spherical_pendulum"
DECLARED = "% singular where \\sin\\theta = 0\n"


def spherical(*, singular=True, divided="", sign=1):
    """A spherical pendulum whose equations are right; the second may be divided by something, or the first have the wrong sign."""
    paper = Paper("pendulum", "none", sets={"one": {"m": "1", "l": "2", "g": "9.81"}}, box={"q": (-1.0, 2.0), "p": (-3.0, 3.0)})
    paper.coordinate("q", "rad", "angle from the vertical")
    paper.coordinate("p", "rad", "azimuth", mirror=-1)
    for name, unit in (("m", "kg"), ("l", "m"), ("g", "m/s^2")):
        paper.parameter(name, unit, name)
    if singular:
        paper.singular_where("the vertical")(lambda s, m: m.sin(s.q))
    over = {"": lambda s, m: 1, "sine": lambda s, m: m.sin(s.q), "cosine": lambda s, m: m.cos(s.q)}[divided]
    paper.motion("1", of="q")(lambda s, m: [sign * s.m * s.l**2 * s.ddq, -s.m * s.l**2 * m.sin(s.q) * m.cos(s.q) * s.dp**2,
                                            s.m * s.g * s.l * m.sin(s.q)])
    paper.motion("2", of="p")(lambda s, m: [s.m * s.l**2 * m.sin(s.q)**2 * s.ddp / over(s, m),
                                            2 * s.m * s.l**2 * m.sin(s.q) * m.cos(s.q) * s.dq * s.dp / over(s, m)])
    return paper


def report(paper, energies=False):
    """Its report, with or without energies."""
    known = Energies("Lagrange", "", lambda s, m: s.m * s.l**2 * (s.dq**2 + m.sin(s.q)**2 * s.dp**2) / 2, lambda s, m: -s.m * s.g * s.l * m.cos(s.q))
    return gather.verify(Case("pendulum", Path("."), paper, [known] * energies), thorough=False)


class Singular(unittest.TestCase):
    def test_the_mass_matrix_is_definite_everywhere_else(self):
        (d,) = [d for d in gather.verify(load(PENDULUM)).definiteness if d.boxes]
        self.assertEqual([v.status for v in d.boxes.values()], ["proved"])
        with tempfile.TemporaryDirectory() as outer:
            folder = Path(outer) / "paper"
            shutil.copytree(PENDULUM, folder)
            paper = (folder / "paper.tex").read_text(encoding="utf-8")
            self.assertIn(DECLARED, paper)
            (folder / "paper.tex").write_text(paper.replace(DECLARED, ""), encoding="utf-8")
            (d,) = [d for d in gather.verify(load(folder)).definiteness if d.boxes]
        self.assertEqual([v.status for v in d.boxes.values()], ["undecided"])

    def test_at_rest_in_a_singular_place_nothing_is_objected_to(self):
        self.assertEqual(report(spherical()).violations["definite"], [])
        self.assertEqual(len(report(spherical(singular=False)).violations["definite"]), 1)

    def test_what_is_not_definite_beside_it_is_found_and_certified(self):
        found = report(spherical(sign=-1))
        self.assertTrue([f for f in found.findings if f.key == "definite-1"])
        content = json.loads(certificate.as_certificate(found))
        checker = script.Checker(content)
        claims = [c for c in content["claims"] if c.get("finding") == "definite-1"]
        self.assertEqual([c["is"] for c in claims], ["equal", "equal", "greater"])
        self.assertEqual([c for c in content["claims"] if not checker.holds(c)], [])

    def test_the_report_says_what_is_singular_there(self):
        for divided, expected in (("", "the vertical, where sin q = 0: the determinant of the mass matrix is zero there."),
                                  ("sine", "the determinant of the mass matrix is zero there; (2) was divided by what is zero there.")):
            self.assertIn(expected, text.as_text(report(spherical(divided=divided), energies=True)))
        paper = spherical(singular=False)
        paper.singular_where("level")(lambda s, m: m.cos(s.q))
        self.assertIn("level, where cos q = 0: nothing that is judged is singular there.", text.as_text(report(paper)))

    def test_where_an_equation_says_something_else_than_its_multiple_is_said(self):
        for divided, singular, expected in (
                ("sine", True, "(2) is judged as multiplied by sin q; they say the same but in configurations that are declared singular."),
                ("sine", False, "(2) is judged as multiplied by sin q; where sin q is zero they do not say the same."),
                ("cosine", True, "(2) is judged as multiplied by cos q; where cos q is zero they do not say the same.")):
            self.assertIn(expected, text.as_text(report(spherical(divided=divided, singular=singular), energies=True)))
        paper = spherical(divided="cosine")
        paper.box["q"] = (0.1, 1.5)
        self.assertIn("(2) is judged as multiplied by cos q.", text.as_text(report(paper, energies=True)))

    def test_what_is_no_place_is_refused(self):
        for function in (lambda s, m: s.dq, lambda s, m: s.l, lambda s, m: 1 / s.q, lambda s, m: m.sqrt(s.q), lambda s, m: s.nothing):
            paper = spherical(singular=False)
            paper.singular_where("somewhere")(function)
            with self.assertRaisesRegex(VerifyError, "singular where somewhere"):
                report(paper)
        with self.assertRaisesRegex(PaperError, "declared twice"):
            paper.singular_where("somewhere")(lambda s, m: s.q)

    def test_in_a_manuscript_it_has_its_place(self):
        for written, message in (("% singular where \\sin\\theta\n", "is written as an expression = 0"), ("% singular where \\sin\\beta = 0\n", "'beta' is not declared"),
                                 ("% singular where\n", "is written as an expression = 0"), ("% singular where \\sin\\theta = 1\n", "is written as an expression = 0"),
                                 ("% singular where \\sin(\\theta = 0\n", "expected )")):
            with tempfile.TemporaryDirectory() as outer, self.subTest(written):
                folder = Path(outer) / "paper"
                shutil.copytree(PENDULUM, folder)
                paper = (folder / "paper.tex").read_text(encoding="utf-8")
                (folder / "paper.tex").write_text(paper.replace(DECLARED, written), encoding="utf-8")
                with self.assertRaises(VerifyError) as raised:
                    gather.verify(load(folder), thorough=False)
                self.assertIn(message, str(raised.exception))
                self.assertRegex(str(raised.exception), r"paper\.tex, line 4, column \d+")

    def test_it_is_shown(self):
        self.assertIn("Declared singular, and not judged: sin θ = 0: the determinant of the mass matrix is zero there.", text.as_text(report_of(PENDULUM)))


if __name__ == "__main__":
    unittest.main()
