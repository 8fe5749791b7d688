"""Hard cases as scene files: the possible fault of each, and the options of its views.

Sheets are 40 by 30 millimetres, their parameters run from 0 to 1, and a picture of a whole one at 320 x 240 shows it
some 200 pixels wide.
"""

import math
from dataclasses import dataclass, field

DISC = '[curve.disc]\nshape = "circle"\nradius = 1\n'


@dataclass(frozen=True)
class Known:
    """An exception that docs/accuracy.md names, and how far it goes: wrong pixels a judged one, clamps a view."""

    reason: str
    pixels: float = 0.0
    clamps: float = 0.0


@dataclass
class Case:
    name: str
    danger: str
    scene: str
    views: list = field(default_factory=lambda: ["--views", "all"])
    known: Known | None = None


def surface(name, points, extra="", weights=None):
    """A Bézier surface of rows of points."""
    text = f'[surface.{name}]\nshape = "bezier"\npoints = {[[list(map(float, p)) for p in row] for row in points]}\n'
    return text + (f"weights = {weights}\n" if weights else "") + extra


def net(n, m, height, width=40.0, depth=30.0):
    """Points over a rectangle, at heights by column and row."""
    return [
        [(width * (i / (n - 1) - 0.5), depth * (j / (m - 1) - 0.5), height(i, j)) for i in range(n)] for j in range(m)
    ]


def wavy(name, extra="", n=4, height=6.0):
    return surface(name, net(n, n, lambda i, j: height * math.cos(2.4 * i) * math.cos(1.7 * j)), extra)


def spline(name, knots):
    """A wavy bicubic sheet with these knots inside, along u."""
    ends = [0.0] * 4, [1.0] * 4
    points = net(4 + len(knots), 4, lambda i, j: 6.0 * math.cos(1.3 * i) * math.cos(1.7 * j))
    text = surface(name, points).replace('"bezier"', '"bspline"')
    return f"{text}u_knots = {[*ends[0], *knots, *ends[1]]}\nv_knots = {[*ends[0], *ends[1]]}\n"


def doubled():
    """A wavy sheet of degree 4 whose first two columns are equal."""
    rows = net(4, 4, lambda i, j: 6.0 * math.cos(2.4 * i) * math.cos(1.7 * j))
    return [[row[0], *row] for row in rows]


def trimmed(*loops, curves=DISC):
    """A wavy sheet with holes."""
    return wavy("sheet", f"border = true\nloops = [{', '.join(loops)}]\n") + curves


def disc(x, y, r):
    return f'{{ curves = "disc", at = [{x!r}, {y!r}], scale = {r!r} }}'


def polygon(name, points):
    return f'[curve.{name}]\nshape = "polyline"\nclosed = true\npoints = {[list(p) for p in points]}\n'


def bezier(name, points):
    return f'[curve.{name}]\nshape = "bezier"\npoints = {[list(p) for p in points]}\n'


def path(name, points):
    return f'[curve.{name}]\nshape = "polyline"\npoints = {[list(p) for p in points]}\n'


def solid(name, shape, **keys):
    text = lambda v: str(v).lower() if isinstance(v, (bool, list)) else repr(v)
    return f'[solid.{name}]\nshape = "{shape}"\n' + "".join(f"{key} = {text(value)}\n" for key, value in keys.items())


def boolean(expression, name="whole"):
    return f'[solid.{name}]\nshape = "boolean"\nof = "{expression}"\n'


def grid(count, radius):
    step = 1 / count
    return [disc((i + 0.5) * step, (j + 0.5) * step, radius) for i in range(count) for j in range(count)]


def stair(steps):
    """A polygon whose corners lie on v = k / 16."""
    points = [(0.15, 0.125)]
    for k in range(steps):
        points += [(0.25 + 0.6 * k / steps, 0.125 + k / 16), (0.25 + 0.6 * k / steps, 0.125 + (k + 1) / 16)]
    return [*points, (0.15, 0.125 + steps / 16)]


def fan(count, radius):
    """Rays of a star whose edges are nearly parallel to u."""
    return [(0.2 + 0.6 * (k % 2), 0.5 + radius * k * 1e-7) for k in range(count)] + [(0.8, 0.8), (0.2, 0.8)]


def sheets(gap):
    """Two sheets side by side, the second of a higher degree and turned round along their common side."""
    left = [[(-20 + 20 * i / 3, 30 * (j / 3 - 0.5), 5 * math.sin(2 * j / 3)) for i in range(4)] for j in range(4)]
    edge = [row[3] for row in left]
    # the side's degree is raised by one: the same curve
    raised = [
        edge[0],
        *(tuple((k * a + (4 - k) * b) / 4 for a, b in zip(edge[k - 1], edge[k])) for k in (1, 2, 3)),
        edge[3],
    ]
    right = [[(p[0] + gap + 20 * i / 3, p[1], p[2] + 2 * i) for i in range(4)] for p in reversed(raised)]
    both = surface("left", left) + surface("right", right)
    return both + '[part.both]\nsurfaces = ["left", "right"]\n'


# exceptions of docs/accuracy.md
OTHER_DEGREES = Known("untrimmed faces that meet with other degrees may leave a pixel open between them", pixels=1e-3)
INTERPENETRATION = Known("what interpenetrates is a pixel off in a picture", pixels=1e-3)
SLIVERS = Known("slivers narrower than a pixel are a pixel in a picture", pixels=1e-2)
CLAMPS = Known("the promise is void where a frame counts a clamp", clamps=4)
CLOSER = ["--zoom", "1,100,1000000"]
CASES = [
    Case("poles", "collapsed edges, singular normals", solid("ball", "sphere", radius=20, faces=True)),
    Case("tip of a cone", "no normal at the tip", solid("cone", "cone", bottom=15, top=0, height=30, faces=True)),
    Case("seams", "loops across a seam", solid("ring", "torus", major=20, minor=7, faces=True)),
    Case(
        "corners on scan lines", "counted twice or not at all", trimmed('"stair"', curves=polygon("stair", stair(10)))
    ),
    Case("edges along scan lines", "|dv| of 1e-7", trimmed('"fan"', curves=polygon("fan", fan(9, 1.0)))),
    Case(
        "inflection along a scan line",
        "a triple root",
        trimmed(
            '["bend", "back"]',
            curves=bezier("bend", [(0.2, 0.45), (0.4, 0.55), (0.6, 0.45), (0.8, 0.55)])
            + path("back", [(0.8, 0.55), (0.8, 0.9), (0.2, 0.9), (0.2, 0.45)]),
        ),
    ),
    Case(
        "cusp",
        "no direction where the curve turns back",
        trimmed(
            '["cusp", "back"]',
            curves=bezier("cusp", [(0.2, 0.2), (0.8, 0.8), (0.2, 0.8), (0.8, 0.2)])
            + path("back", [(0.8, 0.2), (0.2, 0.2)]),
        ),
    ),
    Case("tangent loops", "two loops share a point", trimmed(disc(0.35, 0.5, 0.15), disc(0.65, 0.5, 0.15))),
    Case("nested loops", "an inner one undoes the outer one", trimmed(*(disc(0.5, 0.5, r) for r in (0.4, 0.25, 0.1)))),
    Case(
        "loops that share a side",
        "a gap or a bridge between two holes",
        trimmed(
            '"left"',
            '"right"',
            curves=polygon("left", [(0.2, 0.2), (0.5, 0.2), (0.5, 0.8), (0.2, 0.8)])
            + polygon("right", [(0.5, 0.2), (0.8, 0.2), (0.8, 0.8), (0.5, 0.8)]),
        ),
    ),
    Case(
        "sliver of 2e-6",
        "a loop a few digits of a float wide",
        trimmed('"thin"', curves=polygon("thin", [(0.1, 0.5), (0.9, 0.5), (0.9, 0.500002), (0.1, 0.500002)])),
    ),
    Case("loop along the border", "a loop touches the domain's edge", trimmed(disc(0.5, 0.25, 0.25))),
    Case("holes of 0.3 pixels", "lost or grown", trimmed(*grid(12, 0.00075))),
    Case(
        "slit of 0.1 pixels",
        "closed, or open too wide",
        trimmed('"slit"', curves=polygon("slit", [(0.1, 0.5), (0.9, 0.5), (0.9, 0.5005), (0.1, 0.5005)])),
    ),
    Case("900 holes in a face", "more crossings than a row holds", trimmed(*grid(30, 0.01))),
    Case("degree 15", "digits lost in high powers", wavy("high", n=16, height=14.0)),
    Case(
        "weights 100:1",
        "points crowd together",
        surface(
            "heavy",
            net(4, 4, lambda i, j: 12.0 * ((i + j) % 2)),
            weights=[[1, 100, 1, 1], [1, 1, 100, 1], [100, 1, 1, 1], [1, 1, 1, 100]],
        ),
    ),
    Case(
        "weights 1,000:1",
        "the same",
        surface(
            "heavier",
            net(4, 4, lambda i, j: 12.0 * ((i + j) % 2)),
            weights=[[1, 0.001, 1, 1], [1, 1, 1000, 1], [1000, 1, 1, 1], [1, 1, 1, 0.001]],
        ),
    ),
    Case("knot span of 1e-9", "a patch of no width", spline("span", [0.5, 0.5 + 1e-9])),
    Case("knot as often as the degree", "a crease", spline("crease", [0.5] * 3)),
    Case("repeated control points", "no direction along a side", surface("thick", doubled())),
    Case("collapsed side", "three corners", surface("fan", [[(0, -15, 0)] * 4, *net(4, 4, lambda i, j: 3.0 * i)[1:]])),
    Case(
        "folded sheet",
        "it hides itself",
        surface("fold", [[(x, 10 * j - 15, z) for x, z in ((-20, 0), (30, 0), (-30, 20), (20, 20))] for j in range(4)]),
    ),
    Case(
        "aspect 200:1",
        "one factor for both sides",
        surface("strip", net(4, 4, lambda i, j: 0.05 * (-1) ** i, width=100.0, depth=0.5)),
    ),
    Case("edge-on", "a silhouette of no width", wavy("flat", height=0.0), ["--eye", "0,-80,0.01", "--target", "0,0,0"]),
    Case(
        "near plane through a patch",
        "control points behind the eye",
        wavy("near"),
        ["--eye", "0,-14,4", "--target", "0,10,-2"],
        CLAMPS,
    ),
    Case(
        "W near 0",
        "a row of control points in the eye's plane",
        wavy("level", height=0.5),
        ["--eye", "0,-4.999999,3", "--target", "0,10,2"],
        CLAMPS,
    ),
    Case("shared side, other degree and direction", "a crack", sheets(0.0), known=OTHER_DEGREES),
    Case("gap of 1e-6", "a crack that the file has", sheets(1e-6), known=OTHER_DEGREES),
    Case("10^6 zoom", "digits of a float", trimmed(disc(0.5, 0.5, 0.2)), CLOSER),
    Case(
        "10^6 offset",
        "0.06 is the last digit of a float",
        trimmed(disc(0.5, 0.5, 0.2)),
        ["--views", "all", "--moved", "1000000,1000000,1000000"],
    ),
    Case(
        "coincident faces",
        "which of two is in front",
        solid("A", "block", size=[20, 20, 20])
        + solid("B", "block", size=[20, 20, 20], at=[20, 0, 0])
        + solid("C", "block", size=[10, 10, 10], at=[5, 5, 10])
        + boolean("(A+B)-C"),
    ),
    Case(
        "sheets that cross",
        "which of two is in front",
        wavy("one") + surface("other", net(4, 4, lambda i, j: 4.0 * math.sin(1.9 * i) - 2.0 * j + 3.0)),
        known=INTERPENETRATION,
    ),
    Case(
        "shells of 0.001",
        "front and back in one pixel",
        solid("A", "sphere", radius=20)
        + solid("B", "sphere", radius=19.999)
        + solid("C", "block", size=[40, 40, 40])
        + boolean("A-B-C"),
    ),
    Case(
        "tangent solids",
        "they touch along a line",
        solid("A", "block", size=[40, 40, 20])
        + solid("B", "cylinder", radius=10, height=40, at=[20, 10, -10])
        + boolean("A-B"),
        known=SLIVERS,
    ),
    Case(
        "overlap of 1e-6",
        "thinner than the tie",
        solid("A", "block", size=[20, 20, 20])
        + solid("B", "block", size=[20, 20, 20], at=[19.999999, 5, 5])
        + boolean("A+B"),
    ),
]


def random_sheets(draw, count):
    """Surfaces of degree 1 to 6, weights up to 30:1, each with up to four loops that do not meet; the loops' number."""
    text, instances, loops, side = "", "", 0, math.ceil(math.sqrt(count))
    for k in range(count):
        n, m = draw.randint(2, 7), draw.randint(2, 7)
        points = net(n, m, lambda i, j: draw.uniform(-5, 5))
        weights = [[round(30 ** draw.uniform(-0.5, 0.5), 6) for _ in range(n)] for _ in range(m)]
        chosen = [quarter for quarter in range(4) if draw.random() < 0.5]
        names = []
        for quarter in chosen:
            name = f"c{k}x{quarter}"
            text += star(draw, name, 0.25 + 0.5 * (quarter % 2), 0.25 + 0.5 * (quarter // 2))
            names.append(f'"{name}"')
        loops += len(chosen)
        extra = f"border = true\nloops = [{', '.join(names)}]\n" if names else ""
        text += surface(f"s{k}", points, extra, weights)
        instances += f'[[instance]]\nof = "s{k}"\nat = [{44.0 * (k % side)}, {34.0 * (k // side)}, 0.0]\n'
    return text + instances, loops


def star(draw, name, x, y):
    """A loop around a point that keeps within its quarter of the domain."""
    many = draw.randint(3, 9)
    turns = [(k + draw.uniform(-0.3, 0.3)) * math.tau / many for k in range(many)]
    radii = [draw.uniform(0.05, 0.2) for _ in turns]
    points = [(round(x + r * math.cos(t), 9), round(y + r * math.sin(t), 9)) for r, t in zip(radii, turns)]
    style = draw.choice(["near", "polyline"])
    if style == "polyline":
        return polygon(name, points)
    return f'[curve.{name}]\nshape = "polyloop"\nstyle = "near"\npoints = {[list(p) for p in points]}\n'


def random_trees(draw, count, leaves):
    """So many Boolean solids side by side, each of so many random primitives (fewest, most); and the leaves' number."""
    text, made, side = "", 0, math.ceil(math.sqrt(count))
    for k in range(count):
        many = draw.randint(*leaves)
        text += random_tree(draw, f"tree{k}", made, many, (80.0 * (k % side), 80.0 * (k // side), 0.0))
        made += many
    return text, made


def random_tree(draw, name, first, leaves, place):
    """A Boolean solid of random primitives and operators; the first is large, so that the result is not empty."""
    tree, text = f"A{first}", solid(f"A{first}", "sphere", radius=25.0, at=list(place))
    for k in range(first + 1, first + leaves):
        at = [round(p + draw.uniform(-22, 22), 6) for p in place]
        turn = [round(draw.uniform(0, 90), 6) for _ in range(3)]
        leaf, size = f"A{k}", lambda: round(draw.uniform(3, 12), 6)
        keys = draw.choice(
            [
                ("block", {"size": [size(), size(), size()]}),
                ("sphere", {"radius": size()}),
                ("cylinder", {"radius": size(), "height": 2 * size()}),
                ("torus", {"major": 12.0 + size(), "minor": size() / 2}),
            ]
        )
        text += solid(leaf, keys[0], at=at, rotate=turn, **keys[1])
        tree = f"({tree}{draw.choice('+--')}{leaf})"
    return text + boolean(tree, name)
