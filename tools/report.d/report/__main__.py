"""`tools/report`: options, sections in order, the output, the exit status."""

import argparse
import json
import os
import shlex
import sys
import tempfile
import time
import traceback
from pathlib import Path

from . import budget
from . import context as given
from . import machine, markdown, plots, stored
from .peers import Peers
from .program import Program
from .rows import Contest, Report, Run, Section
from .sections import first_use, frames, least, packages, reading, scale, solids, stability, surfaces, trims, zoom
from .turns import Late

SECTIONS = {
    "surfaces": surfaces,
    "zoom": zoom,
    "trims": trims,
    "solids": solids,
    "scale": scale,
    "stability": stability,
    "least": least,
    "first_use": first_use,
    "frames": frames,
    "reading": reading,
    "packages": packages,
}


def options():
    parser = argparse.ArgumentParser(prog="tools/report", description="Speed against error, beside everybody else.")
    parser.add_argument(
        "--quick", action="store_true", help="fewer files, sizes and rounds: 9 minutes, and 85 for the whole"
    )
    parser.add_argument("--device", metavar="NAME", help="part of the name of the Vulkan device")
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="folder of benchmarks.md, benchmarks.json and benchmarks/; docs without it",
    )
    parser.add_argument(
        "--only",
        nargs="+",
        choices=SECTIONS,
        metavar="SECTION",
        help="these alone, in the time of all; the others are those of benchmarks.json, as it was; of "
        + ", ".join(SECTIONS),
    )
    chosen = parser.parse_args()
    chosen.out = (chosen.out or machine.ROOT / "docs").resolve()
    return chosen


def command(chosen):
    """The command as it stands in the document: without the folder, which is one of this machine."""
    words = ["tools/report", *["--quick"] * chosen.quick]
    words += ["--device", chosen.device] if chosen.device else []
    return shlex.join([*words, *(["--only", *chosen.only] if chosen.only else [])])


def measured(name, context, among=SECTIONS):
    """Measures a section, one `among` others; one that ends early keeps what it has, with the reason."""
    print(f"== {name}", file=sys.stderr, flush=True)
    start = time.monotonic()
    of = SECTIONS[name]
    section = Section(list(SECTIONS).index(name) + 1, of.TITLE, of.TEXT, name)
    context.give(budget.of(name, context.quick, among))
    try:
        of.measure(context, section)
    except Late as late:  # too little time is no failure; the row has the limit
        section.contests.append(Contest(section.title, "all", "s", why=str(late)))
        unjudged(section, late)
    except Exception as error:  # the other sections are still measured
        traceback.print_exc()
        section.failure = f"{type(error).__name__}: {error}"
        unjudged(section, section.failure)
    section.seconds, section.given = time.monotonic() - start, context.budget.seconds
    print(f"   {section.seconds:.0f} s of {section.given:.0f}", file=sys.stderr, flush=True)
    return section


def unjudged(section, why):
    """Gives the reason to the promises that no case has tested: they do not pass for kept ones."""
    for promise in section.promises:
        if not promise.cases:
            promise.why = promise.why or str(why)


def write(report, out):
    """Writes Markdown, JSON and plots."""
    folder = out / "benchmarks"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.svg"):
        old.unlink()
    drawn = {}
    for section in report.sections:
        for plot in section.plots:
            try:
                plots.write(plot, folder / f"{plot.name}.svg")
                drawn[plot.name] = f"benchmarks/{plot.name}.svg"
            except ImportError:
                print("no plots: matplotlib is not installed", file=sys.stderr)
    (out / "benchmarks.md").write_text(markdown.text(report, drawn))
    # a later run reads it: one that is ended here leaves the old file or the new one
    new = out / "benchmarks.json.new"
    new.write_text(json.dumps(report.as_json(), indent=1) + "\n")
    new.replace(out / "benchmarks.json")


def kept(chosen):
    """The sections of earlier runs by name; a sentence if there are none and --only needs them."""
    try:
        found = stored.sections(chosen.out / "benchmarks.json", {name: of.TITLE for name, of in SECTIONS.items()})
    except stored.Unreadable as why:
        if chosen.only:
            print(f"{why}: the report will have the sections of this run alone", file=sys.stderr)
        return {}
    return {section.name: section for section in found}


def main():
    chosen = options()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        program = Program(Path(os.environ["SELVEDGE"]).resolve(), chosen.device, scratch)
        context = given.Context(chosen.quick, program, Peers(scratch), scratch, given.models())
        load, date, commit = machine.load(), machine.date(), machine.commit()
        sections, new = kept(chosen), []
        for name in chosen.only or SECTIONS:
            section = measured(name, context, chosen.only or SECTIONS)
            section.run = Run(
                command=command(chosen),
                date=date,
                machine=machine.processor(),
                device=program.device,
                commit=commit,
                load=load,
                peers=context.peers.versions,
            )
            new.append(section)
            sections[name] = section
            # after each section: a run that is ended early leaves what it has measured, beside what was there
            write(Report([sections[name] for name in SECTIONS if name in sections]), chosen.out)
    print(chosen.out / "benchmarks.md")
    report = Report(new)
    for section, contest in report.lost():
        print(
            f"lost: {section.number}. {contest.what}, beside {contest.peer}: {markdown.interval(contest)}",
            file=sys.stderr,
        )
    for section, promise in report.broken():
        print(f"broken: {section.number}. {promise.what}: {promise.violations} of {promise.cases}", file=sys.stderr)
    sys.exit(report.exit_status())


if __name__ == "__main__":
    main()
