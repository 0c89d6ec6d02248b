"""Equations of motion in quasi-velocities: a single-track vehicle in body axes, Euler's equations of a rigid body."""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import unicodedata
import unittest
from dataclasses import replace
from pathlib import Path

from codegen.verify import Energies, Paper, seeded
from codegen.verify.errors import PaperError
from codegen.verify.judgements.helmholtz import lagrangian
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import Case, load
from codegen.verify.report import certificate, gather as report, html, machine, text

VEHICLE = r"""\title{Single-track vehicle in the axes of its body}
\[ u = \dot x \cos\psi + \dot y \sin\psi \]
\[ v = -\dot x \sin\psi + \dot y \cos\psi \]
\[ r = \dot\psi \]
\[ T = \frac12 m (u^2 + v^2) + \frac12 I r^2 \]
\[ V = 0 \]
\[ Q_u = F_x \] \[ Q_v = F_f + F_r \] \[ Q_r = a F_f - b F_r \]
\begin{align}
m(\dot u - v r) &= F_x \\
m(\dot v + u r) &= F_f + F_r \\
I \dot r &= a F_f - b F_r
\end{align}
"""
SYMBOLS = r"""symbol, kind, unit, meaning, mirror, value
x, coordinate, m, position, ,
y, coordinate, m, position, -1,
\psi, coordinate, rad, heading, -1,
u, quasi-velocity, m/s, speed ahead, ,
v, quasi-velocity, m/s, speed to the side, -1,
r, quasi-velocity, rad/s, yaw rate, -1,
m, parameter, kg, mass, , 1500
I, parameter, kg*m^2, inertia, , 2500
a, parameter, m, front axle, , 1.1
b, parameter, m, rear axle, , 1.5
F_x, force, N, drive, ,
F_f, force, N, front tyre, -1,
F_r, force, N, rear tyre, -1,
"""


class Vehicle(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def loaded(self, *changes, symbols=SYMBOLS):
        written = VEHICLE
        for old, new in changes:
            self.assertIn(old, written)
            written = written.replace(old, new)
        (self.folder / "paper.tex").write_text(written, encoding="utf-8")
        (self.folder / "symbols.csv").write_text(symbols, encoding="utf-8")
        return load(self.folder, "vehicle")

    def judged(self, *changes):
        return report.verify(self.loaded(*changes), thorough=False)

    def test_right_equations_are_agreed_to(self):
        result = self.judged()
        self.assertEqual(result.findings, [])
        found = list(result.comparisons.values())[0].values()
        self.assertEqual([(len(c.agree), c.terms()) for c in found], [(3, 3), (4, 4), (3, 3)])
        shown = unicodedata.normalize("NFC", text.as_text(result))
        self.assertIn(unicodedata.normalize("NFC", "T = 1/2 I ψ̇² + 1/2 m ẋ² + 1/2 m ẏ²"), shown)
        for page in (shown, html.as_html(result), machine.as_json(result)):
            self.assertEqual(re.findall(r".{0,60}integral_of.{0,60}", page), [])

    def test_slips_are_found_and_undone(self):
        self.loaded()
        outcomes = seeded.run("vehicle", self.folder)
        errors = [o for o in outcomes if not o.equivalent]
        self.assertGreater(len(errors), 30)
        self.assertEqual([o.seed for o in errors if not (o.found and o.repaired)], [])
        self.assertEqual([o.seed for o in outcomes if o.equivalent and (o.found or o.repairs)], [])

    def test_without_energies_the_equations_of_the_coordinates_are_judged(self):
        skipped = [(r"\[ T =", "% skip\n\\[ T ="), (r"\[ V =", "% skip\n\\[ V ="),
                   (r"\[ Q_u = F_x \] \[ Q_v = F_f + F_r \] \[ Q_r = a F_f - b F_r \]", "")]
        symbols = SYMBOLS.replace("force", "friction")
        self.assertEqual(report.verify(self.loaded(*skipped, symbols=symbols)).findings, [])
        wrong = report.verify(self.loaded(*skipped, (r"\dot v + u r", r"\dot v - u r"), symbols=symbols))
        self.assertEqual([(f.kind, f.judgements) for f in wrong.findings], [("objection", ["lagrangian"])])
        self.assertIn(("2", (1,), "sign"), [(number, repair.ordinals, repair.slip) for number, repair in wrong.findings[0].possible])

    def test_a_certificate_derives_them_anew(self):
        path = self.folder / "claims.json"
        for changes, expected in (((), 3), ([(r"\dot v + u r", r"\dot v - u r")], 4)):
            path.write_text(certificate.as_certificate(self.judged(*changes)), encoding="utf-8")
            self.assertGreaterEqual(len(json.loads(path.read_text(encoding="utf-8"))["claims"]), expected)
            script = Path(certificate.__file__).parents[1] / "check_certificate.py"
            done = subprocess.run([sys.executable, str(script), str(path)], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_what_defines_none_is_refused(self):
        note = ("= F_f + F_r \\\\\n", "= F_f + F_r \\\\\n% motion of r\n")
        table = [
            ([(r"\[ r = \dot\psi \]", "")], "no equation of paper.tex defines the quasi-velocity r"),
            ([(r"r = \dot\psi", r"r = \dot\psi^2")], "quasi-velocity r is no linear function of the rates"),
            ([(r"r = \dot\psi", r"r = \dot x \cos\psi + \dot y \sin\psi")], "depend on one another"),
            ([(r"I \dot r", r"I \ddot r"), note], "line 12, column 3: the quasi-velocity r has 2 dots"),
        ]
        for changes, expected in table:
            with self.subTest(expected), self.assertRaisesRegex(PaperError, expected):
                self.judged(*changes)


class RigidBody(unittest.TestCase):
    """Euler's equations, from the kinetic energy in Euler's angles."""

    def paper(self, sign=-1):
        paper = Paper("Rigid body", "Euler 1765")
        for name in ("phi", "theta", "psi"):
            paper.coordinate(name, "rad", name)
        for name in "ABC":
            paper.parameter(name, "kg*m^2", "inertia")
        # nutation of zero is a pole of the angles
        paper.box["theta"] = (0.5, 2)
        paper.sets["one"] = {"A": 1, "B": 2, "C": 3}
        rates = {"p": lambda s, m: s.dphi * m.sin(s.theta) * m.sin(s.psi) + s.dtheta * m.cos(s.psi),
                 "q": lambda s, m: s.dphi * m.sin(s.theta) * m.cos(s.psi) - s.dtheta * m.sin(s.psi),
                 "r": lambda s, m: s.dphi * m.cos(s.theta) + s.dpsi}
        for name, function in rates.items():
            paper.quasi_velocity(name, "rad/s", "rate")(function)
        paper.motion("1", of="p")(lambda s, m: [s.A * s.dp, sign * s.B * s.q * s.r, s.C * s.q * s.r])
        paper.motion("2", of="q")(lambda s, m: [s.B * s.dq, -s.C * s.r * s.p, s.A * s.r * s.p])
        paper.motion("3", of="r")(lambda s, m: [s.C * s.dr, -s.A * s.p * s.q, s.B * s.p * s.q])
        return paper

    ENERGIES = Energies("rotation", "", lambda s, m: (s.A * s.p**2 + s.B * s.q**2 + s.C * s.r**2) / 2, lambda s, m: 0)

    def test_they_follow_from_the_energy_and_have_a_lagrangian(self):
        result = report.verify(Case("body", Path("."), self.paper(), [self.ENERGIES]), thorough=False)
        self.assertEqual(result.findings, [])
        self.assertIsNotNone(result.constructed[0].lagrangian)

    def test_a_sign_is_found(self):
        result = report.verify(Case("body", Path("."), self.paper(sign=1), [self.ENERGIES]), thorough=False)
        self.assertEqual([(f.equation, f.slip, f.proved) for f in result.findings], [("1", "sign", True)])
        self.assertIn("lagrangian", result.findings[0].judgements)

    def test_the_order_of_the_equations_is_free(self):
        paper = self.paper()
        turned = replace(paper, equations={number: paper.equations[number] for number in "312"})
        self.assertEqual(lagrangian(Subject(turned)), [])


if __name__ == "__main__":
    unittest.main()
