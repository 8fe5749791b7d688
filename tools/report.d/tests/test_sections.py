"""Sections with made-up measurements: no process runs."""

import importlib.machinery
import importlib.util
import json
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from report import budget, claims, moving
from report.machine import ROOT
from report.rows import Contest, Missing, Section
from report.sections import packages, stability, surfaces, trims, zoom

SIZE = "400x400"


def trim_row(way, trims_ms, bytes_, zoom_=1):
    row = {"model": "holes", "way": way, "zoom": str(zoom_), "width": "400", "height": "400", "wrong": "0"}
    return row | {"trim_ms": str(trims_ms), "frame_ms": "50", "trim_bytes": str(bytes_)}


class Trims(unittest.TestCase):
    def contests(self, *ways):
        section = Section(3, "", "")
        trims.contests(section, "holes", [trims.unique([trim_row(*way) for way in ways])] * 3, SIZE)
        return section.contests

    def test_the_better_of_our_ways_counts(self):
        time, memory = self.contests(("table", 9, 200), ("exact", 4, 80), ("bisect", 40, 1), ("texture", 1, 90))
        self.assertEqual((time.ours, time.theirs, time.lost()), ([4.0] * 3, [40.0] * 3, False))
        self.assertEqual((memory.ours, memory.theirs), ([80.0], [90.0]))

    def test_slower_than_bisection_is_lost(self):
        time, _ = self.contests(("table", 90, 1), ("exact", 80, 1), ("bisect", 40, 1), ("texture", 1, 1))
        self.assertTrue(time.lost())

    def test_below_zero_is_a_hundredth_of_the_frame(self):
        time, _ = self.contests(("table", -3, 1), ("exact", 5, 1), ("bisect", 40, 1), ("texture", 1, 1))
        self.assertEqual(time.ours, [0.5] * 3)

    def test_one_of_our_ways_may_lack_room(self):
        _, memory = self.contests(("table", "", ""), ("exact", 4, 80), ("bisect", 40, 1), ("texture", 1, 90))
        self.assertEqual(memory.ours, [80.0])

    def test_a_texture_without_room_is_not_measured(self):
        _, memory = self.contests(("table", 9, 1), ("exact", 4, 1), ("bisect", 40, 1), ("texture", "", ""))
        self.assertEqual((memory.verdict(), memory.reason()), ("not measured", "the device has no room for it"))


class Surfaces(unittest.TestCase):
    """Ours: 0.5 px in 1 s; theirs: fine in 3 s, coarse in 0.1 s."""

    ERRORS = {"ours 0.5": 0.2, "mesh 0.01": 0.9, "mesh 0.0001": 0.1}

    def contest(self, error, errors=None, file="nist_pmi_2.stp", size=surfaces.MIDDLE, stopped=None):
        case = object.__new__(surfaces.Case)
        case.model, case.size, case.what, case.stopped = Path(file), size, "part.step", stopped or {}
        errors = {name: {"p999_px": off} for name, off in (errors or self.ERRORS).items()}
        ours = [{0.5: (1.0 + k / 10, 20.0, 9.0)} for k in range(3)]
        theirs = [{0.01: (0.1, 5.0, 5.0), 0.0001: (3.0 + k / 10, 9.0, 9.0)} for k in range(3)]
        return case.contest("first picture", "VTK", "s", "mesh", ours, theirs, errors, 0, error)

    def test_the_quickest_setting_that_is_as_right_counts(self):
        fine, coarse = self.contest(0.25), self.contest(1.0)
        self.assertEqual((fine.theirs, fine.verdict(), fine.claim), ([3.0, 3.1, 3.2], "ahead", "ahead"))
        self.assertEqual((coarse.theirs, coarse.verdict(), coarse.claim), ([0.1] * 3, "behind", "open"))

    def test_a_claimed_file_and_size_that_is_slower_within_half_a_pixel_is_lost(self):
        right = self.ERRORS | {"mesh 0.01": 0.3}
        self.assertTrue(self.contest(0.5, right).lost())
        for other in ({"file": "part.step"}, {"size": surfaces.LARGE}):
            found = self.contest(0.5, right, **other)
            self.assertEqual((found.verdict(), found.claim, found.lost()), ("behind", "open", False))

    def test_claims_are_of_files_and_sizes_that_are_measured(self):
        names = {Path(name).name for name in surfaces.FILES}
        self.assertLessEqual(set(claims.FIRST_PICTURE), names)
        for sizes in claims.FIRST_PICTURE.values():
            self.assertLessEqual(set(sizes), set(surfaces.WEIGHTS))

    def test_every_rule_has_its_sentence(self):
        self.assertEqual([len(claims.sentences(name)) for name in ("surfaces", "zoom", "trims", "scale")], [1, 1, 2, 0])
        (first,) = claims.sentences("surfaces")
        for words in ("within 0.5 px", "nist_pmi_2.stp, ", "960x540, 1920x1080"):
            self.assertIn(words, first)

    def test_an_error_that_no_setting_reaches(self):
        self.assertIsNone(self.contest(0.125))
        never = self.ERRORS | {"mesh 0.0001": 0.8}
        self.assertEqual(self.contest(0.25, never).verdict(), "unreached")

    def test_the_table_of_ratios_has_the_quickest_peer(self):
        of = lambda peer, theirs: Contest("", peer, "s", [1.0] * 3, [theirs] * 3)
        never = Contest("", "F3D", "s", unreached=True, why="none is as right")
        self.assertEqual(surfaces.least_ratio([of("VTK", 0.25), never, of("Open CASCADE", 0.5)]), "0.25 VTK")
        self.assertEqual((surfaces.least_ratio([never]), surfaces.least_ratio([])), ("ours alone", ""))

    def test_a_peer_that_lacked_time_is_no_win(self):
        never = self.ERRORS | {"mesh 0.0001": 0.8}
        stopped = self.contest(0.25, never, stopped={("meshed", 1e-6): "the mesh before took 9 s"})
        self.assertEqual((stopped.verdict(), stopped.why[-24:]), ("unreached", "the mesh before took 9 s"))
        cut = self.contest(0.25, never, stopped={("meshed", 1e-6): f"{surfaces.PROCESS}not done in 30 s"})
        self.assertEqual((cut.verdict(), cut.why), ("not measured", "its process was not done in 30 s"))
        other = self.contest(0.25, never, stopped={("F3D", 1e-6): f"{surfaces.PROCESS}not done in 30 s"})
        self.assertEqual(other.verdict(), "unreached")

    def test_a_mesh_that_was_not_tried_is_no_win(self):
        never = self.ERRORS | {"mesh 0.0001": 0.8}
        with mock.patch.object(surfaces.Case, "finest", False):
            found = self.contest(0.25, never)
            self.assertEqual(found.verdict(), "not measured")
            self.assertIn("finer meshes are drawn at 1920x1080 only", found.why)
            limit = self.contest(0.25, never, stopped={("meshed", 1e-6): "the mesh before took 9 s"})
            self.assertEqual(limit.verdict(), "unreached")

    def test_a_peer_without_a_verdict_is_not_behind(self):
        self.assertEqual(self.contest(0.5, {"ours 0.5": 0.2}).verdict(), "not measured")

    def test_a_deflection_that_was_not_drawn_has_its_reason(self):
        case = object.__new__(surfaces.Case)
        case.what, case.stopped, case.context = "part.step", {}, mock.Mock()
        case.why("meshed", [1e-2, 1e-5, 1e-6], [{"mesh_s": 1.0}, {"stopped": "the mesh before took 9 s"}])
        section, found = Section(1, "", ""), [{1e-2: (1.0, 2.0, 3.0, 1.0)}] * 3
        competitors = {"VTK": ("mesh", found)}
        case.table(section, competitors, {"boundary": 9, "alone": 0}, {})
        cells = [row[1:3] for row in section.tables[0].rows]
        self.assertEqual(cells[1], ["1e-05 of the diagonal", Missing("the mesh before took 9 s")])
        self.assertEqual((cells[2][0], type(cells[2][1])), ("1e-06 of the diagonal", Missing))

    def test_pixels_of_two_readings_are_a_table(self):
        case = object.__new__(surfaces.Case)
        case.what, case.tolerances = "part.step", [0.1, 0.5, 1.0]
        errors = {"ours 0.1": {"readings": [8, 0, 1]}, "ours 0.5": {"readings": [7, 1, 1]}}
        section = Section(1, "", "")
        case.readings(section, {"widened": 9, "edge_mm": 0.1593}, errors)
        (table,) = section.tables
        self.assertEqual(table.rows, [["0.1 px", 9, 8, 0, 1], ["0.5 px", 9, 7, 1, 1]])
        self.assertIn("up to 0.16 mm", table.text)
        case.readings(section, {"widened": 0}, {})
        self.assertEqual(len(section.tables), 1)

    def test_later_rounds_repeat_some_settings(self):
        case = object.__new__(surfaces.Case)
        case.begun, case.model, case.camera, case.context = set(), None, None, mock.MagicMock()
        case.tolerances, case.bench = [0.1, 0.5, 1.0, 4.0], lambda tolerance: {surfaces.WALL: 9.0}
        case.benches = {}
        drawn = []
        case.first = lambda tolerance, *options: drawn.append((tolerance, *options)) or (1.0 if options else 2.0)
        first = case.ours()
        self.assertEqual(list(first), [0.1, 0.5, 1.0, 4.0])
        self.assertEqual([drawn.count((t, *surfaces.PLAIN)) for t in first], [0, 1, 0, 0])
        self.assertEqual((first[0.5], first[1.0]), ((2.0, 9.0, None, 1.0), (2.0, 9.0, None, None)))
        self.assertEqual(list(case.ours()), [0.5, 1.0])

    def once(self, error, mine, theirs, errors):
        """A claim whose sides have these first pictures, by round and setting."""
        case = object.__new__(surfaces.Case)
        case.model, case.size = Path("nist_pmi_2.stp"), surfaces.MIDDLE
        case.what, case.stopped = "part.step", {}
        errors = {name: {"p999_px": off} for name, off in errors.items()}
        ours, found = ([{s: (t, 9.0, 9.0) for s, t in one.items()} for one in side] for side in (mine, theirs))
        return case.contest("first picture", "VTK", "s", "mesh", ours, found, errors, 0, error)

    def test_a_setting_that_is_timed_once_has_no_noise_and_no_verdict(self):
        errors = {"ours 0.5": 0.2, "mesh 0.0001": 0.4, "mesh 1e-05": 0.1}
        ours = [{0.5: 2.0}] * 3
        fine = self.once(0.25, ours, [{1e-4: 0.9, 1e-5: 1.99}, {1e-4: 0.9}, {1e-4: 0.9}], errors)
        self.assertEqual((fine.ours, fine.theirs, fine.claim), ([2.0], [1.99], "ahead"))
        self.assertEqual((fine.verdict(), fine.lost()), ("not measured", False))
        coarse = self.once(0.5, ours, [{1e-4: 1.9, 1e-5: 1.99}, {1e-4: 1.9}, {1e-4: 1.9}], errors)
        self.assertEqual((coarse.theirs, coarse.lost()), ([1.9] * 3, True))

    def test_a_setting_that_is_timed_once_does_not_improve_its_round(self):
        errors = {"ours 0.5": 0.2, "ours 4.0": 0.2, "mesh 0.0001": 0.1}
        found = self.once(0.5, [{0.5: 2.0, 4.0: 0.5}, {0.5: 2.1}, {0.5: 2.2}], [{1e-4: 3.0}] * 3, errors)
        self.assertEqual(found.ours, [2.0, 2.1, 2.2])

    def test_a_contest_has_the_rounds_of_both_sides(self):
        errors = {"ours 0.5": 0.2, "mesh 0.0001": 0.1}
        theirs = [{}, {1e-4: 4.0}, {1e-4: 5.0}, {1e-4: 6.0}]
        found = self.once(0.5, [{0.5: 1.0}, {0.5: 2.0}, {0.5: 3.0}, {0.5: 4.0}], theirs, errors)
        self.assertEqual((found.ours, found.theirs), ([2.0, 3.0, 4.0], [4.0, 5.0, 6.0]))
        apart = self.once(0.5, [{0.5: 1.0}, {}], [{}, {1e-4: 1.0}], errors)
        self.assertEqual((apart.verdict(), apart.why), ("not measured", "no round timed both sides"))

    def test_the_table_counts_the_rounds_of_each_setting(self):
        case = object.__new__(surfaces.Case)
        case.what, case.stopped = "part.step", {}
        first = {0.1: (5.0, 6.0, 7.0, None), 0.5: (1.0, 2.0, 3.0, 0.5)}
        section, found = Section(1, "", ""), [first, {0.5: (2.0, 4.0, None, 0.7)}]
        case.table(section, {"selvedge": ("ours", found)}, {"boundary": 9, "alone": 0}, {})
        rows = section.tables[0].rows
        figures = [["0.1 px", 5.0, 6.0, 7.0, "", 1], ["0.5 px", 1.5, 3.0, "", 0.6, 2]]
        self.assertEqual([row[1:7] for row in rows], figures)

    def test_a_plot_shows_the_quickest_of_each_error(self):
        self.assertEqual(surfaces.front([(0.5, 3), (0.1, 9), (0.5, 2)]), [(0.1, 9), (0.5, 2)])

    def test_a_frame_is_told_apart_by_pass_the_longest_first(self):
        frame = {"pass: trims": 20.0, "pass: visibility": 70.0, "pass: reset": 1.0, "pass: scan": 0.5}
        exact = frame | {"all passes": 91.5, "wall clock, with read-back": 99.0, "triangles": 7.0}
        faceted = {"all passes": 4.0, "wall clock, with read-back": 6.0}
        rows = surfaces.spent_rows(exact, faceted)
        names = ["facets, by this engine", "exact surfaces", "visibility", "trims", "all others"]
        self.assertEqual([row[0] for row in rows], names)
        self.assertEqual([row[1] for row in rows], [4.0, 91.5, 70.0, 20.0, 1.5])
        self.assertEqual(rows[2][2], "77 %")
        self.assertEqual(surfaces.spent_rows(exact, None)[0][0], "exact surfaces")

    def test_frames_have_causes(self):
        frame = {surfaces.WALL: 99.0, "all passes": 90.0, "pass: visibility": 60.0, "pass: resolve": 30.0}
        self.assertIn("takes 99 ms (of its passes visibility 67 %, resolve 33 %)", surfaces.frame_cause(frame, None))
        self.assertIn("facets 7 ms by this engine", surfaces.frame_cause(frame, {surfaces.WALL: 7.0}))
        stands = frame | {"reused: all passes": 40.0, "reused: pass: resolve": 30.0, "reused: pass: gaps": 10.0}
        self.assertEqual(surfaces.standing_cause(frame), "")
        self.assertIn("takes 40 ms of passes, 30 of them resolve", surfaces.standing_cause(stands))

    def test_pixels_beyond_the_tolerance_are_counted(self):
        error = {"distances_px": [0.1, 0.5, 0.75, 1.0, 16.0]}
        self.assertEqual([surfaces.beyond(error, tolerance) for tolerance in (0.1, 0.5, 4.0)], [4, 3, 1])


class Packages(unittest.TestCase):
    def test_a_package_that_failed_has_its_reason(self):
        row = packages.row_of({"file": "part.step", "package": "f3d", "error": "no device"})
        self.assertEqual((row[:3], len(row)), (["part.step", "f3d", Missing("no device")], 11))

    def test_ours_has_the_verdict_of_the_judge(self):
        judge = {"judged": 2000, "wrong": 3, "depth_px": {"mean": 0.001, "worst": 0.02}}
        times = {"first_s": 0.5, "next_s": 4.0, "peak_mib": 300.0}
        row = packages.row_of({"file": "part.step", "package": "selvedge", "judge": judge} | times)
        self.assertEqual(row[2:], [0.5, 4.0, 300.0, "3 wrong", "2,000 judged", 0.001, 0.02, "", ""])

    def test_the_others_have_figures_in_their_columns(self):
        row = {"file": "part.step", "package": "vtk", "first_s": 0.5, "next_s": 4.0, "peak_mib": 300.0}
        row |= {"silhouette_px": 7, "seen_px": 900, "depth_px_mean": 0.3, "depth_px_worst": 9.0}
        row = packages.row_of(row | {"depth_px_median": 0.1, "depth_px_99": 2.0})
        self.assertEqual(row[5:], [7, 900, 0.3, 9.0, 0.1, 2.0])
        section = Section(11, "", "")
        packages.measure(mock.Mock(quick=True), section)
        heads = [name.split(",")[0] for name in section.tables[0].head[7:]]
        self.assertEqual(heads, ["depth: mean", "worst", "median", "99 %"])

    def test_a_comparison_that_is_ended_keeps_its_rows(self):
        """Of two files: one that is ended after its first package, and one before."""
        begun = iter([True, False])

        def ended(command, limit_s):
            if next(begun):
                row = {"file": "panel.step", "package": "selvedge", "error": "pretended"}
                Path(command[2]).write_text(json.dumps({"rows": [row], "missing": {}}))
            return "", f"not done in {limit_s:.0f} s", limit_s

        with tempfile.TemporaryDirectory() as folder:
            context = mock.Mock(quick=False, budget=budget.Budget(100, lambda: 0.0))
            folders = iter(("a", "b"))
            context.program.folder = lambda: made(Path(folder) / next(folders))
            context.model = lambda name: Path(name) if name.startswith("samples/") else None
            with mock.patch.object(packages, "run", ended), mock.patch.object(packages, "FILES", packages.FILES[:2]):
                rows = packages.compared(context, Section(11, "", ""))
        # the files have 50 s and 100 s, and 10 s more to begin
        self.assertEqual(
            [row[:3] for row in rows],
            [
                ["panel.step", "selvedge", Missing("pretended")],
                ["panel.step", "others", Missing("tools/compare_python: not done in 60 s")],
                ["bracket.step", "others", Missing("tools/compare_python: not done in 100 s")],
            ],
        )

    def test_the_packages_of_a_file_share_its_time(self):
        compare = comparison()
        now = [0.0]
        left = compare.Left(50.0, lambda: now[0])
        limits = []

        def draw(limit):
            limits.append(limit)
            now[0] += 30.0
            return {"first_s": 1.0}

        rows = [left.row(draw, 45.0) for _ in range(3)]
        self.assertEqual(limits, [45.0, 20.0])
        self.assertEqual(rows[2], {"error": "the file's 50 s were used up"})
        self.assertEqual(compare.Left(None).limit(45.0), 45.0)

    def test_the_comparison_s_own_table_has_the_verdict(self):
        judge = {"wrong": 3, "depth_px": {"mean": 0.001, "worst": 0.02}}
        row = {"file": "part.step", "package": "selvedge", "outputs": "depth", "judge": judge}
        row |= {"first_s": 0.5, "next_s": 4.0, "peak_mib": 300.0}
        report = {"rows": [row], "missing": {"vtk": ["OCP"]}, "size": 9, "views": 2, "machine": "", "date": ""}
        text = comparison().table(report)
        self.assertIn("| 300 | 3 wrong | 0.001 | 0.020 | - | - |", text)
        head, rule, *rows = (line for line in text.splitlines() if line.startswith("|"))
        self.assertEqual({line.count("|") for line in (head, rule, *rows)}, {head.count("|")})
        self.assertTrue(head.endswith("| depth, px: mean | worst | median | 99 % |"))
        self.assertIn("vtk was not compared: OCP is not installed.", text)


def made(folder):
    folder.mkdir()
    return folder


def comparison():
    """tools/compare_python as a module."""
    path = str(ROOT / "tools/compare_python")
    loader = importlib.machinery.SourceFileLoader("compare_python", path)
    spec = importlib.util.spec_from_loader(loader.name, loader)
    module = importlib.util.module_from_spec(spec)
    with mock.patch.object(sys, "dont_write_bytecode", True):
        spec.loader.exec_module(module)
    return module


class Moving(unittest.TestCase):
    """A benchmark that prints what benches/moving.rs prints."""

    def promise(self, move_ms, bench="moving"):
        context, section = mock.Mock(), Section(5, "", "")
        context.model = lambda name: Path(name)
        head = "| file | instances | change, ms: median | worst | record, ms: median | worst |\n|---|---:|---:|\n"
        context.peers.run = lambda command, limit_s: (
            f"{head}| {command[1].name} | 9 | {move_ms} | 0.210 | 1.500 | 2.250 |\n",
            "",
            1.0,
        )
        with mock.patch.dict("os.environ", {"REPORT_MOVING": bench}):
            moving.measure(context, section)
        return section.promises[0], section.tables[0].rows[0]

    def test_a_step_has_a_limit(self):
        promise, row = self.promise(0.125)
        self.assertEqual(row, ["assembly.step", 9, 0.125, 0.21, 1.5, 2.25])
        self.assertEqual((promise.cases, promise.broken()), (1, False))
        self.assertTrue(self.promise(1.0)[0].broken())

    def test_a_benchmark_that_is_not_built_has_the_reason(self):
        promise, row = self.promise(0.125, bench="")
        self.assertEqual((row[1], promise.why), (Missing(moving.NOT_BUILT), moving.NOT_BUILT))


class Stability(unittest.TestCase):
    def test_a_wrong_sheet_of_the_right_face_is_wrong(self):
        folds = {"beyond": 2, "wrong_depth": 3, "worst_shift_px": 1.5}
        judgement = {"sampled": 90, "wrong": 1, "worst_shift_px": 0.6, "given_up": 0, "folds": folds}
        found = stability.Found([{"judgement": judgement, "stats": {"clamps": 4, "patches": 1}}] * 2)
        self.assertEqual((found.wrong, found.worst, found.clamps, found.judged), (12, 1.5, 8, 180))


class Zoom(unittest.TestCase):
    def test_a_mesh_that_is_not_done_is_not_reached(self):
        section = Section(2, "", "")
        camera = {"eye": [0, 0, 9], "target": [0, 0, 0], "fovy": 35.0, "size": [4, 3]}
        cameras = {"1": camera, "1000": camera}
        judged = [{"judgement": {"worst_shift_px": 0.1, "folds": {"worst_shift_px": 0.2}}}] * 2
        ours = [{name: {"passes": [{"name": "visibility", "gpu_ms": 10.0}]} for name in cameras}] * 3
        drawn = {("fixed", name): {"frame_ms": 2.0} for name in cameras}
        meshed = [drawn | {("remeshed", "1"): {"frame_ms": 2.0, "mesh_s": 0.1}}] * 3
        errors = dict.fromkeys(cameras, "no kernel")
        results = {"ours": ours, "meshed": meshed}
        zoom.fill(section, "part.step", cameras, judged, results, errors, {"1000": "not meshed within 20 s"})
        verdicts = [contest.verdict() for contest in section.contests]
        self.assertEqual(verdicts, ["behind", "ahead", "behind", "unreached"])
        self.assertEqual(section.contests[1].theirs, [102.0] * 3)


class Kernel(unittest.TestCase):
    """The judges' searches, if their packages are installed."""

    def test_primitives_that_a_ray_does_not_meet_change_nothing(self):
        try:
            from report.peer import csg
        except ImportError as missing:
            self.skipTest(str(missing))
        from report import scenes

        for name in ("widget", "complex", "gear"):
            scene = scenes.of_name(name)
            camera = {"eye": [60, -90, 70], "target": [0, 0, 0], "up": [0, 0, 1], "fovy": 40.0, "size": [24, 24]}
            quick, whole = (csg.Rays(scene.data(), camera) for _ in range(2))
            whole.radii = whole.radii + 1e9
            pixels = [(x, y) for y in range(0, 24, 2) for x in range(0, 24, 2)]
            seen = [quick.centre(pixel) for pixel in pixels]
            self.assertEqual(seen, [whole.centre(pixel) for pixel in pixels], name)
            self.assertEqual({0, -1}, {face for (face,) in seen}, name)

    def test_an_edge_that_is_off_by_a_distance(self):
        try:
            from report.peer import csg
        except ImportError as missing:
            self.skipTest(str(missing))
        import tempfile

        import numpy

        from report.peer import kernel

        # a block that ends at the picture's middle, seen along z; pixels are 1 unit wide in the plane of its top
        tree = {
            "tree": "A",
            "primitives": {
                "A": {"shape": "block", "at": [-50, -50, -5], "turn": 0, "size": [50, 100, 5], "centred": False}
            },
        }
        camera = {
            "eye": [-0.3, 0.2, 20],
            "target": [-0.3, 0.2, 0],
            "up": [0, 1, 0],
            "fovy": 53.13010235415598,
            "size": [20, 20],
        }
        rays = csg.Rays(tree, camera)
        truth, _ = kernel.boundary(rays, 60)
        columns = {x for x, _ in truth}
        self.assertEqual(columns, {9, 10})
        with tempfile.TemporaryDirectory() as folder:
            image = numpy.zeros((20, 20), int)
            image[:, :10] = 1
            numpy.save(f"{folder}/right.npy", image)
            self.assertTrue((csg.covered(f"{folder}/right.npy")[:, 9] == 0).all())
        wrong = {(11, y) for y in range(20)}
        image = numpy.where(numpy.arange(20) <= 11, 0, -1)[None, :].repeat(20, 0)
        found = kernel.judged(rays, image, None, wrong, len(truth), 60)
        # the edge is at x = 10.3, the pixel's centre at 11.5: 1.2 away, rounded up to 1.5
        self.assertEqual((found["off"], found["beyond"], found["worst_px"]), (20, 0, 1.5))


if __name__ == "__main__":
    unittest.main()
