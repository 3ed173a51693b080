"""Puts the shared library into the wheel."""

import pathlib
import shutil
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:
    from wheel.bdist_wheel import bdist_wheel

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from library_file import NAME, library  # noqa: E402


class Build(build_py):
    def run(self) -> None:
        super().run()
        if not self.editable_mode:
            shutil.copy2(library(), pathlib.Path(self.build_lib) / "welt" / NAME)


class WithLibrary(Distribution):
    def has_ext_modules(self) -> bool:
        """The wheel is of one platform."""
        return True


class Wheel(bdist_wheel):
    def get_tag(self):
        """The wheel serves every Python 3, since ctypes loads the library."""
        return ("py3", "none", super().get_tag()[2])


setup(distclass=WithLibrary, cmdclass={"build_py": Build, "bdist_wheel": Wheel})
