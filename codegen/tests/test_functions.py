"""The table of functions, and what the engine looks for by its names."""

import os
import re
import unittest

from codegen import functions
from codegen.tests.scratch import HEAD, ScratchTest
from codegen.tests.test_derivation import ROOT


class Functions(ScratchTest):
    def test_the_engine_lists_the_functions_that_every_mode_has(self):
        with open(os.path.join(ROOT, "src", "kernel", "tables.rs"), encoding="utf-8") as stream:
            listed = re.search(r"^functions! \{([^}]*)\}", stream.read(), re.M).group(1)
        everywhere = [row.name for row in functions.MODE if not row.series and not row.is_counted]
        self.assertEqual(re.findall(r"\w+", listed), everywhere)

    def test_names_are_told_apart(self):
        rows = [*functions.MODE, *functions.GUARD, *functions.TRANSITION, functions.GUARDS_OF_MODE]
        self.assertEqual(len(functions.ROWS), len(rows))

    def test_each_row_is_emitted_and_found(self):
        text = HEAD + ('y = model.coordinate("y", "m", "height")\nmodel.point_mass(m, position=(x, y))\n'
                       'model.contact("floor", gap=x + y)\nrests, moves = model.mode("rests"), model.mode("moves")\n'
                       'model.transition("go", rests, moves, when=falls(x * y), provided=y)\n')
        mode = self.described(text)["variants"][0]["modes"][0]
        # One that holds along a line has what modes with multipliers have not.
        held = self.described(HEAD + 'y = model.coordinate("y", "m", "height")\nmodel.point_mass(m, position=(x, y))\n'
                              'model.constraint("line", x + y)\n')["variants"][0]["modes"][0]
        # Of walls that move alone impulses are carried.
        moved = self.described(HEAD + 'z = model.motion("z", "a wall", input="a")\nmodel.point_mass(m, position=(x, 0 * x))\n'
                               'model.contact("wall", gap=x - z)\n')["variants"][0]["modes"][0]
        self.assertIsNone(mode["kernel"]["carried"])
        for row in functions.OF_EACH_MODE:
            kernel = {"roundings": held, "carried": moved}.get(row.name, mode)["kernel"]
            self.assertIsNotNone(kernel[row.name], row.name)
        guard = mode["guards"][-1]
        for row in functions.GUARD:
            self.assertIsNotNone(guard[row.name], row.name)
        # Impacts of the reduced form alone say their impulses.
        struck = self.described(HEAD + 'model.point_mass(m, position=(x, 0 * x))\nmodel.contact("floor", gap=x)\n')
        strikes = struck["variants"][0]["modes"][0]["guards"][0]
        for row in functions.TRANSITION:
            of = strikes if row.name == "impulses" else guard
            self.assertIsNotNone(of["transitions"][0][row.name], row.name)


if __name__ == "__main__":
    unittest.main()
