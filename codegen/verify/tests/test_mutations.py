"""Whatever is in a folder: a verdict, or a message with what is wrong; no traceback, and no half of a page."""

import contextlib
import io
import shutil
import tempfile
import unittest
import warnings
from pathlib import Path

from codegen.verify import cli, seeded
from codegen.verify.tests.cases import ROOT
from codegen.verify.tests.mutations import mutated

FOLDERS = [ROOT / "templates/paper", *(ROOT / "codegen/verify/published" / name for name in ("cart_pole", "particle_on_cone", "compass_gait"))]
WRITTEN = [seeded.EXAMPLES / name for name in ("double_pendulum", "rocking_block", "tank")]
# some of thousands that were run; these take two seconds together
SEEDS = range(40)
# what ended in a traceback, or did not end
FOUND = {"a pole at rest": ("templates/paper", r"\frac{1}{2} m \left(", r"\frac{1}{\theta} m \left("),
         "a reciprocal of what is zero at rest": ("codegen/verify/published/cart_pole", r"\dot\theta^2", r"\dot\theta^{-9}"),
         "the integral of a reciprocal": ("codegen/verify/published/double_pendulum_momenta", r"\dot{\theta}_2+\dot{\theta}_1\cos",
                                          r"\frac{\ell}{\ell\dot{\theta}_2}+\dot{\theta}_1\cos"),
         "a power of many terms": ("codegen/verify/published/double_pendulum_momenta", r"\cos(\theta_1-\theta_2)\right\}", r"\cos(\theta_1-\theta_2)\right\}^{99}")}


class Mutations(unittest.TestCase):
    def judged(self, shipped, change, *options):
        """The exit status where `change(folder)` changes a copy of a shipped folder."""
        with tempfile.TemporaryDirectory() as outer:
            folder = Path(outer) / "paper"
            shutil.copytree(shipped, folder, ignore=shutil.ignore_patterns("__pycache__"))
            change(folder)
            out, err = io.StringIO(), io.StringIO()
            pages = [folder / "page.html", folder / "page.tex", folder / "claims.json"]
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
                # Python itself warns of what a hand has left of a file of its own
                warnings.simplefilter("ignore", SyntaxWarning)
                status = cli.main([str(folder), *options, "--html", str(pages[0]), "--latex", str(pages[1]), "--certificate", str(pages[2])])
            self.assertEqual([page.is_file() for page in pages], [status == 0] * 3)
            self.assertEqual(bool(out.getvalue()), status == 0)
            if status:
                self.assertRegex(err.getvalue(), r"^verify: .")
            return status

    def test_no_mutation_ends_without_a_verdict_or_a_message(self):
        statuses = set()
        for seed in SEEDS:
            def change(folder):
                file = folder / ("symbols.csv" if seed // len(FOLDERS) % 4 == 0 else "paper.tex")
                file.write_text(mutated(file.read_text(encoding="utf-8"), seed), encoding="utf-8")

            with self.subTest(seed=seed):
                statuses.add(self.judged(FOLDERS[seed % len(FOLDERS)], change, "--quick"))
        self.assertEqual(statuses, {0, 2})

    def test_nor_does_one_of_python(self):
        statuses = set()
        for seed in SEEDS:
            def change(folder):
                file = folder / ("paper.py" if seed % 2 else "paper_energies.py")
                file.write_text(mutated(file.read_text(encoding="utf-8"), seed), encoding="utf-8")

            with self.subTest(seed=seed):
                statuses.add(self.judged(WRITTEN[seed % len(WRITTEN)], change, "--quick"))
        self.assertEqual(statuses, {0, 2})

    def test_nor_does_what_once_did(self):
        for name, (shipped, old, new) in FOUND.items():
            def change(folder):
                file = folder / "paper.tex"
                text = file.read_text(encoding="utf-8")
                self.assertIn(old, text)
                file.write_text(text.replace(old, new, 1), encoding="utf-8")

            with self.subTest(name):
                self.judged(ROOT / shipped, change)


if __name__ == "__main__":
    unittest.main()
