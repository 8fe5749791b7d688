"""1. Time against error: ours over tolerances, viewers of triangles over deflections, the same files, view and size
in turn."""

import statistics

from .. import noise, views
from ..rows import Contest, Line, Missing, Plot, Promise, Section, Table
from ..turns import Unmeasurable, rounds

FILES_QUICK = ["samples/bracket.step", "first/occt_screw.step", "nist_pmi_2.stp"]
FILES = [*FILES_QUICK, "framework_printable_case_full.stp", "impeller.igs"]
# all sizes for these, the middle one for the others
ALL_SIZES = ["samples/bracket.step", "nist_pmi_2.stp"]
SIZES_QUICK, SIZES = [(960, 540)], [(960, 540), (1920, 1080), (3840, 2160)]
# bounds on the error, pixels
ERRORS = [0.125, 0.25, 0.5, 1.0, 2.0]
# what the project claims: a picture within half a pixel sooner from the file, where the file is large
CLAIMED_PX, CLAIMED_BYTES = 0.5, 1_000_000
# smallest error that a plot shows, pixels: the searches do not separate smaller ones
LEAST_PX = 1 / 16
# the measurements of each setting, in this order
QUANTITIES = [("first picture", "s"), ("turning frame", "ms"), ("standing frame", "ms")]
# the tolerance at which standing frames are drawn
STANDING_PX = 0.5
# passes below this share of all are one row
SMALL_SHARE = 0.02
# the mesh that the engine draws as a viewer of facets
FACETED = 1e-3
VIEWERS = {"occ": "Open CASCADE", "vtk": "VTK"}
TEXT = """\
*First picture* is from the file: of ours the whole process, with the device, the driver's pipelines and the PNG; of
the others from the first byte read to the first frame, without the start of their process, with the window. *Turning*
is a frame of a turn by three degrees each: of ours with the picture read back to host memory, of the others until it
is shown; *standing* is one of a view that stands, as a viewer draws it. Errors are judged by the kernel's rays
against surfaces and trims, at pixels where the face changes; *99.9 %* is exceeded by one in a thousand of them. One
picture of the triangles is judged for all viewers that draw them. Claimed is the first picture within half a pixel of
files of a megabyte and more.

*Where our turning frame goes* is the limit of such a frame on a processor that draws. Its first row is this engine as
a viewer of facets: it draws the mesh within a thousandth of the diagonal, the same that the viewers draw. The rows
below are a frame of the exact surfaces, pass by pass; what it takes beyond the first row is the price of exactness."""


def measure(context):
    section = Section(1, "Time against error, surfaces", TEXT)
    section.promises.append(Promise("no boundary pixel beyond the tolerance, by the kernel's rays"))
    files = context.pick(FILES_QUICK, FILES)
    for name in files:
        model = context.model(name)
        if model is None:
            section.contests.append(Contest(f"first picture, {name}", "all", "s", why=context.absent(name).why))
            continue
        for size in context.pick(SIZES_QUICK, SIZES if name in ALL_SIZES else SIZES[1:2]):
            context.say(f"{name}, {size[0]}x{size[1]}")
            Case(context, model, size).into(section)
    promise = section.promises[0]
    if not promise.cases:
        promise.why = "no kernel to judge by"
    return section


class Case:
    """One file at one size."""

    def __init__(self, context, model, size):
        self.context, self.model, self.size = context, model, size
        self.bounds = context.program.info(model)["bounds"]
        self.frames = 6
        self.camera = views.turned(self.bounds, size, 0)
        self.turn = views.turn(self.bounds, size, self.frames)
        self.tolerances = context.pick([0.5, 1.0], [0.1, 0.25, 0.5, 1.0, 4.0])
        self.deflections = context.pick([1e-2, 1e-3, 1e-4, 1e-5], [1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
        self.f3d_deflections = context.pick([1e-3, 1e-4], self.deflections)
        self.most_mesh_s = context.pick(10, 30)
        self.what = f"{model.name}, {size[0]}x{size[1]}"

    def ours(self):
        """By tolerance: seconds to the first picture, milliseconds of a frame that turns, and that stands or None."""
        found = {}
        for tolerance in self.tolerances:
            first = self.context.program.render(self.model, self.camera, "--tolerance", tolerance, stats=False)
            turning = self.bench("turn", tolerance)["wall clock, with read-back"]
            standing = None
            if tolerance == STANDING_PX:
                standing = self.bench("still", tolerance)["reused: wall clock, with read-back"]
            found[tolerance] = (first["seconds"], turning, standing)
        return found

    def bench(self, motion, tolerance, model=None):
        """Medians by name; of the file, unless another is named."""
        words = ["--motion", motion, "--judged", 0, "--frames", self.frames, "--tolerance", tolerance]
        words += ["--size", "{}x{}".format(*self.size)]
        return self.context.program.bench([model or self.model], *words)[0]["of"]

    def spent(self, section, stl):
        """Where a turning frame goes, beside one of the same engine that draws the mesh `stl`."""
        exact, faceted = self.bench("turn", STANDING_PX), self.bench("turn", STANDING_PX, stl) if stl else None
        columns = ["", "passes, ms", "of the exact frame", "wall clock, ms"]
        section.tables.append(Table(f"{self.what}: where our turning frame goes", columns, spent_rows(exact, faceted)))

    def job(self, **more):
        return {
            "model": str(self.model),
            "camera": self.camera,
            "turn": self.turn,
            "most_mesh_s": self.most_mesh_s,
            **more,
        }

    def meshed(self):
        """The same by viewer and deflection; the reason if the mesher was stopped."""
        self.context.peers.needed("Open CASCADE")
        self.context.peers.needed("VTK")
        job = self.job(deflections=self.deflections, ids=None, wants=list(VIEWERS))
        head, *results = self.context.peers.results("meshed", job, windowed=True, limit_s=self.most_mesh_s * 20)
        found = {name: {} for name in VIEWERS.values()}
        for result in results:
            for key, name in VIEWERS.items():
                timed = result.get(key)
                if timed:
                    first = head["read_s"] + result["mesh_s"] + timed["first_s"]
                    found[name][result["deflection"]] = (first, timed["turning_ms"], timed["standing_ms"])
        return found

    def f3d(self):
        self.context.peers.needed("F3D")
        diagonal = sum((b - a) ** 2 for a, b in zip(*self.bounds)) ** 0.5
        job = self.job(deflections=[d * diagonal for d in self.f3d_deflections])
        results = self.context.peers.results("f3d_viewer", job, windowed=True, limit_s=self.most_mesh_s * 20)
        return {
            d: (r["first_s"], r["turning_ms"], r["standing_ms"])
            for d, r in zip(self.f3d_deflections, results)
            if "first_s" in r
        }

    def judged(self):
        """Errors by the kernel: of our tolerances, of deflections; the counts of the boundary."""
        self.context.peers.needed("Open CASCADE")
        folder = self.context.program.folder()
        job = self.job(deflections=self.deflections, ids=str(folder), wants=[]) | {"turn": []}
        results = self.context.peers.results("meshed", job, windowed=True, limit_s=self.most_mesh_s * 20)
        pictures = {f"mesh {r['deflection']}": {"path": r["ids"], "own": False} for r in results if r.get("ids")}
        stl = next((r["stl"] for r in results if r.get("ids") and r["deflection"] == FACETED), None)
        for tolerance in sorted(self.tolerances, reverse=True):
            drawn = self.context.program.render(
                self.model, self.camera, "--tolerance", tolerance, images=["face"], stats=False
            )
            pictures[f"ours {tolerance}"] = {"path": str(drawn["face"]), "own": True}
        seconds = self.context.pick(6, 8)
        whole = {"whole": {"camera": self.camera, "pictures": pictures}}
        job = {"model": str(self.model), "views": whole, "seconds": seconds}
        (head,) = self.context.peers.results("kernel", job, limit_s=60 + seconds * (1 + len(pictures)))
        return head, head["pictures"], stl

    def into(self, section):
        """Measures, and adds the results."""
        seconds = self.context.pick(45, 110)
        results = rounds(
            {"ours": self.ours, "meshed": self.meshed, "F3D": self.f3d}, seconds, most=self.context.pick(3, 5)
        )
        if isinstance(results["ours"], Unmeasurable):
            raise results["ours"]
        try:
            head, errors, stl = self.judged()
        except Unmeasurable as error:
            head, errors, stl = {"boundary": 0, "sampled": 0, "alone": 0}, {}, None
            section.contests.append(Contest(f"errors, {self.what}", "the kernel", "px", why=str(error)))
        competitors = {"selvedge": ("ours", results["ours"])}
        for name in VIEWERS.values():
            found = results["meshed"]
            competitors[name] = ("mesh", found if isinstance(found, Unmeasurable) else [one[name] for one in found])
        competitors["F3D"] = ("mesh", results["F3D"])
        self.table(section, competitors, head, errors)
        self.spent(section, stl)
        self.plots(section, competitors, errors)
        self.contests(section, competitors, errors)
        for tolerance in self.tolerances:
            error = errors.get(f"ours {tolerance}")
            if error:
                # a search finds a boundary no nearer than the next of its distances
                section.promises[0].violations += beyond(error, tolerance)
                section.promises[0].cases += head["boundary"]

    def settings(self, found):
        """Settings that every round has."""
        return [s for s in found[0] if all(s in one for one in found)] if found else []

    def table(self, section, competitors, head, errors):
        rows = []
        for name, (kind, found) in competitors.items():
            if isinstance(found, Unmeasurable):
                rows.append([name, "", *[Missing(str(found))] * 3, "", "", ""])
                continue
            for setting in self.settings(found):
                times = [None if None in of else statistics.median(of) for of in zip(*(one[setting] for one in found))]
                error = errors.get(f"{kind} {setting}")
                worst = (
                    [
                        f"> {error['worst_px'] / 2:g}" if error["beyond"] else error["worst_px"],
                        error["p999_px"],
                        error["off"],
                    ]
                    if error
                    else [""] * 3
                )
                unit = f"{setting:g} px" if kind == "ours" else f"{setting:g} of the diagonal"
                rows.append([name, unit, *times, *worst])
        text = (
            f"{head['boundary']:,} pixels at changes of face judged, {head['alone']} left out at which both our finest "
            "picture and the finest mesh are off the rays."
        )
        columns = [
            "",
            "within",
            "first picture, s",
            "turning, ms",
            "standing, ms",
            "worst, px",
            "99.9 %, px",
            "pixels off",
        ]
        section.tables.append(Table(self.what, columns, rows, text))

    def curve(self, kind, found, errors, k):
        """`(error, time)` of each setting, times of one round or the medians of all."""
        points = []
        for setting in self.settings(found):
            error = errors.get(f"{kind} {setting}")
            times = [one[setting][k] for one in found]
            if error and None not in times:
                points.append((max(error["p999_px"], LEAST_PX), statistics.median(times)))
        return points

    def plots(self, section, competitors, errors):
        for k, (quantity, unit) in enumerate(QUANTITIES[:2]):
            lines = [
                Line(name, front(self.curve(kind, found, errors, k)), name == "selvedge")
                for name, (kind, found) in competitors.items()
                if not isinstance(found, Unmeasurable)
            ]
            if any(line.points for line in lines):
                key = f"{self.model.stem}-{self.size[0]}-{quantity.split()[0]}"
                section.plots.append(
                    Plot(key, f"{quantity}: {self.what}", "99.9 % boundary error, px", f"{quantity}, {unit}", lines)
                )

    def contests(self, section, competitors, errors):
        """At each error, our quickest tolerance beside the peer's quickest deflection, round by round."""
        ours = competitors["selvedge"][1]
        for name, (kind, found) in competitors.items():
            if name == "selvedge":
                continue
            for k, (quantity, unit) in enumerate(QUANTITIES):
                if isinstance(found, Unmeasurable) or not errors:
                    why = str(found) if isinstance(found, Unmeasurable) else "no kernel to judge by"
                    section.contests.append(Contest(f"{quantity}, {self.what}", name, unit, why=why))
                    continue
                before = None
                for error in ERRORS:
                    contest = self.contest(
                        f"{quantity}, {self.what}, within {error:g} px", name, unit, kind, ours, found, errors, k, error
                    )
                    # a larger error that changes neither side's setting is the same contest
                    sides = contest and (contest.ours, contest.theirs, contest.why)
                    if contest and sides != before:
                        section.contests.append(contest)
                    before = sides

    def contest(self, what, name, unit, kind, ours, found, errors, k, error):
        """None if our own settings do not reach the error."""
        best = lambda kind, one: noise.quickest_within(self.curve(kind, [one], errors, k), error)
        mine, theirs = [best("ours", one) for one in ours], [best(kind, one) for one in found]
        if None in mine:
            return None
        if not any(self.curve(kind, [one], errors, k) for one in found):
            return Contest(what, name, unit, why="no setting of its was both timed and judged")
        large = self.model.stat().st_size >= CLAIMED_BYTES
        claim = "ahead" if k == 0 and error <= CLAIMED_PX and large else "open"
        if None in theirs:
            return Contest(what, name, unit, claim=claim, unreached=True, why="none of its settings is as right")
        many = min(len(mine), len(theirs))
        return Contest(what, name, unit, mine[:many], theirs[:many], claim)


def spent_rows(exact, faceted):
    """Rows of a frame of the exact surfaces by pass, the longest first, after one of facets; of medians by name."""
    wall, whole = "wall clock, with read-back", exact["all passes"]
    passes = {name.removeprefix("pass: "): ms for name, ms in exact.items() if name.startswith("pass: ")}
    large = sorted(((ms, name) for name, ms in passes.items() if ms >= SMALL_SHARE * whole), reverse=True)
    rows = [["facets, by this engine", faceted["all passes"], "", faceted[wall]] if faceted else None]
    rows.append(["exact surfaces", whole, "100 %", exact[wall]])
    rows += [[name, ms, f"{100 * ms / whole:.0f} %", ""] for ms, name in large]
    rows.append(["all others", sum(passes.values()) - sum(ms for ms, _ in large), "", ""])
    return [row for row in rows if row]


def front(curve):
    """The quickest setting of each error."""
    return [(off, min(time for other, time in curve if other == off)) for off in sorted({off for off, _ in curve})]


def beyond(error, tolerance):
    """Pixels that were searched and are right nowhere within the tolerance: what is `worst` beyond it counts as one."""
    return error["beyond"] if error["beyond"] else int(error["worst_px"] > tolerance)
