#!/usr/bin/env python3
"""Open CASCADE's facts of a STEP or IGES file: tools/census calls this, with a Python that has cadquery-ocp and numpy.

    census_kernel.py MODEL                             its facts
    census_kernel.py MODEL CAMERA.json DEPTH.npy ...   and whether its rays agree with the picture, for each picture

Prints a JSON object a line, each as soon as it is known, so that a limit costs only the later ones:

    counts      faces (distinct), placed (faces), solids (placed), facets (faces that are triangles only)
    area        of the placed faces, mm², by two quadratures: fixed, and adaptive, which fail on different faces
    box         of the placed faces, mm: [[x, y, z], [x, y, z]]
    colours     {"r,g,b": area}, by the adaptive quadrature; "none" where a face has no colour; sRGB, 0 to 255
    picture     rays sampled, and by kind those that, like all rays near them, differ from the 3 x 3 pixels around them:
                missing (nothing drawn), extra (nothing there), behind (drawn farther off), before (drawn nearer)
"""
import json, pathlib, sys, time
import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.IntCurvesFace import IntCurvesFace_ShapeIntersector
from OCP.Message import Message, Message_Gravity
from OCP.Quantity import Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Compound
from OCP.BRep import BRep_Builder
from OCP.XCAFDoc import XCAFDoc_DocumentTool
from OCP.XCAFPrs import XCAFPrs
from OCP.collections import IndexedDataMap_TopoDS_Shape_XCAFPrs_Style_TopTools_ShapeMapHasher as Styles
from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as Shapes
from OCP.collections import Sequence_TDF_Label as Labels
from OCP.gp import gp_Dir, gp_Lin, gp_Pnt

# error that the quadrature of a face aims at, as a share of its area
QUADRATURE = 1e-6
# pixels between rays
STEP = 4
# share of the box's diagonal: depths that differ by more belong to different places
DEPTH = 1e-3
# distance in pixels from a ray that differs to the rays that may excuse it
NEAR = [(-.4, -.3), (.4, -.3), (-.1, .2), (.1, .2), (0, 1), (1, 0), (0, -1), (-1, 0)]
# seconds for the rays of a picture
PATIENCE = 15.0


def tell(what, value):
    print(json.dumps({what: value}), flush=True)


def read(path):
    """The document's free shapes: labels and shapes."""
    iges = path.lower().endswith(('.igs', '.iges'))
    reader = IGESCAFControl_Reader() if iges else STEPCAFControl_Reader()
    reader.SetColorMode(True)
    if int(reader.ReadFile(path)) != 1:
        raise SystemExit('the kernel cannot read the file')
    document = TDocStd_Document(TCollection_ExtendedString('XDE'))
    reader.Transfer(document)
    tool, labels = XCAFDoc_DocumentTool.ShapeTool_s(document.Main()), Labels()
    tool.GetFreeShapes(labels)
    labels = [labels.Value(i + 1) for i in range(labels.Length())]
    return document, [(label, tool.GetShape_s(label)) for label in labels]


def each(shape, kind):
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def has_surface(face):
    return BRep_Tool.Surface_s(TopoDS.Face(face)) is not None


def colours(free, areas):
    """Area of each colour: a face has its own, else that of the innermost shape around it that has one."""
    found = {}
    for label, shape in free:
        styles, of = Styles(), {}
        XCAFPrs.CollectStyleSettings_s(label, TopLoc_Location(), styles)
        styled = [(styles.FindKey(i), styles.FindFromIndex(i)) for i in range(1, styles.Size() + 1)]
        styled = [(list(each(key, TopAbs_FACE)), key.ShapeType(), style) for key, style in styled if style.IsSetColorSurf()]
        # outer shapes first, so that inner ones overwrite them
        for inside, _, style in sorted(styled, key=lambda s: (-len(s[0]), int(s[1]))):
            for face in inside:
                of[areas.number(face)] = style.GetColorSurf()
        for face in each(shape, TopAbs_FACE):
            if has_surface(face):
                colour = of.get(areas.number(face))
                name = 'none' if colour is None else ','.join(
                    str(round(255 * x)) for x in colour.Values(Quantity_TOC_sRGB))
                found[name] = found.get(name, 0.0) + float(areas.of(face)[1])
    return found


class Areas:
    """Areas of faces; each distinct one is measured once. Placements do not scale in either format."""

    def __init__(self):
        self.placed, self.distinct, self.area = Shapes(), Shapes(), {}

    def number(self, face):
        """Faces are the same if surface and place are."""
        return self.placed.Add(face)

    def of(self, face):
        own = face.Located(TopLoc_Location())
        n = self.distinct.Add(own)
        if n not in self.area:
            fixed, adaptive = GProp_GProps(), GProp_GProps()
            BRepGProp.SurfaceProperties_s(own, fixed)
            BRepGProp.SurfaceProperties_s(own, adaptive, QUADRATURE)
            self.area[n] = np.abs([fixed.Mass(), adaptive.Mass()])
        return self.area[n]


def box(faces):
    bounds = Bnd_Box()
    for face in faces:
        BRepBndLib.AddOptimal_s(face, bounds, False, False)
    if bounds.IsVoid():
        return None
    bounds.SetGap(0.0)
    return [[f() for f in (bounds.CornerMin().X, bounds.CornerMin().Y, bounds.CornerMin().Z)],
            [f() for f in (bounds.CornerMax().X, bounds.CornerMax().Y, bounds.CornerMax().Z)]]


class Rays:
    """The camera's rays against the surfaces and trims of a shape."""

    def __init__(self, shape, camera, height, width):
        self.size = width, height
        self.eye, target, up = (np.array(camera[n], float) for n in ('eye', 'target', 'up'))
        unit = lambda v: v / np.linalg.norm(v)
        self.forward = unit(target - self.eye)
        self.right = unit(np.cross(self.forward, up))
        self.up = np.cross(self.right, self.forward)
        self.tan = np.tan(np.radians(camera['fovy']) / 2)
        self.shapes = IntCurvesFace_ShapeIntersector()
        self.shapes.Load(shape, 1e-7)

    def depth(self, x, y):
        """Depth of the nearest point along the view axis; infinite if there is none."""
        width, height = self.size
        ray = (self.forward + self.right * ((2 * x / width - 1) * self.tan * width / height)
               + self.up * ((1 - 2 * y / height) * self.tan))
        ray /= np.linalg.norm(ray)
        self.shapes.Perform(gp_Lin(gp_Pnt(*map(float, self.eye)), gp_Dir(*map(float, ray))), 0.0, 1e12)
        n = self.shapes.NbPnt() if self.shapes.IsDone() else 0
        return min((self.shapes.WParameter(i + 1) for i in range(n)), default=np.inf) * float(ray @ self.forward)


def picture(shape, camera, depth, diagonal):
    """Rays in random order, until time is up."""
    height, width = depth.shape
    rays, slack = Rays(shape, camera, height, width), DEPTH * diagonal
    pixels = [(x, y) for y in range(STEP // 2, height, STEP) for x in range(STEP // 2, width, STEP)]
    np.random.default_rng(1).shuffle(pixels)
    result = dict(rays=0, seen=0, missing=0, extra=0, behind=0, before=0, examples=[])
    end = time.monotonic() + PATIENCE

    def agrees(z, around, finite):
        if np.isinf(z):
            return bool(np.isinf(around).any())
        return finite.size > 0 and finite.min() - slack <= z <= finite.max() + slack

    for x, y in pixels:
        if time.monotonic() > end:
            break
        around = depth[max(y - 1, 0):y + 2, max(x - 1, 0):x + 2]
        finite = around[np.isfinite(around)]
        z = rays.depth(x + .5, y + .5)
        result['rays'] += 1
        result['seen'] += bool(np.isfinite(z))
        # the kernel begins from a coarse polyhedron and misses points near borders and silhouettes: a ray close by may not
        near = ((x + .5 + dx, y + .5 + dy) for dx, dy in NEAR)
        if agrees(z, around, finite) or any(agrees(rays.depth(*p), around, finite) for p in near):
            continue
        if np.isinf(z):
            kind = 'extra'
        elif finite.size == 0:
            kind = 'missing'
        else:
            kind = 'behind' if finite.min() > z else 'before'
        result[kind] += 1
        if len(result['examples']) < 5:
            result['examples'].append([int(x), int(y), kind])
    return result


def main():
    for printer in Message.DefaultMessenger_s().Printers():
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
    _document, free = read(sys.argv[1])
    placed = [f for _, shape in free for f in each(shape, TopAbs_FACE)]
    faces = [f for f in placed if has_surface(f)]
    areas = Areas()
    for face in faces:
        areas.distinct.Add(face.Located(TopLoc_Location()))
    tell('counts', dict(faces=areas.distinct.Size(), placed=len(faces), facets=len(placed) - len(faces),
                        solids=sum(1 for _, shape in free for _ in each(shape, TopAbs_SOLID))))
    if not faces:
        return
    tell('area', sum(map(areas.of, faces)).tolist())
    tell('colours', colours(free, areas))
    whole, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(whole)
    for face in faces:
        builder.Add(whole, face)
    pictures = [pathlib.Path(p) for p in sys.argv[2:]]
    for camera, depth in zip(pictures[::2], pictures[1::2]):
        bounds = Bnd_Box()
        BRepBndLib.Add_s(whole, bounds, False)
        tell('picture', picture(whole, json.loads(camera.read_text()), np.load(depth), bounds.SquareExtent() ** .5))
    tell('box', box(faces))


if __name__ == '__main__':
    main()
