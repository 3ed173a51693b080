//! Queries through the C ABI on the surface of a cube, whose corners have the limit points (1, 1, 1)/2 and their mirror
//! images.

use super::*;
use std::ptr::{null, null_mut};

const INFINITY: f64 = f64::INFINITY;

fn cube(faces: usize) -> *mut WeltSurface {
    let positions: Vec<f64> =
        (0..8).flat_map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 })).collect();
    let vertices: [u32; 24] = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5];
    let (mut mesh, mut surface) = (null_mut(), null_mut());
    // SAFETY: arrays and places of these sizes.
    unsafe {
        let (sizes, count) = ([4u32; 6].as_ptr(), 4 * faces);
        assert_eq!(
            welt_mesh_create(
                sizes,
                faces,
                vertices.as_ptr(),
                count,
                positions.as_ptr(),
                8,
                0,
                &mut mesh,
                null_mut()
            ),
            WELT_OK
        );
        assert_eq!(welt_surface_create(mesh, null(), 0, null(), &mut surface, null_mut()), WELT_OK);
        welt_mesh_free(mesh);
    }
    surface
}

fn options(threads: u32, input_stride: usize) -> WeltBatchOptions {
    WeltBatchOptions {
        struct_size: size_of::<WeltBatchOptions>() as u32,
        threads,
        input_stride,
        output_stride: 0,
    }
}

fn blank() -> WeltSurfacePoint {
    WeltSurfacePoint {
        face: 7,
        corner: 7,
        u: 7.0,
        v: 7.0,
        position: [7.0; 3],
        normal: [7.0; 3],
        distance: 7.0,
    }
}

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
}

#[test]
fn closest_points_and_distances() {
    let surface = cube(6);
    let corner = 4.5 * 3f64.sqrt();
    // Four doubles from point to point; the fourth does not matter.
    let points: Vec<f64> = [[5.0, 5.0, 5.0], [-5.0, 5.0, -5.0], [f64::NAN, 0.0, 0.0], [0.0; 3]]
        .iter()
        .flat_map(|p| [p[0], p[1], p[2], f64::NAN])
        .collect();
    let strided = options(2, 32);
    let mut found = [blank(); 4];
    // SAFETY: arrays and places of these sizes.
    unsafe {
        let (p, f) = (points.as_ptr(), found.as_mut_ptr());
        assert_eq!(
            welt_surface_closest(surface, p, 4, INFINITY, null(), &strided, f, 4, null_mut()),
            WELT_OK
        );
        assert!(near(found[0].position, [0.5; 3]) && (found[0].distance - corner).abs() < 1e-12);
        assert!(near(found[1].position, [-0.5, 0.5, -0.5]));
        assert_eq!((found[2].face, found[2].distance), (WELT_NONE, 0.0));
        assert!(found[3].face < 6 && found[3].distance < 0.9);
        // The starts of other points lead to the same ones.
        let mut starts = found;
        starts.reverse();
        let mut again = [blank(); 4];
        let a = again.as_mut_ptr();
        assert_eq!(
            welt_surface_closest(surface, p, 4, INFINITY, starts.as_ptr(), &strided, a, 4, null_mut()),
            WELT_OK
        );
        assert!(near(again[0].position, found[0].position) && near(again[1].position, found[1].position));
        assert_eq!(
            welt_surface_closest(surface, p, 1, corner - 1e-9, null(), null(), a, 4, null_mut()),
            WELT_OK
        );
        assert_eq!(again[0].face, WELT_NONE);
        assert_eq!(
            welt_surface_closest(surface, p, 4, INFINITY, null(), &strided, a, 3, null_mut()),
            WELT_ERROR_BUFFER
        );
        assert_eq!(
            welt_surface_closest(surface, p, 1, f64::NAN, null(), null(), a, 1, null_mut()),
            WELT_ERROR_ARGUMENT
        );
        assert_eq!(
            welt_surface_closest(surface, p, 4, INFINITY, null(), &options(1, 20), a, 4, null_mut()),
            WELT_ERROR_ARGUMENT
        );

        let mut distances = [7.0; 4];
        let d = distances.as_mut_ptr();
        assert_eq!(welt_surface_signed_distances(surface, p, 4, &strided, d, 4, null_mut()), WELT_OK);
        assert!((distances[0] - corner).abs() < 1e-12 && distances[2].is_nan());
        assert_eq!(distances[3], -found[3].distance);
        let open = cube(5);
        assert_eq!(
            welt_surface_signed_distances(open, p, 4, &strided, d, 4, null_mut()),
            WELT_ERROR_ARGUMENT
        );
        welt_surface_free(open);
        welt_surface_free(surface);
    }
}

#[test]
fn line_hits() {
    let surface = cube(6);
    // Through two extraordinary vertices, past the cube, and two that are none.
    let lines: [[f64; 6]; 4] = [
        [2.0, 2.0, 2.0, -1.0, -1.0, -1.0],
        [2.0, 2.0, 2.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, f64::NAN, 0.0, 1.0],
    ];
    let l = lines.as_ptr().cast::<f64>();
    let mut found = [blank(); 4];
    let f = found.as_mut_ptr();
    // SAFETY: arrays and places of these sizes.
    unsafe {
        assert_eq!(welt_surface_first_hits(surface, l, 4, 0.0, INFINITY, null(), f, 4, null_mut()), WELT_OK);
        assert!(near(found[0].position, [0.5; 3]) && (found[0].distance - 1.5).abs() < 1e-12);
        assert!(found[1..].iter().all(|hit| hit.face == WELT_NONE));
        assert_eq!(welt_surface_first_hits(surface, l, 1, 1.6, INFINITY, null(), f, 4, null_mut()), WELT_OK);
        assert!(near(found[0].position, [-0.5; 3]));
        assert_eq!(
            welt_surface_first_hits(surface, l, 1, f64::NAN, 0.0, null(), f, 4, null_mut()),
            WELT_ERROR_ARGUMENT
        );

        let (mut starts, mut needed) = ([7usize; 5], 0);
        let s = starts.as_mut_ptr();
        let all = |room, f, needed: &mut usize| {
            welt_surface_all_hits(surface, l, 4, -INFINITY, INFINITY, null(), s, needed, f, room, null_mut())
        };
        assert_eq!(all(0, null_mut(), &mut needed), WELT_ERROR_BUFFER);
        assert_eq!((needed, starts), (2, [7; 5]));
        assert_eq!(all(4, f, &mut needed), WELT_OK);
        assert_eq!(starts, [0, 2, 2, 2, 2]);
        assert!(near(found[0].position, [0.5; 3]) && near(found[1].position, [-0.5; 3]));
        welt_surface_free(surface);
    }
}
