"""The shared library for those who pack it: the file that WELT_LIBRARY names, or one that cargo builds."""

import os
import pathlib
import shutil
import subprocess
import sys

NAME = {"win32": "welt.dll", "darwin": "libwelt.dylib"}.get(sys.platform, "libwelt.so")
REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


def library() -> pathlib.Path:
    named = os.environ.get("WELT_LIBRARY")
    if named:
        path = pathlib.Path(named)
        path = path / NAME if path.is_dir() else path
        if not path.exists():
            raise SystemExit(f"WELT_LIBRARY names {path}, which does not exist")
        return path
    if not (REPOSITORY / "Cargo.toml").exists():
        raise SystemExit("the sources of the library are not here: set WELT_LIBRARY to the file of the library")
    if not shutil.which("cargo"):
        raise SystemExit("cargo is needed to build the library (https://rustup.rs), or set WELT_LIBRARY to its file")
    subprocess.run(["cargo", "build", "--release", "--lib", "--no-default-features"], cwd=REPOSITORY, check=True)
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    return target / "release" / NAME
