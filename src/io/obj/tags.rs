//! `t` statements as OpenSubdiv's shapes have them: `t crease 2/1/0 a b s`, `t corner 1/1/0 v s`, `t hole 1/0/0 f`,
//! `t interpolateboundary 1/0/0 n`, `t creasemethod 0/0/1 normal`, numbers of vertices and faces 0-based. Others
//! (hierarchical edits, face-varying data) are reported as ignored.
//!
//! The counts are those of the integers, numbers and strings that follow. A crease of more than two vertices is a
//! chain of edges, with one sharpness for all or one for each.

use super::read::{Reader, Result};
use crate::io::report::IgnoredKind;
use crate::io::text::shown;
use crate::mesh::{BoundaryRule, Creasing};

const REMEDY: &str =
    "write for example 't crease 2/1/0 4 7 2.5' or 't corner 1/1/0 4 2.5', vertices counted from 0";

const HOLE_REMEDY: &str = "write for example 't hole 1/0/0 4', faces counted from 0";

impl Reader<'_> {
    /// Reads the rest of a `t` statement.
    pub(super) fn tag(&mut self, line: u32) -> Result<()> {
        self.understood = true;
        if !self.text.next_token_on_line() {
            return Err(self.fault("a tag without a name", REMEDY));
        }
        match self.text.token() {
            b"crease" => self.crease(line),
            b"corner" => self.corner_tag(),
            b"hole" => self.hole(),
            b"interpolateboundary" => self.boundary_rule(),
            b"creasemethod" => self.crease_method(),
            other => {
                self.report.ignore(IgnoredKind::Tags, line, || shown(other));
                Ok(())
            }
        }
    }

    fn crease(&mut self, line: u32) -> Result<()> {
        let (vertices, sharpness) = self.tag_values()?;
        if vertices.len() < 2 || !(sharpness.len() == 1 || sharpness.len() == vertices.len() - 1) {
            return Err(
                self.fault("a crease needs two vertices or more, and one sharpness or one per edge", REMEDY)
            );
        }
        for (i, pair) in vertices.windows(2).enumerate() {
            let sharpness = sharpness.get(i).unwrap_or(&sharpness[0]);
            self.polygons.creases.push((pair[0], pair[1], *sharpness));
            self.lines.creases.push(line);
        }
        Ok(())
    }

    fn corner_tag(&mut self) -> Result<()> {
        let (vertices, sharpness) = self.tag_values()?;
        if vertices.is_empty() || !(sharpness.len() == 1 || sharpness.len() == vertices.len()) {
            return Err(
                self.fault("a corner needs one vertex or more, and one sharpness or one per vertex", REMEDY)
            );
        }
        for (i, &vertex) in vertices.iter().enumerate() {
            self.polygons.corners.push((vertex, *sharpness.get(i).unwrap_or(&sharpness[0])));
        }
        Ok(())
    }

    fn hole(&mut self) -> Result<()> {
        let [count, ..] = self.tag_counts()?;
        for _ in 0..count {
            self.text.next_token_on_line();
            let place = self.text.place();
            let face = self.tag_index("a face number is missing or not a number", HOLE_REMEDY)?;
            self.note_tag_face(face, place);
            self.polygons.holes.push(face);
        }
        Ok(())
    }

    fn boundary_rule(&mut self) -> Result<()> {
        const REMEDY: &str =
            "write 't interpolateboundary 1/0/0 n' with n 0 (none), 1 (edges and corners) or 2 (edges only)";
        self.tag_counts()?;
        self.text.next_token_on_line();
        self.polygons.subdivision.boundary = match self.tag_index("no boundary rule", REMEDY)? {
            0 => BoundaryRule::None,
            1 => BoundaryRule::EdgeAndCorner,
            2 => BoundaryRule::EdgeOnly,
            _ => return Err(self.fault("an unknown boundary rule", REMEDY)),
        };
        Ok(())
    }

    fn crease_method(&mut self) -> Result<()> {
        const REMEDY: &str = "write 't creasemethod 0/0/1 normal' or 't creasemethod 0/0/1 chaikin'";
        self.tag_counts()?;
        self.text.next_token_on_line();
        self.polygons.subdivision.creasing = match self.text.token() {
            b"normal" => Creasing::Uniform,
            b"chaikin" => Creasing::Chaikin,
            _ => return Err(self.fault("an unknown creasing method", REMEDY)),
        };
        Ok(())
    }

    /// Reads `vertices/numbers/strings` and as many vertices and numbers.
    fn tag_values(&mut self) -> Result<(Vec<u32>, Vec<f32>)> {
        let [vertex_count, number_count, _] = self.tag_counts()?;
        let (mut vertices, mut sharpness) = (Vec::new(), Vec::new());
        for _ in 0..vertex_count {
            self.text.next_token_on_line();
            let place = self.text.place();
            let vertex = self.tag_index("a vertex number is missing or not a number", REMEDY)?;
            self.note_tag_vertex(vertex, place);
            vertices.push(vertex);
        }
        for _ in 0..number_count {
            self.text.next_token_on_line();
            match self.text.number() {
                Ok(value) if value >= 0.0 => sharpness.push(value as f32),
                _ => return Err(self.fault("a sharpness is missing or not a number of 0 or more", REMEDY)),
            }
        }
        Ok((vertices, sharpness))
    }

    fn tag_index(&mut self, message: &str, remedy: &'static str) -> Result<u32> {
        let index = self.text.integer().filter(|_| self.text.is_token_end());
        index.and_then(|index| u32::try_from(index).ok()).ok_or_else(|| self.fault(message, remedy))
    }

    fn tag_counts(&mut self) -> Result<[i64; 3]> {
        self.text.next_token_on_line();
        let mut counts = [0; 3];
        for (i, count) in counts.iter_mut().enumerate() {
            let slash = i == 0 || self.text.peek() == Some(b'/');
            if i > 0 && slash {
                self.text.advance();
            }
            match self.text.integer() {
                Some(value) if slash => *count = value,
                _ => return Err(self.fault("a tag without its three counts", REMEDY)),
            }
        }
        if self.text.is_token_end() {
            Ok(counts)
        } else {
            Err(self.fault("a tag without its three counts", REMEDY))
        }
    }
}
