"""A certificate holds by a script that knows nothing of the verification, and what is changed in it does not."""

import ast
import json
import shutil
import tempfile
import unittest
from pathlib import Path

from codegen.verify import Number, Paper, check_certificate as script, seeded
from codegen.verify.load import Case, load
from codegen.verify.report import certificate, gather
from codegen.verify.tests.cases import ROOT, TANK, report_of
from codegen.verify.tests.mutations import mutated


def certified(name):
    return json.loads(certificate.as_certificate(gather.verify(load(seeded.EXAMPLES / name), thorough=False)))


class Certificate(unittest.TestCase):
    def test_the_script_has_fifty_lines_and_imports_sympy_alone(self):
        with open(script.__file__, encoding="utf-8") as stream:
            text = stream.read()
        self.assertLessEqual(sum(bool(line.strip()) for line in text.split("\n")), 50)
        imported = {a.name for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Import) for a in node.names}
        imported |= {node.module.partition(".")[0] for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ImportFrom)}
        self.assertEqual(imported, {"ast", "json", "sys", "functools", "itertools", "sympy"})

    def test_every_finding_has_claims_that_hold(self):
        """With energies, and without, where all that is known of a finding is what it objects to."""
        for without in ("nothing", "energies"):
            report = report_of(TANK, without)
            content = json.loads(certificate.as_certificate(report))
            self.assertEqual(content["without"], {})
            self.assertEqual({c["finding"] for c in content["claims"] if "finding" in c}, {f.key for f in report.findings})
            checker = script.Checker(content)
            self.assertEqual([c for c in content["claims"] if not checker.holds(c)], [])

    def test_a_mass_matrix_that_is_not_definite_is_certified(self):
        paper = Paper("two masses", "none", sets={"one": {"m": "1.5"}})
        paper.coordinate("x", "m", "first")
        paper.coordinate("y", "m", "second")
        paper.parameter("m", "kg", "mass")
        paper.motion("1", of="x")(lambda s, m: [s.m * s.ddx, 2 * s.m * s.ddy])
        paper.motion("2", of="y")(lambda s, m: [2 * s.m * s.ddx, s.m * s.ddy])
        report = gather.verify(Case("two", Path("."), paper), thorough=False)
        self.assertEqual([f.key for f in report.findings], ["definite-1"])
        content = json.loads(certificate.as_certificate(report))
        checker, claims = script.Checker(content), [c for c in content["claims"] if "finding" in c]
        self.assertEqual([(c["is"], c.get("at")) for c in claims], [("equal", None), ("greater", {"m": "1.5"})])
        self.assertTrue(all(map(checker.holds, claims)))
        self.assertFalse(checker.holds({**claims[1], "of": claims[1]["of"][::-1]}))

    def certified_alone(self, paper, **case):
        """The claims on the findings of a paper without energies, all of which hold; and what checks them."""
        report = gather.verify(Case("alone", Path("."), paper, **case), thorough=False)
        content = json.loads(certificate.as_certificate(report))
        checker, claims = script.Checker(content), [c for c in content["claims"] if "finding" in c]
        self.assertEqual(content["without"], {})
        self.assertEqual({c["finding"] for c in claims}, {f.key for f in report.findings})
        self.assertEqual([c for c in claims if not checker.holds(c)], [])
        return claims, checker

    def test_signs_and_moduli_of_what_moves_are_certified(self):
        paper = Paper("a block", "none")
        paper.coordinate("x", "m", "slip", mirror=-1)
        paper.input("z", "m", "ground")
        for name, unit in (("m", "kg"), ("N", "N"), ("c", "kg/m")):
            paper.parameter(name, unit, name)
        paper.force("F", "N", "force", dissipative=False)
        paper.force("R", "N", "base shear")
        paper.motion("1", of="x")(lambda s, m: [s.m * s.ddx, s.N * m.sign(s.dx), s.c * m.Abs(s.dx) * s.dx, -s.F])
        paper.value("2", of="R", momentum=True)(lambda s, m: [s.m * s.ddx, s.m * m.sign(s.dx) * s.ddz])
        claims, checker = self.certified_alone(paper)
        factors = [c["of"][0] for c in claims if c["is"] == "different" and c["of"][0].startswith("diff(")]
        self.assertTrue(any(of.endswith(", F)") for of in factors), factors)
        self.assertEqual(len([of for of in factors if of.endswith(", sign__1)")]), 3)
        for claim in claims:
            if claim["is"] == "equal":
                self.assertFalse(checker.holds({**claim, "of": [claim["of"][0] + " + m", claim["of"][1]]}), claim)

    def test_terms_without_a_dimension_are_certified(self):
        paper = Paper("a pendulum", "none")
        paper.coordinate("x", "m", "place")
        paper.parameter("m", "kg", "mass")
        paper.parameter("k", "N/m", "stiffness")
        paper.motion("1", of="x")(lambda s, m: [s.m * s.ddx, s.k * s.x * m.sin(s.x), s.k * (s.x + s.dx) * s.x])
        claims, checker = self.certified_alone(paper)
        self.assertEqual([c["of"][0].count("scaled") for c in claims if c["finding"].startswith("dim")], [1, 1])

    def test_numbers_that_disagree_are_certified(self):
        paper = Paper("a tank", "none")
        paper.coordinate("x", "m", "slip")
        paper.parameter("m", "kg", "mass")
        paper.motion("1", of="x")(lambda s, m: [s.m * s.ddx])
        numbers = [
            Number("R", "0.2", "m", "radius"),
            Number("H/2", "0.4", "m", "height", exact=True),
            Number("half", None, "m", "half of the radius", lambda n, m: n.R / 2),
            Number("M", "155.3", "kg", "water", lambda n, m: 1000 * m.pi * n.R**2 * 0.4 + 20),
            Number("D", "0.49", "m", "diagonal", lambda n, m: m.sqrt(n.R**2 + 0.16)),
            Number("beta", "1.4", "rad", "angle", lambda n, m: m.asin(n.half / n.D)),
            Number("alpha", "0.465", "rad", "angle", lambda n, m: m.atan(n.R / 0.4)),
            Number("t", "0.3", "1", "sine", lambda n, m: m.tan(n.alpha) * m.cos(n.alpha))]
        claims, checker = self.certified_alone(paper, numbers=numbers)
        self.assertEqual([c["finding"] for c in claims], ["number-M", "number-D", "number-beta", "number-t"])
        for claim in claims:
            self.assertFalse(checker.holds({**claim, "of": claim["of"][::-1]}))

    def test_what_repairs_leave_is_certified(self):
        """Objections are to the repaired equations, whose terms are others: here a line of one is printed twice."""
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(ROOT / "codegen/verify/published/double_pendulum_momenta", Path(folder) / "wrong")
            paper = Path(folder) / "wrong" / "paper.tex"
            paper.write_text(mutated(paper.read_text(encoding="utf-8"), 5), encoding="utf-8")
            content = json.loads(certificate.as_certificate(gather.verify(load(Path(folder) / "wrong"), thorough=False)))
        checker = script.Checker(content)
        self.assertTrue([c for c in content["claims"] if c.get("finding") == "dimensions-2"])
        self.assertEqual([c for c in content["claims"] if not checker.holds(c)], [])

    def test_without_energies_the_conditions_that_hold_are_claims(self):
        content = json.loads(certificate.as_certificate(report_of(ROOT / "codegen/verify/published/compass_gait")))
        checker = script.Checker(content)
        self.assertEqual([c["judgement"] for c in content["claims"]], ["lagrangian"] * 9)
        self.assertTrue(all(map(checker.holds, content["claims"])))

    def test_claims_hold_and_changed_ones_do_not(self):
        content = certified("double_pendulum")
        checker = script.Checker(content)
        self.assertTrue(content["claims"])
        changed = 0
        for claim in content["claims"]:
            self.assertTrue(checker.holds(claim), claim)
            if claim["is"] == "equal":
                self.assertFalse(checker.holds({**claim, "of": [claim["of"][0] + " + l_1", claim["of"][1]]}), claim)
                changed += 1
        self.assertGreater(changed, 0)


if __name__ == "__main__":
    unittest.main()
