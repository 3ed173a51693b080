//! Small meshes to fuzz on.

use glam::DVec3;
use welt::mesh::{Mesh, Polygons};

/// A cube of side 2 round the origin.
pub fn cube() -> Mesh {
    let positions = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - DVec3::ONE)
        .collect();
    let faces: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a cube is a mesh")
}

/// A sheet of 4 x 4 quads with a triangle and a pentagon at its rim: boundaries, odd faces, valences 3 to 5.
pub fn sheet() -> Mesh {
    let mut positions: Vec<DVec3> =
        (0..25).map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5), f64::from(i * i % 7) * 0.1)).collect();
    positions.extend([DVec3::new(0.5, -1.0, 0.0), DVec3::new(2.0, -1.0, 0.0), DVec3::new(3.0, -1.5, 0.2)]);
    let mut faces: Vec<Vec<u32>> = (0..16)
        .map(|i| {
            let at = i / 4 * 5 + i % 4;
            vec![at, at + 1, at + 6, at + 5]
        })
        .collect();
    faces.push(vec![1, 0, 25]);
    faces.push(vec![3, 2, 26, 27]);
    faces.push(vec![2, 1, 25, 26]);
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("the sheet is a mesh")
}
