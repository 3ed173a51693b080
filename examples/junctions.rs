//! The tables of docs/junctions.md: `cargo run --example junctions`; with a folder as its argument, the pictures, too.

#[path = "../tests/common/junction_cases.rs"]
mod junction_cases;
#[path = "../tests/common/sheet.rs"]
mod sheet;

use glam::{DVec2, DVec3};
use junction_cases::{CENTRE, DEPTH, cases, flat, piped_cases};
use sheet::{Band, Ideal, Marked, SIDE, apply, line, sideways, upwards};
use welt::feature;
use welt::grammar::RuleSet;
use welt::mesh::{Mesh, Node, Polygons, Value, VertexId};
use welt::optimise::Method;
use welt::picture::{Camera, Content, Figure, Finish, Panel, Shape};
use welt::subdivision::{limit_normal, limit_positions, refine};

/// Crest of the bar, the groove beside it at the stem's side, the seam, each from least to greatest.
fn piped(rules: &RuleSet) {
    const D: f64 = 0.05;
    for case in piped_cases() {
        let result = apply(rules, sheet::sheet(flat), &case.bands, &case.marks, Method::None, case.set);
        let samples = sheet::samples(&result, &result.base, CENTRE, 1.5, 16);
        let along = |y: f64, beside: f64, sign: f64| {
            let [a, b] = [DVec2::new(2.1, y), DVec2::new(4.9, y)];
            sheet::valley(&samples, a, b, beside, sign * D)
        };
        let [crest, groove] = [along(3.5, 0.04, -1.0), along(3.5 - 0.15, 0.1, 1.0)];
        let seam = sheet::valley(&samples, DVec2::new(3.5, 2.1), DVec2::new(3.5, 3.3), 0.1, D);
        let [pit, peak] =
            [1.0, -1.0].map(|sign| samples.iter().map(|s| -s.height * sign / D).fold(0.0, f64::max));
        println!(
            "{:28} crest {:.3}-{:.3} groove {:.3}-{:.3} seam {:.3}-{:.3} deepest {pit:.2} highest {peak:.2} vertices {} non-quads {:?} {:?}",
            case.name,
            crest[0],
            crest[1],
            groove[0],
            groove[1],
            seam[0],
            seam[1],
            result.mesh.vertex_bound(),
            result.non_quads(),
            result.fired
        );
    }
}

/// The patterns of the table of flat sheets.
fn flat_sheets(rules: &RuleSet) {
    for w in [0.15, 0.08] {
        println!("w = {w}");
        for case in cases(w) {
            let ideal = Ideal::new(&case.bands, case.lines.clone());
            let result = apply(rules, sheet::sheet(flat), &case.bands, &case.marks, Method::None, case.set);
            let samples = sheet::samples(&result, &result.base, CENTRE, 1.5, 32);
            let [rms, max] = sheet::error(&samples, &ideal, CENTRE, DEPTH);
            let half_depth = 1.1934 * w + 0.06285;
            let h = sheet::curvature_error(&samples, &ideal, half_depth);
            // Dead ends are fitted: the ideal's end moves along the line, over all nine faces.
            if case.name.starts_with("DE") {
                let (fitted, end) = sheet::fitted_end(&samples, &case.bands, case.lines[0], DEPTH);
                println!(
                    "{:24} rms {:.4} max {:.3} end at {:.3} {:?}",
                    case.name,
                    fitted[0],
                    fitted[1],
                    end.y - 3.0,
                    result.non_quads()
                );
                continue;
            }
            let across = sheet::valley(&samples, DVec2::new(2.1, 3.5), DVec2::new(4.9, 3.5), w, DEPTH);
            let up = sheet::valley(&samples, DVec2::new(3.5, 2.1), DVec2::new(3.5, 3.5 - w / 2.0), w, DEPTH);
            println!(
                "{:24} rms {rms:.4} max {max:.3} bar {:.3}-{:.3} stem {:.3}-{:.3} dH {:.3}/{:.2} vertices {} non-quads {:?} {:?}",
                case.name,
                across[0],
                across[1],
                up[0],
                up[1],
                h[0],
                h[1],
                result.mesh.vertex_bound(),
                result.non_quads(),
                result.fired
            );
        }
    }
}

/// Features at depth on curved bases: errors in the junction face against the ideal in grid coordinates, valleys.
fn curved(rules: &RuleSet) {
    const RADIUS: f64 = 3.0;
    let centred = |x: f64, y: f64| [(x - 3.5) / RADIUS, (y - 3.5) / RADIUS];
    let cylinder = move |x: f64, y: f64| {
        let [u, v] = centred(x, y);
        DVec3::new(u.sin(), v, u.cos()) * RADIUS
    };
    let sphere = move |x: f64, y: f64| {
        let [u, v] = centred(x, y);
        DVec3::new(u.tan(), v.tan(), 1.0).normalize() * RADIUS
    };
    let saddle = move |x: f64, y: f64| {
        let [u, v] = centred(x, y);
        DVec3::new(u, v, (u * u - v * v) / 2.0) * RADIUS
    };
    type Shape<'a> = &'a dyn Fn(f64, f64) -> DVec3;
    let bases: [(&str, Shape<'_>); 4] =
        [("flat", &flat), ("cylinder", &cylinder), ("sphere", &sphere), ("saddle", &saddle)];
    for depth in [0.1, 0.3] {
        for (base, shape) in bases {
            for case in cases(0.15)
                .into_iter()
                .filter(|case| ["straight", "corner", "crossing", "T-DE", "T-D", "DE3W"].contains(&case.name))
            {
                let mut bands = case.bands.clone();
                bands.iter_mut().for_each(|band| band.depth = depth);
                let grid = apply(rules, sheet::sheet(flat), &bands, &case.marks, Method::None, case.set).base;
                let result = apply(rules, sheet::sheet(shape), &bands, &case.marks, Method::Solve, case.set);
                let samples = sheet::samples(&result, &grid, CENTRE, 1.5, 16);
                if case.name == "DE3W" {
                    let (fitted, end) = sheet::fitted_end(&samples, &bands, case.lines[0], depth);
                    println!(
                        "depth {depth} {base:9} {:9} rms {:.3} max {:.3} end at {:.3}",
                        case.name,
                        fitted[0],
                        fitted[1],
                        end.y - 3.0
                    );
                    continue;
                }
                let ideal = Ideal::new(&bands, case.lines.clone());
                let [rms, max] = sheet::error(&samples, &ideal, CENTRE, depth);
                let along = |a: [f64; 2], b: [f64; 2]| {
                    sheet::valley(&samples, DVec2::from(a), DVec2::from(b), 0.15, depth)
                };
                let bar = if case.name == "corner" {
                    along([3.7, 3.5], [4.9, 3.5])
                } else {
                    along([2.1, 3.5], [4.9, 3.5])
                };
                let stem = along([3.5, 2.1], [3.5, 3.4]);
                println!(
                    "depth {depth} {base:9} {:9} rms {rms:.3} max {max:.3} bar {:.3}-{:.3} stem {:.3}-{:.3}",
                    case.name, bar[0], bar[1], stem[0], stem[1]
                );
            }
        }
    }
}

/// Junctions on sheets of rhombi: errors against the ideal at true distances.
fn angles(rules: &RuleSet) {
    for degrees in [90.0_f64, 75.0, 60.0, 45.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        for case in
            cases(0.15).into_iter().filter(|case| ["corner", "crossing", "T-DE", "T-D"].contains(&case.name))
        {
            // A corner turns by the angle or by its supplement.
            for cos in if case.name == "corner" && degrees < 90.0 { vec![cos, -cos] } else { vec![cos] } {
                let shape = |x: f64, y: f64| DVec3::new(x + cos * y, sin * y, 0.0);
                let result =
                    apply(rules, sheet::sheet(shape), &case.bands, &case.marks, Method::None, case.set);
                let grid =
                    apply(rules, sheet::sheet(flat), &case.bands, &case.marks, Method::None, case.set).base;
                let samples = sheet::samples(&result, &grid, CENTRE, 1.5, 16);
                let ideal = Ideal::new(&case.bands, case.lines.clone()).sheared(DVec2::new(cos, sin));
                let [rms, max] = sheet::error(&samples, &ideal, CENTRE, DEPTH);
                let bar = sheet::valley(&samples, DVec2::new(2.1, 3.5), DVec2::new(4.9, 3.5), 0.15, DEPTH);
                println!(
                    "{:9} {degrees} cos {cos:.2} rms {rms:.3} max {max:.3} bar {:.3}-{:.3}",
                    case.name, bar[0], bar[1]
                );
            }
        }
    }
}

/// A bar and a stem or a crossing feature of other width, depth or sign: in units of the bar's depth.
fn unlike(rules: &RuleSet) {
    let end = f64::from(SIDE) + 1.0;
    for (name, half, depth) in [
        ("alike", 0.15, 0.1),
        ("narrow", 0.08, 0.1),
        ("wide", 0.25, 0.1),
        ("deep", 0.15, 0.2),
        ("shallow", 0.15, 0.05),
        ("ridge", 0.15, -0.1),
    ] {
        for through in [false, true] {
            let stem = Band { kind: "stem", ..Band::groove(half, depth) };
            let bands = [Band::groove(0.15, 0.1), stem];
            let rows = if through { 0..=7 } else { 0..=3 };
            let marks = [sideways(3, 0..=7, 0), upwards(3, rows, 1)].concat();
            let stem_end = if through { end } else { 3.5 };
            let lines = vec![line([-1.0, 3.5], [end, 3.5], 0), line([3.5, -1.0], [3.5, stem_end], 1)];
            let result = apply(rules, sheet::sheet(flat), &bands, &marks, Method::None, &[]);
            let samples = sheet::samples(&result, &result.base, CENTRE, 1.5, 16);
            let [rms, max] = sheet::error(&samples, &Ideal::new(&bands, lines), CENTRE, 0.1);
            let bar = sheet::valley(&samples, DVec2::new(2.1, 3.5), DVec2::new(4.9, 3.5), 0.15, 0.1);
            let stem = sheet::valley(&samples, DVec2::new(3.5, 2.1), DVec2::new(3.5, 3.4), 0.1, depth);
            let pattern = if through { "crossing" } else { "T" };
            println!(
                "{pattern:8} {name:8} rms {rms:.3} max {max:.3} bar {:.3}-{:.3} stem {:.3}-{:.3} (of its own depth)",
                bar[0], bar[1], stem[0], stem[1]
            );
        }
    }
}

/// A dent: a loop of marks round some vertices, which go down with the inner rim.
fn dents(rules: &RuleSet) {
    let convex: Vec<[u32; 2]> = (3..=4).flat_map(|j| (2..=5).map(move |i| [i, j])).collect();
    let bent: Vec<[u32; 2]> = (2..=5)
        .map(|i| [i, 2])
        .chain((2..=5).map(|i| [i, 3]))
        .chain((4..=5).flat_map(|j| [[2, j], [3, j]]))
        .collect();
    for (name, inside) in [("one vertex", vec![[3, 3]]), ("2 x 4 vertices", convex), ("L of vertices", bent)]
    {
        for (walls, middle) in [("rim at half", Some(-0.5)), ("rim free", None)] {
            let lines = vec![(-1.0, None), (0.0, middle), (1.0, Some(-1.0))];
            let bands = [Band { half: 0.15, depth: DEPTH, lines, kind: "dent" }];
            let mut mesh = sheet::sheet(flat);
            let ids: Vec<VertexId> = inside.iter().map(|&[i, j]| sheet::at(i, j)).collect();
            let names = ["line", "kind"].map(|name| mesh.intern(name));
            for &v in &ids {
                mesh.set_attribute(Node::Vertex(v), names[0], Some(Value::Number(3.0)));
                mesh.set_attribute(Node::Vertex(v), names[1], Some(Value::text("dent")));
            }
            let marks: Vec<Marked> = ids
                .iter()
                .flat_map(|&v| {
                    mesh.outgoing(v)
                        .map(|h| mesh.target(h))
                        .collect::<Vec<_>>()
                        .into_iter()
                        .map(move |w| (w, v))
                })
                .filter(|(outside, _)| !ids.contains(outside))
                .map(|(outside, v)| (outside, v, 0))
                .collect();
            let result = apply(rules, mesh, &bands, &marks, Method::None, &[]);
            let samples = sheet::samples(&result, &result.base, CENTRE, 3.2, 16);
            let floor: Vec<f64> = samples
                .iter()
                .filter(|s| {
                    inside
                        .iter()
                        .any(|&[i, j]| (s.at - DVec2::new(i.into(), j.into())).abs().max_element() < 0.3)
                })
                .map(|s| -s.height / DEPTH)
                .collect();
            let [low, high] = [
                floor.iter().copied().fold(f64::INFINITY, f64::min),
                floor.iter().copied().fold(0.0, f64::max),
            ];
            let peak = samples.iter().map(|s| s.height / DEPTH).fold(0.0, f64::max);
            let deepest = samples.iter().map(|s| -s.height / DEPTH).fold(0.0, f64::max);
            println!(
                "dent {name:15} {walls:12} floor {low:.3}-{high:.3} deepest {deepest:.3} highest {peak:.3} {:?}",
                result.fired
            );
        }
    }
}

/// A disk of `sectors` sectors round a pole; grid point (i, j) of sector k.
fn disk(sectors: u32) -> (Mesh, impl Fn(u32, u32, u32) -> VertexId) {
    let vertex = move |k: u32, i: u32, j: u32| {
        let (k, i, j) = if i == 0 { ((k + 1) % sectors, j, 0) } else { (k % sectors, i, j) };
        VertexId(if i == 0 { 0 } else { 1 + (k * SIDE + i - 1) * SIDE + j })
    };
    let mut polygons = Polygons {
        positions: vec![DVec3::ZERO; (1 + sectors * SIDE * SIDE) as usize],
        ..Polygons::default()
    };
    for (k, i, j) in
        (0..sectors).flat_map(|k| (1..=SIDE).flat_map(move |i| (0..SIDE).map(move |j| (k, i, j))))
    {
        let angle = |k: u32| f64::from(k) * std::f64::consts::TAU / f64::from(sectors);
        let [a, b] = [k, k + 1].map(|k| DVec3::new(angle(k).cos(), angle(k).sin(), 0.0));
        polygons.positions[vertex(k, i, j).0 as usize] = a * f64::from(i) + b * f64::from(j);
    }
    for (k, i, j) in
        (0..sectors).flat_map(|k| (0..SIDE - 1).flat_map(move |i| (0..SIDE - 1).map(move |j| (k, i, j))))
    {
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend(
            [vertex(k, i, j), vertex(k, i + 1, j), vertex(k, i + 1, j + 1), vertex(k, i, j + 1)].map(|v| v.0),
        );
    }
    (Mesh::from_polygons(&polygons).expect("a disk"), vertex)
}

/// Junctions in a face at a pole. What is said: depth at the greens' limits is right by construction, so the deepest and
/// the highest point, and the least depth along the lines between the greens.
fn poles(rules: &RuleSet) {
    for sectors in [3, 4, 5, 6, 8] {
        let (mesh, v) = disk(sectors);
        let bands = [Band::groove(0.15, DEPTH), Band::parity()];
        let ring: Vec<Marked> = (0..sectors).map(|k| (v(k, 0, 0), v(k, 1, 0), 0)).collect();
        // Through sector 0 along its i axis, between j = 0 and 1; into the first face only; a T there.
        let row =
            |from: u32| -> Vec<Marked> { (from..SIDE - 1).map(|i| (v(0, i, 1), v(0, i, 0), 0)).collect() };
        let column = |from: u32, to: u32| -> Vec<Marked> {
            (from..=to).map(|j| (v(0, 0, j), v(0, 1, j), 0)).collect()
        };
        for (name, marks) in [
            ("ring round the pole", ring),
            ("corner away from the pole", [row(1), column(1, SIDE - 2)].concat()),
            ("dead end before the pole", row(1)),
        ] {
            let result = apply(rules, mesh.clone(), &bands, &marks, Method::None, &[]);
            let samples = sheet::samples(&result, &result.base, DVec2::ZERO, 1.6, 16);
            let [pit, peak] =
                [1.0, -1.0].map(|sign| samples.iter().map(|s| -s.height * sign / DEPTH).fold(0.0, f64::max));
            let pole = samples
                .iter()
                .filter(|s| s.at.length() < 0.08)
                .map(|s| -s.height / DEPTH)
                .fold(0.0, f64::max);
            println!(
                "pole {sectors} {name:26} deepest {pit:.3} highest {peak:.3} at the pole {pole:.3} {:?}",
                result.fired
            );
        }
    }
}

/// Control mesh, reflection lines and error of some junctions.
fn pictures(rules: &RuleSet, folder: &std::path::Path) {
    let all = [cases(0.15), piped_cases()].concat();
    for (file, name) in [
        ("t", "T-DE"),
        ("t_even", "T, stem of four lines"),
        ("dead_end", "DE3W"),
        ("piping_seam", "seam across piping"),
        ("piping_t", "seam into piping"),
        ("piping_piping", "piping across piping"),
    ] {
        let case = all.iter().find(|case| case.name == name).expect("a case");
        let result = apply(rules, sheet::sheet(flat), &case.bands, &case.marks, Method::None, case.set);
        let ideal = Ideal::new(&case.bands, case.lines.clone());
        let fine = |mesh: &Mesh| {
            let polygons = refine(mesh, 4).expect("fits").into_polygons();
            let refined = Mesh::from_polygons(&polygons).expect("refined");
            (limit_positions(&refined), refined, polygons)
        };
        let (base, ..) = fine(&result.base);
        let (points, refined, polygons) = fine(&result.mesh);
        let normals: Vec<DVec3> = (0..points.len() as u32)
            .map(|v| limit_normal(&refined, VertexId(v)).unwrap_or(DVec3::Z))
            .collect();
        let depth = case.bands[0].depth;
        let near = |p: &DVec3| (p.truncate() - CENTRE).abs().max_element() < 2.0;
        let values: Vec<f64> = points
            .iter()
            .zip(&base)
            .map(|(p, b)| if near(b) { (p.z - ideal.at(b.truncate())[0]) / depth } else { 0.0 })
            .collect();
        let cage = result.mesh.to_polygons();
        let shape = Shape {
            positions: &points,
            face_sizes: &polygons.face_sizes,
            face_vertices: &polygons.face_vertices,
        };
        let control = Shape {
            positions: &cage.positions,
            face_sizes: &cage.face_sizes,
            face_vertices: &cage.face_vertices,
        };
        let greens: Vec<u32> = result.greens.iter().map(|v| v.0).collect();
        let frame = [
            DVec3::new(2.2, 2.2, 0.0),
            DVec3::new(4.8, 4.8, 0.0),
            DVec3::new(2.2, 4.8, 0.0),
            DVec3::new(4.8, 2.2, 0.0),
        ];
        let panel = |content, caption| Panel { content, caption };
        let image = Figure {
            title: name,
            panels: vec![
                panel(
                    Content::Cage { shape: control, edges: &[], vertices: &greens, label: "displaced" },
                    "control mesh",
                ),
                panel(
                    Content::Surface { shape, normals: &normals, finish: Finish::ReflectionLines },
                    "reflection lines",
                ),
                panel(
                    Content::Scalar {
                        shape,
                        normals: &normals,
                        values: &values,
                        range: Some(0.3),
                        label: "error / depth",
                    },
                    "error against the sharp union",
                ),
            ],
            camera: Camera::framing(&frame, DVec3::new(0.0, -0.5, 1.0), DVec3::Y),
            width: 960,
            height: 400,
        }
        .render();
        let mut bytes = Vec::new();
        image.write_png(&mut bytes).expect("memory");
        std::fs::write(folder.join(format!("junction_{file}.png")), bytes)
            .expect("the folder can be written");
    }
}

fn main() {
    let rules = match std::env::var("RULES") {
        Ok(path) => RuleSet::load(path.as_ref()).unwrap_or_else(|e| panic!("{e}")),
        Err(_) => feature::linear_rules().expect("rules"),
    };
    flat_sheets(&rules);
    piped(&rules);
    curved(&rules);
    angles(&rules);
    unlike(&rules);
    poles(&rules);
    dents(&rules);
    if let Some(folder) = std::env::args_os().nth(1) {
        pictures(&rules, std::path::Path::new(&folder));
    }
}
