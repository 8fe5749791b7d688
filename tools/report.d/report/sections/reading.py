"""10. Reading files, beside Open CASCADE."""

from .. import claims
from ..noise import median
from ..rows import Contest, Promise
from ..turns import Unmeasurable, rounds

FILES = [
    "samples/panel.step",
    "samples/assembly.step",
    "nist_pmi_2.stp",
    "framework_printable_case_full.stp",
    "impeller.igs",
    "nist_827-9999-904.stp",
]
# of the time of reading, for the box of what the trims leave
MOST_BOX = 0.05
TITLE = "Reading files"
TEXT = """\
*Ours* is from bytes on disk to a valid model, on all cores, in a fresh process for each file. *Theirs* is the two
steps of Open CASCADE's reader, read and transfer, with all files in one process. The box of the model is found after
reading, in the same process; its share is the median of the rounds."""


def measure(context, section):
    names = context.pick(FILES[:4], FILES)
    there = {name: context.model(name) for name in names if context.model(name)}
    section.contests += [
        Contest(f"reading, {name}", "Open CASCADE", "ms", why=context.absent(name).why)
        for name in names
        if name not in there
    ]

    def theirs():
        context.peers.needed("Open CASCADE")
        found = context.peers.results(
            "reading", {"models": [str(path) for path in there.values()]}, limit_s=60
        )
        if len(found) < len(there):
            raise context.peers.error(f"it read {len(found)} of {len(there)} files")
        return [1e3 * one["read_s"] for one in found]

    shares = []

    def ours():
        told = [context.program.reading(path) for path in there.values()]
        shares.append([share for _, share in told])
        return [ms for ms, _ in told]

    seconds = context.budget.seconds * 0.8
    results = rounds({"ours": ours, "theirs": theirs}, seconds, most=5, left=context.budget.left)
    if isinstance(results["ours"], Unmeasurable):
        raise results["ours"]
    for k, name in enumerate(there):
        what = f"reading, {name.split('/')[-1]}"
        if isinstance(results["theirs"], Unmeasurable):
            section.contests.append(Contest(what, "Open CASCADE", "ms", why=str(results["theirs"])))
        else:
            many = min(map(len, results.values()))
            mine, other = ([one[k] for one in results[who][:many]] for who in ("ours", "theirs"))
            section.contests.append(Contest(what, "Open CASCADE", "ms", mine, other, claims.READING))
    wide = [name for k, name in enumerate(there) if median([one[k] for one in shares]) > MOST_BOX]
    what = f"the box of a file takes at most {MOST_BOX:.0%} of reading it"
    section.promises.append(Promise(": ".join([what, *wide]), len(wide), len(there)))
    section.commands.append("selvedge -v info FILE")
