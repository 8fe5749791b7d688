"""Many files to pictures, and a manifest with a row for each picture."""

from __future__ import annotations

import csv
import errno
import hashlib
import io
import json
import os
import shutil
import time
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any, Union

import numpy as np
import selvedge

from . import _native
from ._errors import ClosedError, Error, RenderError

PathLike = Union[str, "os.PathLike[str]"]

# the columns of `selvedge render --manifest`, with their types in a Parquet file
COLUMNS = {
    "file": "string",
    "sha256": "string",
    "view": "string",
    "output": "string",
    "status": "string",
    "error": "string",
    "camera": "string",
    "faces": "int64",
    "instances": "int64",
    "warnings": "int64",
    "complete": "bool",
    "clamps": "int64",
    "read_s": "double",
    "upload_s": "double",
    "draw_s": "double",
}
EMPTY = {name: "" if kind == "string" else None for name, kind in COLUMNS.items()}
# what costs a file or a picture, and not the run
FAILURES = (Error, OSError, RuntimeError, ValueError)


def render_files(
    files: Iterable[PathLike],
    output: PathLike,
    views: Sequence[str] = ("iso",),
    *,
    arrays: Mapping[str, PathLike] | None = None,
    manifest: PathLike | None = None,
    skip_existing: bool = False,
    fail_fast: bool = False,
    strict: bool = False,
    search: Sequence[PathLike] = (),
    limit_mib: float | None = None,
    limit_s: float | None = None,
    ahead: int = 3,
    renderer: selvedge.Renderer | None = None,
    **settings: Any,
) -> list[dict[str, Any]]:
    """Draws files from standard views into PNG files, and writes a manifest with a row for each picture.

    output: where the pictures go. {stem} stands for a file's name without folder and ending, {view} for the view's.
    arrays: images beside the colour by name, as in Renderer.render, and where their .npy files go: the same patterns.
    manifest: a .csv file, which has each row as soon as the picture is written, or a .parquet file, which is written at
        the end and needs pyarrow. It takes the place of an old one when the renderer is open.
    skip_existing: files of which every output is there are left alone. The old manifest is read: their pictures keep
        the facts of their rows there, but for rows that failed. Rows of other pictures are left out, and so is half a
        last row of a run that was killed; a RuntimeWarning says so.
    fail_fast: the first failure is raised. Without it a file or picture that fails has a row that says why, and the
        others are drawn. A picture that shows nothing of its model has failed.
    strict, search, limit_mib: as in open.
    limit_s: most seconds of work on a file: to read it, to prepare it and to draw its pictures. Beyond, the file is a
        ReadError or its next pictures are a RenderError. A frame that the device has begun is drawn to its end.
    ahead: as in Renderer.render_many. The next file is read while pictures are drawn, so at most ahead + 2 models are
        in memory.
    renderer: the one that draws; without it one is made and closed.
    settings: other arguments of Renderer.render, as size=(512, 512), the same for all pictures.

    Returns the rows, each a dict: file, sha256, view, output, status ("drawn", "skipped" or "failed"), error, camera
    (JSON, as Picture.camera), faces, instances, warnings, complete, clamps, and the seconds read_s, upload_s and
    draw_s. Numbers of pictures that are not drawn are None, and empty in the CSV file, where no old manifest has them.
    The CSV file has the rows of skipped files first.

    Raises ValueError or TypeError for wrong arguments, for two outputs in one place and for an old manifest of other
    columns, FileNotFoundError for a folder that is not there, ImportError where pyarrow is missing, all before anything
    is drawn; ClosedError. After Ctrl-C the manifest has the rows so far, and those of all skipped files.
    """
    if isinstance(files, (str, bytes, os.PathLike)) or isinstance(views, str):
        raise TypeError("files and views are lists, as in render_files([file], output, [view])")
    views, arrays = list(views), dict(arrays or {})
    if ahead < 1:
        raise ValueError(f"ahead must be at least 1, not {ahead}")
    unknown = settings.keys() - (selvedge._DEFAULTS.keys() - {"view", "camera", "outputs"})
    if unknown:
        raise TypeError(f"render_files has no argument {', '.join(sorted(unknown))}")
    selvedge._check_limits(limit_mib=limit_mib, limit_s=limit_s)
    reading = {"strict": strict, "search": search, "limit_mib": limit_mib, "limit_s": limit_s}
    asked = {**selvedge._DEFAULTS, **settings, "outputs": list(arrays)}
    for view in views:
        _native.validate({**asked, "view": view})
    tasks = _tasks([os.fspath(file) for file in files], output, views, arrays, manifest)
    todo = [not (skip_existing and all(shot.is_there() for shot in shots)) for shots in tasks.values()]
    every = [shot for shots in tasks.values() for shot in shots]
    skipped = [shot for shots, wanted in zip(tasks.values(), todo) if not wanted for shot in shots]
    rows = _Rows(manifest, skipped, _old(manifest, every) if skip_existing else {})
    waiting: deque[_Shot] = deque()
    own: selvedge.Renderer | None = None

    def finish(shot: _Shot) -> None:
        failure = shot.finish()
        rows.add(shot.row)
        if failure is not None and fail_fast:
            raise failure

    try:
        if renderer is None and any(todo):
            renderer = own = selvedge.Renderer()
        elif renderer is not None and renderer.closed and any(todo):
            raise ClosedError("the renderer was closed")
        rows.begin()
        for (file, shots), wanted in zip(tasks.items(), todo):
            opened = _Opened(file, reading) if wanted else None
            for shot in shots:
                if opened is not None:
                    shot.order(renderer, opened, asked)
                waiting.append(shot)
                if len(waiting) > ahead:
                    finish(waiting.popleft())
        while waiting:
            finish(waiting.popleft())
    finally:
        for shot in waiting:
            shot.cancel()
        rows.close()
        if own is not None:
            own.close()
    return rows.all


class _Opened:
    """A file that was read, or why it was not."""

    def __init__(self, file: str, reading: Mapping[str, Any]):
        self.model: _native.Model | None = None
        self.failure: Exception | None = None
        try:
            begun = time.perf_counter()
            model = selvedge.open(file, **reading)
            read_s = time.perf_counter() - begun
            self.limits = _native.Limits(file, reading["limit_s"], read_s)
            self.facts = {
                "read_s": read_s,
                "sha256": _sha256(file),
                "faces": len(model.faces),
                "instances": len(model.instances),
                "warnings": len(model.warnings),
                "complete": model.complete,
            }
            self.model = model
        except FAILURES as error:
            self.failure = error


class _Shot:
    """A picture of a file, where it goes, and its row of the manifest."""

    def __init__(self, file: str, view: str, output: str, arrays: dict[str, str]):
        self.view, self.output, self.arrays = view, output, arrays
        self.row: dict[str, Any] = {**EMPTY, "file": file, "view": _word(view), "output": output, "status": "skipped"}
        self._facts: dict[str, Any] = {}
        self._pending: _native.Pending | None = None
        self._failure: Exception | None = None

    def is_there(self) -> bool:
        return all(os.path.isfile(path) for path in (self.output, *self.arrays.values()))

    def order(self, renderer: selvedge.Renderer | None, opened: _Opened, asked: dict[str, Any]) -> None:
        if opened.model is None:
            self._failure = opened.failure
            return
        try:
            self._facts = opened.facts
            self._pending = renderer._native.submit(opened.model, {**asked, "view": self.view}, opened.limits)
        except ClosedError:
            raise
        except FAILURES as error:  # no camera shows this model
            self._failure = error

    def finish(self) -> Exception | None:
        """Waits for the picture, writes it and fills its row; returns why that failed."""
        if self._pending is not None:
            try:
                picture = self._pending.result()
                stats = picture.stats
                if stats["blank"]:  # the views show all of a model: its solids leave no surface
                    raise RenderError(f"{self.row['file']}: nothing is seen with all of it in the picture")
                for name, path in self.arrays.items():
                    with _whole(path) as beside:
                        np.save(beside, picture.images[name])
                with _whole(self.output) as beside:
                    picture.save(beside)
                self.row.update(self._facts, status="drawn", camera=json.dumps(picture.camera, separators=(",", ":")))
                self.row.update({name: stats[name] for name in ("clamps", "upload_s", "draw_s")})
            except ClosedError:
                raise
            except FAILURES as error:
                self._failure = error
        if self._failure is not None:
            self.row.update(status="failed", error=str(self._failure))
        return self._failure

    def cancel(self) -> None:
        if self._pending is not None:
            self._pending.cancel()


class _Rows:
    """The rows so far. A CSV file has each at once, a Parquet file all of them at the end; both begin with `begin`."""

    def __init__(self, manifest: PathLike | None, skipped: Iterable[_Shot], old: Mapping[_Key, dict[str, Any]]):
        self.all: list[dict[str, Any]] = []
        # of skipped files, which the table has from the beginning
        self._skipped = deque(shot.row for shot in skipped)
        self._file: IO[str] | None = None
        self._parquet: Any = None
        self._path = "" if manifest is None else os.fspath(manifest)
        self._begun = False
        for row in self._skipped:
            facts = old.get(_key(row), {})
            row.update({name: cell for name, cell in facts.items() if name not in ("status", "error")})
        if manifest is None:
            return
        if _is_parquet(self._path):
            self._parquet = _pyarrow()
        else:
            self._path = os.path.realpath(self._path)  # a link leads where it led
            if os.path.exists(self._path) and not os.access(self._path, os.W_OK):
                raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), self._path)
            self._file = open(_beside(self._path), "w", encoding="utf-8", newline="")
            with suppress(FileNotFoundError):
                shutil.copymode(self._path, _beside(self._path))
            self._line(COLUMNS)
            for row in self._skipped:
                self._cells(row)

    def begin(self) -> None:
        """Puts a CSV file in the place of an old one; rows are added to it there."""
        if self._file is not None:
            os.fsync(self._file.fileno())
            # some systems rename no file that is open
            self._file.close()
            os.replace(_beside(self._path), self._path)
            self._file = open(self._path, "a", encoding="utf-8", newline="")
        self._begun = True

    def add(self, row: dict[str, Any]) -> None:
        self.all.append(row)
        if row["status"] == "skipped":
            self._skipped.popleft()
        else:
            self._cells(row)

    def _cells(self, row: dict[str, Any]) -> None:
        self._line({True: "true", False: "false"}[cell] if isinstance(cell, bool) else cell for cell in row.values())

    def _line(self, cells: Iterable[Any]) -> None:
        if self._file is not None:
            csv.writer(self._file, lineterminator="\n").writerow(cells)
            self._file.flush()

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
            if not self._begun:
                with suppress(FileNotFoundError):
                    os.unlink(_beside(self._path))
        if self._parquet is not None and self._begun:
            pa, pq = self._parquet
            schema = pa.schema([(name, pa.type_for_alias(kind)) for name, kind in COLUMNS.items()])
            with _whole(self._path) as beside:
                pq.write_table(pa.Table.from_pylist([*self.all, *self._skipped], schema=schema), beside)


# the picture of a row: its file, view and output
_Key = tuple[str, str, str]


def _key(row: Mapping[str, Any]) -> _Key:
    return row["file"], row["view"], row["output"]


def _is_parquet(manifest: PathLike) -> bool:
    ending = Path(manifest).suffix.lower()
    if ending not in (".parquet", ".csv"):
        raise ValueError(f"{manifest}: a manifest is CSV or Parquet, so its name ends in .csv or .parquet")
    return ending == ".parquet"


def _old(manifest: PathLike | None, shots: Iterable[_Shot]) -> dict[_Key, dict[str, Any]]:
    """The rows of an old manifest by their pictures, without those that failed."""
    if manifest is None:
        return {}
    is_parquet, path = _is_parquet(manifest), os.fspath(manifest)
    if not os.path.isfile(path):
        return {}
    rows = _old_parquet(path) if is_parquet else _old_csv(path)
    old = {_key(row): row for row in rows if row["status"] != "failed"}
    left = len(old.keys() - {_key(shot.row) for shot in shots})
    if left:
        text = f"{path}: {left} rows are of pictures that this call does not have: they are left out"
        warnings.warn(text, RuntimeWarning, stacklevel=3)
    return old


def _old_parquet(path: str) -> list[dict[str, Any]]:
    _, pq = _pyarrow()
    table = pq.read_table(path)
    _check_columns(path, table.column_names)
    return table.to_pylist()


def _old_csv(path: str) -> list[dict[str, Any]]:
    with open(path, "rb") as source:
        text = source.read()
    whole = text.rfind(b"\n") + 1
    try:
        lines = list(csv.reader(io.StringIO(text[:whole].decode(), newline="")))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{path}: {error}") from error
    # lines of a quoted cell end before its row does
    is_torn = len(lines) > 1 and len(lines[-1]) != len(COLUMNS)
    if is_torn:
        lines.pop()
    if is_torn or whole < len(text):
        told = f"{path}: the last row has no end, as if a run was killed: it is left out"
        warnings.warn(told, RuntimeWarning, stacklevel=4)
    if lines:
        _check_columns(path, lines[0])
    rows = []
    for number, cells in enumerate(lines[1:], 1):
        try:
            if len(cells) != len(COLUMNS):
                raise ValueError(f"{len(cells)} cells of {len(COLUMNS)}")
            rows.append({name: READ[kind](cell) for (name, kind), cell in zip(COLUMNS.items(), cells)})
        except ValueError as error:
            raise ValueError(f"{path}: row {number}: {error}") from error
    return rows


def _truth(cell: str) -> bool:
    if cell not in ("true", "false"):
        raise ValueError(f"neither true nor false: {cell}")
    return cell == "true"


def _optional(read: Callable[[str], Any]) -> Callable[[str], Any]:
    return lambda cell: read(cell) if cell else None


# how a cell of a CSV file is read
READ = {"string": str, "int64": _optional(int), "bool": _optional(_truth), "double": _optional(float)}


def _check_columns(path: str, columns: Sequence[str]) -> None:
    if list(columns) != list(COLUMNS):
        text = "the columns are not those of a manifest of this version, and skip_existing would lose the rows"
        raise ValueError(f"{path}: {text}: move the file away or name another")


def _beside(path: str) -> str:
    """A name beside the path, of a file that is not in its place yet."""
    folder, name = os.path.split(path)
    return os.path.join(folder, f".part-{name}")


@contextmanager
def _whole(path: str) -> Iterator[str]:
    """A name beside the path: its file takes the place of the path's once it is whole."""
    beside = _beside(path)
    try:
        yield beside
        os.replace(beside, path)
    finally:
        with suppress(FileNotFoundError):
            os.unlink(beside)


def _pyarrow() -> tuple[Any, Any]:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        text = "a Parquet manifest needs the package pyarrow (pip install pyarrow); a .csv manifest needs none"
        raise ImportError(text, name="pyarrow") from error
    return pyarrow, pyarrow.parquet


def _tasks(
    files: list[str], output: PathLike, views: list[str], arrays: dict[str, PathLike], manifest: PathLike | None
) -> dict[str, list[_Shot]]:
    """The pictures of each file. What is written has a folder, and a place of its own that is no file to be read."""
    taken: dict[str, str] = {}
    for file in files:
        if os.path.realpath(file) in taken:
            raise ValueError(f"{file} is named twice")
        taken[os.path.realpath(file)] = f"the file {file}, which is read,"

    def claim(path: str, what: str) -> None:
        folder = os.path.dirname(path) or "."
        if not os.path.isdir(folder):
            raise FileNotFoundError(f"{path}: there is no folder {folder}")
        if os.path.realpath(path) in taken:
            other = taken[os.path.realpath(path)]
            raise ValueError(f"{path}: {other} and {what} have one place; {{stem}} and {{view}} tell outputs apart")
        taken[os.path.realpath(path)] = what

    def place(pattern: PathLike, file: str, view: str, ending: str, what: str) -> str:
        path = os.fspath(pattern).replace("{stem}", Path(file).stem).replace("{view}", _word(view))
        if not path.endswith(ending):
            raise ValueError(f"{path}: what is written here ends in {ending}")
        claim(path, f"{what} of {file}, {view},")
        return path

    if manifest is not None:
        claim(os.fspath(manifest), "the manifest")
    shots = {}
    for file in files:
        shots[file] = [
            _Shot(
                file,
                view,
                place(output, file, view, ".png", "the picture"),
                {name: place(pattern, file, view, ".npy", name) for name, pattern in arrays.items()},
            )
            for view in views
        ]
    return shots


def _word(view: str) -> str:
    """A view in names of files: "30,20" is 30_20."""
    return "_".join(word.strip() for word in view.split(","))


def _sha256(file: str) -> str:
    digest = hashlib.sha256()
    with open(file, "rb") as source:
        while piece := source.read(1 << 20):
            digest.update(piece)
    return digest.hexdigest()
