//! `f` statements, and what can be said about them only at the end of the file.

use super::read::{RANGE_REMEDY, Reader, Result, fault_at};
use crate::io::report::{Ignored, IgnoredKind};
use crate::io::text::{Fault, Place, shown};
use crate::memory;

/// Stands for "no texture coordinate" in `face_texcoords`.
const NO_TEXCOORD: u32 = u32::MAX;

/// One `v/vt/vn` of a face.
struct Corner {
    vertex: u32,
    texcoord: u32,
}

impl Reader<'_> {
    pub(super) fn face(&mut self, line: u32) -> Result<()> {
        self.understood = true;
        if self.polygons.face_sizes.len() as u64 >= self.limits.max_faces {
            let message = format!("more than {} faces", self.limits.max_faces);
            return Err(
                self.fault(message, "raise the limit for faces if the file is meant to be this large")
            );
        }
        let mut size: u32 = 0;
        while self.text.next_token_on_line() {
            if u64::from(size) >= self.limits.max_arity {
                let message = format!("a face with more than {} vertices", self.limits.max_arity);
                return Err(self.fault(message, "split the face, or raise the limit for face sizes"));
            }
            let corner = self.corner(line)?;
            if corner.texcoord != NO_TEXCOORD && self.polygons.face_texcoords.is_empty() {
                // The first texture coordinate of all: the corners before it have none.
                let before = self.polygons.face_vertices.len();
                memory::reserve(&mut self.polygons.face_texcoords, before)?;
                self.polygons.face_texcoords.resize(before, NO_TEXCOORD);
            }
            if corner.texcoord != NO_TEXCOORD || !self.polygons.face_texcoords.is_empty() {
                memory::reserve(&mut self.polygons.face_texcoords, 1)?;
                self.polygons.face_texcoords.push(corner.texcoord);
            }
            memory::reserve(&mut self.polygons.face_vertices, 1)?;
            self.polygons.face_vertices.push(corner.vertex);
            self.largest_vertex = self.largest_vertex.max(Some(corner.vertex));
            size += 1;
        }
        memory::reserve(&mut self.polygons.face_sizes, 1)?;
        memory::reserve(&mut self.lines.faces, 1)?;
        memory::reserve(&mut self.polygons.face_sets, 1)?;
        self.polygons.face_sizes.push(size);
        self.lines.faces.push(line);
        let set = self.sets.index(&mut self.polygons);
        self.polygons.face_sets.push(set);
        if self.sets.are_too_large() {
            return Err(
                self.fault("the names of groups and materials take too much memory", "use shorter names")
            );
        }
        Ok(())
    }

    fn corner(&mut self, line: u32) -> Result<Corner> {
        let place = self.text.place();
        let start = self.text.offset();
        let vertex = self.text.integer();
        let (mut texcoord, mut well_formed) = (None, vertex.is_some());
        // The numbers of texture coordinate and normal are optional, and so are the slashes.
        for part in 0..2 {
            if self.text.peek() != Some(b'/') {
                break;
            }
            self.text.advance();
            let number = self.text.integer();
            if part == 0 {
                texcoord = number;
            }
        }
        well_formed &= self.text.is_token_end();
        if !well_formed {
            self.text.token();
            let token = shown(self.text.since(start));
            let remedy = "write each corner as v, v/vt, v//vn or v/vt/vn";
            return Err(fault_at(place, format!("'{token}' is not a corner of a face"), remedy));
        }
        let vertex = self.vertex_index(vertex.unwrap_or(0), place, start)?;
        Ok(Corner {
            vertex,
            texcoord: texcoord.map_or(NO_TEXCOORD, |number| self.texcoord_index(number, line)),
        })
    }

    /// The 0-based index of a vertex number: from 1, or from -1 backwards. Whether a positive one exists is known
    /// only at the end of the file.
    fn vertex_index(&self, number: i64, place: Place, start: usize) -> Result<u32> {
        let count = self.polygons.positions.len() as i64;
        let index = if number > 0 { number - 1 } else { count + number };
        if number != 0 && index >= 0 && (index as u64) < self.limits.max_vertices {
            return u32::try_from(index)
                .map_err(|_| fault_at(place, "a vertex number beyond 2^32", RANGE_REMEDY));
        }
        let text = shown(self.text.since(start));
        let number = text.split('/').next().unwrap_or_default();
        let message = match index {
            _ if number.trim_start_matches(['-', '+']).bytes().all(|digit| digit == b'0') => {
                "a face names vertex 0, but OBJ files count vertices from 1".to_string()
            }
            ..0 => format!("a face names vertex {number}, but only {count} vertices come before it"),
            _ => format!("a face names vertex {number}, but the file has only {count} vertices up to here"),
        };
        Err(fault_at(place, message, RANGE_REMEDY))
    }

    /// The 0-based index of a texture coordinate number, `NO_TEXCOORD` when it cannot exist.
    fn texcoord_index(&mut self, number: i64, line: u32) -> u32 {
        let count = self.polygons.texcoords.len() as i64;
        let index = if number > 0 { number - 1 } else { count + number };
        match u32::try_from(index) {
            Ok(index) if number != 0 && index < NO_TEXCOORD => index,
            _ => {
                self.report.ignore(IgnoredKind::MissingTextureCoordinate, line, || number.to_string());
                NO_TEXCOORD
            }
        }
    }

    pub(super) fn first_out_of_range(&self) -> Box<Fault> {
        let count = self.polygons.positions.len();
        for (face, &line) in self.polygons.faces().zip(&self.lines.faces) {
            if let Some(corner) = face.iter().position(|&vertex| vertex as usize >= count) {
                let number = u64::from(face[corner]) + 1;
                let message = format!(
                    "corner {} of the face names vertex {number}, but the file has only {count} vertices",
                    corner + 1
                );
                return fault_at(Place { line, column: 1 }, message, RANGE_REMEDY);
            }
        }
        self.fault("a face names a vertex that does not exist", RANGE_REMEDY)
    }

    /// Corners may name texture coordinates that come later in the file, but not ones that never come. A face keeps
    /// its texture coordinates only when every corner has one.
    pub(super) fn settle_texcoords(&mut self) {
        let count = self.polygons.texcoords.len();
        let mut start = 0;
        for (&size, &line) in self.polygons.face_sizes.iter().zip(&self.lines.faces) {
            let end = start + size as usize;
            let corners = self.polygons.face_texcoords.get_mut(start..end).unwrap_or_default();
            start = end;
            for texcoord in corners.iter_mut().filter(|t| **t != NO_TEXCOORD && **t as usize >= count) {
                let number = u64::from(*texcoord) + 1;
                self.report.ignore(IgnoredKind::MissingTextureCoordinate, line, || number.to_string());
                *texcoord = NO_TEXCOORD;
            }
            let missing = corners.iter().filter(|&&texcoord| texcoord == NO_TEXCOORD).count();
            if missing > 0 && missing < corners.len() {
                self.report.ignore(IgnoredKind::PartialTextureCoordinates, line, || "f".into());
                corners.fill(NO_TEXCOORD);
            }
        }
        if self.polygons.face_texcoords.iter().all(|&texcoord| texcoord == NO_TEXCOORD) {
            self.polygons.face_texcoords.clear();
            self.polygons.texcoords.clear();
            if let Some(first_line) = self.first_texcoord_line {
                let kind = IgnoredKind::UnusedTextureCoordinates;
                self.report.ignore_all(Ignored {
                    kind,
                    count: count as u64,
                    first_line,
                    example: "vt".into(),
                });
            }
        }
    }
}
