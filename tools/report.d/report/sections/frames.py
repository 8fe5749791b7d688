"""9. Frames of the samples: still and turning, with the driver's pipelines, and their judged errors."""

from pathlib import Path

from ..rows import Promise, Table

MODELS = ["samples/panel.step", "samples/bracket.step", "samples/assembly.step", "samples/gallery/glass.toml"]
TITLE = "Frames of the samples"
TEXT = """\
Medians of the frames after the first one. *Pipelines* is the time in which the driver makes the scene's pipelines;
*first frame* is the time of the frame for which it compiles the rest. *Reused* is a standing view, drawn as a viewer
draws it."""


def measure(context, section):
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
