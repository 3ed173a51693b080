"""What the user has selected, as what a command needs."""

import FreeCAD

from .marks import base_of, make_marks
from .objects import has_mesh
from .problems import Problem

translate = FreeCAD.Qt.translate


def is_marks(obj):
    return getattr(getattr(obj, "Proxy", None), "kind", "") == "marks"


def chosen_elements(selection):
    """The one cage or feature with selected edges or vertices, and their names."""
    if not selection:
        raise Problem(translate("Welt", "Nothing is selected: select edges of a cage first"))
    bases = [s for s in selection if has_mesh(s.Object)]
    if not bases:
        raise Problem(
            translate("Welt", "{} is no cage: select edges of an object that Import cage made, or of a feature on one").format(
                selection[0].Object.Label
            )
        )
    if len(bases) > 1:
        raise Problem(translate("Welt", "Edges of several objects are selected: select those of one cage or feature"))
    names = [name for name in bases[0].SubElementNames if name.startswith(("Edge", "Vertex"))]
    if not names:
        raise Problem(translate("Welt", "No edge of {} is selected: click on edges in the 3D view").format(bases[0].Object.Label))
    return bases[0].Object, names


def marks_of(selection):
    """The selected marks; or marks made of the selected edges: rings, the usual case, or a loop round selected vertices."""
    marks = [s.Object for s in selection if is_marks(s.Object)]
    if marks:
        return marks
    base, names = chosen_elements(selection)
    return [make_marks(base, names, "Ring" if all(name.startswith("Edge") for name in names) else "Loop")]


def chosen_meshes(selection, count, wanted):
    """So many cages or features."""
    found = [s.Object for s in selection if has_mesh(s.Object)]
    if len(found) != count:
        if not selection:
            raise Problem(translate("Welt", "Nothing is selected: select {} first").format(wanted))
        raise Problem(translate("Welt", "Select {} and nothing else, not {} objects").format(wanted, len(selection)))
    return found


def follow(obj):
    """Lets the limit surfaces of a feature's base show the feature, or makes one; gives them."""
    from .limit import make_limit

    shown = limits_of(base_of(obj.Marks[0]))
    for limit in shown:
        limit.Base = obj
    return shown or [make_limit(obj)]


def limits_of(base):
    """The limit surfaces that show a cage or feature."""
    return [o for o in base.InList if getattr(getattr(o, "Proxy", None), "kind", "") == "limit" and o.Base == base]


def hide_limits(base):
    """Makes room for what shows the same surface."""
    for limit in limits_of(base):
        limit.ViewObject.Visibility = False
