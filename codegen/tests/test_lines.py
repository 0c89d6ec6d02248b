"""Lines that solve for a coordinate: which do, what then depends on what, and what is left to multipliers."""

import unittest

from codegen.tests.scratch import HEAD, ScratchTest

THREE = HEAD + """\
speed = model.parameter("speed", "m/s", 1.0, "speed of a belt")
y = model.coordinate("y", "m", "height")
z = model.coordinate("z", "m", "another place")
model.point_mass(m, position=(x, y))
model.kinetic(m * z.rate**2 / 2)
N = model.parameter("N", "N", 1.0, "normal force")
L = model.parameter("L", "m", 1.0, "length", above=0)
"""

BELT = 'belt = model.motion("belt", "place of a belt", input="a")\n'

REDUCED = (
    ("a slip of two coordinates", 'model.friction("rail", slip=x - 2 * y, normal=N, kinetic=0.2)\n',
     {"rail sticks": ["x"], "rail slides": []}),
    ("a slip rate against a belt", 'model.friction("rail", slip=x.rate - y.rate - speed, normal=N, kinetic=0.2)\n',
     {"rail sticks": ["y"], "rail slides": []}),
    ("a bent constraint", 'model.constraint("hill", y - z**2 / L)\n', {"moves": ["y"]}),
    ("a constraint that is called as a coordinate", 'model.constraint("z", x - y); model.friction("x", slip=y - z, normal=N, kinetic=0.2)\n',
     {"x sticks": ["y", "z"], "x slides": ["y"]}),
    ("beside a gap", 'model.constraint("hill", y - z**2 / L); model.contact("wall", gap=x)\n', {"wall open": ["y"], "wall closed": ["y"]}),
    ("a gap that is no coordinate", 'model.contact("a", gap=x - y)\n', {"a open": [], "a closed": ["y"]}),
    ("a gap with numbers", 'model.contact("a", gap=(x - 0.233 * y) + 0.482 * L); model.friction("b", slip=0.233 * y - x, normal=N, kinetic=0.3)\n',
     {"a open, b sticks": ["x"], "a open, b slides": [], "a closed, b sticks": ["x"]}),
    ("a gap over what a constraint holds", 'model.constraint("hill", y - z**2 / L); model.contact("a", gap=z - y + x)\n',
     {"a open": ["y"], "a closed": ["x", "y"]}),
    ("two gaps that inertia does not couple", 'model.contact("a", gap=x); model.contact("b", gap=y); model.constraint("c", x - z)\n',
     {f"a {a}, b {b}": ["z"] for a in ("open", "closed") for b in ("open", "closed")}),
    ("a gap with friction", 'model.contact("a", gap=y, slip=x - z, kinetic=0.2)\n', {"a open": [], "a sticks": ["z"], "a slides": []}),
    ("two stops along one coordinate", 'model.contact("a", gap=x + L); model.contact("b", gap=L - x)\nmodel.constraint("c", y - z)\n',
     {"a open, b open": ["z"], "a open, b closed": ["z"], "a closed, b open": ["z"]}),
    ("two lines, one behind the other", 'model.constraint("a", x - y); model.friction("b", slip=y - z, normal=N, kinetic=0.2)\n',
     {"b sticks": ["y", "z"], "b slides": ["y"]}),
    ("a gear", 'model.constraint("gear", L * y / 2 + m / m * L * z)\n', {"moves": ["z"]}),
    ("a factor that is not 1 beside one that is", 'model.constraint("gear", y - m / m * 2 * z)\n', {"moves": ["y"]}),
    ("a place on a belt that is driven", BELT + 'model.friction("rail", slip=x - belt, normal=N, kinetic=0.2)\n',
     {"rail sticks": ["x"], "rail slides": []}),
    ("its rate", BELT + 'model.friction("rail", slip=x.rate - belt.rate - speed, normal=N, kinetic=0.2)\n',
     {"rail sticks": ["x"], "rail slides": []}),
    ("a table that is driven", BELT + 'model.contact("a", gap=y - belt)\n', {"a open": [], "a closed": ["y"]}),
    ("what is driven itself", BELT + 'model.constraint("crank", z - L * sin(belt / L))\n', {"moves": ["z"]}),
)
"""Of each mode the coordinates that depend on others."""

LEFT = (
    ("a factor that may be zero", 'model.constraint("gear", speed * x - speed * y)\n'),
    ("friction against two things that move", BELT + 'model.friction("a", slip=x - belt, normal=N, kinetic=0.2)\n'
     'model.friction("b", slip=x, normal=N, kinetic=0.2)\n'),
    ("lines that depend on each other", 'model.friction("a", slip=x - y, normal=N, kinetic=0.2); model.friction("b", slip=y - z, normal=N, kinetic=0.2)\n'
     'model.friction("c", slip=z - x, normal=N, kinetic=0.2)\n'),
    ("lines of which each depends on what the other takes", 'model.constraint("a", x - y); model.constraint("b", x + y - L)\n'),
    ("a constraint along a gap", 'model.constraint("a", x - y); model.contact("b", gap=y - x + L)\n'),
    ("a circle", 'model.constraint("rod", x**2 + y**2 - L**2)\n'),
    ("gaps that inertia couples", 'model.contact("a", gap=x); model.contact("b", gap=y - x + L)\n'),
    ("an impact that presses another contact", 'model.kinetic(m * x.rate * y.rate / 3)\nmodel.contact("a", gap=x); model.contact("b", gap=y)\n'),
    ("friction along what strikes elsewhere", 'model.contact("a", gap=x, restitution=0.5); model.contact("b", gap=y, slip=x, kinetic=0.2)\n'),
    ("friction that acts on its normal force", 'model.contact("a", gap=y, slip=x - y, kinetic=0.2)\n'),
    ("the same through what is free", 'model.kinetic(m * (x.rate + y.rate) * z.rate / 3)\nmodel.contact("a", gap=y, slip=x, kinetic=0.2)\n'),
    ("a rate with a factor that moves", 'model.friction("blade", slip=x / L * y.rate - z.rate, normal=N, kinetic=0.2)\n'),
    ("a reaction that is asked for", 'model.output("force", "N", model.reaction(z), "force")\nmodel.constraint("a", x - z)\n'),
)


class LinesTest(ScratchTest):
    def modes(self, text):
        [variant] = self.described(THREE + text)["variants"]
        names = ["x", "y", "z"]
        return {mode["name"]: [n for n, depends in zip(names, mode["depends"]) if depends] for mode in variant["modes"]
                if mode["contacts"] is None}

    def test_what_depends_on_others(self):
        for what, text, modes in REDUCED:
            with self.subTest(what):
                self.assertEqual(self.modes(text), modes)

    def test_what_is_left_to_multipliers(self):
        for what, text in LEFT:
            with self.subTest(what):
                self.assertEqual(self.modes(text), {})


if __name__ == "__main__":
    unittest.main()
