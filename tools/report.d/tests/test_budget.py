"""The report keeps to its time, on a machine that does nothing but let a clock run."""

import contextlib
import io
import json
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

from report import __main__ as report
from report import budget, peers
from report.context import Context
from report.peers import NOT_DONE, Peers
from report.program import Program
from report.rows import Contest, Missing, Promise, Section
from report.sections import first_use, packages, solids, stability, surfaces, zoom
from report.turns import Late, Overdue, Unmeasurable

from . import pretend

FILES = ["first/occt_screw.step", "nist_pmi_2.stp", "framework_printable_case_full.stp", "impeller.igs"]
FILES += ["m6_countersunk_screw.step", "nist_827-9999-904.stp", "occwl_example.stp", "zoo_ball_bearing.step"]
FILES += ["nist_pmi_5.stp"]
# of a clone, a build, a picture
FIRST_USE_S = {"git": 2.0, "cargo": 620.0, "selvedge": 1.0}
# of all packages on a large file, and on a light one
PACKAGES_S = 60.0, 30.0


def run(quick, speed=1.0):
    """The sections of a run, and its clock."""
    clock = pretend.Clock(speed)

    def built(command, limit_s, cwd=None):
        what = Path(command[0]).name
        done = clock.spend(what, FIRST_USE_S[what], limit_s)
        return "", "" if done else f"not done in {limit_s:.0f} s", FIRST_USE_S[what]

    def drawn(command, limit_s, cwd=None):
        name, seconds = Path(command[3]).name, float(pretend.option(command, "--seconds"))
        done = clock.spend("compare_python", PACKAGES_S[name in pretend.LIGHT], min(seconds, limit_s))
        rows = [{"file": name, "package": "selvedge", "error": "pretended"}]
        rows += [] if done else [{"file": name, "package": "f3d", "error": "were used up"}]
        Path(command[2]).write_text(json.dumps({"rows": rows, "missing": {"vtk": ["OCP"]}}))
        return "", "", 0.0

    with contextlib.ExitStack() as on:
        scratch = Path(on.enter_context(tempfile.TemporaryDirectory()))
        for name in FILES:
            (scratch / name).parent.mkdir(exist_ok=True)
            (scratch / name).write_bytes(bytes(surfaces.LARGE_BYTES if Path(name).name not in pretend.LIGHT else 9))
        on.enter_context(mock.patch("time.monotonic", clock))
        on.enter_context(mock.patch.object(first_use, "run", built))
        on.enter_context(mock.patch.object(packages, "run", drawn))
        on.enter_context(mock.patch.object(packages, "installed", lambda: True))
        on.enter_context(mock.patch.object(budget.Budget.__init__, "__defaults__", (clock,)))
        on.enter_context(mock.patch("report.turns.rounds.__defaults__", (3, 9, clock, None)))
        # scenes that nobody reads
        on.enter_context(mock.patch("report.bumpy.scene", lambda folder, name: folder / f"{name}.toml"))
        on.enter_context(mock.patch("report.hard.random_sheets", lambda draw, count: ("", 2 * count)))
        on.enter_context(mock.patch("report.hard.random_trees", lambda draw, count, leaves: ("", 5 * count)))
        on.enter_context(mock.patch("report.scenes.toml", lambda scene: ""))
        on.enter_context(contextlib.redirect_stderr(io.StringIO()))
        context = Context(quick, pretend.Program(clock, scratch / "runs"), pretend.Peers(clock), scratch, scratch)
        return {name: report.measured(name, context) for name in report.SECTIONS}, clock


class Shares(unittest.TestCase):
    def test_every_section_has_a_share_and_they_fit(self):
        self.assertEqual(set(budget.SECONDS), set(report.SECTIONS))
        quick, whole = (sum(of[k] for of in budget.SECONDS.values()) for k in (0, 1))
        self.assertLessEqual(quick, 9 * 60)
        self.assertLessEqual(whole, 85 * 60)

    def test_sections_without_the_others_share_the_time_of_all(self):
        whole = sum(seconds for _, seconds in budget.SECONDS.values())
        given = lambda *names: [budget.of(name, False, names).seconds for name in names]
        self.assertEqual(given("zoom"), [whole])
        both = given("zoom", "trims")
        self.assertAlmostEqual(sum(both), whole)
        self.assertAlmostEqual(both[0] / both[1], budget.SECONDS["zoom"][1] / budget.SECONDS["trims"][1])
        self.assertAlmostEqual(budget.of("zoom", False).seconds, budget.SECONDS["zoom"][1])
        self.assertEqual(budget.of("packages", True, ["packages"]).seconds, 0)

    def test_a_case_gets_its_share_of_what_is_left(self):
        clock = pretend.Clock()
        of = budget.Budget(100, clock)
        given = []
        for case, seconds in budget.cases(of, {"a": 1, "b": 3, "c": 1}):
            given.append((case, str(seconds)))
            clock.now += {"a": 40, "b": 60, "c": 0}[case]
        why = "the section's 100 s were used up"
        self.assertEqual(given, [("a", "20.0"), ("b", "45.0"), ("c", why)])

    def test_a_process_is_ended_with_its_section(self):
        clock = pretend.Clock()
        of = budget.Budget(100, clock)
        self.assertEqual(of.limit_s(30), 30)
        clock.now = 80
        self.assertEqual(of.limit_s(30), 20)
        clock.now = 99
        self.assertEqual(of.limit_s(30), budget.LEAST_SHARE * 100)


class Processes(unittest.TestCase):
    """The real program and peers, without a process."""

    def setUp(self):
        clock = pretend.Clock()
        self.budget = budget.Budget(100, clock)
        clock.now = 55

    def test_the_program_gets_no_more_than_is_left(self):
        program = Program(Path("selvedge"), None, Path("."))
        program.budget = self.budget
        late = subprocess.TimeoutExpired("selvedge", 45)
        with mock.patch("report.program.subprocess.run", side_effect=late) as ran:
            with self.assertRaisesRegex(Late, "selvedge info was not done in 45 s"):
                program.run("info", "part.step")
        self.assertEqual(ran.call_args.kwargs["timeout"], 45)

    def test_a_process_that_hangs_with_time_left_is_not_late(self):
        program = Program(Path("selvedge"), None, Path("."))
        program.budget = self.budget
        hangs = subprocess.TimeoutExpired("selvedge", 30)
        with mock.patch("report.program.subprocess.run", side_effect=hangs):
            with self.assertRaisesRegex(Overdue, "selvedge check was not done in 30 s"):
                program.run("check", "part.step", limit_s=30)
            program.budget = None
            with self.assertRaises(Overdue):
                program.run("check", "part.step", limit_s=30)

    def test_a_peer_that_hangs_with_time_left_is_not_late(self):
        with tempfile.TemporaryDirectory() as folder:
            peers = Peers(Path(folder))
            peers.budget = self.budget
            with mock.patch("report.peers.run", return_value=("", f"{NOT_DONE} 30 s", 30.0)):
                with self.assertRaises(Overdue), contextlib.redirect_stderr(io.StringIO()):
                    peers.results("kernel", {}, limit_s=30)
            with mock.patch("report.peers.run", return_value=("", "status 1: no display", 1.0)):
                peers.run(["viewer"], 30)
            self.assertIs(peers.error, Unmeasurable)

    def test_a_peer_gets_no_more_than_is_left(self):
        with tempfile.TemporaryDirectory() as folder:
            peers = Peers(Path(folder))
            peers.budget = self.budget
            with mock.patch("report.peers.run", return_value=("", f"{NOT_DONE} 45 s", 45.0)) as ran:
                with self.assertRaises(Late), contextlib.redirect_stderr(io.StringIO()):
                    peers.results("kernel", {}, limit_s=300)
            self.assertEqual(ran.call_args.args[1], 45)


class Halves(unittest.TestCase):
    """A section that ends early."""

    def section(self, error):
        class Half:
            TITLE, TEXT = "Made up", "A text."

            def measure(context, section):
                section.promises += [Promise("tested", 0, 9), Promise("never tested")]
                section.contests.append(Contest("a half", "Viewer", "s", [1.0] * 3, [2.0] * 3))
                raise error

        with mock.patch.dict(report.SECTIONS, least=Half), contextlib.redirect_stderr(io.StringIO()):
            return report.measured("least", Context(True, mock.Mock(), mock.Mock(), Path(), None))

    def test_a_section_keeps_what_it_has_measured(self):
        late, failed = self.section(Late("used up")), self.section(KeyError("frame"))
        for section in (late, failed):
            self.assertEqual((section.number, section.title, section.text), (7, "Made up", "A text."))
            self.assertEqual((section.contests[0].what, section.contests[0].verdict()), ("a half", "ahead"))
        self.assertEqual((late.failure, late.contests[1].why), ("", "used up"))
        self.assertEqual((failed.failure, len(failed.contests)), ("KeyError: 'frame'", 1))

    def test_a_promise_that_was_not_tested_has_the_reason(self):
        self.assertEqual([promise.why for promise in self.section(Late("used up")).promises], ["", "used up"])
        self.assertEqual([promise.why for promise in self.section(KeyError("x")).promises], ["", "KeyError: 'x'"])


class Hangs(unittest.TestCase):
    """A program that never ends `check` from one case on."""

    def section(self, seconds, from_case, to_case):
        clock = pretend.Clock()

        class Hangs(pretend.Program):
            cases = 0

            def check(self, *words, limit_s=600):
                self.cases += 1
                if from_case <= self.cases < to_case:
                    self.spend("check", 1e9, limit_s)
                return super().check(*words, limit_s=limit_s)

        with contextlib.ExitStack() as on:
            scratch = Path(on.enter_context(tempfile.TemporaryDirectory()))
            on.enter_context(mock.patch("time.monotonic", clock))
            on.enter_context(mock.patch("report.hard.random_sheets", lambda draw, count: ("", 2 * count)))
            on.enter_context(mock.patch("report.hard.random_trees", lambda draw, count, leaves: ("", 5 * count)))
            on.enter_context(contextlib.redirect_stderr(io.StringIO()))
            context = Context(True, Hangs(clock, scratch), pretend.Peers(clock), scratch, scratch)
            context.give(budget.Budget(seconds, clock))
            section = Section(6, stability.TITLE, stability.TEXT)
            stability.measure(context, section)
            return section

    def promises(self, section, what):
        return [(p.violations, p.cases) for p in section.promises if what in p.what]

    def test_a_hard_case_that_hangs_is_a_violation(self):
        section = self.section(200, 2, 3)
        self.assertEqual(self.promises(section, "a hard case drawn"), [(1, len(stability.hard.CASES))])

    def test_a_hard_case_without_time_is_none(self):
        # the second case is ended with the section, before its own 30 s; the others have no time
        section = self.section(20, 2, 3)
        self.assertEqual(self.promises(section, "a hard case drawn"), [(0, 1)])

    def test_a_random_case_that_hangs_is_a_violation_and_others_follow(self):
        hard = len(stability.hard.CASES)
        section = self.section(200, hard + 3, hard + 4)
        ((violations, cases),) = self.promises(section, "scene of sheets")
        self.assertEqual((violations, cases > 3), (1, True))
        self.assertIn("case 3: selvedge check was not done in 30 s", section.tables[1].rows[0][-1])


    def test_a_way_that_takes_too_long_on_a_mesh_is_a_row(self):
        context = mock.MagicMock(quick=False)
        context.program.bench.side_effect = Overdue("selvedge bench was not done in 120 s")
        with mock.patch("report.bumpy.scene", lambda folder, name: Path(f"{name}.toml")):
            rows = solids.bunnies(context)
        self.assertEqual(len(rows), len(solids.bumpy.TRIANGLES) * len(solids.WAYS))
        self.assertEqual(str(rows[0][3].why), "selvedge bench was not done in 120 s")

    def test_only_the_mesher_s_own_limit_is_not_reached(self):
        def verdicts(seconds):
            clock = pretend.Clock()
            with contextlib.ExitStack() as on:
                scratch = Path(on.enter_context(tempfile.TemporaryDirectory()))
                on.enter_context(mock.patch("report.turns.rounds.__defaults__", (3, 9, clock, None)))
                on.enter_context(contextlib.redirect_stderr(io.StringIO()))
                context = Context(True, pretend.Program(clock, scratch), pretend.Peers(clock), scratch, None)
                context.give(budget.Budget(seconds, clock))
                section = Section(2, zoom.TITLE, zoom.TEXT)
                zoom.measure(context, section)
                return {one.verdict() for one in section.contests if "1,000,000 times" in one.what}

        self.assertIn("unreached", verdicts(1000))
        # the section ends before the mesher's limit
        self.assertEqual(verdicts(12), {"not measured"})


class Ends(unittest.TestCase):
    """Real processes that do not end by themselves."""

    def ended(self, script):
        start = time.monotonic()
        with mock.patch("report.peers.GRACE_S", 0.3):
            out, problem, _ = peers.run(["sh", "-c", script], 1.0)
        self.assertEqual(problem, f"{NOT_DONE} 1 s")
        # the shell has ended, and was waited for
        self.assertRaises(ProcessLookupError, os.kill, int(out), 0)
        return time.monotonic() - start

    def test_a_process_that_ignores_the_end_is_killed(self):
        # without a kill it lasts 20 s
        self.assertLess(self.ended("trap '' TERM; echo $$; sleep 20"), 10)

    def test_a_process_that_left_the_group_is_not_waited_for(self):
        self.assertLess(self.ended("echo $$; setsid sleep 20 & sleep 20"), 10)


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.whole, cls.quick, cls.slow = run(quick=False), run(quick=True), run(quick=False, speed=0.25)

    def test_a_whole_run_takes_less_than_its_time(self):
        self.assertLess(self.whole[1].now, 82 * 60)

    def test_a_quick_run_takes_less_than_its_time(self):
        self.assertLess(self.quick[1].now, 9 * 60)

    def test_a_slow_machine_gets_reasons_and_hardly_a_longer_run(self):
        sections, clock = self.slow
        # what has begun at the end of a section has the least time
        self.assertLess(clock.now, 82 * 60 + 3 * len(sections) * budget.LEAST_S)
        late = [contest for contest in sections["surfaces"].contests if "used up" in contest.why]
        self.assertTrue(late)

    def test_too_little_time_is_no_failure(self):
        for sections, _ in (self.whole, self.quick, self.slow):
            self.assertEqual([s.failure for s in sections.values() if s.failure], [])

    def test_packages_have_a_row_of_every_file_in_any_time(self):
        names = [Path(name).name for name in packages.FILES]
        self.assertEqual(len(names), 10)
        for sections, _ in (self.whole, self.slow):
            rows = sections["packages"].tables[0].rows
            self.assertEqual([row[0] for row in rows if row[1] == "selvedge"], names)
            # told once, not once a file
            self.assertEqual([row[1] for row in rows].count("vtk"), 1)
            self.assertLessEqual(sections["packages"].seconds, sections["packages"].given)
        late = [row[0] for row in self.slow[0]["packages"].tables[0].rows if row[1] == "f3d"]
        self.assertEqual(late, names)

    def test_no_file_and_size_is_left_out(self):
        for sections, _ in (self.whole, self.slow):
            found = sections["surfaces"]
            named = [table.title for table in found.tables] + [contest.what for contest in found.contests]
            for name, (width, height) in surfaces.wanted(mock.Mock(quick=False)):
                what = f"{Path(name).name}, {width}x{height}"
                self.assertTrue(any(what in one for one in named), what)


if __name__ == "__main__":
    for of_quick in (True, False):
        for of_name, of_section in run(of_quick)[0].items():
            print(of_name, round(of_section.seconds), "of", round(of_section.given), of_section.failure)
