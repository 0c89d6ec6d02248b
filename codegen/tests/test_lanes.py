"""What is emitted for trajectories side by side."""

from codegen.tests.scratch import BODY, HEAD, MODE, ScratchTest

TWO = HEAD + BODY.replace("(x, 0)", "(x, y)").replace("model.point", 'y = model.coordinate("y", "m", "height")\nmodel.point')
FLIES = 'moves = model.mode("moves", freeze=[(y, {held})])\n'


class Lanes(ScratchTest):
    def resets(self, text):
        """Of each transition of the first guard of the first mode, whether lanes can take it."""
        mode = self.described(text)["variants"][0]["modes"][0]
        return [transition["stays"] for transition in mode["guards"][0]["transitions"]]

    def test_a_reset_of_what_is_free_is_for_lanes(self):
        bounce = 'model.transition("bounce", moves, moves, when=falls(x), reset=[(x, 0), (x.rate, -x.rate)])\n'
        self.assertEqual(self.resets(HEAD + BODY + MODE + bounce), [True])
        for held in ("0", "0.5", "HELD"):
            with self.subTest(held=held):
                self.assertEqual(self.resets(TWO + FLIES.format(held=held) + bounce), [True])

    def test_a_reset_of_what_is_held_is_not(self):
        for reset in ("(y, x)", "(y, 2 * y)", "(y, x + y)"):
            with self.subTest(reset=reset):
                lift = f'model.transition("lift", moves, moves, when=falls(x), reset=[{reset}])\n'
                self.assertEqual(self.resets(TWO + FLIES.format(held="HELD") + lift), [False])

    def test_a_transition_to_another_mode_is_not(self):
        other = 'other = model.mode("other")\nmodel.transition("leave", moves, other, when=falls(x))\n'
        back = 'model.transition("bounce", moves, moves, when=falls(x), reset=[(x.rate, -x.rate)])\n'
        self.assertEqual(self.resets(HEAD + BODY + MODE + other + back), [False, True])

    def test_a_reset_by_a_signal_is_not(self):
        throw = ('v = model.input("v", "m/s", "velocity")\n' + BODY + MODE +
                 'model.transition("throw", moves, moves, when=falls(x), reset=[(x.rate, v)])\n')
        self.assertEqual(self.resets(HEAD + throw), [False])
