"""6. Stability: hard cases and random ones, judged against the exact reference; violations counted."""

import random
import time

from .. import hard, program
from ..rows import Missing, Promise, Table
from ..turns import Late, Unmeasurable

# the first random case; others follow
SEED = 1
PIXEL = "a pixel right within half a pixel,"
# numbers that the random cases go on to, if there is time
GOALS = {"patches": 10**6, "trims": 10**5, "trees": 10**5}
# seconds of a case
CASE_S_QUICK, CASE_S = 30, 120
TITLE = "Stability"
TEXT = """\
Each case is a scene file, which `selvedge check` draws and judges: it compares pixels with rays through the exact model
in double precision. *In doubt* counts the rays that the reference gave up. *Wrong* pixels are right nowhere within half
a pixel. The seed of a random case is its number. Random cases go on until their goals are reached or half of the time
that is left is used up. Trims that change from frame to frame, first frames and lists that overflow have no scene
file; tests/frame and tests/parity have these cases. Scene files with loops that cross are refused."""


def measure(context, section):
    size, samples = context.pick("320x240", "1280x720"), context.pick(1000, 5000)
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
            drawn.cases += not isinstance(found, Late)
            if isinstance(found, Unmeasurable):
                drawn.violations += not isinstance(found, Late)
                rows.append([case.name, case.danger, on, Missing(str(found)), "", "", "", ""])
            else:
                figures = [found.judged, found.wrong, found.worst, found.clamps, found.doubt]
                rows.append([case.name, case.danger, on, *figures])
                pixels, clamps = whole.setdefault(case.known, promises(case.known, case.name))
                pixels.violations, pixels.cases = pixels.violations + found.wrong, pixels.cases + found.judged
                clamps.violations, clamps.cases = clamps.violations + found.clamps, clamps.cases + found.views
    head = ["case", "what could go wrong", "device", "pixels judged", "wrong", "worst, px", "clamps", "in doubt"]
    section.tables.append(Table("Hard cases", head, rows))
    both = [promise for pair in whole.values() for promise in pair]
    section.promises += [drawn, *(promise for promise in both if promise.violations or not promise.known)]
    soak(context, section, judge)
    section.commands.append(context.shown("check", "CASE.toml", "--views", "all", *judge.options))


def promises(known, case):
    """The promises for hard cases; where the documents except some, such as this one, these have their own."""
    pixels, clamps = f"{PIXEL} in hard cases", "no clamp in a view of a hard case"
    if known is None:
        return Promise(pixels), Promise(clamps)
    reason, of = f"docs/accuracy.md: {known.reason}", f", such as {case}"
    return Promise(pixels + of, known=reason, most=known.pixels), Promise(clamps + of, known=reason, most=known.clamps)


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
        """The counts, or what was raised in their place."""
        path = self.context.program.folder() / "case.toml"
        path.write_text(scene)
        on = ["--device", device] if device and not self.context.program.on else []
        limit_s = self.context.pick(CASE_S_QUICK, CASE_S)
        try:
            self.context.budget.needed()
            return Found(self.context.program.check(path, *views, *self.options, *on, limit_s=limit_s))
        except Unmeasurable as error:
            return error


def soak(context, section, judge):
    """Random sheets with loops, then random trees, until the goals are reached or the time of each is up."""
    many, leaves = context.pick(20, 400), context.pick((3, 40), (3, 8))
    kinds = {
        "sheets": lambda draw: (*hard.random_sheets(draw, context.pick(60, 400)), 0),
        "trees": lambda draw: (*hard.random_trees(draw, many, leaves), many),
    }
    rows, half = [], context.budget.left() / 2
    for kind, made in kinds.items():
        context.say(f"random {kind}")
        end, number, total = time.monotonic() + half, SEED, Total()
        wrong, failures = [], []
        while time.monotonic() < end and not total.reached(kind):
            scene, parts, trees = made(random.Random(number))
            found = judge.judged(f"selvedge = 1\n{scene}", ["--views", "whole"])
            if isinstance(found, Late):
                break
            if isinstance(found, Unmeasurable):
                failures.append(f"case {number}: {found}")
            else:
                total.add(found, parts, trees)
                if found.wrong:
                    wrong.append(f"case {number}: {found.wrong} wrong, worst {found.worst:.3f} px")
                if found.clamps:
                    failures.append(f"case {number}: {found.clamps} clamps")
            number += 1
        figures = [number - SEED, total.told(kind), total.judged, total.wrong, total.worst]
        rows.append([kind, *figures, "; ".join([*failures, *wrong][:3])])
        why = "" if total.judged else (failures or ["no case was done in time"])[0]
        section.promises.append(Promise(f"{PIXEL} in random {kind}", total.wrong, total.judged, why))
        drawn = Promise(f"a random scene of {kind} drawn, without a clamp", len(failures), number - SEED)
        section.promises.append(drawn)
    head = ["of", "scenes", "with", "pixels judged", "wrong", "worst, px", "which"]
    section.tables.append(Table("Random cases", head, rows))


class Total:
    def __init__(self):
        self.patches = self.parts = self.trees = self.judged = self.wrong = 0
        self.worst = 0.0

    def add(self, found, parts, trees):
        self.patches += found.patches
        self.parts += parts
        self.trees += trees
        self.judged += found.judged
        self.wrong += found.wrong
        self.worst = max(self.worst, found.worst)

    def numbers(self, kind):
        """What there are goals for."""
        return {"patches": self.patches, "trims": self.parts} if kind == "sheets" else {"trees": self.trees}

    def reached(self, kind):
        return all(number >= GOALS[of] for of, number in self.numbers(kind).items())

    def told(self, kind):
        """The numbers, each with its goal where the time did not suffice."""
        told = [
            f"{number:,} {of}" + ("" if number >= GOALS[of] else f" of {GOALS[of]:,}")
            for of, number in self.numbers(kind).items()
        ]
        return ", ".join(told + ([f"{self.parts:,} leaves"] if kind == "trees" else []))
