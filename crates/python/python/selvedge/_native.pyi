from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

class Model:
    """A model in memory, as ``selvedge.open`` reads it. Lengths are millimetres."""

    @property
    def name(self) -> str:
        """The file's or product's name."""
    @property
    def file(self) -> str:
        """The file as messages name it."""
    @property
    def unit(self) -> str:
        """Length unit of the file; coordinates are millimetres all the same."""
    @property
    def summary(self) -> str:
        """What is drawn of the file and what is missing, in one sentence."""
    @property
    def complete(self) -> bool:
        """Whether all that the file states is there."""
    @property
    def bounds(self) -> NDArray[np.float64]:
        """float64 (2, 3): smallest and largest coordinates of what is drawn, millimetres."""
    @property
    def tree(self) -> dict[str, Any]:
        """The assembly: names, bodies (part, name, count) and children, each like it. Occurrences side by side that
        hold the same are one node with all their names.
        """
    @property
    def parts(self) -> list[Part]:
        """Distinct bodies. In the image "part" they are counted from 1."""
    @property
    def instances(self) -> list[Instance]:
        """Placed bodies. In the image "instance" they are counted from 1."""
    @property
    def faces(self) -> tuple[Face, ...]:
        """Faces of all parts, one part after another."""
    @property
    def edges(self) -> tuple[Edge, ...]:
        """Edges of all parts, one part after another, of each those of faces and then those of meshes. In the image
        "edge" they are counted from 1 in this order. Found when they are first asked for.
        """
    @property
    def warnings(self) -> list[Warning]:
        """What was left out or repaired, in the order in which it was found."""
    def snap(
        self,
        at: tuple[float, float],
        radius: float = 8.0,
        view: str | None = None,
        size: tuple[int, int] = (1920, 1080),
        *,
        camera: Camera | None = None,
        kinds: Sequence[str] | None = None,
    ) -> dict[str, Any] | None:
        """A visible point of the model near a place in a view's picture, to snap to.

        at: (x, y) in pixels from the upper left corner; the first pixel's centre is (0.5, 0.5). size, view, camera: as
        in Renderer.render. radius: pixels. kinds: some of "vertex" (an edge's end), "centre" (of a round edge) and
        "edge"; without it all. A vertex is preferred to a centre, and both to an edge. An edge offers only its point
        nearest to the place.

        Returns a dict: kind, point (millimetres), pixel, distance_px, depth, instance (place in Model.instances) and
        edge (Edge.number); or None if no visible point is near. The search uses double precision and no device.
        """

class Part:
    """A distinct body."""

    @property
    def index(self) -> int:
        """Its place in Model.parts."""
    @property
    def name(self) -> str:
        """Name in the file, or empty."""
    @property
    def closed(self) -> bool:
        """Whether its faces or meshes bound a volume."""
    @property
    def faces(self) -> list[Face]:
        """Its faces."""
    @property
    def meshes(self) -> int:
        """How many meshes it has."""

class Instance:
    """A part placed in the model."""

    @property
    def index(self) -> int:
        """Its place in Model.instances."""
    @property
    def name(self) -> str:
        """Names of the occurrences from the root, with slashes between."""
    @property
    def part(self) -> int:
        """The part that is placed, by its place in Model.parts."""
    @property
    def transform(self) -> NDArray[np.float64]:
        """float64 (4, 4): part to model coordinates, millimetres, for columns: model = transform @ [x, y, z, 1]."""

class Face:
    """A face of a part. Measures are those of the part's own coordinates, millimetres."""

    @property
    def number(self) -> int:
        """Number in the file, which the image "face" holds: of STEP's #123 it is 123."""
    @property
    def part(self) -> int:
        """Its part, by its place in Model.parts."""
    @property
    def kind(self) -> str:
        """What the surface is in the file: plane, cylinder, cone, sphere, torus, revolution, extrusion, offset or
        bspline.
        """
    @property
    def radius(self) -> float | None:
        """Radius of a cylinder or sphere, and of the tube of a torus, millimetres; None of other faces."""
    @property
    def area(self) -> float:
        """Area within the trim loops, square millimetres: integrated when it is asked for, to about 1e-9 of itself."""
    @property
    def loops(self) -> int:
        """Trim loops; 0 for a face that is its whole surface."""
    @property
    def degrees(self) -> tuple[int, int]:
        """Degrees of the surface in u and v."""
    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """((u0, u1), (v0, v1)): where the image "uv" of this face lies."""
    @property
    def colour(self) -> list[float] | None:
        """Red, green, blue, opacity in linear light, if the face has a colour of its own."""
    @property
    def bounds(self) -> NDArray[np.float64]:
        """float64 (2, 3): smallest and largest coordinates, in those of the part, millimetres."""

class Edge:
    """Where faces of a part meet or end, or facets crease."""

    @property
    def number(self) -> int:
        """Its place in Model.edges, plus 1: what the image "edge" holds."""
    @property
    def part(self) -> int:
        """Its part, by its place in Model.parts."""
    @property
    def kind(self) -> str:
        """sharp, smooth, seam (a closed face meets itself) or border (one face ends)."""
    @property
    def length(self) -> float:
        """Length of the curve, millimetres, in the part's coordinates."""
    @property
    def faces(self) -> list[int]:
        """Numbers of the faces that end here, as Face.number; those of meshes for sides of triangles."""
    @property
    def entity(self) -> int | None:
        """Number of the edge in the file, if it has one."""
    @property
    def ends(self) -> NDArray[np.float64]:
        """float64 (2, 3): where it begins and ends, in the part's coordinates, millimetres."""

class Warning:
    """Something in a file that was left out, repaired or guessed."""

    @property
    def file(self) -> str:
        """The file."""
    @property
    def line(self) -> int | None:
        """Line, counted from 1, or None."""
    @property
    def entity(self) -> int | None:
        """Number of the entity, or None."""
    @property
    def message(self) -> str:
        """What was wrong and what was done."""
    @property
    def count(self) -> int:
        """How many occurrences this one stands for."""

class Camera:
    """Where a picture is taken from, for any size: ``Camera.look_at`` or ``Camera.opencv``."""

    @staticmethod
    def look_at(
        eye: Sequence[float],
        target: Sequence[float],
        up: Sequence[float] = (0.0, 0.0, 1.0),
        fov: float | None = None,
        ortho: float | None = None,
    ) -> Camera:
        """A camera at `eye` that looks at `target`.

        eye, target, up: three numbers, millimetres of the model; `up` points up in the picture.
        fov: vertical field of view, degrees. ortho: a parallel view in its place, the picture's height in millimetres.
        """
    @staticmethod
    def opencv(K: ArrayLike, R: ArrayLike, t: ArrayLike, first_pixel: float = 0.0) -> Camera:
        """A calibrated camera as OpenCV has it: a point X of the model is seen at K (R X + t).

        K: (3, 3), [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] in pixels of the picture that is drawn. The first pixel's
        centre is (0, 0); with first_pixel=0.5 it is (0.5, 0.5). fx and fy differ by no more than a factor of two, and
        the principal point lies within 16384 pixels of the picture. R: (3, 3), a rotation from model to camera axes. t:
        three numbers, millimetres.
        """

class Picture:
    """A finished picture: an array for each output, row 0 on top, as an attribute of its name. Renderer.render lists
    them with dtype, shape and unit.
    """

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
    @property
    def images(self) -> dict[str, NDArray[Any]]:
        """The arrays by name: "colour" and the outputs of the picture."""
    @property
    def camera(self) -> dict[str, Any]:
        """eye, target, up, fovy in degrees or ortho (half the height), millimetres; size in pixels."""
    @property
    def stats(self) -> dict[str, Any]:
        """Device, driver, milliseconds of each pass, counts; "clamps" above 0 are places where the promise is not
        kept. "upload_s": seconds in which the model was prepared, before its first picture. "draw_s": seconds of this
        picture; with pictures in flight, since the one before. "blank": no pixel shows anything of the model; known
        with the image of faces, or on a background that hides nothing, else False.
        """
    @property
    def colour(self) -> NDArray[np.uint8]:
        """uint8 (H, W, 4): sRGB and opacity; there in any case"""
    @property
    def depth(self) -> NDArray[np.float32]:
        """float32 (H, W): distance along the view axis, millimetres; +inf is background"""
    @property
    def face(self) -> NDArray[np.uint32]:
        """uint32 (H, W): Face.number; 0 is background"""
    @property
    def uv(self) -> NDArray[np.float32]:
        """float32 (H, W, 2): parameters in the face's domain; NaN is background"""
    @property
    def normal(self) -> NDArray[np.float32]:
        """float32 (H, W, 3): unit outward normal, model axes; 0 is background"""
    @property
    def thickness(self) -> NDArray[np.float32]:
        """float32 (H, W): length of the ray within solids and closed parts, millimetres"""
    @property
    def edge(self) -> NDArray[np.uint32]:
        """uint32 (H, W): Edge.number of the line that covers the pixel; 0 is none. Draws the lines, too"""
    @property
    def part(self) -> NDArray[np.uint32]:
        """uint32 (H, W): place in Model.parts, plus 1; 0 is none"""
    @property
    def instance(self) -> NDArray[np.uint32]:
        """uint32 (H, W): place in Model.instances, plus 1; 0 is none"""
    def save(self, path: str | PathLike[str]) -> None:
        """Writes the colour as a PNG file. Raises ValueError for a name that does not end in .png, and OSError."""
    def _repr_png_(self) -> bytes:
        """The colour as PNG, which notebooks show."""

class Pending:
    """A picture that will be there."""

    def result(self) -> Picture:
        """Waits for the picture; once."""
    def cancel(self) -> None:
        """The picture is not drawn if it is not begun."""

class Limits:
    """The time of a file's pictures, which share it; see ``selvedge.render_files``."""

    def __new__(cls, file: str, most_s: float | None, spent_s: float) -> Limits: ...

class Renderer:
    """A device, and a thread that draws on it; see ``selvedge.Renderer``."""

    def __new__(cls, device: str | None, validation: bool, limit_mib: float | None) -> Renderer: ...
    def submit(self, model: Model, settings: Mapping[str, Any], limits: Limits | None = None) -> Pending:
        """Sends a picture to the device's thread."""
    def close(self) -> None:
        """Frees the device once the pictures sent before are drawn."""
    @property
    def closed(self) -> bool:
        """Whether it was closed."""

def open(
    source: str | PathLike[str] | bytes,
    name: str,
    strict: bool,
    search: Sequence[str],
    limit_mib: float | None,
    limit_s: float | None,
) -> Model:
    """Reads a file or bytes; see ``selvedge.open``."""
def check(renderer: Renderer, model: Model, settings: Mapping[str, Any], judged: int) -> dict[str, Any]:
    """Draws and judges; see ``selvedge.check``."""
def validate(settings: Mapping[str, Any]) -> None:
    """Raises what is wrong with a picture's settings, whatever the model."""
