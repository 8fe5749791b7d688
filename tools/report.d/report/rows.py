"""The contents of a report: contests, promises, tables and plots, by section.

A contest is one quantity, the smaller the better, measured for the program and for a peer in the same rounds. Its ratio
is theirs to ours: above 1 we are ahead. With `claim` "ahead" the project says that it wins; "open" claims nothing.

    verdict         of the interval of the ratio              lost: a claim that is
    ahead           all of it is above 1
    even            it holds 1: within the noise
    behind          all of it is below 1                      yes
    unreached       no setting of the peer is as right, or it drew nothing; we are ahead
    not measured    `why` has the reason

A promise counts violations; it has no noise, and a violation that no document excepts makes the run fail. A cell of a
table that could not be measured is a `Missing`.
"""

import dataclasses
from dataclasses import dataclass, field

from . import noise

# of benchmarks.json; stored.py lists the formats
SCHEMA = 2
CLAIMS = ("ahead", "open")
VERDICTS = ("ahead", "even", "behind", "unreached", "not measured")


@dataclass(frozen=True)
class Missing:
    """Takes the place of a figure: the reason why there is none."""

    why: str


@dataclass
class Contest:
    """`ours` and `theirs` have one figure a round. `exact` quantities (bytes, counts, errors) have no noise. `cause`
    is a measurement that explains a loss."""

    what: str
    peer: str
    unit: str
    ours: list[float] = field(default_factory=list)
    theirs: list[float] = field(default_factory=list)
    claim: str = "open"
    exact: bool = False
    unreached: bool = False
    why: str = ""
    cause: str = ""

    def __post_init__(self):
        if self.claim not in CLAIMS:
            raise ValueError(f"no such claim: {self.claim}")
        if not self.why and not self.unreached and len(self.ours) != len(self.theirs):
            raise ValueError(f"{self.what}: {len(self.ours)} rounds of ours, {len(self.theirs)} of {self.peer}")
        if not self.why and not self.unreached and not self.ours:
            raise ValueError(f"{self.what}: neither rounds nor a reason")
        if any(figure <= 0 for figure in [*self.ours, *self.theirs]):
            raise ValueError(f"{self.what}: a figure that is not above 0 has no ratio")
        if self.unreached and not self.why:
            raise ValueError(f"{self.what}: what did {self.peer} not reach?")

    def ratio(self):
        """Theirs to ours: `noise.Interval`; None if it was not measured, or in too few rounds to estimate the noise."""
        if self.unreached or self.why:
            return None
        if self.exact:
            ratio = noise.median(self.theirs) / noise.median(self.ours)
            return noise.Interval(ratio, ratio, ratio)
        return noise.ratio_interval(self.ours, self.theirs)

    def verdict(self):
        if self.unreached:
            return "unreached"
        interval = self.ratio()
        if interval is None:
            return "not measured"
        if interval.low > 1:
            return "ahead"
        return "behind" if interval.high < 1 else "even"

    def reason(self):
        """The reason why there is no ratio; empty if there is one."""
        if self.why:
            return self.why
        return "" if self.ratio() else f"rounds: {len(self.ours)}, too few to know the noise"

    def lost(self):
        """A claim that did not hold, by more than the noise."""
        return self.claim == "ahead" and self.verdict() == "behind"


@dataclass
class Promise:
    """Violations of something that must hold, out of how many cases; `known` says which document excepts up to `most` a
    case."""

    what: str
    violations: int = 0
    cases: int = 0
    why: str = ""
    known: str = ""
    most: float = 0.0

    def violated(self):
        return not self.why and self.violations > 0

    def excepted(self):
        """Violated as a document says."""
        return self.violated() and bool(self.known) and self.violations <= self.most * self.cases

    def broken(self):
        """Violated where no document says so, or more often."""
        return self.violated() and not self.excepted()


@dataclass
class Table:
    """Cells are numbers, words or `Missing`."""

    title: str
    head: list[str]
    rows: list[list]
    text: str = ""

    def __post_init__(self):
        for row in self.rows:
            if len(row) != len(self.head):
                raise ValueError(f"{self.title}: {len(row)} cells under {len(self.head)} heads: {row}")


@dataclass
class Line:
    """A curve of a plot: its name and points."""

    name: str
    points: list[tuple[float, float]]
    ours: bool = False


@dataclass
class Plot:
    """Both axes are logarithmic."""

    name: str
    title: str
    x: str
    y: str
    lines: list[Line]


@dataclass
class Run:
    """What measured a section: the command, the day, the engine, and where. `peers` are versions, or `Missing`.
    `device` is empty if the program had drawn nothing by then."""

    command: str
    date: str
    machine: str
    device: str
    commit: str
    load: str
    peers: dict


@dataclass
class Section:
    number: int
    title: str
    text: str
    # as --only names it
    name: str = ""
    # None until the section is measured
    run: Run | None = None
    tables: list[Table] = field(default_factory=list)
    contests: list[Contest] = field(default_factory=list)
    promises: list[Promise] = field(default_factory=list)
    plots: list[Plot] = field(default_factory=list)
    commands: list[str] = field(default_factory=list)
    seconds: float = 0.0
    # the time that it was given
    given: float = 0.0
    failure: str = ""


@dataclass
class Report:
    """The sections, of one run or of several."""

    sections: list[Section]

    def contests(self):
        return [(section, contest) for section in self.sections for contest in section.contests]

    def promises(self):
        return [(section, promise) for section in self.sections for promise in section.promises]

    def lost(self):
        return [(s, c) for s, c in self.contests() if c.lost()]

    def broken(self):
        return [(s, p) for s, p in self.promises() if p.broken()]

    def exit_status(self):
        """1: a claim was lost by more than the noise, a promise is broken, or a section failed. Of all sections."""
        failed = any(section.failure for section in self.sections)
        return 1 if self.lost() or self.broken() or failed else 0

    def as_json(self):
        """Plain data, with the verdicts; `Missing` becomes {"missing": why}."""
        whole = plain(self)
        for section, data in zip(self.sections, whole["sections"]):
            for contest, row in zip(section.contests, data["contests"]):
                interval = contest.ratio()
                row["verdict"], row["lost"], row["reason"] = contest.verdict(), contest.lost(), contest.reason()
                row["ratio"] = interval and dataclasses.asdict(interval)
            for promise, row in zip(section.promises, data["promises"]):
                row["broken"] = promise.broken()
        return {"schema": SCHEMA, **whole, "exit_status": self.exit_status()}


def worst_cell(found):
    """The worst distance that a judge of pictures found, a bound where it searched no farther."""
    return f"> {found['worst_px'] / 2:g}" if found["beyond"] else found["worst_px"]


def error_cells(found):
    """Worst distance, that of one pixel in a thousand, and pixels off; empty where nothing was judged."""
    return [worst_cell(found), found["p999_px"], found["off"]] if found else [""] * 3


def plain(value):
    """Dataclasses as dictionaries, all the way down."""
    if isinstance(value, Missing):
        return {"missing": value.why}
    if dataclasses.is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value
