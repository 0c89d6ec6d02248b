"""Contacts: the modes and transitions that follow from them, and mistakes in their declaration."""

import os
import unittest

from codegen.generate import load
from codegen.tests.scratch import BODY, HEAD, ScratchTest
from codegen.tests.test_derivation import ROOT

TWO = HEAD + 'y = model.coordinate("y", "m", "height")\nmodel.point_mass(m, position=(x, y))\n'
"""Seven lines: a mass in the plane."""

MISTAKES = (
    ("a gap that is not smooth", 'model.contact("floor", gap=abs(y) - x)\n', "`fabs` is not smooth"),
    ("a gap that nothing changes", 'model.contact("floor", gap=k)\n', "contact `floor`: its gap, `k`, does not depend on any coordinate"),
    ("a gap of rates", 'model.contact("floor", gap=y.rate)\n', "depends on `y.rate`"),
    ("a constraint that is there twice", 'model.constraint("rod", (x * y, 2 * x * y))\n',
     "constraint `rod.2`: it depends on those before it (`rod.1`): of 2 equations 1 are independent"),
    ("a constraint of two dimensions", 'model.constraint("rod", x * y - x)\n', "constraint `rod`: terms of different dimension"),
    ("a gap as a text", 'model.contact("floor", gap="y")\n', "contact `floor`: its gap: the text 'y' is not an expression"),
    ("a gap of another unit", 'model.contact("floor", gap=y + m)\n',
     "contact `floor`: its gap: terms of different dimension are added"),
    ("friction by a normal force of another unit, by multipliers",
     'model.multipliers(); model.friction("base", slip=x, normal=m, kinetic=0.2)\n',
     "friction of `base`: a coefficient times the normal force has the dimension kg, but along the slip it is kg m/s^2"),
    ("friction without a slip", 'model.contact("floor", gap=y, kinetic=0.2)\n', "it has friction but no `slip`"),
    ("a slip without friction", 'model.contact("floor", gap=y, slip=x)\n', "`slip` is given, but no coefficient `kinetic`"),
    ("static friction alone", 'model.contact("floor", gap=y, slip=x, static=0.3)\n',
     "`static` is given, but no coefficient `kinetic`; one coefficient for both is `kinetic` alone"),
    ("friction without a coefficient", 'model.friction("base", slip=x, normal=k)\n', "`slip` is given, but no coefficient `kinetic`; without friction leave it out"),
    ("two frictions along one coordinate",
     'model.friction("a", slip=x, normal=k, kinetic=0.2); model.friction("b", slip=x, normal=k, kinetic=0.2)\n',
     "friction `b`: `a` slips along `x` too"),
    ("two contacts of one name", 'model.contact("a", gap=y); model.contact("a", gap=x)\n',
     "contact `a`: there is a contact, a friction or a ratchet of this name above"),
    ("a slip turned back that is none", 'model.contact("floor", gap=y, tangential_restitution=0.5)\n', "but no `slip` that it would turn back"),
    ("a law of a contact that is none", 'model.impact("floor", [(y.rate, -y.rate)])\n', "impact: there is no contact `floor` with a gap above"),
    ("a ratchet in a place", 'model.ratchet("pawl", rate=x)\n', "ratchet `pawl`: its rate, `x`, does not depend on the rate of any coordinate"),
    ("a ratchet in a square", 'model.ratchet("pawl", rate=x.rate**2)\n', "is not linear in the rates"),
    ("a constraint in a square", 'model.constraint("blade", x.rate * y.rate)\n', "is not linear in the rates"),
    ("a law of a ratchet", 'model.ratchet("pawl", rate=x.rate); model.impact("pawl", [(x.rate, x.rate)])\n',
     "impact: there is no contact `pawl` with a gap above"),
    ("a chart without contacts", 'model.chart("other", when=falls(x), reset=[(x, -x)])\n', "chart `other`: the model has no contacts"),
    ("a chart that changes nothing", 'model.contact("a", gap=y + x); model.chart("other", when=falls(x), reset=[])\n',
     "chart `other`: `reset` is empty"),
    ("a chart of no guard", 'model.contact("a", gap=y + x); model.chart("other", when=x, reset=[(x, -x)])\n',
     "chart `other`: `when` must be falls(…) or rises(…)"),
    ("a law for what sticks that is no list of rates",
     'model.contact("a", gap=y); model.impact("a", [(y.rate, -y.rate)], held=[(x, x)])\n',
     "impact of `a` while others stick: `x` is not the rate of a coordinate"),
    ("sides that are no discrete state", 'model.contact("a", gap=y, sides=k)\n', "contact `a`: `sides` is `k`, not a discrete state"),
    ("sides with a slip", 'side = model.discrete("side", (1, -1), ""); model.contact("a", gap=y, slip=x, kinetic=1, sides=side)\n',
     "contact `a`: it opens to two sides and has a slip"),
    ("sides of a gap that is no coordinate", 'side = model.discrete("side", (1, -1), ""); model.contact("a", gap=y + x, sides=side)\n',
     "contact `a`: it opens to two sides, so that its gap is a coordinate"),
    ("sides by multipliers", 'side = model.discrete("side", (1, -1), ""); model.contact("a", gap=y, sides=side); model.multipliers()\n',
     "contact `a`: a gap that opens to two sides needs a model in which every gap, slip and constraint is a coordinate; here multipliers are asked for"),
    ("sides beside a constraint", 'side = model.discrete("side", (1, -1), ""); model.contact("a", gap=y, sides=side); model.constraint("rod", x * y)\n',
     "here `rod` does not solve for a coordinate"),
    ("what every mode requires of nothing held", 'model.contact("a", gap=y); model.requires(None, model.reaction(x), "slips")\n',
     "what every mode requires: `x` is free in each, so that there is no reaction"),
    ("a mode that freezes beside contacts", 'model.contact("a", gap=y)\nmodel.mode("lies", freeze=[x])\n', "mode `lies` freezes `x`"),
)


def modes(model):
    return [mode.name for mode in model.modes]


def arrows(model):
    return {(t.name, t.source.name, t.target.name) for t in model.transitions}


class Contacts(ScratchTest):
    def test_mistakes_are_told_with_their_line(self):
        for what, text, message in MISTAKES:
            with self.subTest(what):
                line = 9 if "model.mode" in text else 8
                self.assertIn(message, self.refusal(TWO + text, line))

    def test_many_sets_of_states_share_one_mode(self):
        lines = [HEAD, BODY]
        for k in range(5):
            lines.append(f'y{k} = model.coordinate("y{k}", "m", "")\nmodel.point_mass(m, position=(0, y{k}))\n')
        lines += [f'model.contact("c{k}", gap=y{k})\n' for k in range(5)]
        model, = self.loaded("".join(lines))
        self.assertEqual(modes(model), ["moves"])

    def test_friction_in_an_impact_on_two_contacts_takes_multipliers(self):
        text = HEAD + ('y = model.coordinate("y", "m", "")\nmodel.point_mass(m, position=(x, y))\nmodel.point_mass(m, position=(x, 0))\n'
                       'model.kinetic(m * x.rate * y.rate)\nmodel.contact("floor", gap=y)\nmodel.contact("wall", gap=x, slip=y, kinetic=0.1)\n')
        model, = self.loaded(text)
        self.assertEqual(modes(model), ["moves"])
        self.assertEqual([c.name for c in model.coordinates], ["x", "y", "floor.normal", "wall.normal", "wall.friction"])

    def test_gaps_of_several_coordinates_take_multipliers(self):
        described = self.described(TWO + 'model.contact("floor", gap=x + 2 * y, slip=x, kinetic=0.1)\n')
        contact, = described["variants"][0]["modes"][0]["contacts"]["contacts"]
        self.assertEqual((contact["name"], contact["normal"], contact["tangent"]), ("floor", 2, 3))
        self.assertEqual(described["coordinates"][2]["reaction_unit"], "N")

    def test_laws_of_the_model_are_checked(self):
        floor = TWO + 'model.contact("floor", gap=y)\n'
        for rates, message in (
            ("[(y, -y.rate)]", "is not the rate of a coordinate"),
            ("[(y.rate, y)]", "impact of `floor`: `y.rate`: terms of different dimension"),
            ("[(y.rate, abs(y.rate))]", "`fabs` is not smooth"),
            ("[(y.rate, y.acceleration)]", "depends on `y.acceleration`"),
            ("[]", "it lists no rates"),
        ):
            with self.subTest(rates):
                self.assertIn(message, self.refusal(floor + f'model.impact("floor", {rates})\n', 9))

    def test_a_law_of_the_model_takes_multipliers(self):
        text = TWO + 'model.contact("floor", gap=y)\nmodel.impact("floor", [(y.rate, -y.rate / 2)])\n'
        contact, = self.described(text)["variants"][0]["modes"][0]["contacts"]["contacts"]
        self.assertEqual(contact["law"], [1])

    def test_charts_lead_back_to_each_mode_and_gaps_depend_on_discrete_states(self):
        text = TWO + ('side = model.discrete("side", (1, -1), "")\n'
                      'model.contact("a", gap=y + (1 - side) * x)\n'
                      'one, two = model.mode("one"), model.mode("two")\n'
                      'model.chart("other", when=falls(x), reset=[(side, -side), (x, -x), (y, y + 2 * x)])\n')
        model, = self.loaded(text)
        self.assertEqual(arrows(model), {("other", "one", "one"), ("other", "two", "two")})
        self.assertTrue(all(t.is_chart for t in model.transitions))

    def test_a_law_may_be_another_where_all_sticks(self):
        law = 'model.contact("a", gap=y, slip=x, kinetic=1)\nmodel.impact("a", [(y.rate, -y.rate), (x.rate, 0 * x.rate)]%s)\n'
        for given, count in (("", 2), (", held=[(y.rate, -y.rate)]", 1), (", held=[]", 0)):
            contact = self.loaded(TWO + law % given)[0].contacts[0]
            self.assertEqual((len(contact.law), len(contact.held_law)), (2, count))

    def test_multipliers_can_be_asked_for(self):
        model, = self.loaded(TWO + 'model.contact("floor", gap=y)\nmodel.multipliers()\n')
        self.assertEqual(modes(model), ["moves"])

    def loaded(self, text):
        with open(os.path.join(self.folder, "model.py"), "w", encoding="utf-8") as stream:
            stream.write(text)
        return load(self.folder)

    def test_modes_are_sets_of_states(self):
        hopper, = load(os.path.join(ROOT, "tests", "models", "contact_hopper"))
        self.assertEqual(modes(hopper), ["table open", "table sticks", "table slides"])
        self.assertLessEqual({
            ("table strikes", "table open", "table open"),
            ("table opens", "table sticks", "table open"),
            ("table opens", "table slides", "table open"),
            ("table slips", "table sticks", "table slides"),
            ("table sticks", "table slides", "table sticks"),
            ("table reverses", "table slides", "table slides"),
        }, arrows(hopper))

    def test_a_gap_with_sides_opens_to_either_and_goes_on_on_the_other(self):
        text = TWO + ('side = model.discrete("side", (1, -1), "")\ne = model.parameter("e", "1", 0.5, "")\n'
                      'model.contact("a", gap=y, restitution=e, sides=side)\n')
        model, = self.loaded(text)
        opens = [t for t in model.transitions if t.name == "a opens"]
        self.assertEqual([[float(value) for _, value in t.reset] for t in opens], [[1.0], [-1.0]])
        strikes, = (t for t in model.transitions if t.name == "a strikes")
        changed = {symbol.name(): str(value) for symbol, value in strikes.reset}
        self.assertEqual((strikes.target.name, changed["side"]), ("a open", "(-side)"))

    def test_constraints_that_hold_a_coordinate_or_a_rate_freeze_it(self):
        drive = ('w = model.parameter("w", "m/s", 2, "")\nmodel.constraint("rail", y)\n'
                 'model.constraint("drive", x.rate - w)\n')
        plane = ('z = model.coordinate("z", "m", "")\nmodel.point_mass(m, position=(z, 0))\n'
                 'model.contact("a", gap=z)\n')
        for contact, names in (("", ["moves"]), (plane, ["a open", "a closed"])):
            model, = self.loaded(TWO + drive + contact)
            self.assertEqual(modes(model), names)
            for mode in model.modes:
                self.assertLessEqual({"x", "y"}, mode.held.keys())
                self.assertEqual(list(mode.drift), ["x"])
        self.assertEqual([o.name for o in model.outputs if o.name.endswith("force")], ["rail.force", "drive.force"])

    def test_a_coordinate_that_two_hold_takes_multipliers(self):
        model, = self.loaded(TWO + 'model.constraint("rail", y)\nmodel.contact("a", gap=y)\n')
        self.assertEqual(modes(model), ["moves"])
        self.assertIsNotNone(model.modes[0].form)

    def test_what_every_mode_requires_is_asked_where_it_is_held(self):
        model, = self.loaded(TWO + 'model.contact("a", gap=y)\nmodel.requires(None, 1 - model.reaction(y) / (k * x), "breaks")\n')
        self.assertEqual({mode.name: len(mode.requirements) for mode in model.modes}, {"a open": 0, "a closed": 1})

    def test_what_is_always_plastic_needs_no_rest(self):
        text = TWO + 'model.contact("floor", gap=y)\n'
        model, = self.loaded(text)
        self.assertIn(("floor strikes", "floor open", "floor closed"), arrows(model))

    def test_a_gap_bounds_its_coordinate(self):
        described = self.described(TWO + 'd = model.parameter("d", "m", 1, "")\nmodel.contact("roof", gap=d - y)\n')
        self.assertIn("d", str(described["variants"][0]))


if __name__ == "__main__":
    unittest.main()
