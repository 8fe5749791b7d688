"""3. Trimming: the plots of R. Wu and J. Peters, Correct resolution rendering of trimmed spline surfaces, 2014, for
all ways to trim."""

import statistics

from .. import claims
from ..budget import cases
from ..rows import Contest, Line, Missing, Plot, Promise, Table
from ..turns import Late, Unmeasurable, rounds

# the engine's own; the others are baselines
OURS = ("table", "exact")
# those of the contests of time, which every round repeats
REPEATED = [*OURS, "bisect"]
# files with the holes along each side of the generated face that is measured beside them; 0: no such face
FILES_QUICK = {"samples/panel.step": 20}
FILES = {"samples/panel.step": 50, "nist_pmi_2.stp": 0, "m6_countersunk_screw.step": 0}
# the share of a whole run's time: the generated face has most borders
WEIGHTS = {"samples/panel.step": 2.5, "nist_pmi_2.stp": 1.0, "m6_countersunk_screw.step": 1.0}
# pictures of the sweep over zoom, and those that every round draws beside them
SIZE, SMALL_SIZE = "400x400", "200x200"
TITLE = "Trimming"
TEXT = """\
The engine's ways to trim, `table` and `exact`, are measured beside other methods: bisection (the paper's), a texture
of the trim, and triangles made in advance. *Trims* is what the tests cost in the passes of a frame, *turning* the same
of a view that turns. Each round takes the least of its frames; the table has medians over the rounds. The
first round has every way. Later rounds repeat the sweep over zoom, at 400x400, of the ways that are compared in time:
our own and bisection. Larger pictures are measured once: a frame is long there, and its noise small."""


def measure(context, section):
    files = context.pick(FILES_QUICK, FILES)
    absent = [name for name in files if not context.model(name)]
    section.contests += [Contest(f"trims, {name}", "all", "ms", why=context.absent(name).why) for name in absent]
    there = {name: WEIGHTS[name] for name in files if context.model(name)}
    wrong = judged = 0
    for name, seconds in cases(context.budget, there):
        try:
            if isinstance(seconds, Late):
                raise seconds
            context.say(f"{name}: {seconds:.0f} s")
            found = measured(context, section, name, files[name], seconds)
        except Late as late:
            section.contests.append(Contest(f"trims, {name}", "all", "ms", why=str(late)))
            continue
        except Unmeasurable as error:
            section.failure = section.failure or f"{name}: {error}"
            continue
        wrong += sum(int(row["wrong"] or 0) for row in found[0].values() if row["way"] in OURS)
        judged += sum(int(row["judged"] or 0) for row in found[0].values() if row["way"] in OURS)
        for model in dict.fromkeys(model for model, *_ in found[0]):
            table(section, model, found)
            plots(section, model, found, SIZE)
            contests(section, model, found, SIZE)
    why = "" if judged else "nothing was drawn"
    what = "a pixel trimmed by `table` or `exact` right within half a pixel"
    section.promises.append(Promise(what, wrong, judged, why))


def measured(context, section, name, holes, seconds):
    """The rounds of a file, and of the generated face beside it; the first one has the sizes, too."""
    words = [context.model(name), "--no-knobs", "--holes", holes]
    words += ["--samples", context.pick(500, 2000)]
    zooms = context.pick("1,10", "1,10,100,1000")
    of_zoom = ["--zooms", zooms, "--size", SIZE, "--sizes", SMALL_SIZE, "--frames", 2]
    of_size = ["--zooms", 1, "--size", "800x800", "--sizes", "1600x1600,2560x1440", "--frames", 1]
    run = lambda more: unique(context.program.trims(*words, *more))
    ways, begun = ["--ways", ",".join(REPEATED)], []

    def of_round():
        more = ways if begun else []
        begun.append(True)
        return run([*of_zoom, *more])

    found = rounds({"zoom": of_round}, 0.6 * seconds, most=3, left=context.budget.left)["zoom"]
    if isinstance(found, Unmeasurable):
        raise found
    section.commands.append(context.shown("trims", *words, *of_zoom))
    if context.quick:
        return found
    section.commands.append(context.shown("trims", *words, *of_size))
    try:
        found[0] |= run(of_size)
    except Late as late:
        section.contests.append(Contest(f"sizes, {name}", "all", "ms", why=str(late)))
    return found


def key(row):
    return row["model"], row["way"], float(row["zoom"]), f"{row['width']}x{row['height']}"


def unique(rows):
    """By model, way, zoom and size: the sweep of sizes comes by the view of the sweep of zooms."""
    found = {}
    for row in rows:
        found.setdefault(key(row), row)
    return found


def values(found, at, column):
    """Figures of each round; empty if the device lacked memory."""
    texts = [one[at][column] for one in found if at in one]
    return [float(text) for text in texts] if all(texts) else []


def cell(found, at, column, scale=1.0):
    of = values(found, at, column)
    return statistics.median(of) * scale if of else Missing("the device has no room for it")


def table(section, model, found):
    rows = []
    for at in found[0]:
        if at[0] != model:
            continue
        trims, frame = values(found, at, "trim_ms"), values(found, at, "frame_ms")
        share = f"{100 * statistics.median(t / f for t, f in zip(trims, frame)):.0f} %" if trims else ""
        row = found[0][at]
        times = [cell(found, at, column) for column in ("trim_ms", "frame_ms", "turning_trim_ms", "turning_frame_ms")]
        error = [int(row["wrong"]), float(row["worst_shift_px"])] if row["wrong"] else ["", ""]
        rows.append([at[1], int(at[2]), at[3], *times, share, cell(found, at, "trim_bytes", 2**-20), *error])
    head = [
        "way",
        "zoom",
        "picture",
        "trims, ms",
        "frame, ms",
        "turning: trims",
        "frame, ms",
        "of the frame",
        "trims, MiB",
        "wrong pixels",
        "worst, px",
    ]
    section.tables.append(Table(model, head, rows))


def plots(section, model, found, size):
    ways = list(dict.fromkeys(at[1] for at in found[0]))
    name = model.replace(" ", "-")

    def lines(x, column, chosen, scale=1.0):
        drawn = []
        for way in ways:
            ats = [at for at in found[0] if at[:2] == (model, way) and chosen(at) and values(found, at, column)]
            drawn.append(
                Line(way, [(x(at), statistics.median(values(found, at, column)) * scale) for at in ats], way in OURS)
            )
        return drawn

    zoom, pixels = lambda at: at[2], lambda at: float(int(at[3].split("x")[0]) * int(at[3].split("x")[1]))
    of_zoom, of_size = lambda at: at[3] == size, lambda at: at[2] == 1
    section.plots += [
        Plot(f"trims-{name}-zoom", f"trims over zoom: {model}", "zoom", "trims, ms", lines(zoom, "trim_ms", of_zoom)),
        Plot(
            f"trims-{name}-size",
            f"trims over picture size: {model}",
            "pixels",
            "trims, ms",
            lines(pixels, "trim_ms", of_size),
        ),
        Plot(
            f"trims-{name}-memory",
            f"memory over zoom: {model}",
            "zoom",
            "trims, MiB",
            lines(zoom, "trim_bytes", of_zoom, 2**-20),
        ),
    ]


def contests(section, model, found, size):
    """The better of our ways beside bisection in time, beside the texture in memory, at each zoom."""
    for at in found[0]:
        if at[:2] != (model, "bisect") or at[3] != size:
            continue
        other = lambda way, at=at: (model, way, at[2], at[3])
        what = f"{model}, {int(at[2])} times"
        ours, theirs = ([cost(one, ats) for one in found] for ats in ([other(way) for way in OURS], [at]))
        section.contests.append(contest(f"trims, {what}", "bisection", "ms", ours, theirs, claims.TRIMS))
        # for the accuracy of the closest view a texture needs a texel a pixel
        claim = claims.memory_beside_a_texture(at[2])
        least = min(filter(None, (values(found[:1], other(way), "trim_bytes") for way in OURS)), default=[])
        texture = values(found[:1], other("texture"), "trim_bytes")
        memory = contest(f"memory, {what}", "a trim texture", "bytes", least, texture, claim, exact=True)
        memory.cause = texture_cause(model, found[0], size)
        section.contests.append(memory)


def texture_cause(model, first, size):
    """The bytes of a texture at the closest view: ours serve all views."""
    rows = [(at[2], row) for at, row in first.items() if at[:2] == (model, "texture") and at[3] == size]
    closest, bytes_ = max(((zoom, float(row["trim_bytes"])) for zoom, row in rows if row["trim_bytes"]), default=(1, 0))
    if closest <= 1:
        return ""
    megabytes = bytes_ / 1e6
    return f"{model}: our trims serve views at every distance; a texture for {closest:g} times takes {megabytes:.1f} MB"


def contest(what, peer, unit, ours, theirs, claim, exact=False):
    if None in ours or None in theirs or not ours or not theirs:
        return Contest(what, peer, unit, why="the device has no room for it")
    return Contest(what, peer, unit, ours, theirs, claim, exact)


def cost(one, ats):
    """Milliseconds of the quickest way; at least a hundredth of its frame, for a difference of two may be below 0."""
    texts = [(one[at]["trim_ms"], one[at]["frame_ms"]) for at in ats if at in one and one[at]["trim_ms"]]
    return min((max(float(trims), 0.01 * float(frame)) for trims, frame in texts), default=None)
