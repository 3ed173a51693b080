//! Reads the positions and faces of a PLY file.

use super::body::Body;
use super::header::{self, Element, Header, Property, Storage};
use crate::io::Limits;
use crate::io::error::ImportError;
use crate::io::report::{IgnoredKind, ImportReport};
use crate::io::source::{Lines, Source};
use crate::io::text::{Cursor, Fault, Place};
use crate::memory::{self, OutOfMemory};
use crate::mesh::{MOST_COORDINATE, Polygons};
use glam::DVec3;

const REMEDY: &str = "check that the file is whole, or export it again";

/// Reads a whole file. `name` is used in messages.
pub(in crate::io) fn read(name: &str, bytes: &[u8], limits: &Limits) -> Result<Source, ImportError> {
    let mut text = Cursor::new(bytes);
    let header = header::read(&mut text).map_err(|fault| fault.into_error(name))?;
    let mut reader = Reader {
        name,
        limits,
        body: Body::new(header.storage, text, bytes),
        polygons: Polygons::default(),
        report: ImportReport::default(),
        lines: Lines::default(),
        found: [false; 2],
    };
    reader.elements(&header)?;
    Ok(Source::new(name, reader.polygons, reader.report, reader.lines))
}

struct Reader<'a> {
    name: &'a str,
    limits: &'a Limits,
    body: Body<'a>,
    polygons: Polygons,
    report: ImportReport,
    lines: Lines,
    /// Whether vertices and faces were read: a file may have each once.
    found: [bool; 2],
}

impl Reader<'_> {
    fn elements(&mut self, header: &Header) -> Result<(), ImportError> {
        for element in &header.elements {
            match element.name.as_str() {
                "vertex" if !std::mem::replace(&mut self.found[0], true) => self.vertices(element)?,
                "face" if !std::mem::replace(&mut self.found[1], true) => self.faces(element)?,
                _ => self.skip(element)?,
            }
        }
        if !self.found[0] {
            let place = Place { line: 1, column: 1 };
            return Err(self.text_error(place, "the file has no vertices".into(), REMEDY));
        }
        self.check_range(header.storage)
    }

    fn vertices(&mut self, element: &Element) -> Result<(), ImportError> {
        let axes = ["x", "y", "z"]
            .map(|axis| element.properties.iter().position(|p| p.count.is_none() && p.name == axis));
        let [Some(x), Some(y), Some(z)] = axes else {
            return Err(self.text_error(element.place, "the vertices have no x, y and z".into(), REMEDY));
        };
        self.check_count(element, self.limits.max_vertices)?;
        self.note_ignored(element, &[x, y, z]);
        for number in 0..element.count {
            let line = self.line();
            let mut position = DVec3::ZERO;
            for (i, property) in element.properties.iter().enumerate() {
                let Some(axis) = [x, y, z].iter().position(|&p| p == i) else {
                    self.skip_property(element, number, property)?;
                    continue;
                };
                let place = self.place();
                position[axis] = match self.body.scalar(property.scalar) {
                    Ok(value) if value.abs() <= MOST_COORDINATE => value,
                    Ok(value) => {
                        let message = if value.is_finite() {
                            format!("the coordinate {value:e} is out of range, -1e50 to 1e50")
                        } else {
                            format!("the coordinate {value} is not a finite number")
                        };
                        return Err(self.error(element, number, place, message));
                    }
                    Err(message) => return Err(self.error(element, number, place, message)),
                };
            }
            self.room(|reader| {
                memory::reserve(&mut reader.polygons.positions, 1)?;
                memory::reserve(&mut reader.lines.vertices, 1)
            })?;
            self.polygons.positions.push(position);
            self.lines.vertices.extend(line);
        }
        Ok(())
    }

    fn faces(&mut self, element: &Element) -> Result<(), ImportError> {
        let indices = element
            .properties
            .iter()
            .position(|p| p.count.is_some() && matches!(p.name.as_str(), "vertex_indices" | "vertex_index"));
        let Some(indices) = indices else {
            return Err(self.text_error(
                element.place,
                "the faces have no list vertex_indices".into(),
                REMEDY,
            ));
        };
        self.check_count(element, self.limits.max_faces)?;
        self.note_ignored(element, &[indices]);
        for number in 0..element.count {
            let line = self.line();
            for (i, property) in element.properties.iter().enumerate() {
                let (true, Some(count)) = (i == indices, property.count) else {
                    self.skip_property(element, number, property)?;
                    continue;
                };
                let place = self.place();
                let size = self.body.index(count).map_err(|m| self.error(element, number, place, m))?;
                if u64::from(size) > self.limits.max_arity {
                    let message =
                        format!("{size} vertices are more than the limit of {}", self.limits.max_arity);
                    return Err(self.error(element, number, place, message));
                }
                self.room(|reader| {
                    // What the file promises is not asked for at once.
                    memory::reserve(&mut reader.polygons.face_sizes, 1)?;
                    memory::reserve(&mut reader.lines.faces, 1)
                })?;
                for _ in 0..size {
                    self.room(|reader| memory::reserve(&mut reader.polygons.face_vertices, 1))?;
                    let place = self.place();
                    let vertex = self.body.index(property.scalar);
                    self.polygons
                        .face_vertices
                        .push(vertex.map_err(|m| self.error(element, number, place, m))?);
                }
                self.polygons.face_sizes.push(size);
            }
            self.lines.faces.extend(line);
        }
        Ok(())
    }

    /// Makes room in lists.
    #[inline]
    fn room(
        &mut self,
        reserve: impl FnOnce(&mut Self) -> Result<(), OutOfMemory>,
    ) -> Result<(), ImportError> {
        reserve(self).map_err(|source| ImportError::Memory { file: self.name.into(), source })
    }

    /// Reads past an element that a mesh has no use for.
    fn skip(&mut self, element: &Element) -> Result<(), ImportError> {
        let line = element.place.line;
        self.report.ignore(IgnoredKind::PlyElements, line, || element.name.clone());
        if element.properties.is_empty() {
            return Ok(());
        }
        for number in 0..element.count {
            for property in &element.properties {
                self.skip_property(element, number, property)?;
            }
        }
        Ok(())
    }

    fn skip_property(
        &mut self,
        element: &Element,
        number: u64,
        property: &Property,
    ) -> Result<(), ImportError> {
        let place = self.place();
        let mut skipped = || {
            let count = match property.count {
                Some(kind) => self.body.index(kind)?,
                None => 1,
            };
            (0..count).try_for_each(|_| self.body.scalar(property.scalar).map(drop))
        };
        skipped().map_err(|message| self.error(element, number, place, message))
    }

    /// Every element takes at least a byte: a file cannot hold more of them than bytes.
    fn check_count(&self, element: &Element, limit: u64) -> Result<(), ImportError> {
        let Element { name, count, place, .. } = element;
        if *count > limit {
            let message = format!("{count} elements '{name}' are more than the limit of {limit}");
            return Err(self.text_error(
                *place,
                message,
                "raise the limit if the file is meant to be this large",
            ));
        }
        if *count > self.body.remaining() as u64 {
            let message =
                format!("the header promises {count} elements '{name}', but the file ends too early");
            return Err(self.text_error(*place, message, REMEDY));
        }
        Ok(())
    }

    fn note_ignored(&mut self, element: &Element, used: &[usize]) {
        for (i, property) in element.properties.iter().enumerate() {
            if !used.contains(&i) {
                let example = || format!("{} {}", element.name, property.name);
                self.report.ignore(IgnoredKind::PlyProperties, property.line, example);
            }
        }
    }

    /// Faces may come before the vertices, so that this is known only at the end.
    fn check_range(&self, storage: Storage) -> Result<(), ImportError> {
        let count = self.polygons.positions.len();
        for (face, vertices) in self.polygons.faces().enumerate() {
            let Some(vertex) = vertices.iter().find(|&&vertex| vertex as usize >= count) else { continue };
            let message = format!("names vertex {vertex}, but the file has only {count} vertices");
            let remedy = "correct the number or add the missing vertex";
            return Err(match (storage, self.lines.faces.get(face)) {
                (Storage::Ascii, Some(&line)) => {
                    self.text_error(Place { line, column: 1 }, format!("face {face} {message}"), remedy)
                }
                _ => self.binary_error(format!("face {face}"), message, remedy),
            });
        }
        Ok(())
    }

    /// Place of the next number, in a text file.
    fn place(&mut self) -> Option<Place> {
        self.body.seek();
        self.body.place()
    }

    fn line(&mut self) -> Option<u32> {
        self.place().map(|place| place.line)
    }

    fn error(&self, element: &Element, number: u64, place: Option<Place>, message: String) -> ImportError {
        let element = format!("{} {number}", element.name);
        match place {
            Some(place) => self.text_error(place, format!("{element}: {message}"), REMEDY),
            None => self.binary_error(element, message, REMEDY),
        }
    }

    fn text_error(&self, place: Place, message: String, remedy: &'static str) -> ImportError {
        Fault { place, message, remedy, memory: None }.into_error(self.name)
    }

    fn binary_error(&self, element: String, message: String, remedy: &'static str) -> ImportError {
        ImportError::Binary { file: self.name.into(), element, message, remedy }
    }
}
