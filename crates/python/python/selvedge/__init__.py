"""CAD files to exact pictures, depths, normals and face numbers.

    import selvedge

    model = selvedge.open("part.step")
    with selvedge.Renderer() as renderer:
        picture = renderer.render(model, view="iso", size=(1920, 1080), outputs=["depth", "normal", "face"])
    picture.depth                # numpy float32 (H, W), millimetres along the view axis, +inf is background
    picture.save("part.png")

Lengths are millimetres, images have row 0 on top and are sampled at pixel centres.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Union

from . import _kernels, _native
from ._errors import ClosedError, DeviceError, Error, MissingFileError, ReadError, RenderError
from ._files import render_files
from ._native import Camera, Edge, Face, Instance, Model, Part, Picture, Warning

__all__ = [
    "Camera",
    "ClosedError",
    "DeviceError",
    "Edge",
    "Error",
    "Face",
    "Instance",
    "MissingFileError",
    "Model",
    "Part",
    "Picture",
    "ReadError",
    "RenderError",
    "Renderer",
    "Warning",
    "check",
    "open",
    "render_files",
]

Source = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, Any]


def open(
    source: Source,
    *,
    name: str | None = None,
    strict: bool = False,
    search: Sequence[str | os.PathLike[str]] = (),
    limit_mib: float | None = None,
    limit_s: float | None = None,
) -> Model:
    """Reads a model.

    source: a path; the bytes of a file; or a shape of build123d, cadquery or pythonocc, which goes through STEP in memory.
    name: stands for bytes in messages; its ending tells the format where the content does not.
    strict: a file of which anything is left out is refused.
    search: folders in which files that an assembly names are looked for, beside its own.
    limit_mib: most MiB of a file; three quarters of the machine's memory without it.
    limit_s: most seconds for reading it; beyond, it is a ReadError.

    Raises ReadError with file, line and entity; MissingFileError; TypeError for what is none of these. Ctrl-C ends it.
    """
    if isinstance(source, (bytearray, memoryview)):
        source = bytes(source)
    if not isinstance(source, (str, bytes, os.PathLike)):
        step = _kernels.step(source)
        if step is None:
            raise TypeError(f"a path, bytes or a shape of Open CASCADE is read, not {type(source).__name__}")
        source, name = step, name or "shape.step"
    _check_limits(limit_mib=limit_mib, limit_s=limit_s)
    folders = [os.fspath(folder) for folder in search]
    return _native.open(source, name or "bytes", strict, folders, limit_mib, limit_s)


def _check_limits(**limits: float | None) -> None:
    for name, limit in limits.items():
        if limit is not None and not 0.0 < limit < float("inf"):
            raise ValueError(f"{name} must be above 0, not {limit}")


class Renderer:
    """A Vulkan device that draws models; a context manager, which closes it.

    device: part of the device's name; without it a discrete GPU, else an integrated one, else the CPU. Of several
        devices it is the first, and with "#1" behind it the second: "#1" alone is the second of all.
    validation: load Vulkan's validation layer; what it says of a picture is a RenderError.
    limit_mib: most MiB of buffers and images on the device, which never takes more than it has left. A picture that
        needs more is a RenderError.

    Raises DeviceError. Several threads may use one renderer: it draws their pictures in the order in which they ask.
    """

    def __init__(self, device: str | None = None, *, validation: bool = False, limit_mib: float | None = None):
        _check_limits(limit_mib=limit_mib)
        self._native = _native.Renderer(device, validation, limit_mib)

    def render(
        self,
        model: Model,
        view: str | None = None,
        size: tuple[int, int] = (1920, 1080),
        outputs: Sequence[str] = (),
        *,
        camera: Camera | None = None,
        style: str = "shaded",
        curvature_range: float | None = None,
        background: str = "gradient",
        edges: str | None = None,
        silhouettes: bool = False,
        hidden_lines: bool = False,
        line_width: float | None = None,
        samples: int = 1,
        smooth: str | None = None,
        ao: float | str | None = None,
        sun: Sequence[float] | None = None,
        tolerance: float = 0.5,
    ) -> Picture:
        """Draws one picture and waits for it.

        view: iso (the default), front, right, back, left, top, bottom, or "AZIMUTH,ELEVATION" in degrees; as large as the
            model fits. camera: a Camera in its place.
        size: width and height, 1 to 16384 pixels each.
        outputs: images beside the colour, each an attribute of the picture:
            depth      float32 (H, W)     distance along the view axis, millimetres; +inf is background
            face       uint32  (H, W)     Face.number; 0 is background
            uv         float32 (H, W, 2)  parameters in the face's domain; NaN is background
            normal     float32 (H, W, 3)  unit outward normal, model axes; 0 is background
            part       uint32  (H, W)     place in Model.parts, plus 1; 0 is none
            instance   uint32  (H, W)     place in Model.instances, plus 1; 0 is none
            thickness  float32 (H, W)     length of the ray within solids and closed parts, millimetres
            edge       uint32  (H, W)     Edge.number of the line that covers the pixel; 0 is none. Draws the lines, too
            colour     uint8   (H, W, 4)  sRGB and opacity; there in any case
        style: shaded, clay, technical, normals, zebra, isophotes, mean-curvature or gaussian-curvature. background: a CSS
            colour, gradient, or none (transparent).
        curvature_range: the mean curvature at the end of the scale, 1/mm, whose square is that of Gaussian curvature;
            without it a round number at which most of the model's curvatures are told apart.
        edges: lines along "all" edges, the "sharp" ones, or "none". silhouettes: outlines of curved faces and meshes, too.
        hidden_lines: lines behind faces, dashed. line_width: pixels; without it 1 or more, and more in high pictures.
        samples: 1, 4 or 8 of each pixel's colour. smooth: at samples=1, borders that are smooth: "borders" of all faces (the
            default), "trims", those of trimmed faces by exact areas, or "none".
        ao: ambient occlusion at samples=1: nearby surfaces darken each other. The radius, millimetres; "auto", a
            twenty-fifth of the model's diagonal (the default); or "none".
        sun: direction from the model towards a light that casts shadows; without it a studio's light.
        tolerance: largest distance in pixels between a drawn boundary and the true one, at least 0.1.

        Raises ValueError, TypeError, RenderError, ClosedError. Ctrl-C ends it. A model that was drawn by the call before
        is not prepared again.
        """
        settings = dict(locals())
        del settings["self"], settings["model"]
        return self._native.submit(model, settings).result()

    def render_many(self, jobs: Iterable[Mapping[str, Any]], ahead: int = 3) -> Iterator[Picture]:
        """Draws many pictures, and yields them in order: the bytes of each are those of render.

        jobs: the arguments of render as mappings, "model" among them. They are taken while pictures are drawn: a
            generator that opens files reads the next one meanwhile.
        ahead: how many pictures may be drawn or wait beyond the one that is yielded next. Jobs that follow each other
            and differ in view, camera or size alone are drawn together, at most `ahead` and at most three at a time.
            Pictures above 16.8 million pixels, and those of a renderer with validation, are drawn one at a time.

        An exception of a job begins with "job N", counted from 0, and the model's file; its attribute job is N. It is
        raised after the pictures of the jobs before, as is an exception that jobs itself raises; no later job is drawn.
        Ctrl-C ends it at once. Closing the generator, or leaving its loop and dropping it, cancels what is not begun.
        """
        if ahead < 1:
            raise ValueError(f"ahead must be at least 1, not {ahead}")
        return self._many(iter(jobs), ahead)

    def _many(self, jobs: Iterator[Mapping[str, Any]], ahead: int) -> Iterator[Picture]:
        pending: deque[_Ordered] = deque()
        count, failure = 0, None
        more = True
        try:
            while more or pending:
                while more and len(pending) <= ahead:
                    try:
                        pending.append(_Ordered(self, count, next(jobs)))
                        count += 1
                    except StopIteration:
                        more = False
                    except Exception as error:  # after the pictures before
                        failure, more = error, False
                if pending:
                    yield pending.popleft().picture()
        finally:
            for left in pending:
                left.cancel()
        if failure is not None:
            raise failure

    def close(self) -> None:
        """Frees the device once the pictures that were asked for are drawn; later ones raise ClosedError."""
        self._native.close()

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._native.closed

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


_DEFAULTS: dict[str, Any] = dict(Renderer.render.__kwdefaults__ or {})
_DEFAULTS.update(zip(("view", "size", "outputs"), Renderer.render.__defaults__ or ()))


class _Ordered:
    """A job of render_many that the renderer has; its exceptions name it."""

    def __init__(self, renderer: Renderer, number: int, job: Mapping[str, Any]):
        self.name, self.number = f"job {number}", number
        with self._named():
            settings = {**_DEFAULTS, **job}
            if "model" not in settings:
                raise TypeError("render needs a model")
            model = settings.pop("model")
            if isinstance(model, Model):
                self.name += f" ({model.file})"
            unknown = settings.keys() - _DEFAULTS.keys()
            if unknown:
                raise TypeError(f"render has no argument {', '.join(sorted(map(str, unknown)))}")
            self._pending = renderer._native.submit(model, settings)

    def picture(self) -> Picture:
        with self._named():
            return self._pending.result()

    def cancel(self) -> None:
        self._pending.cancel()

    @contextmanager
    def _named(self) -> Iterator[None]:
        try:
            yield
        except Exception as error:
            told = error.args[0] if error.args else type(error).__name__
            error.args = (f"{self.name}: {told}", *error.args[1:])
            error.job = self.number  # type: ignore[attr-defined]
            raise


def check(
    model: Model,
    view: str | None = None,
    size: tuple[int, int] = (640, 480),
    *,
    camera: Camera | None = None,
    judged: int = 20_000,
    tolerance: float = 0.5,
    renderer: Renderer | None = None,
) -> dict[str, Any]:
    """Draws a view and judges the picture against exact rays in double precision.

    judged: pixels that are compared, spread evenly; those at which the face changes are compared in any case.
    renderer: the one that draws; without it one is made and closed.

    The result: kept (the promise), seen (some pixel shows the model), judged, wrong (pixels that break the promise),
    worst_shift_px, tolerance_px, clamps, camera, and judgement with all counts and errors, as `selvedge check --json` has it.
    """
    if judged < 1:
        raise ValueError(f"judged must be at least 1, not {judged}")
    if renderer is None:
        with Renderer() as own:
            return check(model, view, size, camera=camera, judged=judged, tolerance=tolerance, renderer=own)
    settings = {**_DEFAULTS, "view": view, "size": size, "camera": camera, "tolerance": tolerance}
    return _native.check(renderer._native, model, settings, judged)
