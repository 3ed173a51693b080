"""Features: grooves, ridges, piping and the like on marked edges."""

import json
import os

import FreeCAD

from .marks import base_of, selectors
from .objects import Proxy, add, cage_shape, mesh_of
from .problems import Problem, library

try:
    import tomllib
except ImportError:
    # Before Python 3.11: a profile of one's own has the defaults that it declares.
    tomllib = None

translate = FreeCAD.Qt.translate

FITS = {"Surface, sliding": "surface_slide", "Surface": "surface", "Solve": "solve", "Loop": "loop", "None": "none"}
PARITIES = {"Automatic": "auto", "All quads": "all_quad", "Local": "local"}


class Feature(Proxy):
    """A feature of the library on marked edges. Its control mesh, like that of a cage, can carry further marks."""

    kind = "feature"

    def __init__(self, obj):
        super().__init__(obj)
        self._mesh = None

    def add_properties(self, obj):
        say = lambda text: translate("App::Property", text)
        add(obj, "App::PropertyLinkList", "Marks", "Feature", say("The marks, all on the same cage or feature"))
        add(obj, "App::PropertyString", "Feature", "Feature", say("The feature of the library"))
        obj.setEditorMode("Feature", 1)
        add(obj, "App::PropertyFile", "Rules", "Feature", say("Rule file or profile of one's own; read at every recompute"))
        for name, choices in (("Fit", FITS), ("Parity", PARITIES)):
            if name not in obj.PropertiesList:
                add(obj, "App::PropertyEnumeration", name, "Feature", say("How the cage is fitted to the surface before, and what becomes of odd faces"))
                setattr(obj, name, list(choices))
        add(obj, "App::PropertyBool", "Strict", "Feature", say("Marks that no rule handles are an error"))
        add(obj, "App::PropertyStringList", "Warnings", "Result", say("What the library warns of"))
        add(obj, "App::PropertyString", "Report", "Result", say("What was done, as JSON"))
        for name in ("Warnings", "Report"):
            obj.setEditorMode(name, 1)

    def placed_as(self, obj):
        return base_of(obj.Marks[0]) if obj.Marks else None

    def onChanged(self, obj, name):
        if name == "Rules":
            self._mesh = None

    def mesh(self, obj):
        if getattr(self, "_mesh", None) is None:
            # After a document was opened, or after a failure.
            self._mesh, _ = applied(obj)
        return self._mesh

    def compute(self, obj):
        self._mesh = None
        if obj.Feature == "rules" and os.path.isfile(obj.Rules):
            # Another file, or an edited one, may declare other parameters.
            add_parameters(obj)
        mesh, report = applied(obj)
        obj.Warnings = warnings(report)
        obj.Report = json.dumps(report)
        obj.Shape = cage_shape(mesh)
        self._mesh = mesh


def applied(obj):
    """The control mesh with the feature, and the report."""
    if not obj.Marks:
        raise Problem(translate("Welt", "The feature has no marks: set the property Marks, or delete the feature"))
    bases = {base_of(marks) for marks in obj.Marks}
    if len(bases) != 1:
        raise Problem(translate("Welt", "The marks are on different objects: use marks of one cage or feature"))
    base = mesh_of(bases.pop())
    mesh = base.copy()
    selection = mesh.select(" ".join(selectors(marks, base) for marks in obj.Marks))
    report = mesh.apply(
        selection,
        what(obj),
        settings(obj),
        fit=FITS[obj.Fit],
        parity=PARITIES[obj.Parity],
        strict=obj.Strict,
    )
    return mesh, report


def what(obj):
    """The feature or the rules, as the library takes them."""
    welt = library()
    if not obj.Feature == "rules":
        return obj.Feature
    if not os.path.isfile(obj.Rules):
        raise rules_gone(obj.Rules)
    return obj.Rules if obj.Rules.endswith(".toml") else welt.Rules(obj.Rules)


def parameters(name, path=""):
    """What a feature or a rule file declares: name, unit, default, low, high and help of each parameter."""
    welt = library()
    if name == "rules":
        return profile(path) if path.endswith(".toml") else [p._asdict() for p in welt.Rules(path).parameters]
    for feature in welt.features():
        if feature["name"] == name:
            return feature["parameters"]
    raise Problem(translate("Welt", "The library knows no feature {}: install the version that made the document").format(name))


def profile(path):
    """The parameters of a profile file, as features declare them."""
    if tomllib is None:
        return []
    try:
        with open(path, "rb") as file:
            content = tomllib.load(file)
    except OSError:
        raise rules_gone(path) from None
    except ValueError as error:
        raise Problem(f"{path}: {error}") from None
    whole = {"unit": "length", "low": None, "high": None, "help": "", "default": 0.0}
    return [{**whole, **parameter} for parameter in content.get("parameter", [])]


def rules_gone(path):
    return Problem(translate("Welt", "The rule file {} is gone: set the property Rules to a .rules or .toml file").format(path))


def property_name(parameter):
    return parameter["name"].title().replace("_", "").replace("-", "")


def add_parameters(obj):
    """Gives the object properties for the parameters that its feature declares. A length is one in the units of the document,
    or, where that is 0, a part of the marked edges' length."""
    for parameter in parameters(obj.Feature, obj.Rules):
        name, default = property_name(parameter), parameter["default"]
        if name in obj.PropertiesList:
            continue
        if parameter["unit"] == "count":
            add(obj, "App::PropertyIntegerConstraint", name, "Parameters", parameter["help"])
            setattr(obj, name, (int(default), int(parameter["low"] or 0), int(parameter["high"] or 10000), 1))
        elif parameter["unit"] == "length":
            relative = isinstance(default, str) and default.endswith("%")
            add(obj, "App::PropertyDistance", name, "Parameters", parameter["help"], 0.0 if relative else default)
            if relative:
                tooltip = translate("App::Property", "{} as a part of the marked edges' length, where {} is 0").format(name, name)
                add(obj, "App::PropertyFloat", name + "Percent", "Parameters", tooltip, float(default[:-1]))
        else:
            add(obj, "App::PropertyFloat", name, "Parameters", parameter["help"], float(default))


def settings(obj):
    """The parameters as settings of the library."""
    chosen = {}
    for parameter in parameters(obj.Feature, obj.Rules):
        name = property_name(parameter)
        if name not in obj.PropertiesList:
            continue
        value = getattr(obj, name)
        value = getattr(value, "Value", value)
        percent = name + "Percent"
        if percent in obj.PropertiesList and value == 0.0:
            value = f"{getattr(obj, percent)!r}%"
        chosen[parameter["name"]] = value
    return chosen


def warnings(report):
    """The sentences of a report that a user should see."""
    said = [warned(warning) for warning in report.get("warnings", [])]
    left = len(report.get("leftovers", []))
    if left:
        said.append(translate("Welt", "{} marks were left over: no rule fits there").format(left))
    return said


def warned(warning):
    """A warning of a report as a sentence."""
    if warning.get("kind") == "fold":
        text = translate("Welt", "The limit surface folds at {} vertices: ask for less depth or more width")
        return text.format(len(warning["vertices"]))
    if warning.get("kind") == "wall":
        text = translate("Welt", "A depth of {:.4g} exceeds the wall, which is {:.4g} thick: ask for less depth")
        return text.format(warning["depth"], warning["thickness"])
    return str(warning)


def make_feature(marks, name, rules="", **values):
    """A feature on marks; values are of its properties, such as Width=1.6."""
    document = marks[0].Document
    # What cannot be read is told before there is an object.
    parameters(name, rules)
    obj = document.addObject("Part::FeaturePython", "Rules" if name == "rules" else name.title())
    Feature(obj)
    obj.Feature = name
    if rules:
        obj.Rules = rules
    obj.Marks = list(marks)
    add_parameters(obj)
    for key, value in values.items():
        setattr(obj, key, value)
    from .views import show

    show(obj)
    return obj
