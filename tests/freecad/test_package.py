"""The addon as a package: what FreeCAD's addon manager and macro list read."""

import ast
import glob
import os
import unittest
import xml.etree.ElementTree as ElementTree

from support import REPOSITORY

from freecad.welt import views

ADDON = os.path.join(REPOSITORY, "bindings/freecad")
LITERALS = "Name Comment Author Date Version License Web Wiki Icon Help Status Requires Files".split()


class Package(unittest.TestCase):
    def test_the_manifest(self):
        space = "{https://wiki.freecad.org/Package_Metadata}"
        root = ElementTree.parse(os.path.join(ADDON, "package.xml")).getroot()
        self.assertEqual((root.tag, root.get("format")), (space + "package", "1"))
        with open(os.path.join(REPOSITORY, "Cargo.toml")) as file:
            self.assertIn(f'version = "{root.findtext(space + "version")}"', file.read())
        bench = root.find(f"{space}content/{space}workbench")
        self.assertEqual(bench.findtext(space + "classname"), "WeltWorkbench")
        self.assertTrue(os.path.exists(os.path.join(ADDON, bench.findtext(space + "icon"))))

    def test_macros(self):
        macros = glob.glob(os.path.join(ADDON, "macros", "*.FCMacro"))
        self.assertGreaterEqual(len(macros), 2)
        for macro in macros:
            with open(macro, encoding="utf-8") as file:
                tree = ast.parse(file.read())
            literals = {
                node.targets[0].id.strip("_"): ast.literal_eval(node.value)
                for node in tree.body
                if isinstance(node, ast.Assign) and node.targets[0].id.startswith("__")
            }
            self.assertEqual(list(literals), LITERALS, macro)

    def test_icons(self):
        for file in os.listdir(views.ICONS):
            root = ElementTree.parse(os.path.join(views.ICONS, file)).getroot()
            self.assertEqual(root.get("viewBox"), "0 0 64 64", file)
