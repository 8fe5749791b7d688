"""A run of some sections keeps the others: made-up sections, no peers, no processes but git."""

import contextlib
import io
import json
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from report import __main__ as report
from report import machine, markdown, stored
from report.rows import Contest, Line, Missing, Plot, Promise, Report, Run, Section, Table

TITLES = {name: of.TITLE for name, of in report.SECTIONS.items()}
WON, LOST = ([1.0] * 3, [2.0] * 3), ([2.0] * 3, [1.0] * 3)
FIRST, SECOND = ("2026-01-01", "aaa"), ("2026-02-02", "bbb")


def made_up(title, figures, error=None):
    """A section with one claim and one plot, which may end by an error."""

    class MadeUp:
        TITLE, TEXT = title, "A text."

        def measure(context, section):
            section.contests.append(Contest(f"frame, {title}", "Viewer", "ms", *figures, claim="ahead"))
            section.plots.append(Plot(title, title, "x", "y", []))
            if error:
                raise error

    return MadeUp


def folder_of(test):
    """A folder that is removed after the test."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    return Path(folder.name)


class Runs(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of(self)
        self.json, self.markdown = self.folder / "benchmarks.json", self.folder / "benchmarks.md"
        self.of = {"least": made_up("A", LOST), "frames": made_up("B", WON), "reading": made_up("C", WON)}

    def run_at(self, conditions, *words):
        """The exit status and the messages of a run."""
        told = io.StringIO()
        with contextlib.ExitStack() as on:
            date, commit = conditions
            on.enter_context(mock.patch.dict(report.SECTIONS, self.of, clear=True))
            on.enter_context(mock.patch.dict("os.environ", SELVEDGE="selvedge"))
            on.enter_context(mock.patch("sys.argv", ["report", "--out", str(self.folder), *words]))
            on.enter_context(mock.patch.object(machine, "date", lambda: date))
            on.enter_context(mock.patch.object(machine, "commit", lambda: commit))
            on.enter_context(mock.patch.object(report, "Peers", lambda _: mock.Mock(versions={"Viewer": commit})))
            on.enter_context(mock.patch("report.plots.write", lambda plot, path: path.write_text(plot.title)))
            on.enter_context(contextlib.redirect_stdout(io.StringIO()))
            on.enter_context(contextlib.redirect_stderr(told))
            with self.assertRaises(SystemExit) as ends:
                report.main()
        return ends.exception.code, told.getvalue()

    def sections(self):
        return {section["name"]: section for section in json.loads(self.json.read_text())["sections"]}

    def test_a_run_of_one_section_keeps_figures_and_runs_of_the_others(self):
        self.run_at(FIRST)
        before = self.sections()
        self.of["frames"] = made_up("B", ([1.0] * 3, [4.0] * 3))
        self.run_at(SECOND, "--only", "frames")
        after, text = self.sections(), self.markdown.read_text()
        self.assertEqual(list(after), ["least", "frames", "reading"])
        self.assertEqual([after[name] for name in ("least", "reading")], [before["least"], before["reading"]])
        self.assertEqual(after["frames"]["contests"][0]["theirs"], [4.0] * 3)
        self.assertEqual([after["frames"]["run"][of] for of in ("date", "commit")], list(SECOND))
        self.assertIn("| date, commit | 2026-01-01, aaa (sections 1, 3); 2026-02-02, bbb (section 2) |", text)
        self.assertIn("| peers | Viewer aaa (sections 1, 3); Viewer bbb (section 2) |", text)
        for number, (date, commit) in enumerate((FIRST, SECOND, FIRST), 1):
            _, _, section = text.partition(f"## {number}. ")
            self.assertIn(f"Measured {date}, commit {commit}, 0 s of the", section.split("\n## ")[0])
        self.assertEqual(len(list(self.folder.glob("benchmarks/*.svg"))), 3)

    def test_the_summary_is_of_all_sections_and_the_exit_status_of_those_measured(self):
        self.assertEqual(self.run_at(FIRST)[0], 1)
        status, told = self.run_at(SECOND, "--only", "reading")
        self.assertEqual((status, "lost: " in told), (0, False))
        self.assertIn("**lost**: 1. frame, A", self.markdown.read_text())
        self.assertIn("| contests | 2 ahead, 0 even, 1 behind", self.markdown.read_text())
        self.assertEqual(json.loads(self.json.read_text())["exit_status"], 1)

    def test_a_section_that_failed_is_kept_as_failed_until_it_is_measured(self):
        self.of["frames"] = made_up("B", WON, KeyError("frame"))
        self.run_at(FIRST)
        self.run_at(SECOND, "--only", "reading")
        self.assertEqual(self.sections()["frames"]["failure"], "KeyError: 'frame'")
        self.assertIn("**failed**: 2. B: KeyError: 'frame'", self.markdown.read_text())
        self.of["frames"] = made_up("B", WON)
        self.run_at(SECOND, "--only", "frames")
        self.assertNotIn("failed", self.markdown.read_text())

    def test_a_whole_run_that_is_ended_keeps_what_it_has_not_measured(self):
        self.run_at(FIRST)
        self.of["frames"] = made_up("B", WON, SystemExit("ended"))
        self.run_at(SECOND)
        self.assertEqual([of["run"]["commit"] for of in self.sections().values()], ["bbb", "aaa", "aaa"])

    def test_a_file_that_cannot_be_read_leaves_the_named_sections_and_a_message(self):
        self.run_at(FIRST)
        whole = self.json.read_text()
        figures = json.loads(whole)
        figures["sections"][2]["contests"][0]["ours"] = ["fast"] * 3
        damaged = {
            whole[: len(whole) // 2]: "benchmarks.json is no JSON: ",
            json.dumps(figures): "sections[2].contests[0].ours[0] is str, and float is needed",
            whole.replace('"commit"', '"revision"'): "sections[0].run: commit, revision of too many or too few",
            whole.replace('"schema": 2', '"schema": 9'): "has format 9; 1 and 2 are read",
            "[]": "has format None",
            None: "there is no ",
        }
        for text, why in damaged.items():
            self.json.unlink() if text is None else self.json.write_text(text)
            _, told = self.run_at(SECOND, "--only", "frames")
            self.assertIn(why, told)
            self.assertIn(": the report will have the sections of this run alone\n", told)
            self.assertEqual(list(self.sections()), ["frames"])

    def test_the_document_has_the_options_without_the_folder(self):
        self.run_at(FIRST, "--quick", "--device", "llvm pipe", "--only", "least")
        told = self.sections()["least"]["run"]["command"]
        self.assertEqual(told, "tools/report --quick --device 'llvm pipe' --only least")

    def test_a_whole_run_needs_no_file(self):
        self.assertNotIn("there is no ", self.run_at(FIRST)[1])


class Formats(unittest.TestCase):
    def section(self):
        """A section with everything that a report may have."""
        peers = {"Viewer": "1", "Other": Missing("no package")}
        run = Run("tools/report", "2026-01-01", "a processor", "llvmpipe", "abc", "0.1", peers)
        section = Section(3, TITLES["trims"], "A text.", "trims", run, seconds=200.5, given=100, failure="KeyError")
        row = ["a", 1, 2.0, None, True, Missing("no room")]
        section.tables.append(Table("A table", [*"abcdef"], [row], "of a scene"))
        why = {"why": "no window"}
        section.contests.append(Contest("a", "Viewer", "s", *LOST, "ahead", cause="a start takes 0.2 s"))
        section.contests.append(Contest("b", "Viewer", "B", [3], [4.5], exact=True))
        section.contests += [Contest("c", "Viewer", "s", unreached=True, **why), Contest("d", "Viewer", "s", **why)]
        section.promises += [Promise("kept", 1, 9, known="docs/accuracy.md", most=0.5), Promise("not tested", why="x")]
        section.plots.append(Plot("plot", "A plot", "x", "y", [Line("selvedge", [(1, 2.5), (3.0, 4)], True)]))
        section.commands.append("selvedge trims")
        return section

    def read(self, data):
        path = folder_of(self) / "benchmarks.json"
        path.write_text(json.dumps(data))
        return stored.sections(path, TITLES)

    def test_what_is_read_is_what_was_written(self):
        section = self.section()
        (found,) = self.read(Report([section]).as_json())
        self.assertEqual(found, section)
        written, again = (markdown.text(Report([one]), {}) for one in (section, found))
        self.assertEqual(again, written)

    def test_format_1_has_one_run_for_all_sections(self):
        section = self.section()
        data = Report([section]).as_json()
        (row,) = data["sections"]
        del row["name"]
        data |= {"schema": 1, **row.pop("run")}
        self.assertEqual(self.read(data), [section])

    def test_a_section_that_the_report_has_no_more_is_left_out_and_numbers_are_the_present_ones(self):
        old, kept = self.section(), self.section()
        old.name, kept.number = "lights", 8
        self.assertEqual([(s.name, s.number) for s in self.read(Report([old, kept]).as_json())], [("trims", 3)])

    def test_the_figures_of_the_documents_can_be_kept(self):
        found = stored.sections(machine.ROOT / "docs/benchmarks.json", TITLES)
        text = markdown.text(Report(found), {})
        self.assertGreater(len(found), 1)
        self.assertEqual(text.count("\nMeasured 2"), len(found))


class Numbers(unittest.TestCase):
    def test_three_in_sequence_are_a_span(self):
        told = [markdown.among(numbers, [None] * 9) for numbers in ([4], [1, 2], [1, 2, 3, 5, 7, 8], list(range(9)))]
        self.assertEqual(told, [" (section 4)", " (sections 1, 2)", " (sections 1 to 3, 5, 7, 8)", ""])


class Commits(unittest.TestCase):
    def test_the_report_s_own_files_are_no_change_of_the_engine(self):
        folder = folder_of(self)
        git = lambda *words: subprocess.run(["git", "-C", folder, *words], check=True, capture_output=True)
        files = [folder / "docs/benchmarks.json", folder / "docs/benchmarks/zoom.svg", folder / "docs/cli.md"]
        files[1].parent.mkdir(parents=True)
        git("init")
        for file in files:
            file.write_text("old")
        git("add", ".")
        git("-c", "user.name=a", "-c", "user.email=a@example.com", "commit", "-m", "all")
        marks = []
        with mock.patch.object(machine, "ROOT", folder):
            for file in files:
                file.write_text("newer")
                marks.append(machine.commit().endswith("+"))
        self.assertEqual(marks, [False, False, True])


if __name__ == "__main__":
    unittest.main()
