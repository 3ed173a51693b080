//! What repair and welding do to small shapes whose right answer is known, and what the report says.

use welt::io::{self, Format, Import, ImportError, ImportOptions, Inspection, Repair};
use welt::mesh::VertexId;

const CUBE: &str = "v 0 0 0\nv 0 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nv 1 1 0\nv 1 1 1\n\
    f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";

fn import(text: &str, options: &ImportOptions) -> (Import, Inspection) {
    let source = io::read_bytes("a.obj", Format::Obj, text.as_bytes(), options).expect("readable");
    let inspection = io::inspect(&source);
    (source.build().expect("a mesh"), inspection)
}

fn repaired(text: &str) -> (Import, Inspection) {
    import(text, &ImportOptions { repair: true, ..ImportOptions::default() })
}

fn welded(text: &str, distance: f64) -> (Import, Inspection) {
    import(text, &ImportOptions { weld: Some(distance), ..ImportOptions::default() })
}

#[test]
fn one_flipped_face_is_turned_back() {
    let (import, inspection) = repaired(&CUBE.replace("f 3 4 8 7", "f 7 8 4 3"));
    assert_eq!(import.report.repairs, [Repair::FaceFlipped { face: 3 }]);
    assert_eq!(inspection.components[0].volume, Some(1.0));
    // The first vertex stays the first.
    assert_eq!(import.mesh.to_polygons().face_vertices[12..16], [6, 2, 3, 7]);
}

#[test]
fn faces_that_enclose_nothing_go() {
    let (import, inspection) =
        repaired(&format!("f\n{CUBE}f 1 1 2\nf 1 2 3 2\nf 5 5 7 7 3 1 1\n").replace("f 1 3 7 5\n", ""));
    assert_eq!(
        import.report.repairs,
        [
            Repair::FaceRemoved { face: 0 },
            Repair::FaceRemoved { face: 6 },
            Repair::FaceRemoved { face: 7 },
            Repair::RepetitionRemoved { face: 8, vertex: 0 },
            Repair::RepetitionRemoved { face: 8, vertex: 4 },
            Repair::RepetitionRemoved { face: 8, vertex: 6 },
            Repair::FaceFlipped { face: 8 },
        ]
    );
    assert_eq!((inspection.faces, inspection.genus, inspection.boundaries.len()), (6, Some(0), 0));
}

#[test]
fn a_fin_comes_off_and_the_cube_stays_closed() {
    let text = format!("{CUBE}v -1 0 0\nv -1 0 1\nf 1 2 10 9\nt crease 2/1/0 0 1 2.5\nt corner 1/1/0 1 3\n");
    let (import, inspection) = repaired(&text);
    assert_eq!(
        import.report.repairs,
        [
            Repair::EdgeCut { edge: (0, 1), faces: vec![0, 2, 6] },
            Repair::VertexSplit { vertex: 0, copies: vec![10] },
            Repair::VertexSplit { vertex: 1, copies: vec![11] },
        ]
    );
    let components: Vec<_> =
        inspection.components.iter().map(|c| (c.faces, c.boundaries, c.volume)).collect();
    assert_eq!(components, [(6, 0, Some(1.0)), (1, 1, None)]);
    // The copies carry position and sharpness.
    let polygons = import.mesh.to_polygons();
    assert_eq!(polygons.positions[10..], polygons.positions[..2]);
    assert_eq!(polygons.corners, [(1, 3.0), (11, 3.0)]);
    for (a, b) in [(0, 1), (10, 11)] {
        let edge = import.mesh.find_half_edge(VertexId(a), VertexId(b)).expect("an edge");
        assert_eq!(import.mesh.edge_sharpness(edge), 2.5);
    }
}

#[test]
fn fans_that_meet_in_a_vertex_get_one_each() {
    let (import, inspection) = repaired("v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\n");
    assert_eq!(import.report.repairs, [Repair::VertexSplit { vertex: 0, copies: vec![5] }]);
    assert_eq!((inspection.vertices, inspection.components.len()), (6, 2));
}

#[test]
fn a_moebius_strip_is_cut_once_across() {
    // Twelve quads round a strip whose ends meet upside down; its cut open form is a strip with one boundary.
    let count = 12;
    let mut text = String::new();
    for i in 0..count {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        for side in [-0.2, 0.2] {
            let radius = 1.0 + side * (angle / 2.0).cos();
            text += &format!(
                "v {} {} {}\n",
                radius * angle.cos(),
                radius * angle.sin(),
                side * (angle / 2.0).sin()
            );
        }
    }
    for i in 0..count {
        let (a, b) = (2 * i + 1, 2 * i + 2);
        let (c, d) = if i + 1 == count { (2, 1) } else { (a + 2, b + 2) };
        text += &format!("f {a} {c} {d} {b}\n");
    }
    let (import, inspection) = repaired(&text);
    let cuts = import
        .report
        .repairs
        .iter()
        .filter(|repair| matches!(repair, Repair::OneSidedEdgeCut { .. }))
        .count();
    assert_eq!(cuts, 1);
    assert_eq!((inspection.vertices, inspection.boundaries.len(), inspection.genus), (26, 1, Some(0)));
}

#[test]
fn welding_closes_seams_and_says_what_is_gone() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 1e-4 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4\nf 5 6 7 8\n\
                t crease 2/1/0 4 7 1\n";
    let source =
        io::read_bytes("a.obj", Format::Obj, text.as_bytes(), &ImportOptions::default()).expect("readable");
    assert_eq!(io::inspect(&source).seams, [(7, 2)]);
    let (import, inspection) = welded(text, 1e-3);
    assert_eq!(
        import.report.repairs,
        [Repair::VertexWelded { vertex: 4, into: 1 }, Repair::VertexWelded { vertex: 7, into: 2 }]
    );
    assert_eq!(import.mesh.to_polygons().face_vertices, [0, 1, 2, 3, 1, 4, 5, 2]);
    assert_eq!(import.mesh.to_polygons().creases, [(1, 2, 1.0)]);
    assert_eq!((inspection.boundaries.len(), inspection.boundaries[0].edges), (1, 6));
    // Nothing within reach: nothing happens. Everything within reach: the faces collapse.
    assert!(welded(CUBE, 0.5).0.report.repairs.is_empty());
    let (collapsed, _) = welded(CUBE, 9.0);
    assert_eq!((collapsed.mesh.vertex_bound(), collapsed.mesh.face_bound()), (1, 0));
    assert_eq!(collapsed.report.repairs.len(), 7 + 6);
}

#[test]
fn an_unusable_welding_distance_is_refused() {
    for distance in [-1.0, f64::NAN, f64::INFINITY] {
        let options = ImportOptions { weld: Some(distance), ..ImportOptions::default() };
        let error = io::import_bytes("a.obj", Format::Obj, CUBE.as_bytes(), &options).expect_err("refused");
        assert!(matches!(error, ImportError::WeldDistance { .. }));
        assert!(error.to_string().contains("give a finite number that is 0 or larger"));
    }
}

#[test]
fn an_inside_out_cube_is_seen() {
    let reversed: String = CUBE
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(corners) => format!("f {}\n", corners.split(' ').rev().collect::<Vec<_>>().join(" ")),
            None => format!("{line}\n"),
        })
        .collect();
    let (_, inspection) = import(&reversed, &ImportOptions::default());
    assert_eq!((inspection.inside_out.as_slice(), inspection.components[0].volume), (&[0][..], Some(-1.0)));
    assert_eq!(inspection.bounding_box, Some([[0.0; 3], [1.0; 3]]));
    assert!(inspection.to_string().contains("inside-out components: 1 (0)"), "{inspection}");
}

#[test]
fn defects_of_all_kinds_are_listed_together() {
    let text = format!("{CUBE}f 1 2\nf 1 2 5\n");
    let source =
        io::read_bytes("a.obj", Format::Obj, text.as_bytes(), &ImportOptions::default()).expect("readable");
    let inspection = io::inspect(&source);
    let found: Vec<String> = inspection.defects.iter().map(ToString::to_string).collect();
    assert_eq!(found[0], "line 15: face 6 has 2 vertices; a face needs at least 3");
    assert!(
        found.iter().any(|defect| defect.starts_with("lines 9, 11, 16: edge 0-1 has 3 faces (0, 2, 7)")),
        "{found:?}"
    );
    assert!(!inspection.is_clean() && inspection.genus.is_none());
    let json = serde_json::to_string(&inspection).expect("json");
    assert!(json.contains(r#"{"kind":"too-few-vertices","face":6,"size":2,"lines":[15]}"#), "{json}");
}

#[test]
fn ply_messages_name_the_element() {
    let header = |storage: &str, faces: &str| {
        format!(
            "ply\nformat {storage} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n{faces}"
        )
    };
    let read = |text: &str, tail: &[u8]| {
        let bytes = [text.as_bytes(), tail].concat();
        io::import_bytes("a.ply", Format::Ply, &bytes, &ImportOptions::default())
            .map(|_| ())
            .map_err(|e| e.to_string())
    };
    let points = "0 0 0\n1 0 0\n1 1 0\n";
    assert_eq!(read(&header("ascii", &format!("{points}3 0 1 2\n")), b""), Ok(()));
    for (body, part) in [
        (
            format!("{points}3 0 1 7\n"),
            "a.ply:13:1: face 0 names vertex 7, but the file has only 3 vertices; correct",
        ),
        (
            format!("{points}3 0 1 -1\n"),
            "a.ply:13:7: face 0: -1 is not an index; check that the file is whole",
        ),
        (format!("{points}3 0 1"), "face 0: the file ends too early; check"),
        ("0 0 0\n1 x 0\n".to_string(), "a.ply:11:3: vertex 1: 'x' is not a number; check"),
        ("0 0 nan\n".to_string(), "a.ply:10:5: vertex 0: the coordinate NaN is not a finite number; check"),
        (format!("{points}2 0 1\n"), "a.ply: line 13: face 0 has 2 vertices; a face needs at least 3; mend"),
    ] {
        let error = read(&header("ascii", &body), b"").expect_err(part);
        assert!(error.contains(part), "{part}\nis not in\n{error}");
    }
    let mut binary: Vec<u8> = (0..9u16).flat_map(|i| f32::from(i * i).to_be_bytes()).collect();
    binary.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
    assert_eq!(read(&header("binary_big_endian", ""), &binary), Ok(()));
    let error = read(&header("binary_big_endian", ""), &binary[..binary.len() - 1]).expect_err("too short");
    assert_eq!(
        error,
        "a.ply: face 0: the file ends too early; check that the file is whole, or export it again"
    );
    for (text, part) in [
        ("", "a.ply:1:1: the file does not begin with 'ply'"),
        ("ply\nformat ascii 1.0\n", "the header has no 'end_header'"),
        ("ply\nformat rar 1.0\n", "a.ply:2:11: 'rar' is no format of PLY"),
        ("ply\nformat ascii 1.0\nend_header\n", "the file has no vertices"),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
            "a.ply:3:1: the vertices have no x, y and z",
        ),
    ] {
        let error = read(text, b"").expect_err(part);
        assert!(error.contains(part), "{part}\nis not in\n{error}");
    }
}

#[test]
fn holes_keep_to_their_faces() {
    // Face 0 has no area and goes; the hole, face 2, becomes face 1.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 2\nf 1 2 3\nf 1 3 4\nt hole 1/0/0 2\n";
    let options = welt::io::ImportOptions { repair: true, ..Default::default() };
    let import =
        welt::io::import_bytes("a.obj", welt::io::Format::Obj, text.as_bytes(), &options).expect("a mesh");
    assert_eq!(import.mesh.to_polygons().holes, [1]);
    let text = text.replace("1/0/0 2", "1/0/0 3");
    let error = welt::io::import_bytes("a.obj", welt::io::Format::Obj, text.as_bytes(), &options)
        .expect_err("no face 3");
    assert!(error.to_string().contains("a.obj:8:14: a tag names face 3, but the file has 3"), "{error}");
}
