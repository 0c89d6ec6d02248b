"""The same model gives the same bytes, whatever the order of hashing."""

import os
import subprocess
import sys
import tempfile
import unittest

from codegen.tests.test_derivation import ROOT, folders


def generated(folder, seed):
    """Bytes of all files generated in a process with this hash seed."""
    with tempfile.TemporaryDirectory() as out:
        command = [sys.executable, "-B", "-m", "codegen", "generate", "--model-dir", folder, "--out", out]
        environment = {**os.environ, "PYTHONHASHSEED": str(seed)}
        subprocess.run(command, cwd=ROOT, env=environment, check=True)
        files = {}
        for path, _, names in os.walk(out):
            for name in names:
                with open(os.path.join(path, name), "rb") as stream:
                    files[name] = stream.read()
        return files


class Determinism(unittest.TestCase):
    def test_generated_code_does_not_depend_on_the_hash_seed(self):
        for folder in folders():
            with self.subTest(folder=os.path.basename(folder)):
                first, second = (generated(folder, seed) for seed in (0, 4711))
                self.assertEqual(sorted(first), sorted(second))
                name = os.path.basename(folder)
                self.assertLessEqual({f"{name}.c", f"{name}_model.c", "description.json", "manifest.json"}, set(first))
                for name, text in first.items():
                    self.assertEqual(text, second[name], name)


if __name__ == "__main__":
    unittest.main()
