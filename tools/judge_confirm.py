#!/usr/bin/env python3
"""Checks the pixels that the independent kernel contradicts in a second way: tools/judge_all calls this.

    ORACLE=oracle judge_confirm.py MODEL FOLDER LIMIT      FOLDER: camera.json, face.npy; writes confirmed.json

The kernel finds where a ray meets a face from a coarse polyhedron, and misses points near borders and silhouettes.
Its surfaces and trims by themselves are exact: for every judged pixel that is off by more than 1/16 pixel, Newton's
method looks for the points of rays on the kernel's surface of the face that was drawn there. Counted are pixels

    there   such a point is on a ray within 1/16 pixel, inside the kernel's own trims or on them, and in front of the
            kernel's own point: the picture is right
    edge    the kernel's own point lies on an edge, within the kernel's width of edges, and not inside the face
    left    neither
    over    those of the last two that are off by more than half a pixel
"""
import json, math, os, pathlib, sys
import numpy as np

sys.path.insert(0, os.environ['ORACLE'])
import judge_iges
import oracle as K
from OCP.BRep import BRep_Tool
from OCP.BRepClass import BRepClass_FaceClassifier
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_IN, TopAbs_ON
from OCP.gp import gp_Pnt, gp_Pnt2d, gp_Vec

RADII = [1 / 16, 1 / 8, 1 / 4, 3 / 8, 1 / 2, 3 / 4, 1, 1.5, 2]
SEEDS = 24


class Surface:
    """A face's surface, sampled for Newton's method."""

    def __init__(self, face):
        self.face, self.surface = face, BRep_Tool.Surface_s(face)
        u0, u1, v0, v1 = self.box = BRepTools.UVBounds_s(face)
        self.us, self.vs = np.linspace(u0, u1, 300), np.linspace(v0, v1, 60)
        value = lambda u, v: (lambda p: (p.X(), p.Y(), p.Z()))(self.surface.Value(u, v))
        self.points = np.array([[value(u, v) for v in self.vs] for u in self.us])

    def jet(self, u, v):
        point, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        self.surface.D1(u, v, point, du, dv)
        return (np.array([q.X(), q.Y(), q.Z()]) for q in (point, du, dv))

    def hits(self, origin, ray, pixel):
        """Distances along the ray of points inside the trims or on them; `pixel`: size of one at distance 1."""
        arm = self.points - origin
        along = arm @ ray
        off = np.linalg.norm(arm - along[..., None] * ray, axis=-1)
        e = np.cross(ray, np.eye(3)[np.argmin(np.abs(ray))])
        e /= np.linalg.norm(e)
        across = np.array([e, np.cross(ray, e)])
        found = []
        for k in np.argsort(off.ravel())[:SEEDS]:
            i, j = divmod(int(k), len(self.vs))
            t, uv = self.polish(self.us[i], self.vs[j], origin, ray, across)
            if t is not None and t[1] <= 1e-3 * pixel * t[0]:
                state = BRepClass_FaceClassifier(self.face, gp_Pnt2d(*uv), 1e-7).State()
                if state in (TopAbs_IN, TopAbs_ON):
                    found.append(t[0])
        return found

    def polish(self, u, v, origin, ray, across):
        u0, u1, v0, v1 = self.box
        damping = 1e-6
        point, du, dv = self.jet(u, v)
        r = across @ (point - origin)
        for _ in range(60):
            jacobian = np.stack([across @ du, across @ dv], 1)
            normal = jacobian.T @ jacobian
            step = np.linalg.lstsq(normal + damping * np.diag(np.diag(normal) + 1e-18), -jacobian.T @ r, rcond=None)[0]
            to = min(max(u + step[0], u0), u1), min(max(v + step[1], v0), v1)
            next_point, next_du, next_dv = self.jet(*to)
            next_r = across @ (next_point - origin)
            if next_r @ next_r < r @ r:
                (u, v), point, du, dv, r, damping = to, next_point, next_du, next_dv, next_r, max(damping / 5, 1e-15)
            else:
                damping *= 5
                if damping > 1e3:
                    break
        return (float((point - origin) @ ray), float(np.linalg.norm(r))), (u, v)


def main():
    model, folder, limit = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])
    K.quiet()
    judge_iges.install()
    _, faces, _ = K.load(model)
    camera, drawn = json.loads((folder / 'camera.json').read_text()), np.load(folder / 'face.npy')
    height, width = drawn.shape
    camera['size'] = [width, height]
    camera.setdefault('fovy', 35)
    cam = K.Cam(camera)
    oracle = K.Oracle(faces, cam)
    number = [s for _, s in faces]
    boxes = [b for b in (K.fbox(f) for f, _ in faces) if b]
    tie = 1e-4 * float(np.linalg.norm(np.max([b[1] for b in boxes], 0) - np.min([b[0] for b in boxes], 0)))
    pixels = K.pixels('boundary:32', width, height, oracle)
    if len(pixels) > limit:
        # as judge.py chooses
        pixels = pixels[np.random.default_rng(1).choice(len(pixels), limit, replace=False)]
    first = lambda hits: number[hits[0][1]] if hits else 0
    surfaces, size = {}, 2 * cam.th / height

    def own_depths(own, origin, ray):
        for i in (i for i, n in enumerate(number) if n == own and own):
            if i not in surfaces:
                surfaces[i] = Surface(faces[i][0])
            yield from surfaces[i].hits(origin, ray, size)

    result = dict(there=0, edge=0, left=0, over=0, examples=[])
    for x, y in pixels:
        at, own = (x + .5, y + .5), int(drawn[y, x])
        hits = oracle.shoot(*at, True)
        if first(hits) == own or (hits and any(number[h[1]] == own and abs(h[0] - hits[0][0]) < tie for h in hits)):
            continue
        turn = lambda q, a: (at[0] + q * math.cos(a), at[1] + q * math.sin(a))
        ring = lambda q, n=8: (turn(q, math.tau * k / n) for k in range(n))
        if any(first(oracle.shoot(*p, True)) == own for p in ring(1 / 16)):
            continue
        seen = hits[0][0] if hits else math.inf
        if any(t < seen + tie for p in (at, *ring(1 / 16)) for t in own_depths(own, *cam.ray(*p))):
            kind = 'there'
        else:
            kind = 'edge' if hits and hits[0][4] == 2 else 'left'
            shift = next((q for q in RADII if any(first(oracle.shoot(*p, True)) == own for p in ring(q, 24))), None)
            result['over'] += shift is None or shift > .5
            result['examples'].append([int(x), int(y), first(hits), own, shift, kind])
        result[kind] += 1
    result['examples'] = result['examples'][:40]
    (folder / 'confirmed.json').write_text(json.dumps(result))
    print(json.dumps(result))


if __name__ == '__main__':
    main()
