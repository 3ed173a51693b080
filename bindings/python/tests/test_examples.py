"""What the documentation shows runs as it stands there."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import welt
from test_mesh import CHAIR

HERE = os.path.dirname(os.path.abspath(__file__))
PACKAGE = os.path.dirname(HERE)


def environment():
    return {**os.environ, "PYTHONPATH": PACKAGE, "WELT_LIBRARY": os.path.realpath(welt.library_file)}


class Examples(unittest.TestCase):
    def test_code_of_the_readmes(self):
        for file in (os.path.join(PACKAGE, "../../README.md"), os.path.join(PACKAGE, "README.md")):
            with open(file, encoding="utf-8") as text:
                blocks = re.findall(r"^```python\n(.*?)^```", text.read(), flags=re.S | re.M)
            self.assertTrue(blocks, file)
            for block in blocks:
                with self.subTest(file=file), tempfile.TemporaryDirectory() as folder:
                    shutil.copy(CHAIR, os.path.join(folder, "chair.obj"))
                    subprocess.run([sys.executable, "-c", block], cwd=folder, env=environment(), check=True, stdout=subprocess.DEVNULL)
                    # 76 marked edges of a groove of three lines.
                    seam = welt.Mesh.read(os.path.join(folder, "seam.obj"))
                    self.assertEqual(seam.vertex_count, welt.Mesh.read(CHAIR).vertex_count + 3 * 76)

    def test_the_tour(self):
        tour = os.path.join(PACKAGE, "examples/tour.py")
        done = subprocess.run([sys.executable, tour], env=environment(), check=True, capture_output=True, text=True)
        self.assertIn("76 edges are marked", done.stdout)
        self.assertIn("does not fit edge", done.stdout)


if __name__ == "__main__":
    unittest.main()
