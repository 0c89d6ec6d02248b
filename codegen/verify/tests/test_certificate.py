"""A certificate holds by a script that knows nothing of the verification, and what is changed in it does not."""

import ast
import json
import shutil
import tempfile
import unittest
from pathlib import Path

from codegen.verify import Paper, check_certificate as script, seeded
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
