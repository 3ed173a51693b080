"""The declarations of the package against include/welt.h."""

import ctypes
import os
import re
import unittest

from welt import _abi

HEADER = os.path.join(os.path.dirname(__file__), "../../../include/welt.h")


def code():
    with open(HEADER, encoding="utf-8") as file:
        return re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S)


def one_line(text):
    return " ".join(text.split()).replace("( ", "(")


class Header(unittest.TestCase):
    def test_every_function_is_declared_with_its_signature(self):
        header = [one_line(m) for m in re.findall(r"^WELT_API\s+(.*?);", code(), flags=re.S | re.M)]
        package = [one_line(p) for p in _abi.PROTOTYPES.split(";") if p.strip()]
        self.assertGreater(len(header), 60)
        missing = [p + ";" for p in header if p not in package]
        surplus = [p + ";" for p in package if p not in header]
        self.assertEqual((missing, surplus), ([], []), "add what is missing to PROTOTYPES in welt/_abi.py")
        self.assertEqual(header, package, "the order is that of the header")

    def test_constants(self):
        header = {name: int(value) for name, value in re.findall(r"^#define (WELT_\w+) (-?\d+)$", code(), flags=re.M)}
        self.assertEqual(header, _abi.CONSTANTS)

    def test_structs_have_the_layout_of_the_header(self):
        header = {}
        for body, name in re.findall(r"^typedef struct \{(.*?)\} (\w+);", code(), flags=re.S | re.M):
            header[name] = re.findall(r"(\w+) (\**)(\w+)(?:\[(\d+)\])?;", body)
        self.assertEqual(set(header), set(_abi.STRUCTS))
        for name, members in header.items():
            declared = _abi.STRUCTS[name]._fields_
            self.assertEqual([member for member, _ in declared], [member for _, _, member, _ in members], name)
            for (member, kind), (plain, star, _, length) in zip(declared, members):
                expected = _abi._VALUES[plain]
                if length:
                    expected = expected * int(length)
                elif star:
                    expected = ctypes.POINTER(expected)
                self.assertIs(kind, expected, f"{name}.{member}")

    def test_types_are_those_of_the_prototypes(self):
        table = _abi.functions()
        apply = table["welt_feature_apply"]
        self.assertEqual(len(apply.arguments), 10)
        self.assertEqual(apply.handles, [(0, True, "welt_mesh"), (1, False, "welt_selection"), (7, False, "welt_job")], "the mesh is changed, selection and job are read")
        self.assertTrue(apply.fails)
        self.assertIs(table["welt_mesh_set_edge_sharpness"].arguments[2], ctypes.POINTER(ctypes.c_float))
        self.assertIs(table["welt_mesh_positions"].arguments[1], ctypes.POINTER(ctypes.POINTER(ctypes.c_double)))
        self.assertIs(table["welt_surface_closest"].arguments[4], ctypes.POINTER(_abi.SurfacePoint))
        self.assertIs(table["welt_job_progress"].result, ctypes.c_double)
        self.assertFalse(table["welt_job_progress"].fails)


if __name__ == "__main__":
    unittest.main()
