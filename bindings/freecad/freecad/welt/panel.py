"""Task panels: what an object is told while the document shows the result."""

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

from .feature import parameters, property_name
from .problems import sentence
from .views import icon

translate = FreeCAD.Qt.translate

#: Milliseconds after the last change until the document is computed anew.
DELAY = 300


class TaskPanel:
    """A form that changes an object while the document shows the result; Cancel leaves everything as it was."""

    def __init__(self, obj, title, picture):
        self.object = obj
        self.form = QtGui.QWidget()
        self.form.setObjectName("WeltPanel")
        self.form.setWindowTitle(title)
        self.form.setWindowIcon(QtGui.QIcon(icon(picture)))
        layout = QtGui.QFormLayout(self.form)
        self.fill(layout)
        self.message = QtGui.QLabel()
        self.message.setWordWrap(True)
        layout.addRow(self.message)
        self.timer = QtCore.QTimer(self.form)
        self.timer.setSingleShot(True)
        self.timer.setInterval(DELAY)
        self.timer.timeout.connect(self.update)
        self.update()

    def number(self, value):
        box = QtGui.QDoubleSpinBox()
        box.setDecimals(3)
        box.setRange(-1e6, 1e6)
        box.setValue(value)
        return box

    def update(self):
        """Computes the document and says how it went."""
        self.object.Document.recompute()
        broken = [obj for obj in (self.object, *self.object.InListRecursive) if not obj.isValid()]
        self.message.setText(sentence(broken[0].getStatusString()) if broken else "\n".join(self.notes()))

    def notes(self):
        """What is said where all is well."""
        return []

    def getStandardButtons(self):
        buttons = QtGui.QDialogButtonBox.Ok | QtGui.QDialogButtonBox.Cancel
        # Newer versions of Qt for Python have enumerations here.
        return buttons.value if hasattr(buttons, "value") else int(buttons)

    def accept(self):
        self.timer.stop()
        self.update()
        if not self.object.isValid():
            # The panel stays, with the sentence that says why.
            return False
        self.object.Document.commitTransaction()
        FreeCADGui.ActiveDocument.resetEdit()
        FreeCADGui.Control.closeDialog()
        return True

    def reject(self):
        self.timer.stop()
        document = self.object.Document
        document.abortTransaction()
        FreeCADGui.ActiveDocument.resetEdit()
        FreeCADGui.Control.closeDialog()
        document.recompute()
        return True


class FeaturePanel(TaskPanel):
    """The parameters of a feature."""

    def __init__(self, obj):
        super().__init__(obj, obj.Label, obj.Feature.title())

    def fill(self, layout):
        obj = self.object
        for parameter in parameters(obj.Feature, obj.Rules):
            self._row(layout, parameter)
        for name in ("Fit", "Parity"):
            self._choice(layout, name)

    def notes(self):
        return self.object.Warnings

    def _row(self, layout, parameter):
        obj, name = self.object, property_name(parameter)
        label = translate("Welt", name)
        if parameter["unit"] == "count":
            box = QtGui.QSpinBox()
            box.setRange(int(parameter["low"] or 0), int(parameter["high"] or 10000))
            box.setValue(getattr(obj, name))
            box.valueChanged.connect(lambda value: self.change(name, value))
        elif name + "Percent" in obj.PropertiesList:
            box = self._length(name)
        else:
            box = self.number(float(getattr(getattr(obj, name), "Value", getattr(obj, name))))
            box.valueChanged.connect(lambda value: self.change(name, value))
        box.setToolTip(parameter["help"])
        layout.addRow(label, box)

    def _length(self, name):
        """A length in the units of the document, or a part of the marked edges' length."""
        obj, row = self.object, QtGui.QWidget()
        layout = QtGui.QHBoxLayout(row)
        layout.setContentsMargins(0, 0, 0, 0)
        length = getattr(obj, name).Value
        box, unit = self.number(length or getattr(obj, name + "Percent")), QtGui.QComboBox()
        unit.addItems(["mm", translate("Welt", "% of edge")])
        unit.setCurrentIndex(0 if length else 1)
        # The panel of FreeCAD is narrow at first.
        for narrow in (box, unit):
            narrow.setMinimumWidth(60)

        def changed(*_):
            absolute = unit.currentIndex() == 0
            self.change(name, box.value() if absolute else 0.0)
            if not absolute:
                self.change(name + "Percent", box.value())

        box.valueChanged.connect(changed)
        unit.currentIndexChanged.connect(changed)
        layout.addWidget(box, 1)
        layout.addWidget(unit)
        return row

    def _choice(self, layout, name):
        box = QtGui.QComboBox()
        box.addItems(self.object.getEnumerationsOfProperty(name))
        box.setMinimumWidth(60)
        box.setCurrentText(getattr(self.object, name))
        box.currentTextChanged.connect(lambda text: self.change(name, text))
        layout.addRow(translate("Welt", name), box)

    def change(self, name, value):
        setattr(self.object, name, value)
        self.timer.start()
