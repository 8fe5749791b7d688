"""5. Scale: patches, instances and the leaves of solids, each over decades: time, bytes, exponents of growth."""

from .. import moving, noise, scenes
from ..rows import Line, Missing, Plot, Table
from ..turns import Unmeasurable

# from so many copies or holes on one frame is measured: it is long, and its noise small
ONE_FRAME = 500
# patches that the engine stores of a sheet
STORED = 4096
# seconds of one number
MOST_S = 180
TITLE = "Scale"
TEXT = """\
Patches are those of wavy bicubic sheets of 32 x 32 spans, each sheet with a net of its own; the table counts the
patches that the engine stores. Instances are copies of `bracket.step`. Leaves are the primitives of a plate with a grid
of holes. All are seen whole, and every pass is recorded: the median of the frames. From 500 copies or holes on, one
frame is measured. An exponent of 1 is growth in proportion, a smaller one slower growth; *last* is the exponent
between the two largest."""


def measure(context, section):
    size = context.pick("480x270", "640x360")
    frames = lambda number: context.pick(2, 5) if number < ONE_FRAME else 1
    copies = context.pick("1,10,100", "1,10,100,500,2442")
    words = ["--size", size]
    # the quickest first, so that the largest numbers come last within the section's time
    series = [
        (
            "leaves",
            "leaves of a solid",
            lambda: leaves(context, section, context.pick([9, 100, 1024], [9, 100, 1024, 10000, 99856]), words, frames),
        ),
        (
            "patches",
            "patches",
            lambda: swept(context, section, ["--degrees", "3", "--distinct"], copies, size, frames, "patches"),
        ),
        (
            "instances",
            "instances",
            lambda: swept(
                context,
                section,
                [context.model("samples/bracket.step")],
                context.pick("1,10,100,1000", "1,10,100,1000,10000,30000,100000"),
                size,
                frames,
                "copies",
            ),
        ),
    ]
    moving.measure(context, section)
    exponents = []
    for name, title, measured in series:
        context.say(name)
        points = measured()
        rows = [[int(n), *(cells if not isinstance(cells, str) else [Missing(cells)] * 3)] for n, cells in points]
        section.tables.append(
            Table(title[0].upper() + title[1:], [title, "all passes, ms", "scene, MiB", "transient, MiB"], rows)
        )
        good = [(n, cells) for n, cells in points if not isinstance(cells, str)]
        for k, what in enumerate(["time", "bytes of the scene", "transient bytes"]):
            curve = [(n, cells[k]) for n, cells in good]
            last = noise.exponent(curve[-2:])
            exponents.append(
                [
                    title,
                    what,
                    *(
                        Missing("fewer than two sizes were measured") if e is None else e
                        for e in (noise.exponent(curve), last)
                    ),
                ]
            )
        line = Line("selvedge", [(n, cells[0]) for n, cells in good], True)
        section.plots.append(Plot(f"scale-{name}", f"time over {title}", title, "all passes, ms", [line]))
    section.tables.append(Table("Exponents", ["of", "", "over all", "last"], exponents))


def swept(context, section, what, copies, size, frames, column):
    """`(number, [ms, MiB, MiB])` of each number of copies, or why not."""
    points = []
    for number in copies.split(","):
        words = [*what, "--copies", number, "--sizes", size, "--frames", frames(int(number)), "--samples", 0]
        try:
            context.budget.needed()
            (row,) = context.program.sweep(*words, limit_s=MOST_S)
        except Unmeasurable as error:
            each = STORED if column == "patches" else 1
            points.append((int(number) * each, str(error)))
            continue
        mebibytes = [float(row[key]) / 2**20 for key in ("persistent_bytes", "transient_bytes")]
        points.append((int(row[column]), [float(row["all_ms"]), *mebibytes]))
    section.commands.append(
        context.shown("sweep", *what, "--copies", copies, "--sizes", size, "--frames", frames(1), "--samples", 0)
    )
    return points


def leaves(context, section, holes, words, frames):
    points = []
    for number in holes:
        scene = scenes.plate(number)
        path = context.program.folder() / f"{scene.name}.toml"
        path.write_text(scenes.toml(scene))
        # the first frame of a turn stands
        options = ["--motion", "turn", "--judged", 0, "--frames", max(frames(number), 2), *words]
        try:
            context.budget.needed()
            (report,) = context.program.bench([path], *options, limit_s=MOST_S)
        except Unmeasurable as error:
            points.append((number + 1, str(error)))
            continue
        bytes_ = lambda pool: report["largest"].get(f"pool: {pool}", 0.0) / 2**20
        points.append((number + 1, [report["of"]["all passes"], bytes_("persistent"), bytes_("transient")]))
    section.commands.append(
        context.shown("bench", "plate.toml", "--motion", "turn", "--judged", 0, "--frames", frames(1), *words)
    )
    return points
