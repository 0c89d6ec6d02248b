"""The exact normal form against numbers and against SymPy, and Lagrange's equations against
SymPy's own derivation."""

import math
import random
import unittest
from fractions import Fraction

import sympy

from codegen.verify.errors import NotInClass, PaperError
from codegen.verify.judgements.angles import without_angles
from codegen.verify.judgements.definite import Verdict, prove, prove_matrix
from codegen.verify.load import load
from codegen.verify.normal.algebra import Ring, expression
from codegen.verify.normal.matrices import determinant
from codegen.verify.readings.lagrange import Motion
from codegen.verify.seeded import EXAMPLES

A, B, Q, V, LAM, M = sympy.symbols("a b q v lam m", real=True)


def random_expression(generator, depth=3):
    """A random expression of the class."""
    if depth == 0:
        return generator.choice([A, B, Q, V, LAM, M, sympy.Integer(generator.randint(-3, 3)), sympy.Rational(1, 3)])
    kind = generator.choice(["add", "mul", "mul", "pow", "sin", "cos"])
    if kind in ("sin", "cos"):
        angle = generator.randint(-2, 2) * A + generator.randint(-2, 2) * LAM * Q + sympy.Rational(generator.randint(-3, 3), 2) * B
        return getattr(sympy, kind)(angle)
    left, right = random_expression(generator, depth - 1), random_expression(generator, depth - 1)
    return {"add": left + right, "mul": left * right, "pow": left**2 - right}[kind]


class NormalForm(unittest.TestCase):
    def setUp(self):
        self.ring = Ring(["lam"], ["a", "b"])

    def test_has_the_value_of_the_expression_for_both_discrete_states(self):
        generator = random.Random(1)
        for _ in range(60):
            term = random_expression(generator)
            form = self.ring.read(term)
            for state in (1, -1):
                values = {"a": 0.3, "b": -1.1, "q": 0.7, "v": 1.3, "m": 2.0, "lam": state}
                expected = float(term.subs({sympy.Symbol(n, real=True): v for n, v in values.items()}))
                self.assertAlmostEqual(form.evaluate(values, math.sin, math.cos), expected, delta=1e-9 * max(1, abs(expected)))

    def test_of_identical_expressions_is_equal(self):
        for left, right in [
            (sympy.sin(A - Q), sympy.sin(A) * sympy.cos(Q) - sympy.cos(A) * sympy.sin(Q)),
            (sympy.sin(Q)**2 + sympy.cos(Q)**2, 1),
            (sympy.cos(LAM * Q), sympy.cos(Q)),
            (sympy.sin(LAM * Q), LAM * sympy.sin(Q)),
            (LAM**3, LAM),
            (sympy.cos(3 * Q), 4 * sympy.cos(Q)**3 - 3 * sympy.cos(Q)),
            (sympy.sign(-LAM * V), -LAM * sympy.sign(V)),
            (sympy.Abs(-LAM * V), sympy.Abs(V)),
            (1 / (A * M), A**-1 / M),
            (sympy.sign(V)**3, sympy.sign(V)),
            (sympy.sin(sympy.sign(Q) * A - Q), sympy.sign(Q) * sympy.sin(A) * sympy.cos(Q) - sympy.cos(A) * sympy.sin(Q)),
        ]:
            self.assertEqual(self.ring.read(left), self.ring.read(right), (left, right))

    def test_of_different_expressions_differs(self):
        for left, right in [(sympy.sin(Q), Q), (LAM * Q, Q), (sympy.cos(A - Q), sympy.cos(A + Q)), (sympy.Abs(V), V),
                            (sympy.sin(sympy.sign(Q) * A - Q), sympy.sin(A - Q)), (sympy.sign(Q), sympy.sign(V))]:
            self.assertNotEqual(self.ring.read(left), self.ring.read(right), (left, right))

    def test_differentiates_like_sympy(self):
        generator = random.Random(2)
        for _ in range(30):
            term = random_expression(generator)
            for symbol in (Q, V, A):
                self.assertEqual(self.ring.read(term).diff(symbol.name), self.ring.read(sympy.diff(term, symbol)), term)

    def test_comes_back_as_an_expression(self):
        generator = random.Random(3)
        for _ in range(30):
            form = self.ring.read(random_expression(generator))
            self.assertEqual(self.ring.read(expression(form)), form)

    def test_rejects_what_it_cannot_prove_and_names_it(self):
        for term in (sympy.exp(Q), sympy.sin(Q**2), 1 / (1 + LAM), sympy.sqrt(Q), sympy.Float(0.1) * Q, sympy.sin(Q + 1)):
            with self.assertRaises(NotInClass, msg=str(term)):
                self.ring.read(term)

    def test_order_is_the_lowest_degree(self):
        self.assertEqual(self.ring.read(sympy.cos(Q) - 1).order(["q"]), 2)
        self.assertEqual(self.ring.read(V * sympy.sin(Q)).order(["q"]), 1)
        self.assertEqual(self.ring.read(V).order(["q"]), 0)
        self.assertIsNone(self.ring.read(V - V).order(["q"]))


class Derivation(unittest.TestCase):
    def test_agrees_with_sympy_for_every_example(self):
        for name in ("double_pendulum", "rocking_block", "tank"):
            case = load(EXAMPLES / name)
            motion = Motion(case.paper, case.energies[0])
            t = sympy.Symbol("t")
            inputs = [x.name for x in case.paper.symbols.values() if x.role == "input"]
            functions = {n: sympy.Function(n)(t) for n in motion.coordinates + inputs}
            stand_in = {}
            for n, f in functions.items():
                stand_in.update({"dd" + n: f.diff(t, 2), "d" + n: f.diff(t), n: f})
            symbols = {n: sympy.Symbol(n, real=True) for n in stand_in}
            forward = {symbols[n]: stand_in[n] for n in stand_in}
            backward = [(stand_in[n], symbols[n]) for n in sorted(stand_in, key=lambda n: (not n.startswith("dd"), not n.startswith("d")))]
            energies = case.energies[0]
            kinetic = energies.kinetic(motion.s, motion.m).subs(forward, simultaneous=True)
            potential = energies.potential(motion.s, motion.m).subs(forward, simultaneous=True)
            lagrangian = kinetic - potential
            for n in motion.coordinates:
                expected = lagrangian.diff(functions[n].diff(t)).diff(t) - lagrangian.diff(functions[n])
                expected = motion.ring.read(expected.subs(backward)).substitute(motion.held)
                extra = motion.ring.number(0)
                if energies.dissipation:
                    extra += motion.ring.read(energies.dissipation(motion.s, motion.m)).diff("d" + n)
                if n in energies.forces:
                    extra -= motion.ring.read(energies.forces[n](motion.s, motion.m))
                self.assertEqual(motion.residual(n), expected + extra, (name, n))


class Definiteness(unittest.TestCase):
    def setUp(self):
        self.ring = Ring([], [])

    def test_determinant_is_that_of_sympy(self):
        rows = [[A, Q, sympy.sin(Q)], [Q, B, V], [sympy.sin(Q), V, M]]
        mine = determinant([[self.ring.read(x) for x in row] for row in rows])
        self.assertEqual(mine, self.ring.read(sympy.expand(sympy.Matrix(rows).det())))

    def test_proof_refutation_and_doubt(self):
        form = self.ring.read(2 + sympy.cos(Q))
        self.assertEqual(prove([form], {}, {"q": (-4.0, 4.0)}).status, "proved")
        form = self.ring.read(sympy.Rational(99, 100) + sympy.cos(Q))
        refuted = prove([form], {}, {"q": (-4.0, 4.0)})
        self.assertEqual(refuted.status, "refuted")
        low, high = refuted.point["q"]
        self.assertLess(0.99 + math.cos((low + high) / 2), 0)
        touching = self.ring.read(Q**2)
        self.assertEqual(prove([touching], {}, {"q": (-1.0, 2.0)}, limit=50).status, "undecided")

    def test_matrices_whose_minors_are_not_multiplied_out(self):
        def chain(diagonal):
            """Six rows, coupled to their neighbours by m cos q: definite where the diagonal is above 2 m cos(pi/7) = 1.80 m."""
            entries = {0: diagonal * M, 1: M * sympy.cos(Q)}
            return [[self.ring.read(entries.get(abs(i - j), sympy.Integer(0))) for j in range(6)] for i in range(6)]

        box = {"q": (-2.0, 2.0)}
        for diagonal, status in ((sympy.Rational(19, 10), "proved"), (sympy.Rational(17, 10), "refuted"), (sympy.Abs(B), "undecided")):
            self.assertEqual(prove_matrix(chain(diagonal), {"m": "3", "b": "2"}, box).status, status)
        with self.assertRaisesRegex(PaperError, "no value for m"):
            prove_matrix(chain(2), {}, box)

    def test_constants_of_one_function_are_one_interval(self):
        """(a - b) cos q with a - b = 1/10: term by term the bounds of a cos q and b cos q say nothing over the whole box."""
        form = self.ring.read((A - B) * sympy.cos(Q))
        fixed, box = {"a": "3", "b": "2.9"}, {"q": (-1.0, 1.0)}
        self.assertGreater(prove([form], fixed, box).boxes, 1)
        self.assertEqual(prove_matrix([[form]], fixed, box), Verdict("proved", 1))
        self.assertEqual(prove_matrix([[form * -1]], fixed, box).status, "refuted")
        self.assertEqual(prove_matrix([[form + self.ring.read(sympy.Abs(M))]], {**fixed, "m": "1"}, box).status, "undecided")

    def test_constant_angles_are_constants(self):
        """a sin(b - q) - a sin(b + q) + 1 = 1 - 2 a cos b sin q, with cos b small: one box; term by term it is many."""
        form = self.ring.read(A * sympy.sin(B - Q) - A * sympy.sin(B + Q) + 1)
        fixed, box = {"a": "3", "b": "1.5"}, {"q": (-1.0, 1.0)}
        self.assertGreater(prove([form], fixed, box).boxes, 4)
        self.assertEqual(prove_matrix([[form]], fixed, box), Verdict("proved", 1))
        # 2 a cos b is 1.02 and 1.26: the form is zero at sin q = 0.98, outside the box, and at 0.80, inside
        self.assertEqual(prove_matrix([[form]], {"a": "3", "b": "1.4"}, box).status, "proved")
        self.assertEqual(prove_matrix([[form]], {"a": "3.7", "b": "1.4"}, box).status, "refuted")
        for point in (-1.0, -0.3, 0.0, 0.7):
            other = self.ring.read(A * sympy.cos(B - Q) - A * sympy.cos(B + Q) + 1)
            for whole, slope in ((form, -7.4 * math.cos(1.4)), (other, 7.4 * math.sin(1.4))):
                off = whole - Fraction(1 + slope * math.sin(point))
                for sign in (1, -1):  # as near as the doubles of this test are
                    near = off * sign + Fraction(1, 10**12)
                    self.assertEqual(prove_matrix([[near]], {"a": "3.7", "b": "1.4"}, {"q": (point, point)}).status, "proved")

    def test_angles_that_enter_as_differences_are_taken_out(self):
        """Links of any number hang on a cart: definite at all angles, which boxes of eight angles do not show."""
        angles = sympy.symbols("q_1:9", real=True)

        def links(coupling, others=angles):
            """A cart and eight links, the third of them measured from the horizontal."""
            shift = [-sympy.pi / 2 if k == 2 else 0 for k in range(8)]
            a = [0, *(angle + by for angle, by in zip(others, shift))]
            return [[self.ring.read(sympy.expand_trig(M * (9 - max(i, j)) * (1 if i == j else coupling * sympy.cos(a[i] - a[j]))))
                     for j in range(9)] for i in range(9)]

        constant = without_angles(links(1))
        self.assertEqual(constant, [[self.ring.read(M * (9 - max(i, j))) for j in range(9)] for i in range(9)])
        box = {x.name: (-3.0, 3.0) for x in angles}
        self.assertEqual(prove_matrix(links(1), {"m": "3"}, box), Verdict("proved", 1))
        self.assertEqual(prove_matrix(links(1), {"m": "-3"}, box).status, "refuted")
        # 1 - c^2 < 0 at equal angles, and not far from them
        pair = [[self.ring.read(x) for x in row] for row in ((sympy.Integer(1), sympy.Rational(3, 2) * sympy.cos(angles[0] - angles[1])),
                                                             (sympy.Rational(3, 2) * sympy.cos(angles[0] - angles[1]), sympy.Integer(1)))]
        self.assertEqual(prove_matrix(pair, {}, {"q_1": (-1.0, 1.0), "q_2": (-1.0, 1.0)}).status, "refuted")
        self.assertEqual(prove_matrix(pair, {}, {"q_1": (1.4, 1.6), "q_2": (0.0, 0.1)}).status, "proved")
        # no angles of three coordinates have these differences
        one, c = sympy.Integer(1), [sympy.cos(angles[0] - angles[1]) / 2, sympy.cos(angles[0] + angles[2]) / 2, sympy.cos(angles[1] - angles[2]) / 2]
        rows = ((one, c[0], c[1]), (c[0], one, c[2]), (c[1], c[2], one))
        self.assertIsNone(without_angles([[self.ring.read(x) for x in row] for row in rows]))
        self.assertIsNone(without_angles([[self.ring.read(sympy.cos(Q)**2)]]))

    def test_a_large_determinant_is_made_minor_by_minor(self):
        rows = [[A if i == j else sympy.Integer(1) for j in range(8)] for i in range(8)]
        mine = determinant([[self.ring.read(x) for x in row] for row in rows])
        self.assertEqual(mine, self.ring.read(sympy.expand((A - 1)**7 * (A + 7))))

    def test_fractions_stay_exact(self):
        self.assertEqual(self.ring.read(sympy.Rational(1, 3) * Q).terms[((("q", 1),), ("cos", ()))], Fraction(1, 3))


if __name__ == "__main__":
    unittest.main()
