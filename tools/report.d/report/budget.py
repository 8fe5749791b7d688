"""The time of each section: what it is given, and what is left of it.

The shares of a whole run are 85 minutes together, those of a quick one 9. Sections that are measured without the others
share the time of all: each takes what it needs of that. A section orders its cases, the most telling
ones first, and divides what is left among those to come. A case that has no time left stays in the report as a row
with that reason, and so does one whose process was ended for the section's time.
"""

import time

from .turns import Late, Overdue

# seconds of a quick run, and of a whole one
SECONDS = {
    "surfaces": (205, 1870),
    "zoom": (80, 270),
    "trims": (75, 430),
    "solids": (80, 560),
    "scale": (20, 470),
    "stability": (37, 170),
    "least": (4, 5),
    "first_use": (4, 780),
    "frames": (13, 60),
    "reading": (20, 45),
    "packages": (0, 440),
}
# a process that begins late gets so many seconds: the judge of a case comes last, and its rows are nothing without it;
# an eighth of its section's time, and no more than this
LEAST_S, LEAST_SHARE = 30.0, 1 / 8


class Budget:
    """`seconds` from now."""

    def __init__(self, seconds, clock=time.monotonic):
        self.seconds, self.clock, self.start = seconds, clock, clock()

    def left(self):
        return max(self.seconds - (self.clock() - self.start), 0.0)

    def needed(self):
        """Raises the reason for the rows of what there is no time for."""
        if self.left() <= 0:
            raise Late(f"the section's {self.seconds:,.0f} s were used up")

    def share(self, weight, rest):
        """Seconds for a case of this weight; `rest` are the weights of all cases to come, its own among them."""
        return self.left() * weight / sum(rest)

    def limit_s(self, most_s):
        """Seconds after which a process is ended: `most_s`, or what is left."""
        return min(most_s, max(self.left(), min(LEAST_S, LEAST_SHARE * self.seconds)))

    def ended(self, most_s):
        """That, and the error of a process that is ended then: only the section's time makes it late."""
        limit_s = self.limit_s(most_s)
        return limit_s, Late if limit_s < most_s else Overdue


def of(section, quick, measured=SECONDS):
    """The time of a section among those that are measured."""
    together = lambda names: sum(SECONDS[name][0 if quick else 1] for name in names)
    share = together([section]) / max(together(measured), 1)
    return Budget(share * together(SECONDS))


def cases(budget, weights):
    """Each case with its seconds; a case without time left has the reason in their place."""
    rest = list(weights.values())
    for case, weight in weights.items():
        try:
            budget.needed()
            yield case, budget.share(weight, rest)
        except Late as late:
            yield case, late
        rest.pop(0)
