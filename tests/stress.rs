//! Hostile and odd files: each ends in a clean mesh or in a message that names the place and the remedy.

use crate::common;

use welt::io::{self, Format, IgnoredKind, Import, ImportError, ImportOptions};

fn import(name: &str, bytes: &[u8], options: &ImportOptions) -> Result<Import, ImportError> {
    io::import_bytes(name, Format::Obj, bytes, options)
}

fn repairing() -> ImportOptions {
    ImportOptions { repair: true, ..ImportOptions::default() }
}

/// The message for OBJ text, which must be refused.
fn message(text: &str) -> String {
    import("a.obj", text.as_bytes(), &ImportOptions::default()).expect_err(text).to_string()
}

const MEND: &str = "mend these in the modeller, or import with repair";

/// Files of the collection that are refused, with a part of the message.
const MESSAGES: [(&str, &str); 18] = [
    (
        "gen_bad_index_1e19.obj",
        ":9:9: a face names vertex 10000000000000000000, but the file has only 8 vertices",
    ),
    (
        "gen_bad_index_big.obj",
        ":9:1: corner 4 of the face names vertex 99, but the file has only 8 vertices; correct",
    ),
    ("gen_bad_index_zero.obj", ":9:3: a face names vertex 0, but OBJ files count vertices from 1; correct"),
    ("gen_nan_inf.obj", ":1:3: the coordinate NaN is not a finite number; write 'v x y z'"),
    ("gen_not_a_number.obj", ":1:3: 'a' is not a number; write 'v x y z' with three finite numbers"),
    ("as_number_formats.obj", ":11:14: '3.1+e2' is not a number; write"),
    ("tol_issue-140-zero-face-idx.obj", ":16:3: a face names vertex 0, but"),
    ("gen_one_vertex_face.obj", "line 9: face 0 has 1 vertices; a face needs at least 3"),
    ("gen_two_vertex_face.obj", "line 9: face 0 has 2 vertices; a face needs at least 3"),
    ("tm_notenoughindices.obj", "line 9: face 0 has 2 vertices"),
    (
        "tol_invalid-face-definition.obj",
        "line 15: face 0 has 1 vertices; a face needs at least 3; line 18: face 1 has 2",
    ),
    ("as_box_longline.obj", "face 0 names vertex 0 twice"),
    (
        "gen_long_line_ngon_50000.obj.gz",
        "a face with more than 1024 vertices; split the face, or raise the limit",
    ),
    ("gen_cube_one_flipped.obj", "lines 10, 12: faces 0, 2 run along edge 0-1 in the same direction"),
    ("gen_moebius_quads.obj", "run along edge"),
    ("gen_two_cubes_vertex.obj", "line 9: 2 fans of faces meet in vertex 7 without sharing an edge"),
    ("gc_triple_vierbein.obj", "faces ("),
    ("gc_moebius.obj", "in the same direction"),
];

#[test]
fn every_file_ends_in_a_mesh_or_a_message() {
    let Some(data) = common::shared_data() else { return };
    let mut files: Vec<_> = std::fs::read_dir(data.join("stress"))
        .expect("the folder is readable")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.sort();
    assert_eq!(files.len(), 61);
    let mut refused = Vec::new();
    for path in files {
        let name = path.file_name().and_then(|name| name.to_str()).expect("a plain name");
        match import(name, &common::content(&path), &ImportOptions::default()) {
            Ok(import) => import.mesh.validate_control_mesh().expect(name),
            Err(error) => {
                let text = error.to_string();
                assert!(text.starts_with(&format!("{name}:")), "{text}");
                assert!(text.contains("; "), "no remedy: {text}");
                match error {
                    ImportError::Text { line, column, .. } => assert!(line > 0 && column > 0),
                    ImportError::Defects { defects, .. } => {
                        assert!(text.ends_with(MEND), "{text}");
                        assert!(defects.iter().all(|defect| !defect.lines.is_empty()), "{text}");
                    }
                    other => panic!("{other}"),
                }
                if let Some((_, part)) = MESSAGES.iter().find(|(file, _)| *file == name) {
                    assert!(text.contains(part), "{part}\nis not in\n{text}");
                }
                refused.push(name.to_string());
            }
        }
    }
    // Besides those, the files that the catalogue calls non-manifold.
    let others = ["as_WusonOBJ.obj", "gc_hourglass_ico.obj"];
    let mut expected: Vec<&str> = MESSAGES.iter().map(|m| m.0).chain(others).collect();
    expected.sort_unstable();
    assert_eq!(refused, expected);
}

#[test]
fn repair_makes_a_mesh_of_every_file_that_can_be_understood() {
    let Some(data) = common::shared_data() else { return };
    let mut repaired = 0;
    for folder in ["stress", "osd", "product", "organic", "upholstery"] {
        for entry in std::fs::read_dir(data.join(folder)).expect("the folder is readable") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().and_then(|name| name.to_str()).expect("a plain name");
            if !name.contains(".obj") {
                continue;
            }
            let bytes = common::content(&path);
            let before = import(name, &bytes, &ImportOptions::default());
            let after = import(name, &bytes, &repairing());
            match (before, after) {
                (Ok(before), Ok(after)) => {
                    assert_eq!(before.mesh.to_polygons(), after.mesh.to_polygons(), "{name}");
                    assert!(after.report.repairs.is_empty(), "{name} was changed without need");
                }
                (Err(ImportError::Defects { .. }), Ok(after)) => {
                    after.mesh.validate_control_mesh().expect(name);
                    assert!(!after.report.repairs.is_empty(), "{name} was changed in silence");
                    repaired += 1;
                }
                (Err(ImportError::Text { .. }), Err(ImportError::Text { .. })) => {}
                (_, after) => panic!("{name}: {:?}", after.map(|import| import.report)),
            }
        }
    }
    // 13 non-manifold, 5 inconsistent, 7 with degenerate faces, by the notes of the catalogue.
    assert_eq!(repaired, 25);
}

#[test]
fn messages_name_place_and_remedy() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    for (text, part) in [
        ("v 1 2\n", "a.obj:1:6: a vertex with fewer than three coordinates; write 'v x y z'"),
        ("v 0 0 1e999\n", "a.obj:1:7: the coordinate inf is not a finite number"),
        (
            "v 0 0 0\nf 1 -1 -2\n",
            "a.obj:2:8: a face names vertex -2, but only 1 vertices come before it; correct",
        ),
        (
            "v 0 0 0\nf 1 x 2\n",
            "a.obj:2:5: 'x' is not a corner of a face; write each corner as v, v/vt, v//vn or v/vt/vn",
        ),
        ("v 0 0 0\nf 1/2/3/4 2 3\n", "a.obj:2:3: '1/2/3/4' is not a corner"),
        (
            "\x7fELF\x02 garbage\n",
            "a.obj:1:1: '?ELF?' is no OBJ statement, and the file has none; check that this is an OBJ",
        ),
        ("t crease 2/1/0 0 1 1\n", "a.obj:1:18: a tag names vertex 1, but the file has 0"),
        ("v 0 0 0\nt crease 2/1/0 0\n", "a vertex number is missing"),
        ("v 0 0 0\nt corner 1/1/0 0 -1\n", "a sharpness is missing or not a number of 0 or more"),
        ("v 0 0 0\nt corner 9999999999/1/0 0 1\n", "a vertex number is missing"),
        ("v 0 0 0\nt crease 1/1/0 0 1\n", "a crease needs two vertices or more"),
    ] {
        let found = message(text);
        assert!(found.contains(part), "{part}\nis not in\n{found}");
    }
    assert!(
        message(&format!("{cube}f 1 2 3\nf 1 2 3\n")).contains("lines 4, 5: faces 0, 1 run along edge 0-1")
    );
    let three = message(&format!("{cube}v 0 0 1\nv 0 0 2\nf 1 2 3\nf 2 1 4\nf 1 2 5\n"));
    assert!(
        three.contains("lines 6, 7, 8: edge 0-1 has 3 faces (0, 1, 2); a surface has at most 2"),
        "{three}"
    );
}

#[test]
fn limits_are_checked_while_reading() {
    let limits = io::Limits { max_vertices: 3, max_faces: 1, max_arity: 3, max_valence: 2 };
    let options = ImportOptions { limits, ..ImportOptions::default() };
    let triangle = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    assert!(import("a.obj", triangle.as_bytes(), &options).is_ok());
    let long = format!("g {}\n", "x".repeat(5000));
    for (more, part) in [
        (long.as_str(), "a.obj:5:5003: a name of 5000 bytes; use names of at most 4096 bytes"),
        ("v 0 0 0\n", "a.obj:5:2: more than 3 vertices; raise the limit"),
        ("f 1 2 3\n", "a.obj:5:2: more than 1 faces; raise the limit"),
    ] {
        let text = format!("{triangle}{more}");
        let error = import("a.obj", text.as_bytes(), &options).expect_err(part).to_string();
        assert!(error.contains(part), "{error}");
    }
    let fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 3 4\n";
    let tight = ImportOptions {
        limits: io::Limits { max_valence: 1, ..io::Limits::default() },
        ..ImportOptions::default()
    };
    assert!(import("a.obj", fan.as_bytes(), &ImportOptions::default()).is_ok());
    let error = import("a.obj", fan.as_bytes(), &tight).expect_err("two faces at vertex 0").to_string();
    assert!(
        error.contains("a.obj: 2 faces meet at vertex 0, more than the limit of 1; use fewer"),
        "{error}"
    );
    let error = import("a.obj", b"v 0 0 0\nf 1 1 1 1\n", &options).expect_err("a large face").to_string();
    assert!(error.contains("a.obj:2:9: a face with more than 3 vertices; split the face"), "{error}");
}

#[test]
fn what_is_ignored_is_counted() {
    let text = "vn 0 0 1\nv 0 0 0 0.5 0.5 nan\nv 1 0 0 2\nv 1 1 0 1\nv 0 1 0 1 2\nvt 0 0 0.5\nl 1 2\np 1\np 2\n\
                curv 0 1 1 2\nlod 3\nfoo bar\ng empty\ng full\nf 1/1 2/7 3/0 4/-9\nt vertexedit 1/0/0 0\n\
                t crease 2/1/0 0 2 1\no nothing\n";
    let import = import("a.obj", text.as_bytes(), &ImportOptions::default()).expect("a quad");
    let found: Vec<_> = import.report.ignored.iter().map(|i| (i.kind, i.count, i.first_line)).collect();
    let mut expected = vec![
        (IgnoredKind::Normals, 1, 1),
        (IgnoredKind::VertexColours, 1, 2),
        (IgnoredKind::VertexWeights, 1, 3),
        (IgnoredKind::ExtraNumbers, 1, 5),
        (IgnoredKind::ThirdTextureCoordinate, 1, 6),
        (IgnoredKind::Lines, 1, 7),
        (IgnoredKind::Points, 2, 8),
        (IgnoredKind::FreeFormGeometry, 1, 10),
        (IgnoredKind::DisplaySettings, 1, 11),
        (IgnoredKind::UnknownKeywords, 1, 12),
        (IgnoredKind::NamesWithoutFaces, 2, 13),
        (IgnoredKind::MissingTextureCoordinate, 3, 15),
        (IgnoredKind::PartialTextureCoordinates, 1, 15),
        (IgnoredKind::UnusedTextureCoordinates, 1, 6),
        (IgnoredKind::Tags, 1, 16),
        (IgnoredKind::CreasesWithoutEdge, 1, 17),
    ];
    expected.sort_unstable_by_key(|entry| entry.0);
    let mut sorted = found;
    sorted.sort_unstable_by_key(|entry| entry.0);
    assert_eq!(sorted, expected);
}
