"""6. Stability: hard cases and random ones, judged against the exact reference; violations counted."""

import random
import time

from .. import hard, program
from ..rows import Missing, Promise, Section, Table
from ..turns import Unmeasurable

# the first random case; others follow
SEED = 1
PIXEL = "a pixel right within half a pixel,"
TEXT = """\
Each case is a scene file, drawn and judged by `selvedge check`: pixels against rays through the exact model in double
precision. *In doubt* counts rays that the reference gave up. *Wrong* pixels are right nowhere within half a pixel.
The seed of a random case is its number."""


def measure(context):
    section = Section(6, "Stability", TEXT)
    size, samples = context.pick("320x240", "1280x720"), context.pick(1000, 20000)
    judge = Judge(context, ["--size", size, "--samples", samples])
    rows, devices, first, whole = [], [None], True, {}
    drawn = Promise("a hard case drawn and judged")
    for case in hard.CASES:
        cells = [judge.judged(f"selvedge = 1\n{case.scene}", case.views, device) for device in devices]
        if first and "llvmpipe" not in context.program.device:
            devices.append("llvmpipe")  # a GPU was chosen: the CPU's device beside it
            cells.append(judge.judged(f"selvedge = 1\n{case.scene}", case.views, "llvmpipe"))
        first = False
        for device, found in zip(devices, cells):
            on = device or context.program.device.split(" (")[0]
            drawn.cases += 1
            if isinstance(found, str):
                drawn.violations += 1
                rows.append([case.name, case.danger, on, Missing(found), "", "", "", ""])
            else:
                figures = [found.judged, found.wrong, found.worst, found.clamps, found.doubt]
                rows.append([case.name, case.danger, on, *figures])
                pixels, clamps = whole.setdefault(case.known, promises(case.known))
                pixels.violations, pixels.cases = pixels.violations + found.wrong, pixels.cases + found.judged
                clamps.violations, clamps.cases = clamps.violations + found.clamps, clamps.cases + found.views
    head = ["case", "what could go wrong", "device", "pixels judged", "wrong", "worst, px", "clamps", "in doubt"]
    section.tables.append(Table("Hard cases", head, rows))
    both = [promise for pair in whole.values() for promise in pair]
    section.promises += [drawn, *(promise for promise in both if promise.violations or not promise.known)]
    soak(context, section, judge)
    section.commands.append(context.shown("check", "CASE.toml", "--views", "all", *judge.options))
    return section


def promises(known):
    """The promises for hard cases, with the documents' exceptions."""
    pixels, clamps = f"{PIXEL} in hard cases", "no clamp in a view of a hard case"
    if known is None:
        return Promise(pixels), Promise(clamps)
    reason = f"docs/accuracy.md: {known.reason}"
    return Promise(pixels, known=reason, most=known.pixels), Promise(clamps, known=reason, most=known.clamps)


class Found:
    """The sum of a case's views."""

    def __init__(self, views):
        self.views = len(views)
        judgements = [view["judgement"] for view in views]
        self.judged = sum(j["sampled"] for j in judgements)
        self.wrong = sum(map(program.wrong, judgements))
        self.worst = max(map(program.worst_shift_px, judgements))
        self.clamps = sum(view["stats"]["clamps"] for view in views)
        self.doubt = sum(j["given_up"] for j in judgements)
        self.patches = max(view["stats"]["patches"] for view in views)


class Judge:
    def __init__(self, context, options):
        self.context, self.options = context, options

    def judged(self, scene, views, device=None):
        """The counts, or the reason why there are none."""
        path = self.context.program.folder() / "case.toml"
        path.write_text(scene)
        on = ["--device", device] if device and not self.context.program.on else []
        try:
            return Found(
                self.context.program.check(path, *views, *self.options, *on, limit_s=self.context.pick(60, 600))
            )
        except Unmeasurable as error:
            return str(error)


def soak(context, section, judge):
    """Random sheets with loops, then random trees, until the time of each is up."""
    kinds = {
        "sheets": lambda draw: hard.random_sheets(draw, context.pick(60, 400)),
        "trees": lambda draw: (hard.random_tree(draw, leaves := draw.randint(3, 40)), leaves),
    }
    rows = []
    for kind, made in kinds.items():
        context.say(f"random {kind}")
        end, number, total = time.monotonic() + context.pick(12, 120), SEED, Total()
        wrong, failures = [], []
        while time.monotonic() < end:
            scene, parts = made(random.Random(number))
            found = judge.judged(f"selvedge = 1\n{scene}", ["--views", "whole"])
            if isinstance(found, str):
                failures.append(f"case {number}: {found}")
            else:
                total.add(found, parts)
                if found.wrong:
                    wrong.append(f"case {number}: {found.wrong} wrong, worst {found.worst:.3f} px")
                if found.clamps:
                    failures.append(f"case {number}: {found.clamps} clamps")
            number += 1
        counts = f"{total.patches:,} patches, {total.parts:,} trims" if kind == "sheets" else f"{total.parts:,} leaves"
        rows.append(
            [kind, number - SEED, counts, total.judged, total.wrong, total.worst, "; ".join([*failures, *wrong][:3])]
        )
        what = f"{PIXEL} in random {kind}"
        section.promises.append(Promise(what, total.wrong, total.judged, "" if total.judged else failures[0]))
        section.promises.append(
            Promise(f"a random case of {kind} drawn, without a clamp", len(failures), number - SEED)
        )
    section.tables.append(
        Table("Random cases", ["of", "cases", "with", "pixels judged", "wrong", "worst, px", "which"], rows)
    )


class Total:
    def __init__(self):
        self.patches = self.parts = self.judged = self.wrong = 0
        self.worst = 0.0

    def add(self, found, parts):
        self.patches += found.patches
        self.parts += parts
        self.judged += found.judged
        self.wrong += found.wrong
        self.worst = max(self.worst, found.worst)
