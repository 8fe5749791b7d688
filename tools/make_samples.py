#!/usr/bin/env python3
"""Writes the sample models of samples/ with Open CASCADE, an independent CAD kernel.

    python3 -m venv .venv && .venv/bin/pip install cadquery==2.8.0
    .venv/bin/python tools/make_samples.py            # all of them
    .venv/bin/python tools/make_samples.py panel zoo  # some of them

Lengths are millimetres. The files hold no p-curves, like most files that CAD programs write, so a reader
must find the (u, v) trim curves itself. Headers carry neither date nor names: the same version of the kernel
writes the same bytes again, but for the order of the colours of an assembly.
"""

import itertools
import math
import re
import sys
from pathlib import Path

import cadquery as cq
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

SAMPLES = Path(__file__).resolve().parent.parent / "samples"


# --- bracket: planes, cylinders, cones, tori and fillet surfaces -------------------------------------------------


def bracket():
    """An L-shaped bracket with a gusset, rounded edges, countersunk and plain holes and a slot."""
    base = cq.Workplane("XY").box(80, 50, 8, centered=(True, True, False)).edges("|Z").fillet(8)
    wall = cq.Workplane("XY").box(8, 50, 60, centered=(False, True, False)).translate((-40, 0, 0))
    wall = wall.edges("|X and >Z").fillet(18)
    body = base.union(wall.intersect(cq.Workplane("XY").box(80, 50, 200).edges("|Z").fillet(8)))
    gusset = cq.Workplane("XZ").moveTo(-32, 8).lineTo(2, 8).lineTo(-32, 30).close().extrude(4, both=True)
    body = body.union(gusset)
    body = body.edges(cq.selectors.BoxSelector((-33, -26, 7), (-31, 26, 9))).fillet(3)
    countersink = cq.Solid.makeCone(3.3, 6.3, 3, cq.Vector(0, 0, 5)).fuse(cq.Solid.makeCylinder(3.3, 8))
    for y in (-13, 13):
        body = body.cut(cq.Workplane(obj=countersink).translate((24, y, 0)))
    body = body.cut(cq.Workplane("YZ").center(0, 42).circle(9).extrude(200, both=True))
    body = body.cut(cq.Workplane("XY").pushPoints([(0, 17), (0, -17)]).slot2D(18, 5).extrude(8))
    return body.edges(cq.selectors.BoxSelector((36, -30, 7.5), (42, 30, 8.5))).fillet(2.5)


# --- panel: one trimmed free-form face ---------------------------------------------------------------------------


def panel_surface():
    """A bicubic B-spline sheet, 240 x 160 mm, through a grid of points with two swells and a twist."""

    def height(x, y):
        swell = 22 * math.exp(-((x - 45) ** 2 + (y - 20) ** 2) / 2600)
        dent = -14 * math.exp(-((x + 60) ** 2 + (y + 25) ** 2) / 1800)
        return swell + dent + x * y / 900 - x * x / 900

    rows = [
        [cq.Vector(x, y, height(x, y)) for y in (-80 + 160 * j / 12 for j in range(13))]
        for x in (-120 + 240 * i / 16 for i in range(17))
    ]
    return cq.Face.makeSplineApprox(rows, tol=0.05, minDeg=3, maxDeg=3)


def panel():
    """The sheet cut to a rounded outline, with round holes, a grille of slits and a star-shaped opening."""
    outline = cq.Workplane("XY").workplane(offset=-60).sketch().rect(220, 140).vertices().fillet(26).finalize()
    keep = outline.extrude(120)
    tool = cq.Workplane("XY").workplane(offset=-60)
    slits = [(-70 + 10 * i, -25 + 4 * math.sin(i)) for i in range(4)]
    keep = keep.cut(tool.pushPoints(slits).slot2D(40, 3.2, 84).extrude(120))
    hairlines = [(-98 + 3 * i, 36) for i in range(4)]
    keep = keep.cut(tool.pushPoints(hairlines).slot2D(24, 0.3, 90).extrude(120))
    keep = keep.cut(tool.polarArray(26, 0, 360, 8).circle(3.5).extrude(120).translate((45, 20, 0)))
    keep = keep.cut(tool.center(45, 20).circle(14).extrude(120))
    corners = [(-96, -56), (96, -56), (96, 56), (-96, 56)]
    keep = keep.cut(tool.pushPoints(corners).circle(4.5).extrude(120))
    star = []
    for i in range(10):
        radius, angle = (17, 7)[i % 2], math.radians(90 + 36 * i)
        star.append((10 + radius * math.cos(angle), -38 + radius * math.sin(angle)))
    keep = keep.cut(tool.polyline(star).close().extrude(120))
    wave = [(-30, 40), (-15, 52), (0, 44), (8, 58), (-12, 64), (-34, 54)]
    keep = keep.cut(tool.spline(wave, periodic=True).close().extrude(120))
    sheet = panel_surface().intersect(keep.val())
    return cq.Workplane(obj=sheet)


# --- zoo: one of each quadric, whole and cut ---------------------------------------------------------------------


def zoo_shapes():
    """Small solids, poles, tips and seams among them."""
    xy, yz, xz = (lambda: cq.Workplane("XY")), (lambda: cq.Workplane("YZ")), (lambda: cq.Workplane("XZ"))
    solid = lambda made: cq.Workplane(obj=made)
    box = lambda x, y, z, axis, degrees, at: xy().box(x, y, z).rotate((0, 0, 0), axis, degrees).translate(at)

    # spheres: whole; an octant removed, poles on its edges; a lune between latitudes; drilled through
    yield xy().sphere(10)
    yield xy().sphere(10).cut(box(20, 20, 20, (0, 0, 1), 0, (10, -10, 10)))
    yield solid(cq.Solid.makeSphere(10, cq.Vector(), cq.Vector(1, 2, 2), -35, 60, 250))
    yield xy().sphere(10).cut(yz().circle(4).extrude(20, both=True))

    # cones: with a tip; a frustum with a slot; a wedge down to the tip
    yield solid(cq.Solid.makeCone(10, 0, 22))
    yield solid(cq.Solid.makeCone(10, 4, 18)).cut(box(30, 12, 4, (0, 1, 0), 30, (0, 0, 9)))
    yield solid(cq.Solid.makeCone(0, 10, 20, cq.Vector(), cq.Vector(0, 0, 1), 200))

    # cylinders: crossed by a thinner one; cut by slanted planes (ellipses)
    yield xy().circle(9).extrude(20).cut(yz().center(0, 10).circle(6).extrude(20, both=True))
    yield xy().circle(9).extrude(20).intersect(box(40, 40, 20, (1, 1, 0), 35, (0, 0, 10)))

    # tori: whole, with two seams; cut by planes across both seams; drilled
    yield solid(cq.Solid.makeTorus(9, 3))
    yield solid(cq.Solid.makeTorus(8, 4)).cut(box(30, 30, 30, (1, 1, 0), 25, (15, 0, 15)))
    yield solid(cq.Solid.makeTorus(8, 4)).cut(xz().center(8, 0).circle(2).extrude(20, both=True))

    # swept: an elliptic cylinder, a turned spline, a twisted bar
    yield xy().ellipse(10, 5).extrude(16).cut(xz().center(0, 8).ellipse(4, 2).extrude(10, both=True))
    vase = xz().moveTo(0, 0).lineTo(6, 0).spline([(9, 6), (5, 12), (4, 18), (8, 22)], includeCurrent=True)
    yield vase.lineTo(0, 22).close().revolve(360, (0, 0, 0), (0, 1, 0))
    yield xy().rect(14, 9).twistExtrude(20, 70)

    # a ball with a square well, every surface turned into a rational B-spline
    ball = xy().sphere(10).cut(xy().center(4, 0).rect(6, 6).extrude(20)).val()
    yield solid(cq.Shape.cast(BRepBuilderAPI_NurbsConvert(ball.wrapped).Shape()))


def zoo():
    """The shapes on a grid, 30 mm apart."""
    solids = []
    for i, shape in enumerate(zoo_shapes()):
        assert shape.val().isValid(), f"zoo shape {i}"
        solids += shape.translate((30 * (i % 4), 30 * (i // 4), 0)).solids().vals()
    return cq.Workplane(obj=cq.Compound.makeCompound(solids))


# --- assembly: shared parts, nested and placed -------------------------------------------------------------------


def hexagon_bolt():
    """M8 x 30 without thread; the head is chamfered by a cone, which leaves hyperbolas on its flats."""
    head = cq.Workplane("XY").polygon(6, 15.01).extrude(5.3)
    head = head.intersect(cq.Workplane(obj=cq.Solid.makeCone(14, 6, 6)))
    return head.union(cq.Workplane("XY").workplane(offset=-30).circle(4).extrude(30)).faces("<Z").chamfer(0.8)


AXIS = 56  # height of the shaft above the ground


def pillow_block():
    """The housing: a base with four bolt holes under a bored, filleted boss."""
    base = cq.Workplane("XY").box(130, 64, 14, centered=(True, True, False)).edges("|Z").fillet(12)
    outline = [(-46, 10), (46, 10), (34, AXIS), (-34, AXIS)]
    web = cq.Workplane("XZ").polyline(outline).close().extrude(15, both=True)
    body = base.union(web).edges(cq.selectors.BoxSelector((-60, -20, 13), (60, 20, 15))).fillet(4)
    boss = cq.Workplane("XZ").center(0, AXIS).circle(38).extrude(20, both=True).edges().chamfer(1.5)
    body = body.union(boss).cut(cq.Workplane("XZ").center(0, AXIS).circle(30).extrude(40, both=True))
    return body.cut(cq.Workplane("XY").rect(104, 38, forConstruction=True).vertices().circle(4.5).extrude(20))


def bearing_ring(inner, outer, track):
    """A ring, 18 mm wide along y, with the raceway's torus cut into it and rounded rims."""
    ring = cq.Workplane("XZ").circle(outer).circle(inner).extrude(9, both=True).edges().fillet(1)
    return ring.cut(cq.Workplane(obj=cq.Solid.makeTorus(track, 5.05, cq.Vector(), cq.Vector(0, 1, 0))))


def shaft():
    """A stepped shaft along y with a keyway and chamfered ends."""
    body = cq.Workplane("XZ").workplane(offset=-46).circle(14).extrude(92).faces("<Y or >Y").chamfer(1.5)
    body = body.union(cq.Workplane("XZ").workplane(offset=-24).circle(17).extrude(12).edges().fillet(1.5))
    return body.cut(cq.Workplane("XY").workplane(offset=11).center(0, -34).slot2D(20, 6, 90).extrude(10))


def hand_wheel():
    """A rim, five tapered spokes and a hub with a keyed bore, in the xz plane."""
    wheel = cq.Workplane(obj=cq.Solid.makeTorus(52, 5.5, cq.Vector(), cq.Vector(0, 1, 0)))
    for i in range(5):
        spoke = cq.Solid.makeCone(5, 3.4, 40, cq.Vector(0, 0, 12), cq.Vector(0, 0, 1))
        wheel = wheel.union(cq.Workplane(obj=spoke).rotate((0, 0, 0), (0, 1, 0), 72 * i))
    wheel = wheel.union(cq.Workplane("XZ").circle(22).extrude(9, both=True).edges().fillet(3))
    return wheel.cut(cq.Workplane("XZ").circle(14).extrude(20, both=True))


def handle():
    """A turned grip: a free-form profile about y, with a rounded end on its axis (a pole)."""
    half = cq.Workplane("XY").moveTo(0, 0).lineTo(3, 0).lineTo(3, 6)
    half = half.spline([(7, 14), (8.5, 26), (6, 36), (0, 40)], tangents=[(1, 0.2), (-1, 0)], includeCurrent=True)
    return half.close().revolve(360, (0, 0, 0), (0, 1, 0))


def assembly():
    """A shaft in a pillow block. The nine balls share one body; so do the four bolts and the four washers."""
    at = lambda x, y, z: cq.Location(cq.Vector(x, y, z))
    steel, dark, brass = cq.Color(0.62, 0.65, 0.69), cq.Color(0.22, 0.23, 0.25), cq.Color(0.80, 0.58, 0.20)
    block = pillow_block()
    result = cq.Assembly(name="pillow_block_unit")
    housing = cq.Assembly(block, name="housing", color=cq.Color(0.13, 0.32, 0.52))
    for face in block.faces("<Y or >Y").vals():  # the machined sides are bare metal: faces with a colour of their own
        housing.addSubshape(face, color=steel)
    result.add(housing)
    bearing = cq.Assembly(name="bearing", loc=at(0, 0, AXIS))
    bearing.add(bearing_ring(24, 30, 22).mirror("XY"), name="outer_ring", color=steel)
    bearing.add(bearing_ring(14, 19.5, 22), name="inner_ring", color=steel)
    ball = cq.Workplane("XY").sphere(5)
    for i in range(9):
        turn = cq.Location(cq.Vector(), cq.Vector(0, 1, 0), 40 * i)
        bearing.add(ball, name=f"ball_{i + 1}", color=brass, loc=turn * at(0, 0, 22))
    result.add(bearing)
    bolt, washer = hexagon_bolt(), cq.Workplane("XY").circle(8).circle(4.2).extrude(1.6).edges().chamfer(0.3)
    for i, (x, y) in enumerate([(-52, -19), (52, -19), (52, 19), (-52, 19)]):
        place = cq.Location(cq.Vector(x, y, 14), cq.Vector(0, 0, 1), 17 * i)
        fastener = cq.Assembly(name=f"fastener_{i + 1}", loc=place)
        fastener.add(washer, name=f"washer_{i + 1}", color=brass)
        fastener.add(bolt, name=f"bolt_{i + 1}", color=dark, loc=at(0, 0, 1.6))
        result.add(fastener)
    result.add(shaft(), name="shaft", color=steel, loc=at(0, 0, AXIS))
    wheel = cq.Assembly(name="wheel", loc=cq.Location(cq.Vector(0, 36, AXIS), cq.Vector(0, 1, 0), 24))
    wheel.add(hand_wheel(), name="hand_wheel", color=cq.Color(0.55, 0.08, 0.07))
    wheel.add(handle(), name="handle", color=dark, loc=at(0, 4, 52))
    result.add(wheel)
    return result


# --- writing -----------------------------------------------------------------------------------------------------


def neutral_header(path):
    """Replaces everything in the header that depends on time, place and author of the file."""
    text = path.read_text()
    name = f"FILE_NAME('{path.name}','1970-01-01T00:00:00',(''),(''),'','','');"
    text, headers = re.subn(r"FILE_NAME\(.*?\);", name, text, count=1, flags=re.S)
    assert headers == 1
    text = re.sub(r"Open CASCADE STEP translator [\d. ]+", path.stem, text)
    numbers = itertools.count(1)  # the kernel numbers occurrences through the life of the process
    text = re.sub(r"(OCCURRENCE\(')\d+'", lambda found: f"{found[1]}{next(numbers)}'", text)
    path.write_text(text)


def write(name):
    """One sample, checked by the kernel before it is written."""
    made = globals()[name]()
    if not isinstance(made, cq.Assembly):
        for shape in made.vals():
            assert shape.isValid(), f"{name}: the kernel finds the shape invalid"
        made = cq.Assembly(made, name=name, color=cq.Color(0.45, 0.55, 0.62))
    path = SAMPLES / f"{name}.step"
    made.export(str(path), "STEP", write_pcurves=False)
    neutral_header(path)
    faces = path.read_text().count("ADVANCED_FACE(")
    print(f"{path.name}: {path.stat().st_size / 1024:.0f} KiB, {faces} faces")


if __name__ == "__main__":
    SAMPLES.mkdir(exist_ok=True)
    for sample in sys.argv[1:] or ["bracket", "panel", "zoo", "assembly"]:
        write(sample)
