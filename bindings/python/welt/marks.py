"""Marked edges and rule sets."""

from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Tuple, Union

from . import _options as options
from . import arrays
from ._handle import Handle, call, make

if TYPE_CHECKING:
    from .mesh import Mesh


class Selection(Handle):
    """Marked edges: which edges of a mesh a feature crosses, and where. Made by `Mesh.select`; never changes."""

    _free = "welt_selection_free"
    _kind = "selection"

    def __len__(self) -> int:
        """Number of marked edges, those of curves not counted."""
        return int(call("welt_selection_count", self))

    def edges(self, mesh: Mesh) -> Tuple[Any, Any]:
        """(k, 2) vertices of the marked edges of the mesh it was made on, and (k,) places, in (0, 1) from the first vertex."""
        count = len(self)
        ends, places = arrays.Made(arrays.INDEX, count, 2), arrays.Made(arrays.DOUBLE, count)
        call("welt_selection_edges", self, mesh, ends.pointer, ends.capacity, places.pointer, places.capacity)
        return ends.array, places.array


class Parameter(NamedTuple):
    """A number that rules declare."""

    name: str
    #: Such as length, angle or count.
    unit: str
    help: str
    default: float
    #: The least and the greatest value; they may be infinite.
    low: float
    high: float


class Rules(Handle):
    """A rule set. Never changes."""

    _free = "welt_rules_free"
    _kind = "rule set"

    def __init__(self, path: Union[str, os.PathLike[str]]) -> None:
        """Loads a rule file and checks it. Raises FileError, or ParseError: each place has file, line and column."""
        name = os.fspath(path).encode()
        self._take_over(make("welt_rules_load", name, len(name)))

    @classmethod
    def linear(cls) -> Rules:
        """The rules of linear features that come with the library."""
        return cls._adopt(make("welt_rules_linear"))

    @property
    def parameters(self) -> List[Parameter]:
        """The parameters that the rules declare."""
        result = []
        for index in range(call("welt_rules_parameter_count", self)):
            low, high = ctypes.c_double(), ctypes.c_double()
            call("welt_rules_parameter_range", self, index, ctypes.byref(low), ctypes.byref(high))
            name, unit, text = (call(f"welt_rules_parameter_{part}", self, index).decode() for part in ("name", "unit", "help"))
            default = float(call("welt_rules_parameter_default", self, index))
            result.append(Parameter(name, unit, text, default, low.value, high.value))
        return result


def features() -> List[Dict[str, Any]]:
    """The features that `Mesh.apply` knows: each with name, help and parameters, which have name, unit ("length" or "count"),
    default (a number in model units, or a text such as "30%"), low, high (None where only the mesh sets a bound) and help."""
    return options.report(make("welt_feature_list"))  # type: ignore[return-value]
