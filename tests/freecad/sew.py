"""Sews patches in FreeCAD: `freecadcmd -c "import runpy; runpy.run_path('tests/freecad/sew.py')"` with the JSON files
that `welt patches` wrote in the environment variable PATCHES, separated by colons.

Prints a line of JSON per file: faces, those in no shell, shells, closed ones and how many there should be, valid (the solids of the
closed shells, other shells and faces in none, by OpenCASCADE's BRepCheck), free edges and how many there should be, edges that more than two faces share,
the greatest distance between the poles of shared sides, the greatest tolerance of the sewn shape, volume of the closed shells, seconds for
making faces and sewing, and for the checks. FreeCAD's exit code says nothing about errors: the last line is "done"."""

import json
import math
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


def side(patch, number):
    """The poles of a side, counter-clockwise."""
    m, n = patch["pole_counts"]
    places = [range(m), range(m - 1, m * n, m), range(m * n - 1, m * (n - 1) - 1, -1), range(m * (n - 1), -1, -m)]
    return [patch["poles"][place] for place in places[number]]


def gap(patches):
    """Greatest distance between poles of sides that two patches share."""
    worst = 0.0
    for patch in patches:
        for number, beyond in enumerate(patch["neighbours"]):
            if beyond is not None:
                theirs = reversed(side(patches[beyond[0]], beyond[1]))
                worst = max([worst] + [math.dist(a, b) for a, b in zip(side(patch, number), theirs, strict=True)])
    return worst


def sew(path):
    with open(path) as file:
        patches = json.load(file)["patches"]
    start = time.time()
    shape = Part.Compound([face(patch) for patch in patches])
    shape.sewShape()
    sewn = time.time()
    shells = shape.Shells
    in_shells = {face.hashCode() for shell in shells for face in shell.Faces}
    loose = [face for face in shape.Faces if face.hashCode() not in in_shells]
    uses = {}
    for each in shape.Faces:
        for edge in each.Edges:
            if not edge.Degenerated:
                uses[edge.hashCode()] = uses.get(edge.hashCode(), 0) + 1
    solids = [Part.Solid(shell) for shell in shells if shell.isClosed()]
    parts = solids + [shell for shell in shells if not shell.isClosed()] + loose
    return {
        "file": os.path.basename(path),
        "faces": len(shape.Faces),
        "loose": len(loose),
        "shells": len(shells),
        "closed": len(solids),
        "closed_components": closed_components(patches),
        "valid": all(part.isValid() for part in parts),
        "free_edges": sum(count == 1 for count in uses.values()),
        "borders": sum(beyond is None for patch in patches for beyond in patch["neighbours"]),
        "crowded_edges": sum(count > 2 for count in uses.values()),
        "gap": gap(patches),
        "tolerance": shape.getTolerance(1),
        "volume": sum(abs(solid.Volume) for solid in solids),
        "sewing_seconds": round(sewn - start, 2),
        "checking_seconds": round(time.time() - sewn, 2),
    }


for path in os.environ["PATCHES"].split(":"):
    print("sewn " + json.dumps(sew(path)), flush=True)
print("done", flush=True)
