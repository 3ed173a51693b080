"""Limit surfaces as B-spline solids: closed, valid, of the right volume, through a STEP file and back."""

import math
import os

import Part
from support import REPOSITORY, Case, torus

from freecad.welt.cage import make_cage
from freecad.welt.limit import make_limit
from freecad.welt.solid import make_solid


class Solids(Case):
    def is_closed(self, shape):
        """Not only valid, which an unsewn compound is too: every edge has two faces."""
        self.assertTrue(shape.isValid())
        for solid in shape.Solids:
            self.assertEqual([shell.isClosed() for shell in solid.Shells], [True])
            for edge in solid.Edges:
                self.assertEqual(len(solid.ancestorsOfType(edge, Part.Face)), 2)

    def test_a_torus_with_a_groove(self):
        groove = self.groove(self.cage(torus(16, 8)), 0, 1, Width=4, Depth=1.5)
        solid, limit = make_solid(groove), make_limit(groove, 4)
        self.recompute()
        self.assertEqual((solid.Kind, solid.Shape.ShapeType), ("Solid", "Solid"))
        self.is_closed(solid.Shape)
        self.assertEqual(solid.Shape.Faces[0].Surface.TypeId, "Part::GeomBSplineSurface")
        self.assertAlmostEqual(solid.Shape.Volume / limit.Mesh.Volume, 1.0, 3)
        # The cage shrinks on the way to its limit: 2 pi^2 R r^2 is more than the volume.
        whole = 2 * math.pi**2 * 50 * 15**2
        self.assertLess(solid.Shape.Volume, whole)
        self.assertGreater(solid.Shape.Volume, 0.7 * whole)

        path = self.path("torus.step")
        solid.Shape.exportStep(path)
        read = Part.Shape()
        read.read(path)
        self.assertEqual(len(read.Solids), 1)
        self.is_closed(read)
        self.assertEqual(len(read.Faces), solid.Faces)
        self.assertAlmostEqual(read.Volume / solid.Shape.Volume, 1.0, 9)

        volume = solid.Shape.Volume
        groove.Depth = 0.5
        self.recompute()
        self.assertGreater(solid.Shape.Volume, volume, "a shallow groove takes less away")

    def test_extraordinary_vertices(self):
        # A cube has eight of them; OpenSubdiv's limit surface of it has the volume that its mesh tends to.
        cube = "".join(f"v {x} {y} {z}\n" for x in (-10, 10) for y in (-10, 10) for z in (-10, 10))
        cube += "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
        cage = self.cage(cube)
        solid, limit = make_solid(cage), make_limit(cage, 6)
        self.recompute()
        self.is_closed(solid.Shape)
        self.assertGreater(solid.Shape.Volume, 0)
        self.assertAlmostEqual(solid.Shape.Volume / limit.Mesh.Volume, 1.0, 3)
        self.assertLess(solid.Deviation, 20 * solid.Tolerance)

    def test_a_surface_with_a_border_is_a_shell(self):
        cage = self.cage("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n")
        solid = make_solid(cage)
        self.recompute()
        self.assertEqual(solid.Kind, "Shell: the surface has a border")
        self.assertEqual((len(solid.Shape.Solids), solid.Shape.ShapeType), (0, "Shell"))

    def test_several_parts(self):
        cage = make_cage(self.document, os.path.join(REPOSITORY, "tests/data/models/chair.obj"))
        solid = make_solid(cage)
        self.recompute()
        self.assertGreater(len(solid.Shape.Shells), 1)
        self.assertTrue(solid.Shape.isValid())
