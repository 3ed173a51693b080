"""Failures as exceptions."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Optional, Tuple

from ._abi import CONSTANTS
from ._library import raw


class Place(NamedTuple):
    """A place that an error speaks of: an element of a mesh, or a place in a text, or both."""

    #: "vertex", "edge", "face", or "whole" for the input as a whole.
    kind: str
    #: One number for a vertex and a face, two for the vertices of an edge; 0-based.
    ids: Tuple[int, ...]
    #: What is wrong there.
    message: str
    #: The file, or None.
    file: Optional[str]
    #: Line and column in bytes, 1-based, or None.
    line: Optional[int]
    column: Optional[int]

    def __str__(self) -> str:
        text = ":".join(str(part) for part in (self.file, self.line, self.column) if part is not None)
        element = f"{self.kind} {','.join(map(str, self.ids))}" if self.ids else ""
        return ": ".join(part for part in (text, element, self.message) if part)


class Error(Exception):
    """A call failed; what it was to change is as it was before.

    `code` is one of the numbers WELT_ERROR_* of the C ABI, `message` one line that says what went wrong and what to do,
    `places` what it speaks of.
    """

    code: int = 0

    def __init__(self, message: str, places: Tuple[Place, ...] = (), code: Optional[int] = None) -> None:
        super().__init__(message)
        self.message = message
        self.places = places
        if code is not None:
            self.code = code


class ArgumentError(Error, ValueError):
    """An argument has a value outside its range, or does not fit the others."""

    code = CONSTANTS["WELT_ERROR_ARGUMENT"]


class MeshError(Error, ValueError):
    """The polygons are no surface: each place is one defect."""

    code = CONSTANTS["WELT_ERROR_MESH"]


class CancelledError(Error):
    """The job was cancelled."""

    code = CONSTANTS["WELT_ERROR_CANCELLED"]


class TooLargeError(Error, MemoryError):
    """The result would have more elements than 31 bits can number."""

    code = CONSTANTS["WELT_ERROR_TOO_LARGE"]


class BufferTooSmallError(Error):
    """A buffer is too small. Methods of this package make them large enough."""

    code = CONSTANTS["WELT_ERROR_BUFFER"]


class PoisonedError(Error):
    """The handle was left half changed by a call that met a defect of the library; it can only be closed."""

    code = CONSTANTS["WELT_ERROR_POISONED"]


class InternalError(Error):
    """A defect of the library; please report it."""

    code = CONSTANTS["WELT_ERROR_INTERNAL"]


class FileError(Error, OSError):
    """A file cannot be read or written."""

    code = CONSTANTS["WELT_ERROR_FILE"]


class ParseError(Error, ValueError):
    """A text or a file cannot be understood: places have file, line and column."""

    code = CONSTANTS["WELT_ERROR_SYNTAX"]


class RuleError(Error):
    """A rule failed, or rules do not end, or a mark is left where that is an error: the message names rule and place."""

    code = CONSTANTS["WELT_ERROR_RULE"]


class OutOfMemoryError(Error, MemoryError):
    """There is no memory for a large list; nothing was changed."""

    code = CONSTANTS["WELT_ERROR_MEMORY"]


_CLASSES = {kind.code: kind for kind in Error.__subclasses__()}
_KINDS = {CONSTANTS["WELT_PLACE_" + kind.upper()]: kind for kind in ("whole", "vertex", "edge", "face")}


def _place(error: Any, index: int) -> Place:
    ids = (raw("welt_error_place_id", error, index, which) for which in (0, 1))
    return Place(
        _KINDS.get(raw("welt_error_place_kind", error, index), "whole"),
        tuple(i for i in ids if i != CONSTANTS["WELT_NONE"]),
        raw("welt_error_place_message", error, index).decode(),
        raw("welt_error_place_file", error, index).decode() or None,
        raw("welt_error_place_line", error, index) or None,
        raw("welt_error_place_column", error, index) or None,
    )


def taken(error: ctypes.c_void_p) -> Error:
    """The exception for an error handle, which is freed."""
    try:
        code = raw("welt_error_code", error)
        message = raw("welt_error_message", error).decode()
        places = tuple(_place(error, i) for i in range(raw("welt_error_place_count", error)))
    finally:
        raw("welt_error_free", error)
    return _CLASSES.get(code, Error)(message, places, code)
