"""A walk through the package, cell by cell, as in a notebook (`# %%` begins a cell).

    python3 tour.py [CHAIR.obj]
"""

# %% A control mesh of a chair, from a file.
import os
import sys
import tempfile

import welt

models = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tests/data/models")
mesh = welt.Mesh.read(sys.argv[1] if len(sys.argv) > 1 else os.path.join(models, "leaf_chair.obj"))
print(mesh)

# %% Positions come as an array of shape (n, 3): numpy's, where numpy is installed.
print("first vertex", mesh.positions.tolist()[0])

# %% Marks: all edges that a loop cut from the edge between vertices 3 and 331 would cross.
marks = mesh.select("ring:3,331")
print(len(marks), "edges are marked")

# %% What features there are, and what they take.
for feature in welt.features():
    print(f"{feature['name']}: {feature['help']}; " + ", ".join(f"{p['name']} {p['default']}" for p in feature["parameters"]))

# %% A groove, 1.6 wide at half depth and 0.6 deep; the surface elsewhere stays where it is.
before = mesh.copy()
report = mesh.apply(marks, "groove", {"width": 1.6, "depth": 0.6}, job=welt.Job(lambda done, stage: None))
print(f"{report['before']['faces']} faces became {report['after']['faces']}")

# %% What is wrong comes as an exception that says what to do, and the places it speaks of. The mesh is as it was.
try:
    before.apply(marks, "groove", {"width": 500})
except welt.ArgumentError as error:
    print(error)
    print("at", error.places[0])

# %% The limit surface: exact points, closest points, a mesh of any fineness.
surface = mesh.freeze()
point = surface.evaluate([0], [(0.5, 0.5)], derivatives=1)
print("in the middle of face 0:", point.tolist()[0][0])
fine = mesh.refine(2)
print(fine.face_count(2), "faces on level 2;", fine.mesh(2).limit_positions().tolist()[0], "is the first limit point")

# %% How far the limit surface is from that before, at most 0.6 in the groove.
apart = mesh.deviation(before, samples=2)
print(f"deviation: {apart.largest:.3f} at most, {apart.root_mean_square:.4f} root mean square")

# %% And out again. A file is replaced whole, or is as it was.
with tempfile.TemporaryDirectory() as folder:
    mesh.write(os.path.join(folder, "seam.obj"))
