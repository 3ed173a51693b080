"""Arrays on their way in and out: numpy arrays where numpy is present, else memory views.

What comes out has the same shape either way. Without numpy it is a `memoryview` of that shape: `a[i, j]`, `a.tolist()`.
"""

from __future__ import annotations

import array
import ctypes
from typing import Any, Iterable, Optional, Sequence, Tuple, Union

from .errors import ArgumentError

try:
    import numpy
except ImportError:
    numpy = None  # type: ignore[assignment,unused-ignore]

#: Whatever numpy.asarray takes; nested sequences without numpy.
ArrayLike = Union[Sequence[Any], Iterable[Any], memoryview, Any]

# The ctypes type, numpy's name and the format of `array` of what arrays hold.
DOUBLE = (ctypes.c_double, "f8", "d")
FLOAT = (ctypes.c_float, "f4", "f")
INDEX = (ctypes.c_uint32, "u4", "I")


def _flat(values: Any) -> Iterable[Any]:
    if isinstance(values, memoryview):
        values = values.tolist()
    for value in values:
        if hasattr(value, "__iter__") and not isinstance(value, (str, bytes)):
            yield from _flat(value)
        else:
            yield value


def _numbers(values: Any, kind: Tuple[Any, str, str], what: str) -> Tuple[Any, int, Any]:
    """Address, number of elements, and what keeps the memory alive."""
    if numpy is not None:
        given = numpy.asarray(values)
        if kind is INDEX and given.size:
            if given.dtype.kind not in "iu":
                raise ArgumentError(f"{what} must be whole numbers, not {given.dtype}")
            if given.min() < 0 or given.max() > 0xFFFFFFFF:
                raise ArgumentError(f"{what} must be numbers from 0 to 4294967295")
        flat = numpy.ascontiguousarray(given, dtype=kind[1])
        return flat.ctypes.data, flat.size, flat
    if isinstance(values, memoryview) and values.format == kind[2] and values.c_contiguous and not values.readonly:
        size = values.nbytes // values.itemsize
        held: Any = (kind[0] * size).from_buffer(values) if size else values
        return (ctypes.addressof(held) if size else 0), size, held
    held = array.array(kind[2], _flat(values))
    return held.buffer_info()[0], len(held), held


class Given:
    """An array that is passed in: `pointer` for the call, `count` of elements of `width` numbers each."""

    def __init__(self, values: ArrayLike, kind: Tuple[Any, str, str], width: int, what: str) -> None:
        try:
            address, size, self._held = _numbers(values, kind, what)
        except ArgumentError:
            raise
        except (TypeError, ValueError, OverflowError) as error:
            raise ArgumentError(f"{what}: {error}") from None
        if size % width:
            raise ArgumentError(f"{what} must have {width} numbers each, but has {size} in all")
        self.count = size // width
        # An empty array must not be NULL: that would stand for the default.
        self._room = (kind[0] * max(size, 1)).from_address(address) if size else (kind[0] * 1)()
        self.pointer = ctypes.cast(self._room, ctypes.POINTER(kind[0]))


def doubles(values: ArrayLike, width: int, what: str) -> Given:
    return Given(values, DOUBLE, width, what)


def floats(values: ArrayLike, what: str) -> Given:
    return Given(values, FLOAT, 1, what)


def indices(values: ArrayLike, width: int, what: str) -> Given:
    return Given(values, INDEX, width, what)


def shaped(memory: Any, kind: Tuple[Any, str, str], shape: Tuple[int, ...], readonly: bool = False) -> Any:
    """The array that shows memory of a ctypes array; nothing is copied."""
    if numpy is not None:
        result = numpy.frombuffer(memory, dtype=kind[1]) if len(memory) else numpy.empty(0, dtype=kind[1])
        result = result.reshape(shape)
        if readonly:
            result.flags.writeable = False
        return result
    view: Any = memoryview(memory).cast("B")
    # A memory view cannot have a length of 0 in one of several dimensions.
    view = view.cast(kind[2], shape=list(shape)) if all(shape) else view.cast(kind[2])
    return view.toreadonly() if readonly else view


class Made:
    """An array that a call fills: `pointer` and `capacity` for the call, `array` afterwards."""

    def __init__(self, kind: Tuple[Any, str, str], *shape: int) -> None:
        self.capacity = 1
        for length in shape:
            self.capacity *= length
        self.pointer = (kind[0] * self.capacity)()
        self.array = shaped(self.pointer, kind, shape)


def structs(memory: Any) -> Any:
    """An array of structs that a call filled: with numpy one with named fields, else the ctypes array."""
    if numpy is None:
        return memory
    return numpy.frombuffer(memory, dtype=numpy.dtype(memory._type_)) if len(memory) else numpy.empty(0, memory._type_)


def pointer_or_null(given: Optional[Given]) -> Any:
    return None if given is None else given.pointer


def memory(first: Any, kind: Tuple[Any, str, str], size: int, owner: Any) -> Any:
    """Memory that an owner has, as a ctypes array that keeps it alive."""
    result = (kind[0] * size).from_address(ctypes.addressof(first.contents)) if size else (kind[0] * 0)()
    result.owner = owner
    return result
