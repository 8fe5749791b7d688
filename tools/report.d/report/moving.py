"""A step of one instance in a scene that is drawn already, by the benchmark benches/moving.rs, which `tools/report`
builds and the environment variable REPORT_MOVING names."""

import os

from .rows import Missing, Promise, Table
from .turns import Unmeasurable

FILES = ["samples/assembly.step", "samples/bracket.step", "nist_pmi_2.stp", "framework_printable_case_full.stp"]
# milliseconds in which an instance of this sample moves
PROMISED, PROMISED_MS = "assembly.step", 1.0
PROCESS_S = 60
NOT_BUILT = "not built: a whole run of tools/report builds the benchmark, if SELVEDGE names no program"
HEAD = ["file", "instances", "move, ms", "worst", "record, ms", "worst"]
TEXT = """\
One instance moves by a small step in each of 50 frames. *Move* is the call that moves it, *record* the call that
records the next frame, both on the processor: medians, and the worst. The frame is drawn after them."""


def measure(context, section):
    """Adds the table, and the promise that a step takes less than a millisecond."""
    promise = Promise(f"an instance of samples/{PROMISED} moves in less than {PROMISED_MS:g} ms")
    section.promises.append(promise)
    rows = []
    for name in FILES:
        model = context.model(name)
        if model is None:
            rows.append([name, context.absent(name), *[""] * 4])
            continue
        try:
            row = of_file(context, model)
        except Unmeasurable as error:
            promise.why = promise.why or (str(error) if model.name == PROMISED else "")
            rows.append([model.name, Missing(str(error)), *[""] * 4])
            continue
        if model.name == PROMISED:
            promise.cases, promise.violations = 1, int(row[2] >= PROMISED_MS)
        rows.append(row)
    section.tables.append(Table("A step of one instance", HEAD, rows, TEXT))
    section.commands.append("cargo bench --features headless --bench moving -- FILE")


def of_file(context, model):
    """A row of the benchmark's table."""
    bench = os.environ.get("REPORT_MOVING")
    if not bench:
        raise Unmeasurable(NOT_BUILT)
    context.budget.needed()
    out, problem, _ = context.peers.run([bench, model], PROCESS_S)
    if problem:
        raise context.peers.error(f"the benchmark was {problem}")
    return row_of(out)


def row_of(out):
    """The last line of the benchmark's table, numbers as numbers."""
    lines = [line for line in out.splitlines() if line.startswith("| ")]
    name, instances, *times = [cell.strip() for cell in lines[-1].strip("| ").split("|")]
    return [name, int(instances), *map(float, times)]
