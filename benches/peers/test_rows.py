"""Tests of what run.py makes of the rows that the peers print: python3 benches/peers/test_rows.py."""

import unittest

import ensemble
from rows import best, collect, frontier, least, least_costs, merged, table, with_summary
from run import is_there

REFERENCES = {
    "P1": {"scales": [0.2, 0.5], "t_end": "6.0", "y_end": ["1.0", "2.0"], "events": ["0.5", "1.5"]},
    "P4S": {"scales": [1, 1e-9, 1, 1], "t_end": "2.0", "y_end": ["1", "0", "0", "0"], "events": ["0.5"]},
    "P5": {"scales": [1, 4], "t_end": "4.0", "y_end": ["0", "2"], "events": ["4.0"]},
    "free": {"scales": [1], "t_end": "0.5", "y_end": ["0"], "events": ["0.1", "0.2", "0.3"], "least_events": {"0.001": 2}},
}


def printed(problem="P1", tolerance="1e-3", status=0, time="6", y="1.02;2", events="0.5;1.5001", seconds="3e-6"):
    return f"a|m|{problem}|{tolerance}|{seconds}|4e-6|7|10|2|5|{status}|{time}|{y}|{events}"


def row(peer, least, error, verdict="ok", problem="P1"):
    return {"peer": peer, "method": "m", "problem": problem, "tolerance": "0.001", "least_us": str(least), "end_error": str(error), "verdict": verdict}


class Collect(unittest.TestCase):
    def test_errors_are_in_scales_and_times_in_microseconds(self):
        got = collect(printed(), REFERENCES)
        self.assertEqual((got["verdict"], got["end_error"], got["event_time_error"]), ("ok", "1.00e-01", "1.00e-04"))
        self.assertEqual((got["least_us"], got["median_us"], got["tolerance"], got["events"], got["steps"]), ("3.00", "4.00", "0.001", "2", "5"))

    def test_a_missed_or_doubled_event_is_no_result(self):
        for events in ("0.5", "0.5;1.5;1.6", ""):
            got = collect(printed(events=events), REFERENCES)
            self.assertEqual((got["verdict"], got["end_error"]), ("wrong events", "nan"))

    def test_a_failed_run_is_no_result(self):
        self.assertEqual(collect(printed(status=-1), REFERENCES)["verdict"], "failed")

    def test_slaved_components_are_not_compared(self):
        got = collect(printed("P4S", y="1;5;0;7", events="0.5"), REFERENCES)
        self.assertEqual(got["end_error"], "0.00e+00")

    def test_the_ball_is_judged_by_when_it_ends_too(self):
        got = collect(printed("P5", time="4.25", y="9;2.4", events="4.0"), REFERENCES)
        self.assertEqual(got["end_error"], "2.50e-01")

    def test_landings_below_the_tolerance_may_be_left_out_but_no_others(self):
        verdicts = {tolerance: collect(printed("free", tolerance, y="0", events="0.1;0.2"), REFERENCES)["verdict"] for tolerance in ("1e-3", "1e-4")}
        self.assertEqual(verdicts, {"1e-3": "ok", "1e-4": "wrong events"})
        self.assertEqual(collect(printed("free", y="0", events="0.1"), REFERENCES)["verdict"], "wrong events")


class Best(unittest.TestCase):
    ROWS = [row("dalembert", 10, 1e-4), row("dalembert", 12, 1e-7), row("x", 4, 1e-2), row("x", 40, 1e-4), row("x", 30, 1e-5),
            row("y", 1, 1e-9, "wrong events"), row("y", 20, 1e-9, problem="P2")]

    def test_the_fastest_row_that_reaches_the_error(self):
        fastest = best(self.ROWS, "P1", 1e-3)
        self.assertEqual({peer: r["least_us"] for peer, r in fastest.items()}, {"dalembert": "10", "x": "30"})
        self.assertEqual({peer: r["least_us"] for peer, r in best(self.ROWS, "P1", 1e-6).items()}, {"dalembert": "12"})

    def test_the_table_has_ratios_to_the_best_peer_and_to_the_floor(self):
        floor = [row("floor(own)", 2, 1e-2), row("floor(own)", 5, 1e-4)]
        lines = table(self.ROWS + floor).splitlines()
        [line] = [one for one in lines if one.startswith("| P1 | 0.001 |")]
        self.assertEqual(line, "| P1 | 0.001 | 10.0 (m, 0.001) | 30.0 (m, 0.001) | – | 5.0 (m, 0.001) | 0.33 | 2.00 |")
        self.assertNotIn("floor", with_summary("| problem | error | dalembert / µs | best other / µs | ratio |\n\n\n", self.ROWS + floor))

    def test_the_table_of_the_readme_is_replaced_and_nothing_else(self):
        old = "| problem | error | dalembert / µs | best other / µs | ratio |\n|---|--:|--:|---|--:|\n| old |\n"
        got = with_summary(f"before\n\n{old}\nafter\n", self.ROWS)
        head = old.replace("| old |\n", "")
        self.assertEqual(got, f"before\n\n{head}| P1 | 1e-3 | 10.0 | 30.0 (x) | 0.33 |\n\nafter\n")
        with self.assertRaises(ValueError):
            with_summary("no table", self.ROWS)

    def test_the_frontier_leaves_out_what_is_both_slower_and_less_accurate(self):
        self.assertEqual(frontier([(1e-3, 5.0), (1e-6, 4.0), (1e-9, 9.0), (1e-2, 1.0)]), [(1e-9, 9.0), (1e-6, 4.0), (1e-2, 1.0)])


class Ensemble(unittest.TestCase):
    def test_the_fastest_that_reaches_the_error_counts(self):
        ours, heyoka = [[1e-3, 2e-6, 1e-2], [1e-6, 4e-6, 1e-7]], [[1e-3, 8, 9e-6, 1e-5], [1e-3, 16, 8e-6, 1e-5]]
        lines = ensemble.table(ours, heyoka).splitlines()
        self.assertEqual(lines[2], "| 0.001 | 4.00 (error 1e-07) | 8.00 (error 1e-05) | 0.50 |")
        self.assertEqual(lines[3], "| 1e-06 | 4.00 (error 1e-07) | – | – |")


class Resume(unittest.TestCase):
    def test_new_rows_take_the_place_of_those_of_the_same_peer_and_problem(self):
        old = [row("x", 1, 1, problem="P1"), row("x", 2, 1, problem="P2"), row("y", 3, 1, problem="P1")]
        got = merged(old, [row("x", 9, 1, problem="P1")])
        self.assertEqual(sorted((r["peer"], r["problem"], r["least_us"]) for r in got), [("x", "P1", "9"), ("x", "P2", "2"), ("y", "P1", "3")])

    def test_the_least_times_of_two_passes_count_where_the_steps_are_the_same(self):
        run = lambda time, problem, steps: row("x", time, 1, problem=problem) | {"steps": steps, "median_us": str(time)}
        old = [run(2, "P1", "5"), run(1, "P2", "7")]
        new = least(old, [run(9, "P1", "5"), run(9, "P2", "5")])
        self.assertEqual([r["least_us"] for r in new], ["2.00", "9.00"])

    def test_a_time_less_calls_is_the_least_time_less_the_least_cost(self):
        def run(peer, least):
            return {**row(peer, least, 1), "steps": "5", "median_us": least}

        def a_pass(full, less):
            return [run("h", full), run("h less calls", less)]

        # Calls of 20 and of 50, which something disturbed; the second pass alone was as fast without.
        for first, second in ((("60", "40"), ("62", "12")), (("62", "12"), ("60", "40"))):
            new = least(a_pass(*first), a_pass(*second))
            self.assertEqual([float(r["least_us"]) for r in new], [60, 40])
            self.assertEqual([float(r["median_us"]) for r in new], [60, 40])

    def test_the_least_costs_of_a_step_count_where_the_steps_are_the_same(self):
        head = "| problem | tolerance | method | steps | ns a step | own, ns | share |\n|---|--:|---|--:|--:|--:|--:|\n"
        old = head + "| P1 | 1e-3 | Taylor | 11 | 800 | 90 | 11 % |\n| P2 | 1e-3 | Taylor | 55 | 100 | 10 | 10 % |\n"
        new = head + "| P1 | 1e-3 | Taylor | 11 | 900 | 80 | 9 % |\n| P2 | 1e-3 | Taylor | 37 | 500 | 50 | 10 % |\n"
        both = head + "| P1 | 1e-3 | Taylor | 11 | 800 | 80 | 10 % |\n| P2 | 1e-3 | Taylor | 37 | 500 | 50 | 10 % |\n"
        self.assertEqual(least_costs(old, new), both)
        self.assertEqual(least_costs("", new), new)

    def test_what_is_missing_is_known_by_the_names_that_a_peer_prints(self):
        rows = [row("CVODE", 1, 1)]
        self.assertTrue(is_there(rows, "sundials", "P1"))
        self.assertFalse(is_there(rows, "sundials", "P2"))
        self.assertFalse(is_there(rows, "fortran", "P1"))


if __name__ == "__main__":
    unittest.main()
