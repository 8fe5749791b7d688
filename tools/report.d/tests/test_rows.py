"""A lost claim is reported: made-up measurements, no peers, no processes."""

import json
import unittest

from report import markdown, plots
from report.rows import Contest, Missing, Promise, Report, Run, Section, Table


def contest(ours, theirs, claim="ahead", **more):
    return Contest("first picture, part.step", "Viewer", "ms", ours, theirs, claim, **more)


def report(*contests, promises=(), failure=""):
    run = Run("tools/report", "2026-01-01", "a machine", "a device", "abc", "0.1", {"Viewer": "1.0"})
    made_up = {"contests": list(contests), "promises": list(promises), "failure": failure}
    return Report([Section(1, "Made up", "", "made_up", run, **made_up)])


WON = contest([100, 110, 105], [300, 280, 330])
LOST = contest([300, 280, 330], [100, 110, 105])
NOISY = contest([100, 200, 300], [210, 180, 150])


class Verdicts(unittest.TestCase):
    def test_verdicts_follow_the_interval(self):
        self.assertEqual([c.verdict() for c in (WON, LOST, NOISY)], ["ahead", "behind", "even"])

    def test_a_lost_claim_fails_the_run(self):
        self.assertEqual(report(WON).exit_status(), 0)
        self.assertEqual(report(WON, LOST).exit_status(), 1)

    def test_a_loss_within_the_noise_does_not_fail_the_run(self):
        # two of three rounds were lost, by less than they differ
        self.assertEqual(report(NOISY).exit_status(), 0)

    def test_a_lost_contest_without_a_claim_does_not_fail_the_run(self):
        self.assertEqual(report(contest(LOST.ours, LOST.theirs, "open")).exit_status(), 0)

    def test_a_broken_promise_fails_the_run(self):
        self.assertEqual(report(promises=[Promise("pixels", 0, 100)]).exit_status(), 0)
        self.assertEqual(report(promises=[Promise("pixels", 1, 100)]).exit_status(), 1)

    def test_a_known_exception_is_reported_and_does_not_fail_the_run(self):
        known = report(promises=[Promise("pixels", 7, 100, known="docs/accuracy.md says so", most=0.07)])
        self.assertEqual(known.exit_status(), 0)
        self.assertIn("pixels: 7 of 100; docs/accuracy.md says so", markdown.text(known, {}))

    def test_more_than_the_exception_allows_fails_the_run(self):
        known = report(promises=[Promise("pixels", 8, 100, known="docs/accuracy.md says so", most=0.07)])
        self.assertEqual(known.exit_status(), 1)
        self.assertNotIn("known: ", markdown.text(known, {}))

    def test_a_section_that_failed_fails_the_run(self):
        self.assertEqual(report(WON, failure="the program ended with status 3").exit_status(), 1)

    def test_two_rounds_are_no_verdict(self):
        two = contest([1, 1], [9, 9])
        self.assertEqual((two.verdict(), two.lost()), ("not measured", False))
        self.assertIn("rounds: 2", two.reason())

    def test_exact_quantities_need_no_rounds(self):
        self.assertEqual(contest([5.0], [4.0], exact=True).verdict(), "behind")
        self.assertEqual(contest([4.0], [4.0], exact=True).verdict(), "even")

    def test_a_row_has_a_figure_or_a_reason(self):
        self.assertRaises(ValueError, contest, [], [])
        self.assertRaises(ValueError, contest, [1.0], [])
        self.assertRaises(ValueError, contest, [0.0], [1.0])
        self.assertRaises(ValueError, contest, [], [], unreached=True)
        self.assertEqual(contest([], [], why="not installed").verdict(), "not measured")
        self.assertEqual(contest([], [], unreached=True, why="not within 5 s").verdict(), "unreached")


class Plots(unittest.TestCase):
    def test_ticks_are_plain_numbers(self):
        told = [plots.plain(value) for value in (1e-6, 0.05, 1.5, 20, 10_000, 1e6)]
        self.assertEqual(told, ["1e-6", "0.05", "1.5", "20", "10,000", "1e6"])


class Written(unittest.TestCase):
    def test_losses_come_first(self):
        text = markdown.text(report(WON, LOST), {})
        first = text.index("## Where we lose")
        self.assertLess(first, text.index("## 1. Made up"))
        self.assertIn("**lost**", text[first : text.index("## 1. Made up")])

    def test_a_loss_stands_under_the_measurement_that_explains_it(self):
        caused = contest(LOST.ours, LOST.theirs, "open", cause="a process takes 0.4 s")
        text = markdown.losses(report(contest(LOST.ours, LOST.theirs, "open"), caused))
        unexplained, explained = text.split("Cause: a process takes 0.4 s.")
        self.assertIn("No measurement explains these:\n\n* 1. first picture", unexplained)
        self.assertIn("* 1. first picture", explained)

    def test_a_lost_claim_has_its_cause(self):
        lost = contest(LOST.ours, LOST.theirs, cause="a process takes 0.4 s")
        self.assertRegex(markdown.losses(report(lost)), r"\*\*lost\*\*: .*Its cause: a process takes 0.4 s")

    def test_a_loss_at_several_errors_is_one_line(self):
        at = lambda error, theirs: Contest(f"frame, a.step, within {error} px", "Viewer", "ms", [9.0] * 3, [theirs] * 3)
        text = markdown.losses(report(at(0.25, 3.0), at(0.5, 1.0), at(1, 4.5)))
        self.assertEqual(text.count("* 1. frame"), 1)
        figures = "within 0.5 px: 9.00 ms beside 1.00 ms of Viewer, ratio 0.11 [0.11, 0.11]"
        self.assertIn(f"{figures}; also within 0.25 px, 1 px", text)

    def test_losses_and_claims_are_counted(self):
        even = contest(NOISY.ours, NOISY.theirs, "open")
        absent = contest([], [], why="not installed")
        text = markdown.text(report(WON, LOST, even, absent), {})
        lose, claim = text.split("## What we claim")
        row = "| 1. first picture | 1 | {} | 1 | 1 | 0.33 [0.32, 0.39], Viewer |"
        self.assertIn(row.format(1), lose)
        self.assertIn(row.format(0), claim)
        named = report(WON)
        named.sections[0].name = "reading"
        self.assertIn("\n* 1. reading, beside Open CASCADE: every file", markdown.text(named, {}))
        nothing = markdown.text(report(contest(WON.ours, WON.theirs, "open")), {})
        self.assertIn("## What we claim\n\nNothing in these sections.", nothing)

    def test_each_section_has_its_run_and_time(self):
        whole = report(WON)
        whole.sections[0].seconds, whole.sections[0].given = 61.0, 80.0
        run = "Measured 2026-01-01, commit abc, {}, by `tools/report`. a machine, load 0.1; a device."
        self.assertIn(run.format("61 s of the 80 s that it is given"), markdown.text(whole, {}))
        whole.sections[0].seconds, whole.sections[0].given = 330.0, 300.0
        self.assertIn(run.format("5.5 min of the 5.0 min that it is given"), markdown.text(whole, {}))

    def test_a_run_without_losses_states_it(self):
        self.assertIn("Nowhere in these sections.", markdown.text(report(WON), {}))

    def test_a_missing_figure_has_a_reason(self):
        whole = report(contest([], [], why="the viewer is not installed"))
        whole.sections[0].tables.append(Table("", ["a", "b"], [[1, Missing("no room")]]))
        whole.sections[0].run.peers["Other"] = Missing("pip found no such package")
        text = markdown.text(whole, {})
        absent = text[text.index("## What was not measured") : text.index("## 1. Made up")]
        for why in ("the viewer is not installed", "no room", "pip found no such package"):
            self.assertIn(why, absent)

    def test_json_holds_the_verdicts(self):
        data = json.loads(json.dumps(report(WON, LOST, promises=[Promise("pixels", 2, 9)]).as_json()))
        rows = data["sections"][0]["contests"]
        self.assertEqual([(row["verdict"], row["lost"]) for row in rows], [("ahead", False), ("behind", True)])
        self.assertTrue(data["sections"][0]["promises"][0]["broken"])
        self.assertEqual((data["schema"], data["exit_status"]), (2, 1))

    def test_a_table_of_uneven_rows_is_refused(self):
        self.assertRaises(ValueError, Table, "", ["a", "b"], [[1]])


if __name__ == "__main__":
    unittest.main()
