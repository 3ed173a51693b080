"""The plugin in meshlabserver: its results are those of the program welt, its failures say what to do."""

import json
import math
import re
import tempfile
import unittest
from pathlib import Path

from host import (FAUX, LEAF_CHAIR, ROOT, SELECTED, enum, feature, meshlab, open_file, parameter, read_obj, read_ply, welt,
                  write_ply)

GROOVE = {"width": "1.6", "depth": "0.6"}
RING = "ring:3,331"


def tube(sides=6, rows=3):
    """A tube with open ends whose long edges are sharp: vertex s + sides * r, faces between rows."""
    positions = [
        (math.cos(2 * math.pi * s / sides), math.sin(2 * math.pi * s / sides), float(r))
        for r in range(rows + 1)
        for s in range(sides)
    ]
    faces = [
        tuple(s % sides + sides * r for s, r in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
        for j in range(rows)
        for i in range(sides)
    ]
    return positions, faces


class Filters(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chair = read_obj(LEAF_CHAIR)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.cage, self.out, self.obj = (self.folder / name for name in ("cage.ply", "out.ply", "out.obj"))
        self.expected = self.folder / "expected.obj"

    def run_filter(self, *filters, inputs=None):
        code, text = meshlab(filters, inputs or [self.cage], self.out)
        self.assertEqual(code, 0, text)
        return text

    def apply(self, name, settings, *marks):
        sets = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        marked = [word for mark in marks for word in ("--mark", mark)]
        welt("apply", self.cage, "-o", self.expected, "--feature", name, *marked, *sets)

    def assert_as_expected(self):
        """The polygon file is that of the program; the layer has the same polygons in single precision."""
        self.assertEqual(self.obj.read_text(), self.expected.read_text())
        positions, faces = read_obj(self.expected)
        found, _, polygons = read_ply(self.out)
        self.assertEqual(polygons, faces)
        self.assertEqual(len(found), len(positions))
        size = max(abs(c) for p in positions for c in p)
        self.assertLess(max(abs(a - b) for p, q in zip(positions, found) for a, b in zip(p, q)), 1e-6 * size)

    def test_quads_in_quads_out(self):
        write_ply(self.cage, *self.chair)
        text = self.run_filter(feature("Welt: Groove", GROOVE, selectors=RING, polygon_file=self.obj))
        self.apply("groove", GROOVE, RING)
        self.assert_as_expected()
        # 76 marks: three vertices and three faces each.
        self.assertIn("76 edges marked; the mesh now has 2198 vertices and 2162 polygons", text)
        self.assertIn("width: reached 1.600", text)
        self.assertTrue(all(len(face) == 4 for face in read_ply(self.out)[2]))

    def test_every_feature_that_the_library_lists(self):
        write_ply(self.cage, *tube())
        settings = {
            "groove": {"width": "0.3", "depth": "0.05"},
            "ridge": {"width": "0.3", "height": "5%"},
            "piping": {"width": "50%", "height": "0.05", "depth": "0.02"},
            "step": {"width": "0.4", "height": "0.05"},
            "bead": {"width": "0.4", "height": "0.05"},
            "dent": {"width": "0.2", "depth": "0.05"},
            "loop": {"count": 2},
        }
        for name, lengths in settings.items():
            with self.subTest(name):
                self.run_filter(feature("Welt: " + name.title(), lengths, selectors="ring:6,12", polygon_file=self.obj))
                self.apply(name, lengths, "ring:6,12")
                self.assert_as_expected()

    def test_marks_of_selected_vertices(self):
        positions, faces = tube()
        write_ply(self.cage, positions, faces, vertices=range(12))
        self.run_filter(feature("Welt: Groove", {"width": "0.3", "depth": "0.05"}, "vertices", polygon_file=self.obj))
        self.apply("groove", {"width": "0.3", "depth": "0.05"}, "cut:" + ",".join(map(str, range(12))))
        self.assert_as_expected()

    def test_marks_of_selected_faces(self):
        positions, faces = tube()
        write_ply(self.cage, positions, faces, face_flags=dict.fromkeys(range(6), SELECTED))
        self.run_filter(feature("Welt: Groove", {"width": "0.3", "depth": "0.05"}, "faces", polygon_file=self.obj))
        # The first row of faces has the first two rows of vertices.
        self.apply("groove", {"width": "0.3", "depth": "0.05"}, "cut:" + ",".join(map(str, range(12))))
        self.assert_as_expected()

    def test_marks_of_crease_edges(self):
        write_ply(self.cage, *tube())
        # The long edges turn by 60 degrees.
        creases = ("Select Crease Edges", [parameter("Float", "AngleDegNeg", -45), parameter("Float", "AngleDegPos", 45)])
        lengths = {"width": "0.3", "depth": "0.05"}
        for marks in ("edges", "rings"):
            with self.subTest(marks):
                self.run_filter(creases, feature("Welt: Groove", lengths, marks, polygon_file=self.obj))
                if marks == "rings":
                    self.apply("groove", lengths, "ring:0,6", "ring:6,12", "ring:12,18")
                else:
                    edges = sorted((s + 6 * r, s + 6 * (r + 1)) for r in range(3) for s in range(6))
                    self.apply("groove", lengths, *(f"edge:{a},{b}" for a, b in edges))
                self.assert_as_expected()

    def test_a_feature_on_a_feature(self):
        write_ply(self.cage, *tube())
        first = feature("Welt: Loop", {"count": 1}, selectors="ring:0,6", polygon_file=self.obj)
        lengths = {"width": "0.3", "depth": "0.05"}
        self.run_filter(first, feature("Welt: Groove", lengths, selectors="ring:12,18", polygon_file=self.folder / "two.obj"))
        welt("apply", self.obj, "-o", self.expected, "--feature", "groove", "--mark", "ring:12,18", "--set", "width=0.3",
             "--set", "depth=0.05")
        found, expected = read_obj(self.folder / "two.obj"), read_obj(self.expected)
        self.assertEqual(found[1], expected[1])
        # Between the two the layer has single precision.
        self.assertLess(max(abs(a - b) for p, q in zip(found[0], expected[0]) for a, b in zip(p, q)), 1e-5)

    def test_polygons_other_than_quads(self):
        positions, faces = tube()
        # Both ends closed by a hexagon, one of which is cut in two.
        faces += [(5, 4, 3, 2, 1, 0), (18, 19, 20), (18, 20, 21, 22, 23)]
        write_ply(self.cage, positions, faces)
        lengths = {"width": "0.3", "depth": "0.05"}
        self.run_filter(feature("Welt: Groove", lengths, selectors="ring:6,12", polygon_file=self.obj))
        self.apply("groove", lengths, "ring:6,12")
        self.assert_as_expected()

    def test_custom_rules(self):
        write_ply(self.cage, *tube())
        rules = ROOT / "rules/linear.rules"
        start = [open_file("rules", rules), parameter("String", "settings", "")]
        self.run_filter(feature("Welt: Custom Rules", {}, selectors="ring:6,12", polygon_file=self.obj, before=start))
        welt("apply", self.cage, "-o", self.expected, "--rules", rules, "--mark", "ring:6,12")
        self.assert_as_expected()

    def test_limit_surface(self):
        write_ply(self.cage, *tube())
        self.run_filter(("Welt: Limit Surface", [parameter("Int", "level", 2), enum("boundary", 0, 3)]))
        welt("limit", self.cage, "-o", self.expected, "--level", "2")
        positions, faces = read_obj(self.expected)
        found, _, polygons = read_ply(self.out)
        self.assertEqual(polygons, faces)
        self.assertLess(max(abs(a - b) for p, q in zip(positions, found) for a, b in zip(p, q)), 1e-6)

    def test_open_control_mesh(self):
        write_ply(self.cage, *tube())
        start = ("Welt: Open Control Mesh", [open_file("file", LEAF_CHAIR)])
        self.run_filter(start, feature("Welt: Groove", GROOVE, selectors=RING, polygon_file=self.obj))
        write_ply(self.cage, *self.chair)
        self.apply("groove", GROOVE, RING)
        self.assert_as_expected()

    def test_deviation(self):
        # Of a groove of known depth from the cage without it.
        write_ply(self.cage, *tube())
        lengths = {"width": "0.3", "depth": "0.05"}
        self.run_filter(feature("Welt: Groove", lengths, selectors="ring:6,12", polygon_file=self.obj))
        grooved = self.folder / "grooved.ply"
        self.out.rename(grooved)
        text = self.run_filter(
            ("Welt: Deviation", [parameter("Mesh", "reference", 0), parameter("Int", "level", 3), enum("boundary", 0, 3)]),
            inputs=[self.cage, grooved])
        quality = read_ply(self.out)[1]
        self.assertAlmostEqual(min(quality), -0.05, delta=0.001)
        self.assertLess(max(quality), 0.01)
        both = json.loads(welt("deviation", self.cage, self.obj, "--json"))["both"]
        told = re.search(r"max (\S+), rms (\S+), 95 % within (\S+);", text)
        for found, key in zip(told.groups(), ("max", "rms", "p95")):
            # The layer has single precision.
            self.assertAlmostEqual(float(found), both[key], delta=1e-4 * both[key])


class Failures(unittest.TestCase):
    """Each ends with an error, says what to do, and writes nothing."""

    def fails(self, mesh, a_filter, *words, **flags):
        with tempfile.TemporaryDirectory() as folder:
            cage, out = Path(folder) / "cage.ply", Path(folder) / "out.ply"
            write_ply(cage, *mesh, **flags)
            before = cage.read_bytes()
            code, text = meshlab([a_filter], [cage], out)
            self.assertNotEqual(code, 0, text)
            self.assertEqual(cage.read_bytes(), before)
            self.assertFalse(out.exists())
            for word in words:
                self.assertIn(word, text)

    def test_nothing_selected(self):
        for marks in ("vertices", "faces", "edges", "rings"):
            what = "edges" if marks == "rings" else marks
            self.fails(tube(), feature("Welt: Groove", GROOVE, marks), f"no {what} are selected: select some")
        self.fails(tube(), feature("Welt: Groove", GROOVE), "selectors is empty: name edges")

    def test_all_selected(self):
        self.fails(tube(), feature("Welt: Groove", GROOVE, "vertices"), "name some vertices of a component, not all", vertices=range(24))

    def test_width_too_large(self):
        self.fails(tube(), feature("Welt: Groove", {"width": "7", "depth": "0.1"}, selectors="ring:6,12"),
                   "a width of 7.000 does not fit edge 6,12 (length 1.000); it takes widths from")

    def test_widths_that_are_none(self):
        self.fails(tube(), feature("Welt: Groove", {"width": "wide", "depth": "0.1"}, selectors="ring:6,12"),
                   "'wide' is not a length; give a number")

    def test_an_edge_with_three_faces(self):
        positions, faces = tube()
        broken = (positions + [(3.0, 0.0, 0.0)], faces + [(0, 6, 24)])
        self.fails(broken, feature("Welt: Groove", GROOVE, selectors="ring:6,12"), "edge 0-6 has 3 faces",
                   "Repair non Manifold Edges")

    def test_two_fans_in_a_vertex(self):
        positions, faces = tube()
        broken = (positions + [(3.0, 0.0, 0.0), (3.0, 1.0, 0.0)], faces + [(0, 24, 25)])
        self.fails(broken, feature("Welt: Groove", GROOVE, selectors="ring:6,12"), "vertex 0")

    def test_points_only(self):
        for name in ("Welt: Groove", "Welt: Limit Surface"):
            a_filter = feature(name, GROOVE, selectors=RING)
            if name != "Welt: Groove":
                a_filter = (name, [parameter("Int", "level", 1), enum("boundary", 0, 3)])
            self.fails((tube()[0], []), a_filter, "the layer has no faces")

    def test_faux_edges_round_a_vertex(self):
        # A quad in four triangles, whose tip is on no edge of the polygon.
        positions = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0), (0.5, 0.5, 0.5)]
        faces = [(i, (i + 1) % 4, 4) for i in range(4)]
        inside = dict.fromkeys(range(4), FAUX << 1 | FAUX << 2)
        self.fails((positions, faces), feature("Welt: Groove", GROOVE, selectors="edge:0,1"),
                   "are no polygon; run 'Turn into a Pure-Triangular mesh' first", face_flags=inside)

    def test_edges_without_length(self):
        positions, faces = tube()
        flat = [(x, y, 0.0) for x, y, _ in positions]
        self.fails((flat, faces), feature("Welt: Groove", GROOVE, selectors="ring:6,12"), "edge 6,12 has no length")

    def test_marks_that_do_not_exist(self):
        self.fails(tube(), feature("Welt: Groove", GROOVE, selectors="ring:0,99"),
                   "vertex 99 does not exist; the mesh has vertices 0 to 23")

    def test_a_rule_file_that_is_not_there(self):
        start = [open_file("rules", "/nowhere/my.rules"), parameter("String", "settings", "")]
        self.fails(tube(), feature("Welt: Custom Rules", {}, selectors="ring:6,12", before=start), "/nowhere/my.rules")

    def test_a_control_mesh_that_is_not_there(self):
        self.fails(tube(), ("Welt: Open Control Mesh", [open_file("file", "/nowhere/chair.obj")]), "/nowhere/chair.obj")

    def test_no_rule_file(self):
        start = [open_file("rules", ""), parameter("String", "settings", "")]
        self.fails(tube(), feature("Welt: Custom Rules", {}, selectors="ring:6,12", before=start), "no rule file is named")

    def test_a_polygon_file_that_cannot_be_written(self):
        self.fails(tube(), feature("Welt: Loop", {"count": 1}, selectors="ring:6,12", polygon_file="/nowhere/out.obj"),
                   "/nowhere/out.obj")

    def test_a_layer_compared_with_itself(self):
        self.fails(tube(), ("Welt: Deviation", [parameter("Mesh", "reference", 0), parameter("Int", "level", 1),
                                               enum("boundary", 0, 3)]), "compared with itself")


if __name__ == "__main__":
    unittest.main()
