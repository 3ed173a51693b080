//! Olsen's patch templates as rules: counts of the paper, valences, and Figure 10 of Thaller, Augsdoerfer, Fellner 2016:
//! general refinement against rules made for the feature.

use glam::{DQuat, DVec3};
use std::path::Path;
use welt::feature::{self, Options, Report, Request};
use welt::grammar::{self, RuleSet, RunOptions};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{Mesh, Node, Polygons, Value, VertexId};
use welt::optimise::Method;
use welt::surface::LimitSurface;

fn rules() -> RuleSet {
    RuleSet::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("rules/patches.rules")).expect("rules")
}

/// `n` x `n` unit quads in the plane.
fn sheet(n: u32) -> Mesh {
    let mut polygons = Polygons::default();
    for (i, j) in (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))) {
        polygons.positions.push(DVec3::new(i.into(), j.into(), 0.0));
        if i < n && j < n {
            let a = j * (n + 1) + i;
            polygons.face_sizes.push(4);
            polygons.face_vertices.extend([a, a + 1, a + n + 2, a + n + 1]);
        }
    }
    Mesh::from_polygons(&polygons).expect("a sheet")
}

/// A sphere of 6 x 8 x 8 = 384 quads, as many as the spheres of Olsen's Table 1 begin with.
fn sphere() -> Mesh {
    const N: i32 = 8;
    let mut polygons = Polygons::default();
    let vertex = |p: [i32; 3], polygons: &mut Polygons| {
        let position = DVec3::from_array(p.map(f64::from)).normalize();
        let known = polygons.positions.iter().position(|q| q.distance(position) < 1e-9);
        known.unwrap_or_else(|| {
            polygons.positions.push(position);
            polygons.positions.len() - 1
        }) as u32
    };
    for (axis, sign) in (0..3).flat_map(|axis| [(axis, N), (axis, -N)]) {
        for (i, j) in (0..N).flat_map(|j| (0..N).map(move |i| (i, j))) {
            let mut corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(a, b)| {
                let mut p = [0; 3];
                p[axis] = sign;
                p[(axis + 1) % 3] = 2 * (i + a) - N;
                p[(axis + 2) % 3] = 2 * (j + b) - N;
                vertex(p, &mut polygons)
            });
            if sign < 0 {
                corners.reverse();
            }
            polygons.face_sizes.push(4);
            polygons.face_vertices.extend(corners);
        }
    }
    Mesh::from_polygons(&polygons).expect("a sphere")
}

/// Refines the faces (x, y) of a sheet; gives quads, triangles and the greatest valence inside.
fn refine(n: u32, faces: &[(u32, u32)], parameters: &[(&str, f64)]) -> [usize; 3] {
    let mut mesh = sheet(n);
    let refine = mesh.intern("refine");
    let depth = parameters.iter().find(|(name, _)| *name == "depth").map_or(1.0, |(_, depth)| *depth);
    for (x, y) in faces {
        let f = mesh.faces().nth((y * n + x) as usize).expect("a face");
        mesh.set_attribute(Node::Face(f), refine, Some(Value::Number(depth)));
    }
    let parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let options = RunOptions { parameters, ..RunOptions::default() };
    grammar::run(&rules(), &mut mesh, &options).expect("the rules run");
    mesh.validate_control_mesh().expect("a control mesh");
    let count = |sides: usize| mesh.faces().filter(|&f| mesh.arity(f) == sides).count();
    assert_eq!(count(3) + count(4), mesh.faces().count(), "no polygon is left");
    let valence = mesh.vertices().map(|v| mesh.valence(v)).max().expect("vertices");
    for f in mesh.faces() {
        assert!(mesh.attribute_names(Node::Face(f)).is_empty(), "nothing stays behind");
    }
    [count(4), count(3), valence]
}

/// "Over all cases ... our templates produce 13 quads and only 4 triangles", "valence of no more than n = 5".
#[test]
fn the_templates_hold_13_quads_and_4_triangles() {
    // The face in the middle of 3 x 3 quads is patched; its neighbours' own patches are those of known cases.
    let middle = |neighbours: &[(u32, u32)]| {
        let [quads, triangles, valence] = refine(3, neighbours, &[]);
        assert!(valence <= 5, "{neighbours:?}: valence {valence}");
        [quads, triangles]
    };
    let [south, east, north, west] = [(1, 0), (2, 1), (1, 2), (0, 1)];
    // Faces of the sheet without the middle: refined ones are 4 quads; a corner face with one refined neighbour is
    // 2 quads and a triangle, with two adjacent ones 3 quads.
    let rest = |refined: usize, one: usize, adjacent: usize| {
        [4 * refined + 2 * one + 3 * adjacent + (8 - refined - one - adjacent), one]
    };
    let cases = [
        (vec![south], rest(1, 2, 0)),
        (vec![south, north], rest(2, 4, 0)),
        (vec![south, east], rest(2, 2, 1)),
        (vec![south, east, west], rest(3, 2, 2)),
        (vec![south, east, north, west], rest(4, 0, 4)),
    ];
    let mut total = [0, 0];
    for (neighbours, rest) in &cases {
        let [quads, triangles] = middle(neighbours);
        total = [total[0] + quads - rest[0], total[1] + triangles - rest[1]];
    }
    assert_eq!(total, [13, 4]);
}

/// Incremental refinement costs faces and keeps valences low (paper: 755 faces against 561, Figure 5).
#[test]
fn incremental_refinement_patches_no_patched_face_again() {
    let stroke: Vec<(u32, u32)> = (4..16).map(|i| (i, i / 2 + 4)).collect();
    let run = |incremental: f64| refine(20, &stroke, &[("depth", 3.0), ("incremental", incremental)]);
    let ([vanilla_quads, vanilla_triangles, vanilla], [quads, triangles, incremental]) = (run(0.0), run(1.0));
    println!("vanilla: {vanilla_quads} quads, {vanilla_triangles} triangles, valence {vanilla}");
    println!("incremental: {quads} quads, {triangles} triangles, valence {incremental}");
    assert!(incremental < vanilla, "{incremental} {vanilla}");
    assert!(quads + triangles > vanilla_quads + vanilla_triangles);
    assert!(triangles < vanilla_triangles);
}

fn apply(request: &Request, method: Method) -> (Mesh, Report) {
    let mut mesh = sphere();
    let at = |p: [f64; 3]| {
        let p = DVec3::from_array(p).normalize();
        let distance = |v: &VertexId| mesh.position(*v).distance(p);
        mesh.vertices().min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("vertices").0
    };
    let selector = Selector::parse(&format!("ring:{},{}", at([8.0, 0.0, 0.0]), at([8.0, 0.0, 2.0])))
        .expect("a selector");
    let selection = Selection::resolve(&mesh, &[selector]).expect("an edge");
    assert_eq!(selection.marks.len(), 32);
    let options = Options { method, samples: 4, ..Options::default() };
    let report = feature::apply(&mut mesh, &selection, request, &options, &Job::new()).expect("it runs");
    (mesh, report)
}

const DEPTH: f64 = 0.02;
/// Lines a quarter of the edge apart: twice the place where the cubic B-spline is at half of its height, times a quarter.
const WIDTH: f64 = 0.3612;

/// Where the vertex stands on the cube that the sphere was made from, along z: 0 and 2 are the ends of the crossed edges.
fn height_on_cube(p: DVec3) -> f64 {
    8.0 * p.z / p.x.abs().max(p.y.abs()).max(1e-9)
}

/// A groove along the middle line of the refined faces, by the stage that raises the lines of a profile.
fn press_in(mesh: &mut Mesh) {
    let middle = mesh.vertices().filter(|&v| (height_on_cube(mesh.position(v)) - 1.0).abs() < 0.2);
    let heights: Vec<(VertexId, f64)> = middle.map(|v| (v, -DEPTH)).collect();
    assert_eq!(heights.len(), 128, "four pieces in each of 32 faces");
    assert!(feature::raise(mesh, &heights).is_empty());
}

/// How a groove came out: least and greatest depth and width as fractions of what was asked for; greatest and root mean
/// square distance from the sphere further than three quarters of an edge from its middle line.
struct Groove {
    depth: [f64; 2],
    width: [f64; 2],
    outside: [f64; 2],
}

impl Groove {
    fn of(mesh: &Mesh) -> Self {
        let [before, after] = [LimitSurface::new(&sphere()), LimitSurface::new(mesh)];
        // Distances from the centre in a direction through the cube; the sphere's limit is round within a thousandth.
        let lifted = |direction: DVec3| {
            let radius = |surface: &LimitSurface| {
                surface.first_line_hit(DVec3::ZERO, direction, 0.0, 2.0).expect("it is closed").s
            };
            radius(&after) - radius(&before)
        };
        let mut groove = Self { depth: [f64::MAX, 0.0], width: [f64::MAX, 0.0], outside: [0.0, 0.0] };
        let note = |range: &mut [f64; 2], x: f64| *range = [range[0].min(x), range[1].max(x)];
        let mut count = 0.0;
        for column in 0..4 * 32 {
            let (quarter, y) = (column / 32, f64::from(column % 32) / 2.0 - 7.99);
            let turn = DQuat::from_rotation_z(f64::from(quarter) * std::f64::consts::FRAC_PI_2);
            let direction = |z: f64| (turn * DVec3::new(8.0, y, z)).normalize();
            let at = |z: f64| lifted(direction(z));
            let deepest =
                (-10..=10).map(|i| 1.0 + f64::from(i) / 50.0).min_by(|a, b| at(*a).total_cmp(&at(*b)));
            let middle = deepest.expect("places");
            note(&mut groove.depth, -at(middle) / DEPTH);
            // Half depth on both sides, by bisection.
            let [low, high] = [-1.0, 1.0].map(|side| {
                let (mut inner, mut outer) = (middle, middle + side);
                for _ in 0..20 {
                    let z = (inner + outer) / 2.0;
                    *if at(z) < -DEPTH / 2.0 { &mut inner } else { &mut outer } = z;
                }
                inner
            });
            let crossed = direction(2.0).angle_between(direction(0.0));
            let width = direction(high).angle_between(direction(low));
            note(&mut groove.width, width / (WIDTH * crossed));
            for i in 0..=20 {
                for z in [1.0 - 1.5 - f64::from(i) / 6.0, 1.0 + 1.5 + f64::from(i) / 6.0] {
                    let off = at(z).abs();
                    groove.outside = [groove.outside[0].max(off), groove.outside[1] + off * off];
                    count += 1.0;
                }
            }
        }
        groove.outside[1] = f64::sqrt(groove.outside[1] / count);
        groove
    }
}

/// Figure 10: "Compared to specialized rules, this usually leads to a greater increase in resolution". The tables stand
/// in docs/patches.md: the fit before anything is displaced, and the groove.
#[test]
fn general_refinement_costs_more_than_rules_for_the_feature() {
    let special = |depth: f64| {
        let settings = [format!("width={}%", 100.0 * WIDTH), format!("depth={depth}")];
        Request::features(&["groove"], &settings).expect("a request")
    };
    let general = |incremental: &str| {
        let settings = ["depth=2".to_owned(), format!("incremental={incremental}")];
        Request::rules(rules(), &settings).expect("a request")
    };
    let rows = [
        ("rules of linear features", None),
        ("refinement, 2 rounds", Some("0")),
        ("refinement, 2 rounds, incremental", Some("1")),
    ];
    let (mut found, mut grooves) = (Vec::new(), Vec::new());
    for (name, incremental) in rows {
        let request = incremental.map_or_else(|| special(0.0), general);
        for (fit, method) in [("none", Method::None), ("solve", Method::Solve)] {
            let (mut mesh, report) = apply(&request, method);
            let deviation = report.fitted.as_ref().expect("it was measured").total;
            let added =
                [report.after.vertices - report.before.vertices, report.after.faces - report.before.faces];
            println!(
                "| {name} | {fit} | {} | {} | {} | {:.2e} | {:.2e} |",
                added[0],
                added[1],
                report.non_quads.len(),
                deviation.max,
                deviation.rms
            );
            found.push((added, deviation.max));
            match incremental {
                Some(_) => press_in(&mut mesh),
                None => mesh = apply(&special(DEPTH), method).0,
            }
            let groove = Groove::of(&mesh);
            println!(
                "| {name} | {fit} | {} | {:.3} - {:.3} | {:.3} - {:.3} | {:.2e} | {:.2e} |",
                added[0],
                groove.depth[0],
                groove.depth[1],
                groove.width[0],
                groove.width[1],
                groove.outside[0],
                groove.outside[1]
            );
            grooves.push(groove);
        }
    }
    // Three vertices per crossed edge, three quads per crossed face.
    assert_eq!(found[0].0, [96, 96]);
    for general in [&found[2..4], &found[4..6]] {
        assert!(general[0].0[0] >= 8 * found[0].0[0], "{general:?}");
        // Not fitted, and fitted: the rules for the feature disturb the surface less.
        assert!(general[0].1 > found[0].1 && general[1].1 > found[1].1, "{general:?}");
    }
    // Fitted, all three make the groove that was asked for; that of the special rules is the least disturbance per vertex.
    for groove in [&grooves[1], &grooves[3], &grooves[5]] {
        assert!(groove.depth[0] > 0.99 && groove.depth[1] < 1.01, "{:?}", groove.depth);
        assert!(groove.width[0] > 0.95 && groove.width[1] < 1.05, "{:?}", groove.width);
    }
    assert!(grooves[1].outside[0] < grooves[3].outside[0] && grooves[1].outside[0] < grooves[5].outside[0]);
    // docs/patches.md says so.
    assert!(found[1].1 < 1.1e-3 && found[3].1 < 3.2e-3 && found[5].1 < 1.5e-3, "{found:?}");
}
