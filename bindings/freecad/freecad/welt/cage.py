"""The cage: a control mesh in the document."""

import os

import FreeCAD

from .objects import Proxy, add, cage_shape, edited
from .problems import Problem, library

translate = FreeCAD.Qt.translate

BOUNDARIES = {"As in the file": None, "None": "none", "Edges": "edge_only", "Edges and corners": "edge_and_corner"}


class Cage(Proxy):
    """A control mesh from a file, which is kept inside the document; its points can be moved."""

    kind = "cage"

    def __init__(self, obj):
        super().__init__(obj)
        self._mesh = None

    def add_properties(self, obj):
        say = lambda text: translate("App::Property", text)
        add(obj, "App::PropertyFileIncluded", "File", "Cage", say("OBJ or PLY file with the control mesh; kept in the document"))
        add(obj, "App::PropertyVectorList", "Points", "Cage", say("The vertices of the control mesh"))
        if "Boundary" not in obj.PropertiesList:
            add(obj, "App::PropertyEnumeration", "Boundary", "Cage", say("What becomes of the boundary of the surface"))
            obj.Boundary = list(BOUNDARIES)
        add(obj, "App::PropertyBool", "Repair", "Cage", say("Split apart or turn round what a control mesh cannot hold"))
        for name in ("Vertices", "Edges", "Faces"):
            add(obj, "App::PropertyInteger", name, "Counts", say("Number in the control mesh"))
            obj.setEditorMode(name, 1)
        add(obj, "App::PropertyStringList", "Notes", "Counts", say("What the file holds and the control mesh does not"))
        obj.setEditorMode("Notes", 1)

    def onChanged(self, obj, name):
        if name in ("File", "Repair", "Boundary"):
            self._mesh = None
        if name == "File" and edited(obj) and "Points" in obj.PropertiesList:
            # They are those of the file before.
            obj.Points = []

    def mesh(self, obj):
        if getattr(self, "_mesh", None) is None:
            self._mesh = self._read(obj)
        points = obj.Points
        if len(points) == self._mesh.vertex_count:
            self._mesh.positions = [tuple(point) for point in points]
        return self._mesh

    def compute(self, obj):
        mesh = self.mesh(obj)
        if len(obj.Points) != mesh.vertex_count:
            # Another file than the points are of.
            obj.Points = [FreeCAD.Vector(*point) for point in mesh.positions.tolist()]
        obj.Vertices, obj.Edges, obj.Faces = mesh.vertex_count, mesh.edge_count, mesh.face_count
        obj.Notes = [f"{key}: {value}" for key, value in mesh.report.items() if value]
        obj.Shape = cage_shape(mesh)

    def _read(self, obj):
        welt = library()
        if not obj.File:
            raise Problem(translate("Welt", "The cage has no file: set the property File to an OBJ or PLY file"))
        if not os.path.exists(obj.File):
            raise Problem(
                translate("Welt", "The file of the cage, {}, is gone: set the property File to it again").format(obj.File)
            )
        mesh = welt.Mesh.read(obj.File, repair=obj.Repair)
        boundary = BOUNDARIES[obj.Boundary]
        if boundary:
            mesh.set_subdivision(boundary)
        return mesh


def make_cage(document, path):
    """A cage of a file in a document."""
    if not os.path.exists(path):
        raise Problem(translate("Welt", "There is no file {}: choose another").format(path))
    welt = library()
    try:
        # What cannot be read is told before there is an object.
        welt.Mesh.read(path).close()
    except welt.Error as error:
        raise Problem(str(error)) from None
    obj = document.addObject("Part::FeaturePython", "Cage")
    obj.Label = os.path.splitext(os.path.basename(path))[0]
    Cage(obj)
    obj.File = path
    from .views import show

    show(obj)
    return obj
