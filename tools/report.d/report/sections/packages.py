"""11. From Python: depth and normals of STEP files as arrays, beside other packages, by tools/compare_python."""

import importlib.util
import json
import sys

from ..machine import ROOT
from ..peers import NOT_DONE, run
from ..rows import Missing, Table
from ..turns import Late, Unmeasurable

TITLE = "From Python"
TEXT = """\
Each package draws each file in a process of its own, from the same eight cameras at 1024x1024. *First picture* is the
time from before the import of the package to arrays in memory, *next* that of the other seven views. Triangles are
within 0.001 mm. Errors are differences from the exact picture, which the project's own reference judges. *Silhouette*
counts the pixels that show the model in one picture only; *depth* is the difference in pixel sides at that depth.
`tools/compare_python` without options measures ten files and 24 cameras."""
# of samples and of the folder of files
FILES = ["samples/bracket.step", "nist_pmi_2.stp"]
VIEWS, PROCESS_S = 8, 20
LONG = "takes many minutes: only without --quick"
NOT_BUILT = "selvedge is not installed in target/report/python: tools/wheel writes it"


def measure(context, section):
    why = LONG if context.quick else "" if importlib.util.find_spec("selvedge") else NOT_BUILT
    rows = [["all", "", Missing(why), *[""] * 6]] if why else compared(context, section)
    columns = ["file", "package", "first picture, s", "next, s", "peak, MiB"]
    columns += ["silhouette, px", "of", "depth, px", "99 %, px"]
    section.tables.append(Table("", columns, rows))


def compared(context, section):
    """Rows of tools/compare_python."""
    out, files = context.program.folder() / "out.json", [model for model in map(context.model, FILES) if model]
    options = ["--views", VIEWS, "--timeout", PROCESS_S]
    section.commands.append(context.shown("tools/compare_python", "out.json", *files, *options, program="python"))
    command = [sys.executable, ROOT / "tools/compare_python", out, *files, *options]
    _, problem, _ = run(command, context.budget.limit_s(context.budget.seconds))
    if problem:
        raise (Late if problem.startswith(NOT_DONE) else Unmeasurable)(f"tools/compare_python: {problem}")
    report = json.loads(out.read_text())
    rows = [row_of(row) for row in report["rows"]]
    lacking = ((name, f"{', '.join(lacks)} is not installed") for name, lacks in report["missing"].items())
    return rows + [["", name, Missing(why), *[""] * 6] for name, why in lacking]


def row_of(row):
    """A row of the table, of one that tools/compare_python writes."""
    if "error" in row:
        return [row["file"], row["package"], Missing(row["error"]), *[""] * 6]
    keys = ["first_s", "next_s", "peak_mib", "silhouette_px", "seen_px", "depth_px_median", "depth_px_99"]
    if "judge" in row:
        judge = row["judge"]
        row = row | {"silhouette_px": f"{judge['wrong']} wrong", "seen_px": f"{judge['judged']:,} judged"}
    return [row["file"], row["package"], *(row.get(key, "") for key in keys)]
