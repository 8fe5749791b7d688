"""1. Time against error: ours over tolerances, viewers of triangles over deflections, the same files, view and size
in turn."""

import statistics

from .. import claims, floor, noise, views
from ..budget import cases
from ..rows import Contest, Line, Missing, Plot, Promise, Table, error_cells
from ..turns import Late, Unmeasurable, rounds

# what is claimed comes first
FILES_QUICK = ["nist_pmi_2.stp", "samples/bracket.step", "first/occt_screw.step"]
FILES = ["nist_pmi_2.stp", "framework_printable_case_full.stp", "impeller.igs", *FILES_QUICK[1:]]
SMALL, MIDDLE, LARGE = (960, 540), (1920, 1080), (3840, 2160)
# shares of the time: what a case of this size costs beside one of the middle size, and a large file beside a small one
WEIGHTS, LARGE_FILE = {SMALL: 0.5, MIDDLE: 1.0, LARGE: 1.1}, 1.5
# tolerances, pixels, and deflections, shares of the diagonal: all at the middle size, and some at the others. The
# mesher's angle makes the meshes of 1e-2 and 1e-3 nearly the same
TOLERANCES_QUICK, TOLERANCES, TOLERANCES_OTHER = [0.5, 1.0], [0.1, 0.25, 0.5, 1.0, 4.0], [0.25, 0.5]
DEFLECTIONS_QUICK, DEFLECTIONS = [1e-2, 1e-3, 1e-4, 1e-5], [1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
DEFLECTIONS_OTHER = {SMALL: [1e-3, 1e-4], LARGE: [1e-3, 1e-4, 1e-5]}
# settings that every round repeats; the others are timed in the first one. A peer's others are finer than all of these,
# and so slower: no contest misses the peer's quickest setting
REPEATED = {"ours": [0.25, 0.5, 1.0], "meshed": [1e-2, 1e-3, 1e-4], "F3D": [1e-2, 1e-3, 1e-4]}
# share of a case's time for its rounds; the rest is for the pictures and the judge
ROUNDS_SHARE = 0.65
# seconds of a process of a peer, and the reason where it took longer
PEER_S, PROCESS = 150, "its process was "
# bounds on the error, pixels
ERRORS = [0.125, 0.25, 0.5, 1.0, 2.0]
# bytes of a large file
LARGE_BYTES = 1_000_000
# smallest error that a plot shows, pixels: the searches do not separate smaller ones
LEAST_PX = 1 / 16
# the measurements of each setting, in this order; the view of a turn's first frame has been drawn before: it stands
QUANTITIES = [("first picture", "s"), ("turning frame", "ms"), ("standing frame", "ms"), ("plain first picture", "s")]
# the tolerance of the frame that is shown pass by pass, and of the plain picture
SPENT_PX = 0.5
# a picture as the others draw theirs, trimmed as the one with smooth borders is
PLAIN = ["--ao", "none", "--smooth", "none", "--trim", "exact"]
# passes below this share of all are one row
SMALL_SHARE = 0.02
# the mesh that the engine draws as a viewer of facets
FACETED = 1e-3
# the bench's name of a frame from its recording to the picture in host memory
WALL = "wall clock, with read-back"
VIEWERS = {"occ": "Open CASCADE", "vtk": "VTK"}
RIGHT = "no boundary pixel beyond the tolerance, by the kernel's rays"
# why the judge has two readings of a file
WIDE = """\
The kernel widens each face by the tolerance of its edges. It is as large as the distance between an edge's curves in
space and in (u, v) at the same parameter, though the curves may lie in one place. We judge by the curves in (u, v).
Here are the pixels at which an edge, by a tolerance of up to {mm:.2g} mm, puts another face in front. They are judged
by the curves with all others; none is left out for this."""
TITLE = "Time against error, surfaces"
TEXT = """\
*First picture* is from the file: of ours the whole process, with the device, the driver's pipelines and the PNG; of
the others from the first byte read to the first frame, without the start of their process, with the window. *Turning*
is a frame of a turn by three degrees each: of ours with the picture read back to host memory, of the others until it
is shown. *Standing* is a frame of a view that stands, as a viewer draws it; of ours it is one frame a round. Errors
are judged by the kernel's rays against surfaces and trims, at pixels where the face changes; one in a thousand of them
exceeds *99.9 %*. A face that another one just hides is seen beside it where a border is off: by that distance. One
picture of the triangles is judged for all viewers that draw them.

The others draw one sample a pixel. Our first picture has ambient occlusion and smooth borders, as the program draws it
without options, and our frames have smooth borders, passes `borders` and `show`. *Plain first picture* is ours without
either, within half a pixel, beside the others' first picture. At 3840x2160 we claim nothing.

The first round times every setting. Later rounds repeat our tolerances of 0.25 to 1 px, and deflections of 0.01 to
0.0001. Column *rounds* has the number of rounds that timed a setting. A contest takes the rounds that timed both of its
sides; with fewer than three it is not measured. All settings are drawn at 1920x1080. The other sizes have our
tolerances of 0.25 and 0.5 px, and deflections of 0.001 and finer. Meshes become finer until the next one may take
longer than the limit: its row names the limit.

*Where our turning frame goes* is the cause of such a frame's time on a processor that draws. Its first row is this
engine as a viewer of facets: it draws the mesh within a thousandth of the diagonal, the same that the viewers draw.
The rows below are a frame of the exact surfaces, pass by pass; its time beyond the first row is the price of
exactness. At 3840x2160 the first row is left out."""


RATIOS = """\
At each error our quickest setting beside that of the quickest peer, theirs to ours: above 1 we are ahead. *Ours alone*:
no setting of a peer reaches the error. A cell is empty where we do not reach it, or where it was not measured."""


def measure(context, section):
    ratios = Table("Ratios to the quickest peer", ["", *(f"within {error:g} px" for error in ERRORS)], [], RATIOS)
    weights = {}
    for name, size in wanted(context):
        model = context.model(name)
        if model is None:
            section.contests.append(Contest(f"first picture, {name}", "all", "s", why=context.absent(name).why))
        else:
            weights[model, size] = WEIGHTS[size] * (LARGE_FILE if large(model) else 1.0)
    for (model, size), seconds in cases(context.budget, weights):
        what = f"{model.name}, {size[0]}x{size[1]}"
        try:
            if isinstance(seconds, Late):
                raise seconds
            context.say(f"{what}: {seconds:.0f} s")
            ratios.rows += Case(context, model, size, seconds).into(section)
        except Late as late:
            section.contests += [Contest(f"{name}, {what}", "all", unit, why=str(late)) for name, unit in QUANTITIES]
        except Unmeasurable as error:
            section.failure = section.failure or f"{what}: {error}"
    if ratios.rows:
        section.tables.append(ratios)
    if not section.promises:
        section.promises.append(Promise(RIGHT, why="the kernel did not judge the pictures"))


def large(model):
    return model.stat().st_size >= LARGE_BYTES


def wanted(context):
    """Files and sizes, those that tell most first."""
    if context.quick:
        return [(name, SMALL) for name in FILES_QUICK]
    return [(name, size) for size in (MIDDLE, SMALL, LARGE) for name in FILES]


class Case:
    """One file at one size, within so many seconds."""

    # the finest deflections are among those of the case
    finest = True

    def __init__(self, context, model, size, seconds):
        self.context, self.model, self.size, self.seconds = context, model, size, seconds
        self.bounds = context.program.info(model)["bounds"]
        # the first frame of a turn stands
        self.frames = context.pick(6, 3 if size == LARGE else 5)
        self.camera = views.turned(self.bounds, size, 0)
        self.turn = views.turn(self.bounds, size, self.frames)
        self.tolerances = context.pick(TOLERANCES_QUICK, TOLERANCES if size == MIDDLE else TOLERANCES_OTHER)
        self.deflections = context.pick(DEFLECTIONS_QUICK, DEFLECTIONS_OTHER.get(size, DEFLECTIONS))
        self.f3d_deflections = context.pick([1e-3, 1e-4], self.deflections)
        self.finest = self.deflections == self.f3d_deflections == DEFLECTIONS
        self.most_mesh_s = context.pick(10, 12)
        self.what = f"{model.name}, {size[0]}x{size[1]}"
        # competitors whose first round is done; then the reasons of settings that were not timed
        self.begun, self.stopped = set(), {}
        # images of faces and a mesh, which the first round of the viewers writes
        self.images, self.stl = {}, None
        # the last bench by tolerance
        self.benches = {}

    def settings_of(self, who, all_settings):
        """All settings in the first round, then those that are repeated."""
        return [s for s in all_settings if who not in self.begun or s in REPEATED[who]]

    def ours(self):
        """By tolerance: the figures of `QUANTITIES`, None for what was not drawn."""
        found = {}
        for tolerance in self.settings_of("ours", self.tolerances):
            first = self.first(tolerance)
            plain = self.first(tolerance, *PLAIN) if tolerance == SPENT_PX else None
            of = self.benches[tolerance] = self.bench(tolerance)
            found[tolerance] = (first, of[WALL], of.get(f"reused: {WALL}"), plain)
        self.begun.add("ours")
        return found

    def first(self, tolerance, *options):
        """Seconds of a process that draws the first picture."""
        words = ["--tolerance", tolerance, *options]
        return self.context.program.render(self.model, self.camera, *words, stats=False)["seconds"]

    def bench(self, tolerance, model=None):
        """Medians of a turn by name; of the file, unless another is named."""
        words = ["--motion", "turn", "--judged", 0, "--frames", self.frames, "--tolerance", tolerance]
        words += ["--size", "{}x{}".format(*self.size)]
        return self.context.program.bench([model or self.model], *words)[0]["of"]

    def spent(self, section):
        """Adds where a turning frame goes; the causes of frames. Except at the largest size, one of this engine with
        the viewers' mesh stands beside it."""
        exact = self.benches[SPENT_PX]
        faceted = self.bench(SPENT_PX, self.stl) if self.stl and self.size != LARGE else None
        columns = ["", "passes, ms", "of the exact frame", "wall clock, ms"]
        section.tables.append(Table(f"{self.what}: where our turning frame goes", columns, spent_rows(exact, faceted)))
        cause, stands = frame_cause(exact, faceted), standing_cause(exact)
        return {"turning frame": f"{self.what}: {cause}", "standing frame": f"{self.what}: {stands}" if stands else ""}

    def job(self, **more):
        return {
            "model": str(self.model),
            "camera": self.camera,
            "turn": self.turn,
            "most_mesh_s": self.most_mesh_s,
            **more,
        }

    def meshed(self):
        """The same by viewer and deflection."""
        self.context.peers.needed("Open CASCADE")
        self.context.peers.needed("VTK")
        # the first round writes the images that are judged
        folder = None if "meshed" in self.begun else str(self.context.program.folder())
        deflections = self.settings_of("meshed", self.deflections)
        job = self.job(deflections=deflections, ids=folder, wants=list(VIEWERS))
        head, *results = self.context.peers.results("meshed", job, windowed=True, limit_s=PEER_S)
        found = {name: {} for name in VIEWERS.values()}
        for result in results:
            for key, name in VIEWERS.items():
                timed = result.get(key)
                if timed:
                    first = head["read_s"] + result["mesh_s"] + timed["first_s"]
                    found[name][result["deflection"]] = (first, timed["turning_ms"], timed["standing_ms"], first)
            if result.get("ids"):
                self.images[result["deflection"]] = result["ids"]
                self.stl = result["stl"] if result["deflection"] == FACETED else self.stl
        self.why("meshed", deflections, results)
        self.begun.add("meshed")
        return found

    def f3d(self):
        self.context.peers.needed("F3D")
        diagonal = sum((b - a) ** 2 for a, b in zip(*self.bounds)) ** 0.5
        deflections = self.settings_of("F3D", self.f3d_deflections)
        job = self.job(deflections=[d * diagonal for d in deflections])
        results = self.context.peers.results("f3d_viewer", job, windowed=True, limit_s=PEER_S)
        found = {
            d: (r["first_s"], r["turning_ms"], r["standing_ms"], r["first_s"])
            for d, r in zip(deflections, results)
            if "first_s" in r
        }
        self.why("F3D", deflections, results)
        self.begun.add("F3D")
        return found

    def why(self, who, deflections, results):
        """Keeps the reasons of the deflections that were not drawn: the mesher's limit, or that of the process."""
        for k, deflection in enumerate(deflections):
            if k >= len(results):
                self.stopped[who, deflection] = f"{PROCESS}{self.context.peers.problem}"
            elif "stopped" in results[k]:
                self.stopped[who, deflection] = results[k]["stopped"]

    def pictures(self):
        """Our images of faces, the coarsest first; they also warm the caches of files."""
        for tolerance in sorted(self.tolerances, reverse=True):
            drawn = self.context.program.render(
                self.model, self.camera, "--tolerance", tolerance, images=["face"], stats=False
            )
            yield f"ours {tolerance}", {"path": str(drawn["face"]), "own": True}

    def judged(self, ours):
        """Errors by the kernel, of our tolerances and of deflections, and the counts of the boundary."""
        self.context.peers.needed("Open CASCADE")
        meshes = {f"mesh {d}": {"path": path, "own": False} for d, path in self.images.items()}
        pictures = {**meshes, **ours}
        seconds = self.context.pick(5, 6)
        whole = {"whole": {"camera": self.camera, "pictures": pictures}}
        job = {"model": str(self.model), "views": whole, "seconds": seconds}
        (head,) = self.context.peers.results("kernel", job, limit_s=60 + seconds * (1 + len(pictures)))
        return head, head["pictures"]

    def into(self, section):
        """Measures, and adds the results; rows of ratios by error."""
        pictures = dict(self.pictures())
        competitors = {"ours": self.ours, "meshed": self.meshed, "F3D": self.f3d}
        seconds, most = ROUNDS_SHARE * self.seconds, self.context.pick(3, 5)
        results = rounds(competitors, seconds, most=most, left=self.context.budget.left)
        if isinstance(results["ours"], Unmeasurable):
            raise results["ours"]
        try:
            head, errors = self.judged(pictures)
        except Unmeasurable as error:
            head, errors = {"boundary": 0, "sampled": 0, "alone": 0, "widened": 0}, {}
            section.contests.append(Contest(f"errors, {self.what}", "the kernel", "px", why=str(error)))
        competitors = {"selvedge": ("ours", results["ours"])}
        for name in VIEWERS.values():
            found = results["meshed"]
            competitors[name] = ("mesh", found if isinstance(found, Unmeasurable) else [one[name] for one in found])
        competitors["F3D"] = ("mesh", results["F3D"])
        self.table(section, competitors, head, errors)
        self.readings(section, head, errors)
        causes = {}
        try:
            causes = self.spent(section)
            causes["first picture"] = floor.cause(self.context, self.size)
        except Late as late:  # the rows stay; they have no cause beside them
            section.contests.append(Contest(f"causes, {self.what}", "all", "ms", why=str(late)))
        self.plots(section, competitors, errors)
        ratios = self.contests(section, competitors, errors, causes)
        promise = Promise(f"{RIGHT}, {self.what}")
        for tolerance in self.tolerances:
            error = errors.get(f"ours {tolerance}")
            if error:
                promise.violations += beyond(error, tolerance)
                promise.cases += head["boundary"]
        if promise.cases:
            section.promises.append(promise)
        return ratios

    def settings(self, found):
        """Settings that a round timed."""
        return list(dict.fromkeys(s for one in found for s in one))

    def table(self, section, competitors, head, errors):
        rows = []
        for name, (kind, found) in competitors.items():
            if isinstance(found, Unmeasurable):
                rows.append([name, "", *[Missing(str(found))] * len(QUANTITIES), *[""] * 4])
                continue
            who = {"selvedge": "ours", "F3D": "F3D"}.get(name, "meshed")
            for setting in self.settings(found):
                timed = [one[setting] for one in found if setting in one]
                times = [None if None in of else statistics.median(of) for of in zip(*timed)]
                error = errors.get(f"{kind} {setting}")
                unit = f"{setting:g} px" if kind == "ours" else f"{setting:g} of the diagonal"
                times = ["" if time is None else time for time in times]
                rows.append([name, unit, *times, len(timed), *error_cells(error)])
            for (of, deflection), why in self.stopped.items():
                if of == who and deflection not in self.settings(found):
                    rows.append([name, f"{deflection:g} of the diagonal", *[Missing(why)] * len(QUANTITIES), *[""] * 4])
        text = (
            f"Judged are {head['boundary']:,} pixels at changes of face. Left out are {head['alone']:,}, at which our "
            "finest picture and the finest mesh both differ from the rays."
        )
        columns = [
            "",
            "within",
            "first picture, s",
            "turning, ms",
            "standing, ms",
            "plain first, s",
            "rounds",
            "worst, px",
            "99.9 %, px",
            "pixels off",
        ]
        section.tables.append(Table(self.what, columns, rows, text))

    def readings(self, section, head, errors):
        """Adds what our pictures show where the kernel's tolerance of an edge hides what its curves show."""
        if not head["widened"]:
            return
        of = {tolerance: errors.get(f"ours {tolerance}") for tolerance in self.tolerances}
        rows = [[f"{tolerance:g} px", head["widened"], *error["readings"]] for tolerance, error in of.items() if error]
        columns = ["selvedge within", "pixels", "by the curves", "by the tolerance of an edge", "neither"]
        title = f"{self.what}: where the kernel's edges are wide"
        section.tables.append(Table(title, columns, rows, WIDE.format(mm=head["edge_mm"])))

    def curve(self, kind, found, errors, k):
        """`(error, time)` of each setting, times of one round or the medians of those that timed it."""
        points = []
        for setting in self.settings(found):
            error = errors.get(f"{kind} {setting}")
            times = [one[setting][k] for one in found if setting in one]
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

    def contests(self, section, competitors, errors, causes):
        """At each error, our quickest tolerance beside the peer's quickest deflection, round by round; rows of the
        least ratio of all peers."""
        ours, least = competitors["selvedge"][1], {}
        for name, (kind, found) in competitors.items():
            if name == "selvedge":
                continue
            for k, (quantity, unit) in enumerate(QUANTITIES):
                if isinstance(found, Unmeasurable) or not errors:
                    why = str(found) if isinstance(found, Unmeasurable) else "the kernel did not judge the pictures"
                    section.contests.append(Contest(f"{quantity}, {self.what}", name, unit, why=why))
                    continue
                before = None
                for error in ERRORS:
                    contest = self.contest(
                        f"{quantity}, {self.what}, within {error:g} px", name, unit, kind, ours, found, errors, k, error
                    )
                    if contest and (contest.unreached or contest.ratio()):
                        least.setdefault((k, error), []).append(contest)
                    # a larger error that changes neither side's setting is the same contest
                    sides = contest and (contest.ours, contest.theirs, contest.why)
                    if contest and sides != before:
                        contest.cause = causes.get(quantity, "")
                        section.contests.append(contest)
                    before = sides
        return [
            [f"{quantity}, {self.what}", *(least_ratio(least.get((k, error), [])) for error in ERRORS)]
            for k, (quantity, _) in enumerate(QUANTITIES)
        ]

    def quickest(self, kind, found, errors, k, error):
        """The quickest time within the error, by round; None in a round without one. Settings that are timed too seldom
        to know their noise count only where no other is within the error: the rounds of a side compare alike."""
        count = lambda setting: sum(setting in one for one in found)
        often = {s for s in self.settings(found) if count(s) >= noise.FEWEST_ROUNDS}
        within = lambda one: noise.quickest_within(self.curve(kind, [one], errors, k), error)
        times = [within({s: of for s, of in one.items() if s in often}) for one in found]
        return times if any(times) else [within(one) for one in found]

    def contest(self, what, name, unit, kind, ours, found, errors, k, error):
        """None if our own settings do not reach the error."""
        mine, theirs = self.quickest("ours", ours, errors, k, error), self.quickest(kind, found, errors, k, error)
        if not any(mine):
            return None
        if not self.curve(kind, found, errors, k):
            return Contest(what, name, unit, why="none of its settings was both timed and judged")
        claim = claims.first_picture(self.model.name, self.size, error) if k == 0 else "open"
        if not any(theirs):
            stopped = [why for (who, _), why in self.stopped.items() if who == ("F3D" if name == "F3D" else "meshed")]
            cut = next((why for why in stopped if why.startswith(PROCESS)), None)
            if cut:
                return Contest(what, name, unit, claim=claim, why=cut)
            why = "none of its settings has so small an error"
            if not (stopped or self.finest):  # a setting that was not tried is no win
                return Contest(what, name, unit, claim=claim, why=f"{why}; finer meshes are drawn at 1920x1080 only")
            why += f"; a finer one is beyond the limit: {stopped[0]}" if stopped else ""
            return Contest(what, name, unit, claim=claim, unreached=True, why=why)
        both = [(a, b) for a, b in zip(mine, theirs) if a and b]
        if not both:
            return Contest(what, name, unit, claim=claim, why="no round timed both sides")
        return Contest(what, name, unit, *map(list, zip(*both)), claim)


def least_ratio(contests):
    """The least ratio, with its peer, as a cell; peers that reach no such error are behind."""
    measured = [(contest.ratio().median, contest.peer) for contest in contests if not contest.unreached]
    if measured:
        ratio, peer = min(measured)
        return f"{ratio:.2f} {peer}"
    return "ours alone" if contests else ""


def frame_cause(exact, faceted):
    """The price of exactness in a turning frame, as a sentence; of medians by name."""
    shares = ", ".join(f"{name} {share}" for name, _, share, _ in spent_rows(exact, None)[1:4] if share)
    surfaces = f"a turning frame of the exact surfaces takes {exact[WALL]:.0f} ms (of its passes {shares})"
    return f"{surfaces}, one of the viewers' facets {faceted[WALL]:.0f} ms by this engine" if faceted else surfaces


def standing_cause(exact):
    """What a standing frame computes again, as a sentence; empty without such frames."""
    passes = [(ms, name.removeprefix("reused: pass: ")) for name, ms in exact.items() if "reused: pass: " in name]
    if not passes:
        return ""
    whole, (longest, name) = exact["reused: all passes"], max(passes)
    return f"a standing frame takes {whole:.0f} ms of passes, {longest:.0f} of them {name}"


def spent_rows(exact, faceted):
    """Rows of a frame of the exact surfaces by pass, the longest first, after one of facets; of medians by name."""
    wall, whole = WALL, exact["all passes"]
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
    """Pixels that were searched and are right nowhere within the tolerance."""
    return sum(distance > tolerance for distance in error["distances_px"])
