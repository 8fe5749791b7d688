"""A closed ball with waves on it, as triangles in an OBJ file. It replaces the paper's bunny and has the same number
of triangles."""

import math

TRIANGLES = {"bunny": 574_000, "bunny2": 2_300_000}
# the cuts are those of the paper: three cylinders through the mesh
CUTS = """
[solid.B]
shape = "cylinder"
radius = 6
height = 60
at = [0, 0, -30]

[solid.C]
shape = "cylinder"
radius = 5
height = 60
rotate = [90, 0, 0]
at = [0, 30, 0]

[solid.D]
shape = "cylinder"
radius = 4
height = 60
rotate = [0, 90, 0]
at = [-30, 0, 0]

[solid.whole]
shape = "boolean"
of = "A-(B+C+D)"
"""


def scene(folder, name):
    """Writes the mesh and the scene file, whose path is returned."""
    with open(folder / f"{name}.obj", "w") as out:
        out.writelines(lines(TRIANGLES[name]))
    path = folder / f"{name}.toml"
    path.write_text(f'selvedge = 1\nname = "{name}"\n\n[file.A]\npath = "{name}.obj"\n{CUTS}')
    return path


def lines(triangles):
    rings = round(math.sqrt(triangles / 4))
    around = 2 * rings

    def at(theta, phi):
        s = math.sin(theta)
        r = 20 * (1 + 0.12 * math.sin(5 * phi) * s**2 * math.cos(4 * theta))
        return f"v {r * s * math.cos(phi):.9g} {r * s * math.sin(phi):.9g} {r * math.cos(theta):.9g}\n"

    yield at(0, 0)
    for i in range(1, rings):
        yield from (at(math.pi * i / rings, math.tau * j / around) for j in range(around))
    yield at(math.pi, 0)
    last = (rings - 1) * around + 2
    vertex = lambda i, j: 2 + (i - 1) * around + j % around
    for j in range(around):
        yield f"f 1 {vertex(1, j)} {vertex(1, j + 1)}\n"
        yield f"f {last} {vertex(rings - 1, j + 1)} {vertex(rings - 1, j)}\n"
    for i in range(1, rings - 1):
        for j in range(around):
            a, b, c, d = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
            yield f"f {a} {b} {c}\nf {a} {c} {d}\n"
