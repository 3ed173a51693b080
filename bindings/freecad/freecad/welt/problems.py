"""What goes wrong, told in one sentence."""

import sys

import FreeCAD

translate = FreeCAD.Qt.translate


class Problem(Exception):
    """A sentence for the user, with the remedy."""


def library():
    """The Python package of the library."""
    try:
        import welt
    except ImportError as error:
        raise Problem(
            translate(
                "Welt", "The welt library is not usable: {}; install the addon again (bindings/freecad/install.py) and start FreeCAD again."
            ).format(str(error).partition("; install the package")[0].rstrip("."))
        ) from None
    return welt


def sentence(error):
    """One line for whatever a computation raised."""
    text = " ".join(str(error).split()) or type(error).__name__
    place = next((place for place in getattr(error, "places", ()) if place.file and place.line), None)
    if place and place.file not in text:
        return f"{place.file}:{place.line}: {text}."
    return text[0].upper() + text[1:] + ("" if text.endswith((".", "!", "?")) else ".")


class _Restore:
    """Puts the limit of tracebacks back when the document was recomputed."""

    def __init__(self):
        self.before = None

    def silence(self):
        if self.before is None:
            self.before = (getattr(sys, "tracebacklimit", 1000),)
            sys.tracebacklimit = 0
            FreeCAD.addDocumentObserver(self)

    def slotRecomputedDocument(self, _document):
        if self.before is not None:
            sys.tracebacklimit = self.before[0]
            self.before = None
            FreeCAD.removeDocumentObserver(self)


_restore = _Restore()


class _Named(type):
    """FreeCAD prints the class of an exception before its text."""

    def __str__(cls):
        return "Welt"

    __repr__ = __str__


class Refusal(RuntimeError, metaclass=_Named):
    """What an object's `execute` tells."""


def refuse(error):
    """Raises what an object's `execute` has to tell. FreeCAD shows it at the object, and prints it with Python's traceback
    unless that is limited: users need the sentence alone."""
    _restore.silence()
    raise Refusal(sentence(error)) from None
