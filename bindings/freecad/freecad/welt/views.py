"""How objects look in the tree and in the 3D view."""

import os

import FreeCAD

from .objects import Stateless

ICONS = os.path.join(os.path.dirname(__file__), "Resources", "icons")


def icon(name):
    return os.path.join(ICONS, f"Welt{name}.svg")


class View(Stateless):
    """The view of an object of the workbench."""

    def __init__(self, vobj):
        vobj.Proxy = self

    def attach(self, vobj):
        self.object = vobj.Object
        if self.object.isDerivedFrom("Mesh::Feature"):
            # Clicks go through the surface to the edges of the cage.
            from pivy import coin

            style = coin.SoPickStyle()
            style.style = coin.SoPickStyle.UNPICKABLE
            vobj.RootNode.insertChild(style, 0)

    def getIcon(self):
        obj = self.object
        kind = obj.Proxy.kind if obj.Proxy else "cage"
        return icon((obj.Feature if kind == "feature" else kind).title())

    def claimChildren(self):
        """The tree shows what a feature is made of below it."""
        obj = self.object
        kind = obj.Proxy.kind if obj.Proxy else ""
        if kind == "feature":
            return obj.Marks
        if kind == "marks" and obj.Elements:
            return [obj.Elements[0]]
        return []


LOOKS = {
    "cage": {"LineColor": (0.15, 0.2, 0.3), "PointColor": (0.15, 0.2, 0.3), "LineWidth": 2.0, "PointSize": 4.0},
    "feature": {"LineColor": (0.1, 0.35, 0.6), "PointColor": (0.1, 0.35, 0.6), "LineWidth": 2.0, "PointSize": 3.0},
    "marks": {"LineColor": (0.85, 0.1, 0.1), "PointColor": (0.85, 0.1, 0.1), "LineWidth": 4.0, "PointSize": 4.0},
    "limit": {"ShapeColor": (0.8, 0.8, 0.78), "Lighting": "Two side"},
    "deviation": {"Lighting": "Two side"},
    # Fine enough for a groove.
    "solid": {"ShapeColor": (0.8, 0.8, 0.78), "Deviation": 0.1, "AngularDeflection": 10.0},
}


def show(obj):
    """Gives an object its view, where there is a view."""
    if not FreeCAD.GuiUp:
        return
    View(obj.ViewObject)
    for name, value in LOOKS.get(obj.Proxy.kind, {}).items():
        if name in obj.ViewObject.PropertiesList:
            setattr(obj.ViewObject, name, value)
