//! The limit surface as B-spline patches: against evaluation, by their sides, and in a CAD kernel.

use crate::common;

use glam::DVec3;
use std::path::Path;
use std::process::Command;
use welt::job::{Cancelled, Job};
use welt::mesh::{FaceId, Mesh, Polygons};
use welt::surface::{ClosestOptions, LimitSurface, PatchOptions, Patches, SplinePatch};

fn patches(mesh: &Mesh, options: &PatchOptions) -> Patches {
    let faces: Vec<FaceId> = mesh.faces().collect();
    Patches::new(mesh, &faces, options, &Job::new()).expect("nobody cancels")
}

/// Numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn cube() -> Mesh {
    let positions =
        (0..8).map(|i| DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into())).collect();
    let faces: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a cube")
}

/// A bumpy torus of `m` by `n` quads.
fn torus(m: u32, n: u32) -> Mesh {
    let mut random = Random(7);
    let point = |i: u32, j: u32| {
        let turn = |k: u32, of: u32| (f64::from(k) / f64::from(of) * std::f64::consts::TAU).sin_cos();
        let ((sin, cos), (s, c)) = (turn(i, m), turn(j, n));
        DVec3::new((3.0 + c) * cos, (3.0 + c) * sin, s)
    };
    let positions = (0..m * n).map(|k| point(k % m, k / m) + 0.2 * random.next() * DVec3::Z).collect();
    let faces: Vec<[u32; 4]> = (0..m * n)
        .map(|k| {
            let (i, j) = (k % m, k / m);
            let at = |i: u32, j: u32| (i % m) + m * (j % n);
            [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
        })
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(|face| face.as_slice()).collect();
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a torus")
}

fn chair(name: &str) -> Mesh {
    common::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/models").join(name))
}

/// True in the last three spans beside an extraordinary vertex.
fn is_last(patch: &SplinePatch, u: f64, v: f64) -> bool {
    let ends = |knots: &[f64], t: f64| {
        let count = knots.len();
        [t <= knots[6], t >= knots[count - 7]]
    };
    let (u, v) = (ends(&patch.knots_u, u), ends(&patch.knots_v, v));
    [(0, 0), (1, 0), (1, 1), (0, 1)]
        .into_iter()
        .zip(patch.irregular)
        .any(|((i, j), irregular)| irregular && u[i] && v[j])
}

fn range(knots: &[f64]) -> f64 {
    *knots.last().expect("knots")
}

/// Sides have the same poles as those of their neighbours, in every bit, and the same knots.
fn check_sides(patches: &Patches) {
    for (number, patch) in patches.patches.iter().enumerate() {
        for (side, beyond) in patch.neighbours.iter().enumerate() {
            let Some((other, there)) = *beyond else { continue };
            let neighbour = &patches.patches[other];
            assert_eq!(neighbour.neighbours[there], Some((number, side)));
            let own: Vec<DVec3> = patch.side_poles(side).iter().map(|&i| patch.poles[i]).collect();
            let mut theirs: Vec<DVec3> =
                neighbour.side_poles(there).iter().map(|&i| neighbour.poles[i]).collect();
            theirs.reverse();
            let bits =
                |poles: &[DVec3]| poles.iter().map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
            assert_eq!(bits(&own), bits(&theirs), "side {side} of patch {number}");
            let along = |patch: &SplinePatch, side: usize| {
                let knots = if side.is_multiple_of(2) { &patch.knots_u } else { &patch.knots_v };
                let end = range(knots);
                let mut knots = knots.clone();
                if side > 1 {
                    knots = knots.iter().rev().map(|knot| end - knot).collect();
                }
                knots
            };
            let mut theirs = along(neighbour, there);
            let end = range(&theirs);
            theirs = theirs.iter().rev().map(|knot| end - knot).collect();
            assert_eq!(along(patch, side), theirs, "knots of side {side} of patch {number}");
        }
    }
}

#[test]
fn single_faces_have_the_parameters_of_evaluation() {
    let mut random = Random(1);
    for mesh in [cube(), torus(7, 5), chair("leaf_chair.obj")] {
        let surface = LimitSurface::new(&mesh);
        let made = patches(&mesh, &PatchOptions { most_faces: 1, ..PatchOptions::default() });
        assert_eq!(made.patches.len(), mesh.faces().count());
        for patch in &made.patches {
            let [face] = patch.faces[..] else { panic!("a patch of one face") };
            for _ in 0..20 {
                let (u, v) = (random.next(), random.next());
                if is_last(patch, u, v) {
                    continue;
                }
                let expected = surface.evaluate(face, 0, u, v).expect("a point");
                let found = patch.evaluate(u, v).expect("a point");
                assert!(
                    found.position.distance(expected.position) < 1e-12 * surface.size(),
                    "{face:?} {u} {v}"
                );
                assert!(found.du.distance(expected.du) < 1e-10 * surface.size(), "{face:?} {u} {v}");
                assert!(found.dv.distance(expected.dv) < 1e-10 * surface.size(), "{face:?} {u} {v}");
            }
        }
    }
}

#[test]
fn rectangles_are_as_large_as_they_may_be() {
    let most = |most_faces| PatchOptions { most_faces, ..PatchOptions::default() };
    assert_eq!(patches(&cube(), &most(10)).patches.len(), 6);
    let ring = patches(&torus(12, 8), &most(10));
    assert_eq!(ring.patches.len(), 4, "no patch meets itself");
    assert_eq!((ring.report.exact, ring.report.max_deviation, ring.report.rings), (4, 0.0, 0));
    assert!(ring.report.max_normal_jump < 1e-6);
    let small = patches(&torus(12, 8), &most(3));
    assert!(small.patches.iter().all(|patch| patch.faces.len() <= 9));
    let total: usize = small.patches.iter().map(|patch| patch.faces.len()).sum();
    assert_eq!(total, 96);
    for made in [ring, small] {
        check_sides(&made);
        assert!(made.patches.iter().flat_map(|patch| patch.neighbours).all(|beyond| beyond.is_some()));
    }
}

#[test]
fn tolerance_is_kept_and_more_rings_come_nearer() {
    let mut last = f64::INFINITY;
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5] {
        let report = patches(&cube(), &PatchOptions { tolerance, ..PatchOptions::default() }).report;
        assert!(report.max_relative_deviation <= tolerance && report.max_deviation > 0.0);
        assert!(report.max_relative_deviation <= last);
        last = report.max_relative_deviation;
    }
}

/// Points of patches, at random and within last spans, are as near to the surface as is said: found by the closest point,
/// which knows nothing of patches.
fn check_distances(name: &str, mesh: &Mesh, made: &Patches) {
    let surface = LimitSurface::new(mesh);
    let mut random = Random(3);
    let step = made.patches.len().div_ceil(40);
    for patch in made.patches.iter().step_by(step) {
        let (m, n) = (range(&patch.knots_u), range(&patch.knots_v));
        for k in 0..12 {
            let (mut u, mut v) = (random.next() * m, random.next() * n);
            let corner = k % 4;
            if k > 3 && patch.irregular[corner] {
                let h = patch.knots_u[6].min(patch.knots_v[6]);
                (u, v) = [
                    (u * h / m, v * h / n),
                    (m - u * h / m, v * h / n),
                    (m - u * h / m, n - v * h / n),
                    (u * h / m, n - v * h / n),
                ][corner];
            }
            let found = patch.evaluate(u, v).expect("a point").position;
            let foot = surface.closest(found, &ClosestOptions::default()).expect("a foot");
            let most = if is_last(patch, u, v) { 1.5 * patch.deviation } else { 0.0 };
            assert!(
                foot.distance <= most + 1e-12 * surface.size(),
                "{name}: {} at {u} {v}, said {most}",
                foot.distance
            );
        }
    }
}

/// The normal at a corner of a patch, from its poles.
fn corner_normal(patch: &SplinePatch, corner: usize) -> Option<DVec3> {
    let (begins, ends) = (patch.side_poles(corner), patch.side_poles((corner + 3) % 4));
    let origin = patch.poles[begins[0]];
    let along = patch.poles[begins[1]] - origin;
    along.cross(patch.poles[ends[ends.len() - 2]] - origin).try_normalize()
}

/// All patches at an extraordinary vertex have the same tangent plane there, but across creases.
fn check_normals(name: &str, made: &Patches) {
    for (number, patch) in made.patches.iter().enumerate() {
        for corner in (0..4).filter(|&corner| patch.irregular[corner]) {
            let Some((other, there)) = patch.neighbours[corner] else { continue };
            let own = corner_normal(patch, corner).expect("a normal");
            let their = corner_normal(&made.patches[other], (there + 1) % 4).expect("a normal");
            assert!(own.distance(their) < 1e-7, "{name}: corner {corner} of patch {number}, {own} {their}");
        }
    }
}

/// Of every folder some that take little time, with all valences from 3 to 24; `tests/freecad/sew_cages.py` goes through all.
const CLEAN: [&str; 20] = [
    "classic/fish_control_mesh",
    "classic/spot_control_mesh",
    "mechanical/bolt_cc",
    "organic/q_clownfish",
    "organic/q_shark",
    "organic/sphere384_quads",
    "osd/catmark_lefthanded",
    "osd/catmark_smoothtris0",
    "osd/catmark_toroidal_tet",
    "osd/catmark_torus",
    "osd/loop_icosahedron",
    "osd/loop_tetrahedron",
    "product/bsby_fork_cage",
    "product/q_helmet2",
    "product/q_vase",
    "product/sc_creamer_cage",
    "product/sc_jar_cage",
    "upholstery/bs0_couch2",
    "upholstery/q_chair_cushioned",
    "upholstery/sc_white_kitchen_chair_cage",
];

#[test]
fn clean_cages_become_patches() {
    let mut cages: Vec<(&str, Mesh)> = ["chair.obj", "leaf_chair.obj"].map(|name| (name, chair(name))).into();
    if let Some(data) = common::shared_data() {
        cages.extend(CLEAN.map(|name| (name, common::load(&data.join(name).with_extension("obj")))));
    }
    for (name, mesh) in cages {
        let made = patches(&mesh, &PatchOptions::default());
        println!("{name}: {:?}", made.report);
        check_sides(&made);
        check_normals(name, &made);
        assert!(made.report.max_relative_deviation < 1e-3, "{name}: {:?}", made.report);
        assert!(made.report.max_normal_jump < 0.5, "{name}: {:?}", made.report);
        check_distances(name, &mesh, &made);
        let borders = made.patches.iter().flat_map(|patch| patch.neighbours).filter(Option::is_none).count();
        assert_eq!(borders > 0, mesh.boundary_loops().next().is_some(), "{name}");
    }
}

#[test]
fn creases_and_borders_are_exact() {
    let mut mesh = torus(12, 8);
    let ring: Vec<_> =
        mesh.half_edges().filter(|&h| mesh.source(h).0 < 12 && mesh.target(h).0 < 12).collect();
    for h in ring {
        mesh.set_edge_sharpness(h, f32::INFINITY);
    }
    let made = patches(&mesh, &PatchOptions::default());
    check_sides(&made);
    assert_eq!(made.report.exact, made.report.patches);
    check_distances("a torus with a crease", &mesh, &made);
    let open: Vec<FaceId> = mesh.faces().filter(|face| face.0 >= 24).collect();
    let made = Patches::new(&mesh, &open, &PatchOptions::default(), &Job::new()).expect("nobody cancels");
    check_sides(&made);
    assert_eq!(made.report.exact, made.report.patches);
    assert!(made.patches.iter().flat_map(|patch| patch.neighbours).any(|beyond| beyond.is_none()));
}

#[test]
fn nothing_and_cancelled() {
    let none = Patches::new(&cube(), &[], &PatchOptions::default(), &Job::new()).expect("nobody cancels");
    assert!(none.patches.is_empty());
    let job = Job::new();
    job.cancel();
    let faces: Vec<FaceId> = cube().faces().collect();
    assert_eq!(Patches::new(&cube(), &faces, &PatchOptions::default(), &job).err(), Some(Cancelled.into()));
    let patch = &patches(&cube(), &PatchOptions::default()).patches[0];
    assert!(patch.evaluate(f64::NAN, 0.0).is_none());
    assert_eq!(
        patch.evaluate(-1.0, 5.0).expect("a point").position,
        patch.evaluate(0.0, 1.0).expect("a point").position
    );
}

/// Through the program and FreeCAD, where that is installed: closed and valid shells of the right volume. The script is the
/// judge of each row, and fails when one is bad.
#[test]
fn patches_sew_in_freecad() {
    if Command::new("freecadcmd").arg("--version").output().is_err() {
        println!("skipped: FreeCAD is absent");
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![root.join("tests/data/models/leaf_chair.obj")];
    if let Some(data) = common::shared_data() {
        let more = ["osd/catmark_cube", "osd/loop_icosahedron", "upholstery/q_pillow"];
        files.extend(more.map(|name| data.join(name).with_extension("obj")));
    }
    let output = Command::new("python3")
        .arg(root.join("tests/freecad/sew_cages.py"))
        .args(["--welt", env!("CARGO_BIN_EXE_welt"), "--fine", "10000"])
        .args(&files)
        .output()
        .expect("Python runs");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text} {}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(text.matches("| good |").count(), files.len(), "{text}");
}
