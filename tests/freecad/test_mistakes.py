"""What users get wrong: one sentence with the remedy, no traceback, nothing lost."""

import os
import types

import FreeCAD
from support import Case, edge_name, run, torus

from freecad.welt import selection
from freecad.welt.cage import make_cage
from freecad.welt.feature import make_feature
from freecad.welt.limit import make_deviation, make_limit
from freecad.welt.marks import make_marks
from freecad.welt.problems import Problem, sentence


def chosen(obj, *names):
    return types.SimpleNamespace(Object=obj, SubElementNames=names)


class Selected(Case):
    def says(self, sentence, action, *arguments):
        count = len(self.document.Objects)
        with self.assertRaisesRegex(Problem, sentence) as caught:
            action(*arguments)
        self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(len(self.document.Objects), count, "nothing was made")

    def test_nothing_and_wrong_objects(self):
        cage = self.cage(torus(8, 6))
        box = self.document.addObject("Part::Box", "Box")
        self.says("Nothing is selected: select edges of a cage first", selection.marks_of, [])
        self.says("Box is no cage: select edges of an object that Import cage made", selection.marks_of, [chosen(box, "Edge1")])
        self.says("No edge of cage is selected: click on edges", selection.marks_of, [chosen(cage)])
        self.says("select those of one cage", selection.marks_of, [chosen(cage, "Edge1"), chosen(self.cage(), "Edge1")])
        self.says("Select two cages or features and nothing else", selection.chosen_meshes, [chosen(cage)], 2, "two cages or features")
        self.says("Box is no cage", make_limit, box)
        self.says("Box is no cage", make_marks, box, ["Edge1"])
        made = selection.marks_of([chosen(cage, "Edge1", "Edge2")])
        self.assertEqual((len(made), made[0].Propagation), (1, "Ring"))
        self.assertEqual(selection.marks_of([chosen(made[0])]), made)

    def test_files(self):
        self.says("There is no file /nowhere/chair.obj: choose another", make_cage, self.document, "/nowhere/chair.obj")
        with open(self.path("bad.obj"), "w") as file:
            file.write("v 0 0 0\nv 1 zero 0\n")
        self.says(r"bad.obj:2", make_cage, self.document, self.path("bad.obj"))


class Recomputed(Case):
    def test_a_width_too_large(self):
        groove = self.groove(self.cage(), 0, 1, Width=1.0)
        before = groove.Proxy.mesh(groove).positions.tolist()
        shape = len(groove.Shape.Edges)
        groove.Width = 500
        self.refused(groove, r"A width of 500.* does not fit edge .* it takes widths from .* to .*\.$")
        self.assertEqual(len(groove.Shape.Edges), shape, "the shape is as it was")
        groove.Width = 1.0
        self.recompute()
        self.assertEqual(groove.Proxy.mesh(groove).positions.tolist(), before)

    def test_stale_marks(self):
        cage = self.cage()
        first = self.groove(cage, 0, 1, Width=1.0)
        second = self.groove(first, 505, 506, Width=1.0)
        on_new = self.groove(first, *first.Proxy.mesh(first).edges.tolist()[-1], propagation="Edges")
        marks = first.Marks[0]
        elements = marks.Elements
        marks.Elements = (cage, [edge_name(cage, 0, 1), edge_name(cage, 10, 11)])
        said = self.refused(on_new.Marks[0], "The marks are stale, Edge.* of Groove is not the one that was marked: select it anew")
        self.assertIn("use Mark again", said)
        self.assertTrue(first.isValid())
        marks.Elements = elements
        self.recompute()
        second.Marks[0].Elements = (first, ["Edge99999"])
        self.refused(second.Marks[0], "The marks are stale, Edge99999")
        second.Marks[0].Elements = (first, [edge_name(first, 505, 506)])
        self.recompute()

    def test_objects_that_are_gone(self):
        cage = self.cage()
        groove = self.groove(cage, 0, 1)
        limit = make_limit(groove)
        deviation = make_deviation(groove, cage)
        self.recompute()
        deviation.Reference = None
        self.refused(deviation, "There is nothing to compare with: set the property Reference")
        self.document.removeObject(groove.Marks[0].Name)
        self.refused(groove, "The feature has no marks: set the property Marks, or delete the feature")
        self.document.removeObject(groove.Name)
        self.refused(limit, "The cage is gone: choose another, or delete this object")
        limit.Base = cage
        deviation.Base = deviation.Reference = cage
        self.recompute()

    def test_marks_that_are_none(self):
        cage = self.cage()
        groove = self.groove(cage, 0, 1)
        marks = groove.Marks
        for wrong in (cage, self.document.addObject("Part::Box", "Box")):
            groove.Marks = [wrong]
            self.refused(groove, f"(?i){wrong.Label} is no marks: set the property Marks to")
        groove.Marks = marks
        self.recompute()

    def test_a_depth_that_folds(self):
        groove = self.groove(self.cage(), 0, 1, Width=1.0, Depth=1000)
        self.assertRegex(groove.Warnings[0], "The limit surface folds at [0-9]+ vertices: ask for less depth or more width")

    def test_another_rule_file(self):
        profiles = os.path.join(os.environ["WELT_REPOSITORY"], "profiles")
        made = make_feature([make_marks(self.cage(), ["Edge1"])], "rules", os.path.join(profiles, "groove.toml"))
        self.recompute()
        made.Rules = os.path.join(profiles, "piping.toml")
        self.recompute()
        self.assertIn("Height", made.PropertiesList)

    def test_marks_that_are_too_few(self):
        cage = self.cage()
        marks = make_marks(cage, [edge_name(cage, 0, 1)], "Path")
        self.refused(marks, "A path needs two edges: select another edge as well")
        marks.Propagation = "Ring"
        marks.Elements = (cage, ["Vertex1"])
        self.refused(marks, "Ring needs edges: select edges, or use the propagation Loop")
        marks.Elements = None
        self.refused(marks, "Nothing is marked: select edges")

    def test_rules_that_do_not_apply(self):
        cage = self.cage()
        path = self.path("own.rules")
        with open(path, "w") as file:
            file.write("% Rules that no mark of this cage fits.\nphase split\nrule never {\n")
        with self.assertRaises(Exception) as caught:
            make_feature([make_marks(cage, ["Edge1"])], "rules", path)
        self.assertRegex(sentence(caught.exception), r"own.rules:\d+: .*\.$")
        # The rules of linear features do nothing without the cuts that features prepare.
        with open(path, "w") as file:
            file.write(f'include "{os.environ["WELT_REPOSITORY"]}/rules/linear.rules"\n')
        for obj in self.document.Objects[1:]:
            self.document.removeObject(obj.Name)
        made = make_feature([make_marks(cage, ["Edge1"])], "rules", path)
        made.Strict = True
        self.refused(made, "mark")
        os.remove(path)
        made.touch()
        self.refused(made, "The rule file .*own.rules is gone: set the property Rules")

    def test_files_that_are_gone(self):
        cage = self.cage()
        os.remove(cage.File)
        cage.Repair = True
        self.refused(cage, "The file of the cage, .*, is gone: set the property File to it again")
        cage.File = self.path("cage.obj")
        self.recompute()

    def test_the_report_has_no_traceback(self):
        program = f"""
import sys, FreeCAD
sys.path.insert(0, {os.path.dirname(__file__)!r})
from support import Case
from test_mistakes import Recomputed
case = Recomputed("test_a_width_too_large")
case.debug()
"""
        out, err = run(program)
        self.assertRegex(out + err, "Welt: A width of 500.* does not fit edge .*")
        self.assertNotIn("Traceback", out + err)

    def test_the_library_is_missing_or_another(self):
        cage = self.groove(self.cage(torus(8, 6)), 0, 1)
        self.document.saveAs(self.path("groove.FCStd"))
        program = f"""
import FreeCAD
document = FreeCAD.openDocument({self.path("groove.FCStd")!r})
document.Groove.Width = 1
document.recompute()
print("said:", document.Groove.getStatusString() + " | " + document.Marks.getStatusString())
print("shape:", len(document.Groove.Shape.Edges))
"""
        for library, said in (
            ("/nowhere/libwelt.so", "The welt library is not usable: the welt library cannot be loaded .*install the addon again"),
            ("libm.so.6", "libm.so.6 is no welt library; install the addon again"),
        ):
            with self.subTest(library=library):
                out, err = run(program, WELT_LIBRARY=library)
                self.assertRegex(out, said)
                self.assertIn(f"shape: {len(cage.Shape.Edges)}", out)
                self.assertNotIn("Traceback", out + err)

    def test_saved_where_the_addon_is_absent(self):
        groove = self.groove(self.cage(torus(8, 6)), 0, 1, Width=2.0)
        make_limit(groove)
        self.recompute()
        self.document.saveAs(self.path("groove.FCStd"))
        save = f"""
import FreeCAD
document = FreeCAD.openDocument({self.path("groove.FCStd")!r})
print("proxy:", document.Groove.Proxy)
document.saveAs({self.path("again.FCStd")!r})
"""
        self.assertIn("proxy: None", run(save, HOME=self.folder)[0])
        again = FreeCAD.openDocument(self.path("again.FCStd"))
        self.addCleanup(lambda: FreeCAD.closeDocument(again.Name))
        kinds = [obj.Proxy.kind for obj in self.document.Objects]
        self.assertEqual([obj.Proxy.kind for obj in again.Objects], kinds)
        for document in (self.document, again):
            document.Groove.Width = 2.5
            document.recompute()
        self.assertEqual(again.Groove.Proxy.mesh(again.Groove).positions.tolist(), groove.Proxy.mesh(groove).positions.tolist())
