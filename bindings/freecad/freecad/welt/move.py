"""Moving vertices of a cage."""

import FreeCAD

from .marks import vertices_of
from .panel import TaskPanel

translate = FreeCAD.Qt.translate


def move(cage, vertices, offset, points=None):
    """Moves vertices, 0-based, of a cage by a vector in its own coordinates, from where they are or from points."""
    chosen = set(vertices)
    cage.Points = [p + offset if i in chosen else p for i, p in enumerate(points or cage.Points)]


class MovePanel(TaskPanel):
    """By how much the vertices of the selected elements of a cage are moved."""

    def __init__(self, cage, names):
        self.vertices = {v for _, ends in vertices_of(cage.Proxy.mesh(cage), names) for v in ends or ()}
        self.points = cage.Points
        super().__init__(cage, translate("Welt", "Move vertices"), "Move")

    def fill(self, layout):
        self.boxes = [self.number(0.0) for _ in "xyz"]
        for axis, box in zip("xyz", self.boxes):
            box.valueChanged.connect(self.change)
            layout.addRow(axis, box)

    def change(self, *_):
        move(self.object, self.vertices, FreeCAD.Vector(*(box.value() for box in self.boxes)), self.points)
        self.timer.start()

    def notes(self):
        return [translate("Welt", "Number of vertices that are moved: {}").format(len(self.vertices))]
