"""welt for FreeCAD: parametric grooves, ridges and seams on Catmull-Clark control meshes."""

__version__ = "0.1.0"
