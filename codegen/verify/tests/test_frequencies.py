"""Frequencies of small motions, beside what the same published texts print."""

import math
import unittest
from pathlib import Path

from codegen.verify import Energies, Paper
from codegen.verify.construct.frequencies import frequencies
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import Case, load
from codegen.verify.report import gather as report, text
from codegen.verify.seeded import PUBLISHED


def values(name):
    """The squares of the frequencies of a published system with its printed parameters."""
    (found,) = frequencies(Subject(load(PUBLISHED / name).paper)).values.values()
    return found


class Printed(unittest.TestCase):
    def test_an_upright_pendulum_falls_at_the_printed_rate(self):
        # lambda = 12.47 rad/s, printed with numbers of four digits
        fall, still = values("furuta_pendulum")
        self.assertEqual((f"{math.sqrt(-fall):.2f}", still), ("12.47", 0))

    def test_modes_of_three_masses(self):
        # omega_0 and omega_0 sqrt(2), and a steady motion of the whole
        for found, printed in zip(values("three_masses"), (0, 1, 2), strict=True):
            self.assertAlmostEqual(found, printed, delta=1e-14)

    def test_modes_of_a_double_pendulum(self):
        # omega^2 = omega_0^2/(1 +- 1/sqrt(2)), omega_0^2 = g/l
        for found, sign in zip(values("double_pendulum_momenta"), (1, -1), strict=True):
            self.assertAlmostEqual(found * (1 + sign / math.sqrt(2)) / 9.81, 1, delta=1e-14)

    def test_in_closed_form(self):
        found = frequencies(Subject(load(PUBLISHED / "bead_on_rotating_wire").paper))
        paper = load(PUBLISHED / "bead_on_rotating_wire").paper
        # stable where g k > omega^2
        subject = Subject(paper)
        s = subject.s
        self.assertEqual(-found.polynomial[0] * found.polynomial[1].inverse(), subject.ring.read(s.g * s.k - s.omega**2))
        self.assertAlmostEqual(found.values["values"][0], 9.81 * 2 - 9, delta=1e-14)


class Unsaid(unittest.TestCase):
    def test_where_rest_is_no_equilibrium_or_rates_couple(self):
        self.assertIsNone(frequencies(Subject(load(PUBLISHED / "spring_loaded_inverted_pendulum").paper)))
        paper = Paper("Charge in a magnetic field", "made for this test")
        for name in "xy":
            paper.coordinate(name, "m", name)
        for name, unit in (("m", "kg"), ("B", "kg/s")):
            paper.parameter(name, unit, name)
        paper.sets["one"] = {"m": 1, "B": 2}
        paper.motion("1", of="x")(lambda s, m: [s.m * s.ddx, -s.B * s.dy])
        paper.motion("2", of="y")(lambda s, m: [s.m * s.ddy, s.B * s.dx])
        self.assertIsNone(frequencies(Subject(paper)))

    def test_damping_and_forces_are_left_out(self):
        paper = Paper("Oscillator", "any textbook")
        paper.coordinate("x", "m", "x", mirror=-1)
        for name, unit in (("m", "kg"), ("k", "N/m")):
            paper.parameter(name, unit, name)
        paper.parameter("c", "N*s/m", "damping", dissipative=True)
        paper.force("F", "N", "push", mirror=-1)
        paper.sets["one"] = {"m": 2, "k": 8, "c": 1}
        paper.motion("1", of="x")(lambda s, m: [s.m * s.ddx, s.c * s.dx, s.k * s.x, -s.F])
        energies = Energies("oscillator", "", lambda s, m: s.m * s.dx**2 / 2, lambda s, m: s.k * s.x**2 / 2,
                            dissipation=lambda s, m: s.c * s.dx**2 / 2, forces={"x": lambda s, m: s.F})
        result = report.verify(Case("oscillator", Path("."), paper, [energies]), thorough=False)
        self.assertEqual(result.constructed[0].frequencies.values, {"one": [4.0]})
        self.assertIn("Small motions about rest, without damping and forces: 2 rad/s (one)", text.as_text(result))


if __name__ == "__main__":
    unittest.main()
