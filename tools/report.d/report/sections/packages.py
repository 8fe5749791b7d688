"""11. From Python: depth and normals of STEP files as arrays, beside other packages, by tools/compare_python."""

import importlib.util
import json
import sys

from ..budget import cases
from ..machine import ROOT
from ..peers import run
from ..rows import Missing, Table
from ..turns import Late

TITLE = "From Python"
TEXT = """\
Each package draws each file in a process of its own, from the same 24 cameras at 1024x1024. *First picture* is the time
from before the import of the package to arrays in memory, *next* that of the other 23 views. Triangles are within 0.001
mm. Errors are differences from the exact picture, which the project's own reference judges: in the rows of selvedge
*silhouette* counts its wrong pixels, *of* the judged ones, and depths are compared where a surface is neither grazing
nor folded. In the others *silhouette* counts the pixels that show the model in one picture only, and depths are
compared where both show it. *Mean*, *worst*, *median* and *99 %*, which one depth in a hundred exceeds, are in pixel
sides at that depth; the reference of selvedge gives the first two. F3D returns colours only. A package that is not done
with a file within the limit in its row has no figures. Each file has its share of the section's time, and what a file
leaves over goes to the later ones."""
# of samples and of the folder of files, the small ones first
FILES = ["samples/panel.step", "samples/bracket.step", "samples/assembly.step", "first/occt_screw.step"]
FILES += ["occwl_example.stp", "zoo_ball_bearing.step", "nist_pmi_5.stp", "m6_countersunk_screw.step"]
FILES += ["nist_pmi_2.stp", "framework_printable_case_full.stp"]
# seconds of a package on a file; tools/compare_python ends it, and has BEGIN_S beside to begin and to write
VIEWS, PROCESS_S, BEGIN_S = 24, 45, 10
# the cells behind the reason for which a row has no figures
EMPTY = [""] * 8
LONG = "takes many minutes: only without --quick"
NOT_BUILT = "selvedge is not installed in target/report/python: tools/wheel writes it"


def measure(context, section):
    why = LONG if context.quick else "" if installed() else NOT_BUILT
    rows = [["all", "", Missing(why), *EMPTY]] if why else compared(context, section)
    columns = ["file", "package", "first picture, s", "next, s", "peak, MiB"]
    columns += ["silhouette, px", "of", "depth: mean, px", "worst, px", "median, px", "99 %, px"]
    section.tables.append(Table("", columns, rows))


def installed():
    return importlib.util.find_spec("selvedge") is not None


def compared(context, section):
    """Rows of tools/compare_python, which runs once for each file, in the file's share of the section's time."""
    options = ["--views", VIEWS, "--timeout", PROCESS_S]
    rows, lacking, measured, there = [], {}, [], {}
    for name in FILES:
        there[name] = context.model(name)
        if there[name] is None:
            rows.append([name, "", context.absent(name), *EMPTY])
    for name, seconds in cases(context.budget, {name: 1 for name, model in there.items() if model}):
        model = there[name]
        if isinstance(seconds, Late):
            rows.append([model.name, "", Missing(str(seconds)), *EMPTY])
            continue
        measured.append(model)
        report, problem = of_file(context, model, [*options, "--seconds", f"{seconds:.0f}"], seconds + BEGIN_S)
        rows += map(row_of, report["rows"])
        if problem:
            rows.append([model.name, "others", Missing(f"tools/compare_python: {problem}"), *EMPTY])
        lacking |= report["missing"]
    section.commands.append(context.shown("tools/compare_python", "out.json", *measured, *options, program="python"))
    not_installed = ((name, Missing(f"{', '.join(lacks)} is not installed")) for name, lacks in lacking.items())
    return rows + [["", name, why, *EMPTY] for name, why in not_installed]


def of_file(context, model, options, seconds):
    """The report of tools/compare_python on one file, and the problem if it did not end well."""
    context.say(model.name)
    out = context.program.folder() / "out.json"
    command = [sys.executable, ROOT / "tools/compare_python", out, model, *options]
    _, problem, _ = run(command, context.budget.limit_s(seconds))
    return json.loads(out.read_text()) if out.exists() else {"rows": [], "missing": {}}, problem


def row_of(row):
    """A row of the table, of one that tools/compare_python writes."""
    if "error" in row:
        return [row["file"], row["package"], Missing(row["error"]), *EMPTY]
    keys = ["first_s", "next_s", "peak_mib", "silhouette_px", "seen_px"]
    keys += ["depth_px_mean", "depth_px_worst", "depth_px_median", "depth_px_99"]
    if "judge" in row:
        judge = row["judge"]
        row = row | {"silhouette_px": f"{judge['wrong']} wrong", "seen_px": f"{judge['judged']:,} judged"}
        row |= {"depth_px_mean": judge["depth_px"]["mean"], "depth_px_worst": judge["depth_px"]["worst"]}
    return [row["file"], row["package"], *(row.get(key, "") for key in keys)]
