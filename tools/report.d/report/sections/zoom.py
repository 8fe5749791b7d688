"""2. Time against zoom, with error: triangles of one mesh, of a mesh for each zoom, and ours."""

import statistics

from .. import claims, program, views
from ..rows import Contest, Line, Missing, Plot, Promise, Table, worst_cell
from ..turns import Overdue, Unmeasurable, rounds

FILE, SAMPLE = "nist_pmi_2.stp", "samples/bracket.step"
ZOOMS_QUICK, ZOOMS = [1, 10, 1_000, 1_000_000], [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000]
# deflection of the one mesh, of the diagonal: the default of Open CASCADE's viewer
FIXED = 1e-3
# a mesh for a view is within so many of its pixels
WITHIN_PX = 0.5
# the kernel's tolerance, millimetres; the least pixel size, in tolerances, whose sixteenth the kernel's rays resolve
KERNEL_MM, KERNEL_PIXEL = 1e-7, 32
TITLE = "Time against zoom"
TEXT = """\
The views are so many times closer to the detail that is nearest to the eye. The *fixed* viewer draws one mesh within a
thousandth of the diagonal. The other one meshes anew for each view, within half a pixel; its time is that of mesh and
frame. Open CASCADE makes the meshes, and VTK draws them. Ours is a frame of all passes, with smooth borders and without
ambient occlusion, as in section 1. The kernel's rays measure the errors where a pixel is much larger than the kernel's
tolerance of 1e-7 mm. *By our reference* is the error that the project's own reference finds, at every zoom. There are
three rounds; a view whose mesh is not done within the limit in its row is not meshed again in later rounds."""


def measure(context, section):
    model = context.model(FILE) or context.model(SAMPLE)
    size, zooms = context.pick((960, 540), (1920, 1080)), context.pick(ZOOMS_QUICK, ZOOMS)
    words = [
        "check",
        model,
        "--zoom",
        ",".join(map(str, zooms)),
        "--size",
        "{}x{}".format(*size),
        "--samples",
        context.pick(2000, 8000),
    ]
    context.say("our pictures")
    judged = context.program.check(model, *words[2:])
    section.commands.append(context.shown(*words))
    section.promises.append(
        Promise(
            "a pixel right within half a pixel, by the project's reference",
            sum(program.wrong(v["judgement"]) for v in judged),
            sum(v["judgement"]["sampled"] for v in judged),
        )
    )
    cameras = {str(zoom): {**view["camera"], "size": list(size)} for zoom, view in zip(zooms, judged)}
    count = 3
    drawn = lambda camera: context.program.render(model, camera, "--ao", "none")["stats"]
    ours = lambda: {name: drawn(camera) for name, camera in cameras.items()}
    folder = context.program.folder()

    reached = list(cameras)
    limit_s, stopped = context.pick(12, 40), {}

    def meshed():
        """By kind and view; a view whose mesh is not done in time is not tried again."""
        context.peers.needed("VTK")
        wanted = {
            name: {"camera": camera, "deflection": WITHIN_PX * views.pixel_mm(camera)}
            for name, camera in cameras.items()
        }
        job = {"model": str(model), "views": wanted, "meshes": reached, "fixed": FIXED, "ids": str(folder)}
        results = context.peers.results("zoomed", job, windowed=True, limit_s=limit_s)
        found = {(one["kind"], one["view"]): one for one in results}
        late = [name for name in reached if ("remeshed", name) not in found]
        if late and context.peers.error is not Overdue:
            # the section's time, or a failure: only the mesher's own limit is a loss
            raise context.peers.error(f"a mesh a zoom: {context.peers.problem}")
        reached[:] = [name for name in reached if name not in late]
        # reported once, for all rounds
        stopped.update({name: f"{int(late[0]):,} times was not meshed within {limit_s} s" for name in late})
        return found

    context.say("in turn")
    results = rounds({"ours": ours, "meshed": meshed}, 0, most=count, left=context.budget.left)
    if isinstance(results["ours"], Unmeasurable):
        raise results["ours"]
    errors = kernel_errors(context, model, cameras, results["meshed"])
    fill(section, model.name, cameras, judged, results, errors, stopped)


def kernel_errors(context, model, cameras, meshed):
    """By zoom and picture; a reason in place of either."""
    if isinstance(meshed, Unmeasurable):
        return {name: str(meshed) for name in cameras}
    wanted, errors = {}, {}
    for name, camera in cameras.items():
        if views.pixel_mm(camera) < KERNEL_PIXEL * KERNEL_MM:
            errors[name] = f"a pixel is {views.pixel_mm(camera):.0e} mm, too little beside the kernel's tolerance"
            continue
        pictures = {
            "ours": {
                "path": str(context.program.render(model, camera, images=["face"], stats=False)["face"]),
                "own": True,
            }
        }
        for kind in ("fixed", "remeshed"):
            if (kind, name) in meshed[0]:
                pictures[kind] = {"path": meshed[0][kind, name]["ids"], "own": False}
        wanted[name] = {"camera": camera, "pictures": pictures}
    seconds = context.pick(3, 4)
    job = {"model": str(model), "views": wanted, "seconds": seconds}
    try:
        found = context.peers.results("kernel", job, limit_s=60 + 4 * seconds * len(wanted))
    except Unmeasurable as error:
        return {name: errors.get(name, str(error)) for name in cameras}
    return {
        **{name: f"the kernel's rays: {context.peers.problem}" for name in cameras},
        **errors,
        **{one["view"]: one["pictures"] for one in found},
    }


def fill(section, file, cameras, judged, results, errors, stopped):
    meshed = results["meshed"]
    rows, lines = [], {"ours": [], "fixed": [], "remeshed": []}
    for (name, camera), view in zip(cameras.items(), judged):
        mine = [program.passes_ms(one[name]) for one in results["ours"]]
        lines["ours"].append((float(name), statistics.median(mine)))
        cells = [int(name), views.pixel_mm(camera), statistics.median(mine)]
        cells += [error(errors[name], "ours"), program.worst_shift_px(view["judgement"])]
        for kind in ("fixed", "remeshed"):
            what = f"frame, {file}, {int(name):,} times"
            peer = "VTK, fixed mesh" if kind == "fixed" else "VTK, a mesh a zoom"
            claim = claims.frame_beside_a_mesh_for_the_zoom(int(name)) if kind == "remeshed" else "open"
            late = stopped.get(name) if kind == "remeshed" else None
            if late or isinstance(meshed, Unmeasurable):
                cells += [Missing(late or str(meshed)), ""]
                section.contests.append(
                    Contest(what, peer, "ms", claim=claim, unreached=bool(late), why=late or str(meshed))
                )
                continue
            found = [one[kind, name] for one in meshed]
            times = [one["frame_ms"] + 1e3 * one.get("mesh_s", 0.0) for one in found]
            lines[kind].append((float(name), statistics.median(times)))
            cells += [statistics.median(times), error(errors[name], kind)]
            many = min(len(mine), len(times))
            cause = frame_cause([one[name] for one in results["ours"]], error(errors[name], kind))
            section.contests.append(Contest(what, peer, "ms", mine[:many], times[:many], claim, cause=cause))
        rows.append(cells)
    head = [
        "zoom",
        "a pixel, mm",
        "ours, ms",
        "worst, px",
        "by our reference",
        "fixed mesh, ms",
        "worst, px",
        "a mesh a zoom, ms",
        "worst, px",
    ]
    section.tables.append(Table(file, head, rows))
    names = {"ours": "selvedge", "fixed": "one mesh", "remeshed": "a mesh for each zoom"}
    drawn = [Line(names[kind], points, kind == "ours") for kind, points in lines.items() if points]
    section.plots.append(Plot("zoom", f"time over zoom: {file}", "zoom", "frame, ms", drawn))


def frame_cause(stats, theirs):
    """The passes that take most of our frame, and the peer's error: the cause of a frame that is behind."""
    passes = [{one["name"]: one["gpu_ms"] for one in frame["passes"]} for frame in stats]
    medians = {name: statistics.median(of.get(name, 0.0) for of in passes) for name in passes[0]}
    whole, longest = sum(medians.values()), sorted(medians.items(), key=lambda row: -row[1])[:3]
    told = ", ".join(f"{name} {100 * ms / whole:.0f} %" for name, ms in longest if ms > 0)
    beside = "" if isinstance(theirs, Missing) or theirs == "" else f"; the facets beside it are {theirs} px off"
    return f"section 2: a frame of the exact surfaces is {whole:.0f} ms of passes ({told}){beside}"


def error(of_view, kind):
    """The worst error by the kernel, as a cell."""
    if isinstance(of_view, str):
        return Missing(of_view)
    found = of_view.get(kind)
    return "" if found is None else worst_cell(found)
