"""The workbench, where FreeCAD has a window."""

import os

import FreeCAD
import FreeCADGui

from .views import icon


class WeltWorkbench(FreeCADGui.Workbench):
    MenuText = "Welt"
    ToolTip = FreeCAD.Qt.translate("Workbench", "Grooves, ridges and seams on subdivision surfaces")
    Icon = icon("Workbench")

    def Initialize(self):
        from . import commands

        commands.register()
        for title, names in commands.TOOLBARS.items():
            self.appendToolbar(title, names)
            self.appendMenu("&Welt", names + ["Separator"])

    def GetClassName(self):
        return "Gui::PythonWorkbench"


FreeCADGui.addLanguagePath(os.path.join(os.path.dirname(__file__), "Resources", "translations"))
FreeCADGui.addWorkbench(WeltWorkbench())
