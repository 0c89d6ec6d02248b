"""The text of an order of a series: linear parts are multiplied out."""

import re
import unittest

import casadi as ca

from codegen.emit_series import Outputs
from codegen.interiors import Interiors


def order(expression):
    """Statements of an order of the series of functions of x, y (moving) and b, c (constant)."""
    x, y, b, c = (ca.SX.sym(name) for name in "xybc")
    none = ca.SX(0, 1)
    series = Outputs(ca.vertcat(*expression(x, y, b, c)), moving=[("q", ca.vertcat(x, y))],
                     constant=[("c", ca.vertcat(b, c))], held=none, drift={})
    return [line.strip() for line in series.order if line.startswith("  const real t") or " out[" in line]


class Order(unittest.TestCase):
    def test_nested_products_by_constants_are_one(self):
        variable, output = order(lambda x, y, b, c: [b * (c * x + b * (x - c * y))])
        self.assertEqual(variable.count("*"), 2 + 2, variable)  # two products, two indices
        self.assertEqual(output, f"out[1 * k + 0] = REAL({variable.split()[2]});")

    def test_terms_that_cancel_vanish(self):
        variable, _ = order(lambda x, y, b, c: [(x + c * y) - x])
        self.assertNotIn("q[2 * k + 0]", variable)

    def test_what_is_needed_twice_is_computed_once(self):
        lines = order(lambda x, y, b, c: [(s := b * x + c * y) * s, b * s, c * s])
        self.assertEqual(sum("q[2 * k + 0]" in line and "q[2 * k + 1]" in line for line in lines), 1, lines)

    def test_a_constant_of_a_plain_sum_stays_outside(self):
        lines = order(lambda x, y, b, c: [b * (x + y)])
        self.assertEqual(lines[0].split(" = ")[1], "q[2 * k + 0] + q[2 * k + 1];")

    def test_a_variable_whose_terms_are_there_is_left_out(self):
        """b s + c x with s = x + b y, which is stored as a factor, has the terms x and y alone."""
        lines = order(lambda x, y, b, c: [(s := x + b * y) * s, b * s + c * x])
        stored = re.match(r"const real (t\d+) = ", lines[0]).group(1)
        last = next(line for line in reversed(lines) if line.startswith("const"))
        self.assertNotIn(stored, last)
        self.assertEqual(last.count("w["), 2, last)


class Late(unittest.TestCase):
    def test_an_element_that_two_rows_share_leaves_others_their_accelerations(self):
        interiors = Interiors()
        accelerations = [f"a[2 * (k - 1) + {j}]" for j in range(2)]
        for row in (("same", "m"), ("same", "n")):
            for j, mass in enumerate(row):
                interiors.add_late(mass, f"acceleration {j}", accelerations[j])
        for (_, name), index in interiors.indices.items():
            self.assertEqual(interiors.late[index], accelerations[int(name.split()[1])], name)


if __name__ == "__main__":
    unittest.main()
