"""meshlabserver and the program welt, the files they exchange."""

import os
import re
import struct
import subprocess
import tempfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

ROOT = Path(os.environ["ROOT"])
LEAF_CHAIR = ROOT / "tests/data/models/leaf_chair.obj"
# Bits of the flags in a PLY file of MeshLab, and of face flags that say which sides of a triangle are inside a polygon.
SELECTED = 0x20
FAUX = 0x40000

MARKS = ["vertices", "faces", "edges", "rings", "selectors"]


def read_obj(path):
    """Positions and faces, 0-based."""
    positions, faces = [], []
    for line in Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            positions.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            faces.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:]))
    return positions, faces


def write_ply(path, positions, faces, vertices=(), face_flags=None):
    """A mesh whose given vertices are selected; face_flags has the flags of faces that have some."""
    lines = ["ply", "format ascii 1.0", f"element vertex {len(positions)}"]
    lines += [f"property float {axis}" for axis in "xyz"] + ["property int flags"]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "property int flags", "end_header"]
    vertices, face_flags = set(vertices), face_flags or {}
    for i, p in enumerate(positions):
        # As single precision, which MeshLab has: both programs read the same numbers.
        single = struct.unpack("fff", struct.pack("fff", *p))
        lines.append(" ".join(map(repr, single)) + f" {SELECTED if i in vertices else 0}")
    for i, face in enumerate(faces):
        lines.append(f"{len(face)} " + " ".join(map(str, face)) + f" {face_flags.get(i, 0)}")
    Path(path).write_text("\n".join(lines) + "\n")


def read_ply(path):
    """Positions, quality (or None), and polygons of a binary PLY of triangles with flags, as MeshLab writes it."""
    content = Path(path).read_bytes()
    head, body = content.split(b"end_header\n", 1)
    sizes = {"float": "f", "double": "d", "int": "i", "uint": "I", "uchar": "B", "char": "b", "short": "h", "ushort": "H"}
    elements = []
    for line in head.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    rows, offset = {}, 0
    for name, count, properties in elements:
        rows[name] = []
        for _ in range(count):
            row = {}
            for prop in properties:
                length = 1
                if prop[0] == "list":
                    length = struct.unpack_from("<" + sizes[prop[1]], body, offset)[0]
                    offset += struct.calcsize(sizes[prop[1]])
                form = "<" + str(length) + sizes[prop[-2]]
                row[prop[-1]] = struct.unpack_from(form, body, offset)
                offset += struct.calcsize(form)
            rows[name].append(row)
    vertices = rows["vertex"]
    positions = [tuple(v[axis][0] for axis in "xyz") for v in vertices]
    quality = [v["quality"][0] for v in vertices] if vertices and "quality" in vertices[0] else None
    return positions, quality, polygons(rows["face"])


def polygons(triangles):
    """Joins triangles over sides that are faux on both."""
    sides, triangles = {}, [(t["vertex_indices"], t.get("flags", (0,))[0]) for t in triangles]
    for t, (v, flags) in enumerate(triangles):
        for i in range(3):
            if flags & (FAUX << i):
                sides.setdefault(frozenset((v[i], v[(i + 1) % 3])), []).append(t)
    group = list(range(len(triangles)))
    for pair in sides.values():
        a, b = (group[t] for t in pair)
        group = [min(a, b) if g in (a, b) else g for g in group] if a != b else group
    outer = {}
    for t, (v, flags) in enumerate(triangles):
        for i in range(3):
            if not flags & (FAUX << i):
                outer.setdefault(group[t], {})[v[i]] = v[(i + 1) % 3]
    faces = []
    for t in sorted(outer):
        face, step = [triangles[t][0][0]], outer[t]
        while step[face[-1]] != face[0]:
            face.append(step[face[-1]])
        faces.append(tuple(face))
    return faces


def parameter(kind, name, value, **more):
    words = {"type": "Rich" + kind, "name": name, "value": value, "description": name, "tooltip": "", **more}
    return "<Param " + " ".join(f"{k}={quoteattr(str(v))}" for k, v in words.items()) + "/>"


def enum(name, value, count):
    return parameter("Enum", name, value, enum_cardinality=count, **{f"enum_val{i}": i for i in range(count)})


def open_file(name, path):
    return parameter("OpenFile", name, path, exts_cardinality=1, ext_val0="*")


def feature(name, lengths, marks="selectors", selectors="", polygon_file="", strict=False, before=()):
    """The filter of a feature: lengths are the texts of its parameters in their order, before what stands in front of them."""
    parameters = list(before)
    for key, value in lengths.items():
        parameters.append(parameter("Int" if isinstance(value, int) else "String", key, value))
    parameters += [
        enum("marks", MARKS.index(marks), 5),
        parameter("String", "selectors", selectors),
        enum("fit", 4, 5),
        enum("parity", 0, 3),
        parameter("Bool", "strict", str(strict).lower()),
        enum("boundary", 0, 3),
        parameter("SaveFile", "polygons", polygon_file, ext="OBJ (*.obj)"),
    ]
    return name, parameters


def meshlab(filters, inputs, output=None):
    """Runs filters on the last of the inputs. Gives exit code and what was printed."""
    with tempfile.NamedTemporaryFile("w", suffix=".mlx") as script:
        script.write("<!DOCTYPE FilterScript>\n<FilterScript>\n")
        for name, parameters in filters:
            script.write(f" <filter name={quoteattr(name)}>\n  " + "\n  ".join(parameters) + "\n </filter>\n")
        script.write("</FilterScript>\n")
        script.flush()
        command = [os.environ["MESHLABSERVER"]]
        for path in inputs:
            command += ["-i", str(path)]
        if output:
            command += ["-o", str(output), "-m", "ff", "vf", "vq"]
        command += ["-s", script.name]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, check=False)
        return done.returncode, re.sub(r"\x1b\[[0-9;]*m", "", done.stdout.decode(errors="replace"))


def welt(*arguments):
    """Runs the program, which must succeed."""
    done = subprocess.run([os.environ["WELT"], *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=60, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode()
