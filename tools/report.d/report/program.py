"""`selvedge`, in a new process each time: its output, its files, and the time."""

import csv
import json
import re
import subprocess
import time

from .machine import ROOT
from .turns import Overdue, Unmeasurable

# 1 is a broken promise, which the figures show
FINE = (0, 1)
UNITS = {"s": 1e3, "ms": 1.0, "µs": 1e-3}


class Program:
    """A release build, on a named device if there is a name; `scratch` is a folder for its files."""

    def __init__(self, path, device, scratch):
        self.path, self.scratch, self.count = path, scratch, 0
        self.on = ["--device", device] if device else []
        self.device = ""
        # of the section that is measured
        self.budget = None

    def folder(self):
        self.count += 1
        folder = self.scratch / f"run{self.count}"
        folder.mkdir(parents=True)
        return folder

    def run(self, *words, limit_s=600, allowed=FINE):
        """Standard output and standard error; the wall clock of the whole process, seconds."""
        command = [str(self.path), *map(str, words)]
        limit_s, error = self.budget.ended(limit_s) if self.budget else (limit_s, Overdue)
        start = time.perf_counter()
        try:
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=limit_s)
        except subprocess.TimeoutExpired:
            raise error(f"selvedge {words[0]} was not done in {limit_s:.0f} s") from None
        took = time.perf_counter() - start
        if done.returncode not in allowed:
            last = (done.stderr.strip().splitlines() or ["it printed nothing"])[-1].replace(f"{self.scratch}/", "")
            raise Unmeasurable(f"selvedge {words[0]} ended with status {done.returncode}: {last}")
        return done.stdout, done.stderr, took

    def info(self, model):
        return json.loads(self.run("info", model, "--json")[0])

    def render(self, model, camera, *options, images=(), stats=True):
        """`{seconds, stats, IMAGE: path}`: a process from the file to a PNG. With `stats` the frame is drawn again."""
        folder = self.folder()
        words = ["render", model, "-o", folder / "picture.png", *at(camera), *options, *self.on]
        for image in images:
            words += ["--aov", f"{image}={folder / image}.npy"]
        if stats:
            words += ["--stats", folder / "stats.json"]
        _, _, took = self.run(*words)
        found = {"seconds": took, **{image: folder / f"{image}.npy" for image in images}}
        if stats:
            found["stats"] = json.loads((folder / "stats.json").read_text())
            self.seen(found["stats"])
        return found

    def bench(self, models, *options, limit_s=600):
        """The reports of `bench`, each with its medians by name as `of`."""
        folder = self.folder()
        self.run("bench", *models, "--out", folder, *options, *self.on, limit_s=limit_s)
        reports = json.loads((folder / "bench.json").read_text())
        for report in reports:
            report["of"] = {row["name"]: row["median"] for row in report["rows"]}
            report["largest"] = {row["name"]: row["largest"] for row in report["rows"]}
            self.seen(report)
        return reports

    def check(self, model, *options, limit_s=600):
        """The judgements of `check`, one a view."""
        path = self.folder() / "check.json"
        self.run("check", model, "--json", path, *options, *self.on, limit_s=limit_s)
        found = json.loads(path.read_text())
        for view in found:
            self.seen(view["stats"])
        return found

    def sweep(self, *words, limit_s=600):
        """Rows of `sweep`'s table, numbers as text."""
        path = self.folder() / "sweep.csv"
        self.run("sweep", *words, "--out", path, *self.on, limit_s=limit_s)
        return list(csv.DictReader(path.open()))

    def trims(self, *words):
        """Rows of the table of `trims`, numbers as text."""
        folder = self.folder()
        self.run("trims", *words, "--out", folder, *self.on)
        return list(csv.DictReader((folder / "trims.csv").open()))

    def reading(self, model):
        """From bytes on disk to a valid model, ms, and the time of its box as a share of that."""
        _, told, _ = self.run("-v", "info", model)
        value, unit = re.search(r" read .* in ([0-9.]+)(s|ms|µs)\b", told).groups()
        percent = re.search(r" box in .*, ([0-9.]+) % of the time of reading", told).group(1)
        return float(value) * UNITS[unit], float(percent) / 100

    def seen(self, stats):
        # of the first frame; the output may have further ones
        self.device = self.device or f"{stats['device']} ({stats['driver']})"


def at(camera):
    """A camera as options."""
    point = lambda name: "--{}={}".format(name, ",".join(repr(float(x)) for x in camera[name]))
    width, height = camera["size"]
    return [point("eye"), point("target"), point("up"), "--fov", repr(camera["fovy"]), "--size", f"{width}x{height}"]


def wrong(judgement):
    """Pixels that break the promise: the wrong face, or the right face's wrong sheet."""
    return judgement["wrong"] + judgement["folds"]["beyond"] + judgement["folds"]["wrong_depth"]


def worst_shift_px(judgement):
    """Of faces, and of sheets of faces."""
    return max(judgement["worst_shift_px"], judgement["folds"]["worst_shift_px"])


def passes_ms(stats):
    """GPU time of all passes of a frame."""
    return sum(one["gpu_ms"] for one in stats["passes"])
