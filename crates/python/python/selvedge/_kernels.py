"""Shapes of other kernels: Open CASCADE's, as build123d, cadquery and pythonocc hold them, go through STEP in memory."""

from __future__ import annotations

import importlib
import os
import tempfile
from typing import Any

# module of the shape's class: where its bindings keep the STEP writer
_BINDINGS = {"OCP.": "OCP", "OCC.Core.": "OCC.Core"}


def unwrapped(source: Any) -> Any:
    """The kernel's shape within an object of build123d or cadquery; other objects as they are."""
    value = getattr(source, "val", None)  # a cadquery Workplane holds its shapes on a stack
    if callable(value) and not hasattr(source, "wrapped"):
        source = value()
    return getattr(source, "wrapped", source)


def step(source: Any) -> bytes | None:
    """The shape as a STEP file; None for what is no shape of a kernel that is known here."""
    shape = unwrapped(source)
    module = type(shape).__module__ + "."
    package = next((package for start, package in _BINDINGS.items() if module.startswith(start)), None)
    if package is None:
        return None
    control = importlib.import_module(f"{package}.STEPControl")
    writer = control.STEPControl_Writer()
    done = importlib.import_module(f"{package}.IFSelect").IFSelect_RetDone
    kind = getattr(control, "STEPControl_AsIs", None)
    if kind is None:  # bindings that keep the names within their enumeration
        kind = control.STEPControl_StepModelType.STEPControl_AsIs
    if writer.Transfer(shape, kind) != done:
        raise ValueError("Open CASCADE cannot write this shape as STEP")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "shape.step")
        if writer.Write(path) != done:
            raise OSError("Open CASCADE cannot write a STEP file")
        with open(path, "rb") as file:
            return file.read()
