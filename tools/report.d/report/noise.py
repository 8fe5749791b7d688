"""Medians and their uncertainty: bootstrap intervals of paired ratios, exponents of growth.

Rounds are paired: in each, all competitors run one after another on the same machine, so that other work slows all of
them and mostly cancels in the ratio of a round. The rest is the noise; the spread of the rounds' ratios measures it.
Source: B. Efron, R. Tibshirani, An Introduction to the Bootstrap, 1993, chapter 13 (percentile intervals).
"""

import functools
import math
import random
import statistics
from dataclasses import dataclass

# fewer rounds give no estimate of their spread
FEWEST_ROUNDS = 3
RESAMPLES = 2000
# share of the resampled medians within the interval
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Interval:
    """A median, and the interval that holds it."""

    median: float
    low: float
    high: float


def median(values):
    return statistics.median(values)


def ratio_interval(ours, theirs):
    """Interval of the ratio theirs to ours; None for fewer than `FEWEST_ROUNDS`. Equal rounds give equal intervals."""
    return None if len(ours) < FEWEST_ROUNDS else resampled(tuple(ours), tuple(theirs))


@functools.cache
def resampled(ours, theirs):
    """The interval of tuples; the same rounds are resampled once."""
    logs = [math.log(b / a) for a, b in zip(ours, theirs, strict=True)]
    draw = random.Random(1)
    medians = sorted(median(draw.choices(logs, k=len(logs))) for _ in range(RESAMPLES))
    out = round((1 - CONFIDENCE) / 2 * RESAMPLES)
    return Interval(*(math.exp(x) for x in (median(logs), medians[out], medians[-1 - out])))


def exponent(points):
    """The power of x that y grows with, by least squares of the logarithms; None where x does not double."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    if len(logs) < 2 or max(x for x, _ in logs) - min(x for x, _ in logs) < math.log(2):
        return None
    return statistics.linear_regression(*zip(*logs)).slope


def quickest_within(settings, error):
    """Of `(error, time)` pairs, the least time of one whose error is at most `error`; None where there is none."""
    return min((time for off, time in settings if off <= error), default=None)
