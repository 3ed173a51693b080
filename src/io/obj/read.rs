//! Reads OBJ files statement by statement, in one pass over the bytes.

use super::sets::{SetStatement, Sets};
use crate::io::Limits;
use crate::io::error::ImportError;
use crate::io::report::{IgnoredKind, ImportReport};
use crate::io::source::{Lines, Source};
use crate::io::text::{Cursor, Fault, Place, shown};
use crate::memory;
use crate::mesh::{MOST_COORDINATE, Polygons};
use glam::{DVec2, DVec3};
use rustc_hash::FxHashSet;

pub(super) type Result<T> = std::result::Result<T, Box<Fault>>;

/// Bytes of a file per vertex or face, from below for usual files: what is reserved in advance.
const BYTES_PER_ELEMENT: usize = 48;

/// Longest name of a group, object, material, smoothing group or library, in bytes.
const LONGEST_NAME: usize = 4096;

/// Reads a whole file. `name` is used in messages.
pub(in crate::io) fn read(
    name: &str,
    bytes: &[u8],
    limits: &Limits,
) -> std::result::Result<Source, ImportError> {
    let mut reader = Reader::new(bytes, limits);
    let read = reader.reserve(bytes.len() / BYTES_PER_ELEMENT).and_then(|()| reader.statements());
    match read.and_then(|()| reader.finish()) {
        Ok(()) => Ok(Source::new(name, reader.polygons, reader.report, reader.lines)),
        Err(fault) => Err(fault.into_error(name)),
    }
}

pub(super) struct Reader<'a> {
    pub(super) text: Cursor<'a>,
    pub(super) limits: &'a Limits,
    pub(super) polygons: Polygons,
    pub(super) report: ImportReport,
    pub(super) lines: Lines,
    pub(super) sets: Sets,
    /// The material libraries named so far.
    libraries: FxHashSet<String>,
    pub(super) first_texcoord_line: Option<u32>,
    /// True once a statement of the format was seen.
    pub(super) understood: bool,
    /// The largest vertex number (0-based) that a face or a tag named, and where a tag named its largest.
    pub(super) largest_vertex: Option<u32>,
    largest_tag_vertex: Option<(u32, Place)>,
    /// The largest face number (0-based) that a tag named, and where.
    largest_tag_face: Option<(u32, Place)>,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8], limits: &'a Limits) -> Self {
        Self {
            text: Cursor::new(bytes),
            limits,
            polygons: Polygons::default(),
            report: ImportReport::default(),
            lines: Lines::default(),
            sets: Sets::default(),
            libraries: FxHashSet::default(),
            first_texcoord_line: None,
            understood: false,
            largest_vertex: None,
            largest_tag_vertex: None,
            largest_tag_face: None,
        }
    }

    /// Makes room for as many vertices and quads.
    fn reserve(&mut self, expected: usize) -> Result<()> {
        memory::reserve(&mut self.polygons.positions, expected)?;
        memory::reserve(&mut self.lines.vertices, expected)?;
        memory::reserve(&mut self.polygons.face_sizes, expected)?;
        memory::reserve(&mut self.polygons.face_vertices, 4 * expected)?;
        memory::reserve(&mut self.lines.faces, expected)?;
        Ok(())
    }

    /// An error at the present place.
    pub(super) fn fault(&self, message: impl Into<String>, remedy: &'static str) -> Box<Fault> {
        fault_at(self.text.place(), message, remedy)
    }

    pub(super) fn note_tag_vertex(&mut self, vertex: u32, place: Place) {
        if self.largest_tag_vertex.is_none_or(|(largest, _)| vertex > largest) {
            self.largest_tag_vertex = Some((vertex, place));
        }
    }

    pub(super) fn note_tag_face(&mut self, face: u32, place: Place) {
        if self.largest_tag_face.is_none_or(|(largest, _)| face > largest) {
            self.largest_tag_face = Some((face, place));
        }
    }

    fn statements(&mut self) -> Result<()> {
        loop {
            if self.text.next_token_on_line() {
                self.statement()?;
            }
            if !self.text.next_line() {
                return Ok(());
            }
        }
    }

    fn statement(&mut self) -> Result<()> {
        let place = self.text.place();
        let line = place.line;
        let keyword = self.text.token();
        let ignored = match keyword {
            b"v" => return self.vertex(line),
            b"f" | b"fo" => return self.face(line),
            b"vt" => return self.texcoord(line),
            b"vn" => IgnoredKind::Normals,
            b"g" => return self.set(SetStatement::Group, line),
            b"o" => return self.set(SetStatement::Object, line),
            b"usemtl" => return self.set(SetStatement::Material, line),
            b"s" => return self.set(SetStatement::Smoothing, line),
            b"mtllib" => return self.material_library(line),
            b"t" => return self.tag(line),
            b"p" => IgnoredKind::Points,
            b"l" => IgnoredKind::Lines,
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm"
            | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"cdc" | b"cdp" | b"bzp" | b"bsp"
            | b"res" => IgnoredKind::FreeFormGeometry,
            b"mg" | b"bevel" | b"c_interp" | b"d_interp" | b"lod" | b"shadow_obj" | b"trace_obj"
            | b"ctech" | b"stech" | b"usemap" | b"maplib" => IgnoredKind::DisplaySettings,
            _ => {
                self.report.ignore(IgnoredKind::UnknownKeywords, line, || shown(keyword));
                return Ok(());
            }
        };
        self.understood = true;
        self.report.ignore(ignored, line, || shown(keyword));
        Ok(())
    }

    fn vertex(&mut self, line: u32) -> Result<()> {
        self.understood = true;
        if self.polygons.positions.len() as u64 >= self.limits.max_vertices {
            let message = format!("more than {} vertices", self.limits.max_vertices);
            return Err(
                self.fault(message, "raise the limit for vertices if the file is meant to be this large")
            );
        }
        let x = self.coordinate()?;
        let y = self.coordinate()?;
        let z = self.coordinate()?;
        memory::reserve(&mut self.polygons.positions, 1)?;
        memory::reserve(&mut self.lines.vertices, 1)?;
        self.polygons.positions.push(DVec3::new(x, y, z));
        self.lines.vertices.push(line);
        if self.text.next_token_on_line() {
            self.behind_coordinates(line);
        }
        Ok(())
    }

    fn coordinate(&mut self) -> Result<f64> {
        const RANGE: &str = "scale the model; coordinates lie between -1e50 and 1e50";
        const REMEDY: &str = "write 'v x y z' with three finite numbers";
        if !self.text.next_token_on_line() {
            return Err(self.fault("a vertex with fewer than three coordinates", REMEDY));
        }
        let place = self.text.place();
        match self.text.number() {
            Ok(value) if value.abs() <= MOST_COORDINATE => Ok(value),
            Ok(value) if value.is_finite() => {
                Err(fault_at(place, format!("the coordinate {value:e} is out of range"), RANGE))
            }
            Ok(value) => {
                Err(fault_at(place, format!("the coordinate {value} is not a finite number"), REMEDY))
            }
            Err(token) => Err(fault_at(place, format!("'{}' is not a number", shown(token)), REMEDY)),
        }
    }

    /// Weight (1 more number), colour (3), both (4) or what else stands behind the coordinates.
    fn behind_coordinates(&mut self, line: u32) {
        let mut count = 0;
        let mut first = None;
        while self.text.next_token_on_line() {
            let number = self.text.number();
            if count == 0 {
                first = number.ok();
            }
            count += 1;
        }
        if matches!(count, 1 | 4) && first != Some(1.0) {
            self.report.ignore(IgnoredKind::VertexWeights, line, || "v".into());
        }
        match count {
            1 => {}
            3 | 4 => self.report.ignore(IgnoredKind::VertexColours, line, || "v".into()),
            _ => self.report.ignore(IgnoredKind::ExtraNumbers, line, || "v".into()),
        }
    }

    fn texcoord(&mut self, line: u32) -> Result<()> {
        const REMEDY: &str = "write 'vt u v' with finite numbers";
        self.understood = true;
        if self.polygons.texcoords.len() as u64 >= self.limits.max_vertices {
            let message = format!("more than {} texture coordinates", self.limits.max_vertices);
            return Err(
                self.fault(message, "raise the limit for vertices if the file is meant to be this large")
            );
        }
        let mut values = [0.0; 3];
        for (i, value) in values.iter_mut().enumerate() {
            if !self.text.next_token_on_line() {
                if i == 0 {
                    return Err(self.fault("a texture coordinate without a number", REMEDY));
                }
                break;
            }
            let place = self.text.place();
            *value = match self.text.number() {
                Ok(number) if number.is_finite() => number,
                Ok(_) => {
                    return Err(fault_at(place, "a texture coordinate that is not a finite number", REMEDY));
                }
                Err(token) => {
                    return Err(fault_at(place, format!("'{}' is not a number", shown(token)), REMEDY));
                }
            };
        }
        if values[2] != 0.0 {
            self.report.ignore(IgnoredKind::ThirdTextureCoordinate, line, || "vt".into());
        }
        self.first_texcoord_line.get_or_insert(line);
        memory::reserve(&mut self.polygons.texcoords, 1)?;
        self.polygons.texcoords.push(DVec2::new(values[0], values[1]));
        Ok(())
    }

    fn name(&mut self, line: u32) -> Result<String> {
        let words = self.text.words();
        if words.len() > LONGEST_NAME {
            let message = format!("a name of {} bytes", words.len());
            return Err(self.fault(message, "use names of at most 4096 bytes"));
        }
        Ok(String::from_utf8(words).unwrap_or_else(|error| {
            let name = String::from_utf8_lossy(error.as_bytes()).into_owned();
            self.report.ignore(IgnoredKind::NamesNotUtf8, line, || shown(name.as_bytes()));
            name
        }))
    }

    fn set(&mut self, statement: SetStatement, line: u32) -> Result<()> {
        self.understood = true;
        let name = self.name(line)?;
        if let Some(unused) = self.sets.set(statement, name, line) {
            self.report.ignore(IgnoredKind::NamesWithoutFaces, unused, || statement.keyword().into());
        }
        Ok(())
    }

    fn material_library(&mut self, line: u32) -> Result<()> {
        self.understood = true;
        let name = self.name(line)?;
        if !name.is_empty() && self.libraries.insert(name.clone()) {
            self.polygons.material_libraries.push(name);
        }
        Ok(())
    }

    /// Checks what can be known only at the end.
    fn finish(&mut self) -> Result<()> {
        if !self.understood
            && let Some(unknown) = self.report.ignored.first()
        {
            let place = Place { line: unknown.first_line, column: 1 };
            let message = format!("'{}' is no OBJ statement, and the file has none", unknown.example);
            return Err(fault_at(place, message, "check that this is an OBJ file"));
        }
        let count = self.polygons.positions.len();
        if self.largest_vertex.is_some_and(|vertex| vertex as usize >= count) {
            return Err(self.first_out_of_range());
        }
        if let Some((vertex, place)) = self.largest_tag_vertex.filter(|&(vertex, _)| vertex as usize >= count)
        {
            let message =
                format!("a tag names vertex {vertex}, but the file has {count} (tags count from 0)");
            return Err(fault_at(place, message, RANGE_REMEDY));
        }
        let faces = self.polygons.face_sizes.len();
        if let Some((face, place)) = self.largest_tag_face.filter(|&(face, _)| face as usize >= faces) {
            let message = format!("a tag names face {face}, but the file has {faces} (tags count from 0)");
            return Err(fault_at(place, message, "correct the number or add the missing face"));
        }
        for (statement, line) in self.sets.unused() {
            self.report.ignore(IgnoredKind::NamesWithoutFaces, line, || statement.keyword().into());
        }
        if self.polygons.sets.iter().all(|set| *set == Default::default()) {
            self.polygons.sets.clear();
            self.polygons.face_sets.clear();
        }
        self.settle_texcoords();
        Ok(())
    }
}

pub(super) const RANGE_REMEDY: &str = "correct the number or add the missing vertex";

pub(super) fn fault_at(place: Place, message: impl Into<String>, remedy: &'static str) -> Box<Fault> {
    Box::new(Fault { place, message: message.into(), remedy, memory: None })
}
