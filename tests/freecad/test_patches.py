"""The example of docs/patches-cad.md runs as it stands there."""

import os
import re
import shutil

import Part
from support import CHAIR, REPOSITORY, Case


class Patches(Case):
    def test_the_example(self):
        with open(os.path.join(REPOSITORY, "docs/patches-cad.md"), encoding="utf-8") as page:
            (block,) = re.findall(r"^```python\n(.*?)^```", page.read(), flags=re.S | re.M)
        shutil.copy(CHAIR, self.path("chair.obj"))
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        names = {}
        exec(compile(block, "docs/patches-cad.md", "exec"), names)
        # The seat and a leg assembly; the third component has a border.
        self.assertEqual([solid.isValid() for solid in names["solids"]], [True, True])
        read = Part.Shape()
        read.read(self.path("chair.step"))
        self.assertEqual(len(read.Solids), 2)
        self.assertAlmostEqual(read.Volume / sum(solid.Volume for solid in names["solids"]), 1.0, 6)
