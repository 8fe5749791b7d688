"""9. Frames of the samples: still and turning, with the driver's pipelines and their judged errors; a part that moves."""

from pathlib import Path

from ..rows import Promise, Table

MODELS = ["samples/panel.step", "samples/bracket.step", "samples/assembly.step", "samples/gallery/glass.toml"]
TITLE = "Frames of the samples"
TEXT = """\
Medians of the frames after the first one. *Pipelines* is the time in which the driver makes the scene's pipelines;
*first frame* is the time of the frame for which it compiles the rest. *Reused* is a standing view, drawn as a viewer
draws it. In the table of steps the last placed part of a model moves in each frame. *Change* is the call that moves it,
*with recording* that call and the one that records the frame after it, both on one thread; it should be below 1 ms."""
STEPPED = ["samples/assembly.step"]


def measure(context, section):
    steps(context, section)
    models = [context.model(name) for name in MODELS]
    rows, wrong, judged = [], 0, 0
    for motion in ("still", "turn"):
        words = [
            "--motion",
            motion,
            "--size",
            context.pick("480x270", "1280x720"),
            "--frames",
            context.pick(5, 12),
            "--judged",
            1,
        ]
        for report in context.program.bench(models, *words):
            of, first, error = report["of"], report["first_frame"], report["error"]
            wrong, judged = wrong + error["wrong_pixels"], judged + error["judged_pixels"]
            rows.append(
                [
                    Path(report["model"]).name,
                    report["face_instances"],
                    motion,
                    first["pipelines_ms"],
                    first["wall_ms"],
                    of["all passes"],
                    of.get("reused: all passes"),
                    of["wall clock, with read-back"],
                    error["wrong_pixels"],
                    error["worst_shift_px"],
                ]
            )
        section.commands.append(context.shown("bench", *MODELS, *words))
    head = [
        "model",
        "faces placed",
        "camera",
        "pipelines, ms",
        "first frame, ms",
        "all passes, ms",
        "reused, ms",
        "wall clock, ms",
        "wrong pixels",
        "worst shift, px",
    ]
    section.tables.append(Table("", head, rows))
    section.promises.append(Promise("a pixel right within half a pixel, by the project's reference", wrong, judged))


def steps(context, section):
    """The time of a placed part that moves, on the thread that records."""
    words = ["--motion", "step", "--size", "480x270", "--frames", context.pick(20, 50), "--judged", 0]
    rows = []
    for report in context.program.bench([context.model(name) for name in STEPPED], *words):
        both = "step: change and recording"
        of, largest = report["of"], report["largest"]
        name = Path(report["model"]).name
        rows.append([name, report["face_instances"], of["step: change"], of[both], largest[both], of["step: copied"]])
    section.commands.append(context.shown("bench", *STEPPED, *words))
    head = ["model", "faces placed", "change, ms", "with recording, ms", "largest, ms", "copied, bytes"]
    section.tables.append(Table("A step of one placed part", head, rows))
