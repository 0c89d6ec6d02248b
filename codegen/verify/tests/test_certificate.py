"""A certificate holds by a script that knows nothing of the verification, and what is changed in it does not."""

import ast
import json
import unittest

from codegen.verify import check_certificate as script, seeded
from codegen.verify.input.load import load
from codegen.verify.report import certificate, gather


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
