"""Contacts that scenes switch, and contacts that only some choices have."""

import os

from codegen import generate
from codegen.align import align
from codegen.tests.scratch import HEAD, ScratchTest

PLANE = HEAD + 'y = model.coordinate("y", "m", "height")\nmodel.point_mass(m, position=(x, y))\n'


class Switches(ScratchTest):
    def loaded(self, text):
        with open(os.path.join(self.folder, "model.py"), "w", encoding="utf-8") as stream:
            stream.write(text)
        return generate.load(self.folder)

    def test_a_contact_is_on_off_or_permanent(self):
        on, off, permanent = self.loaded(PLANE + 'model.contact("floor", gap=y, slip=x, kinetic=0.2, switch=True)\n')
        names = [[mode.name for mode in model.modes] for model in (on, off, permanent)]
        self.assertEqual(names, [["floor open", "floor sticks", "floor slides"], ["moves"], ["floor sticks"]])
        self.assertEqual(permanent.transitions, [])

    def test_what_is_off_leaves_no_trace_where_it_alone_is_derived(self):
        text = PLANE + 'model.contact("wall", gap=x + y, switch=True)\nmodel.contact("floor", gap=y - x)\n'
        self.loaded(text)
        files = generate.generate(self.folder, named={"contacts.wall": "off"})
        self.assertNotIn("wall.normal", "".join(text for name, text in files.items() if name.endswith(".c")))
        on = generate.generate(self.folder, named={"contacts.wall": "on"})
        self.assertIn("wall.normal", "".join(text for name, text in on.items() if name.endswith(".c")))

    def test_a_permanent_contact_by_multipliers_holds_gap_and_slip_by_constraints(self):
        text = PLANE + 'model.contact("wall", gap=x + y, slip=x - y, kinetic=0.2, switch=True)\n'
        *_, permanent = self.loaded(text)
        self.assertEqual([c.name for c in permanent.modes[0].form.constraints], ["wall.gap", "wall.slip"])
        names = ["wall.gap", "wall.slip", "wall.normal", "wall.friction", "wall.normal_impulse", "wall.friction_impulse"]
        self.assertEqual([o.name for o in permanent.outputs], names)

    def test_impulses_are_outputs_and_say_whose_rates_they_are(self):
        text = PLANE + ('model.contact("wall", gap=x + y, slip=x - y, kinetic=0.2)\n'
                        'model.constraint("rail", x - 2 * y)\n')
        model, = self.loaded(text)
        impulses = [(o.name, o.unit) for o in model.outputs if o.name.endswith("impulse")]
        self.assertEqual(impulses, [("wall.normal_impulse", "N s"), ("wall.friction_impulse", "N s"), ("rail.impulse", "N s")])
        multipliers = [c.extra["impulse"] for c in model.coordinates if "multiplier" in c.extra]
        self.assertEqual([o.name for o in multipliers], [name for name, _ in impulses])

    def test_a_law_of_impact_of_a_contact_that_is_off_or_permanent_is_none(self):
        text = PLANE + 'model.contact("floor", gap=y, switch=True)\nmodel.impact("floor", [(y.rate, -y.rate / 2)])\n'
        on, off, permanent = self.loaded(text)
        self.assertEqual([[mode.name for mode in model.modes] for model in (on, off, permanent)],
                         [["moves"], ["moves"], ["floor closed"]])

    def test_what_held_for_good_contradicts_itself_is_not_offered(self):
        text = PLANE + "".join(f'model.contact("{name}", gap={gap}, switch=True)\n' for name, gap in (("a", "x + y"), ("b", "x - y"), ("c", "y - 2 * x")))
        offered = [[c[3] for c in model.choices] for model in self.loaded(text)]
        self.assertEqual(len(offered), 26)
        self.assertNotIn(["permanent"] * 3, offered)
        self.assertIn("constraint `c`: it depends", self.refusal(PLANE + 'model.constraint("a", x + y); model.constraint("b", x - y); model.constraint("c", x)\n', 8))

    def test_a_gap_bounds_its_coordinate_where_it_is_there(self):
        text = PLANE + 'model.contact("floor", gap=y, switch=True)\n'
        described = self.described(text)
        y = next(c for c in described["coordinates"] if c["name"] == "y")
        self.assertIsNone(y["minimum"])
        bounds = [[bound["text"] for bound in variant["bounds"]] for variant in described["variants"]]
        self.assertEqual(bounds, [["0"], [], ["0"]])
        y, = [c for c in self.described(text.replace(", switch=True", ""))["coordinates"] if c["name"] == "y"]
        self.assertEqual(y["minimum"], 0.0)

    def test_choices_share_the_multipliers_of_all(self):
        text = PLANE + ('joint = model.choice("joint", ["pin", "play"], "")\n'
                        'if joint == "pin":\n    model.constraint("pin", (x + y, x - y))\n'
                        'else:\n    model.contact("pin", gap=k - x - y, slip=x - y, kinetic=0.2)\n').replace("gap=k - x - y", "gap=-x - y")
        models = self.loaded(text)
        align(models)
        for kind in ("coordinates", "discretes"):
            first, second = [[entry.name for entry in getattr(model, kind)] for model in models]
            self.assertEqual(first, second)
        # Outputs are those of what is there.
        self.assertEqual([sorted(o.name for o in model.outputs if not o.name.startswith("pin.")) for model in models], [[], []])
        self.assertIn("pin.gap", [o.name for o in models[1].outputs])
        self.assertNotIn("pin.gap", [o.name for o in models[0].outputs])
        self.assertEqual(len(models[0].modes[0].form.idle), 2)
        generate.check_same_declarations(models)
