"""Exceptions of the package."""

from __future__ import annotations

__all__ = ["ClosedError", "DeviceError", "Error", "MissingFileError", "ReadError", "RenderError"]


class Error(Exception):
    """Base class of all exceptions that are the package's own."""


class ReadError(Error):
    """A file gives no model.

    file: the file as messages name it. line: the line at fault, counted from 1, or None.
    entity: the number of the entity at fault (of STEP's #123 it is 123), or None.
    """

    def __init__(self, message: str, file: str | None = None, line: int | None = None, entity: int | None = None):
        super().__init__(message)
        self.file = file
        self.line = line
        self.entity = entity


class MissingFileError(ReadError, FileNotFoundError):
    """There is no such file; a FileNotFoundError, too."""


class DeviceError(Error):
    """There is no usable Vulkan device."""


class RenderError(Error):
    """A model cannot be drawn, or the device failed."""


class ClosedError(Error):
    """The renderer was closed."""
