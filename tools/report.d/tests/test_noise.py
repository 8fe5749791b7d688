"""Medians, intervals, exponents and turns against values by hand."""

import random
import unittest

from report import noise
from report.turns import Late, Unmeasurable, rounds


class Intervals(unittest.TestCase):
    def test_an_interval_holds_its_median(self):
        found = noise.ratio_interval([1, 1, 1, 1, 1], [2, 3, 4, 5, 6])
        self.assertAlmostEqual(found.median, 4)
        self.assertTrue(2 <= found.low < 4 < found.high <= 6)

    def test_a_load_on_both_leaves_the_ratio(self):
        ours = [10, 40, 15, 90]
        found = noise.ratio_interval(ours, [3 * x for x in ours])
        for value in (found.median, found.low, found.high):
            self.assertAlmostEqual(value, 3)

    def test_equal_competitors_seldom_differ(self):
        draw = random.Random(7)
        times = lambda: [draw.lognormvariate(0, 0.2) for _ in range(7)]
        told = 0
        for _ in range(50):
            found = noise.ratio_interval(times(), times())
            told += not found.low <= 1 <= found.high
        # 95 % intervals of seven rounds; percentile intervals of so few are somewhat too narrow
        self.assertLess(told, 10)

    def test_unlike_competitors_differ(self):
        draw = random.Random(8)
        times = lambda scale: [scale * draw.lognormvariate(0, 0.05) for _ in range(5)]
        found = noise.ratio_interval(times(2.0), times(1.0))
        self.assertLess(found.high, 1)

    def test_exponents(self):
        points = [(x, 5 * x**0.75) for x in (1, 10, 1000)]
        self.assertAlmostEqual(noise.exponent(points), 0.75)
        self.assertIsNone(noise.exponent([(1, 2), (1.1, 3)]))

    def test_the_quickest_that_is_right_enough(self):
        settings = [(2.0, 10), (0.4, 50), (0.1, 30), (0.05, 90)]
        self.assertEqual(noise.quickest_within(settings, 0.5), 30)
        self.assertEqual(noise.quickest_within(settings, 2.0), 10)
        self.assertIsNone(noise.quickest_within(settings, 0.01))


class Turns(unittest.TestCase):
    def test_each_round_begins_with_another(self):
        order = []
        rounds({name: lambda name=name: order.append(name) for name in "abc"}, 0, least=3, most=3)
        self.assertEqual("".join(order), "abcbcacab")

    def test_time_ends_the_rounds_after_the_least(self):
        now = [0.0]

        def slow():
            now[0] += 10
            return now[0]

        count = lambda seconds: len(rounds({"a": slow}, seconds, clock=lambda: now[0])["a"])
        self.assertEqual([count(0), count(55), count(1000)], [3, 5, 9])

    def test_an_unmeasurable_competitor_has_a_reason_and_causes_no_delay(self):
        def fails():
            raise Unmeasurable("no display")

        found = rounds({"a": lambda: 1, "b": fails}, 0)
        self.assertEqual(found["a"], [1, 1, 1])
        self.assertEqual(str(found["b"]), "no display")

    def test_a_late_competitor_keeps_its_rounds_and_ends_them(self):
        turns = []

        def late():
            turns.append(len(turns))
            if len(turns) > 3:
                raise Late("used up")
            return turns[-1]

        # it begins round 4; the other has no turn in it
        found = rounds({"a": late, "b": lambda: 1, "c": lambda: 1}, 0, least=5, most=5)
        self.assertEqual(found, {"a": [0, 1, 2], "b": [1, 1, 1], "c": [1, 1, 1]})

    def test_a_competitor_that_is_late_at_once_has_the_reason_and_others_go_on(self):
        def late():
            raise Late("used up")

        found = rounds({"a": late, "b": lambda: 1}, 0)
        self.assertEqual((str(found["a"]), found["b"]), ("used up", [1, 1, 1]))


if __name__ == "__main__":
    unittest.main()
