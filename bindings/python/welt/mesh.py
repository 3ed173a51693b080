"""Control meshes."""

from __future__ import annotations

import ctypes
import os
import weakref
from typing import Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from . import _options as options
from . import arrays
from ._handle import Handle, call, make
from .arrays import ArrayLike
from .errors import ArgumentError
from .job import Job, run
from .marks import Rules, Selection
from .surface import BATCH_WIDTHS, Refinement, Surface

Settings = Union[str, Mapping[str, Union[int, float, str]]]


class Deviation(NamedTuple):
    """How far two limit surfaces are apart, in model units."""

    largest: float
    root_mean_square: float
    #: The distance that 95 % of the area do not exceed.
    percentile_95: float


class Mesh(Handle):
    """A control mesh; its vertices, edges and faces are numbered from 0 without gaps.

    positions: (n, 3) numbers, x, y and z of each vertex in model units.
    faces: the vertices of each face, 3 or more, counter-clockwise seen from outside, 0-based; an (m, k) array or
        sequences of different lengths.

    Raises MeshError where the faces are no surface: each place of the error is one defect.
    """

    _free = "welt_mesh_free"
    _kind = "mesh"
    #: What a file holds and the mesh does not ("ignored"), and what was changed ("repairs"); empty where there was no file.
    report: Dict[str, Any]

    def __init__(self, positions: ArrayLike, faces: Iterable[Sequence[int]]) -> None:
        corners = [list(face) for face in faces]
        self._create(positions, [len(face) for face in corners], [v for face in corners for v in face])

    @classmethod
    def from_arrays(cls, positions: ArrayLike, face_sizes: ArrayLike, face_vertices: ArrayLike) -> Mesh:
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
    def read(cls, path: Union[str, os.PathLike[str]], *, repair: bool = False, weld: float = -1.0) -> Mesh:
        """Reads a mesh from a file, OBJ or PLY by its extension.

        repair: split apart, turn round or remove what a mesh cannot hold, instead of refusing the file.
        weld: merge vertices that are no further apart than this distance, in the unit of the file; 0 merges equal ones, a
            negative number none.

        Raises FileError, ParseError (places have the line) and MeshError (places have defects and lines). What was ignored
        and repaired stands in `report`.
        """
        name = os.fspath(path).encode()
        return cls._imported("welt_mesh_import_file", name, len(name), options.importing(repair, weld))

    @classmethod
    def read_bytes(
        cls, content: bytes, format: str = "obj", *, name: str = "memory", repair: bool = False, weld: float = -1.0
    ) -> Mesh:
        """Reads a mesh from the content of a file.

        format: "obj" or "ply".
        name: stands for the file in messages.
        repair, weld: as for `read`.
        """
        label = name.encode()
        data = ctypes.cast(ctypes.c_char_p(content), ctypes.POINTER(ctypes.c_uint8))
        code = options.constant("WELT_FORMAT_", format)
        return cls._imported(
            "welt_mesh_import_memory", label, len(label), code, data, len(content), options.importing(repair, weld)
        )

    @classmethod
    def _imported(cls, name: str, *arguments: Any) -> Mesh:
        mesh, report = ctypes.c_void_p(), ctypes.c_void_p()
        call(name, *arguments, ctypes.byref(mesh), ctypes.byref(report))
        self = cls._adopt(mesh)
        self.report = options.report(report)
        return self

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the mesh, OBJ or PLY by the extension. A file that was there is replaced at the very end, or is as it was."""
        name = os.fspath(path).encode()
        call("welt_mesh_export_file", self, name, len(name))

    def copy(self) -> Mesh:
        """A mesh of its own with all that this one holds. Selections of this one serve the copy too."""
        result = Mesh._adopt(make("welt_mesh_copy", self))
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

    # --- The limit surface

    def limit_positions(self) -> Any:
        """(n, 3) doubles: the point of the limit surface that belongs to each vertex, in model units."""
        made = arrays.Made(arrays.DOUBLE, self.vertex_count, 3)
        call("welt_mesh_limit_positions", self, made.pointer, made.capacity)
        return made.array

    def limit_normals(self) -> Any:
        """(n, 3) doubles: unit normals of the limit surface at the vertices, outwards; 0 where there is none."""
        made = arrays.Made(arrays.DOUBLE, self.vertex_count, 3)
        call("welt_mesh_limit_normals", self, made.pointer, made.capacity)
        return made.array

    def refine(self, depth: int, *, job: Optional[Job] = None) -> Refinement:
        """The Catmull-Clark refinements of levels 0 to `depth`; each level has four times the faces of the one before."""
        if not 0 <= depth <= 30:
            raise ArgumentError(f"depth must be from 0 to 30, not {depth}")
        return run(job, lambda watched: Refinement._adopt(make("welt_refinement_create", self, depth, watched)))

    def freeze(self, faces: Optional[ArrayLike] = None, *, job: Optional[Job] = None) -> Surface:
        """The limit surface as it is now, of some faces (0-based) or of all; cost follows their number."""
        given = None if faces is None else arrays.indices(faces, 1, "faces")
        count = 0 if given is None else given.count
        pointer = arrays.pointer_or_null(given)
        return run(job, lambda watched: Surface._adopt(make("welt_surface_create", self, pointer, count, watched)))

    def deviation(self, other: Mesh, samples: int = 8, *, job: Optional[Job] = None) -> Deviation:
        """How far the limit surfaces of two control meshes are apart, both ways; 1 to 64 samples per side of each face."""
        values = (ctypes.c_double * 3)()
        count = options.whole(samples, "samples")
        run(job, lambda watched: call("welt_mesh_deviation", self, other, count, values, watched))
        return Deviation(*values)

    # --- Loop subdivision, of triangles

    def refine_loop(self, levels: int) -> Mesh:
        """The mesh after `levels` steps of Loop's rules; each makes four triangles of one."""
        result = Mesh._adopt(make("welt_mesh_refine_loop", self, options.whole(levels, "levels")))
        result.report = {}
        return result

    def loop_limit(self) -> Tuple[Any, Any]:
        """(n, 3) points of the Loop limit surface and (n, 3) unit normals at the vertices of a triangle mesh."""
        points = arrays.Made(arrays.DOUBLE, self.vertex_count, 3)
        normals = arrays.Made(arrays.DOUBLE, self.vertex_count, 3)
        call("welt_mesh_loop_limit", self, points.pointer, normals.pointer, points.capacity)
        return points.array, normals.array

    def loop_evaluate(self, faces: ArrayLike, parameters: ArrayLike, derivatives: int = 0, *, threads: int = 1) -> Any:
        """Points of the Loop limit surface, with derivatives: (k, 1, 3), (k, 3, 3) or (k, 6, 3) doubles as `Surface.evaluate`.

        parameters: (k, 2), the weights of the second and the third corner of the face.
        """
        where, given = arrays.indices(faces, 1, "faces"), arrays.doubles(parameters, 2, "parameters")
        options.same(where.count, given.count, "one face per pair of parameters")
        made = arrays.Made(arrays.DOUBLE, where.count, options.chosen(BATCH_WIDTHS, derivatives, "derivatives"), 3)
        call(
            "welt_mesh_loop_evaluate", self, where.pointer, given.pointer, where.count, derivatives, options.batch(threads),
            made.pointer, made.capacity,
        )  # fmt: skip
        return made.array

    # --- Features

    def select(self, selectors: Union[str, Iterable[str]]) -> Selection:
        """The edges that selectors name, one or several: `edge:A,B[@t]`, `ring:A,B`, `path:A,B:C,D`, `cut:V,V,...`,
        `polyline:X,Y,Z;...`, `spline:X,Y,Z;...`, `select:FILE`, each with `#kind` for another kind of mark. Vertices are 0-based."""
        text = (selectors if isinstance(selectors, str) else " ".join(selectors)).encode()
        return Selection._adopt(make("welt_selection_create", self, text, len(text)))

    def mark(self, selection: Selection) -> None:
        """Stores marks on the mesh, for rules that look for them; `apply` does so by itself."""
        call("welt_mesh_mark", self, selection)

    def apply(
        self,
        selection: Selection,
        features: Union[str, Rules],
        settings: Settings = "",
        *,
        fit: str = "solve",
        parity: str = "auto",
        strict: bool = False,
        deviation: bool = False,
        job: Optional[Job] = None,
    ) -> Dict[str, Any]:
        """Puts features along the marked edges, fits the mesh to the surface as it was, and gives the report.

        features: a feature that `welt.features()` lists, such as "groove", or a profile file ending in .toml; several as lines
            `KIND=FEATURE`. Or a rule set: then nothing is displaced.
        settings: such as {"width": 1.6, "depth": "30%"}: lengths in model units, or parts of the length of the marked edge;
            `KIND.NAME` for one feature of several.
        fit: "none", "loop", "solve", "surface" or "surface_slide": how the changed mesh is fitted (docs/optimisation.md).
        parity: "auto", "all_quad" or "local": what is done about faces with an odd number of sides.
        strict: marks that no rule handles are an error; else the report lists them.
        deviation: measure deviations and look for thin walls; costs more than the feature.

        After an error the mesh is as it was before. Vertices keep their numbers, new ones follow.
        """
        chosen = options.feature(fit, parity, strict, deviation)
        text = options.settings(settings)
        what: List[Any]
        if isinstance(features, Rules):
            name, what = "welt_rules_apply", [features]
        else:
            lines = features.encode()
            name, what = "welt_feature_apply", [lines, len(lines)]
        return run(
            job,
            lambda watched: options.report(
                make(name, self, selection, *what, text, len(text), ctypes.byref(chosen), watched)
            ),
        )

    def displace(self, vertices: ArrayLike, heights: ArrayLike) -> None:
        """Moves vertices along the normals so that the limit point of each rises by its height, in model units."""
        given, values = arrays.indices(vertices, 1, "vertices"), arrays.doubles(heights, 1, "heights")
        options.same(given.count, values.count, "one height per vertex")
        call("welt_mesh_displace", self, given.pointer, values.pointer, given.count)

    def fit(
        self,
        surface: Surface,
        vertices: Optional[ArrayLike] = None,
        method: str = "solve",
        *,
        job: Optional[Job] = None,
    ) -> Dict[str, Any]:
        """Moves vertices (0-based; None for all) so that their limit points lie on a frozen surface; gives the report."""
        given = None if vertices is None else arrays.indices(vertices, 1, "vertices")
        count = 0 if given is None else given.count
        pointer = arrays.pointer_or_null(given)
        code = options.constant("WELT_FIT_", method)
        return run(
            job,
            lambda watched: options.report(make("welt_mesh_fit", self, pointer, count, surface, code, watched)),
        )

    def __repr__(self) -> str:
        if self.closed:
            return "<welt.Mesh, closed>"
        return f"<welt.Mesh: {self.vertex_count} vertices, {self.edge_count} edges, {self.face_count} faces>"
