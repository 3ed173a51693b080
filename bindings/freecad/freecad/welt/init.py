"""Documents that were saved where the addon was absent: FreeCAD keeps their properties, and forgets whose they are."""

import FreeCAD

# A property that only objects of the kind have.
KINDS = (
    ("Known", "marks", "Marks"),
    ("Marks", "feature", "Feature"),
    ("Repair", "cage", "Cage"),
    ("MostFaces", "solid", "Solid"),
    ("Reference", "limit", "Deviation"),
    ("Level", "limit", "Limit"),
)


class Observer:
    """Gives such objects their data back when their document becomes the active one, as one that is opened does."""

    def slotActivateDocument(self, document):
        if document.Restoring:
            return
        for obj in document.Objects:
            if getattr(obj, "Proxy", 0) is None:
                adopt(obj)


def adopt(obj):
    from importlib import import_module

    names = obj.PropertiesList
    for name, module, proxy in KINDS:
        if name in names and obj.getGroupOfProperty(name) in GROUPS:
            getattr(import_module(f"freecad.welt.{module}"), proxy)(obj)
            from .views import show

            show(obj)
            return


# The groups of those properties.
GROUPS = ("Marks", "Feature", "Cage", "Solid", "Deviation", "Limit surface")

FreeCAD.addDocumentObserver(Observer())
