"""4. Boolean solids: three ways of ours, OpenSCAD's preview, Manifold's triangles, POV-Ray."""

import statistics

from .. import bumpy, claims, floor, scenes, views
from ..budget import cases
from ..rows import Contest, Missing, Promise, Table, error_cells
from ..turns import Late, Overdue, Unmeasurable, rounds

WAYS = ["events", "cst", "blister"]
SCENES_QUICK = ["widget", "complex", "gear"]
SCENES = [*SCENES_QUICK, "plate100", "plate1000"]
# shares of a whole run's time, beside a scene's 1: the thousand holes, and the two meshes; share of a scene's time for
# its rounds
WEIGHTS, ROUNDS_SHARE = {"plate1000": 3.0, "meshes": 1.6}, 0.75
# seconds of one way on a mesh
MESH_S = 120
# facets around a round primitive
SEGMENTS_QUICK, SEGMENTS = [64], [32, 128]
# degrees from top to bottom: OpenSCAD's fixed field of view
FOV_DEG = 22.5
# factor on the eye's distance: every way draws the whole solid within the picture
AWAY = 1.02
TITLE = "Boolean solids"
TEXT = """\
The scenes have the numbers of primitives of the models of J. Hable and J. Rossignac, *Blister*, SIGGRAPH 2005, which
are not public. *First picture* is the whole process of ours, OpenSCAD and POV-Ray, from the file to a PNG. Of Manifold
it is evaluation and VTK's window and first frame, without the start of its process. *Turning* is a frame of a turn by
three degrees each; OpenSCAD and POV-Ray draw no turn. Ours have smooth borders, and the first picture ambient
occlusion; the others have neither. Errors are those of the outline, by rays through the primitives'
own equations. The number beside OpenSCAD and Manifold is that of facets around a round primitive. A blank OpenSCAD
preview (a cube) and our plane show what the start of each process takes."""


def measure(context, section):
    section.promises.append(Promise("an outline within half a pixel, by the primitives' equations"))
    section.promises.append(Promise("a pixel of a solid right within half a pixel, by the project's reference"))
    blank(context, section)
    ways = []
    weights = dict.fromkeys(context.pick(SCENES_QUICK, SCENES), 1.0)
    for name, seconds in cases(context.budget, weights | context.pick({}, WEIGHTS)):
        try:
            if name == "meshes":
                continue
            if isinstance(seconds, Late):
                raise seconds
            context.say(f"{name}: {seconds:.0f} s")
            case = Case(context, name, seconds)
            case.into(section)
            ways += way_rows(name, len(case.scene.primitives), case.benches)
        except Late as late:
            section.contests.append(Contest(f"first picture, {name}", "all", "s", why=str(late)))
        except Unmeasurable as error:
            section.failure = section.failure or f"{name}: {error}"
    ways += bunnies(context)
    head = [
        "scene",
        "primitives",
        "way",
        "solids, ms",
        "turning frame, ms",
        "layers",
        "paper: peeled, in all",
        "paper, s",
        "of the way, MiB",
        "transient, MiB",
    ]
    text = "Medians of pass `solids` and of the wall clock; the paper's figures are of a GeForce 6800, of other models."
    section.tables.append(Table("Our ways beside the paper's", head, ways, text))
    if not section.promises[0].cases:
        section.promises[0].why = "no picture was judged"


class Case:
    """One scene."""

    def __init__(self, context, name, seconds):
        self.context, self.name, self.seconds = context, name, seconds
        self.scene = scenes.of_name(name)
        self.folder = context.program.folder()
        self.file = self.folder / f"{name}.toml"
        self.file.write_text(scenes.toml(self.scene))
        bounds = context.program.info(self.file)["bounds"]
        size = context.pick((640, 480), (800, 600))
        self.frames = 4
        self.camera = self.view(bounds, size, 0)
        self.turn = [self.view(bounds, size, step) for step in range(self.frames)]
        self.size = "{}x{}".format(*size)
        self.segments = context.pick(SEGMENTS_QUICK, SEGMENTS)
        self.benches = []
        self.pictures = {}

    def view(self, bounds, size, step):
        camera = views.turned(bounds, size, step, FOV_DEG)
        camera["eye"] = [t + AWAY * (e - t) for e, t in zip(camera["eye"], camera["target"])]
        return camera

    def ours(self):
        """For each way: seconds to the first picture, and the report of a turn."""
        found = {}
        for way in WAYS:
            first = self.context.program.render(self.file, self.camera, "--solids", way, images=["face"], stats=False)
            options = ["--motion", "turn", "--solids", way, "--frames", self.frames, "--judged", 1, "--size", self.size]
            (report,) = self.context.program.bench([self.file], *options)
            self.pictures[f"selvedge, {way}"] = str(first["face"])
            found[way] = (first["seconds"], report)
        self.benches.append({way: report for way, (_, report) in found.items()})
        return {
            f"selvedge, {way}": (first, report["of"]["wall clock, with read-back"])
            for way, (first, report) in found.items()
        }

    def openscad(self):
        self.context.peers.needed("OpenSCAD")
        found = {}
        for segments in self.segments:
            file, picture = self.folder / f"{segments}.scad", self.folder / f"{segments}.png"
            file.write_text(scenes.scad(self.scene, segments))
            at = ",".join(f"{x:.9f}" for x in [*self.camera["eye"], *self.camera["target"]])
            size = "{},{}".format(*self.camera["size"])
            took = previewed(self.context, file, picture, [f"--camera={at}", f"--imgsize={size}"])
            name = f"OpenSCAD, {segments}"
            self.pictures[name] = str(picture)
            found[name] = (took, None)
        return found

    def manifold(self):
        self.context.peers.needed("Manifold")
        self.context.peers.needed("VTK")
        job = {
            "scene": self.scene.data(),
            "segments": self.segments,
            "camera": self.camera,
            "turn": self.turn,
            "folder": str(self.folder),
        }
        found = {}
        for one in self.context.peers.results(
            "manifold_viewer", job, windowed=True, limit_s=60
        ):
            name = f"Manifold, {one['segments']}"
            self.pictures[name] = one["picture"]
            found[name] = (one["evaluate_s"] + one["first_s"], one["turning_ms"])
        return found

    def povray(self):
        self.context.peers.needed("POV-Ray")
        file, picture = self.folder / "scene.pov", self.folder / "pov.png"
        file.write_text(scenes.pov(self.scene, self.camera))
        width, height = self.camera["size"]
        _, problem, took = self.context.peers.run(
            ["povray", f"+I{file}", f"+O{picture}", f"+W{width}", f"+H{height}", "-D", "-A", "+FN8"],
            60,
        )
        if problem or not picture.exists():
            raise self.context.peers.error(f"POV-Ray drew nothing: {problem or 'no picture'}")
        self.pictures["POV-Ray"] = str(picture)
        return {"POV-Ray": (took, None)}

    def into(self, section):
        competitors = {
            "selvedge": self.ours,
            "OpenSCAD": self.openscad,
            "Manifold": self.manifold,
            "POV-Ray": self.povray,
        }
        seconds, most = ROUNDS_SHARE * self.seconds, self.context.pick(3, 5)
        results = rounds(competitors, seconds, most=most, left=self.context.budget.left)
        if isinstance(results["selvedge"], Unmeasurable):
            raise results["selvedge"]
        errors, judged = self.errors(section)
        rows = []
        for name, found in results.items():
            if isinstance(found, Unmeasurable):
                rows.append([name, *[Missing(str(found))] * 2, "", "", ""])
                continue
            for setting in found[0]:
                first, turning = zip(*(one[setting] for one in found))
                turning = Missing("it draws single pictures only") if turning[0] is None else statistics.median(turning)
                error = errors.get(setting)
                rows.append([setting, statistics.median(first), turning, *error_cells(error)])
        text = f"{judged:,} pixels at the outline are judged."
        section.tables.append(
            Table(
                f"{self.name}, {self.size}",
                ["", "first picture, s", "turning, ms", "worst, px", "99.9 %, px", "pixels off"],
                rows,
                text,
            )
        )
        self.causes = [floor.cause(self.context, self.camera["size"]), self.frame_cause()]
        self.contests(section, results)
        for way in WAYS:
            error = errors.get(f"selvedge, {way}")
            if error:
                section.promises[0].cases += judged
                section.promises[0].violations += sum(distance > 0.5 for distance in error["distances_px"])
            for report in self.benches[:1]:
                section.promises[1].cases += report[way]["error"]["judged_pixels"]
                section.promises[1].violations += report[way]["error"]["wrong_pixels"]

    def frame_cause(self):
        """What of a turning frame the rays through the solid take."""
        median = lambda name: statistics.median(one["events"]["of"].get(name, 0.0) for one in self.benches)
        rays, whole = median("pass: solids"), median("wall clock, with read-back")
        return f"{self.name}: rays through the primitives' own equations take {rays:.1f} ms of our {whole:.1f} ms"

    def errors(self, section):
        try:
            job = {
                "scene": self.scene.data(),
                "camera": self.camera,
                "pictures": self.pictures,
                "seconds": self.context.pick(4, 8),
            }
            (found,) = self.context.peers.results("csg", job, limit_s=120 + 4 * job["seconds"])
        except Unmeasurable as error:
            section.contests.append(Contest(f"errors, {self.name}", "the equations", "px", why=str(error)))
            return {}, 0
        return found["pictures"], found["boundary"]

    def contests(self, section, results):
        """Way `events` beside the others, and beside our other ways."""
        ours = results["selvedge"]
        best = lambda one, k: one["selvedge, events"][k]
        for way in WAYS[1:]:
            theirs = [one[f"selvedge, {way}"][1] for one in ours]
            mine, what = [best(one, 1) for one in ours], f"turning frame, {self.name}"
            section.contests.append(Contest(what, f"way {way}", "ms", mine, theirs, claims.WAY_EVENTS))
        for name, found in results.items():
            if name == "selvedge":
                continue
            if isinstance(found, Unmeasurable):
                section.contests.append(Contest(f"first picture, {self.name}", name, "s", why=str(found)))
                continue
            for setting in found[0]:
                for k, quantity, unit in ((0, "first picture", "s"), (1, "turning frame", "ms")):
                    if found[0][setting][k] is not None:
                        many = min(len(ours), len(found))
                        mine, theirs = [best(one, k) for one in ours[:many]], [one[setting][k] for one in found[:many]]
                        what, cause = f"{quantity}, {self.name}", self.causes[k]
                        section.contests.append(Contest(what, setting, unit, mine, theirs, cause=cause))


def way_rows(name, primitives, benches):
    """Rows of the table beside the paper's figures, of rounds of reports by way."""
    rows = []
    paper = scenes.PAPER.get(name)
    for way in benches[0]:
        of = lambda quantity: statistics.median(one[way]["of"].get(quantity, 0.0) for one in benches)
        largest = benches[0][way]["largest"]
        mebibytes = lambda begins: sum(v for quantity, v in largest.items() if quantity.startswith(begins)) / 2**20
        blister = way == "blister"
        layers = [
            of("layers") if blister else "",
            f"{paper[0]}, {paper[1]}" if blister and paper else "",
            paper[2] if blister and paper else "",
        ]
        times = [of("pass: solids"), of("wall clock, with read-back")]
        rows.append([name, primitives, way, *times, *layers, mebibytes("solids: "), mebibytes("pool: transient")])
    return rows


def previewed(context, file, picture, options):
    """Seconds of OpenSCAD's preview of a file, the whole process."""
    command = ["xvfb-run", "-a", "openscad", "--preview", *options, "-o", picture, file]
    _, problem, took = context.peers.run(command, context.pick(30, 60))
    if problem or not picture.exists():
        raise context.peers.error(f"OpenSCAD drew nothing: {problem or 'no picture'}")
    return took


def blank(context, section):
    """The least that a process takes: OpenSCAD's preview of a cube beside our picture of one."""
    what, folder = "first picture, a cube", context.program.folder()
    ours, theirs = folder / "cube.toml", folder / "cube.scad"
    ours.write_text('selvedge = 1\n[solid.A]\nshape = "block"\nsize = [20, 20, 20]\n')
    theirs.write_text("cube([20, 20, 20]);\n")
    size = context.pick((640, 480), (800, 600))
    camera = {**floor.CAMERA, "size": list(size)}

    def preview():
        context.peers.needed("OpenSCAD")
        return previewed(context, theirs, folder / "cube.png", ["--imgsize={},{}".format(*size)])

    draw = lambda: context.program.render(ours, camera, stats=False)["seconds"]
    results = rounds({"ours": draw, "theirs": preview}, 0, left=context.budget.left)
    for found in results.values():
        if isinstance(found, Unmeasurable):
            section.contests.append(Contest(what, "OpenSCAD", "s", why=str(found)))
            return
    many = min(map(len, results.values()))
    mine, theirs = results["ours"][:many], results["theirs"][:many]
    section.contests.append(Contest(what, "OpenSCAD", "s", mine, theirs, cause=floor.cause(context, size)))


def bunnies(context):
    """The same with meshes as operands, without peers: the paper's numbers of triangles, and one round."""
    if context.quick:
        return [["bunny", 4, "", *[Missing("574,000 triangles take minutes: only without --quick")] * 2, *[""] * 5]]
    rows = []
    for name in bumpy.TRIANGLES:
        context.say(name)
        path = bumpy.scene(context.program.folder(), name)
        for way in WAYS:
            options = ["--motion", "turn", "--solids", way, "--frames", 2, "--judged", 0, "--size", "640x480"]
            try:
                context.budget.needed()
                (report,) = context.program.bench([path], *options, limit_s=MESH_S)
            except (Late, Overdue) as late:
                rows.append([name, 4, way, *[Missing(str(late))] * 2, *[""] * 5])
            else:
                rows += way_rows(name, 4, [{way: report}])
    return rows
