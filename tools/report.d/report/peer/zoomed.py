"""A viewer of triangles over zooms: with one mesh for all of them, and with a mesh for each.

    job      model, views: {name: {camera, deflection}}, meshes (names of views), ids (a folder),
             fixed (deflection of the one mesh, of the diagonal)
    results  {view, kind: fixed, frame_ms, ids} for all views,
             then {view, kind: remeshed, mesh_s, triangles, frame_ms, ids} for each of `meshes`

Deflections of views are lengths. The mesher cannot be stopped but with its process. VTK draws; a frame is the median
of several. Run within an X server.
"""

import statistics
import time

import numpy

from . import job, shapes, tell
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
    for name, view in wanted["views"].items():
        tell({"view": name, "kind": "fixed", **drawn(vtk, view["camera"], f"{wanted['ids']}/fixed-{name}.npy")})
    for name in wanted["meshes"]:
        view = wanted["views"][name]
        took = shapes.mesh(shape, view["deflection"])
        triangles = shapes.triangles(found)
        vtk.load(triangles)
        of_view = drawn(vtk, view["camera"], f"{wanted['ids']}/remeshed-{name}.npy")
        tell({"view": name, "kind": "remeshed", "mesh_s": took, "triangles": len(triangles[1]), **of_view})


if __name__ == "__main__":
    main()
