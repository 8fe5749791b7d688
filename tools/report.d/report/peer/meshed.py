"""Viewers of triangles: Open CASCADE's (V3d) and VTK, over the deflections of one mesher.

    job      model, camera, turn (cameras), deflections (of the diagonal), most_mesh_s, ids (a folder, or null),
             wants (viewers)
    results  {read_s, diagonal}, then for each deflection
             {deflection, mesh_s, triangles, ids, stl, occ: {first_s, turning_ms, standing_ms}, vtk: the same};
             or {deflection, stopped} where the one before took so long to mesh that this one would not be done in time

First pictures are the seconds from a mesh to its first frame, with the window's; handing the triangles to VTK is not
counted, because a program in C++ would not do it from Python. Frames in a row are timed as one. Run within an X
server.
"""

import time

import numpy
from OCP.AIS import AIS_InteractiveContext, AIS_Shape
from OCP.Aspect import Aspect_DisplayConnection
from OCP.gp import gp_Dir, gp_Pnt
from OCP.Graphic3d import Graphic3d_Camera
from OCP.OpenGl import OpenGl_GraphicDriver
from OCP.Quantity import Quantity_Color, Quantity_TOC_RGB
from OCP.V3d import V3d_Viewer
from OCP.Xw import Xw_Window

from . import job, shapes, tell
from .meshing import stopped
from .turn import turned
from .vtk_viewer import VtkViewer


class OccViewer:
    """A window of V3d: the shape shaded by its triangles, no edges."""

    def __init__(self, size):
        start = time.perf_counter()
        display = Aspect_DisplayConnection()
        self.scene = V3d_Viewer(OpenGl_GraphicDriver(display))
        self.scene.SetDefaultLights()
        self.scene.SetLightOn()
        self.view = self.scene.CreateView()
        self.view.SetImmediateUpdate(False)
        self.window = Xw_Window(display, "report", 0, 0, *size)
        self.view.SetWindow(self.window)
        self.window.Map()
        self.view.SetBackgroundColor(Quantity_Color(1, 1, 1, Quantity_TOC_RGB))
        self.context = AIS_InteractiveContext(self.scene)
        self.made_s = time.perf_counter() - start

    def look(self, camera):
        found = self.view.Camera()
        found.SetProjectionType(Graphic3d_Camera.Projection_e.Projection_Perspective)
        found.SetFOVy(camera["fovy"])
        found.SetUp(gp_Dir(*camera["up"]))
        found.SetCenter(gp_Pnt(*camera["target"]))
        found.SetEye(gp_Pnt(*camera["eye"]))
        found.OrthogonalizeUp()
        self.view.ZFitAll()
        self.view.Invalidate()
        self.view.Redraw()

    def shown(self, shape, camera, turn):
        """Seconds to the first frame of the meshed shape, milliseconds of one that turns, and of one that stands."""
        start = time.perf_counter()
        drawn = AIS_Shape(shape)
        drawn.Attributes().SetAutoTriangulation(False)
        self.context.Display(drawn, 1, -1, False)
        self.look(camera)
        first = time.perf_counter() - start
        frames = {"turning_ms": turned(self.look, turn), "standing_ms": turned(self.look, [camera] * len(turn))}
        self.context.Remove(drawn, False)
        return {"first_s": self.made_s + first, **frames}


def main():
    wanted = job()
    shape, read_s = shapes.read(wanted["model"])
    diagonal = shapes.diagonal(shape)
    tell({"read_s": read_s, "diagonal": diagonal})
    found = shapes.faces(shape)
    size, camera, turn = wanted["camera"]["size"], wanted["camera"], wanted["turn"]
    occ = OccViewer(size) if "occ" in wanted["wants"] else None
    vtk = VtkViewer(size) if "vtk" in wanted["wants"] or wanted["ids"] else None
    last = 0.0
    for deflection in wanted["deflections"]:
        why = stopped(last, wanted["most_mesh_s"])
        if why:
            tell({"deflection": deflection, "stopped": why})
            continue
        last = shapes.mesh(shape, deflection * diagonal)
        result = {"deflection": deflection, "mesh_s": last, "ids": None}
        if occ:
            result["occ"] = occ.shown(shape, camera, turn)
        if vtk:
            triangles = shapes.triangles(found)
            result["triangles"] = len(triangles[1])
            vtk.load(triangles)
            if "vtk" in wanted["wants"]:
                result["vtk"] = vtk.shown(camera, turn)
            if wanted["ids"]:
                result["ids"] = f"{wanted['ids']}/{deflection:g}.npy"
                numpy.save(result["ids"], vtk.faces(camera))
                result["stl"] = f"{wanted['ids']}/{deflection:g}.stl"
                shapes.write_stl(result["stl"], triangles)
        tell(result)


if __name__ == "__main__":
    main()
