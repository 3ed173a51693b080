//! What several integration tests share.

pub mod curved_sheet;
pub mod junction_cases;
pub mod rings;
pub mod sheet;

use std::path::PathBuf;

/// The folder of test meshes beside the project; `None`, and a line on standard output, where it is absent.
pub fn shared_data() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: ../shared is absent");
    None
}

/// The content of a test mesh, unpacked when it ends with `.gz`.
pub fn content(path: &std::path::Path) -> Vec<u8> {
    let bytes = std::fs::read(path).expect("a file of the catalogue is readable");
    if path.extension().is_none_or(|extension| extension != "gz") {
        return bytes;
    }
    let mut unpacked = Vec::new();
    std::io::Read::read_to_end(&mut flate2::read::GzDecoder::new(bytes.as_slice()), &mut unpacked)
        .expect("a file of the catalogue unpacks");
    unpacked
}

/// The control mesh in a file of `../shared/data` or of `tests/data`.
pub fn load(path: &std::path::Path) -> welt::mesh::Mesh {
    welt::io::import(path, &welt::io::ImportOptions::default()).expect("a clean mesh").mesh
}

/// The `.obj` files of one folder of `../shared/data` that the kernel can hold, by name.
pub fn clean_cages(data: &std::path::Path, folder: &str) -> Vec<(String, welt::mesh::Mesh)> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(data.join(folder))
        .expect("a folder of the catalogue")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "obj"))
        .collect();
    paths.sort();
    paths
        .into_iter()
        .filter_map(|path| {
            let mesh = welt::io::import(&path, &welt::io::ImportOptions::default()).ok()?.mesh;
            Some((path.file_name()?.to_string_lossy().into_owned(), mesh))
        })
        .collect()
}

/// The rule files of the project that are sets of their own, not parts that another file includes.
pub fn rule_sets() -> Vec<PathBuf> {
    let mut files: Vec<(PathBuf, String)> =
        std::fs::read_dir(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("rules"))
            .expect("the rules")
            .map(|entry| entry.expect("an entry").path())
            .map(|path| (path.clone(), std::fs::read_to_string(path).expect("text")))
            .collect();
    files.sort();
    let is_part = |path: &PathBuf| {
        let name = path.file_name().map(|name| format!("include \"{}\"", name.to_string_lossy()));
        name.is_some_and(|name| files.iter().any(|(_, text)| text.contains(&name)))
    };
    files.iter().map(|(path, _)| path.clone()).filter(|path| !is_part(path)).collect()
}

/// A flat sheet of `side` x `side` unit cells; vertex (i, j) lies at (i, j, 0) and is number (side + 1) j + i.
pub fn flat_sheet(side: u32) -> welt::mesh::Mesh {
    let count = side + 1;
    let positions = (0..count * count)
        .map(|k| glam::DVec3::new(f64::from(k % count), f64::from(k / count), 0.0))
        .collect();
    let mut polygons = welt::mesh::Polygons { positions, ..welt::mesh::Polygons::default() };
    for (i, j) in (0..side).flat_map(|j| (0..side).map(move |i| (i, j))) {
        let at = |i: u32, j: u32| j * count + i;
        polygons.face_sizes.push(4);
        polygons.face_vertices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    welt::mesh::Mesh::from_polygons(&polygons).expect("a sheet")
}
