"""Drawings: what is refused, and that the program gives the points."""

import json
import math
import os
import unittest

import casadi as ca

from codegen import drawing, generate
from codegen.tests.scratch import BODY, HEAD, MODE, ScratchTest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FUNCTIONS = dict(
    add=lambda a, b: a + b, sub=lambda a, b: a - b, mul=lambda a, b: a * b, div=lambda a, b: a / b, neg=lambda a: -a,
    sq=lambda a: a * a, twice=lambda a: 2 * a, inv=lambda a: 1 / a, sin=math.sin, cos=math.cos, sqrt=math.sqrt)


def run(program, values):
    """The outputs of a program, as pages compute them."""
    w, out = [0.0] * program["registers"], [None] * program["outputs"]
    for op, to, *rest in program["program"]:
        if op == "const":
            w[to] = rest[0]
        elif op == "in":
            w[to] = values[program["symbols"][rest[0]]]
        elif op == "out":
            out[to] = w[rest[0]]
        else:
            w[to] = FUNCTIONS[op](*(w[i] for i in rest))
    return out


class Programs(unittest.TestCase):
    def test_the_program_of_every_model_gives_the_points_that_it_states(self):
        folder = os.path.join(ROOT, "models")
        names = sorted(name for name in os.listdir(folder) if os.path.exists(os.path.join(folder, name, "model.py")))
        for name in names:
            model = generate.load(os.path.join(folder, name))[0]
            self.assertTrue(model.shapes, f"{name} draws nothing")
            program = json.loads(drawing.program(model))
            known, symbols = drawing.symbols(model)
            values = {name: 0.1 + 0.07 * k for k, name in enumerate(known)}
            lengths = []
            for shape in model.shapes:
                lengths += shape.values()
            function = ca.Function("points", symbols, [ca.densify(ca.vertcat(*lengths))])
            wanted = [float(x) for x in function(*(values[n] for n in known)).full().ravel()]
            self.assertEqual(len(wanted), program["outputs"])
            for given, want in zip(run(program, values), wanted):
                self.assertAlmostEqual(given, want, places=12, msg=name)


class Contacts(unittest.TestCase):
    def test_contacts_name_reactions_and_the_states_of_modes(self):
        model = generate.load(os.path.join(ROOT, "models", "walking_tank"))[0]
        shapes = json.loads(drawing.program(model))["shapes"]
        pivot = next(shape for shape in shapes if shape["name"] == "pivot")
        self.assertEqual(pivot["force"], ["reaction.z_h", "reaction.y"])
        self.assertEqual(pivot["states"], dict(
            stands_sticks="sticks", rocks_sticks="sticks", stands_slides="slides", rocks_slides="slides"))


    def test_a_declared_contact_brings_its_forces_with_their_directions(self):
        model = generate.load(os.path.join(ROOT, "models", "rigid_block"))[0]
        shapes = json.loads(drawing.program(model))["shapes"]
        left = next(shape for shape in shapes if shape["name"] == "left")
        self.assertEqual((left["of"], left["pushes"]), ("left", ["left.normal", "left.friction"]))
        out = run(json.loads(drawing.program(model)), dict.fromkeys(drawing.symbols(model)[0], 0.5))
        self.assertEqual(out[left["start"] + 2:left["start"] + 6], [0, 1, 1, 0])

    def test_forces_of_constraints_act_along_what_they_hold(self):
        """The work of the forces that are drawn is that of the multipliers: J'(Q) d = grad of the expression, by differences."""
        model = generate.load(os.path.join(ROOT, "models", "four_bar"))[0]
        shape = next(s for s in model.shapes if s.of == "coupler_bar")
        symbols = drawing.symbols(model)[1]
        held = next(c.expression for c in model.constraints if c.name == "coupler_bar")
        at_B = [s for s in symbols if s.name() in ("x_B", "y_B")]
        point = {"x_A": 0.0, "y_A": 0.4, "x_B": 0.8, "y_B": 1.0, "coupler": 1.0}
        values = [point.get(s.name(), 0.5) for s in symbols]
        both = ca.Function("both", symbols, [ca.vertcat(*shape.pushes[0][1]), ca.jacobian(held, ca.vertcat(*at_B)).T])
        drawn, gradient = (x.full().ravel() for x in both(*values))
        for given, want in zip(drawn, gradient):
            self.assertAlmostEqual(given, want, places=14)


class Refusals(ScratchTest):
    def refused(self, call, words):
        self.assertIn(words, self.refusal(HEAD + BODY + MODE + call, 8))

    def test_what_is_no_drawing_is_refused_with_its_line(self):
        self.refused('model.draw("b", [(x, 0)], kind="ball")', "there is no kind `ball`; write one of body,")
        self.refused('model.draw("b", [(x, 0)])', "a `body` has at least 3 points, not 1")
        self.refused('model.draw("b", [(x, 0), (0, 0), (1, 0)], kind="spring")', "a `spring` has 2 points, not 3")
        self.refused('model.draw("b", [x, 0], kind="line")', "points are a list of pairs (X, Y)")
        self.refused('model.draw("b", [(x, k)], kind="point")', "the term `k` has the dimension")
        self.refused('model.draw("b", [(x.rate, 0)], kind="point")', "`x.rate` is no coordinate, parameter or discrete state")
        self.refused('model.draw("b", [(x, 0), (0, 0)], kind="line", radius=x)', "only a `point` has a radius")
        self.refused('model.draw("b", [(x, 0)], kind="point", force=(x, None))', "only a `contact` has a force and states")
        self.refused('model.draw("b", [(x, 0)], kind="contact", force=x)', "its force is a pair")
        self.refused('model.draw("b", [(x, 0)], kind="contact", force=(k, None))', "not a coordinate or a prescribed motion")
        self.refused('model.draw("b", [(x, 0)], kind="contact", states=[(model.modes[0], "shut")])', "there is no state 'shut'")
        self.refused('model.draw("b", [(x, 0)], kind="contact", states=[("m", "closed")])', "not a mode")
        self.refused('model.draw("b", [(x, 0)], kind="contact", of="wall")', "there is no contact, friction or constraint the text 'wall'")
        self.refused('model.draw("b", [(x, 0)], kind="contact", along=[(1, 0)])', "`along` belongs to `of`")
        self.refused('model.contact("w", gap=x); model.draw("b", [(x, 0)], kind="contact", of="w", along=[(1, 0), (0, 1)])',
                     "`along` has 2 directions, but the forces of `w` are `w.normal`")
        self.refused('model.contact("w", gap=x); model.draw("b", [(x, 0)], kind="contact", of="w", along=[(x, 0)])', "has the dimension m")
        self.refused('model.contact("w", gap=x); model.draw("b", [(x, 0)], kind="point", of="w")', "`of` is for a `contact`")
        self.refused('model.draw(7, [(x, 0)], kind="point")', "the name of what is drawn is a text, not 7")
        self.refused('model.draw("b\\x07", [(x, 0)], kind="point")', "holds U+0007: write one line of printable characters")


if __name__ == "__main__":
    unittest.main()
