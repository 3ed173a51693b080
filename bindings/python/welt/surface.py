"""Limit surfaces: refinements level by level, and exact queries."""

from __future__ import annotations

import ctypes
import math
from typing import TYPE_CHECKING, Any, Optional, Tuple

from . import _options as options
from . import arrays
from ._abi import CONSTANTS, SurfacePoint
from ._handle import Handle, call, make
from .arrays import ArrayLike
from .errors import BufferTooSmallError

if TYPE_CHECKING:
    from .mesh import Mesh

#: Vectors per point for derivatives up to an order: position; du, dv; duu, duv, dvv.
BATCH_WIDTHS = {0: 1, 1: 3, 2: 6}


class Refinement(Handle):
    """The Catmull-Clark refinements of a mesh, level by level; level 0 is the mesh. Made by `Mesh.refine`; never changes.

    Arrays of positions and face vertices are views: nothing is copied, and they keep the refinement alive.
    """

    _free = "welt_refinement_free"
    _kind = "refinement"

    def vertex_count(self, level: int) -> int:
        return self._count("vertex", level)

    def edge_count(self, level: int) -> int:
        return self._count("edge", level)

    def face_count(self, level: int) -> int:
        return self._count("face", level)

    def _count(self, element: str, level: int) -> int:
        return int(call(f"welt_refinement_{element}_count", self, options.whole(level, "level")))

    def positions(self, level: int) -> Any:
        """(n, 3) doubles, the vertices of a level in model units."""
        count = self.vertex_count(level)
        return self._view("positions", ctypes.c_double, arrays.DOUBLE, level, (count, 3))

    def face_vertices(self, level: int) -> Any:
        """The vertices of the faces of a level, counter-clockwise, 0-based: (m, 4) from level 1; on level 0 those of all faces
        one after the other."""
        count = self._count("face_vertex", level)
        shape = (count // 4, 4) if level else (count,)
        return self._view("face_vertices", ctypes.c_uint32, arrays.INDEX, level, shape)

    def _view(self, what: str, type_: Any, kind: Any, level: int, shape: Tuple[int, ...]) -> Any:
        owner = self._owner
        first = ctypes.POINTER(type_)()
        call(f"welt_refinement_{what}", self, level, ctypes.byref(first))
        memory = arrays.memory(first, kind, math.prod(shape), owner)
        return arrays.shaped(memory, kind, shape, readonly=True)

    def mesh(self, level: int) -> Mesh:
        """A level as a mesh: another control mesh of the same surface, numbered as the level. Its `limit_positions()` are the
        level moved onto the limit surface."""
        from .mesh import Mesh

        result = Mesh._adopt(make("welt_refinement_mesh", self, options.whole(level, "level")))
        result.report = {}
        return result

    def vertex_parents(self, level: int) -> Tuple[Any, Any]:
        """What the vertices of a level, from 1, stand for on the level before: (n,) kinds (0 vertex, 1 edge, 2 face) and (n,)
        numbers of elements."""
        return self._parents("vertex", level, self.vertex_count(level))

    def face_parents(self, level: int) -> Tuple[Any, Any]:
        """Which faces of the level before the faces of a level, from 1, cover: (m,) faces and (m,) corners, 0-based."""
        return self._parents("face", level, self.face_count(level))

    def _parents(self, element: str, level: int, count: int) -> Tuple[Any, Any]:
        first, second = arrays.Made(arrays.INDEX, count), arrays.Made(arrays.INDEX, count)
        call(f"welt_refinement_{element}_parents", self, level, first.pointer, second.pointer, count)
        return first.array, second.array


class Surface(Handle):
    """A limit surface, frozen: it stays as it is when its mesh changes. Made by `Mesh.freeze`.

    Queries that find points give arrays of structs with the fields face (`welt.NONE` where nothing was found), corner, u, v,
    position, normal (unit, outwards) and distance. threads: 1 by default, 0 for as many as the machine has; results do
    not depend on it.
    """

    _free = "welt_surface_free"
    _kind = "surface"

    def evaluate(
        self,
        faces: ArrayLike,
        parameters: ArrayLike,
        corners: Optional[ArrayLike] = None,
        derivatives: int = 0,
        *,
        threads: int = 1,
    ) -> Any:
        """Points of the surface: (k, 1, 3) doubles; with derivatives=1 (k, 3, 3): position, du, dv; with 2 (k, 6, 3): also
        duu, duv, dvv. In model units.

        faces: (k,) numbers. parameters: (k, 2), u and v in [0, 1]. corners: (k,), the patch of each point: a quad has patch
        0 only, another face one per corner; None for 0 everywhere.
        """
        where, places, patches = self._parameters(faces, parameters, corners)
        made = arrays.Made(arrays.DOUBLE, where.count, options.chosen(BATCH_WIDTHS, derivatives, "derivatives"), 3)
        call(
            "welt_surface_evaluate", self, where.pointer, arrays.pointer_or_null(patches), places.pointer, where.count,
            derivatives, options.batch(threads), made.pointer, made.capacity,
        )  # fmt: skip
        return made.array

    def curvature(self, faces: ArrayLike, parameters: ArrayLike, corners: Optional[ArrayLike] = None) -> Any:
        """(k, 10) doubles: the principal curvatures, the greater first; their unit directions (3 numbers each); mean and
        Gaussian curvature, in 1 / model unit. NaN where curvature is not defined. Arguments as for `evaluate`."""
        where, places, patches = self._parameters(faces, parameters, corners)
        made = arrays.Made(arrays.DOUBLE, where.count, 10)
        call(
            "welt_surface_curvature", self, where.pointer, arrays.pointer_or_null(patches), places.pointer, where.count,
            made.pointer, made.capacity,
        )  # fmt: skip
        return made.array

    @staticmethod
    def _parameters(faces: ArrayLike, parameters: ArrayLike, corners: Optional[ArrayLike]) -> Tuple[Any, Any, Any]:
        where, places = arrays.indices(faces, 1, "faces"), arrays.doubles(parameters, 2, "parameters")
        patches = None if corners is None else arrays.indices(corners, 1, "corners")
        options.same(where.count, places.count, "one face per pair of parameters")
        if patches is not None:
            options.same(where.count, patches.count, "one face per corner")
        return where, places, patches

    def closest(self, points: ArrayLike, radius: float = math.inf, *, threads: int = 1) -> Any:
        """The closest point of the surface to each of (k, 3) points, exactly; `distance` is how far. Nothing at or beyond
        the radius is found."""
        given = arrays.doubles(points, 3, "points")
        found = (SurfacePoint * given.count)()
        call(
            "welt_surface_closest", self, given.pointer, given.count, radius, None, options.batch(threads), found, len(found)
        )
        return arrays.structs(found)

    def signed_distances(self, points: ArrayLike, *, threads: int = 1) -> Any:
        """(k,) distances of (k, 3) points to a closed surface, negative inside. ArgumentError where it has a border."""
        given = arrays.doubles(points, 3, "points")
        made = arrays.Made(arrays.DOUBLE, given.count)
        call(
            "welt_surface_signed_distances", self, given.pointer, given.count, options.batch(threads), made.pointer,
            made.capacity,
        )  # fmt: skip
        return made.array

    def first_hits(self, lines: ArrayLike, first: float = 0.0, last: float = math.inf, *, threads: int = 1) -> Any:
        """The first point in which each of (k, 6) lines, origin and direction, meets the surface; `distance` is the parameter
        s of the hit, origin + s * direction, of those in [first, last] the one of the smallest amount."""
        given = arrays.doubles(lines, 6, "lines")
        found = (SurfacePoint * given.count)()
        call(
            "welt_surface_first_hits", self, given.pointer, given.count, first, last, options.batch(threads), found,
            len(found),
        )  # fmt: skip
        return arrays.structs(found)

    def all_hits(self, lines: ArrayLike, first: float = 0.0, last: float = math.inf, *, threads: int = 1) -> Tuple[Any, Any]:
        """All points in which (k, 6) lines meet the surface: (k + 1,) starts, and the points, by s; those of line i are
        points[starts[i]:starts[i + 1]]."""
        given = arrays.doubles(lines, 6, "lines")
        starts, needed = (ctypes.c_size_t * (given.count + 1))(), ctypes.c_size_t()
        found = (SurfacePoint * given.count)()
        while True:
            try:
                call(
                    "welt_surface_all_hits", self, given.pointer, given.count, first, last, options.batch(threads), starts,
                    ctypes.byref(needed), found, len(found),
                )  # fmt: skip
                break
            except BufferTooSmallError:
                if needed.value <= len(found):
                    raise
                found = (SurfacePoint * needed.value)()
        whole = (SurfacePoint * needed.value).from_buffer(found)
        return list(starts), arrays.structs(whole)


NONE = CONSTANTS["WELT_NONE"]
