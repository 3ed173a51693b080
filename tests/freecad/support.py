"""What the tests of the addon share: models, and processes of their own."""

import math
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import FreeCAD

from freecad.welt.cage import make_cage
from freecad.welt.feature import make_feature
from freecad.welt.marks import make_marks

REPOSITORY = os.environ["WELT_REPOSITORY"]
CHAIR = os.path.join(REPOSITORY, "tests/data/models/leaf_chair.obj")


def torus(around=40, across=25, radius=50.0, thickness=15.0):
    """A control mesh of around * across quads as the text of an OBJ file."""
    lines = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = radius + thickness * math.cos(b)
            lines.append(f"v {r * math.cos(a)!r} {r * math.sin(a)!r} {thickness * math.sin(b)!r}")
    corner = lambda i, j: i % around * across + j % across + 1
    for i in range(around):
        for j in range(across):
            lines.append("f " + " ".join(map(str, (corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)))))
    return "\n".join(lines) + "\n"


class Case(unittest.TestCase):
    """A test with a document and a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.document = FreeCAD.newDocument("Test")
        self.addCleanup(lambda: FreeCAD.closeDocument(self.document.Name))

    def path(self, name):
        return os.path.join(self.folder, name)

    def cage(self, text=None):
        """A torus of 1000 faces, or another."""
        path = self.path("cage.obj")
        with open(path, "w") as file:
            file.write(text or torus())
        cage = make_cage(self.document, path)
        self.recompute()
        return cage

    def chair(self):
        cage = make_cage(self.document, CHAIR)
        self.recompute()
        return cage

    def groove(self, cage, a, b, propagation="Ring", **values):
        groove = make_feature([make_marks(cage, [edge_name(cage, a, b)], propagation)], "groove", **values)
        self.recompute()
        return groove

    def recompute(self, *valid):
        self.document.recompute()
        for obj in valid or self.document.Objects:
            self.assertTrue(obj.isValid(), f"{obj.Name}: {obj.getStatusString()}")

    def refused(self, obj, sentence):
        """Recomputes; the object says a sentence, and the document can be used."""
        self.document.recompute()
        self.assertFalse(obj.isValid(), obj.Name)
        said = obj.getStatusString()
        self.assertRegex(said, sentence)
        self.assertNotIn("\n", said)
        self.assertNotIn("Traceback", said)
        return said


def edge_name(obj, a, b):
    edges = [sorted(edge) for edge in obj.Proxy.mesh(obj).edges.tolist()]
    return f"Edge{edges.index(sorted((a, b))) + 1}"


def content(obj, path):
    """The control mesh of a cage or feature as the library writes it."""
    obj.Proxy.mesh(obj).write(path)
    with open(path, "rb") as file:
        return file.read()


def run(program, **environment):
    """Runs a program in a FreeCAD of its own: what it printed, and what it complained of."""
    child = subprocess.run(
        [shutil.which("freecadcmd"), "-c", program],
        env={**os.environ, **environment}, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    # Progress is printed among the rest.
    return re.sub(r"[\t\r]*\(\d+ %\)[\t\r]*|Recompute\.\.\.\.\.\.\n?", "", child.stdout), child.stderr
