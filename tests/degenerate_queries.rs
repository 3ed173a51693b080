//! Queries with defined results where there is no one answer, or none: docs/queries.md has the table.

use crate::common;

use glam::DVec3;
use welt::mesh::{FaceId, Mesh, Polygons};
use welt::surface::{ClosestOptions, Foot, Hit, LimitSurface, Parameter};

const EVERYWHERE: ClosestOptions = ClosestOptions { radius: f64::INFINITY, facing: None };
/// Where the smooth cube of edge 2 ends along the axes: the limit of the centre of a face.
const TOP: f64 = 68.0 / 81.0;

/// A mesh of quads, all edges as sharp as told.
fn quads(positions: Vec<DVec3>, faces: &[[u32; 4]], sharpness: f32) -> Mesh {
    let faces: Vec<&[u32]> = faces.iter().map(<[u32; 4]>::as_slice).collect();
    let mut mesh = Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a surface");
    let half_edges: Vec<_> = mesh.faces().flat_map(|f| mesh.face_half_edges(f).collect::<Vec<_>>()).collect();
    for h in half_edges {
        mesh.set_edge_sharpness(h, sharpness);
    }
    mesh
}

/// Cubes with these centres and halves of edges; inside out where these are negative.
fn cubes(places: &[(DVec3, f64)], sharpness: f32) -> LimitSurface {
    let sides: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for &(centre, half) in places {
        let first = positions.len() as u32;
        let end = |i: u32, bit: u32| if i >> bit & 1 == 1 { half.abs() } else { -half.abs() };
        positions.extend((0..8).map(|i| centre + DVec3::new(end(i, 0), end(i, 1), end(i, 2))));
        for mut side in sides {
            if half < 0.0 {
                side.reverse();
            }
            faces.push(side.map(|v| first + v));
        }
    }
    LimitSurface::new(&quads(positions, &faces, sharpness))
}

fn smooth_cube() -> LimitSurface {
    cubes(&[(DVec3::ZERO, 1.0)], 0.0)
}

/// The cube itself: the limit surface of sharp edges.
fn sharp_cube() -> LimitSurface {
    cubes(&[(DVec3::ZERO, 1.0)], f32::INFINITY)
}

/// The square from (0, 0) to (6, 6), of 36 faces.
fn flat_sheet() -> LimitSurface {
    let positions = (0..49u32).map(|i| DVec3::new((i % 7).into(), (i / 7).into(), 0.0)).collect();
    let corners = (0..42u32).filter(|i| i % 7 < 6);
    let faces: Vec<[u32; 4]> = corners.map(|i| [i, i + 1, i + 8, i + 7]).collect();
    LimitSurface::new(&quads(positions, &faces, 0.0))
}

fn hits(surface: &LimitSurface, origin: [f64; 3], direction: [f64; 3]) -> Vec<Hit> {
    surface.line_hits(origin.into(), direction.into())
}

fn foot(surface: &LimitSurface, point: [f64; 3]) -> Foot {
    surface.closest(point.into(), &EVERYWHERE).expect("a foot")
}

fn assert_at(hits: &[Hit], expected: &[f64]) {
    let close = hits.iter().zip(expected).all(|(hit, s)| (hit.s - s).abs() < 1e-14);
    assert!(hits.len() == expected.len() && close, "{hits:?} {expected:?}");
}

fn directions() -> impl Iterator<Item = DVec3> {
    (1..60).map(|k| {
        let k = f64::from(k);
        DVec3::new((12.9 * k).sin(), (78.2 * k).sin(), (37.7 * k).sin())
    })
}

#[test]
fn a_line_through_an_extraordinary_vertex_or_an_edge_hits_it_once() {
    let cube = smooth_cube();
    // The limit points of the corners are their halves.
    let pole = DVec3::splat(0.5);
    let middle = foot(&cube, [0.0, 2.0, 2.0]).position;
    assert!(middle.x.abs() < 1e-15 && (middle.y - middle.z).abs() < 1e-15);
    for target in [pole, -pole, middle] {
        for direction in directions() {
            let found = cube.line_hits(target - 3.0 * direction, direction);
            let there = found.iter().filter(|hit| hit.position.distance(target) < 1e-9).count();
            assert!(there == 1 && found.len() == 2, "{target} {direction}: {found:?}");
        }
    }
    assert_at(&hits(&cube, [-5.0; 3], [1.0; 3]), &[4.5, 5.5]);
}

#[test]
fn a_tangent_line_gives_its_point_of_contact() {
    let cube = smooth_cube();
    let count = |height: f64| hits(&cube, [-5.0, 0.0, height], [1.0, 0.0, 0.0]).len();
    let contact = hits(&cube, [-5.0, 0.0, TOP], [1.0, 0.0, 0.0]);
    assert_eq!(contact.len(), 1);
    assert!(contact[0].position.distance(DVec3::Z * TOP) < 1e-6);
    assert_eq!([count(TOP + 1e-11), count(TOP - 1e-11)], [0, 2]);
}

#[test]
fn a_line_in_a_flat_surface_gives_points_of_it_at_most_one_per_patch() {
    let sheet = flat_sheet();
    let lines = [([-5.0, 2.0, 0.0], [1.0, 0.0, 0.0]), ([-5.0, 1.3, 0.0], [1.0, 0.2, 0.0]), ([-5.0, 0.0, 0.0], [2.0, 0.0, 0.0])];
    for (origin, direction) in lines {
        let found = hits(&sheet, origin, direction);
        assert!((1..=12).contains(&found.len()), "{} hits", found.len());
        for hit in &found {
            let on_line = DVec3::from(origin) + hit.s * DVec3::from(direction);
            assert!(hit.position.distance(on_line) < 1e-12 && hit.position.z == 0.0, "{hit:?}");
            assert!(hit.position.x >= 0.0 && hit.position.x <= 6.0);
        }
        assert!(found.windows(2).all(|pair| pair[0].s < pair[1].s));
        let first = sheet.first_line_hit(origin.into(), direction.into(), 0.0, f64::INFINITY).expect("a hit");
        assert!((0.0..=12.0).contains(&first.s));
    }
    assert!(hits(&sheet, [-5.0, 2.0, 1e-11], [1.0, 0.0, 0.0]).is_empty());
}

#[test]
fn lines_at_creases_and_corners() {
    let cube = sharp_cube();
    let edge = hits(&cube, [-5.0, 1.0, 1.0], [1.0, 0.0, 0.0]);
    assert!((1..=2).contains(&edge.len()), "{} hits along an edge", edge.len());
    for hit in &edge {
        assert!(hit.position.distance(DVec3::new(hit.s - 5.0, 1.0, 1.0)) < 1e-14 && (4.0..=6.0).contains(&hit.s));
    }
    let side = hits(&cube, [-5.0, 0.3, 1.0], [1.0, 0.1, 0.0]);
    assert!(!side.is_empty());
    for hit in &side {
        let p = hit.position;
        assert!((p.z - 1.0).abs() < 1e-14 && p.abs().max_element() < 1.0 + 1e-14, "{hit:?}");
    }
    assert_at(&hits(&cube, [0.1, 5.0, 5.0], [0.0, -1.0, -1.0]), &[4.0, 6.0]);
    assert_at(&hits(&cube, [5.0; 3], [-1.0; 3]), &[4.0, 6.0]);
    // An edge that is touched only.
    assert_at(&hits(&cube, [0.1, 0.0, 2.0], [0.0, 1.0, -1.0]), &[1.0]);
}

#[test]
fn lines_at_the_border_and_from_far_away() {
    let sheet = flat_sheet();
    let down = [0.0, 0.0, -1.0];
    assert_eq!(hits(&sheet, [3.0, 0.0, 5.0], down).len(), 1);
    assert_eq!(hits(&sheet, [3.0, -1e-11, 5.0], down).len(), 0);
    assert_eq!(hits(&sheet, [3.0, 3.0, 5.0], down).len(), 1, "a vertex of four faces");
    assert_eq!(hits(&sheet, [3.0, 2.5, 1e12], down)[0].s, 1e12);
    let cube = smooth_cube();
    let far = hits(&cube, [0.0, 0.0, 1e12], down);
    assert_eq!(far.len(), 2);
    // The parameter is rounded to the numbers there are; the position is not.
    assert!((far[0].s - (1e12 - TOP)).abs() <= 1e-4 && (far[0].position.z - TOP).abs() < 1e-14);
}

#[test]
fn senseless_lines_hit_nothing() {
    let cube = smooth_cube();
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for (origin, direction) in [
        ([0.0; 3], [0.0; 3]),
        ([nan, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([inf, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([0.0; 3], [0.0, nan, 1.0]),
        ([0.0; 3], [0.0, 0.0, inf]),
        ([0.0; 3], [0.0, 0.0, 1e-300]),
        ([0.0; 3], [0.0, 0.0, 1e300]),
    ] {
        assert!(hits(&cube, origin, direction).is_empty(), "{origin:?} {direction:?}");
        let (o, d) = (origin.into(), direction.into());
        assert!(cube.first_line_hit(o, d, 0.0, inf).is_none() && cube.nearest_line_hit(o, d, 9.0, DVec3::Z).is_none());
    }
    for direction in [[0.0, 0.0, 1e-140], [0.0, 0.0, 1e140]] {
        assert_eq!(hits(&cube, [0.0; 3], direction).len(), 2);
    }
    let between = |first, last| cube.line_hits_between(DVec3::ZERO, DVec3::Z, first, last).len();
    assert_eq!([between(nan, 1.0), between(0.0, nan), between(1.0, 0.0), between(0.0, inf)], [0, 0, 0, 1]);
}

#[test]
fn closest_points_where_many_are_equally_close_none_or_far() {
    let (smooth, sharp, sheet) = (smooth_cube(), sharp_cube(), flat_sheet());
    assert!((foot(&smooth, [0.0; 3]).distance - TOP).abs() < 1e-15);
    assert_eq!(foot(&sharp, [0.0; 3]).distance, 1.0);
    assert_eq!(foot(&sharp, [0.0; 3]), foot(&sharp, [0.0; 3]), "always the same one");
    assert_eq!(foot(&sharp, [2.0, 3.0, 3.0]).position, DVec3::ONE);
    assert_eq!(foot(&sharp, [0.25, 3.0, 3.0]).position, DVec3::new(0.25, 1.0, 1.0));
    assert_eq!(foot(&sheet, [-4.0, 3.0, 3.0]).distance, 5.0);
    assert_eq!(foot(&smooth, [0.5; 3]).distance, 0.0, "an extraordinary vertex");
    let on = hits(&smooth, [0.1, 0.2, 5.0], [0.0, 0.0, -1.0])[0].position;
    assert!(foot(&smooth, on.to_array()).distance < 1e-15);
    assert!((foot(&smooth, [0.0, 0.0, 1e12]).distance - (1e12 - TOP)).abs() <= 1e-4);
    assert!(foot(&smooth, [0.0, 0.0, 1e12]).position.distance(DVec3::Z * TOP) < 1e-9);
    assert_eq!(foot(&smooth, [1e59, 0.0, 0.0]).distance, 1e59);
    for x in [f64::NAN, f64::INFINITY, 1e61] {
        assert!(smooth.closest(DVec3::new(0.0, x, 0.0), &EVERYWHERE).is_none());
    }
    for radius in [0.0, -1.0, f64::NAN, 1.0 - 1e-9] {
        assert!(sharp.closest(DVec3::ZERO, &ClosestOptions { radius, facing: None }).is_none(), "{radius}");
    }
}

/// The start gives a bound, by another way of evaluating: where this is lower by rounding the search must still find its foot.
#[test]
fn a_start_at_the_foot_itself_is_found() {
    let Some(data) = common::shared_data() else { return };
    for file in ["product/bsby_fork_cage.obj", "osd/catmark_pole8.obj"] {
        let mesh = common::load(&data.join(file));
        let surface = LimitSurface::new(&mesh);
        let corners = || mesh.vertices().map(|v| mesh.position(v));
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        for k in 0..400 {
            let part = |factor: f64| 0.7 * (f64::from(k) * factor).sin();
            let point = 0.5 * (low + high) + (high - low) * DVec3::new(part(12.9), part(78.2), part(37.7));
            let foot = foot(&surface, point.to_array());
            let start = Parameter { face: foot.face, corner: foot.corner as u32, u: foot.u, v: foot.v };
            let again = surface.closest_from(start, point, &EVERYWHERE).expect("a foot");
            assert!((again.distance - foot.distance).abs() <= 1e-14 * surface.size(), "{file}: point {k}");
            let nowhere = Parameter { face: FaceId(u32::MAX), ..start };
            assert_eq!(surface.closest_from(nowhere, point, &EVERYWHERE), Some(foot));
        }
    }
}

/// The distance of a point to a cube of edge 2 about `centre`, negative inside.
fn cube_distance(point: DVec3, centre: DVec3, half: f64) -> f64 {
    let q = (point - centre).abs() - half;
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0)
}

#[test]
fn signed_distances_of_sharp_overlapping_and_hollow_solids() {
    assert!(flat_sheet().solid_distance(DVec3::ZERO).is_none(), "an open surface has no inside");
    let sharp = sharp_cube();
    assert_eq!(sharp.solid_distance(DVec3::ZERO), Some(-1.0));
    assert_eq!(sharp.solid_distance(DVec3::new(1.0, 0.2, 0.1)).map(f64::abs), Some(0.0));
    assert!(sharp.solid_distance(DVec3::splat(1e12)).is_some_and(|distance| distance > 1e12));
    assert!(sharp.solid_distance(DVec3::NAN).is_none() && sharp.solid_distance(DVec3::splat(1e61)).is_none());

    let (a, b) = (DVec3::ZERO, DVec3::new(1.2, 0.7, 0.4));
    let both = cubes(&[(a, 1.0), (b, 1.0)], f32::INFINITY);
    let hollow = cubes(&[(a, 1.0), (a, -0.5)], f32::INFINITY);
    let mut inside_both = 0;
    for k in 0..600 {
        let at = |factor: f64| (f64::from(k) * factor).sin();
        let point = DVec3::new(at(12.9), at(78.2), at(37.7)) * 2.5;
        let (to_a, to_b) = (cube_distance(point, a, 1.0), cube_distance(point, b, 1.0));
        let close = |found: Option<f64>, expected: f64| {
            assert!(found.is_some_and(|found| (found - expected).abs() < 1e-12), "{point}: {found:?} {expected}");
        };
        close(sharp.solid_distance(point), to_a);
        // To the nearest point of either, also where it is inside the other.
        let nearest = to_a.abs().min(to_b.abs());
        close(both.solid_distance(point), if to_a.min(to_b) < 0.0 { -nearest } else { nearest });
        inside_both += i32::from(to_a < 0.0 && to_b > 0.0 && to_b < -to_a);
        let to_hollow = cube_distance(point, a, 0.5);
        let nearest = to_a.abs().min(to_hollow.abs());
        close(hollow.solid_distance(point), if to_a < 0.0 && to_hollow > 0.0 { -nearest } else { nearest });
    }
    assert!(inside_both > 5, "points inside one that are nearer to the outside of the other: {inside_both}");
}
