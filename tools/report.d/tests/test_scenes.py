"""One description, four forms."""

import json
import unittest

from report import scenes


class Expressions(unittest.TestCase):
    def test_products_bind_tighter_and_chains_run_from_the_left(self):
        self.assertEqual(scenes.parsed("A*B-C-D"), ["-", ["-", ["*", "A", "B"], "C"], "D"])
        self.assertEqual(scenes.parsed("A-(B+C1)"), ["-", "A", ["+", "B", "C1"]])

    def test_chains_are_flat(self):
        self.assertEqual(scenes.flat(scenes.parsed("A-B-C")), ["A", "B", "C"])
        self.assertEqual(scenes.flat(scenes.parsed("A*B-C")), [["*", "A", "B"], "C"])
        self.assertEqual(scenes.flat(scenes.parsed("A-(B-C)")), ["A", ["-", "B", "C"]])

    def test_long_chains_are_written_as_one_list(self):
        found = scenes.chained(scenes.parsed("A*B-C-(D+E+F)"))
        self.assertEqual(found, ["-", ["*", "A", "B"], "C", ["+", "D", "E", "F"]])
        long = scenes.Scene("long", {}, "-".join(["A"] * 5000))
        self.assertEqual(len(json.loads(json.dumps(long.data()))["tree"]), 5001)

    def test_members_of_chains(self):
        try:
            from report.peer import csg
        except ImportError as missing:
            self.skipTest(str(missing))
        members = [csg.member(scenes.chained(scenes.parsed(text)), {"A", "C"}) for text in ("A-B-C", "A-B-D", "B+D+C")]
        self.assertEqual(members, [False, True, True])
        self.assertEqual([csg.member(["*", "A", *more], {"A", "C"}) for more in ("C", "CB")], [True, False])

    def test_a_text_that_is_no_expression_is_refused(self):
        self.assertRaises(ValueError, scenes.parsed, "A^B")


class Forms(unittest.TestCase):
    def test_numbers_of_primitives_are_the_papers(self):
        self.assertEqual(
            [len(scenes.of_name(name).primitives) for name in ("widget", "complex", "gear", "plate100")],
            [4, 20, 48, 101],
        )

    def test_every_primitive_stands_in_every_form(self):
        scene = scenes.of_name("complex")
        camera = {"eye": [0, -9, 3], "target": [0, 0, 0], "up": [0, 0, 1], "fovy": 35, "size": [4, 3]}
        self.assertEqual(scenes.toml(scene).count("[solid."), 21)
        for text, round_ones in (
            (scenes.scad(scene, 64), ("cylinder(", "sphere(")),
            (scenes.pov(scene, camera), ("cylinder {", "sphere {")),
        ):
            self.assertEqual([text.count(word) for word in round_ones], [18, 2])
            self.assertEqual(text.count("{"), text.count("}"))


if __name__ == "__main__":
    unittest.main()
