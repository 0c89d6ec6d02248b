"""The two derivations of the equations agree, and mode equations are what they should be."""

import os
import random
import unittest

import casadi as ca

from codegen import derive
from codegen.generate import load

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def folders():
    """All model folders of the project."""
    for parent in ("models", os.path.join("tests", "models")):
        path = os.path.join(ROOT, parent)
        for name in sorted(os.listdir(path)):
            if os.path.exists(os.path.join(path, name, "model.py")):
                yield os.path.join(path, name)


class Derivation(unittest.TestCase):
    def test_bodies_and_energies_give_the_same_equations(self):
        numbers = random.Random(1)
        for folder in folders():
            model = load(folder)[0]
            both = ca.vertcat(derive.residual_from_bodies(model), derive.residual_from_energies(model))
            symbols = ca.symvar(both)
            function = ca.Function("both", symbols, [both])
            with self.subTest(model=model.name):
                for _ in range(20):
                    values = [numbers.uniform(0.2, 1.2) for _ in symbols]
                    result = function(*values).full().ravel()
                    bodies, energies = result[: len(result) // 2], result[len(result) // 2:]
                    # Terms of the largest size, each with a few roundings.
                    self.assertLess(max(abs(bodies - energies)), 1e-13 * max(abs(energies)))

    def test_mass_matrices_are_symmetric(self):
        for folder in folders():
            model = load(folder)[0]
            if model.hand_written:
                continue
            x = derive.configuration(model)
            mass = ca.jacobian(derive.residual_from_bodies(model), x.a)
            symbols = ca.symvar(mass)
            values = [0.3 + 0.1 * k for k in range(len(symbols))]
            mass = ca.Function("mass", symbols, [ca.densify(mass)])(*values).full()
            with self.subTest(model=model.name):
                self.assertLess(abs(mass - mass.T).max(), 1e-14 * abs(mass).max())


if __name__ == "__main__":
    unittest.main()
