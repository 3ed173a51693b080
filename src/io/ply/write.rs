//! Writes PLY files.

use super::super::number::shortest;
use crate::mesh::Polygons;
use glam::DVec3;
use std::io::{self, Write};

/// How the numbers are stored.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum Encoding {
    /// Binary, little endian.
    #[default]
    BinaryLittleEndian,
    /// Text; numbers are the shortest that read back as the same.
    Ascii,
}

/// What to write besides positions and faces. Each array has one entry per vertex of the polygons.
#[derive(Clone, Copy, Default, Debug)]
pub struct Options<'a> {
    /// Storage of the numbers.
    pub encoding: Encoding,
    /// Unit normals, as `nx ny nz`.
    pub normals: Option<&'a [DVec3]>,
    /// A number per vertex, as `quality`.
    pub quality: Option<&'a [f64]>,
    /// Colours, as `red green blue` in 0 to 255.
    pub colours: Option<&'a [[u8; 3]]>,
}

/// Writes `polygons` with double positions. Groups, materials, texture coordinates and creases have no place in the
/// format.
///
/// # Errors
/// What `out` reports; [`io::ErrorKind::InvalidInput`] when an array does not have one entry per vertex, or when a
/// mesh is too large for the format's 32-bit numbers.
pub fn write(polygons: &Polygons, options: &Options, out: &mut impl Write) -> io::Result<()> {
    check(polygons, options)?;
    let large_faces = polygons.face_sizes.iter().any(|&size| size > u32::from(u8::MAX));
    write_header(polygons, options, large_faces, out)?;
    for (i, position) in polygons.positions.iter().enumerate() {
        let mut line = Line { out, encoding: options.encoding, first: true };
        for vector in [Some(*position), options.normals.map(|all| all[i])].into_iter().flatten() {
            vector.to_array().into_iter().try_for_each(|x| line.float(x))?;
        }
        options.quality.map_or(Ok(()), |all| line.float(all[i]))?;
        for channel in options.colours.map(|all| all[i]).into_iter().flatten() {
            line.integer(channel.into(), &[channel])?;
        }
        line.end()?;
    }
    for face in polygons.faces() {
        let mut line = Line { out, encoding: options.encoding, first: true };
        let size = face.len() as u32;
        if large_faces {
            line.integer(size, &size.to_le_bytes())?;
        } else {
            line.integer(size, &[size as u8])?;
        }
        face.iter().try_for_each(|&vertex| line.integer(vertex, &vertex.to_le_bytes()))?;
        line.end()?;
    }
    Ok(())
}

fn check(polygons: &Polygons, options: &Options) -> io::Result<()> {
    let count = polygons.positions.len();
    let lengths =
        [options.normals.map(<[_]>::len), options.quality.map(<[_]>::len), options.colours.map(<[_]>::len)];
    if lengths.into_iter().flatten().any(|length| length != count) {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "an array does not have one entry per vertex",
        ));
    }
    if i32::try_from(count).is_err() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "more vertices than PLY can number"));
    }
    Ok(())
}

fn write_header(
    polygons: &Polygons,
    options: &Options,
    large_faces: bool,
    out: &mut impl Write,
) -> io::Result<()> {
    let format = match options.encoding {
        Encoding::BinaryLittleEndian => "binary_little_endian",
        Encoding::Ascii => "ascii",
    };
    write!(out, "ply\nformat {format} 1.0\nelement vertex {}\n", polygons.positions.len())?;
    let mut properties = vec!["double x", "double y", "double z"];
    if options.normals.is_some() {
        properties.extend(["double nx", "double ny", "double nz"]);
    }
    if options.quality.is_some() {
        properties.push("double quality");
    }
    if options.colours.is_some() {
        properties.extend(["uchar red", "uchar green", "uchar blue"]);
    }
    properties.iter().try_for_each(|property| writeln!(out, "property {property}"))?;
    let count = if large_faces { "int" } else { "uchar" };
    let faces = polygons.face_sizes.len();
    write!(out, "element face {faces}\nproperty list {count} int vertex_indices\nend_header\n")
}

/// One element on its way out.
struct Line<'a, W> {
    out: &'a mut W,
    encoding: Encoding,
    first: bool,
}

impl<W: Write> Line<'_, W> {
    fn float(&mut self, value: f64) -> io::Result<()> {
        match self.encoding {
            Encoding::BinaryLittleEndian => self.out.write_all(&value.to_le_bytes()),
            Encoding::Ascii => self.text(shortest(value)),
        }
    }

    fn integer(&mut self, value: u32, bytes: &[u8]) -> io::Result<()> {
        match self.encoding {
            Encoding::BinaryLittleEndian => self.out.write_all(bytes),
            Encoding::Ascii => self.text(value),
        }
    }

    fn text(&mut self, value: impl std::fmt::Display) -> io::Result<()> {
        let blank = if std::mem::replace(&mut self.first, false) { "" } else { " " };
        write!(self.out, "{blank}{value}")
    }

    fn end(self) -> io::Result<()> {
        match self.encoding {
            Encoding::BinaryLittleEndian => Ok(()),
            Encoding::Ascii => writeln!(self.out),
        }
    }
}
