//! No memory for a large list: an error that says how much was asked for, and nothing lost. The allocator of this program refuses
//! large lists on demand, one after the other.

use glam::DVec3;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use welt::io::{self, Format, ImportError, ImportOptions};
use welt::job::Job;
use welt::mesh::{Defect, FaceId, Mesh, Polygons};
use welt::subdivision::{RefineError, Refinement};
use welt::surface::{FreezeError, LimitSurface, Sampling, compare};

/// What is large, in bytes.
const LARGE: usize = 64 << 10;

/// Refuses a large list after as many others.
struct Failing;

thread_local! {
    static LEFT: Cell<Option<usize>> = const { Cell::new(None) };
}

fn refuses(size: usize) -> bool {
    if size < LARGE {
        return false;
    }
    let left = LEFT.get();
    LEFT.set(left.map(|left| left.saturating_sub(1)));
    left == Some(0)
}

// SAFETY: everything is left to the allocator of the system, or refused.
unsafe impl GlobalAlloc for Failing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if refuses(layout.size()) { std::ptr::null_mut() } else { unsafe { System.alloc(layout) } }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if refuses(size) { std::ptr::null_mut() } else { unsafe { System.realloc(place, layout, size) } }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Failing = Failing;

/// Lets `work` find no memory for its n-th large list, for all n until it succeeds; gives the messages.
fn fail_everywhere<T, E: std::fmt::Display>(work: impl Fn() -> Result<T, E>) -> (T, Vec<String>) {
    let mut messages = Vec::new();
    loop {
        LEFT.set(Some(messages.len()));
        let result = work();
        LEFT.set(None);
        match result {
            Ok(value) => return (value, messages),
            Err(error) => messages.push(error.to_string()),
        }
        assert!(messages.len() < 10_000, "it never succeeds");
    }
}

#[track_caller]
fn told(messages: &[String], at_least: usize, prefix: &str) {
    assert!(messages.len() >= at_least, "only {} large lists", messages.len());
    for message in messages {
        let bytes = message
            .strip_prefix(&format!("{prefix}no memory for a list of "))
            .unwrap_or_else(|| panic!("{message}"));
        let (bytes, rest) = bytes.split_once(" bytes; ").unwrap_or_else(|| panic!("{message}"));
        assert!(bytes.parse::<usize>().expect("a size") > 0);
        assert!(rest.starts_with("ask for less, or free memory"), "{message}");
    }
}

fn sheet(side: u32) -> Polygons {
    let count = side + 1;
    let positions = (0..count * count)
        .map(|k| DVec3::new(f64::from(k % count), f64::from(k / count), f64::from(k % 7)))
        .collect();
    let mut polygons = Polygons { positions, ..Polygons::default() };
    for corner in (0..side).flat_map(|y| (0..side).map(move |x| y * count + x)) {
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([corner, corner + 1, corner + count + 1, corner + count]);
    }
    polygons
}

#[test]
fn meshes_refinements_surfaces_and_files() {
    let polygons = sheet(150);
    let (mesh, messages) = fail_everywhere(|| {
        Mesh::from_polygons(&polygons).inspect_err(|defects| {
            assert!(matches!(defects.0[..], [Defect::NoMemory { .. }]), "{defects}");
        })
    });
    println!("a mesh: {} large lists", messages.len());
    told(&messages, 6, "");

    let control: Vec<DVec3> = mesh.positions().to_vec();
    let ((refinement, positions), messages) = fail_everywhere(|| {
        let refinement = Refinement::new(&mesh, 2)?;
        let positions = refinement.positions(2, &control)?;
        refinement.limit_positions(2, &positions)?;
        Ok::<_, RefineError>((refinement, positions))
    });
    println!("a refinement: {} large lists", messages.len());
    told(&messages, 10, "");
    let (level, messages) = fail_everywhere(|| refinement.polygons(2, positions.clone_quietly()));
    told(&messages, 2, "");
    assert_eq!(level.face_sizes.len(), 150 * 150 * 16);

    let faces: Vec<FaceId> = mesh.faces().collect();
    let (surface, messages) = fail_everywhere(|| {
        LimitSurface::around_with(&mesh, &faces, &Job::new()).inspect_err(|error| {
            assert!(matches!(error, FreezeError::Memory(_)));
        })
    });
    println!("a surface: {} large lists", messages.len());
    told(&messages, 4, "");
    assert_eq!(surface.faces().count(), faces.len());

    let ((), messages) = fail_everywhere(|| surface.prepare());
    println!("what queries search: {} large lists", messages.len());
    told(&messages, 4, "");
    let (copy, messages) = fail_everywhere(|| mesh.try_clone());
    println!("a copy: {} large lists", messages.len());
    told(&messages, 4, "");
    let (again, messages) = fail_everywhere(|| copy.try_to_polygons());
    println!("polygons of a mesh: {} large lists", messages.len());
    told(&messages, 4, "");
    assert!(again == polygons);

    let mut text = Vec::new();
    io::obj::write(&polygons, &mut text).expect("written");
    let mut ply = Vec::new();
    io::ply::write(&polygons, &io::ply::Options::default(), &mut ply).expect("written");
    for (format, content) in [(Format::Obj, &text), (Format::Ply, &ply)] {
        let (import, messages) = fail_everywhere(|| {
            let import = io::import_bytes("a", format, content, &ImportOptions::default());
            import.inspect_err(|error| assert!(matches!(error, ImportError::Memory { .. }), "{error}"))
        });
        println!("{format:?}: {} large lists", messages.len());
        told(&messages, 10, "a: ");
        assert_eq!(import.mesh.faces().count(), faces.len());
    }
}

/// Its samples are the largest lists of all.
#[test]
fn deviations() {
    let [first, second] =
        [sheet(40), sheet(40)].map(|polygons| Mesh::from_polygons(&polygons).expect("a sheet"));
    let sampling = Sampling { per_side: 2, threads: 1 };
    let (found, messages) = fail_everywhere(|| {
        compare(&first, &second, sampling, &Job::new()).inspect_err(|error| {
            assert!(matches!(error, FreezeError::Memory(_)));
        })
    });
    println!("a deviation: {} large lists", messages.len());
    told(&messages, 8, "");
    assert_eq!(found.both.samples, 2 * 40 * 40 * 4);
    assert!(found.both.max < 1e-9, "{}", found.both.max);
}

/// A copy whose memory is not refused.
trait CloneQuietly {
    fn clone_quietly(&self) -> Self;
}

impl CloneQuietly for Vec<DVec3> {
    fn clone_quietly(&self) -> Self {
        let left = LEFT.take();
        let copy = self.clone();
        LEFT.set(left);
        copy
    }
}
