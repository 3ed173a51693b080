//! Arbitrary and damaged files never panic, and what is accepted is a mesh.

use proptest::prelude::*;
use welt::io::{self, Format, ImportOptions, Limits};

/// A file with one of everything.
const OBJ: &str = "mtllib a.mtl\no chair\ng seat left\nusemtl leather\ns 1\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\n\
    v 0 1 0 2\nv 0.5 .5 1e0\nvt 0 0\nvt 1 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3//1 \\\n 4\nf -1 1 4\nf 5 3 2\nl 1 2\np 1\n\
    t crease 2/1/0 0 1 2.5\nt corner 1/1/0 4 10\nt hole 1/0/0 0\ng back\nf 2 1 5\nf 4 3 5\n";

const PLY: &str = "ply\nformat ascii 1.0\ncomment a\nelement vertex 4\nproperty float x\nproperty double y\n\
    property int z\nproperty uchar red\nelement edge 1\nproperty list char short e\nelement face 2\n\
    property list uchar uint vertex_indices\nproperty float quality\nend_header\n\
    0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n2 0 1\n3 0 1 2 0.5\n3 0 2 3 0.25\n";

fn options() -> impl Strategy<Value = ImportOptions> {
    (any::<bool>(), prop::option::of(prop::sample::select(vec![0.0, 1e-9, 0.3, 1e300, -1.0, f64::NAN])))
        .prop_map(|(repair, weld)| ImportOptions { repair, weld, limits: Limits::default() })
}

/// Reads in every way; what becomes a mesh must be one, and a repaired file that was understood must become one.
fn feed(format: Format, bytes: &[u8], options: &ImportOptions) {
    let Ok(source) = io::read_bytes("soup", format, bytes, options) else { return };
    let inspection = io::inspect(&source);
    assert!(!inspection.to_string().is_empty());
    let report = source.report.to_string();
    match source.build() {
        Ok(import) => {
            import.mesh.validate_control_mesh().expect("an accepted mesh is valid");
            assert!(inspection.is_clean());
        }
        Err(error) => {
            assert!(!inspection.is_clean());
            assert!(!options.repair, "repair left {error}\n{report}");
        }
    }
}

/// Replaces, inserts and removes bytes at places given as fractions of the length.
fn damage(text: &str, edits: &[(f64, u8, u8)]) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for &(place, kind, byte) in edits {
        let at = (place * bytes.len() as f64) as usize;
        match kind {
            0 if at < bytes.len() => bytes[at] = byte,
            1 if at < bytes.len() => {
                bytes.remove(at);
            }
            2 => bytes.truncate(at),
            _ => bytes.insert(at, byte),
        }
    }
    bytes
}

fn edits() -> impl Strategy<Value = Vec<(f64, u8, u8)>> {
    let likely = prop::sample::select(b"0123456789 -./\n\r\t\\#eftvnpl\0\xff".to_vec());
    prop::collection::vec((0.0..1.0f64, prop::sample::select(vec![0u8, 0, 0, 0, 1, 2, 3, 3]), likely), 1..6)
}

fn faces() -> impl Strategy<Value = Vec<Vec<u32>>> {
    prop::collection::vec(prop::collection::vec(1u32..9, 0..6), 0..14)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn byte_soup(bytes in prop::collection::vec(any::<u8>(), 0..200), options in options()) {
        feed(Format::Obj, &bytes, &options);
        feed(Format::Ply, &bytes, &options);
    }

    #[test]
    fn damaged_obj(edits in edits(), options in options()) {
        feed(Format::Obj, &damage(OBJ, &edits), &options);
    }

    #[test]
    fn damaged_ply(edits in edits(), options in options()) {
        feed(Format::Ply, &damage(PLY, &edits), &options);
    }

    #[test]
    fn damaged_binary_ply(edits in edits(), tail in prop::collection::vec(any::<u8>(), 0..120), options in options()) {
        let text = PLY.replace("ascii", "binary_big_endian");
        let header = text.split_inclusive("end_header\n").next().unwrap_or_default();
        let mut bytes = damage(header, &edits);
        bytes.extend(tail);
        feed(Format::Ply, &bytes, &options);
    }

    /// Any faces over eight vertices: degenerate, doubled, one-sided, with many at an edge.
    #[test]
    fn any_faces_can_be_repaired(faces in faces(), options in options()) {
        let mut text: String = (0..8).map(|i| format!("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2)).collect();
        for face in faces {
            text += "f";
            face.iter().for_each(|vertex| text += &format!(" {vertex}"));
            text += "\n";
        }
        text += "t crease 2/1/0 0 1 1\nt corner 1/1/0 2 1\n";
        feed(Format::Obj, text.as_bytes(), &options);
    }
}

#[test]
fn a_header_cannot_make_the_reader_reserve_or_loop() {
    for (count, properties) in
        [("1000000", "property float x\nproperty float y\nproperty float z\n"), ("99999999999999999999", "")]
    {
        let text =
            format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{properties}end_header\n");
        assert!(io::read_bytes("a.ply", Format::Ply, text.as_bytes(), &ImportOptions::default()).is_err());
    }
    let text = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n\
                element other 18446744073709551615\nend_header\n";
    let source = io::read_bytes("a.ply", Format::Ply, text.as_bytes(), &ImportOptions::default());
    assert_eq!(source.map(|source| source.polygons.positions.len()).ok(), Some(0));
}
