"""Seeded errors in correct equations of three systems: every one is found, and by the judgements
that must find it; what is no error raises no objection."""

import unittest
from pathlib import Path

from codegen.verify import seeded


class SeededErrors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # run() itself fails if the unmutated equations raise an objection
        cls.results = seeded.run_all()
        cls.outcomes = [o for outcomes in cls.results.values() for o in outcomes]

    def describe(self, outcome):
        seed = outcome.seed
        return f"{seed.system} ({seed.equation}) term {seed.term + 1}: {seed.kind}"

    def test_every_kind_is_seeded_in_at_least_three_systems_or_where_it_exists(self):
        kinds = {name: {o.seed.kind for o in outcomes} for name, outcomes in self.results.items()}
        self.assertEqual(sorted(kinds), ["double_pendulum", "rocking_block", "tank"])
        for name, found in kinds.items():
            missing = set(seeded.KINDS) - found
            # the pendulum has no discrete state
            self.assertEqual(missing, {"missing discrete state"} if name == "double_pendulum" else set(), name)
        self.assertGreater(len(self.outcomes), 400)

    def test_every_error_is_found(self):
        for outcome in self.outcomes:
            if not outcome.equivalent:
                self.assertIn("difference", outcome.found, self.describe(outcome))

    def test_every_error_is_undone_and_named_and_nothing_else_is_found(self):
        for outcome in self.outcomes:
            if not outcome.equivalent:
                self.assertTrue(outcome.repaired, f"{self.describe(outcome)}: {outcome.repairs}")

    def test_the_counts_for_machines(self):
        data = seeded.as_dictionary(self.results)
        self.assertEqual({name: data[name] for name in ("seeded", "detected", "repaired", "rewritings", "false_alarms")},
                         {"seeded": 493, "detected": 493, "repaired": 493, "rewritings": 37, "false_alarms": 0})

    def test_what_changes_nothing_is_recognised_and_raises_no_objection(self):
        equal = [o for o in self.outcomes if o.equivalent]
        self.assertEqual({o.seed.kind for o in equal}, {"rewritten (no error)"})
        for outcome in self.outcomes:
            self.assertEqual(outcome.equivalent, outcome.seed.kind == "rewritten (no error)", self.describe(outcome))
            if outcome.equivalent:
                self.assertEqual((outcome.found, outcome.repairs), ([], []), self.describe(outcome))

    def test_judgements_find_what_they_must(self):
        must = {"lost dot": "dimensions", "lost power": "dimensions", "missing discrete state": "mirror",
                "dropped velocity term": "lagrangian", "asymmetric coupling": "lagrangian"}
        for outcome in self.outcomes:
            judgement = must.get(outcome.seed.kind)
            if judgement:
                self.assertIn(judgement, outcome.found, self.describe(outcome))

    def test_judgements_do_not_cry_wolf(self):
        # a slip that keeps every unit and every parity cannot be seen by dimensions or mirror
        for outcome in self.outcomes:
            if outcome.seed.kind in ("sign", "factor 2", "swapped symbol", "dropped term", "asymmetric coupling"):
                self.assertNotIn("dimensions", outcome.found, self.describe(outcome))
            if outcome.seed.kind in ("factor 2", "swapped symbol", "dropped term", "sign", "asymmetric coupling"):
                self.assertNotIn("mirror", outcome.found, self.describe(outcome))

    def test_most_slips_are_found_without_knowing_the_energies(self):
        errors = [o for o in self.outcomes if not o.equivalent]
        blind = [o for o in errors if set(o.found) - {"difference"}]
        self.assertGreater(len(blind), 0.7 * len(errors))

    def test_table_adds_up(self):
        for outcomes in self.results.values():
            rows = seeded.table(outcomes)
            self.assertEqual(sum(row[1] + row[2] for row in rows), len(outcomes))
            self.assertEqual([row[1] for row in rows], [row[3] for row in rows])

    def test_the_table_in_the_guide_is_this_one(self):
        guide = (Path(seeded.__file__).parents[2] / "docs" / "verification.md").read_text(encoding="utf-8")
        self.assertIn(seeded.as_text(self.results).split("all systems\n")[1].rstrip(), guide)


if __name__ == "__main__":
    unittest.main()
