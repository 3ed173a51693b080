"""The commands of the workbench."""


import FreeCAD
import FreeCADGui
from PySide import QtGui

from . import selection as chosen
from .problems import Problem, library, sentence
from .views import icon

translate = FreeCAD.Qt.translate


def QT_TRANSLATE_NOOP(_context, text):
    return text


def tell(error):
    """One sentence for the user, in a box and in the report view."""
    FreeCAD.Console.PrintError(sentence(error) + "\n")
    QtGui.QMessageBox.warning(FreeCADGui.getMainWindow(), translate("Welt", "Welt"), sentence(error))


class Command:
    """A command with its icon and texts. What `run` raises as a Problem is told in one sentence, and undone."""

    name, menu, tooltip = "", "", ""
    needs_document = True

    def GetResources(self):
        return {
            "Pixmap": icon(self.name),
            "MenuText": translate("Welt", self.menu),
            "ToolTip": translate("Welt", self.tooltip),
        }

    def IsActive(self):
        return not self.needs_document or FreeCAD.ActiveDocument is not None

    def Activated(self):
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument()
        document.openTransaction(translate("Welt", self.menu))
        try:
            keep_open = self.run(document, FreeCADGui.Selection.getSelectionEx())
        except Problem as problem:
            document.abortTransaction()
            tell(problem)
            return
        except Exception as error:
            # welt.Error, told like a Problem; whatever else is a defect and comes with its traceback.
            document.abortTransaction()
            if type(error).__module__.partition(".")[0] != "welt":
                raise
            tell(error)
            return
        if not keep_open:
            document.commitTransaction()
            document.recompute()
            broken = [obj for obj in document.Objects if not obj.isValid() and hasattr(getattr(obj, "Proxy", None), "kind")]
            if broken:
                tell(broken[-1].getStatusString())


class ImportCage(Command):
    name = "Cage"
    menu = QT_TRANSLATE_NOOP("Welt", "Import cage...")
    tooltip = QT_TRANSLATE_NOOP("Welt", "Read a control mesh from an OBJ or PLY file into the document")
    needs_document = False

    def run(self, document, _selection):
        library()
        title, kinds = translate("Welt", "Import cage"), translate("Welt", "Control meshes (*.obj *.ply)")
        path = QtGui.QFileDialog.getOpenFileName(FreeCADGui.getMainWindow(), title, "", kinds)[0]
        if path:
            self.read(document, path)

    def read(self, document, path):
        from .cage import make_cage
        from .limit import make_limit

        obj = make_cage(document, path)
        # The cage is to be seen through the surface, so that its edges can be chosen.
        make_limit(obj).ViewObject.Transparency = 70
        document.recompute()
        FreeCADGui.SendMsgToActiveView("ViewFit")
        return obj


class MoveVertices(Command):
    name = "Move"
    menu = QT_TRANSLATE_NOOP("Welt", "Move vertices")
    tooltip = QT_TRANSLATE_NOOP("Welt", "Move the selected vertices of a cage; features follow")

    def run(self, document, selection):
        from .move import MovePanel

        base, names = chosen.chosen_elements(selection)
        if base.Proxy.kind != "cage":
            text = translate("Welt", "The vertices of {} follow from its cage: select vertices of the cage").format(base.Label)
            raise Problem(text)
        FreeCADGui.Control.showDialog(MovePanel(base, names))
        return True


class Mark(Command):
    """Marks of one propagation."""

    texts = {
        "Edges": QT_TRANSLATE_NOOP("Welt", "Mark the selected edges"),
        "Ring": QT_TRANSLATE_NOOP("Welt", "Mark all edges that a loop cut from the selected edge would cross"),
        "Path": QT_TRANSLATE_NOOP("Welt", "Mark the edges between the selected edges"),
        "Loop": QT_TRANSLATE_NOOP("Welt", "Mark a closed loop round the selected vertices or edges"),
    }

    def __init__(self, propagation):
        self.propagation = propagation
        self.name = "Mark" + propagation
        self.menu = {
            "Edges": QT_TRANSLATE_NOOP("Welt", "Mark edges"),
            "Ring": QT_TRANSLATE_NOOP("Welt", "Mark ring"),
            "Path": QT_TRANSLATE_NOOP("Welt", "Mark path"),
            "Loop": QT_TRANSLATE_NOOP("Welt", "Mark loop"),
        }[propagation]
        self.tooltip = self.texts[propagation]

    def run(self, document, selection):
        from .marks import make_marks

        base, names = chosen.chosen_elements(selection)
        marks = make_marks(base, names, self.propagation)
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(marks)


class MakeFeature(Command):
    """A feature of the library, with a panel for its parameters."""

    texts = {
        "groove": (QT_TRANSLATE_NOOP("Welt", "Groove"), QT_TRANSLATE_NOOP("Welt", "Press a seam into the surface along the marks")),
        "ridge": (QT_TRANSLATE_NOOP("Welt", "Ridge"), QT_TRANSLATE_NOOP("Welt", "Raise a ridge along the marks")),
        "piping": (QT_TRANSLATE_NOOP("Welt", "Piping"), QT_TRANSLATE_NOOP("Welt", "Sew a cord between two grooves along the marks")),
        "dent": (QT_TRANSLATE_NOOP("Welt", "Dent"), QT_TRANSLATE_NOOP("Welt", "Press in what a closed loop of marks bounds")),
        "step": (QT_TRANSLATE_NOOP("Welt", "Step"), QT_TRANSLATE_NOOP("Welt", "Make a step along the marks")),
        "bead": (QT_TRANSLATE_NOOP("Welt", "Bead"), QT_TRANSLATE_NOOP("Welt", "Raise a band with a broad top along the marks")),
        "loop": (QT_TRANSLATE_NOOP("Welt", "Loop"), QT_TRANSLATE_NOOP("Welt", "Insert edge loops; the surface stays as it is")),
        "rules": (
            QT_TRANSLATE_NOOP("Welt", "Custom rules..."),
            QT_TRANSLATE_NOOP("Welt", "Apply a rule file or a profile of one's own along the marks"),
        ),
    }

    def __init__(self, feature):
        self.feature = feature
        self.name = feature.title()
        self.menu, self.tooltip = self.texts[feature]

    def run(self, document, selection):
        from .feature import make_feature
        from .panel import FeaturePanel

        library()
        marks = chosen.marks_of(selection)
        rules = ""
        if self.feature == "rules":
            title, kinds = translate("Welt", "Custom rules"), translate("Welt", "Rules and profiles (*.rules *.toml)")
            rules = QtGui.QFileDialog.getOpenFileName(FreeCADGui.getMainWindow(), title, "", kinds)[0]
            if not rules:
                raise Problem(translate("Welt", "No rule file was chosen: the feature is not made"))
        obj = make_feature(marks, self.feature, rules)
        for limit in chosen.follow(obj):
            limit.ViewObject.Transparency = 0
        for hidden in marks + [marks[0].Elements[0], obj]:
            hidden.ViewObject.Visibility = False
        FreeCADGui.Control.showDialog(FeaturePanel(obj))
        return True


class MakeLimit(Command):
    name = "Limit"
    menu = QT_TRANSLATE_NOOP("Welt", "Limit surface")
    tooltip = QT_TRANSLATE_NOOP("Welt", "Show the limit surface of a cage or a feature")

    def run(self, document, selection):
        from .limit import make_limit

        make_limit(chosen.chosen_meshes(selection, 1, translate("Welt", "one cage or feature"))[0])


class MakeDeviation(Command):
    name = "Deviation"
    menu = QT_TRANSLATE_NOOP("Welt", "Deviation map")
    tooltip = QT_TRANSLATE_NOOP("Welt", "Colour a limit surface by its distance from another: select the new one, then the one before")

    def run(self, document, selection):
        from .limit import make_deviation

        base, reference = chosen.chosen_meshes(selection, 2, translate("Welt", "two cages or features"))
        chosen.hide_limits(base)
        make_deviation(base, reference)


class MakeSolid(Command):
    name = "Solid"
    menu = QT_TRANSLATE_NOOP("Welt", "To solid")
    tooltip = QT_TRANSLATE_NOOP("Welt", "Make a solid of B-spline faces (BRep) of the limit surface of a cage or a feature")

    def run(self, document, selection):
        from .solid import make_solid

        base = chosen.chosen_meshes(selection, 1, translate("Welt", "one cage or feature"))[0]
        chosen.hide_limits(base)
        make_solid(base)


FEATURES = ("Groove", "Ridge", "Piping", "Dent", "Step", "Bead", "Loop", "Rules")
MARKS = ("Edges", "Ring", "Path", "Loop")
TOOLBARS = {
    QT_TRANSLATE_NOOP("Workbench", "Welt cage"): ["Welt_Cage", "Welt_Move"] + [f"Welt_Mark{name}" for name in MARKS],
    QT_TRANSLATE_NOOP("Workbench", "Welt features"): [f"Welt_{name}" for name in FEATURES],
    QT_TRANSLATE_NOOP("Workbench", "Welt surface"): ["Welt_Limit", "Welt_Deviation", "Welt_Solid"],
}


def register():
    """Makes the commands known to FreeCAD."""
    commands = [ImportCage(), MoveVertices(), MakeLimit(), MakeDeviation(), MakeSolid()]
    commands += [Mark(name) for name in MARKS] + [MakeFeature(name.lower()) for name in FEATURES]
    for command in commands:
        FreeCADGui.addCommand("Welt_" + command.name, command)
