"""What calls are told beside meshes and arrays, in the form of the C ABI."""

from __future__ import annotations

import ctypes
import json
import math
from typing import Any, Dict, Mapping, Union

from ._abi import CONSTANTS, BatchOptions, FeatureOptions, ImportOptions, PatchOptions
from ._library import raw
from .errors import ArgumentError


def constant(prefix: str, name: str) -> int:
    """The constant of the C ABI that a word stands for."""
    try:
        return CONSTANTS[prefix + name.upper()]
    except KeyError:
        known = ", ".join(key[len(prefix) :].lower() for key in CONSTANTS if key.startswith(prefix))
        raise ArgumentError(f"{name!r} is none of {known}") from None


def whole(value: int, what: str) -> int:
    """A number that fits 32 bits, which ctypes would cut off."""
    if not 0 <= value <= 0xFFFFFFFF:
        raise ArgumentError(f"{what} must be from 0 to 4294967295, not {value}")
    return value


def chosen(table: Mapping[int, int], value: int, what: str) -> int:
    if value not in table:
        raise ArgumentError(f"{what} must be one of {', '.join(map(str, table))}, not {value}")
    return table[value]


def same(first: int, second: int, rule: str) -> None:
    if first != second:
        raise ArgumentError(f"there must be {rule}, not {first} and {second}")


def importing(repair: bool, weld: float, limits: Mapping[str, int]) -> Any:
    options = ImportOptions()
    raw("welt_import_options_init", options, ctypes.sizeof(options))
    options.repair, options.weld = int(repair), weld
    limit(options, limits)
    return ctypes.byref(options)


def limit(options: ctypes.Structure, limits: Mapping[str, Union[int, float]]) -> None:
    """Sets members max_..., which ctypes would cut off to their bits."""
    known = {field[0]: field[1] for field in options._fields_ if field[0].startswith("max_")}
    for name, most in limits.items():
        if name not in known:
            raise ArgumentError(f"{name!r} is no limit: there are {', '.join(known)}")
        kind = known[name]
        if kind is ctypes.c_double:
            if not most >= 0:
                raise ArgumentError(f"{name} must be 0 or more, not {most}")
        else:
            bits = 8 * ctypes.sizeof(kind)
            if most != most or not 0 <= most < 1 << bits or most != int(most):
                raise ArgumentError(f"{name} must be a whole number from 0 to 2^{bits} - 1, not {most}")
            most = int(most)
        setattr(options, name, most)


def batch(threads: int) -> Any:
    options = BatchOptions()
    raw("welt_batch_options_init", options, ctypes.sizeof(options))
    options.threads = whole(threads, "threads")
    return ctypes.byref(options)


def feature(
    fit: str, parity: str, strict: bool, deviation: bool, limits: Mapping[str, Union[int, float]]
) -> FeatureOptions:
    options = FeatureOptions()
    raw("welt_feature_options_init", options, ctypes.sizeof(options))
    options.fit, options.parity = constant("WELT_FIT_", fit), constant("WELT_PARITY_", parity)
    options.strict, options.deviation = int(strict), int(deviation)
    limit(options, limits)
    return options


def patch(most_faces: int, tolerance: float) -> Any:
    options = PatchOptions()
    raw("welt_patch_options_init", options, ctypes.sizeof(options))
    options.most_faces, options.tolerance = whole(most_faces, "most_faces"), tolerance
    return ctypes.byref(options)


def settings(given: Union[str, Mapping[str, Union[int, float, str]]]) -> bytes:
    """`NAME=VALUE ...` of a mapping; a text is taken as it is."""
    if isinstance(given, str):
        return given.encode()
    for name, value in given.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise ArgumentError(f"{name} must be a finite number, not {value}")
    return " ".join(f"{name}={value}" for name, value in given.items()).encode()


def report(handle: ctypes.c_void_p) -> Dict[str, Any]:
    """The content of a report, which is freed."""
    try:
        return json.loads(raw("welt_report_json", handle))  # type: ignore[no-any-return]
    finally:
        raw("welt_report_free", handle)
