"""The limit surface as B-spline patches, for CAD."""

from __future__ import annotations

import ctypes
import math
from typing import Any, Dict, Iterator, NamedTuple, Tuple

from . import _abi, arrays
from . import _options as options
from ._handle import Handle, call, make


class Patch(NamedTuple):
    """A B-spline patch. Arrays are views: nothing is copied, and they keep the patches alive."""

    #: (nv, nu, 3) doubles: pole (i, j), i along u, is poles[j, i].
    poles: Any
    #: Knots, ascending, nu + degree + 1 and nv + degree + 1 of them.
    knots_u: Any
    knots_v: Any
    degree_u: int
    degree_v: int
    #: The control faces whose surface it is.
    faces: Any
    #: Per side (first v, last u, last v, first u) the patch beyond it and which side of that; `welt.NONE` at the border.
    neighbours: Tuple[int, ...]
    neighbour_sides: Tuple[int, ...]
    #: Per corner, whether an extraordinary vertex lies there, beside which the patch is an approximation.
    irregular: Tuple[bool, ...]
    #: Greatest distance to the limit surface that was found, in model units; 0 where the patch is exact.
    deviation: float


class Patches(Handle):
    """The limit surface as bicubic B-spline patches. Made by `Mesh.patches`; never changes. A sequence of `Patch`."""

    _free = "welt_patches_free"
    _kind = "patches"

    def __len__(self) -> int:
        return int(call("welt_patches_count", self))

    def __getitem__(self, index: int) -> Patch:
        if not 0 <= index < len(self):
            raise IndexError(f"there is no patch {index} of {len(self)}")
        found = _abi.Patch()
        call("welt_patches_get", self, index, ctypes.byref(found))
        nu, nv = found.pole_count_u, found.pole_count_v
        return Patch(
            self._view(found.poles, arrays.DOUBLE, nv, nu, 3),
            self._view(found.knots_u, arrays.DOUBLE, nu + found.degree_u + 1),
            self._view(found.knots_v, arrays.DOUBLE, nv + found.degree_v + 1),
            found.degree_u,
            found.degree_v,
            self._view(found.faces, arrays.INDEX, found.face_count),
            tuple(found.neighbours),
            tuple(found.neighbour_sides),
            tuple(map(bool, found.irregular)),
            found.deviation,
        )

    def __iter__(self) -> Iterator[Patch]:
        return (self[i] for i in range(len(self)))

    def _view(self, first: Any, kind: Any, *shape: int) -> Any:
        memory = arrays.memory(first, kind, math.prod(shape), self._owner)
        return arrays.shaped(memory, kind, shape, readonly=True)

    def report(self) -> Dict[str, Any]:
        """Numbers of patches, exact and approximate; the greatest deviation and angle between normals along a side."""
        return options.report(make("welt_patches_report", self))
