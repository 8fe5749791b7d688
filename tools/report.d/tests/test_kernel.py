"""The judge by the kernel's rays, with made-up faces: no file is read. Skipped without the kernel's package."""

import math
import unittest

from report.sections import surfaces

try:
    import numpy
    from OCP.TopAbs import TopAbs_IN, TopAbs_ON

    from report.peer import kernel
except ImportError as missing:
    raise unittest.SkipTest(str(missing)) from None

CAMERA = {"eye": [0, 0, 9], "target": [0, 0, 0], "up": [0, 1, 0], "fovy": 40.0, "size": [20, 20]}


class Sheets(kernel.Rays):
    """Faces whose hits are given: by number, those with the tolerances of edges and those without."""

    def __init__(self, wide, exact):
        super().__init__([], CAMERA, 1e-6)
        self.given = {True: wide, False: exact}
        self.tiles = {(0, 0): list(wide)}

    def met(self, number, line, wide):
        return self.given[wide].get(number, [])


class Strips(kernel.View):
    """Faces side by side: (left end, face), in pixels."""

    def __init__(self, strips):
        super().__init__(CAMERA)
        self.strips = strips

    def at(self, x, y):
        return [[face for left, face in self.strips if left <= x][-1]]


class Edges(unittest.TestCase):
    def test_the_tolerance_of_an_edge_hides_no_face(self):
        rays = Sheets({4: [(3.0, TopAbs_ON)], 5: [(3.5, TopAbs_IN)]}, {5: [(3.5, TopAbs_IN)]})
        self.assertEqual((rays.centre((7, 8)), rays.widened), ([5], {(7.5, 8.5): 4}))

    def test_a_point_on_the_curve_itself_is_one_of_the_face(self):
        rays = Sheets({4: [(3.0, TopAbs_ON)], 5: [(3.5, TopAbs_IN)]}, {4: [(3.0, TopAbs_ON)]})
        self.assertEqual((rays.centre((7, 8)), rays.widened), ([4], {}))

    def test_a_face_keeps_its_other_hits(self):
        both = [(3.0, TopAbs_ON), (6.0, TopAbs_IN)]
        rays = Sheets({4: both, 5: [(7.0, TopAbs_IN)]}, {4: [(6.0, TopAbs_IN)]})
        # the same face in front by both readings: no difference that a picture of faces shows
        self.assertEqual((rays.centre((7, 8)), rays.widened), ([4], {}))

    def test_a_picture_shows_one_reading_or_neither(self):
        image = numpy.array([[50, 40, 60]])
        truth, widened = {(x, 0): [5] for x in range(3)}, {(x, 0): 4 for x in range(3)}
        self.assertEqual(kernel.readings(image, {4: 40, 5: 50, 6: 60}, truth, widened), [1, 1, 1])


class Hidden(unittest.TestCase):
    def test_a_face_that_another_just_hides_is_as_far_off_as_its_border(self):
        # face 1 covers the left of the picture, and hides face 2, which ends before it does
        class Covered(Strips):
            def depth(self, x, y):
                return 3.0 if x < 9.8 else math.inf

            def before(self, x, y, depth):
                return [face for face, at, end in ((1, 3.0, 9.8), (2, 3.1, 9.7)) if x < end and at < depth]

        rays = Covered([(0, 1), (9.8, -1)])
        image = numpy.full((20, 20), 10)
        image[:, 10:] = 0
        names = {1: 10, 2: 20, -1: 0}
        # the picture shows face 2 at a pixel of the background
        image[4, 10] = 20
        found = kernel.judged(rays, image, names, {(10, 4)}, 20, 60)
        self.assertEqual((found["beyond"], found["uncovered"], found["worst_px"]), (0, 1, 1.0))
        # and at one that face 1 hides where face 2 goes on behind it
        image[4, 9] = 20
        found = kernel.judged(rays, image, names, {(9, 4)}, 20, 60)
        self.assertEqual((found["beyond"], found["uncovered"], found["worst_px"]), (1, 0, 16.0))


class Distances(unittest.TestCase):
    def test_tolerances_are_among_them(self):
        judged = {*surfaces.TOLERANCES_QUICK, *surfaces.TOLERANCES, *surfaces.TOLERANCES_OTHER}
        self.assertLessEqual(judged, {*kernel.DISTANCES})

    def test_a_sliver_close_beside_a_centre_is_found(self):
        rays = Strips([(0, 1), (9.512, 2), (9.53, 1)])
        image = numpy.full((20, 20), 10)
        image[4, 9] = 20
        found = kernel.judged(rays, image, {1: 10, 2: 20}, {(9, 4)}, 20, 60)
        self.assertEqual((found["beyond"], found["worst_px"]), (0, 1 / 64))


class Names(unittest.TestCase):
    def test_a_face_between_two_centres_has_its_name(self):
        # a column of the picture shows a face whose true ends are just beside the pixels' centres
        rays = Strips([(0, 1), (9.52, 2), (9.7, 3)])
        image = numpy.full((20, 20), 10)
        image[:, 9], image[:, 10:] = 20, 30
        self.assertEqual(kernel.named(rays, [image]), {1: 10, 2: 20, 3: 30, -1: 0})

    def test_a_face_that_is_hidden_beside_its_pixel_has_its_name(self):
        # face 1 hides face 2, and a picture shows face 2 at a pixel between them
        class Covered(Strips):
            def before(self, x, y, depth):
                return [1, 2, 4] if 9.0 < x < 9.8 else [face for face in self.at(x, y) if face >= 0]

        rays = Covered([(0, 1), (10, 3)])
        image = numpy.full((20, 20), 10)
        image[4, 9], image[:, 10:] = 20, 30
        self.assertEqual(kernel.named(rays, [image]), {1: 10, 2: 20, 3: 30, -1: 0})

    def test_a_face_that_is_not_there_has_no_name(self):
        rays = Strips([(0, 1), (9.52, 3)])
        image = numpy.full((20, 20), 10)
        image[:, 9], image[:, 10:] = 20, 30
        names = kernel.named(rays, [image])
        self.assertEqual(names, {1: 10, 3: 30, -1: 0})
        found = kernel.judged(rays, image, names, {(9, 4)}, 20, 60)
        self.assertEqual((found["beyond"], found["worst_px"]), (1, 16.0))

    def test_a_small_face_takes_no_name_from_a_large_one(self):
        # the rays miss the small face, whose pixels vote for the large one
        rays = Strips([(0, 1)])
        image = numpy.full((20, 20), 90)
        image[3, 4:12] = 10
        self.assertEqual(kernel.named(rays, [image])[1], 90)

    def test_the_finest_picture_names(self):
        rays = Strips([(0, 1), (10, 2)])
        fine, coarse = numpy.full((20, 20), 10), numpy.full((20, 20), 20)
        # the coarse picture has the two the wrong way round
        fine[:, 10:], coarse[:, 10:] = 20, 10
        self.assertEqual(kernel.named(rays, [coarse, fine]), {1: 10, 2: 20, -1: 0})


if __name__ == "__main__":
    unittest.main()
