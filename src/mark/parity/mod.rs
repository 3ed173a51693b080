//! Parity: where features end or meet, faces are left with an odd number of sides, which quads alone cannot fill.
//!
//! [`route`] pairs these faces by lines that cross the quads between them, one new vertex per crossed edge, so that
//! every face gets an even number of sides. In the terms of graph theory the crossed edges are a T-join of the dual
//! graph (Schrijver 2003, Combinatorial Optimization, chapter 29): shortest paths between the odd faces, then the
//! pairing of least total cost. The border of the mesh takes any number of lines. What a line costs is in
//! [`cost`]; where it may go, in [`faces`].

mod cost;
mod faces;
mod lines;
mod pairing;
mod report;
mod search;

pub use report::{End, Line, Odd, Reason, Report};

use super::Mark;
use crate::job::{Cancelled, Job};
use crate::mesh::{FaceId, HalfEdgeId, Mesh};
use cost::{Costs, IMPOSSIBLE, LEAVE};
use faces::Faces;
use pairing::pair;
use rustc_hash::{FxHashMap, FxHashSet};
use search::{Found, Path, Reach, search};
use serde::Serialize;
use std::collections::BTreeMap;

/// The kind of the marks that make a face even.
pub const KIND: &str = "parity";

/// What is done about faces that a feature leaves with an odd number of sides.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// A line where the way is short, one irregular face outside of the band elsewhere.
    #[default]
    Auto,
    /// Lines wherever there is a way. Triangles, pentagons and the like that were there before serve as ends,
    /// too, and become quads.
    AllQuad,
    /// No lines: one irregular face each.
    Local,
}

/// In all-quad mode, how many partners each odd face looks for: the nearest ones.
const NEAREST: usize = 12;

/// The edges that parity lines cross, as marks of kind [`KIND`] in their middles, and what was done.
///
/// `marks` are the marked edges with the number of vertices that the rules will insert on each; each edge at most
/// once, all on `mesh`. The mesh is not changed. The result depends on nothing but the arguments; among lines of equal
/// cost it is that with lower ids. In auto mode the time follows the number of odd faces, in all-quad mode the area
/// that the lines have to search.
///
/// # Errors
/// [`Cancelled`].
pub fn route(
    mesh: &Mesh,
    marks: &[(HalfEdgeId, usize)],
    mode: Mode,
    job: &Job,
) -> Result<(Vec<Mark>, Report), Cancelled> {
    let faces = Faces::new(mesh, marks, mode == Mode::AllQuad);
    let mut report = Report::new(mode, faces.odd().len());
    let mut join = BTreeMap::new();
    // The odd faces that can have a line.
    let mut open = Vec::new();
    for &face in faces.odd() {
        if mode == Mode::Local {
            report.leave(face, Reason::Local);
        } else if faces.exits(face).next().is_none() {
            report.leave(face, Reason::ClosedIn);
        } else {
            open.push(face);
        }
    }
    let mut costs = Costs::new(mesh, marks);
    let mut search =
        Pairs { mesh, faces: &faces, open, taken: FxHashSet::default(), met: FxHashSet::default() };
    let mut is_first = true;
    while !search.open.is_empty() {
        let round = search.round(&mut costs, mode, job)?;
        // A second round is for faces whose nearest partners were all taken: they look further, among themselves.
        report.exact &= round.is_exact && (is_first || round.paths.is_empty());
        is_first = false;
        for h in round.paths.iter().flat_map(|path| &path.crossed) {
            // An edge that two lines cross is crossed by none: they exchange their ends.
            if join.remove(&h.edge()).is_none() {
                join.insert(h.edge(), *h);
            }
        }
        if round.paths.is_empty() || mode == Mode::Auto {
            break;
        }
    }
    for &face in &search.open {
        let reason = match mode {
            Mode::Auto | Mode::Local => Reason::Far,
            Mode::AllQuad if search.met.contains(&face) => Reason::OddNumber,
            Mode::AllQuad => Reason::Unreachable,
        };
        report.leave(face, reason);
    }
    report.left.sort_unstable_by_key(|odd| odd.face);
    let crossed = lines::trace(mesh, &faces, &mut costs, &join, &mut report);
    let mark = |half_edge| Mark { half_edge, t: 0.5, kind: KIND.to_owned(), breadth: None };
    Ok((crossed.into_iter().map(mark).collect(), report))
}

/// The odd faces on their search for partners.
struct Pairs<'a, 'm> {
    mesh: &'m Mesh,
    faces: &'a Faces<'m>,
    /// The faces without a partner.
    open: Vec<FaceId>,
    /// Faces that were odd before and have a line.
    taken: FxHashSet<FaceId>,
    /// Faces that found a partner, though it may have gone to another.
    met: FxHashSet<FaceId>,
}

/// What one round gave.
struct Round {
    paths: Vec<Path>,
    is_exact: bool,
}

impl Pairs<'_, '_> {
    /// Pairs the open faces with each other, with irregular faces and with the border, at least cost.
    fn round(&mut self, costs: &mut Costs, mode: Mode, job: &Job) -> Result<Round, Cancelled> {
        let reach = match mode {
            Mode::AllQuad => Reach { partners: NEAREST, leave: IMPOSSIBLE },
            Mode::Auto | Mode::Local => Reach { partners: usize::MAX, leave: LEAVE },
        };
        let mut nodes: FxHashMap<FaceId, usize> =
            self.open.iter().enumerate().map(|(i, &face)| (face, i)).collect();
        let mut irregular = Vec::new();
        let mut found: Vec<Found> = Vec::with_capacity(self.open.len());
        for (i, &face) in self.open.iter().enumerate() {
            job.step("parity", i as f64 / self.open.len() as f64)?;
            let is_partner = |other: FaceId| {
                other != face
                    && (nodes.contains_key(&other)
                        || self.faces.is_unmarked(other) && !self.taken.contains(&other))
            };
            let partners = search(self.mesh, self.faces, costs, self.faces.exits(face), &reach, is_partner);
            if !partners.faces.is_empty() {
                self.met.insert(face);
            }
            for &(other, _) in &partners.faces {
                nodes.entry(other).or_insert_with(|| {
                    irregular.push(other);
                    self.open.len() + irregular.len() - 1
                });
            }
            found.push(partners);
        }
        // What it costs not to pair a face: the way to the border, or an irregular face; nothing for those that were
        // irregular before.
        let alone = |node: usize| {
            found
                .get(node)
                .map_or(0, |f| f.border.as_ref().map_or(reach.leave, |path| path.cost.min(reach.leave)))
        };
        let mut ways: BTreeMap<(usize, usize), &Path> = BTreeMap::new();
        for (i, partners) in found.iter().enumerate() {
            for (face, path) in &partners.faces {
                let Some(&j) = nodes.get(face) else { continue };
                let way = ways.entry((i.min(j), i.max(j))).or_insert(path);
                if path.cost < way.cost {
                    *way = path;
                }
            }
        }
        let gains: Vec<(usize, usize, cost::Cost)> = ways
            .iter()
            .map(|(&(a, b), path)| (a, b, alone(a) + alone(b) - path.cost))
            .filter(|&(_, _, gain)| gain > 0)
            .collect();
        let pairing = pair(nodes.len(), &gains);
        let mut paths = Vec::new();
        let mut still_open = Vec::new();
        for (i, partners) in found.iter().enumerate() {
            match (pairing.mates[i], &partners.border) {
                (Some(j), _) => {
                    // Each pair once.
                    if i < j {
                        paths.extend(ways.get(&(i, j)).copied().cloned());
                    }
                    self.taken.extend(j.checked_sub(self.open.len()).and_then(|k| irregular.get(k)));
                }
                (None, Some(path)) => paths.push(path.clone()),
                (None, None) => still_open.push(self.open[i]),
            }
        }
        let is_exact = pairing.is_exact && found.iter().all(|partners| !partners.is_cut);
        self.open = still_open;
        Ok(Round { paths, is_exact })
    }
}
