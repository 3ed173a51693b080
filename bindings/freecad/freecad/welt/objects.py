"""What all objects of the workbench have in common, and how a control mesh becomes a shape."""

import FreeCAD
import Part

from .problems import Problem, library, refuse

translate = FreeCAD.Qt.translate


class Stateless:
    """What FreeCAD stores in a document about an object of Python: nothing, properties hold all."""

    def dumps(self):
        return None

    def loads(self, _state):
        return None

    # The names of FreeCAD 0.20.
    __getstate__ = dumps
    __setstate__ = loads


class Proxy(Stateless):
    """A document object whose data is Python's. Subclasses give `kind`, `add_properties` and `compute`."""

    kind = ""

    def __init__(self, obj):
        obj.Proxy = self
        self.add_properties(obj)

    def execute(self, obj):
        try:
            welt = library()
            self.compute(obj)
        except Problem as problem:
            refuse(problem)
        except welt.Error as error:
            refuse(error)
        # Shapes are made where the cage lies.
        base = self.placed_as(obj)
        if base is not None and obj.Placement != base.Placement:
            obj.Placement = base.Placement

    def onDocumentRestored(self, obj):
        """Documents of earlier versions get the properties that are new."""
        self.add_properties(obj)

    def placed_as(self, _obj):
        """The object whose placement this one copies."""
        return None


def add(obj, kind, name, group, tooltip, value=None):
    """Adds a property unless it is there."""
    if name in obj.PropertiesList:
        return
    obj.addProperty(kind, name, group, tooltip)
    if value is not None:
        setattr(obj, name, value)


def edited(obj):
    """Whether a property changes because somebody sets it, and not because a document is opened, or something undone."""
    return not obj.Document.Restoring and not obj.Document.Transacting


def has_mesh(obj):
    """Whether an object gives a control mesh: a cage, or a feature on one."""
    return callable(getattr(getattr(obj, "Proxy", None), "mesh", None))


def mesh_of(obj):
    """The control mesh of a cage or a feature; not to be changed."""
    if obj is None:
        raise Problem(translate("Welt", "The cage is gone: choose another, or delete this object"))
    if not has_mesh(obj):
        raise Problem(
            translate("Welt", "{} is no cage: choose one that Import cage made, or a feature on one").format(obj.Label)
        )
    return obj.Proxy.mesh(obj)


def cage_shape(mesh):
    """Vertices and edges of a control mesh, of which Vertex i + 1 and Edge i + 1 are number i of the mesh."""
    vertices = [Part.Vertex(*point) for point in mesh.positions.tolist()]
    edges = []
    for a, b in mesh.edges.tolist():
        try:
            edges.append(Part.Edge(vertices[a], vertices[b]))
        except Part.OCCError:
            raise Problem(
                translate("Welt", "Vertices {} and {} of an edge are at the same place: move one of them").format(a, b)
            ) from None
    return Part.Compound(vertices + edges)
