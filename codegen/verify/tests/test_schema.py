"""What --json prints is what docs/verification.schema.json says, and nothing else."""

import json
import unittest

from codegen.verify import seeded
from codegen.verify.report import machine
from codegen.verify.report.effects import Simulated, attach
from codegen.verify.tests.cases import ROOT, TANK, WITHOUT, report_of

TYPES = {"string": str, "integer": int, "number": (int, float), "boolean": bool, "null": type(None), "array": list, "object": dict}


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = json.loads((ROOT / "docs/verification.schema.json").read_text(encoding="utf-8"))

    def wrong(self, value, schema, at="report"):
        """What of a value is against a schema, of the words that this one has."""
        if "$ref" in schema:
            schema = self.schema["$defs"][schema["$ref"].rpartition("/")[2]]
        unknown = set(schema) - {"$schema", "$defs", "title", "description", "type", "const", "enum", "anyOf", "items", "properties", "required",
                                 "additionalProperties"}
        self.assertEqual(unknown, set())
        if "anyOf" in schema:
            branches = [self.wrong(value, branch, at) for branch in schema["anyOf"]]
            return [] if [] in branches else max(branches, key=len)
        if "const" in schema or "enum" in schema:
            allowed = schema.get("enum", [schema.get("const")])
            return [] if any(value is x or value == x and type(value) is type(x) for x in allowed) else [f"{at}: {value!r}"]
        kind = schema["type"]
        if not isinstance(value, TYPES[kind]) or isinstance(value, bool) and kind != "boolean":
            return [f"{at}: {value!r} is no {kind}"]
        found = []
        if kind == "array":
            for k, item in enumerate(value):
                found += self.wrong(item, schema["items"], f"{at}[{k}]")
        if kind == "object":
            known, others = schema.get("properties", {}), schema["additionalProperties"]
            found += [f"{at}: {name} is lacking" for name in schema.get("required", []) if name not in value]
            for name, item in value.items():
                if name in known or others:
                    found += self.wrong(item, known.get(name, others), f"{at}.{name}")
                else:
                    found.append(f"{at}: {name} is not declared")
        return found

    def test_reports_are_as_declared(self):
        for folder in (TANK, seeded.EXAMPLES / "rocking_block", ROOT / "codegen/verify/published/compass_gait"):
            for without in WITHOUT:
                self.assertEqual(self.wrong(json.loads(machine.as_json(report_of(folder, without))), self.schema), [])

    def test_a_report_with_effects_is_as_declared(self):
        report = report_of(TANK)
        runs = [{"peak": 0.01 * k, **({"stopped": "early"} if k == 2 else {})} for k in range(len(report.case.corrections) + 1)]
        report.simulated = Simulated({"scene": {"as printed": runs[1]}}, {"scene": runs}, {"scene": runs[0]})
        try:
            attach(report.findings, report.case.corrections, report.simulated)
            data = json.loads(machine.as_json(report))
        finally:
            report.simulated = None
            for finding in report.findings:
                finding.effects = {}
        self.assertEqual(self.wrong(data, self.schema), [])
        self.assertEqual(data["effects"]["show_nowhere"], [])
        self.assertEqual(sum(bool(f["effects"]) for f in data["findings"]), len(report.case.corrections))

    def test_what_is_lacking_added_or_of_another_type_is_seen(self):
        data = json.loads(machine.as_json(report_of(seeded.EXAMPLES / "rocking_block")))
        for change in ({"terms": "3"}, {"terms": True}, {"more": 1}, {"schema": 2}, {"judgements": {}}, {"date": None}):
            self.assertTrue(self.wrong({**data, **change}, self.schema), change)
        self.assertTrue(self.wrong({k: v for k, v in data.items() if k != "findings"}, self.schema))

    def test_the_version_is_that_of_the_reports(self):
        self.assertEqual(self.schema["properties"]["schema"]["const"], machine.SCHEMA)


if __name__ == "__main__":
    unittest.main()
