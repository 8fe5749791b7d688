"""The report as Markdown: losses first, then claims, then missing measurements, then the sections."""

from . import claims as claimed
from .noise import median
from .rows import Missing

VERDICT_WORDS = {
    "ahead": "ahead",
    "even": "even",
    "behind": "behind",
    "unreached": "ahead",
    "not measured": "not measured",
}
# between the name of a contest and its bound on the error
WITHIN = ", within "


def text(report, plots):
    """`plots` are paths of pictures, relative to the document, by the plots' names."""
    parts = [
        "# Benchmarks",
        "Written by `tools/report`: current figures only. Each section names the run that measured it; `tools/report "
        "--only SECTION` measures one anew. Dated experiments stand in [notes](notes).",
        heading(report),
        "## Where we lose",
        losses(report),
        "## What we claim",
        claims(report),
        "## What was not measured",
        absences(report),
    ]
    for section in report.sections:
        parts.append(f"## {section.number}. {section.title}")
        parts.append(section_text(section, plots))
    return "\n\n".join(part for part in parts if part) + "\n"


def heading(report):
    took, given = (sum(getattr(section, of) for section in report.sections) for of in ("seconds", "given"))
    of_runs = lambda of: shared(report.sections, lambda section: of(section.run))
    rows = [
        ("machine", of_runs(lambda run: [run.machine])),
        ("device", of_runs(lambda run: [run.device] if run.device else []) or "none was used"),
        ("date, commit", of_runs(lambda run: [f"{run.date}, {run.commit}"])),
        ("peers", of_runs(versions) or "none"),
        ("time", f"{took / 60:.0f} minutes; the sections are given {given / 60:.0f}"),
    ]
    count = lambda verdict: sum(c.verdict() == verdict for _, c in report.contests())
    ahead = count("ahead") + count("unreached")
    rows.append(
        (
            "contests",
            f"{ahead} ahead, {count('even')} even, {count('behind')} behind, {count('not measured')} not measured",
        )
    )
    return table(["", ""], rows) + (
        "\n\nCompetitors take turns. A ratio is theirs to ours: the median over the rounds, with its 95 % bootstrap "
        "interval. Above 1 we are ahead; an interval that contains 1 is even. A **claim** that is behind makes the run "
        "fail. Each section has a budget of time; what it had no time for is listed below, with the limit."
    )


def versions(run):
    return [f"{name} {value}" for name, value in run.peers.items() if not isinstance(value, Missing)]


def shared(sections, values):
    """The values of the sections; what some sections lack has the numbers of the others."""
    found = {}
    for section in sections:
        for value in values(section):
            found.setdefault(value, []).append(section.number)
    return "; ".join(value + among(numbers, sections) for value, numbers in found.items())


def among(numbers, sections):
    """The numbers of sections in brackets, three in sequence as "1 to 3"; empty if they are all."""
    if len(numbers) == len(sections):
        return ""
    spans = []
    for number in numbers:
        if spans and number == spans[-1][-1] + 1:
            spans[-1].append(number)
        else:
            spans.append([number])
    words = [f"{span[0]} to {span[-1]}" if len(span) > 2 else ", ".join(map(str, span)) for span in spans]
    return f" (section{'s' if numbers[1:] else ''} {', '.join(words)})"


def losses(report):
    """What is broken, failed or lost; then what we are behind in, under the measurements that explain it."""
    behind_in = {tallied(s, c) for s, c in report.contests() if c.verdict() == "behind"}
    short = tally((s, c) for s, c in report.contests() if tallied(s, c) in behind_in)
    told = lambda s, p: f"{s.number}. {p.what}: {p.violations:,} of {p.cases:,}"
    lines = [f"* **broken**: {told(s, p)}" for s, p in report.broken()]
    lines += [f"* **failed**: {s.number}. {s.title}: {s.failure}" for s in report.sections if s.failure]
    behind = [(s, c) for s, c in report.contests() if c.verdict() == "behind"]
    behind.sort(key=lambda row: (not row[1].lost(), row[1].ratio().median))
    cause = lambda c: f". Its cause: {c.cause}" if c.cause else ""
    lines += [f"* **lost**: {loss(s, c)}{cause(c)}" for s, c in behind if c.lost()]
    lines += [f"* known: {told(s, p)}; {p.known}" for s, p in report.promises() if p.excepted()]
    parts = [short, "\n".join(lines)]
    grouped, bounds = {}, {}
    for section, contest in behind:
        if not contest.lost():
            what, _, bound = contest.what.partition(WITHIN)
            others = bounds.setdefault((section.number, what, contest.peer, contest.cause), [])
            if not others:
                grouped.setdefault(contest.cause, []).append((section, contest, others))
            others.append(bound)
    for cause, rows in grouped.items():
        also = lambda others: f"; also{WITHIN.strip(',')}{', '.join(others[1:])}" if others[1:] else ""
        grouped[cause] = [f"* {loss(section, contest)}{also(others)}" for section, contest, others in rows]
    unexplained = grouped.pop("", [])
    if unexplained:
        parts += ["No measurement explains these:", "\n".join(unexplained)]
    for cause, rows in grouped.items():
        parts += [f"Cause: {cause}.", "\n".join(rows)]
    return "\n\n".join(part for part in parts if part) or "Nowhere in these sections."


def tallied(section, contest):
    """A contest's row of a tally: its section, and its quantity."""
    return section.number, contest.what.split(",")[0]


def tally(contests):
    """Verdicts counted by quantity, with the least ratio; empty without contests."""
    rows = {}
    for section, contest in contests:
        rows.setdefault(tallied(section, contest), []).append(contest)
    body = []
    for (number, quantity), of in rows.items():
        count = lambda *verdicts, of=of: sum(contest.verdict() in verdicts for contest in of)
        counts = [count("ahead", "unreached"), count("even"), count("behind"), count("not measured")]
        measured = [contest for contest in of if contest.ratio()]
        least = min(measured, key=lambda contest: contest.ratio().median, default=None)
        body.append([f"{number}. {quantity}", *counts, f"{interval(least)}, {least.peer}" if least else ""])
    head = ["section and quantity", "ahead", "even", "behind", "not measured", "least ratio"]
    return table(head, body) if body else ""


def claims(report):
    """The claims by quantity, and in which cases; in the sections' tables each is marked."""
    short = tally((s, c) for s, c in report.contests() if c.claim == "ahead")
    lines = [f"* {s.number}. {sentence}" for s in report.sections for sentence in claimed.sentences(s.name)]
    return "\n\n".join(part for part in (short, "\n".join(lines)) if part) or "Nothing in these sections."


def loss(section, contest):
    ours, theirs = (number(float(median(figures))) for figures in (contest.ours, contest.theirs))
    beside = f"{ours} {contest.unit} beside {theirs} {contest.unit} of {contest.peer}"
    return f"{section.number}. {contest.what}: {beside}, ratio {interval(contest)}"


def absences(report):
    absent, grouped = {}, {}
    for section in report.sections:
        for name, value in section.run.peers.items():
            if isinstance(value, Missing):
                absent.setdefault((name, value.why), []).append(section.number)
    lines = [f"* {name}{among(numbers, report.sections)}: {why}" for (name, why), numbers in absent.items()]
    for section, contest in report.contests():
        if contest.verdict() == "not measured":
            grouped.setdefault((section.number, contest.reason()), []).append(f"{contest.what}, {contest.peer}")
    for section, promise in report.promises():
        if promise.why:
            grouped.setdefault((section.number, promise.why), []).append(promise.what)
    # reasons that occur in tables alone
    for section in report.sections:
        for one in section.tables:
            for why in {cell.why: None for row in one.rows for cell in row if isinstance(cell, Missing)}:
                grouped.setdefault((section.number, why), [one.title or section.title])
    for (number, why), what in grouped.items():
        named = what[0] if len(what) == 1 else f"{what[0]}, and {len(what) - 1} more"
        lines.append(f"* {number}. {named}: {why}")
    return "\n".join(lines) or "Nothing was left out."


def section_text(section, plots):
    parts = [measured(section), section.text]
    if section.failure:
        parts.append(f"**This section failed**: {section.failure}")
    for one in section.tables:
        parts += [f"**{one.title}.** {one.text}".strip() if one.title else one.text, cells(one)]
    if section.contests:
        parts.append(contests(section.contests))
    if section.promises:
        parts.append(promises(section.promises))
    parts += [f"![{plot.title}]({plots[plot.name]})" for plot in section.plots if plot.name in plots]
    if any(plot.name not in plots for plot in section.plots):
        parts.append("Not plotted: matplotlib is not installed.")
    if section.commands:
        parts.append("```sh\n" + "\n".join(section.commands) + "\n```")
    return "\n\n".join(part for part in parts if part)


def measured(section):
    """The run of a section, and its time."""
    run = section.run
    time = f", {span(section.seconds)} of the {span(section.given)} that it is given" if section.given else ""
    on = "; ".join(part for part in (f"{run.machine}, load {run.load}", run.device) if part)
    return f"Measured {run.date}, commit {run.commit}{time}, by `{run.command}`. {on}."


def span(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.1f} min"


def contests(rows):
    body = []
    for c in rows:
        measured = c.ratio() is not None
        verdict = VERDICT_WORDS[c.verdict()] + (
            ", **claim lost**" if c.lost() else ", claimed" if c.claim == "ahead" else ""
        )
        ours, theirs = (median_of(values, measured) for values in (c.ours, c.theirs))
        ratio = interval(c) if measured else c.reason()
        body.append([c.what, c.peer, c.unit, ours, theirs, ratio, verdict])
    return table(["contest", "peer", "unit", "ours", "theirs", "ratio", "verdict"], body)


def median_of(values, measured):
    return number(float(median(values))) if measured else ""


def interval(contest):
    found = contest.ratio()
    if contest.exact:
        return f"{found.median:.2f}"
    return f"{found.median:.2f} [{found.low:.2f}, {found.high:.2f}]"


def promises(rows):
    body = [[p.what, p.why or f"{p.cases:,}", "" if p.why else f"{p.violations:,}"] for p in rows]
    return table(["must hold", "cases", "violations"], body)


def cells(one):
    """A table, with a note for each reason why a figure is missing."""
    reasons, rows = [], []
    for row in one.rows:
        line = []
        for cell in row:
            if isinstance(cell, Missing):
                if cell.why not in reasons:
                    reasons.append(cell.why)
                line.append(f"({reasons.index(cell.why) + 1})")
            else:
                line.append(number(cell))
        rows.append(line)
    notes = "\n".join(f"({k + 1}) {why}  " for k, why in enumerate(reasons))
    return table(one.head, rows) + (f"\n\n{notes}" if notes else "")


def number(cell):
    """A measurement with three digits; words and whole numbers unchanged."""
    if isinstance(cell, bool) or cell is None:
        return "" if cell is None else ("yes" if cell else "no")
    if isinstance(cell, int):
        return f"{cell:,}"
    if not isinstance(cell, float):
        return str(cell)
    if cell == 0 or 0.001 <= abs(cell) < 1e6:
        digits = 0 if abs(cell) >= 100 else 1 if abs(cell) >= 10 else 2 if abs(cell) >= 1 else 3
        return f"{cell:,.{digits}f}"
    return f"{cell:.1e}"


def table(head, rows):
    escape = lambda cell: str(cell).replace("|", "\\|").replace("\n", " ")
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(escape(cell) for cell in row) + " |" for row in rows])
