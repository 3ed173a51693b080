"""Finding the library, and what is said where it is missing or another."""

import ctypes.util
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

import welt
from welt import _library

PACKAGE = os.path.dirname(os.path.abspath(welt.__file__))


def load(environment, path):
    """Imports the package in a process of its own: what it says, without the traceback."""
    kept = {key: value for key, value in os.environ.items() if key not in ("WELT_LIBRARY", "PYTHONPATH")}
    program = "try:\n import welt\n print('file', welt.library_file)\nexcept ImportError as error:\n print(error)"
    environment = {**kept, **environment, "PYTHONPATH": path}
    child = subprocess.run([sys.executable, "-c", program], cwd=path, env=environment, capture_output=True, text=True, check=True)
    return child.stdout.strip()


class Finding(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = self.folder.name
        files = [f for f in os.listdir(PACKAGE) if f.endswith(".py")]
        os.mkdir(os.path.join(self.path, "welt"))
        for file in files:
            shutil.copy(os.path.join(PACKAGE, file), os.path.join(self.path, "welt", file))

    def test_in_the_package_and_beside_it(self):
        for folder in (self.path, os.path.join(self.path, "welt")):
            file = os.path.join(folder, _library.NAME)
            os.symlink(os.path.realpath(welt.library_file), file)
            self.assertEqual(load({}, self.path), f"file {file}")

    def test_where_welt_library_says(self):
        file = os.path.realpath(welt.library_file)
        self.assertEqual(load({"WELT_LIBRARY": file}, self.path), f"file {file}")
        self.assertEqual(load({"WELT_LIBRARY": os.path.dirname(file)}, self.path), f"file {file}")

    def test_missing(self):
        said = load({"WELT_LIBRARY": "/nowhere/libwelt.so"}, self.path)
        self.assertIn("the welt library cannot be loaded (/nowhere/libwelt.so", said)
        self.assertIn("pip install", said)
        self.assertEqual(said.count("\n"), 0)

    def test_another_library(self):
        said = load({"WELT_LIBRARY": ctypes.util.find_library("m") or "libm.so.6"}, self.path)
        self.assertRegex(said, "is no welt library; install")

    def test_another_interface(self):
        abi = os.path.join(self.path, "welt", "_abi.py")
        with open(abi) as file:
            text = file.read()
        with open(abi, "w") as file:
            file.write(text.replace("\nABI_VERSION = 0\n", "\nABI_VERSION = 9\n"))
        said = load({"WELT_LIBRARY": os.path.realpath(welt.library_file)}, self.path)
        self.assertRegex(said, r"is welt \d.*, whose binary interface is not that of this package \(.*interface 9\); install")

    def test_an_older_library(self):
        abi = os.path.join(self.path, "welt", "_abi.py")
        with open(abi, "a") as file:
            file.write('\nPROTOTYPES += "int32_t welt_not_yet(void);"\n')
        said = load({"WELT_LIBRARY": os.path.realpath(welt.library_file)}, self.path)
        self.assertRegex(said, "lacks welt_not_yet: it is older than this package; install")

    @unittest.skipUnless(importlib.util.find_spec("setuptools") and importlib.util.find_spec("wheel"), "skipped: setuptools or wheel is absent")
    def test_the_wheel_has_the_library(self):
        source = os.path.dirname(PACKAGE)
        copy = os.path.join(self.path, "source")
        shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__", "tests", "build", "*.egg-info"))
        small = os.path.join(self.path, "small.so")
        with open(small, "wb") as file:
            file.write(b"stands for the library")
        subprocess.run(
            [sys.executable, "setup.py", "-q", "bdist_wheel"], cwd=copy, env={**os.environ, "WELT_LIBRARY": small}, check=True, capture_output=True
        )
        (wheel,) = os.listdir(os.path.join(copy, "dist"))
        self.assertTrue(wheel.startswith(f"welt-{welt.__version__}-py3-none-"), wheel)
        names = zipfile.ZipFile(os.path.join(copy, "dist", wheel)).namelist()
        self.assertIn("welt/" + _library.NAME, names)
        self.assertEqual({n for n in names if n.endswith(".py")}, {"welt/" + f for f in os.listdir(PACKAGE) if f.endswith(".py")})


if __name__ == "__main__":
    unittest.main()
