"""Vertices, edges and faces of control meshes: in and out, files, the subdivision scheme."""

from __future__ import annotations

import ctypes
import os
import weakref
from typing import Any, Dict, Iterable, List, Mapping, Sequence, Tuple, TypeVar, Union

from . import _options as options
from . import arrays
from ._handle import Handle, call, make
from .arrays import ArrayLike

E = TypeVar("E", bound="Elements")


class Elements(Handle):
    """What `Mesh` is made of: see there."""

    _free = "welt_mesh_free"
    _kind = "mesh"
    #: What a file holds and the mesh does not ("ignored"), and what was changed ("repairs"); empty where there was no file.
    report: Dict[str, Any]

    def __init__(self, positions: ArrayLike, faces: Iterable[Sequence[int]]) -> None:
        corners = [list(face) for face in faces]
        self._create(positions, [len(face) for face in corners], [v for face in corners for v in face])

    @classmethod
    def from_arrays(cls: type[E], positions: ArrayLike, face_sizes: ArrayLike, face_vertices: ArrayLike) -> E:
        """A mesh of flat arrays: (n, 3) positions, the number of vertices of each face, and the vertices of all faces one
        after the other."""
        self = cls.__new__(cls)
        self._create(positions, face_sizes, face_vertices)
        return self

    def _create(self, positions: ArrayLike, face_sizes: ArrayLike, face_vertices: ArrayLike) -> None:
        sizes = arrays.indices(face_sizes, 1, "face_sizes")
        corners = arrays.indices(face_vertices, 1, "face_vertices")
        points = arrays.doubles(positions, 3, "positions")
        self._take_over(
            make("welt_mesh_create", sizes.pointer, sizes.count, corners.pointer, corners.count, points.pointer, points.count, 0)
        )
        self.report = {}

    # --- Files

    @classmethod
    def read(
        cls: type[E],
        path: Union[str, os.PathLike[str]],
        *,
        repair: bool = False,
        weld: float = -1.0,
        limits: Mapping[str, int] = {},
    ) -> E:
        """Reads a mesh from a file, OBJ or PLY by its extension.

        repair: split apart, turn round or remove what a mesh cannot hold, instead of refusing the file.
        weld: merge vertices that are no further apart than this distance, in the unit of the file; 0 merges equal ones, a
            negative number none.
        limits: how much a file may hold: max_vertices, max_faces, max_face_vertices, max_vertex_faces.

        Raises FileError, ParseError (places have the line) and MeshError (places have defects and lines). What was ignored
        and repaired stands in `report`.
        """
        name = os.fspath(path).encode()
        return cls._imported("welt_mesh_import_file", name, len(name), options.importing(repair, weld, limits))

    @classmethod
    def read_bytes(
        cls: type[E],
        content: bytes,
        format: str = "obj",
        *,
        name: str = "memory",
        repair: bool = False,
        weld: float = -1.0,
        limits: Mapping[str, int] = {},
    ) -> E:
        """Reads a mesh from the content of a file.

        format: "obj" or "ply".
        name: stands for the file in messages.
        repair, weld, limits: as for `read`.
        """
        label = name.encode()
        data = ctypes.cast(ctypes.c_char_p(content), ctypes.POINTER(ctypes.c_uint8))
        code, chosen = options.constant("WELT_FORMAT_", format), options.importing(repair, weld, limits)
        return cls._imported("welt_mesh_import_memory", label, len(label), code, data, len(content), chosen)

    @classmethod
    def _imported(cls: type[E], name: str, *arguments: Any) -> E:
        mesh, report = ctypes.c_void_p(), ctypes.c_void_p()
        call(name, *arguments, ctypes.byref(mesh), ctypes.byref(report))
        self = cls._adopt(mesh)
        self.report = options.report(report)
        return self

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the mesh, OBJ or PLY by the extension. A file that was there is replaced at the very end, or is as it was."""
        name = os.fspath(path).encode()
        call("welt_mesh_export_file", self, name, len(name))

    def copy(self: E) -> E:
        """A mesh of its own with all that this one holds. Selections of this one serve the copy too."""
        result = type(self)._adopt(make("welt_mesh_copy", self))
        result.report = self.report
        return result

    # --- Elements

    @property
    def vertex_count(self) -> int:
        return int(call("welt_mesh_vertex_count", self))

    @property
    def edge_count(self) -> int:
        return int(call("welt_mesh_edge_count", self))

    @property
    def face_count(self) -> int:
        return int(call("welt_mesh_face_count", self))

    @property
    def positions(self) -> Any:
        """(n, 3) doubles, the vertices in model units; a copy. Assigning moves all vertices."""
        made = arrays.Made(arrays.DOUBLE, self.vertex_count, 3)
        ctypes.memmove(made.pointer, self._positions(), 8 * made.capacity)
        return made.array

    @positions.setter
    def positions(self, positions: ArrayLike) -> None:
        given = arrays.doubles(positions, 3, "positions")
        call("welt_mesh_set_positions", self, given.pointer, given.count, 0)

    @property
    def positions_view(self) -> Any:
        """(n, 3) doubles, the vertices where the library holds them: nothing is copied, nothing can be written.

        While a view is in use the mesh cannot be changed (BufferError); a mesh that is closed lives on in its views.
        """
        owner, count = self._owner, self.vertex_count
        first = self._positions()
        assert owner is not None
        memory = owner.view() if owner.view is not None else None
        if memory is None:
            memory = arrays.memory(first, arrays.DOUBLE, 3 * count, owner)
            owner.view = weakref.ref(memory)
        return arrays.shaped(memory, arrays.DOUBLE, (count, 3), readonly=True)

    def _positions(self) -> Any:
        first = ctypes.POINTER(ctypes.c_double)()
        call("welt_mesh_positions", self, ctypes.byref(first))
        return first

    @property
    def face_sizes(self) -> Any:
        """(m,) whole numbers, the number of vertices of each face."""
        return self._faces()[0]

    @property
    def face_vertices(self) -> Any:
        """The vertices of all faces one after the other, counter-clockwise, 0-based."""
        return self._faces()[1]

    @property
    def faces(self) -> List[Tuple[int, ...]]:
        """The vertices of each face, counter-clockwise, 0-based."""
        sizes, vertices = (made.tolist() for made in self._faces())
        result, start = [], 0
        for size in sizes:
            result.append(tuple(vertices[start : start + size]))
            start += size
        return result

    def _faces(self) -> Tuple[Any, Any]:
        sizes = arrays.Made(arrays.INDEX, self.face_count)
        vertices = arrays.Made(arrays.INDEX, int(call("welt_mesh_face_vertex_count", self)))
        call("welt_mesh_faces", self, sizes.pointer, sizes.capacity, vertices.pointer, vertices.capacity)
        return sizes.array, vertices.array

    @property
    def edges(self) -> Any:
        """(e, 2) whole numbers, the vertices of each edge, 0-based."""
        made = arrays.Made(arrays.INDEX, self.edge_count, 2)
        call("welt_mesh_edges", self, made.pointer, made.capacity)
        return made.array

    # --- The subdivision scheme

    def set_subdivision(self, boundary: str = "edge_only", creasing: str = "uniform") -> None:
        """boundary: "none" (faces at the boundary are no part of the surface), "edge_only" (the boundary is a cubic
        B-spline), "edge_and_corner" (vertices of a single face stay). creasing: "uniform" or "chaikin"."""
        call(
            "welt_mesh_set_subdivision",
            self,
            options.constant("WELT_BOUNDARY_", boundary),
            options.constant("WELT_CREASING_", creasing),
        )

    def set_edge_sharpness(self, edges: ArrayLike, sharpness: ArrayLike) -> None:
        """edges: (k, 2) vertices. sharpness: (k,) numbers, 0 (smooth) or more; 10 and more is infinitely sharp."""
        ends, values = arrays.indices(edges, 2, "edges"), arrays.floats(sharpness, "sharpness")
        options.same(ends.count, values.count, "one sharpness per edge")
        call("welt_mesh_set_edge_sharpness", self, ends.pointer, values.pointer, values.count)

    def set_vertex_sharpness(self, vertices: ArrayLike, sharpness: ArrayLike) -> None:
        """vertices: (k,) numbers. sharpness: (k,) numbers, 0 (smooth) or more; 10 and more is infinitely sharp."""
        given, values = arrays.indices(vertices, 1, "vertices"), arrays.floats(sharpness, "sharpness")
        options.same(given.count, values.count, "one sharpness per vertex")
        call("welt_mesh_set_vertex_sharpness", self, given.pointer, values.pointer, values.count)

    def set_holes(self, faces: ArrayLike) -> None:
        """Says which faces are holes, all others not: subdivided like others, but no part of the surface."""
        given = arrays.indices(faces, 1, "faces")
        call("welt_mesh_set_holes", self, given.pointer, given.count)

    def __repr__(self) -> str:
        if self.closed:
            return "<welt.Mesh, closed>"
        return f"<welt.Mesh: {self.vertex_count} vertices, {self.edge_count} edges, {self.face_count} faces>"
