"""7. Only what a scene needs: pipelines, buffers, images and bytes that exist for each kind of scene."""

import re

from .. import hard
from ..floor import CAMERA, PLANE
from ..rows import Promise, Table
from ..turns import Unmeasurable

# parts of the names of objects, by feature
FEATURES = {
    "trims": ("trim", "gap "),
    "meshes": ("mesh",),
    "solids": ("solid",),
    "layers": ("layer",),
    "a sun": ("sun",),
}
SIZE = "320x240"
SHEET = hard.wavy("sheet")
TRIMMED = hard.wavy("sheet", 'border = true\nloops = [{ curves = "disc", at = [0.5, 0.5], scale = 0.2 }]\n') + hard.DISC
MESH = '[file.tetra]\npath = "tetra.obj"\n'
BORE = hard.solid("B", "cylinder", radius=8, height=60, at=[0, 0, -30]) + hard.boolean("A-B")
SOLID = hard.solid("A", "sphere", radius=20) + BORE
GLASS = hard.solid("A", "sphere", radius=20) + 'colour = "#7fa8d080"\n' + BORE
SUN = SOLID + "[picture]\nsun = [0.3, -0.5, 0.8]\n"
TETRA = "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
# scene, and the features that it has
SCENES = {
    "a plane": (PLANE, []),
    "an untrimmed sheet": (SHEET, []),
    "a trimmed part": (TRIMMED, ["trims"]),
    "a mesh": (MESH, ["meshes"]),
    "a solid": (SOLID, ["solids"]),
    "a solid of glass": (GLASS, ["solids", "layers"]),
    "a solid in the sun": (SUN, ["solids", "a sun"]),
}
TITLE = "Only what a scene needs"
TEXT = """\
What exists after two frames of 320 x 240 pixels, by name. Objects for trims, meshes, solids, layers or a sun exist
only in scenes that have these. The last column counts the objects of a scene that the plane's scene lacks."""


def measure(context, section):
    folder = context.program.folder()
    (folder / "tetra.obj").write_text(TETRA)
    found = {}
    for name, (scene, _) in SCENES.items():
        path = folder / f"{name.replace(' ', '-')}.toml"
        path.write_text(f"selvedge = 1\n{scene}")
        stats = context.program.render(path, {**CAMERA, "size": [320, 240]})["stats"]
        if "objects" not in stats:
            raise Unmeasurable(f"{context.program.path.name} is an older build, which lists no objects")
        found[name] = stats["objects"]
    plane = {one["name"] for one in found["a plane"]}
    rows, others, cases = [], [], 0
    for name, objects in found.items():
        pipelines = [one for one in objects if one["bytes"] == 0]
        held = [one for one in objects if one["bytes"] > 0]
        more = sorted({one["name"] for one in objects} - plane)
        rows.append([name, len(pipelines), len(held), sum(one["bytes"] for one in held) / 2**20, len(more)])
        cases += len(objects)
        others += [(name, one["name"]) for one in objects for of in foreign(one["name"], SCENES[name][1])]
    section.tables.append(Table("", ["scene", "pipelines", "buffers and images", "MiB", "beyond the plane's"], rows))
    named = "" if not others else ": " + "; ".join(f"{what} of {scene}" for scene, what in others[:5])
    section.promises.append(Promise(f"every object serves something that the scene has{named}", len(others), cases))
    section.commands.append(
        context.shown("render", "SCENE.toml", "--size", SIZE, "-o", "picture.png", "--stats", "stats.json")
    )


def foreign(name, features):
    """Features that an object serves and a scene lacks. A pipeline's name has the omitted ones in brackets."""
    name = re.sub(r"\(no [^)]*\)", "", name.lower())
    return [of for of, words in FEATURES.items() if of not in features and any(word in name for word in words)]
