"""The model in docs/models.md is a model, and has the reactions that the page says."""

import pathlib
import re
import tempfile
import unittest

import casadi as ca

from codegen import derive, generate

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "models.md"


class Documentation(unittest.TestCase):

    def test_the_complete_model_generates_and_holds_the_block(self):
        model = self.built(self.blocks()[0])
        self.assertEqual([mode.name for mode in model.modes], ["slope open", "slope sticks", "slope slides"])
        self.assert_holds_the_block(model, model.modes[1])

    def test_the_same_by_hand(self):
        contacts, hand = self.blocks()[:2]
        declared = contacts[:contacts.index("model.contact(")].replace(
            "force = model.input", 'slip = model.discrete("slip", (-1, +1), "direction of slip")\nforce = model.input')
        model = self.built(declared + hand)
        self.assert_holds_the_block(model, model.modes[0])

    def test_modes_beside_contacts(self):
        contacts, beside = self.blocks()[0], next(block for block in self.blocks() if "drives.force" in block)
        declared = contacts[:contacts.index("m = model.parameter(")] + "\n".join([
            *[f'{name} = model.parameter("{name}", "{unit}", 1.0, "a number")' for name, unit in (
                ("m", "kg"), ("mu", "1"), ("pull", "N"), ("slow", "m/s"), ("fast", "m/s"), ("kick", "m/s"))],
            *[f'{name} = model.coordinate("{name}", "m", "a place")' for name in "xy"],
            "model.point_mass(m, position=(x, y))", ""])
        model = self.built(declared + beside)
        self.assertEqual([mode.name for mode in model.modes], ["coasts", "drives"])

    @staticmethod
    def blocks():
        return re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)

    def built(self, source):
        with tempfile.TemporaryDirectory() as folder:
            model_folder = pathlib.Path(folder) / "slope_block"
            model_folder.mkdir()
            (model_folder / "model.py").write_text(source, encoding="utf-8")
            self.assertIn("slope_block.c", generate.generate(str(model_folder)))
            model, = generate.load(str(model_folder))
        return model

    def assert_holds_the_block(self, model, mode):
        held = ca.SX.sym("held", len(model.coordinates))
        sticks = derive.ModeEquations(model, mode, derive.residual_from_bodies(model), held)
        values = {p.name: p.extra["default"] for p in model.parameters}
        values["force"] = 0.7
        reactions = ca.vertcat(*[reaction for _, reaction in sticks.reactions])
        symbols = ca.symvar(reactions)
        found = ca.Function("reactions", symbols, [reactions])(*[values.get(s.name(), 0.0) for s in symbols])
        m, g, beta = values["m"], values["g"], values["beta"]
        self.assertAlmostEqual(float(found[0]), m * g * float(ca.sin(beta)) - 0.7, places=12)
        self.assertAlmostEqual(float(found[1]), m * g * float(ca.cos(beta)), places=12)


if __name__ == "__main__":
    unittest.main()
