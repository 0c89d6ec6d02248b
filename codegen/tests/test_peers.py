"""What the programs of the peers read of a generated model: the tables of its modes as C++ (`benches/peers/tank.py`)."""

import importlib.util
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

from codegen.tests.test_derivation import ROOT

MODEL = "rocking_block"


def tank():
    path = os.path.join(ROOT, "benches", "peers", "tank.py")
    spec = importlib.util.spec_from_file_location("tank", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class TablesOfPeers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tank = tank()
        with tempfile.TemporaryDirectory() as out:
            command = [sys.executable, "-B", "-m", "codegen", "generate", "--model-dir", os.path.join("models", MODEL), "--out", out]
            subprocess.run(command, cwd=ROOT, check=True)

            def read(name):
                with open(os.path.join(out, MODEL, name), encoding="utf-8") as stream:
                    return stream.read()

            manifest = json.loads(read("manifest.json"))
            cls.description = json.loads(read("description.json"))
            cls.names = cls.tank.functions_of(read(manifest["tables"]))
            cls.sources = "".join(read(name) for name in manifest["sources"])

    def test_the_functions_of_the_table_are_those_of_the_sources(self):
        self.assertGreater(len(self.names), 10)
        for name in self.names:
            if name != "NULL":
                self.assertRegex(self.sources, rf"\b{name}\s*\(", name)

    def test_the_tables_say_what_the_description_says(self):
        table = self.tank.tables(self.description, self.names)
        variant = self.description["variants"][0]
        rows = table[table.index("MODES[] = {"):].split("\n  {{")[0]
        self.assertEqual(len(re.findall(r"^  \{\d+, ", rows, re.M)), len(variant["modes"]))
        for mode in variant["modes"]:
            self.assertIn(mode["name"].upper(), table)
            system = self.names[mode["kernel"]["system"]]
            self.assertRegex(table, rf"\{{{len(mode['free'])}, \{{{', '.join(map(str, mode['free']))}\}}, {system}, ")
            for guard in mode["guards"]:
                self.assertIn(self.names[guard["guard"]], table)
        declared = set(re.findall(r"\bFunction (\w+);", table))
        self.assertEqual(declared, set(re.findall(r"\bdalembert_\w+", table)))

    def test_another_first_variant_is_refused(self):
        variant = {**self.description["variants"][0], "defaults": [False]}
        with self.assertRaisesRegex(ValueError, "not that of the defaults"):
            self.tank.tables({**self.description, "variants": [variant]}, self.names)


if __name__ == "__main__":
    unittest.main()
