"""Tapes say what the expressions say."""

import math
import random
import unittest

import casadi as ca

from codegen import tape

x, y, p = (ca.SX.sym(name) for name in "xyp")
PLACES = {x.element_hash(): ("Coordinate", 0), y.element_hash(): ("Rate", 0), p.element_hash(): ("Parameter", 0)}

EXPRESSIONS = (
    x * y - p, x / (3 + y), -x**2 + 2 * y, ca.sin(x) * ca.cos(x) + ca.sin(y), ca.tan(x) + ca.tanh(y), ca.sinh(x) - ca.cosh(y),
    ca.sqrt(2 + x), ca.exp(x) + ca.log(2 + y), ca.atan(x) + ca.asin(y) - ca.acos(x), x**5, x ** -3, (2 + x) ** y, (2 + x) ** 1.5,
    ca.if_else(p > 0, x, y), ca.fmax(p, 0.3) * x, 7 + 0 * x,
)

_NAMES = {
    "SquareRoot": math.sqrt, "Exponential": math.exp, "Logarithm": math.log, "Sine": math.sin, "Cosine": math.cos,
    "Tangent": math.tan, "ArcSine": math.asin, "ArcCosine": math.acos, "ArcTangent": math.atan,
    "HyperbolicSine": math.sinh, "HyperbolicCosine": math.cosh, "HyperbolicTangent": math.tanh,
}
_PICKS = {
    "Less": lambda a, b: float(a < b), "Where": lambda a, b: b if a else 0.0, "Greatest": max, "Not": lambda a, b: float(not a),
}


def values(made, given):
    """What a tape gives at order 0, and the derivative of each function by its slope."""
    found, slopes = [], []
    for [(kind, of)] in (instruction.items() for instruction in made["instructions"]):
        if kind == "Constant":
            value = float(of)
        elif kind in ("Coordinate", "Rate", "Parameter"):
            value = given[kind]
        elif kind == "Function":
            name, x, slope = of
            value = _NAMES[name](found[x])
            slopes.append((name, found[x], slope))
        elif kind == "Fixed":
            value = _PICKS[of[0]](*(found[i] for i in of[1:]))
        elif kind == "Negative":
            value = -found[of]
        else:
            a, b = (found[i] for i in of)
            value = {"Sum": a + b, "Difference": a - b, "Product": a * b, "Quotient": a / b if b else math.nan}[kind]
        found.append(value)
    return [found[i] for i in made["results"]], [(name, at, found[w]) for name, at, w in slopes]


class Tapes(unittest.TestCase):
    def test_values_are_those_of_the_expressions(self):
        draw = random.Random(1)
        column = ca.vertcat(*EXPRESSIONS)
        exact, text = ca.Function("exact", [x, y, p], [column]), tape.of(column, PLACES)
        for _ in range(50):
            at = [draw.uniform(0.1, 0.9) for _ in range(3)]
            found, _ = values(text, dict(zip(("Coordinate", "Rate", "Parameter"), at)))
            for one, other in zip(found, exact(*at).full().ravel()):
                self.assertAlmostEqual(one, other, delta=1e-13 * (1 + abs(other)))

    def test_slopes_are_those_of_the_functions(self):
        _, slopes = values(tape.of(ca.vertcat(*EXPRESSIONS), PLACES), {"Coordinate": 0.3, "Rate": 0.4, "Parameter": 0.5})
        self.assertEqual({name for name, _, _ in slopes}, set(_NAMES))
        for name, at, slope in slopes:
            step = 1e-6
            difference = (_NAMES[name](at + step) - _NAMES[name](at - step)) / (2 * step)
            self.assertAlmostEqual(slope, difference, delta=1e-6 * (1 + abs(difference)), msg=name)

    def test_an_operation_without_a_rule_is_not_a_number(self):
        self.assertIn({"Constant": "nan"}, tape.of(ca.erf(x), PLACES)["instructions"])


if __name__ == "__main__":
    unittest.main()
