"""The peers: which are installed, and runs of each in a separate process.

`tools/report` installs Python packages into a folder of the build and writes the reason if it cannot; packages of
Debian are used if they are installed.
"""

import contextlib
import importlib.metadata
import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import time

from .machine import ROOT
from .rows import Missing
from .turns import Overdue, Unmeasurable

# names in the report: package, module
PACKAGES = {
    "Open CASCADE": ("cadquery-ocp", "OCP"),
    "VTK": ("vtk", "vtkmodules"),
    "F3D": ("f3d", "f3d"),
    "Manifold": ("manifold3d", "manifold3d"),
    "pyrender": ("pyrender", "pyrender"),
}
DEBIAN = {"OpenSCAD": "openscad", "POV-Ray": "povray"}
SCREEN = "-screen 0 3840x2160x24"
NOT_DONE = "not done in"
# seconds that a process may take to end after SIGTERM, and its pipe to close after SIGKILL
GRACE_S = 5.0


class Peers:
    """`versions` by name, a `Missing` for each absent one."""

    def __init__(self, scratch):
        self.scratch, self.count = scratch, 0
        # problem of the last process, empty if there was none; and the error that it is, by what ended the process
        self.problem, self.error = "", Unmeasurable
        # of the section that is measured
        self.budget = None
        self.versions = {}
        for name, (package, module) in PACKAGES.items():
            if importlib.util.find_spec(module):
                self.versions[name] = importlib.metadata.version(package)
            else:
                self.versions[name] = Missing(f"not installed: {why_not(package)}")
        for name, program in DEBIAN.items():
            there = shutil.which(program)
            self.versions[name] = version(program) if there else Missing(f"not installed: apt install {program}")
        if not shutil.which("xvfb-run"):
            for name in ("Open CASCADE", "VTK", "F3D", "OpenSCAD"):
                self.versions[name] = Missing("no X server to draw in: apt install xvfb")

    def has(self, name):
        return not isinstance(self.versions[name], Missing)

    def needed(self, name):
        """Raises the reason for the rows of an absent peer."""
        if not self.has(name):
            raise Unmeasurable(f"{name}: {self.versions[name].why}")

    def results(self, program, job, windowed=False, limit_s=300):
        """The results of a program of `report.peer`, including those before the limit stopped it."""
        self.count += 1
        path = self.scratch / f"job{self.count}.json"
        path.write_text(json.dumps(job))
        command = [sys.executable, "-m", f"report.peer.{program}", str(path)]
        if windowed:
            command = ["xvfb-run", "-a", "-s", SCREEN, *command]
        out, problem, _ = self.run(command, limit_s)
        if problem:
            print(f"   {program}: {problem}", file=sys.stderr, flush=True)
        found = [json.loads(line[len("RESULT ") :]) for line in out.splitlines() if line.startswith("RESULT ")]
        if not found:
            raise self.error(f"{program} printed no result: {problem}")
        return found

    def run(self, command, limit_s):
        """As the function below, with no more time than the section has."""
        limit_s, error = self.budget.ended(limit_s) if self.budget else (limit_s, Overdue)
        out, self.problem, took = run(command, limit_s)
        self.error = error if self.problem.startswith(NOT_DONE) else Unmeasurable
        return out, self.problem, took


def run(command, limit_s, cwd=ROOT):
    """Standard output, the problem (empty if there is none), and seconds; at the limit its group is ended."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools/report.d")}
    start = time.perf_counter()
    process = subprocess.Popen(
        [str(word) for word in command],
        cwd=cwd,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        out, told = process.communicate(timeout=limit_s)
        problem = (
            ""
            if process.returncode == 0
            else f"status {process.returncode}: {(told.strip().splitlines() or ['it printed nothing'])[-1]}"
        )
    except subprocess.TimeoutExpired:
        out = ended(process)
        problem = f"{NOT_DONE} {limit_s:.0f} s"
    return out, problem, time.perf_counter() - start


def ended(process):
    """Ends the group of a process; what it has written."""
    written = b""
    for number in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        try:
            return process.communicate(timeout=GRACE_S)[0]
        except subprocess.TimeoutExpired as waits:
            written = waits.output or b""
    # a process that left the group holds the pipes open
    process.poll()
    process.stdout.close()
    process.stderr.close()
    return written.decode(errors="replace")


def version(program):
    done = subprocess.run([program, "--version"], capture_output=True, text=True)
    words = (done.stdout + done.stderr).split()
    return next((word for word in words if word[0].isdigit()), "of unknown version")


def why_not(package):
    """The output of pip; `tools/report` keeps it in the folder that REPORT_PIP names."""
    folder = os.environ.get("REPORT_PIP", "")
    path = os.path.join(folder, f"{package}.failed")
    if folder and os.path.exists(path):
        with open(path) as text:
            lines = [line.strip() for line in text if line.strip()]
        return lines[-1] if lines else "pip failed and printed nothing"
    return f"pip install {package}"
