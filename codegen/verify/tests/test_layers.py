"""How the package holds together, by its imports: no circles of modules, and folders in layers."""

import ast
import subprocess
import sys
import unittest
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
# the folders and files from the ground up: each imports of those before it, and of itself, alone
LAYERS = ("errors", "progress", "input", "normal", "judgements", "repairs", "readings", "construct", "report", "load", "seeded", "cli")
# a script that nothing of the package is needed for
ALONE = {"check_certificate"}


def modules(walk=ast.walk):
    """{module: the modules of the package that it imports}; names without the package's. An import inside a function counts, but where
    `walk` gives the statements of a module alone."""
    found = {}
    for file in sorted(PACKAGE.rglob("*.py")):
        parts = file.relative_to(PACKAGE).with_suffix("").parts
        if parts[0] in ("tests", "examples", "published"):
            continue
        tree, at = ast.parse(file.read_text(encoding="utf-8")), parts[:-1]
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        imported = set()
        for node in walk(tree):
            if isinstance(node, ast.ImportFrom) and 0 < node.level <= len(at) + 1:
                base = [*at[:len(at) - node.level + 1], *(node.module.split(".") if node.module else [])]
                imported.add(".".join(base))
                imported |= {".".join([*base, alias.name]) for alias in node.names}
        found[name] = imported
    return {name: {x for x in imported if x in found and x != name} for name, imported in found.items()}


class Layers(unittest.TestCase):
    def test_what_files_of_a_model_folder_need_is_imported_without_sympy(self):
        names = "Correction, Effects, Number, Paper, apply, group, without"
        code = f"import sys\nfrom codegen.verify import {names}\nsys.exit('sympy' in sys.modules)"
        done = subprocess.run([sys.executable, "-B", "-c", code], cwd=PACKAGE.parents[1], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_no_modules_import_one_another_in_a_circle(self):
        left = {name: {x for x in imported if x} for name, imported in modules(lambda tree: tree.body).items() if name}
        while left:
            # a folder is imported before its modules, which is no dependence of theirs
            free = [name for name, imported in left.items() if not any(x in left and not name.startswith(x + ".") for x in imported)]
            self.assertTrue(free, f"a circle among {', '.join(left)}")
            for name in free:
                del left[name]

    def test_folders_import_what_stands_before_them_alone(self):
        for name, imported in modules().items():
            layer = name.partition(".")[0]
            if not name or layer in ALONE:  # the package itself offers names of its folders
                continue
            self.assertIn(layer, LAYERS)
            above = LAYERS[LAYERS.index(layer) + 1:]
            self.assertEqual([x for x in imported if x.partition(".")[0] in above], [], name)

    def test_errors_know_nothing_and_are_of_one_kind(self):
        self.assertEqual(modules()["errors"], set())
        tree = ast.parse((PACKAGE / "errors.py").read_text(encoding="utf-8"))
        bases = {node.name: [base.id for base in node.bases] for node in tree.body if isinstance(node, ast.ClassDef)}
        self.assertEqual({name: found for name, found in bases.items() if name not in ("Place", "VerifyError")},
                         {name: ["VerifyError"] for name in bases if name not in ("Place", "VerifyError")})
        # and no module declares others
        for file in PACKAGE.rglob("*.py"):
            if "tests" not in file.parts and file.name != "errors.py":
                for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                    if isinstance(node, ast.ClassDef):
                        self.assertFalse({base.id for base in node.bases if isinstance(base, ast.Name)} & {"Exception", "ValueError"}, file)


if __name__ == "__main__":
    unittest.main()
