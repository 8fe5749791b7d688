"""F3D, the viewer of many formats: it meshes by Open CASCADE, within a length and an angle that are options of its
readers.

    job      model, camera, turn (cameras), deflections (lengths, the coarsest first), most_mesh_s
    results  {deflection, first_s, turning_ms, standing_ms} for each; first_s runs from reading the file anew to the
             first picture; or {deflection, stopped} where the mesh would take longer than most_mesh_s. A mesh's time is
             what its first picture takes beyond the quickest one.
"""

import time

import f3d

from . import job, tell
from .meshing import stopped
from .turn import turned

ANGLE = 0.349


def main():
    wanted = job()
    width, height = wanted["camera"]["size"]
    f3d.Log.set_verbose_level(f3d.Log.VerboseLevel.QUIET)
    f3d.Engine.autoload_plugins()
    firsts = []
    for deflection in wanted["deflections"]:
        why = stopped(firsts[-1] - min(firsts), wanted["most_mesh_s"]) if firsts else None
        if why:
            tell({"deflection": deflection, "stopped": why})
            continue
        for reader in ("STEP", "IGES"):
            f3d.Engine.set_reader_option(f"{reader}.linear_deflection", repr(deflection))
            f3d.Engine.set_reader_option(f"{reader}.angular_deflection", repr(ANGLE))
        start = time.perf_counter()
        engine = f3d.Engine.create(offscreen=True)
        engine.window.size = width, height
        engine.scene.add(wanted["model"])

        def look(camera):
            held = engine.window.camera
            held.position, held.focal_point, held.view_up = camera["eye"], camera["target"], camera["up"]
            held.view_angle = camera["fovy"]
            engine.window.render()

        look(wanted["camera"])
        first = time.perf_counter() - start
        firsts.append(first)
        turn = wanted["turn"]
        standing = turned(look, [wanted["camera"]] * len(turn))
        tell({"deflection": deflection, "first_s": first, "turning_ms": turned(look, turn), "standing_ms": standing})


if __name__ == "__main__":
    main()
