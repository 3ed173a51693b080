//! Faces side by side in a plane, for drawings.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Positions of the vertices of `faces`: the first face is a regular polygon whose first side lies below, each further
/// one is put on the outside of a side it shares with one that has its place. `corners` tells vertices where sides
/// begin from those inside of straight sides.
pub(super) fn positions(faces: &[&[u32]], corners: &[bool]) -> Vec<DVec3> {
    let mut places: Vec<Option<DVec2>> = vec![None; corners.len()];
    let mut left: Vec<&[u32]> = faces.to_vec();
    while !left.is_empty() {
        let shared = |face: &[u32]| sides(face, corners).iter().any(|side| ends(side, &places).is_some());
        let next = left.iter().position(|face| shared(face)).unwrap_or(0);
        place(left.remove(next), corners, &mut places);
    }
    places.into_iter().map(|p| p.unwrap_or_default().extend(0.0)).collect()
}

/// The sides of a face: the vertices of each, both ends included.
fn sides(face: &[u32], corners: &[bool]) -> Vec<Vec<u32>> {
    let n = face.len();
    let starts: Vec<usize> = (0..n).filter(|&i| corners[face[i] as usize]).collect();
    starts
        .iter()
        .zip(starts.iter().cycle().skip(1))
        .map(|(&start, &end)| {
            let count = (end + n - start - 1) % n + 1;
            (0..=count).map(|i| face[(start + i) % n]).collect()
        })
        .collect()
}

/// The places of the ends of a side.
fn ends(side: &[u32], places: &[Option<DVec2>]) -> Option<[DVec2; 2]> {
    Some([places[*side.first()? as usize]?, places[*side.last()? as usize]?])
}

fn place(face: &[u32], corners: &[bool], places: &mut [Option<DVec2>]) {
    let sides = sides(face, corners);
    let n = sides.len();
    // Where the polygon goes: on a side that has its place, else far from the others, its first side below.
    let known = sides.iter().enumerate().find_map(|(i, side)| Some((i, ends(side, places)?)));
    let right = places.iter().flatten().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
    let start = if right.is_finite() { right + 1.0 } else { 0.0 };
    let (first, [a, b]) = known.unwrap_or((0, [DVec2::new(start, 0.0), DVec2::new(start + 1.0, 0.0)]));
    let mut at = a;
    let mut direction = b - a;
    for i in 0..n {
        let side = &sides[(first + i) % n];
        let from = *places[side[0] as usize].get_or_insert(at);
        at += direction;
        direction = DVec2::from_angle(TAU / n as f64).rotate(direction);
        let to = places[side[side.len() - 1] as usize].unwrap_or(at);
        let pieces = side.len() - 1;
        for (k, &v) in side.iter().enumerate().take(pieces).skip(1) {
            places[v as usize].get_or_insert(from.lerp(to, k as f64 / pieces as f64));
        }
    }
}
