"""A viewer of triangles over zooms: with one mesh for all of them, and with a mesh for each.

    job      model, views: {name: {camera, deflection}}, fixed (deflection of the one mesh, of the diagonal), most_mesh_s, ids (a folder)
    results  {view, fixed: {frame_ms, ids}, remeshed: {mesh_s, frame_ms, triangles, ids} or {stopped}}

Deflections of views are lengths. VTK draws; a frame is the median of several. Run within an X server.
"""

import statistics
import time

import numpy

from . import job, shapes, tell
from .meshed import GROWTH
from .vtk_viewer import VtkViewer

FRAMES = 5


def drawn(vtk, camera, path):
    """The loaded triangles: milliseconds of a frame, and the image of faces."""
    vtk.shown(camera, [])
    times = []
    vtk.renderer.AddActor(vtk.actor)
    for _ in range(FRAMES):
        start = time.perf_counter()
        vtk.look(camera)
        times.append((time.perf_counter() - start) * 1e3)
    vtk.renderer.RemoveActor(vtk.actor)
    numpy.save(path, vtk.faces(camera))
    return {"frame_ms": statistics.median(times), "ids": path}


def main():
    wanted = job()
    shape, _ = shapes.read(wanted["model"])
    found = shapes.faces(shape)
    size = next(iter(wanted["views"].values()))["camera"]["size"]
    vtk = VtkViewer(size)
    shapes.mesh(shape, wanted["fixed"] * shapes.diagonal(shape))
    vtk.load(shapes.triangles(found))
    fixed = {name: drawn(vtk, view["camera"], f"{wanted['ids']}/fixed-{name}.npy") for name, view in wanted["views"].items()}
    last, finer = 0.0, None
    for name, view in wanted["views"].items():
        # meshes of a tolerance a hundred times as small
        steps = finer / view["deflection"] if finer else 1.0
        if last * min(steps, 10.0) ** 0.9 * (GROWTH if steps > 10 else 1.0) > wanted["most_mesh_s"]:
            why = f"the mesh before took {last:.1f} s; {wanted['most_mesh_s']} s are given"
            tell({"view": name, "fixed": fixed[name], "remeshed": {"stopped": why}})
            continue
        last, finer = shapes.mesh(shape, view["deflection"]), view["deflection"]
        triangles = shapes.triangles(found)
        vtk.load(triangles)
        remeshed = {"mesh_s": last, "triangles": len(triangles[1]), **drawn(vtk, view["camera"], f"{wanted['ids']}/meshed-{name}.npy")}
        tell({"view": name, "fixed": fixed[name], "remeshed": remeshed})


if __name__ == "__main__":
    main()
