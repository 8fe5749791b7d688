"""Open CASCADE: a file's shape, its faces in order, and their triangles."""

import time

import numpy
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.IGESControl import IGESControl_Reader
from OCP.Message import Message, Message_Gravity
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_REVERSED
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

# between the normals of neighbouring facets, radians: the default of Open CASCADE's viewer, 20 degrees
ANGLE = 0.349


def read(path):
    """The shape, and seconds to read and transfer it."""
    for printer in list(Message.DefaultMessenger_s().Printers()):
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
    start = time.perf_counter()
    reader = (IGESControl_Reader if path.lower().endswith((".igs", ".iges")) else STEPControl_Reader)()
    if int(reader.ReadFile(path)) != 1:
        raise SystemExit(f"the kernel cannot read {path}")
    reader.TransferRoots()
    shape = reader.OneShape()
    return shape, time.perf_counter() - start


def faces(shape):
    """All placed faces, in the kernel's order."""
    explorer, found = TopExp_Explorer(shape, TopAbs_FACE), []
    while explorer.More():
        found.append((getattr(TopoDS, "Face_s", None) or TopoDS.Face)(explorer.Current()))
        explorer.Next()
    return found


def edge_mm(face):
    """The largest tolerance of the face's edges."""
    explorer, most = TopExp_Explorer(face, TopAbs_EDGE), 0.0
    while explorer.More():
        edge = (getattr(TopoDS, "Edge_s", None) or TopoDS.Edge)(explorer.Current())
        most = max(most, BRep_Tool.Tolerance_s(edge))
        explorer.Next()
    return most


def box(shape):
    """Corners of the box, from the surfaces; None for a void one."""
    bounds = Bnd_Box()
    BRepBndLib.Add_s(shape, bounds, False)
    if bounds.IsVoid():
        return None
    low, high = bounds.CornerMin(), bounds.CornerMax()
    return [(p.X(), p.Y(), p.Z()) for p in (low, high)]


def diagonal(shape):
    low, high = box(shape)
    return sum((b - a) ** 2 for a, b in zip(low, high)) ** 0.5


def mesh(shape, deflection):
    """Meshes anew, on all cores, within a length; seconds."""
    BRepTools.Clean_s(shape)
    start = time.perf_counter()
    BRepMesh_IncrementalMesh(shape, deflection, False, ANGLE, True)
    return time.perf_counter() - start


def triangles(found):
    """Points, corners and the face's number of each triangle, as lists."""
    points, corners, numbers = [], [], []
    for number, face in enumerate(found):
        place = TopLoc_Location()
        patch = BRep_Tool.Triangulation_s(face, place)
        if patch is None:
            continue
        moved, first = place.Transformation(), len(points)
        for k in range(1, patch.NbNodes() + 1):
            p = patch.Node(k).Transformed(moved)
            points.append((p.X(), p.Y(), p.Z()))
        turned = face.Orientation() == TopAbs_REVERSED
        for k in range(1, patch.NbTriangles() + 1):
            a, b, c = (n + first - 1 for n in patch.Triangle(k).Get())
            corners.append((a, c, b) if turned else (a, b, c))
            numbers.append(number)
    return points, corners, numbers


def write_stl(path, of):
    """Triangles as `triangles` returns them, as a binary STL file."""
    points, corners, _ = of
    facets = numpy.zeros(len(corners), dtype=[("normal", "<3f4"), ("corners", "<(3,3)f4"), ("spare", "<u2")])
    facets["corners"] = numpy.array(points)[numpy.array(corners)]
    with open(path, "wb") as file:
        file.write(bytes(80) + len(corners).to_bytes(4, "little") + facets.tobytes())
