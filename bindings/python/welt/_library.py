"""Finds and loads the shared library, and calls its functions."""

from __future__ import annotations

import ctypes
import os
import sys
from typing import Any, Callable, Dict, List, Tuple

from . import _abi


class LibraryError(ImportError):
    """The shared library is missing, or is not one that this package knows; the message says what to do."""


NAME = {"win32": "welt.dll", "darwin": "libwelt.dylib"}.get(sys.platform, "libwelt.so")
SONAME = NAME + ".0" if NAME == "libwelt.so" else NAME
REMEDY = "install the package anew with `pip install ./bindings/python`, or set WELT_LIBRARY to the file of the library"


def candidates() -> List[str]:
    """Where the library may be: what WELT_LIBRARY names and nothing else; or in the package, beside it, in the system."""
    named = os.environ.get("WELT_LIBRARY")
    if named:
        return [os.path.join(named, NAME) if os.path.isdir(named) else named]
    package = os.path.dirname(os.path.abspath(__file__))
    files = [os.path.join(folder, NAME) for folder in (package, os.path.dirname(package))]
    return [file for file in files if os.path.exists(file)] + [SONAME]


def load() -> Tuple[ctypes.CDLL, str]:
    """The library and its file."""
    failures = []
    for file in candidates():
        try:
            return ctypes.CDLL(file), file
        except OSError as error:
            failures.append(f"{file}: {error}")
    raise LibraryError(f"the welt library cannot be loaded ({'; '.join(failures)}); {REMEDY}")


def bind(library: Any, file: str) -> Dict[str, Tuple[Callable[..., Any], _abi.Function]]:
    """The functions of a library, after a check that it is one this package was written for."""
    try:
        compatible = library.welt_is_compatible
        version = library.welt_version_string
    except AttributeError:
        raise LibraryError(f"{file} is no welt library; {REMEDY}") from None
    version.restype = ctypes.c_char_p
    if not compatible(ctypes.c_uint32(_abi.VERSION), ctypes.c_uint32(_abi.ABI_VERSION)):
        raise LibraryError(
            f"{file} is welt {version().decode()}, whose binary interface is not that of this package "
            f"({_abi.VERSION >> 16}.{_abi.VERSION >> 8 & 255}.{_abi.VERSION & 255}, interface {_abi.ABI_VERSION}); {REMEDY}"
        )
    table = {}
    for name, function in _abi.functions().items():
        try:
            pointer = getattr(library, name)
        except AttributeError:
            raise LibraryError(f"{file} lacks {name}: it is older than this package; {REMEDY}") from None
        pointer.restype, pointer.argtypes = function.result, function.arguments
        table[name] = (pointer, function)
    return table


FILE: str
_library, FILE = load()
FUNCTIONS = bind(_library, FILE)


def raw(name: str, *arguments: Any) -> Any:
    """Calls a function as it is."""
    return FUNCTIONS[name][0](*arguments)
