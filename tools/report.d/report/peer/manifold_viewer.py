"""Manifold evaluates a Boolean solid as triangles, VTK draws them.

    job      scene: {primitives, tree} (Scene.data of scenes.py), segments (numbers around), camera, turn, folder
    results  {segments, evaluate_s, triangles, first_s, turning_ms, picture (an image of faces)}

Run within an X server.
"""

import time

import numpy
from manifold3d import CrossSection, Manifold, OpType

from . import job, tell
from .vtk_viewer import VtkViewer


def primitive(part, segments):
    shape = part["shape"]
    if shape == "block":
        made = Manifold.cube(part["size"], part["centred"])
    elif shape == "sphere":
        made = Manifold.sphere(part["radius"], segments)
    elif shape == "cylinder":
        made = Manifold.cylinder(part["height"], part["radius"], part["radius"], segments)
    else:
        made = Manifold.revolve(CrossSection.circle(part["minor"], segments).translate([part["major"], 0]), segments)
    return made.rotate([part["turn"], 0, 0]).translate(part["at"])


def evaluated(tree, parts):
    if isinstance(tree, str):
        return parts[tree]
    operator = {"+": OpType.Add, "*": OpType.Intersect, "-": OpType.Subtract}[tree[0]]
    return Manifold.batch_boolean([evaluated(one, parts) for one in tree[1:]], operator)


def main():
    wanted = job()
    vtk = VtkViewer(wanted["camera"]["size"])
    for segments in wanted["segments"]:
        start = time.perf_counter()
        parts = {name: primitive(part, segments) for name, part in wanted["scene"]["primitives"].items()}
        mesh = evaluated(wanted["scene"]["tree"], parts).to_mesh()
        points, corners = numpy.array(mesh.vert_properties)[:, :3], numpy.array(mesh.tri_verts)
        took = time.perf_counter() - start
        vtk.load((points, corners, numpy.zeros(len(corners), int)))
        shown = vtk.shown(wanted["camera"], wanted["turn"])
        picture = f"{wanted['folder']}/{segments}.npy"
        numpy.save(picture, vtk.faces(wanted["camera"]) + 1)
        tell({"segments": segments, "evaluate_s": took, "triangles": len(corners), "picture": picture, **shown})


if __name__ == "__main__":
    main()
