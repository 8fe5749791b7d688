"""Boolean solids for all competitors, each from one description: as our scene file, for OpenSCAD, for POV-Ray, and as
plain data.

A primitive is `{shape, …, at, turn}`: block (size, centred), sphere (radius), cylinder (radius, height), torus
(major, minor); turned about x by `turn` degrees, then moved by `at`. A scene has primitives by name and an expression
of them, `+` `*` `-` and brackets. The paper's models (J. Hable, J. Rossignac, Blister, SIGGRAPH 2005) are not public:
these have its numbers of primitives, and of triangles.
"""

import math
import re
from dataclasses import dataclass

# layers peeled, layers in all, seconds on a GeForce 6800
PAPER = {
    "widget": (3.85, 4.00, 0.018),
    "bunny": (6.81, 9.13, 0.325),
    "bunny2": (6.77, 9.09, 1.200),
    "complex": (9.17, 14.1, 0.093),
    "gear": (25.6, 36.4, 0.460),
}
COLOURS = ["#4f7fa8", "#d8a657", "#b5485d", "#6d8f4e"]


@dataclass
class Scene:
    name: str
    primitives: dict
    expression: str

    def tree(self):
        return parsed(self.expression)

    def data(self):
        return {"primitives": self.primitives, "tree": chained(self.tree())}


def primitive(shape, at=(0, 0, 0), turn=0, **keys):
    return {"shape": shape, "at": list(at), "turn": turn, **keys}


def widget():
    """A rounded block less two crossing bores: 4 primitives."""
    parts = {
        "A": primitive("block", size=[40, 40, 40], centred=True),
        "B": primitive("sphere", radius=26),
        "C": primitive("cylinder", (0, 0, -30), radius=11, height=60),
        "D": primitive("cylinder", (0, 30, 0), 90, radius=11, height=60),
    }
    return Scene("widget", parts, "A*B-C-D")


def complex_():
    """Two crossing tubes with flanges and bolt holes: 20 primitives."""
    parts = {
        "A": primitive("cylinder", (0, 0, -40), radius=16, height=80),
        "B": primitive("cylinder", (0, 0, -45), radius=12, height=90),
        "C": primitive("cylinder", (0, 40, 0), 90, radius=13, height=80),
        "D": primitive("cylinder", (0, 45, 0), 90, radius=9, height=90),
        "E": primitive("sphere", radius=24),
        "F": primitive("sphere", radius=20),
        "G": primitive("cylinder", (0, 0, 34), radius=26, height=6),
        "H": primitive("cylinder", (0, 0, -40), radius=26, height=6),
    }
    for k in range(12):
        turn = math.radians(60 * (k % 6) + 30)
        at = (round(21 * math.cos(turn), 9), round(21 * math.sin(turn), 9), -41 if k < 6 else 33)
        parts[f"J{k}"] = primitive("cylinder", at, radius=2.5, height=8)
    return Scene("complex", parts, "(A+C+E+G+H)-(B+D+F)-(" + "+".join(f"J{k}" for k in range(12)) + ")")


def gear():
    """A wheel of 40 gaps with a bore, a recess and lightening holes: 48 primitives."""
    parts = {
        "A": primitive("cylinder", radius=40, height=12),
        "B": primitive("cylinder", (0, 0, -1), radius=8, height=14),
        "C": primitive("torus", (0, 0, 12), major=20, minor=5),
        "D": primitive("torus", major=20, minor=5),
    }
    ring = lambda radius, degrees: (
        round(radius * math.cos(math.radians(degrees)), 9),
        round(radius * math.sin(math.radians(degrees)), 9),
        -1,
    )
    parts |= {f"T{k}": primitive("cylinder", ring(41, 9 * k), radius=1.9, height=14) for k in range(40)}
    parts |= {f"L{k}": primitive("cylinder", ring(30, 90 * k + 45), radius=4, height=14) for k in range(4)}
    return Scene("gear", parts, "A-(" + "+".join(name for name in parts if name != "A") + ")")


def plate(holes):
    """A plate with a grid of holes."""
    side = round(math.sqrt(holes))
    parts = {"A": primitive("block", size=[side, side, 2], centred=False)}
    parts |= {
        f"H{k}": primitive("cylinder", (k % side + 0.5, k // side + 0.5, -1), radius=0.3, height=4)
        for k in range(holes)
    }
    return Scene(f"plate{holes}", parts, "A-(" + "+".join(f"H{k}" for k in range(holes)) + ")")


def of_name(name):
    if name.startswith("plate"):
        return plate(int(name[5:]))
    return {"widget": widget, "complex": complex_, "gear": gear}[name]()


def parsed(expression):
    """A tree of lists `[operator, left, right]` and names; `*` binds tighter than `+` and `-`."""
    words = re.findall(r"[A-Z][0-9]*|[-+*()]", expression)
    if "".join(words) != expression:
        raise ValueError(f"not an expression: {expression}")
    words.reverse()

    def operand():
        word = words.pop()
        if word != "(":
            return word
        inside = levels(0)
        words.pop()
        return inside

    def levels(level):
        if level == 2:
            return operand()
        tree = levels(level + 1)
        while words and words[-1] in ("+-", "*")[level]:
            tree = [words.pop(), tree, levels(level + 1)]
        return tree

    return levels(0)


def toml(scene):
    """A scene file."""
    lines = ["selvedge = 1", f'name = "{scene.name}"']
    for number, (name, part) in enumerate(scene.primitives.items()):
        lines += ["", f"[solid.{name}]", f'shape = "{part["shape"]}"', f'colour = "{COLOURS[number % 4]}"']
        skipped = ("shape", "turn") if not part["turn"] else ("shape",)
        for key, value in part.items():
            if key == "turn" and value:
                lines.append(f"rotate = [{value}, 0, 0]")
            elif key not in skipped:
                lines.append(f"{key} = {str(value).lower()}")
    lines += ["", "[solid.whole]", 'shape = "boolean"', f'of = "{scene.expression}"']
    return "\n".join(lines) + "\n"


def scad(scene, segments):
    """A program for OpenSCAD, whose round primitives have so many segments."""

    def shape(part):
        text = {
            "block": lambda: f"cube({part['size']}, center={str(part['centred']).lower()});",
            "sphere": lambda: f"sphere(r={part['radius']});",
            "cylinder": lambda: f"cylinder(r={part['radius']}, h={part['height']});",
            "torus": lambda: f"rotate_extrude() translate([{part['major']}, 0]) circle(r={part['minor']});",
        }[part["shape"]]()
        return f"translate({part['at']}) rotate([{part['turn']}, 0, 0]) {text}"

    def whole(tree):
        if isinstance(tree, str):
            return shape(scene.primitives[tree])
        name = {"+": "union", "*": "intersection", "-": "difference"}[tree[0]]
        return f"{name}() {{ {' '.join(whole(one) for one in flat(tree))} }}"

    return f"$fn = {segments};\n{whole(scene.tree())}\n"


def pov(scene, camera):
    """A scene for POV-Ray, which has no facets either; its axes are left-handed, so `right` is turned round."""

    def shape(part):
        at, text = (
            part["at"],
            {
                "block": lambda: "box {{ {}, {} ".format(*map(vector, block_corners(part))),
                "sphere": lambda: f"sphere {{ 0, {part['radius']} ",
                "cylinder": lambda: f"cylinder {{ 0, <0, 0, {part['height']}>, {part['radius']} ",
                "torus": lambda: f"torus {{ {part['major']}, {part['minor']} rotate <90, 0, 0> ",
            }[part["shape"]](),
        )
        return f"{text} rotate <{part['turn']}, 0, 0> translate {vector(at)} }}"

    def whole(tree):
        if isinstance(tree, str):
            return shape(scene.primitives[tree])
        name = {"+": "union", "*": "intersection", "-": "difference"}[tree[0]]
        return f"{name} {{ {' '.join(whole(one) for one in flat(tree))} }}"

    width, height = camera["size"]
    across = math.degrees(2 * math.atan(math.tan(math.radians(camera["fovy"]) / 2) * width / height))
    eye, target, up = (vector(camera[name]) for name in ("eye", "target", "up"))
    look = f"location {eye} up y right {-width / height}*x sky {up} angle {across} look_at {target}"
    light = f"light_source {{ {eye}, rgb 1 shadowless }}"
    return (
        "#version 3.7; global_settings { assumed_gamma 1.0 }\nbackground { rgb 1 }\n"
        f"camera {{ perspective {look} }}\n{light}\n"
        f"object {{ {whole(scene.tree())} pigment {{ rgb <0.2, 0.3, 0.4> }} }}\n"
    )


def flat(tree):
    """Operands of a chain of one operator: for a difference the first, then all subtracted ones."""
    operands = []
    operator = None if isinstance(tree, str) else tree[0]
    while not isinstance(tree, str) and tree[0] == operator:
        operands.append(tree[2])
        tree = tree[1]
    return [tree, *reversed(operands)]


def chained(tree):
    """The tree with a chain of one operator as one list, operator first: as deep as its parentheses."""
    return tree if isinstance(tree, str) else [tree[0], *map(chained, flat(tree))]


def block_corners(part):
    half = [s / 2 for s in part["size"]]
    low = [-h for h in half] if part["centred"] else [0, 0, 0]
    return low, [a + s for a, s in zip(low, part["size"])]


def vector(v):
    return "<" + ", ".join(repr(float(x)) for x in v) + ">"
