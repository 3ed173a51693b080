"""Handles of the library: who owns them, who uses them now, and when they are freed."""

from __future__ import annotations

import ctypes
import threading
import weakref
from typing import Any, List, Optional, Tuple, TypeVar

from . import errors
from ._library import FUNCTIONS, raw

H = TypeVar("H", bound="Handle")


class Owner:
    """One handle of the C ABI, freed when nobody holds its owner: neither the object that made it nor a view of it."""

    def __init__(self, pointer: int, free: str) -> None:
        self.pointer = pointer
        self.lock = threading.Lock()
        self.readers = 0
        self.changing = False
        #: The latest view of memory that a change would move, while somebody has it.
        self.view: Optional[weakref.ref[Any]] = None
        weakref.finalize(self, raw, free, pointer)

    def take(self, change: bool, kind: str) -> None:
        """Begins a call; two that cannot be at the same time are an error, not a race."""
        with self.lock:
            if self.changing or (change and self.readers):
                raise errors.ArgumentError(
                    f"the {kind} is used by another call that has not come back; wait for it, or work on a copy"
                )
            if change and self.view is not None and self.view() is not None:
                raise BufferError(f"a view of the {kind} is in use; delete it or copy it before the {kind} is changed")
            self.readers += not change
            self.changing = change

    def release(self, change: bool) -> None:
        with self.lock:
            self.readers -= not change
            self.changing = False


class Handle:
    """What all objects of the library have in common.

    They are freed when the last reference is gone, by `close()`, or at the end of a `with` block, whichever is first. One
    that is closed raises ArgumentError when it is used. Objects may be passed between threads; several threads may read
    one at the same time.
    """

    _free = ""
    _kind = "handle"
    _owner: Optional[Owner] = None

    @classmethod
    def _adopt(cls: type[H], pointer: ctypes.c_void_p) -> H:
        self = cls.__new__(cls)
        self._take_over(pointer)
        return self

    def _take_over(self, pointer: ctypes.c_void_p) -> None:
        assert pointer.value is not None
        self._owner = Owner(pointer.value, self._free)

    def close(self) -> None:
        """Frees the object, as soon as no view of it is left."""
        self._owner = None

    @property
    def closed(self) -> bool:
        return self._owner is None

    def __enter__(self: H) -> H:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def call(name: str, *arguments: Any) -> Any:
    """Calls a function, handles given as objects and the error left out; raises what it reports."""
    pointer, function = FUNCTIONS[name]
    values = list(arguments)
    used: List[Tuple[Owner, bool]] = []
    try:
        for index, change, kind in function.handles:
            handle = arguments[index]
            if handle is None:
                continue
            if not isinstance(handle, Handle) or handle._free != kind + "_free":
                wanted = kind.replace("welt_", "", 1)
                remedy = ": make one by the method select of the mesh" if wanted == "selection" else ""
                raise TypeError(f"a {wanted} is needed, not {type(handle).__name__}{remedy}")
            owner = handle._owner
            if owner is None:
                raise errors.ArgumentError(f"the {handle._kind} was closed")
            owner.take(change, handle._kind)
            used.append((owner, change))
            values[index] = owner.pointer
        if not function.fails:
            return pointer(*values)
        error = ctypes.c_void_p()
        if pointer(*values, ctypes.byref(error)) == 0:
            return None
    finally:
        for owner, change in used:
            owner.release(change)
    raise errors.taken(error)


def make(name: str, *arguments: Any) -> ctypes.c_void_p:
    """Makes a handle by a function that writes it to its last parameter but the error."""
    made = ctypes.c_void_p()
    call(name, *arguments, ctypes.byref(made))
    return made
