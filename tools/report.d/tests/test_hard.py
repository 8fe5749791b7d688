"""Scenes of hard and random cases can be read, and are the same for the same number."""

import random
import re
import tomllib
import unittest

from report import hard
from report.sections import least


class Scenes(unittest.TestCase):
    def test_every_case_is_a_scene(self):
        self.assertEqual(len({case.name for case in hard.CASES}), len(hard.CASES))
        for case in hard.CASES:
            with self.subTest(case.name):
                scene = tomllib.loads(case.scene)
                self.assertTrue(scene.keys() & {"surface", "solid"})
                named = set(scene.get("curve", {}))
                for surface in scene.get("surface", {}).values():
                    for loop in surface.get("loops", []):
                        of = loop["curves"] if isinstance(loop, dict) else loop
                        self.assertLessEqual({of} if isinstance(of, str) else set(of), named)

    def test_random_cases_follow_from_their_number(self):
        for made in (lambda draw: hard.random_sheets(draw, 9)[0], lambda draw: hard.random_trees(draw, 9, (3, 9))[0]):
            texts = [made(random.Random(number)) for number in (1, 1, 2)]
            self.assertEqual(texts[0], texts[1])
            self.assertNotEqual(texts[0], texts[2])
            tomllib.loads(texts[0])

    def test_a_random_sheet_is_counted_with_its_loops(self):
        text, loops = hard.random_sheets(random.Random(3), 12)
        scene = tomllib.loads(text)
        self.assertEqual(len(scene["surface"]), 12)
        self.assertEqual(sum(len(one.get("loops", [])) for one in scene["surface"].values()), loops)


    def test_random_trees_share_no_leaf(self):
        text, leaves = hard.random_trees(random.Random(4), 6, (3, 8))
        made = tomllib.loads(text)["solid"]
        trees = [made.pop(f"tree{k}")["of"] for k in range(6)]
        named = [name for tree in trees for name in re.findall(r"A[0-9]+", tree)]
        self.assertEqual((sorted(named), len(named)), (sorted(made), leaves))


class Least(unittest.TestCase):
    def test_an_object_of_another_feature_is_reported(self):
        self.assertEqual(least.foreign("trim intercepts", []), ["trims"])
        self.assertEqual(least.foreign("trim intercepts", ["trims"]), [])
        self.assertEqual(least.foreign("patches", []), [])

    def test_an_omitted_feature_of_a_pipeline_is_not_foreign(self):
        self.assertEqual(least.foreign("border mix (no trims)", []), [])
        self.assertEqual(least.foreign("trim mix (no sun)", []), ["trims"])


if __name__ == "__main__":
    unittest.main()
