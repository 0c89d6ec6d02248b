"""Ranges of the polynomials of a step, in vectors and without."""

import ctypes
import math
import os
import random
import subprocess
import tempfile
import unittest

SOURCE = os.path.join(os.path.dirname(os.path.dirname(__file__)), "ranges.c")
ROWS = 36
Numbers = ctypes.POINTER(ctypes.c_double)


class Ranges(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.compiled = []
        for name, flags in (("vectors", []), ("plain", ["-U__GNUC__", "-U__clang__"])):
            library = os.path.join(folder.name, f"{name}.so")
            subprocess.run([os.environ.get("CC", "cc"), "-O2", "-shared", "-fPIC", *flags, SOURCE, "-o", library], check=True)
            function = ctypes.CDLL(library).dalembert_ranges
            function.argtypes = [ctypes.c_size_t] * 2 + [Numbers] * 3 + [ctypes.c_double] + [Numbers] * 2
            function.restype = None
            cls.compiled.append((name, function))

    def ranges(self, function, rows, tau, count):
        """Middles and radii, a triple each coordinate; `rows`: of q, v and a, a row of coefficients an order."""
        free = len(rows[0][0])
        pad = [[0.0] * free] * (ROWS - count)
        arrays = [(ctypes.c_double * (ROWS * free))(*sum(own + pad, [])) for own in rows]
        out = [(ctypes.c_double * (3 * free))() for _ in range(2)]
        function(free, count, *arrays, tau, *out)
        return out

    def test_no_value_is_outside(self):
        draw = random.Random(3)
        for name, function in self.compiled:
            for free, count in ((1, 8), (1, 20), (1, 27), (2, 7), (3, 28)):
                for _ in range(50):
                    tau = draw.uniform(0.1, 2.0)
                    rows = [[[draw.uniform(-1, 1) / math.factorial(k // 2) for _ in range(free)] for k in range(count)]
                            for _ in range(3)]
                    middles, radii = self.ranges(function, rows, tau, count)
                    for of, own in enumerate(rows):
                        for i in range(free):
                            for n in range(41):
                                value = sum(own[k][i] * (tau * n / 40) ** k for k in range(count))
                                away = abs(value - middles[of * free + i])
                                self.assertLessEqual(away, radii[of * free + i] * (1 + 1e-12), (name, free, count))

    def test_the_middle_of_a_coordinate_is_where_it_starts(self):
        for _, function in self.compiled:
            rows = [[[0.1 * k - 0.3] for k in range(12)] for _ in range(3)]
            self.assertEqual(self.ranges(function, rows, 0.7, 12)[0][0], -0.3)

    def test_half_a_period_is_told_from_growth(self):
        """Of cos the sizes of all coefficients would say cosh π − 1 = 10.6 instead of 1; of cosh they are right."""
        cosine, growth = ([[0.0 if k % 2 else sign ** (k // 2) / math.factorial(k)] for k in range(24)] for sign in (-1, 1))
        for name, function in self.compiled:
            _, radii = self.ranges(function, [cosine, cosine, growth], math.pi, 24)
            self.assertLess(radii[1], 3.5, name)
            self.assertAlmostEqual(radii[2], (math.cosh(math.pi) - 1) / 2, delta=0.3, msg=name)

    def test_both_are_the_same_but_for_rounding(self):
        draw = random.Random(4)
        rows = [[[draw.uniform(-1, 1) for _ in range(2)] for _ in range(18)] for _ in range(3)]
        one, other = (self.ranges(function, rows, 0.8, 18) for _, function in self.compiled)
        for x, y in zip([*one[0], *one[1]], [*other[0], *other[1]]):
            self.assertAlmostEqual(x, y, delta=1e-14 * (1 + abs(x)))


if __name__ == "__main__":
    unittest.main()
