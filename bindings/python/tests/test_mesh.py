"""Meshes, marks, features and surfaces, with numpy and without."""

import gc
import math
import os
import tempfile
import unittest

import welt
from welt import arrays

CHAIR = os.path.join(os.path.dirname(__file__), "../../../tests/data/models/leaf_chair.obj")
PARAMETER = os.path.join(os.path.dirname(__file__), "../../../tests/cpp/data/parameter.rules")
CUBE_POINTS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
CUBE_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def cube():
    return welt.Mesh(CUBE_POINTS, CUBE_FACES)


def sheet(side):
    """Squares of side 1 in the plane z = 0."""
    points = [(x, y, 0) for y in range(side + 1) for x in range(side + 1)]
    corner = lambda x, y: y * (side + 1) + x
    faces = [(corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)) for y in range(side) for x in range(side)]
    return welt.Mesh(points, faces)


class Meshes(unittest.TestCase):
    def test_a_mesh_comes_back_as_it_was_given(self):
        mesh = cube()
        self.assertEqual((mesh.vertex_count, mesh.edge_count, mesh.face_count), (8, 12, 6))
        self.assertEqual(mesh.positions.tolist(), [list(map(float, p)) for p in CUBE_POINTS])
        self.assertEqual(mesh.faces, CUBE_FACES)
        self.assertEqual(mesh.face_sizes.tolist(), [4] * 6)
        edges = {tuple(sorted(edge)) for edge in mesh.edges.tolist()}
        self.assertEqual(edges, {tuple(sorted((f[i - 1], f[i]))) for f in CUBE_FACES for i in range(4)})
        again = welt.Mesh.from_arrays(mesh.positions, mesh.face_sizes, mesh.face_vertices)
        self.assertEqual(again.faces, mesh.faces)

    def test_limit_points_of_the_cube(self):
        # The limit mask of a vertex with n quads: n n for itself, 4 for edge neighbours, 1 for opposite corners, over n (n + 5).
        n = 3
        expected = (n * n * 1 + 4 * (1 + 1 - 1) + (1 - 1 - 1)) / (n * (n + 5))
        limit, normals = cube().limit_positions().tolist(), cube().limit_normals().tolist()
        for point, normal, corner in zip(limit, normals, CUBE_POINTS):
            for i in range(3):
                self.assertAlmostEqual(point[i], expected * corner[i], 14)
                self.assertAlmostEqual(normal[i], corner[i] / math.sqrt(3), 14)

    def test_positions_are_a_copy_and_views_are_none(self):
        mesh = cube()
        copy = mesh.positions
        copy[0, 0] = 7.0
        self.assertEqual(mesh.positions[0, 0], -1.0)
        view = mesh.positions_view
        second = mesh.positions_view
        with self.assertRaises((TypeError, ValueError)):
            view[0, 0] = 1.0
        with self.assertRaisesRegex(BufferError, "view of the mesh is in use"):
            mesh.positions = copy
        del view
        with self.assertRaises(BufferError):
            mesh.positions = copy
        del second
        mesh.positions = copy
        self.assertEqual(mesh.positions_view[0, 0], 7.0)

    def test_views_outlive_what_they_show(self):
        mesh = cube()
        view = mesh.positions_view
        mesh.close()
        refined = cube().refine(2)
        fine = refined.positions(2)
        expected = fine.tolist()
        del refined, mesh
        gc.collect()
        # Others that would take the memory, had it been freed.
        others = [welt.Mesh([(9 * x, 9 * y, 9 * z) for x, y, z in CUBE_POINTS], CUBE_FACES) for _ in range(100)]
        others += [other.refine(2) for other in others]
        self.assertEqual(view.tolist(), [list(map(float, p)) for p in CUBE_POINTS])
        self.assertEqual(fine.tolist(), expected)

    def test_closed_meshes_are_refused(self):
        with cube() as mesh:
            self.assertFalse(mesh.closed)
        with self.assertRaisesRegex(welt.ArgumentError, "the mesh was closed"):
            mesh.positions
        self.assertIn("closed", repr(mesh))
        self.assertIn("8 vertices", repr(cube()))
        mesh.close()

    def test_a_copy_is_a_mesh_of_its_own(self):
        mesh = welt.Mesh.read(CHAIR)
        selection = mesh.select("ring:3,331")
        copy = mesh.copy()
        copy.apply(selection, "groove", {"width": 1.6, "depth": 0.6})
        self.assertEqual(mesh.positions.tolist(), welt.Mesh.read(CHAIR).positions.tolist())
        mesh.apply(selection, "groove", {"width": 1.6, "depth": 0.6})
        self.assertEqual(mesh.positions.tolist(), copy.positions.tolist())

    def test_refinements(self):
        refined = cube().refine(2)
        self.assertEqual([refined.face_count(level) for level in range(3)], [6, 24, 96])
        self.assertEqual([refined.vertex_count(level) for level in range(3)], [8, 26, 98])
        self.assertEqual(refined.edge_count(1), 48)
        self.assertEqual(refined.face_vertices(0).tolist(), [v for f in CUBE_FACES for v in f])
        self.assertEqual(len(refined.face_vertices(1).tolist()[0]), 4)
        kinds, elements = refined.vertex_parents(1)
        self.assertEqual(kinds.tolist(), [0] * 8 + [1] * 12 + [2] * 6)
        self.assertEqual(elements.tolist(), [*range(8), *range(12), *range(6)])
        faces, corners = refined.face_parents(1)
        self.assertEqual(sorted(zip(faces.tolist(), corners.tolist())), [(f, c) for f in range(6) for c in range(4)])
        # The limit surface does not depend on the level that it is reached from.
        fine = refined.mesh(1)
        self.assertEqual(fine.face_count, 24)
        for coarse, point in zip(cube().limit_positions().tolist(), fine.limit_positions().tolist()):
            for i in range(3):
                self.assertAlmostEqual(coarse[i], point[i], 14)
        # The face point of a cube's side is its middle (Catmull and Clark 1978).
        self.assertEqual(sorted(map(sum, refined.positions(1).tolist()[20:])), [-1, -1, -1, 1, 1, 1])

    def test_sharpness_and_boundaries(self):
        mesh = cube()
        mesh.set_edge_sharpness(mesh.edges, [10.0] * mesh.edge_count)
        self.assertEqual(mesh.limit_positions().tolist(), [list(map(float, p)) for p in CUBE_POINTS])
        corner = cube()
        corner.set_vertex_sharpness([7], [10.0])
        self.assertEqual(corner.limit_positions().tolist()[7], [1.0, 1.0, 1.0])
        flat = sheet(2)
        flat.set_subdivision("edge_and_corner")
        self.assertEqual(flat.limit_positions().tolist()[0], [0.0, 0.0, 0.0])
        flat.set_holes([0])
        self.assertTrue(math.isnan(flat.freeze().evaluate([0], [(0.5, 0.5)])[0, 0, 0]))
        with self.assertRaisesRegex(welt.ArgumentError, "'edge' is none of none, edge_only, edge_and_corner"):
            flat.set_subdivision("edge")

    def test_loop_subdivision(self):
        points = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
        mesh = welt.Mesh(points, [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])
        self.assertEqual(mesh.refine_loop(2).face_count, 64)
        limit, normals = mesh.loop_limit()
        # Valence 3, beta = 3/16: the limit weighs the vertex by 1 / (1 + 8 beta ... ) = 2/5, each neighbour by 1/5 (Loop 1987).
        self.assertAlmostEqual(limit[0, 0], 2 / 5 * 1 + 1 / 5 * (1 - 1 - 1), 14)
        self.assertAlmostEqual(normals[0, 0], 1 / math.sqrt(3), 14)
        at_corner = mesh.loop_evaluate([0], [(0, 0)])
        self.assertAlmostEqual(at_corner[0, 0, 1], limit[0, 1], 12)


class Files(unittest.TestCase):
    def test_written_and_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "cübe.ply")
            cube().write(path)
            self.assertEqual(welt.Mesh.read(path).faces, CUBE_FACES)

    def test_files_that_are_none(self):
        with self.assertRaises(welt.FileError) as caught:
            welt.Mesh.read("/nowhere/chair.obj")
        self.assertIsInstance(caught.exception, OSError)
        self.assertEqual(caught.exception.code, -8)
        with self.assertRaises(welt.ParseError) as caught:
            welt.Mesh.read_bytes(b"v 0 0 0\nv 1 zero 0\n", name="bad.obj")
        place = caught.exception.places[0]
        self.assertEqual((place.file, place.line), ("bad.obj", 2))
        self.assertIn("bad.obj:2", str(place))

    def test_limits(self):
        with self.assertRaises(welt.Error):
            welt.Mesh.read(CHAIR, limits={"max_faces": 100})
        with self.assertRaisesRegex(welt.ArgumentError, "'max_size' is no limit: there are max_vertices, max_faces"):
            welt.Mesh.read(CHAIR, limits={"max_size": 100})
        for most in (-1, 1 << 64, 2.5, math.nan, math.inf):
            with self.subTest(most=most), self.assertRaisesRegex(welt.ArgumentError, "max_faces must be a whole number from 0"):
                welt.Mesh.read(CHAIR, limits={"max_faces": most})
        self.assertEqual(welt.Mesh.read(CHAIR, limits={"max_faces": (1 << 64) - 1}).report["repairs"], [])

    def test_repair(self):
        book = b"v 0 0 0\nv 0 1 0\nv 1 0 0\nv -1 0 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n"
        with self.assertRaises(welt.MeshError) as caught:
            welt.Mesh.read_bytes(book)
        place = next(p for p in caught.exception.places if p.kind == "edge")
        self.assertEqual(sorted(place.ids), [0, 1])
        mended = welt.Mesh.read_bytes(book, repair=True)
        self.assertEqual(mended.face_count, 3)
        self.assertTrue(mended.report["repairs"])


class Features(unittest.TestCase):
    def test_a_groove_is_as_wide_and_as_deep_as_asked(self):
        mesh = sheet(8)
        selection = mesh.select("ring:4,5")
        ends, places = selection.edges(mesh)
        self.assertEqual({tuple(sorted(edge)) for edge in ends.tolist()}, {(y * 9 + 4, y * 9 + 5) for y in range(9)})
        self.assertEqual(places.tolist(), [0.5] * 9)
        report = mesh.apply(selection, "groove", {"width": 0.4, "depth": 0.1})
        self.assertEqual((report["before"]["faces"], report["after"]["faces"]), (64, mesh.face_count))
        self.assertAlmostEqual(min(p[2] for p in mesh.limit_positions().tolist()), -0.1, 6)
        # Half depth is half a width away from the mark, which runs along x = 4.5.
        for x in (4.5 - 0.2, 4.5 + 0.2):
            hit = mesh.freeze().first_hits([(x, 4.0, 5.0, 0, 0, -1)])[0]
            height = hit["position"][2] if arrays.numpy else hit.position[2]
            self.assertAlmostEqual(float(height), -0.05, 3)
        self.assertAlmostEqual(mesh.deviation(sheet(8)).largest, 0.1, 2)
        compared = mesh.compare(sheet(8), 4, threads=2)
        self.assertEqual(compared.deviation, mesh.deviation(sheet(8), 4))
        self.assertTrue(5 < compared.degrees < 90)

    def test_wrong_wishes_change_nothing(self):
        mesh = sheet(4)
        before = mesh.positions.tolist()
        selection = mesh.select("ring:2,3")
        for settings, what in (({"width": 5}, "width"), ({"wide": 1}, "wide"), ({"width": math.nan}, "width"), ("depth", "depth")):
            with self.subTest(settings=settings), self.assertRaisesRegex(welt.ArgumentError, what):
                mesh.apply(selection, "groove", settings)
        with self.assertRaisesRegex(welt.ArgumentError, "grove"):
            mesh.apply(selection, "grove")
        with self.assertRaises(welt.ArgumentError):
            mesh.select("ring:2,3000")
        self.assertEqual(mesh.positions.tolist(), before)

    def test_a_width_too_large_names_the_edge(self):
        mesh = sheet(4)
        with self.assertRaises(welt.ArgumentError) as caught:
            mesh.apply(mesh.select("ring:2,3"), "groove", {"width": 5})
        self.assertEqual(caught.exception.places[0].kind, "edge")
        self.assertEqual(len(caught.exception.places[0].ids), 2)

    def test_features_and_rules_declare_parameters(self):
        known = {feature["name"]: feature for feature in welt.features()}
        self.assertEqual(set(known), {"groove", "ridge", "piping", "step", "bead", "dent", "loop"})
        self.assertEqual([p["name"] for p in known["groove"]["parameters"]], ["width", "depth"])
        self.assertEqual(known["groove"]["parameters"][0]["default"], "30%")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.rules")
            with open(path, "w") as file:
                file.write("rule {")
            with self.assertRaises(welt.ParseError) as caught:
                welt.Rules(path)
            self.assertEqual((caught.exception.places[0].file, caught.exception.places[0].line), (path, 1))
        rules = welt.Rules(PARAMETER)
        self.assertEqual(rules.parameters[-1], welt.Parameter("height", "length", "How far up", 2.0, 0.5, 10.0))
        self.assertEqual(rules.parameters[:-1], welt.Rules.linear().parameters)

    def test_limits_of_rules(self):
        mesh = sheet(4)
        before = mesh.positions.tolist()
        selection = mesh.select("ring:2,3")
        for limits, what in (
            ({"max_script_depth": 0}, "more than 0 procedures and loops inside one another"),
            ({"max_applications": 1}, "more than 1 applications"),
            ({"max_steps": 5}, "more than 5 steps"),
            ({"max_changes": 5}, "more than 5 changes"),
            ({"max_growth": 1, "max_extra_elements": 2}, "vertices, edges and faces"),
            ({"max_seconds": 0}, "more than 0 s"),
        ):
            with self.subTest(limits=limits), self.assertRaisesRegex(welt.RuleError, what):
                mesh.apply(selection, "groove", limits=limits)
        for limits, what in (
            ({"max_size": 1}, "'max_size' is no limit: there are max_script_depth, max_applications, max_steps"),
            ({"max_script_depth": 1 << 32}, "max_script_depth must be a whole number from 0 to 2\\^32 - 1"),
            ({"max_steps": -1}, "max_steps must be a whole number from 0 to 2\\^64 - 1, not -1"),
            ({"max_steps": math.inf}, "max_steps must be a whole number"),
            ({"max_seconds": -0.5}, "max_seconds must be 0 or more, not -0.5"),
            ({"max_seconds": math.nan}, "max_seconds must be 0 or more, not nan"),
        ):
            with self.subTest(limits=limits), self.assertRaisesRegex(welt.ArgumentError, what):
                mesh.apply(selection, "groove", limits=limits)
        self.assertEqual(mesh.positions.tolist(), before)
        mesh.apply(selection, "groove", limits={"max_seconds": math.inf, "max_steps": (1 << 64) - 1})
        self.assertGreater(mesh.vertex_count, 25)

    def test_marks_that_no_rule_handles(self):
        # The rules of linear features do nothing without the cuts that the feature stage prepares.
        mesh = sheet(4)
        report = mesh.apply(mesh.select("ring:2,3"), welt.Rules.linear())
        self.assertEqual(report["after"]["faces"], 16)
        with self.assertRaises(welt.RuleError) as caught:
            mesh.apply(mesh.select("ring:2,3"), welt.Rules.linear(), strict=True)
        self.assertEqual({place.kind for place in caught.exception.places}, {"edge"})

    def test_displace_and_fit(self):
        mesh = sheet(4)
        surface = mesh.freeze()
        mesh.displace([12], [0.5])
        self.assertAlmostEqual(mesh.limit_positions()[12, 2], 0.5, 12)
        exact = mesh.copy()
        exact.fit(surface, [12], "solve")
        self.assertAlmostEqual(exact.limit_positions()[12, 2], 0.0, 9)
        # A fit of the surface takes two steps, too few from so far off.
        for _ in range(3):
            report = mesh.fit(surface, [12])
        self.assertIsInstance(report, dict)
        self.assertAlmostEqual(mesh.limit_positions()[12, 2], 0.0, 9)

    def test_what_is_no_selection_never_reaches_the_library(self):
        mesh = cube()
        for wrong in ("ring:0,1", mesh.copy(), 5):
            with self.assertRaisesRegex(TypeError, "a selection is needed, not .*: make one by the method select"):
                mesh.apply(wrong, "groove")


class Surfaces(unittest.TestCase):
    """On the plane, where everything is known."""

    def setUp(self):
        self.surface = sheet(4).freeze()

    def test_evaluation(self):
        # Boundary spans of a cubic spline move their parameters, inner ones do not.
        jet = self.surface.evaluate([5], [(0.25, 0.5)], derivatives=2)
        self.assertEqual(arrays_shape(jet), (1, 6, 3))
        self.assertAlmostEqual(jet[0, 0, 0], 1.25, 12)
        self.assertAlmostEqual(jet[0, 0, 1], 1.5, 12)
        self.assertAlmostEqual(jet[0, 1, 0], 1.0, 12)
        self.assertAlmostEqual(jet[0, 3, 0], 0.0, 12)
        self.assertEqual(arrays_shape(self.surface.curvature([5], [(0.25, 0.5)], [0])), (1, 10))
        with self.assertRaisesRegex(welt.ArgumentError, "one face per pair"):
            self.surface.evaluate([5, 6], [(0.25, 0.5)])

    def test_queries(self):
        found = self.surface.closest([(1.5, 1.5, 2.0), (0, 0, math.nan)])
        self.assertEqual(int(found[0]["face"] if arrays.numpy else found[0].face), 5)
        self.assertAlmostEqual(float(found[0]["distance"] if arrays.numpy else found[0].distance), 2.0, 12)
        self.assertEqual(int(found[1]["face"] if arrays.numpy else found[1].face), welt.NONE)
        starts, points = self.surface.all_hits([(1.5, 1.5, 5, 0, 0, -1), (1.5, 9, 5, 0, 0, -1)])
        self.assertEqual((starts, len(points)), ([0, 1, 1], 1))
        hit = self.surface.first_hits([(1.5, 1.5, 5, 0, 0, -1)])[0]
        self.assertAlmostEqual(float(hit["distance"] if arrays.numpy else hit.distance), 5.0, 12)
        with self.assertRaises(welt.ArgumentError):
            self.surface.signed_distances([(0, 0, 0)])
        # A line through the cube meets it twice; the middle of the limit surface's side is closed in.
        starts, points = cube().freeze().all_hits([(0.1, 0.2, 5, 0, 0, -1)])
        self.assertEqual((starts, len(points)), ([0, 2], 2))
        self.assertLess(cube().freeze().signed_distances([(0, 0, 0)])[0], -0.4)


def arrays_shape(array):
    return tuple(array.shape)


class Patches(unittest.TestCase):
    def test_patches_of_a_cube(self):
        patches = cube().patches()
        self.assertEqual(patches.report()["patches"], len(patches))
        self.assertEqual(sorted({f for patch in patches for f in patch.faces.tolist()}), list(range(6)))
        limit = {tuple(round(x, 12) for x in p) for p in cube().limit_positions().tolist()}
        corners = set()
        first = patches[0].poles
        for patch in patches:
            rows = patch.poles.tolist()
            corners.update(tuple(round(x, 12) for x in rows[j][i]) for j in (0, -1) for i in (0, -1))
            self.assertEqual((len(patch.knots_u), len(patch.knots_v)), (len(rows[0]) + 4, len(rows) + 4))
            for neighbour in patch.neighbours:
                self.assertLess(neighbour, len(patches))
        # A closed surface, whose patches end at the limit points of the vertices.
        self.assertLessEqual(limit, corners)
        with self.assertRaises(IndexError):
            patches[len(patches)]
        expected = patches[0].poles.tolist()
        del patches, patch
        gc.collect()
        self.assertEqual(first.tolist(), expected)
        with self.assertRaises(welt.ArgumentError):
            cube().patches(most_faces=0)


class Arrays(unittest.TestCase):
    def test_numbers_that_are_none(self):
        for faces, what in (([-1], "face"), ([2**32], "face"), ([1.5], "face"), (["one"], "face")):
            with self.subTest(faces=faces), self.assertRaisesRegex(welt.ArgumentError, what):
                cube().set_holes(faces)
        with self.assertRaisesRegex(welt.ArgumentError, "3 numbers each"):
            cube().positions = [1.0, 2.0]
        with self.assertRaises(welt.ArgumentError):
            cube().refine(-1)

    def test_empty_is_not_all(self):
        self.assertTrue(math.isnan(cube().freeze([]).evaluate([0], [(0, 0)])[0, 0, 0]))
        self.assertEqual(len(welt.Mesh([], []).positions), 0)
        self.assertEqual(len(welt.Mesh([], []).positions_view), 0)

    @unittest.skipUnless(arrays.numpy, "skipped: numpy is absent")
    def test_numpy_arrays_go_in_without_a_copy_and_come_out(self):
        import numpy

        points = numpy.array(CUBE_POINTS, dtype=float)
        self.assertEqual(arrays.doubles(points, 3, "points")._held.__array_interface__["data"], points.__array_interface__["data"])
        mesh = welt.Mesh(points[:, ::1], numpy.array(CUBE_FACES))
        self.assertTrue(numpy.array_equal(mesh.positions_view, points))
        self.assertFalse(mesh.positions_view.flags.owndata)
        mesh.positions = numpy.asfortranarray(points) * 2
        self.assertTrue(numpy.array_equal(mesh.positions, points * 2))


if __name__ == "__main__":
    unittest.main()
