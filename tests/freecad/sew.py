"""Sews patches in FreeCAD: `freecadcmd -c "import runpy; runpy.run_path('tests/freecad/sew.py')"` with the JSON files
that `welt patches` wrote in the environment variable PATCHES, separated by colons.

Prints a line of JSON per file: faces, those in no shell, shells, closed ones and how many there should be, valid, free edges
and how many there should be, edges that more than two faces share, volume of the closed shells, seconds. FreeCAD's exit code says nothing about errors: the last line is "done"."""

import json
import os
import time

import FreeCAD
import Part


def face(patch):
    surface = Part.BSplineSurface()
    width, height = patch["pole_counts"]
    vectors = [FreeCAD.Vector(*pole) for pole in patch["poles"]]
    rows = [[vectors[j * width + i] for j in range(height)] for i in range(width)]
    knots = [sorted(set(patch[name])) for name in ("knots_u", "knots_v")]
    ends = [[4] + [1] * (len(own) - 2) + [4] for own in knots]
    surface.buildFromPolesMultsKnots(rows, ends[0], ends[1], knots[0], knots[1], False, False, 3, 3)
    return surface.toShape()


def closed_components(patches):
    """Number of components without a border."""
    seen, count = set(), 0
    for start in range(len(patches)):
        if start in seen:
            continue
        seen.add(start)
        todo, closed = [start], True
        while todo:
            for beyond in patches[todo.pop()]["neighbours"]:
                closed = closed and beyond is not None
                if beyond is not None and beyond[0] not in seen:
                    seen.add(beyond[0])
                    todo.append(beyond[0])
        count += closed
    return count


def sew(path):
    with open(path) as file:
        patches = json.load(file)["patches"]
    start = time.time()
    shape = Part.Compound([face(patch) for patch in patches])
    shape.sewShape()
    shells = shape.Shells
    loose = len(shape.Faces) - sum(len(shell.Faces) for shell in shells)
    uses = {}
    for each in shape.Faces:
        for edge in each.Edges:
            if not edge.Degenerated:
                uses[edge.hashCode()] = uses.get(edge.hashCode(), 0) + 1
    closed = [shell.isClosed() for shell in shells]
    return {
        "file": os.path.basename(path),
        "faces": len(shape.Faces),
        "loose": loose,
        "shells": len(shells),
        "closed": sum(closed),
        "closed_components": closed_components(patches),
        "valid": shape.isValid(),
        "free_edges": sum(count == 1 for count in uses.values()),
        "borders": sum(beyond is None for patch in patches for beyond in patch["neighbours"]),
        "crowded_edges": sum(count > 2 for count in uses.values()),
        "volume": sum(abs(Part.Solid(shell).Volume) for shell, ok in zip(shells, closed) if ok),
        "seconds": round(time.time() - start, 2),
    }


for path in os.environ["PATCHES"].split(":"):
    print("sewn " + json.dumps(sew(path)), flush=True)
print("done", flush=True)
