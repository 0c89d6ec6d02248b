"""Whatever is in a folder: a verdict, or a message with what is wrong; no traceback, and no half of a page."""

import contextlib
import io
import shutil
import tempfile
import unittest
from pathlib import Path

from codegen.verify import cli
from codegen.verify.tests.cases import ROOT
from codegen.verify.tests.mutations import mutated

FOLDERS = [ROOT / "templates/paper", *(ROOT / "codegen/verify/published" / name for name in ("cart_pole", "particle_on_cone", "compass_gait"))]
# some of thousands that were run; these take a second together
SEEDS = range(40)


class Mutations(unittest.TestCase):
    def test_no_mutation_ends_without_a_verdict_or_a_message(self):
        statuses = set()
        for seed in SEEDS:
            with self.subTest(seed=seed), tempfile.TemporaryDirectory() as outer:
                folder = Path(outer) / "paper"
                shutil.copytree(FOLDERS[seed % len(FOLDERS)], folder)
                file = folder / ("symbols.csv" if seed // len(FOLDERS) % 4 == 0 else "paper.tex")
                file.write_text(mutated(file.read_text(encoding="utf-8"), seed), encoding="utf-8")
                out, err = io.StringIO(), io.StringIO()
                pages = [folder / "page.html", folder / "page.tex", folder / "claims.json"]
                with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                    status = cli.main([str(folder), "--quick", "--html", str(pages[0]), "--latex", str(pages[1]), "--certificate", str(pages[2])])
                statuses.add(status)
                self.assertEqual([page.is_file() for page in pages], [status == 0] * 3)
                self.assertEqual(bool(out.getvalue()), status == 0)
                if status:
                    self.assertRegex(err.getvalue(), r"^verify: .")
        self.assertEqual(statuses, {0, 2})


if __name__ == "__main__":
    unittest.main()
