"""Errors of pictures against the surfaces and trims themselves: Open CASCADE's ray against each face, no mesh.

    job      model, seconds (for the rays of the truth, and for the searches of each picture),
             views: {name: {camera, pictures: {name: {path, own}}}}
    results  {view, boundary, sampled, alone, widened, edge_mm,
             pictures: {name: {worst_px, p999_px, off, searched, beyond, uncovered, distances_px, readings}}}, one a view

Sampled are the pixels at changes of face, found by halving the cells of a grid whose corners see different faces,
cell by cell in random order until the time is up. Where a picture shows another face than the ray at a pixel's
centre, the picture's face is looked for around it: the least distance at which a ray sees it is the error there.
`p999_px` is the error that one in a thousand of the boundary's pixels exceeds. Errors are distances of the list
below, rounded up; beyond the last one, a pixel counts as `beyond`, and as twice that distance. `distances_px` are those
of all pixels searched, ascending.

A face that another one just hides may be seen beside it where the border of one of the two is a little off. No ray sees
it then. Its error is the least distance at which a ray meets it, hidden or not, in front of what the ray at the pixel's
centre meets: so far one of the borders is off. Such pixels are counted as `uncovered`.

The kernel counts a point as one of a face if it is within the tolerance of an edge, too. That tolerance bounds the
distance between an edge's curves at the same parameter: curves in one place that run at other speeds make it wide.
Here the curves in (u, v) alone bound a face. `widened` counts the boundary's pixels where the tolerance of an edge, of
at most `edge_mm`, puts another face in front; `readings` of a picture are the pixels of these at which it shows the
face within the curves, the widened one, and neither. The errors are those by the curves, at these pixels as at others.

Pictures that are `own` number faces in another way, all in the same one: each of the kernel's faces is the number that
most rays through the inside of the pictures' faces find, in the finest picture that shows them; for a face that no ray
through a pixel's centre meets, the rays close beside it, which meet it first or right behind the first face. A pixel at
which the last picture and the last `own` one are both wrong is left out, and counted as `alone`: where two independent
pictures agree, the kernel's ray is at fault. Their order is from coarse to fine.
"""

import math
import random
import time

import numpy
from OCP.gp import gp_Dir, gp_Lin, gp_Pnt
from OCP.IntCurvesFace import IntCurvesFace_Intersector
from OCP.TopAbs import TopAbs_IN, TopAbs_ON

from . import job, shapes, tell

# the tolerances that are judged are among them
DISTANCES = [1 / 64, 1 / 32, 1 / 16, 0.1, 1 / 8, 1 / 4, 3 / 8, 1 / 2, 3 / 4, 1, 1.5, 2, 3, 4, 6, 8]
DIRECTIONS = 16
# cells of the grid that is halved, and tiles of faces, pixels
CELL, TILE = 16, 32
# of a picture, pixels that are searched around
SEARCHES = 200
# share of the diagonal: a ray does not separate faces that are nearer to each other
TIE = 1e-6
# the kernel's own tolerance, millimetres
TOLERANCE = 1e-7
# the end of a ray, millimetres
FAR = 1e9
# rays through the inside of each face of a picture, and how far inside, pixels
NAMING, INSIDE = 6, 2
# how far beside a pixel's centre the rays look for a face that none met, pixels: the smallest tolerances are within it
SLIVER = 1 / 4


def unit(v):
    return v / numpy.linalg.norm(v)


class View:
    """A camera. A subclass's `at` says what the ray through a point of the picture meets."""

    def __init__(self, camera):
        self.width, self.height = camera["size"]
        self.eye, target, up = (numpy.array(camera[name], float) for name in ("eye", "target", "up"))
        self.forward = unit(target - self.eye)
        self.right = unit(numpy.cross(self.forward, up))
        self.up = numpy.cross(self.right, self.forward)
        self.tan = math.tan(math.radians(camera["fovy"]) / 2)

    def ray(self, x, y):
        """The direction from the eye through a point of the picture."""
        ray = self.forward + self.right * ((2 * x / self.width - 1) * self.tan * self.width / self.height)
        return unit(ray + self.up * ((1 - 2 * y / self.height) * self.tan))

    def centre(self, pixel):
        return self.at(pixel[0] + 0.5, pixel[1] + 0.5)

    def depth(self, x, y):
        """Where the ray through a point meets the first face; infinite if it meets none. None: faces that others hide
        are not known."""
        return None

    def before(self, x, y, depth):
        """Numbers of the faces that the ray through a point meets in front of a depth, the nearest first, hidden ones
        among them."""
        return []


class Rays(View):
    """The camera's rays against faces, which stand in tiles of the picture."""

    def __init__(self, found, camera, tie):
        super().__init__(camera)
        self.tie, self.found, self.made = tie, found, {}
        # by point of the picture, the face that only the tolerance of an edge puts in front
        self.widened = {}
        self.tiles = {}
        for number, face in enumerate(found):
            for tile in self.covered(face):
                self.tiles.setdefault(tile, []).append(number)

    def covered(self, face):
        """Tiles that the projected box of a face meets."""
        corners = shapes.box(face)
        if corners is None:
            return
        points = numpy.array([[corners[k >> a & 1][a] for a in range(3)] for k in range(8)])
        apart = points - self.eye
        depth = apart @ self.forward
        across, upwards = apart @ self.right / (self.tan * self.width / self.height), apart @ self.up / self.tan
        if depth.max() <= 0 or any((side > depth).all() for side in (across, -across, upwards, -upwards)):
            return  # beyond one side of the view
        low, high = (0, 0), (self.width, self.height)
        if depth.min() > 0:
            x, y = (1 + across / depth) * self.width / 2, (1 - upwards / depth) * self.height / 2
            low, high = (x.min() - 1, y.min() - 1), (x.max() + 1, y.max() + 1)
        span = lambda k, most: range(max(int(low[k]), 0) // TILE, min(int(min(high[k], 1e9)), most) // TILE + 1)
        yield from ((i, j) for i in span(0, self.width) for j in span(1, self.height))

    def at(self, x, y):
        """Numbers of the faces that the ray through a point meets first: several where faces meet."""
        hits, wide = self.hits(x, y)
        first, front = self.first(hits), self.first(wide)
        if front[0] != first[0]:
            self.widened[x, y] = front[0]
        return first

    def depth(self, x, y):
        return min((depth for depth, _ in self.hits(x, y)[0]), default=math.inf)

    def before(self, x, y, depth):
        return [number for at, number in sorted(self.hits(x, y)[0]) if at < depth]

    def hits(self, x, y):
        """Depths and numbers of all faces that the ray through a point meets, by their curves, and within the
        tolerances of their edges."""
        faces = self.tiles.get((int(x) // TILE, int(y) // TILE), [])
        if not faces:
            return [], []
        line = gp_Lin(gp_Pnt(*map(float, self.eye)), gp_Dir(*map(float, self.ray(x, y))))
        wide = [(number, *hit) for number in faces for hit in self.met(number, line, True)]
        # on an edge, or only within its tolerance
        doubted = {number for number, _, state in wide if state == TopAbs_ON}
        hits = [(depth, number) for number, depth, _ in wide if number not in doubted]
        hits += [(depth, number) for number in doubted for depth, _ in self.met(number, line, False)]
        return hits, [(depth, number) for number, depth, _ in wide]

    def met(self, number, line, wide):
        """Depths and states at which a line meets a face, with the tolerances of its edges or without."""
        held = self.made.get((number, wide))
        if held is None:
            held = IntCurvesFace_Intersector(self.found[number], TOLERANCE, True, wide)
            self.made[number, wide] = held
        try:
            held.Perform(line, 0.0, FAR)
        except Exception:  # the kernel's own: a surface that it cannot intersect has no hit
            return []
        if not held.IsDone():
            return []
        points = [(held.WParameter(k), held.State(k)) for k in range(1, held.NbPnt() + 1)]
        return [(depth, state) for depth, state in points if state in (TopAbs_IN, TopAbs_ON)]

    def first(self, hits):
        """The numbers of the nearest faces, the nearest first."""
        if not hits:
            return [-1]
        nearest = min(hits)[0]
        return [number for depth, number in sorted(hits) if depth <= nearest + self.tie]


def boundary(rays, seconds):
    """Faces that rays meet, by pixel: rays through pixels at changes of face, and through all requested pixels."""
    seen, changes = {}, set()

    def face(x, y):
        pixel = min(x, rays.width - 1), min(y, rays.height - 1)
        if pixel not in seen:
            seen[pixel] = rays.centre(pixel)
        return seen[pixel][0]

    cells = [(x, y) for y in range(0, rays.height, CELL) for x in range(0, rays.width, CELL)]
    random.Random(1).shuffle(cells)
    end = time.monotonic() + seconds
    for cell in cells:
        if time.monotonic() > end:
            break
        parts = [(*cell, CELL)]
        while parts:
            x, y, side = parts.pop()
            corners = [(x, y), (x + side, y), (x, y + side), (x + side, y + side)]
            if len({face(*corner) for corner in corners}) == 1:
                continue
            if side == 1:
                changes.update(corner for corner in corners if corner in seen)
            else:
                half = side // 2
                parts += [(x, y, half), (x + half, y, half), (x, y + half, half), (x + half, y + half, half)]
    return {pixel: seen[pixel] for pixel in changes}, seen


def named(rays, images):
    """For pictures with numbers of their own, from coarse to fine, that of each of the kernel's faces; 0 is their
    background."""
    votes, draw, sizes, sampled = {}, numpy.random.default_rng(1), {}, {}
    for image in reversed(images):
        inner = numpy.ones(image.shape, bool)
        for shift in range(-INSIDE, INSIDE + 1):
            inner &= (numpy.roll(image, shift, 0) == image) & (numpy.roll(image, shift, 1) == image)
        for number in map(int, numpy.unique(image)):
            if number == 0 or number in sampled:
                continue
            pixels = numpy.argwhere((image == number) & inner)
            if not len(pixels):
                pixels = numpy.argwhere(image == number)
            sizes[number] = len(pixels)
            sampled[number] = [(int(x), int(y)) for y, x in draw.permutation(pixels)[:NAMING]]
    for number, pixels in sampled.items():
        for pixel in pixels:
            of = votes.setdefault(rays.centre(pixel)[0], {})
            of[number] = of.get(number, 0) + 1
    # of as many votes, the larger face's: the pixels of a small one may all be at its boundary
    names = {face: max(of, key=lambda number: (of[number], sizes[number])) for face, of in votes.items()}
    names[-1] = 0
    # a face narrower than a pixel: the rays through its pixels' centres may meet another one
    for number in sorted(set(sampled) - set(names.values())):
        found = (unnamed(rays, pixel, names) for pixel in sampled[number])
        beside = next((face for face in found if face is not None), None)
        if beside is not None:
            names[beside] = number
    return names


def unnamed(rays, pixel, names):
    """The nearest face beside a pixel's centre that has no name: one that a ray meets first, else one that the first
    hides; None if there is none."""
    behind = lambda x, y: rays.before(x, y, math.inf)[1:2]
    beside = (face for look in (rays.at, behind) for _, faces in around(look, pixel, SLIVER) for face in faces[:1])
    return next((face for face in beside if face not in names), None)


def judged(rays, image, names, wrong, count, seconds):
    """Errors of a picture at the pixels where it is wrong."""
    name = lambda face: names.get(face) if names is not None else face
    order = list(wrong)
    random.Random(2).shuffle(order)
    end, found, uncovered = time.monotonic() + seconds, [], 0
    for pixel in order[:SEARCHES]:
        if time.monotonic() > end:
            break
        drawn = int(image[pixel[1], pixel[0]])
        right = lambda faces: any(name(face) == drawn for face in faces)
        distance = shift(rays, pixel, right)
        if math.isinf(distance):
            distance = hidden_shift(rays, pixel, right)
            uncovered += not math.isinf(distance)
        found.append(distance)
    result = {"off": len(wrong), "searched": len(found), "beyond": sum(math.isinf(s) for s in found)}
    result["uncovered"] = uncovered
    found = sorted(min(s, 2 * DISTANCES[-1]) for s in found)
    result["distances_px"] = found
    result["worst_px"] = found[-1] if found else 0.0
    # each searched pixel represents this many
    rank = int(0.001 * count * len(found) / len(wrong)) if wrong and found else 0
    result["p999_px"] = found[-1 - rank] if rank < len(found) else 0.0
    return result


def around(seen, pixel, most):
    """Distances up to the most, and the faces that are seen at points there."""
    for distance in (d for d in DISTANCES if d <= most):
        for k in range(DIRECTIONS):
            turn = 2 * math.pi * k / DIRECTIONS
            x, y = pixel[0] + 0.5 + distance * math.cos(turn), pixel[1] + 0.5 + distance * math.sin(turn)
            yield distance, seen(x, y)


def least(seen, pixel, right):
    """The least of the distances at which the right face is seen; infinite beyond them."""
    return next((distance for distance, faces in around(seen, pixel, DISTANCES[-1]) if right(faces)), math.inf)


def shift(rays, pixel, right):
    """The least of the distances at which a ray meets the right face first."""
    return least(rays.at, pixel, right)


def hidden_shift(rays, pixel, right):
    """The least of the distances at which a ray meets it at all, in front of what is seen at the pixel's centre."""
    depth = rays.depth(pixel[0] + 0.5, pixel[1] + 0.5)
    return math.inf if depth is None else least(lambda x, y: rays.before(x, y, depth), pixel, right)


def readings(image, names, truth, widened):
    """Pixels at which a picture shows the face within the curves, the one that is widened, and neither."""
    name = lambda face: face if names is None else names.get(face)
    counts = [0, 0, 0]
    for pixel, front in widened.items():
        drawn = int(image[pixel[1], pixel[0]])
        counts[0 if drawn in map(name, truth[pixel]) else 1 if drawn == name(front) else 2] += 1
    return counts


def view(found, diagonal, camera, pictures, seconds):
    """All pictures of one camera."""
    rays = Rays(found, camera, TIE * diagonal)
    truth, seen = boundary(rays, seconds)
    images = {name: numpy.load(picture["path"]).astype(numpy.int64) for name, picture in pictures.items()}
    own = named(rays, [images[name] for name, picture in pictures.items() if picture["own"]])
    names_of = {name: own if picture["own"] else None for name, picture in pictures.items()}
    wrong, last = {}, {}
    for name, image in images.items():
        names = names_of[name]
        last[pictures[name]["own"]] = name
        right = lambda face: face if names is None else names.get(face)
        wrong[name] = {p for p, faces in truth.items() if int(image[p[1], p[0]]) not in map(right, faces)}
    alone = set.intersection(*(wrong[name] for name in last.values())) if len(last) > 1 else set()
    count = len(truth) - len(alone)
    centres = {(x, y): (x + 0.5, y + 0.5) for x, y in truth}
    widened = {pixel: rays.widened[at] for pixel, at in centres.items() if at in rays.widened}
    edge_mm = max((shapes.edge_mm(found[number]) for number in set(widened.values())), default=0.0)
    errors = {}
    for name, image in images.items():
        errors[name] = judged(rays, image, names_of[name], wrong[name] - alone, count, seconds)
        errors[name]["readings"] = readings(image, names_of[name], truth, widened)
    head = {"boundary": count, "sampled": len(seen), "alone": len(alone), "widened": len(widened), "edge_mm": edge_mm}
    return {**head, "pictures": errors}


def main():
    wanted = job()
    shape, _ = shapes.read(wanted["model"])
    found, diagonal = shapes.faces(shape), shapes.diagonal(shape)
    for name, one in wanted["views"].items():
        tell({"view": name, **view(found, diagonal, one["camera"], one["pictures"], wanted["seconds"])})


if __name__ == "__main__":
    main()
