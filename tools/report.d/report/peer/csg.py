"""How wrong pictures of a Boolean solid are: rays through the primitives' own equations, in double precision, by
separate code.

    job      scene: {primitives, tree} (scenes.py), camera, seconds,
             pictures: {name: path of a PNG, or of an image of faces as .npy}
    results  {boundary, sampled, pictures: {name: {worst_px, p999_px, off, searched, beyond, distances_px}}}

Only the outline is judged: whether a pixel shows the solid. A PNG shows the background where it has the colour of
its upper left corner; in an image of faces that is 0.
"""

import math

import numpy
from PIL import Image

from . import job, tell
from .kernel import View, boundary, judged

# a pixel whose colour differs from the corner's by no more steps of 255 is background: pictures are not dithered
ALIKE = 2


class Rays(View):
    """The camera's rays against a tree of primitives: 0 where they meet the solid, -1 where they do not."""

    def __init__(self, scene, camera):
        super().__init__(camera)
        self.tree, self.parts = scene["tree"], scene["primitives"]
        self.names = list(self.parts)
        centres, self.radii = zip(*(sphere(part) for part in self.parts.values()))
        self.centres, self.radii = numpy.array(centres) - self.eye, numpy.array(self.radii)

    def at(self, x, y):
        ray = self.ray(x, y)
        near = numpy.linalg.norm(self.centres - numpy.outer(self.centres @ ray, ray), axis=1) <= self.radii
        met = (self.names[k] for k in numpy.flatnonzero(near))
        within = {name: spans(self.parts[name], self.eye, ray) for name in met}
        ends = sorted({t for of in within.values() for span in of for t in span if t > 0})
        for low, high in zip(ends, ends[1:]):
            middle = (low + high) / 2
            inside = {name for name, of in within.items() if any(a < middle < b for a, b in of)}
            if member(self.tree, inside):
                return [0]
        return [-1]


def member(tree, inside):
    if isinstance(tree, str):
        return tree in inside
    operator, first, *others = tree
    if operator == "*":
        return all(member(one, inside) for one in tree[1:])
    found = any(member(one, inside) for one in others)
    return member(first, inside) and not found if operator == "-" else member(first, inside) or found


def sphere(part):
    """Centre and radius of a sphere around a primitive, a millionth larger than the least one."""
    middle, shape = [0.0, 0.0, 0.0], part["shape"]
    if shape == "sphere":
        radius = part["radius"]
    elif shape == "cylinder":
        middle, radius = [0.0, 0.0, part["height"] / 2], math.hypot(part["radius"], part["height"] / 2)
    elif shape == "torus":
        radius = part["major"] + part["minor"]
    else:
        middle = [0.0 if part["centred"] else s / 2 for s in part["size"]]
        radius = math.hypot(*part["size"]) / 2
    cos, sin = math.cos(math.radians(part["turn"])), math.sin(math.radians(part["turn"]))
    x, y, z = middle
    return numpy.array(part["at"], float) + [x, cos * y - sin * z, sin * y + cos * z], radius * (1 + 1e-6)


def spans(part, eye, ray):
    """Parts of a ray within a primitive: pairs of distances."""
    cos, sin = math.cos(math.radians(part["turn"])), math.sin(math.radians(part["turn"]))
    turned = lambda v: (v[0], cos * v[1] + sin * v[2], -sin * v[1] + cos * v[2])
    o, d = turned(eye - numpy.array(part["at"], float)), turned(ray)
    if part["shape"] == "sphere":
        return quadratic(
            sum(x * x for x in d), sum(a * b for a, b in zip(o, d)), sum(x * x for x in o) - part["radius"] ** 2
        )
    if part["shape"] == "cylinder":
        round_ = quadratic(
            d[0] ** 2 + d[1] ** 2, o[0] * d[0] + o[1] * d[1], o[0] ** 2 + o[1] ** 2 - part["radius"] ** 2
        )
        return clipped(round_, slab(o[2], d[2], 0, part["height"]))
    if part["shape"] == "torus":
        return torus(o, d, part["major"], part["minor"])
    low = [-s / 2 if part["centred"] else 0 for s in part["size"]]
    found = [(-math.inf, math.inf)]
    for k in range(3):
        found = clipped(found, slab(o[k], d[k], low[k], low[k] + part["size"][k]))
    return found


def quadratic(a, b, c):
    """Where a t^2 + 2 b t + c < 0."""
    root = b * b - a * c
    if a == 0 or root <= 0:
        return [(-math.inf, math.inf)] if a == 0 and c < 0 else []
    root = math.sqrt(root)
    return [((-b - root) / a, (-b + root) / a)]


def slab(o, d, low, high):
    """Where low < o + t d < high; a reversed pair is empty."""
    if d == 0:
        return (-math.inf, math.inf) if low < o < high else (1, -1)
    a, b = (low - o) / d, (high - o) / d
    return (min(a, b), max(a, b))


def clipped(found, by):
    both = ((max(a, by[0]), min(b, by[1])) for a, b in found)
    return [(a, b) for a, b in both if a < b]


def torus(o, d, major, minor):
    """Between the real roots of (|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2), p = o + t d with |d| = 1."""
    middle = -sum(a * b for a, b in zip(o, d))
    o = [a + middle * b for a, b in zip(o, d)]
    if sum(x * x for x in o) > (major + minor) ** 2:
        return []
    k = sum(x * x for x in o) + major**2 - minor**2
    flat = [d[0] ** 2 + d[1] ** 2, 2 * (o[0] * d[0] + o[1] * d[1]), o[0] ** 2 + o[1] ** 2]
    # of t^4, t^3, ...: o is at right angles to d, because t runs from the point nearest to the middle
    roots = numpy.roots([1, 0, 2 * k - 4 * major**2 * flat[0], -4 * major**2 * flat[1], k * k - 4 * major**2 * flat[2]])
    real = sorted(float(r.real) + middle for r in roots if abs(r.imag) < 1e-9 * max(1.0, abs(r)))
    return list(zip(real[::2], real[1::2]))


def covered(path):
    """0 where a picture shows the solid, -1 where it does not."""
    if path.endswith(".npy"):
        return numpy.where(numpy.load(path) == 0, -1, 0)
    pixels = numpy.asarray(Image.open(path).convert("RGB")).astype(int)
    return numpy.where(abs(pixels - pixels[0, 0]).max(-1) <= ALIKE, -1, 0)


def main():
    wanted = job()
    rays = Rays(wanted["scene"], wanted["camera"])
    truth, seen = boundary(rays, wanted["seconds"])
    errors = {}
    for name, path in wanted["pictures"].items():
        image = covered(path)
        if image.shape != (rays.height, rays.width):
            raise SystemExit(f"{name}: a picture of {image.shape[1]} x {image.shape[0]} pixels")
        wrong = {p for p, faces in truth.items() if int(image[p[1], p[0]]) not in faces}
        errors[name] = judged(rays, image, None, wrong, len(truth), wanted["seconds"])
    tell({"boundary": len(truth), "sampled": len(seen), "pictures": errors})


if __name__ == "__main__":
    main()
