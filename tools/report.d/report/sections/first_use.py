"""8. First use: seconds and megabytes from a cold clone to the first picture, and the size of a host's files."""

import os
import subprocess
import tempfile
from pathlib import Path

from ..machine import ROOT
from ..peers import NOT_DONE, run
from ..rows import Missing, Table
from ..turns import Unmeasurable

TITLE = "First use"
TEXT = """\
The clone has the history of one commit. The build makes the release program without its window and without Rhino files,
on all cores, from crates that were downloaded before. The sizes are those of the program with both. The library for
hosts is built by `tools/report` in a whole run."""
# what a first picture needs
BUILD = ["cargo", "build", "--release", "-p", "selvedge-cli", "--no-default-features"]
NO_LIBRARY = Missing("not built: a whole run of tools/report builds it, and tools/install_c")
LONG = Missing("takes many minutes: only without --quick")


def measure(context, section):
    rows = [["the program", megabytes(context.program.path), "", ""]]
    library = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "release/libselvedge_c.so"
    size = megabytes(library) if library.exists() else NO_LIBRARY
    rows.append(["the library for hosts in C", size, "", ""])
    camera = {
        "eye": [100.0, -160.0, 110.0],
        "target": [0.0, 0.0, 0.0],
        "up": [0.0, 0.0, 1.0],
        "fovy": 35.0,
        "size": [640, 480],
    }
    sample = context.model("samples/panel.step")
    cold, warm = (context.program.render(sample, camera, stats=False)["seconds"] for _ in range(2))
    rows.append(["the first picture, samples/panel.step", "", cold, ""])
    rows.append(["the second", "", warm, ""])
    if context.quick:
        rows += [["a clone", source_megabytes(), "", ""], ["a cold build", LONG, LONG, LONG]]
    else:
        rows += built(context, section)
    section.tables.append(Table("", ["", "MB", "seconds", "CPU seconds"], rows))
    section.commands.append(context.shown("render", sample, "--size", "640x480", "-o", "picture.png"))


def megabytes(path):
    """Size of a file, or of all files in a folder."""
    files = [path] if path.is_file() else [f for f in path.rglob("*") if f.is_file() and not f.is_symlink()]
    return sum(f.stat().st_size for f in files) / 1e6


def source_megabytes():
    """Size of the files of the commit."""
    done = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, capture_output=True)
    return len(done.stdout) / 1e6 if done.returncode == 0 else Missing("not a git repository")


def built(context, section):
    """Rows of a clone, a cold build in it, and the first picture from it; of what was not done in time the limit."""
    with tempfile.TemporaryDirectory() as folder:
        clone, target = Path(folder) / "clone", Path(folder) / "target"
        rows = []
        words = [
            ("a clone", ["git", "clone", "-q", "--depth", "1", ROOT.as_uri(), clone], folder, clone),
            (
                "a cold build",
                [*BUILD, "-q", "--offline", "--target-dir", target],
                clone,
                target,
            ),
            (
                "the first picture from it",
                [target / "release/selvedge", "render", "samples/panel.step", "-o", target / "a.png"],
                clone,
                target / "a.png",
            ),
        ]
        for name, command, within, made in words:
            before = os.times()
            _, problem, took = run(command, context.budget.limit_s(context.budget.seconds), cwd=within)
            if problem.startswith(NOT_DONE):
                late = Missing(f"{name} was {problem}")
                return [*rows, [name, late, late, late]]
            after = os.times()
            if problem:
                raise Unmeasurable(f"{name}: {problem}")
            cpu = after.children_user + after.children_system - before.children_user - before.children_system
            rows.append([name, megabytes(made), took, cpu])
        section.commands += ["git clone --depth 1", " ".join(BUILD)]
        return rows
