"""3. Trimming: the plots of R. Wu and J. Peters, Correct resolution rendering of trimmed spline surfaces, 2014, for
all ways to trim."""

import statistics

from ..rows import Contest, Line, Missing, Plot, Promise, Section, Table

# the engine's own; the others are baselines
OURS = ("table", "exact")
FILES_QUICK = ["samples/panel.step"]
FILES = [*FILES_QUICK, "nist_pmi_2.stp", "m6_countersunk_screw.step"]
TEXT = """\
The engine's ways to trim, `table` and `exact`, beside other methods: bisection (the paper's), a texture of the trim,
and triangles made in advance. *Trims* is what the tests cost in the passes of a frame, *turning* the same of a view
that turns. The least of the frames of each round counts, and the table has medians over the rounds."""


def measure(context):
    section = Section(3, "Trimming", TEXT)
    names = context.pick(FILES_QUICK, FILES)
    zooms = context.pick("1,10", "1,10,100,1000")
    sizes = context.pick("200x200,400x400", "400x400,800x800,1600x1600,3840x2160")
    size, holes = context.pick("400x400", "800x800"), context.pick(20, 100)
    models = [model for model in map(context.model, names) if model]
    absent = [name for name in names if not context.model(name)]
    section.contests += [Contest(f"trims, {name}", "all", "ms", why=context.absent(name).why) for name in absent]
    words = [*models, "--no-knobs", "--holes", holes, "--zooms", zooms, "--sizes", sizes, "--size", size]
    words += ["--frames", context.pick(2, 5), "--samples", context.pick(500, 2000)]
    found = []
    for number in range(context.pick(3, 5)):
        context.say(f"round {number + 1}")
        found.append(unique(context.program.trims(*words)))
    section.commands.append(context.shown("trims", *words))
    wrong = sum(int(row["wrong"] or 0) for row in found[0].values() if row["way"] in OURS)
    judged = sum(int(row["judged"] or 0) for row in found[0].values() if row["way"] in OURS)
    section.promises.append(Promise("a pixel trimmed by `table` or `exact` right within half a pixel", wrong, judged))
    for model in dict.fromkeys(model for model, *_ in found[0]):
        table(section, model, found)
        plots(section, model, found, size)
        contests(section, model, found, size)
    return section


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
        section.contests.append(contest(f"trims, {what}", "bisection", "ms", ours, theirs, "ahead"))
        # for the accuracy of the closest view a texture needs a texel a pixel
        claim = "ahead" if at[2] >= 10 else "open"
        least = min(filter(None, (values(found[:1], other(way), "trim_bytes") for way in OURS)), default=[])
        texture = values(found[:1], other("texture"), "trim_bytes")
        section.contests.append(
            contest(f"memory, {what}", "a trim texture", "bytes", least, texture, claim, exact=True)
        )


def contest(what, peer, unit, ours, theirs, claim, exact=False):
    if None in ours or None in theirs or not ours or not theirs:
        return Contest(what, peer, unit, why="the device has no room for it")
    return Contest(what, peer, unit, ours, theirs, claim, exact)


def cost(one, ats):
    """Milliseconds of the quickest way; at least a hundredth of its frame, for a difference of two may be below 0."""
    texts = [(one[at]["trim_ms"], one[at]["frame_ms"]) for at in ats if at in one and one[at]["trim_ms"]]
    return min((max(float(trims), 0.01 * float(frame)) for trims, frame in texts), default=None)
