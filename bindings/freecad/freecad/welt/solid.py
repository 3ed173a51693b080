"""The limit surface as a solid of B-spline faces (BRep)."""

import FreeCAD
import Part

from .objects import Proxy, add, mesh_of
from .problems import Problem

translate = FreeCAD.Qt.translate


class Solid(Proxy):
    """The limit surface as B-spline faces, sewn: a solid where the surface is closed, else a shell."""

    kind = "solid"

    def add_properties(self, obj):
        say = lambda text: translate("App::Property", text)
        add(obj, "App::PropertyLink", "Base", "Solid", say("The cage or the feature whose limit surface it is"))
        if "MostFaces" not in obj.PropertiesList:
            add(obj, "App::PropertyIntegerConstraint", "MostFaces", "Solid", say("Faces of the cage along a side of a B-spline face at most"))
            obj.MostFaces = (10, 1, 100, 1)
        if "Tolerance" not in obj.PropertiesList:
            say_tolerance = say("Aim for the deviation beside extraordinary vertices, in parts of the edges' length")
            add(obj, "App::PropertyFloatConstraint", "Tolerance", "Solid", say_tolerance)
            obj.Tolerance = (1e-4, 1e-8, 1.0, 1e-4)
        add(obj, "App::PropertyInteger", "Faces", "Result", say("Number of B-spline faces"))
        add(obj, "App::PropertyString", "Kind", "Result", say("Solid, or shell where the surface has a border"))
        add(obj, "App::PropertyFloat", "Deviation", "Result", say("Greatest distance to the limit surface that was found, in mm"))
        add(obj, "App::PropertyFloat", "NormalJump", "Result", say("Greatest angle between the normals of two faces along a smooth side, in degrees"))
        for name in ("Faces", "Kind", "Deviation", "NormalJump"):
            obj.setEditorMode(name, 1)

    def placed_as(self, obj):
        return obj.Base

    def compute(self, obj):
        patches = mesh_of(obj.Base).patches(most_faces=obj.MostFaces, tolerance=obj.Tolerance)
        report = patches.report()
        shape, closed = sewn([spline(patch).toShape() for patch in patches])
        obj.Shape = shape
        obj.Faces = len(patches)
        obj.Kind = translate("Welt", "Solid") if closed else translate("Welt", "Shell: the surface has a border")
        obj.Deviation = report["max_deviation"]
        obj.NormalJump = report["max_normal_jump"]


def spline(patch):
    """The B-spline surface of a patch."""
    surface = Part.BSplineSurface()
    rows = patch.poles.tolist()
    along_u = [[FreeCAD.Vector(*row[i]) for row in rows] for i in range(len(rows[0]))]
    knots_u, times_u = multiplicities(patch.knots_u.tolist())
    knots_v, times_v = multiplicities(patch.knots_v.tolist())
    surface.buildFromPolesMultsKnots(
        along_u, times_u, times_v, knots_u, knots_v, False, False, patch.degree_u, patch.degree_v
    )  # fmt: skip
    return surface


def multiplicities(knots):
    """Different knots, and how often each stands there."""
    different = sorted(set(knots))
    return different, [knots.count(knot) for knot in different]


def sewn(faces):
    """Faces as a solid or several, and whether all are closed; else as shells."""
    if not faces:
        raise Problem(translate("Welt", "There is no surface: the cage has no faces, or its boundary rule leaves all out"))
    whole = Part.Compound(faces)
    whole.sewShape()
    shells = whole.Shells
    if not shells:
        # A single face is none.
        shells = [Part.Shell([face]) for face in whole.Faces]
    closed = all(shell.isClosed() for shell in shells)
    parts = [solid_of(shell) for shell in shells] if closed else shells
    return (parts[0] if len(parts) == 1 else Part.Compound(parts)), closed


def solid_of(shell):
    """The solid in a closed shell, with its inside inside."""
    solid = Part.Solid(shell)
    if solid.Volume < 0:
        shell.reverse()
        solid = Part.Solid(shell)
    return solid


def make_solid(base):
    mesh_of(base)
    obj = base.Document.addObject("Part::FeaturePython", "Solid")
    Solid(obj)
    obj.Base = base
    from .views import show

    show(obj)
    return obj
