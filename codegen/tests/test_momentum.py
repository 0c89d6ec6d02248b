"""Energies see the motion of the ground, or the model is refused with the term that does not."""

import os
import shutil
import unittest

from codegen.tests.scratch import ScratchTest
from codegen.tests.test_derivation import ROOT

HEAD = """\
from codegen.model import *
model = Model("Test", source="this test")
m = model.parameter("m", "kg", 1.0, "mass", above=0)
k = model.parameter("k", "N/m", 0.0, "stiffness")
l = model.parameter("l", "m", 1.0, "length", above=0)
extra = model.parameter("extra", "kg", 0.0, "what is nothing by default")
g = model.parameter("g", "m/s^2", 9.81, "gravity")
theta = model.coordinate("theta", "rad", "angle")
x = model.coordinate("x", "m", "to the right")
y = model.coordinate("y", "m", "upwards")
z_h = model.ground("z_h", "to the right", input="a_h")
z_v = model.ground("z_v", "upwards", input="a_v", axis="y")
model.gravity(g)
model.rigid_body(m, m * l**2 / 3, position=(x + l * sin(theta), y + l * cos(theta)), angle=theta)
"""
"""Fourteen lines."""

MODE = 'moves = model.mode("moves")\n'
HELD = 'held = model.mode("held", freeze=[theta, x, y])\n'


class Momentum(ScratchTest):
    def test_energies_in_absolute_velocities_are_accepted(self):
        for lines in (
            "",
            "model.kinetic(extra * (x.rate + z_h.rate)**2 / 2)\n",
            "model.kinetic(extra * (x.rate**2 + 2 * x.rate * z_h.rate + z_h.rate**2) / 2)\n",
            "model.kinetic(extra * l * cos(theta) * theta.rate * (x.rate + z_h.rate))\n",
            "model.kinetic(m * l**2 * theta.rate**2 / 2)\n",
            "model.kinetic(extra * (y.rate + z_v.rate)**2 / 2)\nmodel.potential(extra * g * (y + z_v))\n",
            "model.kinetic(extra * x.rate**2 / 2, relative=True)\n",
            "model.potential(k * x**2 / 2)\n",
            "model.kinetic(0.1 * extra * (0.3 * x.rate + 0.3 * z_h.rate)**2)\n",
        ):
            with self.subTest(lines=lines):
                self.generate(HEAD + lines + MODE + HELD)

    def test_an_energy_that_does_not_see_the_ground(self):
        message = self.refusal(HEAD + "model.kinetic(extra * x.rate**2 / 2 + m * l**2 * theta.rate**2 / 2)\n" + MODE, 15)
        self.assertIn("kinetic energy: `((extra*sq(x.rate))/2)` has another momentum where `x` moves the bodies", message)
        self.assertIn("`y.rate + z_h.rate`", message)

    def test_one_that_sees_it_half(self):
        message = self.refusal(HEAD + "model.kinetic(m * (x.rate + z_h.rate)**2 / 2 + extra * theta.rate * l * x.rate)\n" + MODE, 15)
        self.assertIn("theta.rate", message)

    def test_one_of_a_coordinate_that_moves_no_body(self):
        text = HEAD.replace("z_h = ", 'u = model.coordinate("u", "m", "of an oscillation")\nz_h = ')
        self.assertIn("may have momentum, but does not see the ground motion `z_h`",
                      self.refusal(text + "model.kinetic(m * u.rate**2 / 2)\n" + MODE, 16))
        self.generate(text + "model.kinetic(m * u.rate**2 / 2, relative=True)\n" + MODE)

    def test_one_that_is_said_not_to_see_it_but_does(self):
        self.assertIn("said to be relative", self.refusal(HEAD + "model.kinetic(m * (x.rate + z_h.rate)**2, relative=True)\n" + MODE, 15))

    def test_a_mass_that_changes_with_the_motion(self):
        """Then a steady motion of the ground makes a force."""
        message = self.refusal(HEAD + "model.kinetic(extra * cos(theta) * (x.rate + z_h.rate)**2 / 2)\n" + MODE, 15)
        self.assertIn("makes forces depend on where the ground is or how fast it moves (`z_h`)", message)

    def test_damping_of_the_absolute_motion(self):
        for line in ("model.dissipation(extra * (x.rate + z_h.rate)**2)\n", "model.potential(k * (x + z_h)**2 / 2)\n",
                     "model.force(x, k * z_h)\n"):
            with self.subTest(line=line):
                message = self.refusal(HEAD.replace('"kg", 0.0', '"kg/s", 0.0') + line + MODE, 15)
                self.assertIn("makes forces depend on where the ground is", message)

    def test_a_force_of_a_mode_that_knows_the_ground(self):
        self.assertIn("in mode `moves`: `(k*z_h)`", self.refusal(HEAD + MODE + "moves.force(x, k * z_h)\n", 16))

    def test_a_weight_that_the_ground_does_not_carry(self):
        line = "model.kinetic(extra * (y.rate + z_v.rate)**2 / 2)\nmodel.potential(extra * g * y)\n"
        message = self.refusal(HEAD + line + MODE, 16)
        self.assertIn("potential energy: `((extra*g)*y)` does not weigh", message)
        self.assertIn("gravity `g` must enter as the acceleration of the ground does", message)
        self.assertRegex(message, r"kinetic energy at \S+model\.py:15\)")

    def test_an_inertia_without_weight(self):
        message = self.refusal(HEAD + "model.kinetic(extra * (y.rate + z_v.rate)**2 / 2)\n" + MODE, 15)
        self.assertIn("does not weigh what it resists the ground motion `z_v` with", message)

    def test_a_weight_without_inertia(self):
        message = self.refusal(HEAD + "model.potential(extra * g * l * cos(theta))\n" + MODE, 15)
        self.assertIn("potential energy: `(((extra*g)*l)*cos(theta))` does not weigh", message)

    def test_weights_by_another_gravity(self):
        text = HEAD.replace("model.gravity(g)", "")
        message = self.refusal(text + "model.potential(extra * g * (y + z_v))\n" + MODE, 15)
        self.assertIn("state gravity as a parameter", message)

    def test_guards_and_forces_by_the_weight_at_rest(self):
        guard = 'model.transition("t1", moves, held, when=falls(m * g - k * x))\n'
        self.assertIn("guard of `t1`", self.refusal(HEAD + MODE + HELD + guard, 17))
        self.assertIn("force on `x` in mode `moves`", self.refusal(HEAD + MODE + "moves.force(x, -m * g)\n", 16))
        self.generate(HEAD + MODE + HELD + 'model.transition("t1", held, moves, when=falls(held.reaction(y)))\n')

    def test_a_body_that_is_moved_by_hand(self):
        self.assertIn("body 2: positions are relative to the ground: leave `z_h` out",
                      self.refusal(HEAD + "model.point_mass(extra, position=(x + z_h, y))\n" + MODE, 15))

    def test_ground_that_moves_nothing(self):
        text = HEAD.replace("model.rigid_body(m, m * l**2 / 3, position=(x + l * sin(theta), y + l * cos(theta)), angle=theta)",
                            "model.kinetic(m * (x.rate + z_h.rate)**2 / 2 + m * l**2 * theta.rate**2 / 2)")
        self.assertIn("the ground motion `z_v` moves nothing", self.refusal(text + 'moves = model.mode("moves", freeze=[y])\n', 12))

    def test_without_bodies_each_energy_is_held_against_the_others(self):
        text = HEAD.replace("model.rigid_body(m, m * l**2 / 3, position=(x + l * sin(theta), y + l * cos(theta)), angle=theta)\n", "").replace(
            'z_v = model.ground("z_v", "upwards", input="a_v", axis="y")\n', "")
        good = "model.kinetic(m * (x.rate + z_h.rate)**2 / 2 + m * l**2 * theta.rate**2 / 2)\n"
        mode = 'moves = model.mode("moves", freeze=[y])\n'
        self.generate(text + good + mode)
        self.assertIn("may have momentum, but does not see", self.refusal(text + good + "model.kinetic(extra * x.rate**2 / 2)\n" + mode, 14))
        pendulum = "model.kinetic(m * ((l * cos(theta) * theta.rate + z_h.rate)**2 + (l * sin(theta) * theta.rate)**2) / 2)\n"
        self.generate(text + pendulum + 'moves = model.mode("moves", freeze=[x, y])\n')


class Tank(ScratchTest):
    """The shipped tank, and what it would be without the ground's velocity or height."""

    def setUp(self):
        super().setUp()
        tank = os.path.join(ROOT, "models", "walking_tank")
        for name in ("paper.py", "paper_energies.py", "corrections.py"):
            shutil.copy(os.path.join(tank, name), self.folder)
        with open(os.path.join(tank, "model.py"), encoding="utf-8") as stream:
            self.text = stream.read()

    def refused(self, right, wrong, call):
        self.assertIn(right, self.text)
        text = self.text.replace(right, wrong)
        return self.refusal(text, text[:text.index(call)].count("\n") + 1)

    def test_kinetic_energy_in_relative_velocities(self):
        message = self.refused("rise = y.rate + z_v.rate", "rise = y.rate", "model.kinetic(")
        self.assertIn("`(((M_0-M_I)*sq(y.rate))/2)` has another momentum where `y` moves the bodies", message)

    def test_weight_that_does_not_rise_with_the_ground(self):
        message = self.refused("rest * g * (y + z_v)", "rest * g * y", "model.potential(g * moment")
        self.assertIn("gravity `g` must enter as the acceleration of the ground does", message)

    def test_one_wrong_arm(self):
        """Wrong in one parameter only, and nothing with the default ones, where both angles are the same."""
        message = self.refused("M_E * R_0 * sin(alpha_0 - theta) - M_rb", "M_E * R_0 * sin(alpha_I - theta) - M_rb", "model.potential(g * moment")
        self.assertIn("gravity `g` must enter", message)

    def test_there_is_code_with_and_without_vertical_motion(self):
        variants = self.described(self.text)["variants"]
        lean = [v["lean"] for v in variants if v["lean"]]
        self.assertEqual([of["without"] for of in lean], [[1]] * 5)
        self.assertEqual([v["barred"] for v in variants + [of["variant"] for of in lean]].count([1]), 4)


if __name__ == "__main__":
    unittest.main()
