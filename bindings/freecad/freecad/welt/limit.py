"""The limit surface of a cage or a feature, as a mesh object; and how far it is from another, as colours."""

import io
import math
import struct

import FreeCAD
import Mesh

from .objects import Proxy, add, mesh_of
from .problems import Problem

translate = FreeCAD.Qt.translate


class Limit(Proxy):
    """The limit surface: the cage refined, every vertex moved to its limit."""

    kind = "limit"

    def add_properties(self, obj):
        say = lambda text: translate("App::Property", text)
        add(obj, "App::PropertyLink", "Base", "Limit surface", say("The cage or the feature whose limit surface is shown"))
        if "Level" not in obj.PropertiesList:
            add(obj, "App::PropertyIntegerConstraint", "Level", "Limit surface", say("How often each face is divided by four"))
            obj.Level = (2, 0, 6, 1)

    def placed_as(self, obj):
        return obj.Base

    def compute(self, obj):
        positions, faces = limit_mesh(mesh_of(obj.Base), obj.Level)
        obj.Mesh = faceted(positions, faces)


class Deviation(Limit):
    """The limit surface, coloured by its distance from that of another cage or feature."""

    kind = "deviation"

    def add_properties(self, obj):
        super().add_properties(obj)
        say = lambda text: translate("App::Property", text)
        add(obj, "App::PropertyLink", "Reference", "Deviation", say("The cage or the feature to compare with"))
        add(obj, "App::PropertyDistance", "Scale", "Deviation", say("The distance that is red; 0 for the largest there is"))
        for name in ("Largest", "RootMeanSquare"):
            add(obj, "App::PropertyDistance", name, "Deviation", say("Distance of the points of the mesh"))
            obj.setEditorMode(name, 1)
        add(obj, "App::PropertyColorList", "VertexColors", "Deviation", "")
        obj.setEditorMode("VertexColors", 2)

    def compute(self, obj):
        if obj.Reference is None:
            raise Problem(translate("Welt", "There is nothing to compare with: set the property Reference to a cage or feature"))
        reference = mesh_of(obj.Reference).freeze()
        positions, faces = limit_mesh(mesh_of(obj.Base), obj.Level)
        found = reference.closest(positions, threads=0)
        distances = [float(d) for d in (found["distance"] if hasattr(found, "dtype") else (p.distance for p in found))]
        obj.Mesh = faceted(positions, faces)
        largest = max(distances, default=0.0)
        obj.Largest = largest
        obj.RootMeanSquare = (sum(d * d for d in distances) / max(len(distances), 1)) ** 0.5
        scale = obj.Scale.Value or largest or 1.0
        obj.VertexColors = [heat(d / scale) for d in distances]
        if FreeCAD.GuiUp:
            # Colours are taken over when colouring is switched on.
            obj.ViewObject.Coloring = False
            obj.ViewObject.Coloring = True


def limit_mesh(mesh, level):
    """Points of the limit surface, (n, 3) numbers, and the vertices of its faces."""
    refined = mesh.refine(level)
    # The control face of each face.
    faces = range(mesh.face_count)
    for number in range(1, level + 1):
        faces = [faces[parent] for parent in refined.face_parents(number)[0].tolist()]
    fine = refined.mesh(level)
    positions, polygons = fine.limit_positions().tolist(), fine.faces
    absent = set(absent_faces(mesh))
    if not absent:
        return positions, polygons
    kept = [polygon for polygon, face in zip(polygons, faces) if face not in absent]
    used = sorted({vertex for polygon in kept for vertex in polygon})
    number_of = {vertex: number for number, vertex in enumerate(used)}
    return [positions[vertex] for vertex in used], [[number_of[vertex] for vertex in polygon] for polygon in kept]


def absent_faces(mesh):
    """Faces that are no part of the surface: holes, and what the boundary rule leaves out."""
    count = mesh.face_count
    middles = mesh.freeze().evaluate(range(count), [(0.5, 0.5)] * count).tolist()
    return [face for face, ((x, *_),) in enumerate(middles) if math.isnan(x)]


def faceted(positions, faces):
    """A mesh of FreeCAD, through a binary PLY: the quick way in, and the one that keeps the numbers of vertices."""
    triangles = [(face[0], face[i], face[i + 1]) for face in faces for i in range(1, len(face) - 1)]
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(positions)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    body = b"".join([struct.pack("<3f", *p) for p in positions] + [struct.pack("<B3i", 3, *t) for t in triangles])
    result = Mesh.Mesh()
    result.read(Stream=io.BytesIO(head.encode() + body), Format="PLY")
    return result


def heat(part):
    """Blue, green, yellow, red for 0 to 1."""
    part = min(max(part, 0.0), 1.0)
    return (min(2 * part, 1.0), min(4 * part, 1.0, 4 - 4 * part) if part < 1 else 0.0, max(1 - 2 * part, 0.0))


def make_limit(base, level=2):
    return _make(base.Document, "Limit", Limit, Base=base, Level=level)


def make_deviation(base, reference, level=2):
    return _make(base.Document, "Deviation", Deviation, Base=base, Reference=reference, Level=level)


def _make(document, name, proxy, **values):
    mesh_of(values["Base"])
    obj = document.addObject("Mesh::FeaturePython", name)
    proxy(obj)
    for key, value in values.items():
        setattr(obj, key, value)
    from .views import show

    show(obj)
    return obj
