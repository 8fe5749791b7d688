"""A program and peers that do nothing but let a clock run: what each call would take, on two cores without a GPU.

`speed` 1 is a machine on which a process of ours takes 2 s at 1920x1080 and 7 s at 3840x2160; figures of small pictures
are those of docs/benchmarks.md. Files are as heavy as nist_pmi_2.stp, or light.
"""

from pathlib import Path

from report.turns import Unmeasurable

KERNEL = {"worst_px": 0.25, "p999_px": 0.125, "off": 3, "searched": 3, "beyond": 0, "distances_px": [0.0625, 0.125, 0.25], "readings": [1, 0, 0]}
# files of a hundred kilobytes, and their work beside that of the others
LIGHT, LIGHTER = {"bracket.step", "occt_screw.step", "panel.step"}, 0.5
# seconds to read a file and mesh it within a share of its diagonal
READ_S, MESH_S = 2.5, {1e-2: 0.2, 1e-3: 0.3, 1e-4: 0.6, 1e-5: 5.0, 1e-6: 40.0}


class Clock:
    def __init__(self, speed=1.0):
        self.now, self.speed, self.spent = 0.0, speed, {}

    def __call__(self):
        return self.now

    def spend(self, who, seconds, limit_s):
        """Lets the clock run, at most to the limit; whether the work was done."""
        seconds /= self.speed
        runs, took = self.spent.get(who, (0, 0.0))
        done = min(seconds, limit_s)
        self.now += done
        self.spent[who] = runs + 1, took + done
        return seconds <= limit_s


def pixels(size):
    width, height = size if not isinstance(size, str) else map(int, size.split("x"))
    return width * height / 1e6


def weight(model):
    return LIGHTER if Path(model).name in LIGHT else 1.0


def option(words, name, default=None):
    words = list(map(str, words))
    return words[words.index(name) + 1] if name in words else default


class Program:
    def __init__(self, clock, scratch):
        self.clock, self.scratch, self.path, self.on = clock, scratch, Path(__file__), []
        self.device, self.budget, self.count = "llvmpipe (pretended)", None, 0

    def folder(self):
        self.count += 1
        folder = self.scratch / f"run{self.count}"
        folder.mkdir(parents=True)
        return folder

    def spend(self, what, seconds, limit_s=600):
        limit_s, error = self.budget.ended(limit_s)
        if not self.clock.spend(what, seconds, limit_s):
            raise error(f"selvedge {what} was not done in {limit_s:.0f} s")

    def info(self, _model):
        self.spend("info", 0.3)
        return {"bounds": [[0.0, 0.0, 0.0], [10.0, 10.0, 10.0]]}

    def render(self, model, camera, *options, images=(), stats=True):
        seconds = 0.5 + (0.75 + 0.4 * stats) * pixels(camera["size"])
        seconds *= 0.4 if "--solids" in options else weight(model)
        self.spend("render", seconds)
        passes = [{"name": "visibility", "gpu_ms": 200.0}, {"name": "resolve", "gpu_ms": 100.0}]
        objects = [{"name": "patches", "bytes": 8}, {"name": "resolve", "bytes": 0}]
        return {"seconds": seconds, "stats": {"passes": passes, "objects": objects}, **{i: f"{i}.npy" for i in images}}

    def bench(self, models, *options, limit_s=600):
        frames = int(option(options, "--frames"))
        frames = 3 + frames * (2 if option(options, "--motion") == "still" else 1)
        frame = 0.06 + 0.26 * pixels(option(options, "--size"))
        frame *= {"events": 0.4, "cst": 1.5, "blister": 4}.get(option(options, "--solids"), 1)
        frame *= {"bunny": 4, "bunny2": 15}.get(Path(models[0]).stem, 1)
        self.spend("bench", sum(weight(model) for model in models) * (0.8 + frames * frame), limit_s)
        wall = "wall clock, with read-back"
        of = {wall: 300.0, f"reused: {wall}": 90.0, "all passes": 280.0, "pass: solids": 200.0}
        error = {"judged_pixels": 9, "wrong_pixels": 0, "worst_shift_px": 0.1}
        first = {"pipelines_ms": 300.0, "wall_ms": 90.0}
        report = {"of": of, "largest": of, "error": error, "first_frame": first, "face_instances": 1}
        return [report | {"model": str(model)} for model in models]

    def check(self, _model, *options, limit_s=600):
        views = len(option(options, "--zoom", "1,2,3").split(","))
        size, samples = option(options, "--size"), int(option(options, "--samples"))
        judged = samples + 20_000 * pixels(size)
        self.spend("check", 0.3 + views * (0.03 + 0.4 * pixels(size) + judged / 40_000), limit_s)
        folds = {"beyond": 0, "wrong_depth": 0, "worst_shift_px": 0.1}
        judgement = {"sampled": samples, "wrong": 0, "worst_shift_px": 0.1, "given_up": 0, "folds": folds}
        camera = {"eye": [0.0, 0.0, 9.0], "target": [0.0, 0.0, 0.0], "up": [0.0, 1.0, 0.0], "fovy": 35.0}
        return [{"judgement": judgement, "camera": camera, "stats": {"clamps": 0, "patches": 7000}}] * views

    def sweep(self, *words, limit_s=600):
        copies, frames = int(option(words, "--copies")), int(option(words, "--frames"))
        each = 17e-3 if "--distinct" in words else 7e-4
        self.spend("sweep", 1.0 + copies * each + (frames + 1) * (0.1 + copies * each), limit_s)
        keys = ("patches", "copies", "all_ms", "persistent_bytes", "transient_bytes")
        return [dict.fromkeys(keys, str(copies))]

    def trims(self, *words):
        ways = option(words, "--ways", "table,exact,bisect,bisect-tuned,texture,pretessellated").split(",")
        size, frames = option(words, "--size"), int(option(words, "--frames"))
        zooms = [(zoom, size) for zoom in option(words, "--zooms").split(",")]
        views = zooms + [("1", of) for of in option(words, "--sizes").split(",")]
        models = [Path(words[0]).stem] + (["400 holes"] if int(option(words, "--holes")) else [])
        frame = lambda of: 0.035 + 0.14 * pixels(of)
        seconds = sum((2 * frames + 5) * frame(of) + 0.05 + 0.5 * pixels(of) for _, of in views)
        self.spend("trims", len(models) * len(ways) * (1.0 + seconds) * weight(words[0]))
        figures = {"trim_ms": "5", "frame_ms": "50", "turning_trim_ms": "3", "turning_frame_ms": "40"}
        figures |= {"trim_bytes": "100", "wrong": "0", "judged": "9", "worst_shift_px": "0.1"}
        names = ["model", "way", "zoom", "width", "height"]
        at = lambda *values: dict(zip(names, values))
        rows = ((model, way, zoom, *of.split("x")) for model in models for way in ways for zoom, of in views)
        return [at(*row) | figures for row in rows]

    def reading(self, _model):
        self.spend("info", 0.3)
        return 50.0, 0.01


class Peers:
    def __init__(self, clock):
        self.clock, self.budget, self.problem, self.error, self.versions = clock, None, "", Unmeasurable, {"F3D": "1"}

    def needed(self, _name):
        pass

    def run(self, command, limit_s):
        limit_s, error = self.budget.ended(limit_s)
        done = self.clock.spend(Path(command[0]).name, 0.7, limit_s)
        self.error = Unmeasurable if done else error
        for word, value in zip(command, command[1:]):
            if word == "-o":
                Path(value).touch()
        for word in map(str, command):
            if word.startswith("+O"):
                Path(word[2:]).touch()
        return "", "" if done else "not done", 0.7

    def results(self, program, job, windowed=False, limit_s=300):
        seconds, found = getattr(self, program)(job)
        limit_s, error = self.budget.ended(limit_s)
        done = self.clock.spend(program, seconds, limit_s)
        self.problem, self.error = ("", Unmeasurable) if done else (f"not done in {limit_s:.0f} s", error)
        if not done:
            # all but the last were told before the limit
            found = found[:-1]
        if not found:
            raise self.error(f"{program} printed no result: {self.problem}")
        return found

    def given(self, job):
        """A job's own time, which is the same on every machine."""
        return job["seconds"] * self.clock.speed

    def drawn(self, job, viewers):
        """Seconds of one deflection's frames."""
        return viewers * (3 + 2 * (2 + len(job["turn"]))) * 0.02 * (1 + pixels(job["camera"]["size"]))

    def meshed(self, job):
        light = weight(job["model"])
        seconds, found, last = READ_S * light**4, [{"read_s": READ_S, "diagonal": 17.0}], 0.0
        timed = {"first_s": 0.1, "turning_ms": 20.0, "standing_ms": 20.0}
        for deflection in job["deflections"]:
            if 8 * last > job["most_mesh_s"]:
                found.append({"deflection": deflection, "stopped": "the mesh before took 5.0 s"})
                continue
            last = MESH_S[deflection]
            seconds += (2 * last + self.drawn(job, 2)) * light
            found.append({"deflection": deflection, "mesh_s": last, "ids": job["ids"] and "x.npy", "stl": "x.stl"})
            found[-1] |= {"occ": timed, "vtk": timed}
        return seconds, found

    def f3d_viewer(self, job):
        seconds, found, last, light = 0.0, [], 0.0, weight(job["model"])
        for nth, deflection in enumerate(job["deflections"]):
            if 8 * last > job["most_mesh_s"]:
                found.append({"deflection": deflection, "stopped": "the mesh before took 5.0 s"})
                continue
            last = list(MESH_S.values())[nth]
            seconds += READ_S * light**4 + (last + 3 * self.drawn(job, 1)) * light
            found.append({"deflection": deflection, "first_s": READ_S + last, "turning_ms": 70.0, "standing_ms": 70.0})
        return seconds, found

    def kernel(self, job):
        seconds, found = READ_S, []
        for name, view in job["views"].items():
            pictures = view["pictures"]
            seconds += self.given(job) * (1 + 0.35 * len(pictures))
            found.append({"view": name, "boundary": 900, "sampled": 9000, "alone": 0, "widened": 1, "edge_mm": 0.1})
            found[-1]["pictures"] = dict.fromkeys(pictures, KERNEL)
        return seconds, found

    def zoomed(self, job):
        seconds, found = READ_S + 0.5 * len(job["views"]), []
        for name in job["views"]:
            found.append({"view": name, "kind": "fixed", "frame_ms": 20.0, "ids": "x.npy"})
        for nth, name in enumerate(job["meshes"]):
            seconds += 0.3 * 5**nth
            found.append({"view": name, "kind": "remeshed", "mesh_s": 0.3 * 5**nth, "frame_ms": 20.0, "ids": "x.npy"})
        return seconds, found

    def manifold_viewer(self, job):
        shown = {"evaluate_s": 0.1, "first_s": 0.1, "turning_ms": 5.0, "picture": "x.npy"}
        return 1.5, [shown | {"segments": segments} for segments in job["segments"]]

    def csg(self, job):
        pictures = dict.fromkeys(job["pictures"], KERNEL)
        return self.given(job) * (1 + 0.1 * len(pictures)), [{"boundary": 900, "sampled": 9000, "pictures": pictures}]

    def reading(self, job):
        return 1.2 * len(job["models"]), [{"model": model, "read_s": 2.0} for model in job["models"]]


