"""Installs the addon: the workbench, the Python package and the shared library, in one folder that FreeCAD finds.

    python3 bindings/freecad/install.py [FOLDER]

FOLDER is FreeCAD's folder for addons; without it the usual one of this system. The library is built by cargo, unless
WELT_LIBRARY names a built one.
"""

import os
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
PYTHON = HERE.parent / "python"
sys.path.insert(0, str(PYTHON))
from library_file import NAME, library  # noqa: E402


def usual_folder() -> pathlib.Path:
    home = pathlib.Path.home()
    if sys.platform == "win32":
        return pathlib.Path(os.environ["APPDATA"]) / "FreeCAD" / "Mod"
    if sys.platform == "darwin":
        return home / "Library" / "Application Support" / "FreeCAD" / "Mod"
    return home / ".local" / "share" / "FreeCAD" / "Mod"


def install(folder: pathlib.Path) -> pathlib.Path:
    built = library()
    addon, fresh = folder / "Welt", folder / "Welt.new"
    shutil.rmtree(fresh, ignore_errors=True)
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(HERE / "freecad", fresh / "freecad", ignore=ignored)
    shutil.copytree(PYTHON / "welt", fresh / "welt", ignore=ignored)
    shutil.copytree(HERE / "macros", fresh / "macros")
    shutil.copy2(built, fresh / "welt" / NAME)
    for file in ("package.xml", "README.md"):
        shutil.copy2(HERE / file, fresh / file)
    for file in ("LICENSE-MIT", "LICENSE-APACHE"):
        shutil.copy2(HERE.parents[1] / file, fresh / file)
    # An addon that is there is replaced whole, at the end.
    shutil.rmtree(addon, ignore_errors=True)
    fresh.rename(addon)
    return addon


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        raise SystemExit(__doc__)
    print("installed in", install(pathlib.Path(sys.argv[1]) if sys.argv[1:] else usual_folder()))
