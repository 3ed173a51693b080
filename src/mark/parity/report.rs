//! What the router did and what it cost.

use super::Mode;
use crate::mesh::FaceId;
use serde::Serialize;
use std::fmt;

/// Where a parity line ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// In this face: one that a feature left odd, or in all-quad mode a triangle or pentagon.
    Face(u32),
    /// At the border of the mesh.
    Border,
}

/// A row of vertices that makes the faces at its ends even.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Line {
    /// Where it begins and ends.
    pub ends: [End; 2],
    /// The edges that it crosses, in order, by their vertices: one new vertex each.
    pub edges: Vec<(u32, u32)>,
    /// Turns that it takes: two extraordinary vertices each.
    pub turns: usize,
    /// Its cost; 1 is a vertex on an edge in a flat place, far from the feature.
    pub cost: f64,
}

/// Why a face stays odd.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// No lines were asked for.
    Local,
    /// The marks, or the shape of the face, leave no side by which a line could come in.
    ClosedIn,
    /// The way to a partner costs more than an irregular face (auto mode).
    Far,
    /// All partners that it could reach are paired with each other: an odd number of odd faces on a closed surface.
    OddNumber,
    /// No row of quads leads to the border or to another odd face.
    Unreachable,
}

impl Reason {
    /// The reason in words.
    pub fn text(self) -> &'static str {
        match self {
            Self::Local => "no lines were asked for",
            Self::ClosedIn => "no side is open to a line",
            Self::Far => "the way to a partner costs more than one irregular face",
            Self::OddNumber => "an odd number of odd faces on a closed surface",
            Self::Unreachable => "no row of quads leads to the border or to another odd face",
        }
    }
}

/// A face that stays odd: the rules give it one irregular face, if they can handle it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Odd {
    /// The face.
    pub face: u32,
    /// Why.
    pub reason: Reason,
}

/// What was done about odd faces. Faces and vertices have the numbers of the mesh before the feature.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Report {
    /// What was asked for.
    pub mode: Mode,
    /// Faces that the marks leave with an odd number of sides.
    pub odd: usize,
    /// The lines.
    pub lines: Vec<Line>,
    /// Vertices that they add on edges of the mesh.
    pub vertices: usize,
    /// Faces that stay odd.
    pub left: Vec<Odd>,
    /// The lines are those of least total cost among all pairings; else of those tried (many odd faces in all-quad
    /// mode).
    pub exact: bool,
}

impl Report {
    pub(super) fn new(mode: Mode, odd: usize) -> Self {
        Self { mode, odd, lines: Vec::new(), vertices: 0, left: Vec::new(), exact: true }
    }

    pub(super) fn leave(&mut self, face: FaceId, reason: Reason) {
        self.left.push(Odd { face: face.0, reason });
    }
}

impl fmt::Display for Report {
    /// A line for people; nothing where no face was odd.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.odd == 0 {
            return Ok(());
        }
        let turns: usize = self.lines.iter().map(|line| line.turns).sum();
        writeln!(
            f,
            "parity: {} odd faces, {} lines with {} vertices and {turns} turns{}",
            self.odd,
            self.lines.len(),
            self.vertices,
            if self.exact { "" } else { " (not proved least)" }
        )?;
        let reasons = [Reason::Local, Reason::ClosedIn, Reason::Far, Reason::OddNumber, Reason::Unreachable];
        for reason in reasons {
            let left: Vec<u32> = self.left.iter().filter(|o| o.reason == reason).map(|o| o.face).collect();
            if let Some(first) = left.first() {
                writeln!(f, "parity: {} faces stay odd (first: {first}): {}", left.len(), reason.text())?;
            }
        }
        Ok(())
    }
}
