//! `t` statements: `t crease 2/1/0 a b s` and `t corner 1/1/0 v s`, vertex numbers 0-based (OpenSubdiv's shapes).
//!
//! The counts are those of the integers, numbers and strings that follow. A crease of more than two vertices is a
//! chain of edges, with one sharpness for all or one for each.

use super::read::{Reader, Result};
use crate::io::report::IgnoredKind;
use crate::io::text::shown;

const REMEDY: &str =
    "write for example 't crease 2/1/0 4 7 2.5' or 't corner 1/1/0 4 2.5', vertices counted from 0";

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

    /// Reads `vertices/numbers/strings` and as many vertices and numbers.
    fn tag_values(&mut self) -> Result<(Vec<u32>, Vec<f32>)> {
        let counts = self.tag_counts().ok_or_else(|| self.fault("a tag without its three counts", REMEDY))?;
        let (mut vertices, mut sharpness) = (Vec::new(), Vec::new());
        for _ in 0..counts.0 {
            self.text.next_token_on_line();
            let place = self.text.place();
            let vertex = self.text.integer().filter(|_| self.text.is_token_end());
            match vertex.and_then(|v| u32::try_from(v).ok()) {
                Some(vertex) => {
                    self.note_tag_vertex(vertex, place);
                    vertices.push(vertex);
                }
                None => return Err(self.fault("a vertex number is missing or not a number", REMEDY)),
            }
        }
        for _ in 0..counts.1 {
            self.text.next_token_on_line();
            match self.text.number() {
                Ok(value) if value >= 0.0 => sharpness.push(value as f32),
                _ => return Err(self.fault("a sharpness is missing or not a number of 0 or more", REMEDY)),
            }
        }
        Ok((vertices, sharpness))
    }

    fn tag_counts(&mut self) -> Option<(i64, i64)> {
        self.text.next_token_on_line();
        let mut counts = [0; 3];
        for (i, count) in counts.iter_mut().enumerate() {
            if i > 0 {
                if self.text.peek() != Some(b'/') {
                    return None;
                }
                self.text.advance();
            }
            *count = self.text.integer()?;
        }
        self.text.is_token_end().then_some((counts[0], counts[1]))
    }
}
