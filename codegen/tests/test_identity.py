"""Expressions are told apart by their structure, to the last bit of every number."""

import json
import unittest

import casadi as ca

from codegen import units
from codegen.graph import structure
from codegen.tests.scratch import BODY, HEAD, MODE, ScratchTest

X, Y = ca.SX.sym("x"), ca.SX.sym("y")


class Structure(unittest.TestCase):
    def test_numbers_that_print_alike_are_told_apart(self):
        one, other = 1.00000001 - X, 1.00000004 - X
        self.assertEqual(str(one), str(other))
        self.assertNotEqual(structure(one), structure(other))
        self.assertNotEqual(structure(X + 1), structure(X + (1 + 2**-52)))

    def test_texts_have_all_digits(self):
        x = ca.SX.sym("x")
        self.assertEqual(units.short(1.00000001 * x + 0.1), "((1.00000001*x)+0.1)")
        self.assertEqual(units.short(1e-300 * x - 2), "((1e-300*x)-2)")
        self.assertEqual(units.short(x / 3), "(x/3)")

    def test_symbols_of_one_name_are_told_apart(self):
        self.assertNotEqual(structure(X + Y), structure(X + ca.SX.sym("y")))

    def test_the_same_built_twice_is_the_same(self):
        build = lambda: ca.sin(X * Y + 0.1) ** 2 / (X * Y + 0.1)
        shared = X * Y + 0.1
        self.assertEqual(structure(build()), structure(build()))
        self.assertEqual(structure(build()), structure(ca.sin(shared) ** 2 / shared))
        self.assertEqual(len({structure(build()), structure(build())}), 1)

    def test_deep_graphs_do_not_take_long(self):
        def deep():
            node = X
            for _ in range(200):
                node = ca.sin(node) * node + node
            return node
        self.assertEqual(structure(deep()), structure(deep()))
        self.assertNotEqual(structure(deep()), structure(deep() + 1e-9))


class Guards(ScratchTest):
    @staticmethod
    def guards(described):
        """Their number, over all modes."""
        return sum(len(mode["guards"]) for variant in described["variants"] for mode in variant["modes"])

    def test_guards_that_print_alike_are_two(self):
        text = "".join(f'model.transition("at_{k}", moves, moves, when=falls({place!r} * l - x), reset=[(x.rate, 0)])\n'
                       for k, place in enumerate((1.00000001, 1.00000004)))
        described = self.described(HEAD + 'l = model.parameter("l", "m", 1, "")\n' + BODY + MODE + text)
        self.assertEqual(self.guards(described), 2)

    def test_one_guard_of_two_transitions_is_one(self):
        text = "".join(f'model.transition("{name}", moves, moves, when=falls(1.5 * l - x), reset=[(x.rate, 0)])\n' for name in "ab")
        described = self.described(HEAD + 'l = model.parameter("l", "m", 1, "")\n' + BODY + MODE + text)
        self.assertEqual(self.guards(described), 1)

    def test_reactions_at_settings_that_print_alike_are_two(self):
        text = ('s = model.discrete("s", (1.00000001, 1.00000004), "")\n' + BODY + 'model.force(x, k * s * l)\n'
                'sticks = model.mode("sticks", freeze=[x])\nmoves = model.mode("moves")\n')
        text += "".join(f'model.transition("at_{k}", sticks, moves, when=falls(sticks.reaction(x, s={s!r})))\n'
                        for k, s in enumerate((1.00000001, 1.00000004)))
        files = self.generate(HEAD + 'l = model.parameter("l", "m", 1, "")\n' + text)
        self.assertEqual(self.guards(json.loads(files["description.json"])), 2)
        self.assertIn("made_up_sticks_guard1", files["made_up.c"])


if __name__ == "__main__":
    unittest.main()
