"""Contacts: the modes and transitions that follow from them, and mistakes in their declaration."""

import os
import unittest

from codegen.generate import load
from codegen.tests.scratch import BODY, HEAD, ScratchTest
from codegen.tests.test_derivation import ROOT

TWO = HEAD + 'y = model.coordinate("y", "m", "height")\nmodel.point_mass(m, position=(x, y))\n'
"""Seven lines: a mass in the plane."""

MISTAKES = (
    ("a gap of two coordinates", 'model.contact("floor", gap=x + y)\n',
     "contact `floor`: its gap, `(x+y)`, is not ± one coordinate and what parameters add"),
    ("a gap that bends", 'model.contact("floor", gap=y**2)\n', "is not ± one coordinate"),
    ("a gap as a text", 'model.contact("floor", gap="y")\n', "contact `floor`: its gap: the text 'y' is not an expression"),
    ("a gap of another unit", 'model.contact("floor", gap=y + m)\n',
     "contact `floor`: its gap, where it is zero: `(-m)` has the dimension kg, expected m"),
    ("a slip of two rates", 'model.contact("floor", gap=y, slip=x.rate + y.rate, kinetic=0.2)\n',
     "its slip rate, `(x.rate+y.rate)`, is not ± the rate of one coordinate"),
    ("friction without a slip", 'model.contact("floor", gap=y, kinetic=0.2)\n', "it has friction but no `slip`"),
    ("a slip without friction", 'model.contact("floor", gap=y, slip=x)\n', "`slip` is given, but no coefficient `kinetic`"),
    ("two frictions along one coordinate",
     'model.friction("a", slip=x, normal=k, kinetic=0.2); model.friction("b", slip=x, normal=k, kinetic=0.2)\n',
     "friction `b`: `a` slips along `x` too"),
    ("two contacts of one name", 'model.contact("a", gap=y); model.contact("a", gap=x)\n',
     "contact `a`: there is a contact or a friction of this name above"),
    ("contacts beside a mode by hand", 'model.contact("a", gap=y)\nmodel.mode("flies")\n', "the model has contacts and modes by hand"),
)


def modes(model):
    return [mode.name for mode in model.modes]


def arrows(model):
    return {(t.name, t.source.name, t.target.name) for t in model.transitions}


class Contacts(ScratchTest):
    def test_mistakes_are_told_with_their_line(self):
        for what, text, message in MISTAKES:
            with self.subTest(what):
                line = 9 if "model.mode" in text else 8
                self.assertIn(message, self.refusal(TWO + text, line))

    def test_too_many_sets_of_states(self):
        lines = [HEAD, BODY]
        for k in range(5):
            lines.append(f'y{k} = model.coordinate("y{k}", "m", "")\nmodel.point_mass(m, position=(0, y{k}))\n')
        lines += [f'model.contact("c{k}", gap=y{k})\n' for k in range(5)]
        self.assertIn("32 sets of states, and each is a mode of its own; at most 16", self.refusal("".join(lines), 20))

    def test_friction_in_an_impact_on_two_contacts_is_not_made_up(self):
        text = HEAD + ('y = model.coordinate("y", "m", "")\nmodel.point_mass(m, position=(x, y))\nmodel.point_mass(m, position=(x, 0))\n'
                       'model.kinetic(m * x.rate * y.rate)\nmodel.contact("floor", gap=y)\nmodel.contact("wall", gap=x, slip=y, kinetic=0.1)\n')
        self.assertIn("what friction or several other contacts do then is not generated", self.refusal(text, 10))

    def test_modes_are_sets_of_states(self):
        hopper, = load(os.path.join(ROOT, "tests", "models", "contact_hopper"))
        self.assertEqual(modes(hopper), ["table open", "table sticks", "table slides"])
        self.assertLessEqual({
            ("table strikes", "table open", "table open"),
            ("table opens", "table sticks", "table open"),
            ("table opens", "table slides", "table open"),
            ("table slips", "table sticks", "table slides"),
            ("table sticks", "table slides", "table sticks"),
            ("table reverses", "table slides", "table slides"),
        }, arrows(hopper))

    def test_what_is_always_plastic_needs_no_rest(self):
        text = TWO + 'model.contact("floor", gap=y)\n'
        with open(os.path.join(self.folder, "model.py"), "w", encoding="utf-8") as stream:
            stream.write(text)
        model, = load(self.folder)
        self.assertIn(("floor strikes", "floor open", "floor closed"), arrows(model))

    def test_a_gap_bounds_its_coordinate(self):
        described = self.described(TWO + 'd = model.parameter("d", "m", 1, "")\nmodel.contact("roof", gap=d - y)\n')
        self.assertIn("d", str(described["variants"][0]))


if __name__ == "__main__":
    unittest.main()
