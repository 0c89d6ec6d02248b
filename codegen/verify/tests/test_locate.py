"""Without energies: objections are findings, and located by the single edits with which they vanish."""

import json
import unittest
from dataclasses import replace

from codegen.verify import seeded
from codegen.verify.judgements.subject import Subject
from codegen.verify.load import load
from codegen.verify.repairs.locate import _with, locate
from codegen.verify.report import gather as report, html, machine, text
from codegen.verify.report.findings import judge


class Location(unittest.TestCase):
    def seeded_in(self, name, step):
        """(seed, subject, mutated subject) of the errors that are seen without energies."""
        case = load(seeded.EXAMPLES / name, name)
        subject = Subject(case.paper)
        for seed in list(seeded.seeds(name, case.paper, subject))[::step]:
            equation = case.paper.equations[seed.equation]
            mutated = Subject(case.paper.with_equations([replace(equation, function=seed.terms, latex="")]), subject)
            if any(judge(mutated, None).values()):
                yield seed, subject, mutated

    def test_the_slip_is_among_the_edits_that_are_named(self):
        # what is lost with all that belongs to it (the only inertia of a coordinate) leaves no trace
        lost = 0
        for name, step in (("double_pendulum", 9), ("rocking_block", 7)):
            for seed, subject, mutated in self.seeded_in(name, step):
                locations, left = locate(mutated)
                right = [number == seed.equation and _with(mutated, number, repair).total(number) == subject.total(number)
                         for found in locations for number, repair in found.candidates]
                lost += not any(right)
                if seed.kind != "dropped term":
                    self.assertTrue(any(right) and len(locations) == 1 and not left, (name, seed))
        self.assertLessEqual(lost, 2)

    def test_every_edit_that_is_named_does_what_is_said(self):
        for seed, _, mutated in self.seeded_in("rocking_block", 6):
            before = sum(map(len, judge(mutated, None).values()))
            for number, repair in locate(mutated)[0][0].candidates:
                self.assertLess(sum(map(len, judge(_with(mutated, number, repair), None).values())), before, seed)

    def test_right_equations_have_nothing_to_locate(self):
        for name in ("double_pendulum", "rocking_block", "tank"):
            self.assertEqual(locate(Subject(load(seeded.EXAMPLES / name, name).paper)), ([], []))

    def test_the_reports_name_the_edits_and_do_not_call_them_consistent(self):
        case = load(seeded.EXAMPLES / "double_pendulum", "double_pendulum")
        equation = case.paper.equations["2"]
        wrong = replace(equation, latex="", function=lambda s, m: [*equation.function(s, m)[:2], -equation.function(s, m)[2],
                                                                   equation.function(s, m)[3]])
        result = report.verify(replace(case, paper=case.paper.with_equations([wrong]), energies=[]))
        self.assertEqual([f.key for f in result.findings], ["slip-1"])
        written = json.loads(machine.as_json(result))["findings"][0]
        self.assertEqual((written["consistent"], written["proved"]), (None, False))
        self.assertIn(("2", [3], "sign"), [(edit["equation"], edit["term"], edit["slip"]) for edit in written["possible"]])
        for page in (text.as_text(result), html.as_html(result)):
            self.assertIn("1 finding; not judged: term by term against the energies", page)
            self.assertIn("would remove it and raise no other: (2) term 3", page)
            self.assertIn("consistent: not known", page)


if __name__ == "__main__":
    unittest.main()
