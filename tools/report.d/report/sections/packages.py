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
Each package draws each file in a process of its own, from the same 24 cameras at 1024x1024. *First picture* is the
time from before the import of the package to arrays in memory, *next* that of the other 23 views. Triangles are
within 0.001 mm. Errors are differences from the exact picture, which the project's own reference judges: in the rows of
selvedge *silhouette* counts its wrong pixels, and *of* the judged ones. In the others it counts the pixels that show
the model in one picture only; *depth* is the difference in pixel sides at that depth. F3D returns colours only. A
package that is not done with a file within the limit in its row has no figures."""
# of samples and of the folder of files, the small ones first
FILES = ["samples/panel.step", "samples/bracket.step", "samples/assembly.step", "first/occt_screw.step"]
FILES += ["occwl_example.stp", "zoo_ball_bearing.step", "nist_pmi_5.stp", "m6_countersunk_screw.step"]
FILES += ["nist_pmi_2.stp", "framework_printable_case_full.stp"]
VIEWS, PROCESS_S = 24, 45
LONG = "takes many minutes: only without --quick"
NOT_BUILT = "selvedge is not installed in target/report/python: tools/wheel writes it"


def measure(context, section):
    why = LONG if context.quick else "" if installed() else NOT_BUILT
    rows = [["all", "", Missing(why), *[""] * 6]] if why else compared(context, section)
    columns = ["file", "package", "first picture, s", "next, s", "peak, MiB"]
    columns += ["silhouette, px", "of", "depth, px", "99 %, px"]
    section.tables.append(Table("", columns, rows))


def installed():
    return importlib.util.find_spec("selvedge") is not None


def compared(context, section):
    """Rows of tools/compare_python, in a process for each file: a late one leaves the rows of the others."""
    options = ["--views", VIEWS, "--timeout", PROCESS_S]
    rows, lacking, files = [], {}, []
    for name in FILES:
        model = context.model(name)
        if model is None:
            rows.append([name, "", context.absent(name), *[""] * 6])
            continue
        files.append(model)
        try:
            report = of_file(context, model, options)
        except Late as late:
            rows.append([model.name, "", Missing(str(late)), *[""] * 6])
            continue
        rows += map(row_of, report["rows"])
        lacking |= report["missing"]
    section.commands.append(context.shown("tools/compare_python", "out.json", *files, *options, program="python"))
    not_installed = ((name, Missing(f"{', '.join(lacks)} is not installed")) for name, lacks in lacking.items())
    return rows + [["", name, why, *[""] * 6] for name, why in not_installed]


def of_file(context, model, options):
    """The report of tools/compare_python on one file."""
    context.budget.needed()
    context.say(model.name)
    out = context.program.folder() / "out.json"
    command = [sys.executable, ROOT / "tools/compare_python", out, model, *options]
    _, problem, _ = run(command, context.budget.limit_s(context.budget.seconds))
    if problem:
        raise (Late if problem.startswith(NOT_DONE) else Unmeasurable)(f"tools/compare_python: {problem}")
    return json.loads(out.read_text())


def row_of(row):
    """A row of the table, of one that tools/compare_python writes."""
    if "error" in row:
        return [row["file"], row["package"], Missing(row["error"]), *[""] * 6]
    keys = ["first_s", "next_s", "peak_mib", "silhouette_px", "seen_px", "depth_px_median", "depth_px_99"]
    if "judge" in row:
        judge = row["judge"]
        row = row | {"silhouette_px": f"{judge['wrong']} wrong", "seen_px": f"{judge['judged']:,} judged"}
    return [row["file"], row["package"], *(row.get(key, "") for key in keys)]
