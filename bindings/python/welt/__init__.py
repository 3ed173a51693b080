"""welt: grooves, ridges and seams on Catmull-Clark control meshes.

    import welt

    mesh = welt.Mesh.read("chair.obj")
    report = mesh.apply(mesh.select("ring:3,331"), "groove", {"width": 1.6, "depth": 0.6})
    mesh.write("seam.obj")

Arrays go in as whatever numpy takes, or as nested sequences; they come out as numpy arrays where numpy is installed, else
as memory views of the same shape. Lengths are in model units, indices are 0-based. Failures are `welt.Error` with message,
code and places. Long calls take a `welt.Job` for progress and cancelling; Ctrl-C cancels them.

Importing raises `welt.LibraryError`, an ImportError, where the shared library is missing or not of this version.
"""

from . import _library
from ._library import LibraryError
from .errors import (
    ArgumentError,
    BufferTooSmallError,
    CancelledError,
    Error,
    FileError,
    InternalError,
    MeshError,
    ParseError,
    Place,
    PoisonedError,
    OutOfMemoryError,
    RuleError,
    TooLargeError,
)
from .job import Job
from .marks import Parameter, Rules, Selection, features
from .mesh import Comparison, Deviation, Mesh
from .patches import Patch, Patches
from .surface import NONE, Refinement, Surface

#: The version of the library that runs, such as "0.1.0".
__version__ = _library.raw("welt_version_string").decode()
#: The file of the library that runs.
library_file = _library.FILE

__all__ = [
    "ArgumentError",
    "BufferTooSmallError",
    "CancelledError",
    "Comparison",
    "Deviation",
    "Error",
    "FileError",
    "InternalError",
    "Job",
    "LibraryError",
    "Mesh",
    "MeshError",
    "NONE",
    "Parameter",
    "ParseError",
    "Patch",
    "Patches",
    "Place",
    "PoisonedError",
    "Refinement",
    "OutOfMemoryError",
    "RuleError",
    "Rules",
    "Selection",
    "Surface",
    "TooLargeError",
    "features",
    "library_file",
]
