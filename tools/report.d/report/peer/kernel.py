"""Errors of pictures against the surfaces and trims themselves: Open CASCADE's ray against each face, no mesh.

    job      model, seconds (for the rays of the truth, and for the searches of each picture),
             views: {name: {camera, pictures: {name: {path, own}}}}
    results  {view, boundary, sampled, alone, pictures: {name: {worst_px, p999_px, off, searched, beyond}}}, one a view

Sampled are the pixels at changes of face, found by halving the cells of a grid whose corners see different faces,
cell by cell in random order until the time is up. Where a picture shows another face than the ray at a pixel's
centre, the picture's face is looked for around it: the least distance at which a ray sees it is the error there.
`p999_px` is the error that one in a thousand of the boundary's pixels exceeds. Errors are distances of the list
below, rounded up; beyond the last one, a pixel counts as `beyond`, and as twice that distance.

Pictures that are `own` number faces in another way: each of the kernel's faces is the number that most rays through
the inside of the picture's faces find. A pixel at which the last picture and the last `own` one are both wrong is
left out, and counted as `alone`: where two independent pictures agree, the kernel's ray is at fault. Their order is
from coarse to fine.
"""

import math
import random
import time

import numpy
from OCP.gp import gp_Dir, gp_Lin, gp_Pnt
from OCP.IntCurvesFace import IntCurvesFace_Intersector
from OCP.TopAbs import TopAbs_IN, TopAbs_ON

from . import job, shapes, tell

DISTANCES = [1 / 16, 1 / 8, 1 / 4, 3 / 8, 1 / 2, 3 / 4, 1, 1.5, 2, 3, 4, 6, 8]
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


class Rays(View):
    """The camera's rays against faces, which stand in tiles of the picture."""

    def __init__(self, found, camera, tie):
        super().__init__(camera)
        self.tie, self.found, self.made = tie, found, {}
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
        faces = self.tiles.get((int(x) // TILE, int(y) // TILE), [])
        if not faces:
            return [-1]
        line = gp_Lin(gp_Pnt(*map(float, self.eye)), gp_Dir(*map(float, self.ray(x, y))))
        hits = []
        for number in faces:
            held = self.made.get(number)
            if held is None:
                held = self.made[number] = IntCurvesFace_Intersector(self.found[number], TOLERANCE)
            try:
                held.Perform(line, 0.0, FAR)
            except Exception:  # the kernel's own: a surface that it cannot intersect has no hit
                continue
            if held.IsDone():
                for k in range(1, held.NbPnt() + 1):
                    if held.State(k) in (TopAbs_IN, TopAbs_ON):
                        hits.append((held.WParameter(k), number))
        if not hits:
            return [-1]
        nearest = min(hits)[0]
        # the nearest first
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


def named(rays, image):
    """For a picture with numbers of its own, that of each of the kernel's faces; 0 is its background."""
    inner = numpy.ones(image.shape, bool)
    for shift in range(-INSIDE, INSIDE + 1):
        inner &= (numpy.roll(image, shift, 0) == image) & (numpy.roll(image, shift, 1) == image)
    votes, draw = {}, numpy.random.default_rng(1)
    for number in numpy.unique(image):
        if number == 0:
            continue
        pixels = numpy.argwhere((image == number) & inner)
        if not len(pixels):
            pixels = numpy.argwhere(image == number)
        for y, x in draw.permutation(pixels)[:NAMING]:
            of = votes.setdefault(rays.centre((x, y))[0], {})
            of[int(number)] = of.get(int(number), 0) + 1
    return {**{face: max(of, key=of.get) for face, of in votes.items()}, -1: 0}


def judged(rays, image, names, wrong, count, seconds):
    """Errors of a picture at the pixels where it is wrong."""
    name = lambda face: names.get(face) if names is not None else face
    order = list(wrong)
    random.Random(2).shuffle(order)
    end, found = time.monotonic() + seconds, []
    for pixel in order[:SEARCHES]:
        if time.monotonic() > end:
            break
        drawn = int(image[pixel[1], pixel[0]])
        found.append(shift(rays, pixel, lambda faces: any(name(face) == drawn for face in faces)))
    result = {"off": len(wrong), "searched": len(found), "beyond": sum(math.isinf(s) for s in found)}
    found = sorted(min(s, 2 * DISTANCES[-1]) for s in found)
    result["worst_px"] = found[-1] if found else 0.0
    # each searched pixel represents this many
    rank = int(0.001 * count * len(found) / len(wrong)) if wrong and found else 0
    result["p999_px"] = found[-1 - rank] if rank < len(found) else 0.0
    return result


def shift(rays, pixel, right):
    """The least of the distances at which a ray meets the right face; infinite beyond them."""
    for distance in DISTANCES:
        for k in range(DIRECTIONS):
            turn = 2 * math.pi * k / DIRECTIONS
            if right(rays.at(pixel[0] + 0.5 + distance * math.cos(turn), pixel[1] + 0.5 + distance * math.sin(turn))):
                return distance
    return math.inf


def view(found, diagonal, camera, pictures, seconds):
    """All pictures of one camera."""
    rays = Rays(found, camera, TIE * diagonal)
    truth, seen = boundary(rays, seconds)
    images, wrong, last = {}, {}, {}
    for name, picture in pictures.items():
        image = numpy.load(picture["path"]).astype(numpy.int64)
        names = named(rays, image) if picture["own"] else None
        last[picture["own"]] = name
        images[name] = (image, names)
        right = lambda face: face if names is None else names.get(face)
        wrong[name] = {p for p, faces in truth.items() if int(image[p[1], p[0]]) not in map(right, faces)}
    alone = set.intersection(*(wrong[name] for name in last.values())) if len(last) > 1 else set()
    count = len(truth) - len(alone)
    errors = {n: judged(rays, image, names, wrong[n] - alone, count, seconds) for n, (image, names) in images.items()}
    return {"boundary": count, "sampled": len(seen), "alone": len(alone), "pictures": errors}


def main():
    wanted = job()
    shape, _ = shapes.read(wanted["model"])
    found, diagonal = shapes.faces(shape), shapes.diagonal(shape)
    for name, one in wanted["views"].items():
        tell({"view": name, **view(found, diagonal, one["camera"], one["pictures"], wanted["seconds"])})


if __name__ == "__main__":
    main()
