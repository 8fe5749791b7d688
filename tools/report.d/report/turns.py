"""Rounds of all competitors in turn.

    round 1   A B C      round 2   B C A      round 3   C A B      ...

Each round begins with another competitor, so that the order varies. Rounds go on until their time is used up,
but there are `least` of them, for without them the noise is unknown, unless nothing is `left` of the section's time. A
competitor that is late after the first round ends them: the rounds of all stand, some with one more than others.
"""

import time

from .noise import FEWEST_ROUNDS


def rounds(competitors, seconds, least=FEWEST_ROUNDS, most=9, clock=time.monotonic, left=None):
    """Runs `competitors`, a dictionary of functions that return a measurement; for each a list, one entry a round.

    A competitor that raises `Unmeasurable` is left out from then on: its list is what it raised. One that is `Late`
    keeps the rounds that it has.
    """
    results = {name: [] for name in competitors}
    start, longest = clock(), 0.0
    for number in range(most):
        begun = clock()
        if number >= least and begun - start + longest > seconds:
            break
        if number and left and left() <= 0:
            break
        names = list(competitors)
        turn = number % len(names)
        for name in names[turn:] + names[:turn]:
            if isinstance(results[name], Unmeasurable):
                continue
            try:
                results[name].append(competitors[name]())
            except Unmeasurable as error:
                if isinstance(error, Late) and results[name]:
                    return results
                results[name] = error
        longest = max(longest, clock() - begun)
    return results


class Unmeasurable(Exception):
    """The reason why something could not be measured, for its row."""


class Late(Unmeasurable):
    """The section's time was used up, or a process was ended because of that."""


class Overdue(Unmeasurable):
    """A process was ended at its own limit, though the section had time left."""
