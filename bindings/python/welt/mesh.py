"""Control meshes: their limit surfaces, marks and features."""

from __future__ import annotations

import ctypes
from typing import Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Tuple, Union

from . import _options as options
from . import arrays
from ._handle import call, make
from .arrays import ArrayLike
from .elements import Elements
from .errors import ArgumentError
from .job import Job, run
from .marks import Rules, Selection
from .patches import Patches
from .surface import BATCH_WIDTHS, Refinement, Surface

Settings = Union[str, Mapping[str, Union[int, float, str]]]


class Deviation(NamedTuple):
    """How far two limit surfaces are apart, in model units."""

    largest: float
    root_mean_square: float
    #: The distance that 95 % of the area do not exceed.
    percentile_95: float


class Comparison(NamedTuple):
    """How far two limit surfaces are apart, and how their normals and curvatures differ."""

    deviation: Deviation
    #: The largest angle between the normals of a point and of its closest point.
    degrees: float
    #: Differences of the mean curvatures there, per model unit.
    curvature_root_mean_square: float
    curvature_largest: float


class Mesh(Elements):
    """A control mesh; its vertices, edges and faces are numbered from 0 without gaps.

    positions: (n, 3) numbers, x, y and z of each vertex in model units.
    faces: the vertices of each face, 3 or more, counter-clockwise seen from outside, 0-based; an (m, k) array or
        sequences of different lengths.

    Raises MeshError where the faces are no surface: each place of the error is one defect.
    """

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

    def patches(
        self,
        faces: Optional[ArrayLike] = None,
        *,
        most_faces: int = 10,
        tolerance: float = 1e-4,
        job: Optional[Job] = None,
    ) -> Patches:
        """The limit surface of some faces (0-based) or of all as bicubic B-spline patches, for CAD. They meet side to side, with
        poles that are the same to the last bit.

        most_faces: faces along a side of a patch at most.
        tolerance: aim for the deviation beside extraordinary vertices, in parts of the mean length of the edges there.
        """
        given = None if faces is None else arrays.indices(faces, 1, "faces")
        count = 0 if given is None else given.count
        pointer, chosen = arrays.pointer_or_null(given), options.patch(most_faces, tolerance)
        return run(
            job, lambda watched: Patches._adopt(make("welt_patches_create", self, pointer, count, chosen, watched))
        )

    def deviation(self, other: Mesh, samples: int = 8, *, job: Optional[Job] = None) -> Deviation:
        """How far the limit surfaces of two control meshes are apart, both ways; 1 to 64 samples per side of each face."""
        values = (ctypes.c_double * 3)()
        count = options.whole(samples, "samples")
        run(job, lambda watched: call("welt_mesh_deviation", self, other, count, values, watched))
        return Deviation(*values)

    def compare(self, other: Mesh, samples: int = 8, *, threads: int = 1, job: Optional[Job] = None) -> Comparison:
        """As `deviation`, with the change of normals and of mean curvature."""
        values = (ctypes.c_double * 6)()
        count, parts = options.whole(samples, "samples"), options.whole(threads, "threads")
        run(job, lambda watched: call("welt_mesh_compare", self, other, count, parts, values, watched))
        return Comparison(Deviation(*values[:3]), *values[3:])

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
        fit: str = "surface_slide",
        parity: str = "auto",
        strict: bool = False,
        deviation: bool = False,
        limits: Mapping[str, Union[int, float]] = {},
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
        limits: what each run of the rules may cost, beyond which it is a RuleError: max_script_depth, max_applications,
            max_steps, max_changes (of the mesh), max_growth (times the elements of the mesh), max_extra_elements (and as many
            more), max_seconds. Defaults: docs/trust.md.

        After an error the mesh is as it was before. Vertices keep their numbers, new ones follow.
        """
        chosen = options.feature(fit, parity, strict, deviation, limits)
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
        method: str = "surface_slide",
        *,
        job: Optional[Job] = None,
    ) -> Dict[str, Any]:
        """Moves vertices (0-based; None for all) so that the surface comes close to a frozen one; gives the report."""
        given = None if vertices is None else arrays.indices(vertices, 1, "vertices")
        count = 0 if given is None else given.count
        pointer = arrays.pointer_or_null(given)
        code = options.constant("WELT_FIT_", method)
        return run(
            job,
            lambda watched: options.report(make("welt_mesh_fit", self, pointer, count, surface, code, watched)),
        )
