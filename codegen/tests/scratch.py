"""Model files made up for a test, in a folder of their own."""

import json
import os
import tempfile
import unittest

from codegen import generate
from codegen.errors import ModelError

HEAD = """\
from codegen.model import *
model = Model("Test", source="this test")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 1.0, "stiffness")
x = model.coordinate("x", "m", "place")
"""
"""Five lines that every made-up model starts with."""

BODY = "model.point_mass(m, position=(x, 0))\n"
MODE = 'moves = model.mode("moves")\n'


class ScratchTest(unittest.TestCase):
    """A test that writes model files."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.join(folder.name, "made_up")
        os.mkdir(self.folder)

    def generate(self, text):
        """Generates code for a model file of this text."""
        with open(os.path.join(self.folder, "model.py"), "w", encoding="utf-8") as stream:
            stream.write(text)
        return generate.generate(self.folder)

    def described(self, text):
        """The description of the same."""
        return json.loads(self.generate(text)["description.json"])

    def refusal(self, text, line):
        """The message with which a model file is refused, which must point at `line`."""
        with self.assertRaises(ModelError) as caught:
            self.generate(text)
        message = str(caught.exception)
        self.assertIn(f"model.py:{line}: ", message)
        return message
