//! Writes OBJ files.

use super::super::number::shortest;
use crate::mesh::{BoundaryRule, Creasing, FaceSet, Polygons};
use std::io::{self, Write};

/// Stands for "no texture coordinate" in `face_texcoords`.
const NO_TEXCOORD: u32 = u32::MAX;

/// Writes `polygons`: vertices in their order, also those without a face, and every number as the shortest text that
/// reads back as the same number. A face whose corners do not all have texture coordinates is written without.
/// Creases, corners, holes and options of the scheme become `t` tags as in OpenSubdiv's shapes, counted from 0.
///
/// # Errors
/// What `out` reports.
pub fn write(polygons: &Polygons, out: &mut impl Write) -> io::Result<()> {
    for library in &polygons.material_libraries {
        writeln!(out, "mtllib {}", words(library))?;
    }
    for p in &polygons.positions {
        writeln!(out, "v {} {} {}", shortest(p.x), shortest(p.y), shortest(p.z))?;
    }
    for t in &polygons.texcoords {
        writeln!(out, "vt {} {}", shortest(t.x), shortest(t.y))?;
    }
    write_faces(polygons, out)?;
    for &(a, b, sharpness) in &polygons.creases {
        writeln!(out, "t crease 2/1/0 {a} {b} {sharpness}")?;
    }
    for &(vertex, sharpness) in &polygons.corners {
        writeln!(out, "t corner 1/1/0 {vertex} {sharpness}")?;
    }
    for face in &polygons.holes {
        writeln!(out, "t hole 1/0/0 {face}")?;
    }
    // What is not the default of readers.
    match polygons.subdivision.boundary {
        BoundaryRule::None => writeln!(out, "t interpolateboundary 1/0/0 0")?,
        BoundaryRule::EdgeAndCorner => writeln!(out, "t interpolateboundary 1/0/0 1")?,
        BoundaryRule::EdgeOnly => {}
    }
    if polygons.subdivision.creasing == Creasing::Chaikin {
        writeln!(out, "t creasemethod 0/0/1 chaikin")?;
    }
    Ok(())
}

fn write_faces(polygons: &Polygons, out: &mut impl Write) -> io::Result<()> {
    let no_set = FaceSet::default();
    let mut present = &no_set;
    let mut corner = 0;
    for (face, vertices) in polygons.faces().enumerate() {
        let set = polygons.face_sets.get(face).and_then(|&set| polygons.sets.get(set as usize));
        let set = set.unwrap_or(&no_set);
        write_set(present, set, out)?;
        present = set;
        let texcoords = polygons.face_texcoords.get(corner..corner + vertices.len());
        let texcoords = texcoords.filter(|all| !all.contains(&NO_TEXCOORD));
        corner += vertices.len();
        write!(out, "f")?;
        for (i, &vertex) in vertices.iter().enumerate() {
            write!(out, " {}", u64::from(vertex) + 1)?;
            if let Some(texcoords) = texcoords {
                write!(out, "/{}", u64::from(texcoords[i]) + 1)?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

/// The statements that lead from one set to the next. A keyword without a name ends what it began.
fn write_set(from: &FaceSet, to: &FaceSet, out: &mut impl Write) -> io::Result<()> {
    let mut statement = |keyword: &str, changed: bool, name: String| {
        if !changed {
            return Ok(());
        }
        let blank = if name.is_empty() { "" } else { " " };
        writeln!(out, "{keyword}{blank}{name}")
    };
    let name = |name: &Option<String>| name.as_deref().map(words).unwrap_or_default();
    statement("o", from.object != to.object, name(&to.object))?;
    let groups: Vec<String> = to.groups.iter().map(|group| words(group).replace(' ', "_")).collect();
    statement("g", from.groups != to.groups, groups.join(" "))?;
    statement("usemtl", from.material != to.material, name(&to.material))?;
    statement("s", from.smoothing != to.smoothing, name(&to.smoothing))
}

/// A name as it can stand in a line: without line ends and other control characters, and without what would begin a
/// comment or join the next line.
fn words(name: &str) -> String {
    let mut text: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    if text.starts_with('#') {
        text.replace_range(..1, "_");
    }
    text = text.replace(" #", " _");
    if text.ends_with('\\') {
        text.pop();
        text.push('_');
    }
    text
}
