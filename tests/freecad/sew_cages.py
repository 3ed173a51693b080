"""Sews the patches of cages in FreeCAD and prints a row of a Markdown table for each, as soon as it is known:
`python3 tests/freecad/sew_cages.py [--welt target/release/welt] [--seconds 600] CAGE.obj ...`

A cage is clean when `welt check` finds no defect, border or face without an area. A row fails where the closed shells are not as many as
the components without a border, are invalid, where they or the patches enclose another volume than the limit surface, or where edges are left
open that should not be; the exit code is 1 then. The volume to compare with is that of the limit points of refined cages (`welt limit`), by the
divergence theorem, extrapolated from two levels; that of the patches is integrated span by span."""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
# What the extrapolation is good for, relative. FreeCAD's own integration is worse on thin walls (docs/patches-cad.md).
VOLUME = 1e-4
# Points and weights of Gauss and Legendre on [-1, 1]: exact for polynomials of degree 11 along a span, and a volume's have 8.
GAUSS = [(0.2386191860831969, 0.467913934572691), (0.6612093864662645, 0.3607615730481386), (0.932469514203152, 0.1713244923791704)]
HEAD = (
    "cage|clean|faces|extraordinary|patches|faces per patch|rings|deviation|rms|normals at vertices|along sides|"
    "closed shells|borders left open|valid|volume of the patches|volume in FreeCAD|seconds|result"
)


def read(path):
    """Vertices and faces of an OBJ file."""
    vertices, faces = [], []
    with open(path) as file:
        for line in file:
            if line.startswith("v "):
                vertices.append([float(word) for word in line.split()[1:4]])
            elif line.startswith("f "):
                faces.append([int(word.split("/")[0]) - 1 for word in line.split()[1:]])
    return vertices, faces


def components(count):
    """Of things that pairs join: the function that gives the number of a component, and the one that joins two."""
    first = list(range(count))

    def find(at):
        while first[at] != at:
            first[at] = first[first[at]]
            at = first[at]
        return at

    def join(a, b):
        first[find(a)] = find(b)

    return find, join


def volume(path):
    """Sum of the volumes of the components without a border."""
    vertices, faces = read(path)
    find, join = components(len(vertices))
    # Components hang together across edges; where they touch in a vertex only, the library keeps them apart as well.
    edges = {}
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1]):
            edges[min(a, b), max(a, b)] = edges.get((min(a, b), max(a, b)), 0) + 1
            join(a, b)
    opened = {find(a) for (a, b), count in edges.items() if count == 1}
    found = {}
    for face in faces:
        component = find(face[0])
        # Six times the volume of the pyramids from the component's own vertex, which keeps numbers small.
        origin = vertices[component]
        corners = [[x - o for x, o in zip(vertices[corner], origin)] for corner in face]
        (ax, ay, az), rest = corners[0], corners[1:]
        for (bx, by, bz), (cx, cy, cz) in zip(rest, rest[1:]):
            six = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
            found[component] = found.get(component, 0.0) + six
    return sum(abs(six) / 6 for component, six in found.items() if component not in opened)


def expected_volume(welt, cage, faces, folder, fine):
    level = 2
    while faces * 4 ** (level + 1) < fine and level < 6:
        level += 1
    found = []
    for each in (level - 1, level):
        output = os.path.join(folder, "limit.obj")
        subprocess.run([welt, "limit", cage, "-o", output, "--level", str(each)], check=True, capture_output=True)
        found.append(volume(output))
    return found[1] + (found[1] - found[0]) / 3


def corners(patch):
    """Per corner its pole, the next one along the side that begins there, and the one before along the side that ends there."""
    m, n = patch["pole_counts"]
    poles = patch["poles"]
    places = [(0, 1, m), (m - 1, 2 * m - 1, m - 2), (m * n - 1, m * n - 2, m * n - m - 1), (m * (n - 1), m * (n - 2), m * (n - 1) + 1)]
    return [tuple(poles[place] for place in corner) for corner in places]


def normal(corner):
    origin, (ax, ay, az), (bx, by, bz) = [[x - o for x, o in zip(pole, corner[0])] for pole in corner]
    found = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
    length = math.hypot(*found)
    return [x / length for x in found] if length else None


def basis(knots, span, x):
    """Values and derivatives at x of the four cubic B-splines of the span from knots[span] on."""
    levels = [[1.0]]
    for degree in (1, 2, 3):
        below, values = levels[-1], [0.0] * (degree + 1)
        for i in range(degree):
            low, high = knots[span - degree + 1 + i], knots[span + 1 + i]
            part = (x - low) / (high - low)
            values[i] += (1 - part) * below[i]
            values[i + 1] += part * below[i]
        levels.append(values)
    slopes = [0.0] * 4
    for i, value in enumerate(levels[2]):
        slope = 3 * value / (knots[span + 1 + i] - knots[span - 2 + i])
        slopes[i] -= slope
        slopes[i + 1] += slope
    return levels[3], slopes


def gauss_points(knots):
    """Per Gauss point of the spans the number of the first spline, the weight, values and derivatives."""
    found = []
    for span, (low, high) in enumerate(zip(knots, knots[1:])):
        if high > low:
            for point, weight in GAUSS:
                for x in (-point, point):
                    at = low + 0.5 * (x + 1) * (high - low)
                    found.append((span - 3, 0.5 * weight * (high - low), *basis(knots, span, at)))
    return found


def enclosed(patches):
    """The volume of the components of patches without a border."""
    find, join = components(len(patches))
    for number, patch in enumerate(patches):
        for beyond in patch["neighbours"]:
            if beyond:
                join(number, beyond[0])
    opened = {find(number) for number, patch in enumerate(patches) if None in patch["neighbours"]}
    found = {}
    for number, patch in enumerate(patches):
        component = find(number)
        if component in opened:
            continue
        origin, width = patches[component]["poles"][0], patch["pole_counts"][0]
        poles = [[x - o for x, o in zip(pole, origin)] for pole in patch["poles"]]
        across, along = gauss_points(patch["knots_u"]), gauss_points(patch["knots_v"])
        for j, weight_v, values_v, slopes_v in along:
            # The curve at this v, and how it moves with v.
            rows = [poles[(j + k) * width:(j + k + 1) * width] for k in range(4)]
            curve = [[sum(b * p[axis] for b, p in zip(values_v, column)) for axis in range(3)] for column in zip(*rows)]
            moves = [[sum(b * p[axis] for b, p in zip(slopes_v, column)) for axis in range(3)] for column in zip(*rows)]
            for i, weight_u, values_u, slopes_u in across:
                x, y, z = (sum(b * p[axis] for b, p in zip(values_u, curve[i:i + 4])) for axis in range(3))
                ax, ay, az = (sum(b * p[axis] for b, p in zip(slopes_u, curve[i:i + 4])) for axis in range(3))
                bx, by, bz = (sum(b * p[axis] for b, p in zip(values_u, moves[i:i + 4])) for axis in range(3))
                three = x * (ay * bz - az * by) + y * (az * bx - ax * bz) + z * (ax * by - ay * bx)
                found[component] = found.get(component, 0.0) + weight_u * weight_v * three / 3
    return sum(abs(volume) for volume in found.values())


def vertices(patches):
    """Number of extraordinary vertices, and the greatest angle in degrees between the normals of two neighbours at one."""
    around = [corners(patch) for patch in patches]
    found, worst = set(), 0.0
    for patch, own in zip(patches, around):
        for corner in range(4):
            if not patch["irregular"][corner]:
                continue
            found.add(tuple(own[corner][0]))
            beyond = patch["neighbours"][corner]
            here = normal(own[corner])
            there = beyond and normal(around[beyond[0]][(beyond[1] + 1) % 4])
            if here and there:
                worst = max(worst, math.degrees(2 * math.asin(min(1.0, math.dist(here, there) / 2))))
    return len(found), worst


def sew(path, home, seconds):
    script = f"import runpy; runpy.run_path({os.path.join(HERE, 'sew.py')!r})"
    environment = dict(os.environ, HOME=home, PATCHES=path)
    command = ["freecadcmd", "-c", script]
    ran = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=seconds, text=True)
    lines = [line[5:] for line in ran.stdout.splitlines() if line.startswith("sewn ")]
    return json.loads(lines[0]) if lines else None


def cells(welt, cage, folder, seconds, fine):
    """The cells of a row but the first one, and whether all is as it should be."""
    asked = subprocess.run([welt, "check", "--json", cage], capture_output=True, text=True)
    try:
        check = json.loads(asked.stdout)
    except ValueError:
        return ["no: not read: " + asked.stderr.strip()[-80:]], False
    if check["defects"]:
        kinds = sorted({defect["kind"] for defect in check["defects"]})
        return ["no: " + ", ".join(kinds)], True
    if not check["faces"]:
        return ["no: no faces"], True
    why = ["border"] * bool(check["boundaries"]) + ["faces without area"] * bool(check["zero_area_faces"])
    clean = "no: " + ", ".join(why) if why else "yes"
    path = os.path.join(folder, "patches.json")
    made = subprocess.run([welt, "patches", cage, "-o", path], capture_output=True, text=True, timeout=seconds)
    if made.returncode:
        return [clean, made.stderr.strip().splitlines()[-1]], False
    with open(path) as file:
        content = json.load(file)
    report, patches = content["report"], content["patches"]
    irregular, at_vertices = vertices(patches)
    sizes = sorted(len(patch["faces"]) for patch in patches)
    row = [clean, report["faces"], irregular, report["patches"], f"{sizes[0]} / {sizes[len(sizes) // 2]} / {sizes[-1]}", report["rings"]]
    row += [f"{report['max_relative_deviation']:.1e}", f"{report['rms_relative_deviation']:.1e}"]
    # On creases patches have normals of their own.
    row += ["-" if check["creases"] else f"{at_vertices:.0e}", f"{report['max_normal_jump']:.2f}"]
    try:
        found = sew(path, folder, seconds)
    except subprocess.TimeoutExpired:
        return row + [f"not sewn in {seconds} s"], False
    if found is None:
        return row + ["FreeCAD failed"], False
    row.append(f"{found['closed']} / {found['closed_components']}")
    row.append(f"{found['free_edges']} / {found['borders']}")
    row.append("yes" if found["valid"] else "no")
    good = found["valid"] and found["gap"] == 0 and found["closed"] == found["closed_components"]
    # Borders of components that touch are sewn together.
    good = good and found["free_edges"] <= found["borders"] and not (found["crowded_edges"] or found["loose"] and clean == "yes")
    wanted = expected_volume(welt, cage, report["faces"], folder, fine)
    for volume in (enclosed(patches), found["volume"]):
        error = abs(volume - wanted) / wanted if wanted else abs(volume)
        good = good and error < VOLUME
        row.append(f"{error:.0e}")
    row.append(f"{found['sewing_seconds']:.1f} + {found['checking_seconds']:.1f}")
    return row + ["good" if good else "BAD"], good


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--welt", default=os.path.join(HERE, "../../target/release/welt"))
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--fine", type=int, default=150_000, help="faces of the finer refinement, roughly")
    parser.add_argument("cages", nargs="+")
    options = parser.parse_args()
    print("|" + HEAD + "|\n" + "|---" * (HEAD.count("|") + 1) + "|", flush=True)
    failed = 0
    for cage in options.cages:
        with tempfile.TemporaryDirectory() as folder:
            try:
                row, good = cells(options.welt, cage, folder, options.seconds, options.fine)
            except (subprocess.SubprocessError, OSError) as error:
                row, good = [f"failed: {error}"[:200]], False
        failed += not good
        name = os.path.splitext(os.path.basename(cage))[0]
        print("| " + " | ".join(str(cell) for cell in [name, *row]) + " |", flush=True)
    return 1 if failed else 0


sys.exit(main())
