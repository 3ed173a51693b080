//! Numbers at the ends of what numbers can be: results are finite, or refused in words. What rounding costs far from the
//! origin is measured.

use glam::DVec3;
use welt::feature::{self, Options, Request};
use welt::io::{self, Format, ImportOptions};
use welt::job::Job;
use welt::mark::{Selection, Selector};
use welt::mesh::{Defect, FaceId, HalfEdgeId, Mesh, Polygons};
use welt::optimise::Stop;
use welt::subdivision::{limit_points, refine};
use welt::surface::{ClosestOptions, LimitSurface};

const SIDE: u32 = 8;

/// A wavy sheet of 8 x 8 quads of the size `scale`, at `origin`.
fn sheet(scale: f64, origin: DVec3) -> Polygons {
    let count = SIDE + 1;
    let height = |x: f64, y: f64| 0.3 * (0.8 * x).sin() * (0.5 * y).cos();
    let positions = (0..count * count)
        .map(|k| (f64::from(k % count), f64::from(k / count)))
        .map(|(x, y)| origin + scale * DVec3::new(x, y, height(x, y)))
        .collect();
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for corner in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| y * count + x)) {
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([corner, corner + 1, corner + count + 1, corner + count]);
    }
    polygons
}

/// What users do with a mesh, as numbers: refined points, limits and normals, points, feet and hits of the surface, and the mesh
/// with a groove, whose width and depth are parts of the edges. The second list has directions.
fn worked(polygons: &Polygons) -> (Vec<DVec3>, Vec<DVec3>, Result<Vec<DVec3>, String>) {
    // As a file, too: numbers are written and read.
    let mut text = Vec::new();
    io::obj::write(polygons, &mut text).expect("written");
    let import = io::import_bytes("a.obj", Format::Obj, &text, &ImportOptions::default()).expect("read");
    let mut mesh = import.mesh;
    assert_eq!(mesh.to_polygons().positions, polygons.positions, "read to the last bit");
    let mut points = refine(&mesh, 2).expect("fits").positions;
    let limits = limit_points(&mesh);
    points.extend(limits.iter().map(|point| point.position));
    let mut directions: Vec<DVec3> = limits.iter().map(|point| point.normal().unwrap_or_default()).collect();
    let surface = LimitSurface::new(&mesh);
    for face in (0..SIDE * SIDE).step_by(5).map(FaceId) {
        let point = surface.evaluate(face, 0, 0.25, 0.75).expect("a point");
        points.push(point.position);
        directions.push(point.normal);
        let edge = mesh.edge_length(mesh.face_half_edge(face));
        let above = point.position + 0.1 * edge * point.normal;
        if let Some(foot) = surface.closest(above, &ClosestOptions::default()) {
            points.push(foot.position);
            directions.push(foot.normal);
            assert!(foot.distance.is_finite());
        }
        for hit in surface.line_hits(above, DVec3::NEG_Z) {
            points.push(hit.position);
            assert!(hit.s.is_finite());
        }
    }
    let selectors = ["ring:40,41"].map(|text| Selector::parse(text).expect("a selector"));
    let selection = Selection::resolve(&mesh, &selectors).expect("a ring");
    let request = Request::features(&["groove"], &["width=40%", "depth=20%"]).expect("a request");
    let options = Options { samples: 4, ..Options::default() };
    let before = mesh.to_polygons();
    let grooved = match feature::apply(&mut mesh, &selection, &request, &options, &Job::new()) {
        Ok(report) => {
            mesh.validate_control_mesh().expect("a control mesh");
            let text = serde_json::to_string(&report).expect("a report");
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            Ok(mesh.vertices().map(|v| mesh.position(v)).collect())
        }
        Err(error) => {
            assert_eq!(mesh.to_polygons(), before, "{error}");
            Err(error.to_string())
        }
    };
    (points, directions, grooved)
}

#[track_caller]
fn all_finite(points: &[DVec3]) {
    assert!(points.iter().all(|p| p.is_finite()), "{:?}", points.iter().find(|p| !p.is_finite()));
}

/// Sizes from the smallest that squares can hold to the largest that is accepted, and below: there normals are lost, no more.
#[test]
fn results_are_finite_at_every_scale() {
    let (reference, directions, grooved) = worked(&sheet(1.0, DVec3::ZERO));
    let grooved = grooved.expect("a groove");
    for exponent in [-300, -150, -100, -60, -30, -9, 9, 30, 49] {
        let scale = 10f64.powi(exponent);
        let (points, normals, feature) = worked(&sheet(scale, DVec3::ZERO));
        all_finite(&points);
        all_finite(&normals);
        if let Ok(points) = &feature {
            all_finite(points);
        }
        // What scales, scales: subdivision and features are the same at every size that squares of lengths can have.
        if (-60..=30).contains(&exponent) {
            assert_eq!(points.len(), reference.len(), "1e{exponent}");
            let error = |points: &[DVec3], expected: &[DVec3]| {
                points.iter().zip(expected).map(|(p, q)| (*p / scale).distance(*q)).fold(0.0, f64::max)
            };
            assert!(error(&points, &reference) < 1e-9, "1e{exponent}: {}", error(&points, &reference));
            let turned = normals.iter().zip(&directions).map(|(n, m)| n.distance(*m)).fold(0.0, f64::max);
            assert!(turned < 1e-9, "1e{exponent}: normals turned by {turned}");
            let feature = feature.unwrap_or_else(|error| panic!("1e{exponent}: {error}"));
            assert_eq!(feature.len(), grooved.len(), "1e{exponent}");
            assert!(error(&feature, &grooved) < 1e-6, "1e{exponent}: {}", error(&feature, &grooved));
        }
    }
}

#[test]
fn denormal_numbers_give_finite_results() {
    for scale in [f64::MIN_POSITIVE, 5e-324, 1e-320] {
        let (points, normals, feature) = worked(&sheet(scale, DVec3::ZERO));
        all_finite(&points);
        all_finite(&normals);
        if let Ok(points) = feature {
            all_finite(&points);
        }
    }
    // One vertex that is no further off than rounding.
    let mut polygons = sheet(1.0, DVec3::ZERO);
    polygons.positions[40] = polygons.positions[41] + DVec3::splat(5e-324);
    let (points, normals, _) = worked(&polygons);
    all_finite(&points);
    all_finite(&normals);
}

#[test]
fn numbers_beyond_the_range_are_refused() {
    for (number, message) in [
        (
            "1e308",
            "a.obj:1:3: the coordinate 1e308 is out of range; scale the model; coordinates lie between -1e50 and 1e50",
        ),
        ("-1.1e50", "a.obj:1:3: the coordinate -1.1e50 is out of range; scale the model"),
        ("1e309", "a.obj:1:3: the coordinate inf is not a finite number"),
        ("nan", "a.obj:1:3: the coordinate NaN is not a finite number"),
    ] {
        let text = format!("v {number} 0 0\n");
        let error = io::import_bytes("a.obj", Format::Obj, text.as_bytes(), &ImportOptions::default());
        let error = error.expect_err(number).to_string();
        assert!(error.starts_with(message), "{error}");
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\n\
             end_header\n0 {number} 0\n"
        );
        let error = io::import_bytes("a.ply", Format::Ply, text.as_bytes(), &ImportOptions::default());
        assert!(error.expect_err(number).to_string().starts_with("a.ply:8:3: vertex 0: the coordinate "));
    }
    for number in [1e308, -1e51, f64::NAN, f64::INFINITY] {
        let mut polygons = sheet(1.0, DVec3::ZERO);
        polygons.positions[7].y = number;
        let defects = Mesh::from_polygons(&polygons).expect_err("out of range").0;
        assert_eq!(defects, [Defect::NotFinite { vertex: 7 }]);
        let mut mesh = Mesh::from_polygons(&sheet(1.0, DVec3::ZERO)).expect("a sheet");
        assert!(mesh.make_ev_one(HalfEdgeId(0), DVec3::new(0.0, number, 0.0)).is_err());
    }
    // Settings beyond the range.
    for set in ["width=1e308", "width=nan", "depth=-inf", "width=1e51"] {
        assert!(Request::features(&["groove"], &[set]).is_err(), "{set}");
    }
    // Queries from anywhere.
    let surface = LimitSurface::new(&Mesh::from_polygons(&sheet(1.0, DVec3::ZERO)).expect("a sheet"));
    for number in [f64::NAN, f64::INFINITY, 1e308, -1e308, 5e-324] {
        for point in [DVec3::new(number, 1.0, 1.0), DVec3::splat(number)] {
            if let Some(foot) = surface.closest(point, &ClosestOptions::default()) {
                assert!(foot.position.is_finite() && !foot.distance.is_nan(), "{number}: {foot:?}");
            }
            assert!(surface.line_hits(point, DVec3::NEG_Z).iter().all(|hit| hit.position.is_finite()));
            assert!(surface.line_hits(DVec3::ONE, point).iter().all(|hit| hit.position.is_finite()));
        }
    }
}

/// Details of 10^-6 at 10^9: numbers there are 1.2 * 10^-7 apart, and so exact are the results, next to those at the origin.
#[test]
fn details_of_a_micrometre_at_a_billion_keep_what_numbers_hold() {
    let spacing = 2f64.powi(-23);
    let far = DVec3::new(1e9, -1e9, 1e9);
    // As far off, the sheet has rounded corners: the same ones are taken to the origin.
    let there = sheet(1e-6, far);
    let mut here = there.clone();
    here.positions.iter_mut().for_each(|p| *p -= far);
    let (points, normals, feature) = worked(&there);
    let (expected, _, _) = worked(&here);
    all_finite(&points);
    all_finite(&normals);
    if let Ok(points) = feature {
        all_finite(&points);
    }
    // Refined points and limits come first, in the same order.
    let count = (4 * SIDE as usize + 1).pow(2) + (SIDE as usize + 1).pow(2);
    let error = points[..count].iter().zip(&expected).map(|(p, q)| (*p - far - *q).abs().max_element());
    let error = error.fold(0.0, f64::max);
    println!("lost at 1e9: {error:e}, {} spacings of numbers", error / spacing);
    assert!(error <= 4.0 * spacing, "{error:e}");

    // With details of a millimetre a groove there is the groove here, as exact as numbers are.
    let there = sheet(1e-3, far);
    let mut here = there.clone();
    here.positions.iter_mut().for_each(|p| *p -= far);
    let grooved = worked(&there).2.expect("a groove");
    let expected = worked(&here).2.expect("a groove");
    assert_eq!(grooved.len(), expected.len());
    let error =
        grooved.iter().zip(&expected).map(|(p, q)| (*p - far - *q).abs().max_element()).fold(0.0, f64::max);
    println!("lost by a groove at 1e9: {error:e}");
    assert!(error < 2e-5, "{error:e}");
}

/// Edges of a micrometre, 10^9 away: nothing can be measured there, which the report says.
#[test]
fn nothing_is_fitted_where_numbers_are_coarser_than_edges() {
    let groove = |origin| {
        let mut mesh = Mesh::from_polygons(&sheet(1e-6, origin)).expect("a sheet");
        let selector = Selector::parse("ring:40,41").expect("a selector");
        let selection = Selection::resolve(&mesh, &[selector]).expect("a ring");
        let request = Request::features(&["groove"], &["width=40%", "depth=0"]).expect("a request");
        feature::apply(&mut mesh, &selection, &request, &Options::default(), &Job::new()).expect("applied")
    };
    let (far, here) = (groove(DVec3::splat(1e9)), groove(DVec3::ZERO));
    assert_eq!(far.fit.stop, Stop::TooCoarse);
    assert!(far.to_string().contains("not done so far from the origin"), "{far}");
    assert_ne!(here.fit.stop, Stop::TooCoarse);
}
