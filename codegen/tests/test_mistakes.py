"""Mistakes in a model file: each gets the line, what is wrong and what would be right."""

import unittest

from codegen.tests.scratch import BODY, HEAD, ScratchTest

SIDE = 's = model.discrete("s", (+1, -1), "side")\n'
MODES = 'moves = model.mode("moves")\nsticks = model.mode("sticks", freeze=[x])\n'
START = HEAD + SIDE + BODY + MODES
"""Nine lines: a mass on a line that moves or sticks."""

TO_STICKS = 'model.transition("stops", moves, sticks, when=falls(x), {})\n'
AGAIN = 'model.transition("again", moves, moves, when=falls(x), {})\n'

IN_THE_NEXT_LINE = (
    ("a mode as a string", 'model.transition("stops", "moves", sticks, when=falls(x))\n',
     "transition `stops`: its source is the text 'moves', not a mode: give the mode itself, what model.mode('moves', …) returned"),
    ("a target as a string", 'model.transition("stops", moves, "stick", when=falls(x))\n',
     "transition `stops`: its target is the text 'stick', not a mode: give what model.mode(…) returned"),
    ("a rest as a string", 'model.rest(moves, "sticks")\n', "rest: its target is the text 'sticks', not a mode"),
    ("a requirement of a string", 'model.requires("moves", k, "no")\n', "what a requirement is of is the text 'moves', not a mode"),
    ("a reset that is a dict", TO_STICKS.format("reset={}"),
     "transition `stops`: `reset` is {}: give a list of pairs, [(coordinate, rate or discrete state, value), …]"),
    ("a reset without a value", TO_STICKS.format("reset=[x]"), "give a list of pairs"),
    ("a reset of a text", TO_STICKS.format('reset=[("s", 1)]'), "not the text 's': give what model.coordinate(…)"),
    ("a reset of a parameter", TO_STICKS.format("reset=[(k, k)]"), "a reset can set a coordinate, its rate or a discrete state, not `k`"),
    ("a discrete reset outside its values", TO_STICKS.format("reset=[(s, 2)]"), "`s` is one of 1, -1, but `2` may set it to 2"),
    ("a discrete reset to what may be anything", TO_STICKS.format("reset=[(s, x / m * m / (2 * x))]"), "`s` is one of 1, -1, but"),
    ("a discrete reset that may be outside", TO_STICKS.format("reset=[(s, s + 1)]"), "may set it to 2"),
    ("a reset given twice", AGAIN.format("reset=[(x.rate, 0), (x.rate, -x.rate)]"), "transition `again`: the reset sets `x.rate` twice"),
    ("a reset of a frozen coordinate", TO_STICKS.format("reset=[(x.rate, x.rate / 2)]"),
     "the reset sets `x.rate` to `(x.rate/2)`, but mode `sticks` holds it at `0`: what a mode holds is set as it is entered; leave it out"),
    ("a constant guard", 'model.transition("stops", moves, sticks, when=falls(k))\n',
     "guard of `stops`: `k` never changes in mode `moves`, so it never falls through zero"),
    ("a guard on what is held", 'model.transition("goes", sticks, moves, when=falls(x.rate))\n', "`x.rate` never changes in mode `sticks`"),
    ("a guard that is an expression", 'model.transition("stops", moves, sticks, when=x)\n', "`when` must be falls(…) or rises(…)"),
    ("a guard that is a text", 'model.transition("stops", moves, sticks, when=falls("x"))\n', "its guard: the text 'x' is not an expression"),
    ("a rest of a string", 'model.rest("moves", sticks)\n', "rest: its source is the text 'moves', not a mode"),
    ("a rest declared twice", "model.rest(moves, sticks), model.rest(moves, sticks)\n", "rest of `moves` in `sticks` is declared twice"),
    ("a rest into a freer mode", "model.rest(sticks, moves)\n", "rest of `sticks` in `moves`: `moves` lets `x` move, which `sticks` holds"),
    ("a rest into the same mode", "model.rest(moves, moves)\n", "`moves` holds no more than `moves`"),
    ("a coordinate to freeze as a string", 'model.mode("third", freeze=["x"])\n',
     "mode `third`: what `freeze` names is the text 'x', not a coordinate: give the coordinate itself, what model.coordinate('x', …) returned"),
    ("an unknown coordinate to freeze", 'model.mode("third", freeze=[("y", 0)])\n', "the text 'y', not a coordinate: coordinates are `x`"),
    ("a dict to freeze", 'model.mode("third", freeze={x: 0})\n', "`freeze` is a list, [(coordinate, value), …], not a dict"),
    ("a rate to freeze", 'model.mode("third", freeze=[(x.rate, 0)])\n', "is `x.rate`, not a coordinate"),
    ("a coordinate frozen twice", 'model.mode("third", freeze=[x, (x, 0)])\n', "mode `third`: `x` is frozen twice"),
    ("a place that moves", 'model.mode("third", freeze=[(x, 2 * x)])\n', "where `x` is held: `x` is not a parameter"),
    ("a place of another unit", 'model.mode("third", freeze=[(x, m)])\n', "`m` has the dimension kg, expected m"),
    ("a drift of a string", 'model.mode("third", freeze=[x], drift=[("x", 1)])\n', "what `drift` names is the text 'x', not a coordinate"),
    ("a force on a string", 'model.force("x", k * x)\n', "what the force acts on is the text 'x', not a coordinate"),
    ("a force in a mode on a string", 'moves.force("x", k * x)\n', "what the force acts on is the text 'x', not a coordinate"),
    ("a reaction of a string", 'model.requires(sticks, sticks.reaction("x"), "no")\n', "what a reaction is asked of is the text 'x'"),
    ("a reaction of another mode", 'model.transition("stops", moves, sticks, when=falls(sticks.reaction(x)))\n',
     "the reaction `R(x)@sticks` of mode `sticks` is used in mode `moves`, where it is not defined"),
    ("the momentum of a string", 'model.impact_velocities(before=[], after=[], prescribed=[], conserve=["x"])\n',
     "whose momentum is conserved is the text 'x', not a coordinate"),
    ("a meaning that is no text", 'model.parameter("z", "m", 1, 7)\n', "parameter `z`: its meaning is a text, not 7"),
    ("a meaning with half of a pair", 'model.coordinate("z", "m", "\\ud83d")\n', "coordinate `z`: its meaning holds U+D83D: write one line"),
    ("a message with a bell", 'model.limit("far", "\\x07", when=x > 1 * x)\n', "limit `far`: its message holds U+0007"),
    ("a sentence for private use", 'model.valid(x > -x, "\\ue000")\n', "valid: its sentence holds U+E000"),
    ("a mode with a line break", 'model.mode("third", "a\\nb")\n', "mode `third`: its meaning holds U+000A"),
    ("a limit that falls", 'model.limit("far", "far", when=falls(x))\n', "is no comparison"),
    ("an expression that is a text", 'model.potential("k x^2")\n', "potential energy: the text 'k x^2' is not an expression"),
    ("a position that is no pair", "model.point_mass(m, position=x)\n", "body 2: its position is `x`, not a pair (X, Y)"),
    ("a function of Python", "import math; model.potential(k * x**2 * math.sin(x))\n", "it holds the number nan"),
    ("an energy of accelerations", "model.potential(m * x * x.acceleration)\n", "depends on an acceleration"),
    ("a symbol made elsewhere", 'model.potential(k * ca.SX.sym("x")**2)\n', "symbol `x` was not declared by this model"),
    ("a negative mass", "model.point_mass(-m, position=(x, 0))\n", "body 2: its mass `(-m)` is -1 with the default parameters"),
    ("two models", 'model = Model("Again", source="this test")\n', "a model file makes one Model(…), and has made one above"),
    ("an if", "model.potential(k * x**2 if x.rate > 0 else 0)\n", "write one mode or one guard for each case instead"),
    ("an and", TO_STICKS.format("provided=x > 0 and x.rate > 0"), "write one mode or one guard for each case instead"),
    ("a largest", "model.potential(k * max(x, 0)**2)\n", "write one mode or one guard for each case instead"),
    ("a limit as a string", 'model.parameter("l", "kg", 1, "", at_most="m")\n',
     "`at_most` is the text 'm', not a parameter: give the parameter itself, what model.parameter('m', …) returned"),
    ("a limit that is a number", 'model.parameter("l", "kg", 1, "", at_most=3)\n', "a limit that is a number is `maximum`"),
    ("a limit of another unit", 'model.parameter("l", "m", 1, "", at_most=m)\n', "`at_most` is `m`, which has another unit"),
    ("a default beyond its limits", 'model.parameter("l", "m", -1, "", above=0)\n', "its default -1 is not within its own limits"),
    ("a coordinate named as the time", 'model.coordinate("t", "m", "")\n', "a coordinate cannot be named `t`, which is the time"),
    ("a parameter named as a word of Rust", 'model.parameter("loop", "m", 1, "")\n', "cannot be named `loop`, a word of Rust"),
    ("a mode named as a word of C", 'model.mode("double")\n', "a mode cannot be named `double`, a word of C"),
    ("a mode with a space", 'model.mode("at rest", freeze=[x])\n', "`at rest` is not a name for a mode: names are of letters"),
    ("a transition with a space", AGAIN.replace('"again"', '"once again"').format(""), "`once again` is not a name for a transition"),
    ("a choice named as a key of scenes", 'model.choice("end", ("a", "b"), "")\n', "a choice cannot be named `end`, which is a key of scenes"),
    ("a unit that is no text", 'model.parameter("l", 1, 1, "")\n', "`l`: its unit is a text"),
    ("a ground along another axis", 'model.ground("z", "", input="a", axis="z")\n', "there is no axis 'z'"),
)
"""What is wrong, a tenth line after `START`, and what is said of it."""


class Mistakes(ScratchTest):
    def test_each_is_answered_with_its_line(self):
        for what, line, answer in IN_THE_NEXT_LINE:
            with self.subTest(what=what):
                self.assertIn(answer, self.refusal(START + line, 10))

    def test_a_coordinate_without_mass(self):
        text = HEAD + 'y = model.coordinate("y", "m", "")\n' + BODY + 'moves = model.mode("moves")\n'
        self.assertIn("mode `moves`: no mass moves with coordinate `y`", self.refusal(text, 8))

    def test_coordinates_that_move_the_same_mass(self):
        text = HEAD + 'y = model.coordinate("y", "m", "")\nmodel.point_mass(m, position=(x + y, 0))\n' + 'model.mode("moves")\n'
        self.assertIn("the mass matrix of its free coordinates (x, y) is singular", self.refusal(text, 8))

    def test_many_coordinates_that_hang_together_are_not_taken_for_singular(self):
        """Of 30 masses one on the other the determinant is 2e-52 of the product of the rows, and there are 30! products in it."""
        lines = [HEAD, "place = 0\n"]
        for k in range(30):
            lines.append(f'place = place + model.coordinate("y_{k}", "m", "")\nmodel.point_mass(m, position=(place, 0))\n')
        lines.append('model.point_mass(m, position=(x, 0))\nmodel.mode("moves")\n')
        self.described("".join(lines))

    def test_an_energy_that_is_all_there_is(self):
        text = HEAD + "model.kinetic(k * x**2 / 2)\n" + 'model.mode("moves")\n'
        self.assertIn("no mass moves with coordinate `x`", self.refusal(text, 7))

    def test_no_mode_at_all(self):
        [variant] = self.described(HEAD + BODY)["variants"]
        self.assertEqual([mode["name"] for mode in variant["modes"]], ["moves"])

    def test_no_momentum_to_conserve_is_no_mistake(self):
        self.generate(START + 'model.transition("hits", moves, moves, when=falls(x), impact=True, reset=model.impact_velocities('
                      "before=[], after=[], prescribed=[(x, -x.rate)], conserve=[]))\n")

    def test_a_side_turned_by_a_comparison_is_no_mistake(self):
        self.generate(START + AGAIN.format("reset=[(s, s * (1 - 2 * (x.rate < 0)))]"))

    def test_a_coordinate_is_held_at_a_parameter(self):
        described = self.described(HEAD + 'l = model.parameter("l", "m", 1, "")\n' + BODY
                                   + 'model.mode("held", freeze=[(x, 2 * l)])\nmodel.mode("at_zero", freeze=[(x, 0)])\n')
        modes = described["variants"][0]["modes"]
        self.assertEqual([mode["held_at"] for mode in modes], [[{"expression": "(2.*l)"}], [{"number": 0.0}]])

    def test_there_may_be_many_conditions_and_requirements(self):
        conditions = "provided=[x.rate + n * x.rate for n in range(20)]"
        described = self.described(START + AGAIN.format(conditions)
                                   + 'for n in range(30): model.requires(moves, m + n * m + 0 * x, "no")\n')
        modes = described["variants"][0]["modes"]
        conditions = [t["condition"] for mode in modes for guard in mode["guards"] for t in guard["transitions"]]
        self.assertIn(20, [condition["count"] for condition in conditions if condition])
        self.assertEqual(sum(len(mode["requirements"]) for mode in modes), 30)


if __name__ == "__main__":
    unittest.main()
