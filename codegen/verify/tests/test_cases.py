"""Special cases, limits and small motions with damping, against what is known of them."""

import math
import unittest
from pathlib import Path

from codegen.verify import Paper
from codegen.verify.construct.cases import cases
from codegen.verify.construct.frequencies import modes
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import Case
from codegen.verify.report import gather, text


def paper_of(coordinates, parameters, motions, values=None, damping=()):
    """A paper with coordinates in m, parameters {name: unit} and equations of motion."""
    paper = Paper("made for this test", "none")
    for name in coordinates:
        paper.coordinate(name, "m", name)
    for name, unit in parameters.items():
        paper.parameter(name, unit, name, dissipative=name in damping)
    if values:
        paper.sets["one"] = values
    for k, (name, function) in enumerate(zip(coordinates, motions), 1):
        paper.motion(str(k), of=name)(function)
    return paper


PAIR = [lambda s, m: [s.m * s.ddx, s.k * s.x, s.c * (s.x - s.y), s.d * s.dx], lambda s, m: [s.M * s.ddy, s.K * s.y, s.c * (s.y - s.x), s.d * s.dy]]
UNITS = {"m": "kg", "M": "kg", "k": "N/m", "K": "N/m", "c": "N/m", "d": "N*s/m"}
VALUES = {"m": 2, "M": 2, "k": 8, "K": 8, "c": 3, "d": 1}


class Modes(unittest.TestCase):
    def roots(self, paper):
        (found,) = modes(Subject(paper)).values()
        return found

    def assert_roots(self, found, expected):
        self.assertEqual(len(found), len(expected), found)
        for root, wanted in zip(found, expected):
            self.assertLess(abs(root - wanted), 1e-15 * max(1, abs(wanted)), (found, expected))

    def test_two_equal_masses_swing_together_and_against_each_other(self):
        found = self.roots(paper_of("xy", UNITS, PAIR, VALUES, damping="d"))
        # 2 s^2 + s + 8 and 2 s^2 + s + 14
        self.assert_roots(found, [complex(-0.25, math.sqrt(w - 1 / 16)) for w in (4, 7)])

    def test_too_much_damping_and_falling(self):
        oscillator = [lambda s, m: [s.m * s.ddx, s.d * s.dx, s.k * s.x]]
        units = {"m": "kg", "d": "N*s/m", "k": "N/m"}
        self.assert_roots(self.roots(paper_of("x", units, oscillator, {"m": 1, "d": 5, "k": 4}, damping="d")), [-4, -1])
        self.assert_roots(self.roots(paper_of("x", units, oscillator, {"m": 1, "d": 3, "k": -4}, damping="d")), [-4, 1])

    def test_a_charge_in_a_magnetic_field_turns_and_drifts(self):
        field = [lambda s, m: [s.m * s.ddx, -s.B * s.dy], lambda s, m: [s.m * s.ddy, s.B * s.dx]]
        found = self.roots(paper_of("xy", {"m": "kg", "B": "kg/s"}, field, {"m": 2, "B": 3}))
        self.assert_roots(found, [0, 0, 1.5j])

    def test_what_is_not_linear_has_none(self):
        units = {"m": "kg", "N": "N", "k": "N/m", "d": "N*s/m"}
        for terms in (lambda s, m: [s.m * s.ddx, s.k * s.x, s.N * m.sign(s.dx), s.d * s.dx], lambda s, m: [s.m * s.ddx, s.k * s.x],
                      lambda s, m: [s.m * s.ddx, s.d * s.dx, s.N]):
            self.assertEqual(modes(Subject(paper_of("x", units, [terms], {"m": 1, "N": 1, "k": 1, "d": 1}))), {})

    def test_the_report_says_them(self):
        said = text.as_text(gather.verify(Case("pair", Path("."), paper_of("xy", UNITS, PAIR, VALUES, damping="d")), thorough=False))
        self.assertIn("Small motions about rest, with damping and gyroscopic terms: 1.98431 rad/s that decays with 0.25 1/s, "
                      "2.63391 rad/s that decays with 0.25 1/s (one)", said)
        self.assertIn("Small motions about rest, equation of x: 0 = ", said)


class Cases(unittest.TestCase):
    def test_what_becomes_of_a_pair(self):
        found = dict(cases(Subject(paper_of("xy", UNITS, PAIR))))
        self.assertEqual(found, {"c = 0": ["the motions of x and of y know nothing of one another"],
                                 "m = 0": ["the mass matrix is singular: not all accelerations are determined"],
                                 "M = 0": ["the mass matrix is singular: not all accelerations are determined"]})

    def test_an_equation_that_says_nothing_and_a_divisor(self):
        pendulum = [lambda s, m: [(s.M + s.m) * s.ddx, s.m * s.l * s.ddy], lambda s, m: [s.m * s.l * s.ddx, s.m * s.l**2 * s.ddy / s.h]]
        found = dict(cases(Subject(paper_of("xy", {"m": "kg", "M": "kg", "l": "m", "h": "m"}, pendulum))))
        self.assertEqual(found["m = 0"], ["the equation of y says nothing"])
        self.assertEqual(found["h = 0"], ["the equations have no such case: they divide by what is zero there"])
        self.assertNotIn("M = 0", found)

    def test_a_coordinate_that_stays_at_zero_is_no_part_of_it(self):
        chain = [lambda s, m: [s.m * s.ddx, s.k * (s.x - s.y)], lambda s, m: [s.m * s.ddy, s.k * (2 * s.y - s.x - s.z)],
                 lambda s, m: [s.m * s.ddz, s.k * (s.z - s.y)]]
        paper = paper_of("xyz", {"m": "kg", "k": "N/m"}, chain)
        found = dict(cases(Subject(paper)))
        self.assertEqual(found["y = 0 throughout"], ["the motions of x and of z know nothing of one another"])
        self.assertEqual(found["k = 0"], ["the motions of x and of y and of z know nothing of one another"])


if __name__ == "__main__":
    unittest.main()
