//! Writing and reading again keeps everything; a second reader agrees.

use crate::common;

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use welt::io::{self, Format, ImportOptions, obj, ply};
use welt::mesh::{BoundaryRule, Creasing, FaceSet, MOST_COORDINATE, Mesh, Polygons, SubdivisionOptions};

fn read(format: Format, bytes: &[u8]) -> io::Source {
    io::read_bytes("written", format, bytes, &ImportOptions::default()).expect("what was written can be read")
}

fn write_obj(polygons: &Polygons) -> Vec<u8> {
    let mut bytes = Vec::new();
    obj::write(polygons, &mut bytes).expect("memory can be written");
    bytes
}

fn bits(positions: &[DVec3]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

/// All OBJ files of the collection that become a mesh.
fn meshes() -> Vec<(PathBuf, Vec<u8>, Mesh)> {
    let Some(data) = common::shared_data() else { return Vec::new() };
    let mut meshes = Vec::new();
    for folder in ["classic", "mechanical", "organic", "osd", "product", "stress", "upholstery"] {
        for entry in std::fs::read_dir(data.join(folder)).expect("the folder is readable") {
            let path = entry.expect("an entry").path();
            if !path.to_string_lossy().contains(".obj") {
                continue;
            }
            let bytes = common::content(&path);
            let name = path.display().to_string();
            if let Ok(import) = io::import_bytes(&name, Format::Obj, &bytes, &ImportOptions::default()) {
                meshes.push((path, bytes, import.mesh));
            }
        }
    }
    assert!(meshes.len() > 150, "most files become a mesh");
    meshes
}

#[test]
fn every_mesh_survives_obj_and_ply() {
    for (path, _, mesh) in meshes() {
        let polygons = mesh.to_polygons();
        let again = read(Format::Obj, &write_obj(&polygons));
        assert_eq!(bits(&again.polygons.positions), bits(&polygons.positions), "{}", path.display());
        let again = again.build().expect("a mesh again").mesh.to_polygons();
        assert_eq!(again, polygons, "{}", path.display());
        for encoding in [ply::Encoding::Ascii, ply::Encoding::BinaryLittleEndian] {
            let mut bytes = Vec::new();
            let options = ply::Options { encoding, ..ply::Options::default() };
            ply::write(&polygons, &options, &mut bytes).expect("memory can be written");
            let again = read(Format::Ply, &bytes);
            assert_eq!(bits(&again.polygons.positions), bits(&polygons.positions), "{}", path.display());
            assert_eq!(again.polygons.face_sizes, polygons.face_sizes);
            assert_eq!(again.polygons.face_vertices, polygons.face_vertices);
            assert!(again.report.ignored.is_empty());
        }
    }
}

#[test]
fn a_second_reader_agrees() {
    let mut compared = 0;
    for (path, bytes, mesh) in meshes() {
        // tobj reads the points and lines of a longer `p` or `l` statement as a face.
        if bytes.windows(3).any(|text| matches!(text, b"\nl " | b"\np ")) {
            continue;
        }
        // Colours, tags and texture coordinates aside, both readers see the same corners at the same places.
        let options = tobj::LoadOptions {
            single_index: false,
            ignore_points: true,
            ignore_lines: true,
            ..Default::default()
        };
        let no_materials = |_: &Path| Ok(Default::default());
        let Ok((models, _)) = tobj::load_obj_buf(&mut bytes.as_slice(), &options, no_materials) else {
            continue;
        };
        let mut sizes: Vec<u32> = Vec::new();
        let mut corners: Vec<[f32; 3]> = Vec::new();
        for model in &models {
            let mesh = &model.mesh;
            if mesh.face_arities.is_empty() {
                sizes.extend(std::iter::repeat_n(3, mesh.indices.len() / 3));
            } else {
                sizes.extend(&mesh.face_arities);
            }
            corners.extend(mesh.indices.iter().map(|&i| {
                let start = 3 * i as usize;
                [mesh.positions[start], mesh.positions[start + 1], mesh.positions[start + 2]]
            }));
        }
        let ours = mesh.to_polygons();
        let places = ours.face_vertices.iter().map(|&vertex| ours.positions[vertex as usize]);
        let places: Vec<[f32; 3]> = places.map(|p| p.as_vec3().to_array()).collect();
        assert_eq!(sizes, ours.face_sizes, "{}", path.display());
        assert_eq!(corners, places, "{}", path.display());
        compared += 1;
    }
    println!("{compared} files compared with tobj");
    assert!(compared > 150 || common::shared_data().is_none(), "tobj reads most files");
}

/// Two quads and a triangle with everything the writer knows.
fn everything() -> Polygons {
    let set =
        |groups: &[&str], object: Option<&str>, material: Option<&str>, smoothing: Option<&str>| FaceSet {
            groups: groups.iter().map(ToString::to_string).collect(),
            object: object.map(str::to_string),
            material: material.map(str::to_string),
            smoothing: smoothing.map(str::to_string),
        };
    Polygons {
        positions: [
            [0.1, -0.0, 1e-300],
            [1.0 / 3.0, 0.0, f64::MIN_POSITIVE],
            [1e50, 1.5, 0.3],
            [-7.25, 1e16, 123456789.12345679],
            [2.0, 3.0, 4.0],
            [9.0, 9.0, 9.0],
            [5.0, 6.0, 7.0],
        ]
        .map(DVec3::from_array)
        .to_vec(),
        face_sizes: vec![4, 3, 3],
        face_vertices: vec![0, 1, 2, 3, 2, 1, 4, 4, 6, 2],
        texcoords: vec![DVec2::new(0.5, 0.1), DVec2::new(1.0, -2.0)],
        face_texcoords: vec![0, 1, 0, 1, u32::MAX, u32::MAX, u32::MAX, 1, 1, 0],
        sets: vec![
            set(&["seat", "left"], Some("Stühl 椅"), Some("leather brown"), Some("1")),
            set(&[], None, None, None),
            set(&["back"], Some("Stühl 椅"), None, Some("off")),
        ],
        face_sets: vec![0, 1, 2],
        material_libraries: vec!["chair one.mtl".into(), "b.mtl".into()],
        creases: vec![(1, 2, 2.5), (2, 4, 0.1), (0, 1, f32::INFINITY)],
        corners: vec![(3, 10.0)],
        holes: vec![1],
        subdivision: SubdivisionOptions {
            boundary: BoundaryRule::EdgeAndCorner,
            creasing: Creasing::Chaikin,
        },
    }
}

#[test]
fn groups_materials_texcoords_and_tags_survive() {
    let polygons = everything();
    let bytes = write_obj(&polygons);
    let again = read(Format::Obj, &bytes);
    assert_eq!(again.polygons, polygons);
    assert!(again.report.ignored.is_empty(), "{}", again.report);
    let mesh = again.build().expect("a mesh").mesh;
    let text = String::from_utf8(write_obj(&mesh.to_polygons())).expect("UTF-8");
    for line in [
        "mtllib chair one.mtl",
        "o Stühl 椅",
        "g seat left",
        "usemtl leather brown",
        "f 3 2 5",
        "f 5/2 7/2 3/1",
    ] {
        assert!(text.lines().any(|l| l == line), "'{line}' is not in\n{text}");
    }
}

#[test]
fn names_cannot_break_the_file() {
    let mut polygons = everything();
    polygons.sets[0].material = Some("a\nf 1 2 3\r#".into());
    polygons.sets[0].object = Some("#x \\".into());
    polygons.sets[0].groups = vec!["two words".into(), "#".into()];
    let again = read(Format::Obj, &write_obj(&polygons)).polygons;
    assert_eq!(again.face_vertices, polygons.face_vertices);
    assert_eq!(again.sets[0].groups, ["two_words", "_"]);
}

#[test]
fn ply_carries_normals_quality_and_colours() {
    let polygons = Polygons { sets: vec![], face_sets: vec![], ..everything() };
    let count = polygons.positions.len();
    let normals = vec![DVec3::Z; count];
    let quality: Vec<f64> = (0..count).map(|i| i as f64 / 8.0).collect();
    let colours = vec![[255, 128, 0]; count];
    let options = ply::Options {
        encoding: ply::Encoding::Ascii,
        normals: Some(&normals),
        quality: Some(&quality),
        colours: Some(&colours),
    };
    let mut bytes = Vec::new();
    ply::write(&polygons, &options, &mut bytes).expect("memory can be written");
    let text = String::from_utf8(bytes).expect("ascii");
    let expected = "ply\nformat ascii 1.0\nelement vertex 7\nproperty double x\nproperty double y\nproperty double z\n\
                    property double nx\nproperty double ny\nproperty double nz\nproperty double quality\n\
                    property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 3\n\
                    property list uchar int vertex_indices\nend_header\n0.1 -0 1e-300 0 0 1 0 255 128 0\n";
    assert!(text.starts_with(expected), "{text}");
    assert!(text.ends_with("4 0 1 2 3\n3 2 1 4\n3 4 6 2\n"), "{text}");
    let short = ply::Options { quality: Some(&quality[1..]), ..options };
    assert!(ply::write(&polygons, &short, &mut Vec::new()).is_err());
}

#[test]
fn a_file_is_replaced_whole_or_not_at_all() {
    let folder = std::env::temp_dir().join(format!("welt-save-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join("chair.obj");
    let mesh = Mesh::from_polygons(&everything()).expect("a mesh");
    io::export(&path, &mesh).expect("a file");
    let before = std::fs::read(&path).expect("the file");
    let imported = io::import(&path, &ImportOptions::default()).expect("a mesh");
    assert_eq!(imported.mesh.to_polygons(), mesh.to_polygons());

    let failed = io::save(&path, |out| {
        std::io::Write::write_all(out, b"half")?;
        Err(std::io::Error::other("the disk is full"))
    });
    let message = failed.expect_err("the writer failed").to_string();
    assert!(message.contains("chair.obj: cannot be written: the disk is full; check"), "{message}");
    assert_eq!(std::fs::read(&path).expect("the file"), before);
    assert_eq!(std::fs::read_dir(&folder).expect("the folder").count(), 1, "the temporary file is gone");

    #[cfg(unix)]
    {
        let link = folder.join("link.obj");
        std::os::unix::fs::symlink(&path, &link).expect("a link");
        io::export(&link, &mesh).expect("a file behind a link");
        assert!(std::fs::symlink_metadata(&link).expect("the link").is_symlink());
        io::save(Path::new("/dev/null"), |out| std::io::Write::write_all(out, b"x"))
            .expect("a device takes it");
        assert!(!std::fs::metadata("/dev/null").expect("the device").is_file());
    }
    let missing = io::export(&folder.join("none/chair.obj"), &mesh).expect_err("no folder").to_string();
    assert!(missing.contains("none does not exist; create it first"), "{missing}");
    let unknown = io::export(&folder.join("chair.stl"), &mesh).expect_err("no format").to_string();
    assert!(unknown.contains("files end with .obj or .ply"), "{unknown}");
    let absent =
        io::import(&folder.join("none.obj"), &ImportOptions::default()).expect_err("no file").to_string();
    assert!(absent.contains("none.obj: cannot be read: "), "{absent}");
    std::fs::remove_dir_all(&folder).expect("the temporary folder");
}

proptest! {
    #[test]
    fn coordinates_are_kept_to_the_bit(values in prop::collection::vec(any::<f64>().prop_filter("in range", |x| x.abs() <= MOST_COORDINATE), 3..30)) {
        let positions: Vec<DVec3> = values.chunks_exact(3).map(DVec3::from_slice).collect();
        let polygons = Polygons { positions, ..Polygons::default() };
        prop_assert_eq!(bits(&read(Format::Obj, &write_obj(&polygons)).polygons.positions), bits(&polygons.positions));
    }
}
