"""Marks: which edges of a cage a feature crosses."""

import FreeCAD
import Part

from .objects import Proxy, add, edited, has_mesh, mesh_of
from .problems import Problem

translate = FreeCAD.Qt.translate

# How the selected elements are carried on.
PROPAGATIONS = ("Edges", "Ring", "Path", "Loop")


class Marks(Proxy):
    """Edges of a cage or of a feature, as links to its sub-elements, and how they are carried on:

    Edges: the selected edges alone.
    Ring: from each, all edges that a loop cut would cross.
    Path: from each to the next, the edges between them.
    Loop: all edges that leave the selected vertices and edges: a closed loop round them.
    """

    kind = "marks"

    def add_properties(self, obj):
        say = lambda text: translate("App::Property", text)
        add(obj, "App::PropertyLinkSub", "Elements", "Marks", say("Edges or vertices of a cage or a feature"))
        if "Propagation" not in obj.PropertiesList:
            add(obj, "App::PropertyEnumeration", "Propagation", "Marks", say("How the selected elements are carried on"))
            obj.Propagation = list(PROPAGATIONS)
            obj.Propagation = "Ring"
        add(obj, "App::PropertyFloatConstraint", "Place", "Marks", say("Where edges are crossed, from the vertex of the lesser number to the other"))
        if obj.Place == 0.0:
            obj.Place = (0.5, 0.01, 0.99, 0.05)
        add(obj, "App::PropertyInteger", "Count", "Marks", say("Number of marked edges"))
        obj.setEditorMode("Count", 1)
        # The vertices that the elements had when they were chosen: where they differ now, the marks are stale.
        add(obj, "App::PropertyStringList", "Known", "Marks", "")
        obj.setEditorMode("Known", 2)

    def placed_as(self, obj):
        return base_of(obj)

    def onChanged(self, obj, name):
        if name == "Elements" and edited(obj) and "Known" in obj.PropertiesList:
            obj.Known = []

    def compute(self, obj):
        if base_of(obj) is None:
            raise Problem(translate("Welt", "Nothing is marked: select edges of the cage and use Mark again"))
        mesh = mesh_of(base_of(obj))
        selection = mesh.select(selectors(obj, mesh))
        obj.Count = len(selection)
        positions = mesh.positions.tolist()
        ends, _ = selection.edges(mesh)
        obj.Shape = Part.Compound(
            [Part.makeLine(FreeCAD.Vector(*positions[a]), FreeCAD.Vector(*positions[b])) for a, b in ends.tolist()]
        )


def base_of(marks):
    """The cage or feature on which marks are."""
    if getattr(getattr(marks, "Proxy", None), "kind", "") != "marks":
        text = translate("Welt", "{} is no marks: set the property Marks to objects that the Mark commands made")
        raise Problem(text.format(marks.Label))
    return marks.Elements[0] if marks.Elements else None


def elements(obj, mesh):
    """The vertices of each marked element."""
    names = obj.Elements[1] if obj.Elements else ()
    if not any(names):
        raise Problem(translate("Welt", "Nothing is marked: select edges of the cage and use Mark again"))
    found = []
    for name, ends in vertices_of(mesh, names):
        if ends is None:
            raise stale(obj, name)
        found.append(ends)
    known = [",".join(map(str, ends)) for ends in found]
    if not obj.Known:
        obj.Known = known
    for name, before, now in zip(names, obj.Known, known):
        if before != now:
            raise stale(obj, name)
    return found


def vertices_of(mesh, names):
    """The vertices of each element: one of a vertex, two of an edge, the lesser first, None where the mesh has none such."""
    edges = mesh.edges.tolist()
    for name in names:
        kind, number = ("Edge", name[4:]) if name.startswith("Edge") else ("Vertex", name[6:])
        if not name.startswith(kind) or not number.isdigit():
            text = translate("Welt", "{} is no edge or vertex: select edges of the cage and use Mark again")
            raise Problem(text.format(name))
        index = int(number) - 1
        if not 0 <= index < (len(edges) if kind == "Edge" else mesh.vertex_count):
            yield name, None
        else:
            yield name, tuple(sorted(edges[index])) if kind == "Edge" else (index,)


def stale(obj, name):
    label = base_of(obj).Label
    return Problem(
        translate("Welt", "The marks are stale, {} of {} is not the one that was marked: select it anew and use Mark again").format(
            name, label
        )
    )


def selectors(obj, mesh):
    """The marks as selectors of the library."""
    found = elements(obj, mesh)
    if obj.Propagation == "Loop":
        return "cut:" + ",".join(map(str, sorted({vertex for ends in found for vertex in ends})))
    if any(len(ends) != 2 for ends in found):
        raise Problem(translate("Welt", "{} needs edges: select edges, or use the propagation Loop").format(obj.Propagation))
    if obj.Propagation == "Path":
        if len(found) < 2:
            raise Problem(translate("Welt", "A path needs two edges: select another edge as well"))
        return " ".join(f"path:{a},{b}:{c},{d}" for (a, b), (c, d) in zip(found, found[1:]))
    if obj.Propagation == "Ring":
        return " ".join(f"ring:{a},{b}" for a, b in found)
    return " ".join(f"edge:{a},{b}@{obj.Place!r}" for a, b in found)


def make_marks(base, names, propagation="Ring"):
    """Marks on elements of a cage or feature, such as ["Edge3"]."""
    if not has_mesh(base):
        mesh_of(base)
    obj = base.Document.addObject("Part::FeaturePython", "Marks")
    Marks(obj)
    obj.Elements = (base, list(names))
    obj.Propagation = propagation
    from .views import show

    show(obj)
    return obj
