//! Parity lines: every odd face gets an even number of sides, or the report says why it cannot.

use super::case::Case;
use super::checks::ensure;
use super::random::Random;
use rustc_hash::{FxHashMap, FxHashSet};
use welt::job::Job;
use welt::mark::parity::{self, End, Mode, Reason};
use welt::mesh::{FaceId, HalfEdgeId, Mesh};

/// Where a line goes that enters a face, as `docs/linear-features.md` says.
enum Way {
    End(FaceId),
    Border,
    On(Vec<HalfEdgeId>),
}

struct Marked<'m> {
    mesh: &'m Mesh,
    lines: FxHashMap<u32, usize>,
}

impl Marked<'_> {
    fn lines(&self, h: HalfEdgeId) -> usize {
        self.lines.get(&h.edge()).copied().unwrap_or(0)
    }

    /// Lines on the sides of a face, from `h` on.
    fn sides(&self, h: HalfEdgeId) -> Vec<(HalfEdgeId, usize)> {
        let around = std::iter::successors(Some(h), |&g| Some(self.mesh.next(g)).filter(|&g| g != h));
        around.map(|g| (g, self.lines(g))).collect()
    }

    /// The marks make an even face odd.
    fn is_newly_odd(&self, face: FaceId) -> bool {
        let sides = self.sides(self.mesh.face_half_edge(face));
        sides.len().is_multiple_of(2) && sides.iter().map(|side| side.1).sum::<usize>() % 2 == 1
    }

    /// A line may enter an odd face, or leave it, over `h`.
    fn is_exit(&self, h: HalfEdgeId) -> bool {
        let face = self.mesh.face(h);
        if self.mesh.face(h.mate()) == face || self.lines(h) > 0 || !self.is_newly_odd(face) {
            return false;
        }
        let marked: Vec<bool> = self.sides(h).iter().map(|side| side.1 > 0).collect();
        match *marked {
            [_, left, back, right] => back && left == right,
            _ => {
                // Apart from the marked sides, where there is such a side.
                let n = marked.len();
                let apart = |i: usize| !marked[i] && !marked[(i + 1) % n] && !marked[(i + n - 1) % n];
                apart(0) || !(0..n).any(apart)
            }
        }
    }

    fn way(&self, h: HalfEdgeId) -> Way {
        let face = self.mesh.face(h);
        if face.is_boundary() {
            return Way::Border;
        }
        let sides = self.sides(h);
        let is_marked = sides.iter().any(|side| side.1 > 0);
        match *sides {
            _ if self.mesh.face(h.mate()) == face => Way::On(vec![]),
            _ if is_marked && self.is_exit(h) => Way::End(face),
            [(_, 0), (_, x), (back, 0), (_, y)] if x > 0 && x == y => Way::On(vec![back]),
            _ if is_marked => Way::On(vec![]),
            [_, (a, _), (b, _), (c, _)] => Way::On(vec![a, b, c]),
            _ if sides.len() % 2 == 1 => Way::End(face),
            _ => Way::On(vec![]),
        }
    }

    /// The odd faces that lines from `face` can reach, and whether they reach the border.
    fn reach(&self, face: FaceId) -> (FxHashSet<FaceId>, bool) {
        let sides = self.mesh.face_half_edges(face);
        let mut stack: Vec<HalfEdgeId> = sides.filter(|&h| self.is_exit(h)).map(HalfEdgeId::mate).collect();
        let mut seen: FxHashSet<HalfEdgeId> = stack.iter().copied().collect();
        let (mut ends, mut border) = (FxHashSet::default(), false);
        while let Some(h) = stack.pop() {
            match self.way(h) {
                Way::Border => border = true,
                Way::End(other) => {
                    ends.insert(other);
                }
                Way::On(sides) => {
                    stack.extend(sides.into_iter().map(HalfEdgeId::mate).filter(|&next| seen.insert(next)));
                }
            }
        }
        ends.remove(&face);
        (ends, border)
    }
}

pub fn lines_are_right(case: &Case) -> Result<(), String> {
    let mesh = &case.model.mesh;
    let mut random = Random::new(case.seed);
    let counts = [3, 3, 3, 1 + random.below(6)];
    let marks: Vec<(HalfEdgeId, usize)> =
        case.marks.iter().map(|mark| (mark.half_edge, random.pick(&counts))).collect();
    let mode = case.options.parity;
    let run = || parity::route(mesh, &marks, mode, &Job::new()).map_err(|e| e.to_string());
    let (lines, report) = run()?;
    ensure!(run()? == (lines.clone(), report.clone()), "two runs differ");

    let marked = Marked { mesh, lines: marks.iter().map(|&(h, lines)| (h.edge(), lines)).collect() };
    let crossed: FxHashSet<u32> = lines.iter().map(|line| line.half_edge.edge()).collect();
    ensure!(crossed.len() == lines.len() && report.vertices == lines.len(), "an edge is crossed twice");
    ensure!(lines.iter().all(|line| marked.lines(line.half_edge) == 0), "a line crosses a marked edge");
    ensure!(lines.iter().all(|line| line.kind == parity::KIND && line.t == 0.5), "not in the middle");
    let listed: usize = report.lines.iter().map(|line| line.edges.len()).sum();
    ensure!(listed == lines.len(), "{listed} edges are listed of {}", lines.len());

    // Every face is even but those that are said to stay odd, and those that were odd before and got no line.
    let ends: FxHashSet<FaceId> = report
        .lines
        .iter()
        .flat_map(|line| line.ends)
        .filter_map(|end| match end {
            End::Face(face) => Some(FaceId(face)),
            End::Border => None,
        })
        .collect();
    let left: FxHashMap<FaceId, Reason> =
        report.left.iter().map(|odd| (FaceId(odd.face), odd.reason)).collect();
    ensure!(
        report.odd == mesh.faces().filter(|&f| marked.is_newly_odd(f)).count(),
        "{} odd faces",
        report.odd
    );
    for face in mesh.faces() {
        let sides = mesh.face_half_edges(face);
        let inserted: usize = sides.map(|h| marked.lines(h) + usize::from(crossed.contains(&h.edge()))).sum();
        let is_odd = (mesh.arity(face) + inserted) % 2 == 1;
        let was_odd = mesh.arity(face) % 2 == 1;
        let unmarked_or_odd = was_odd && inserted.is_multiple_of(2);
        ensure!(
            is_odd == (left.contains_key(&face) || unmarked_or_odd && !ends.contains(&face)),
            "face {} has {} sides and {inserted} vertices on them",
            face.0,
            mesh.arity(face)
        );
    }
    match mode {
        Mode::Local => ensure!(lines.is_empty(), "lines though none are wanted"),
        Mode::Auto => {
            let ends_at = |end: &End| matches!(end, End::Face(_));
            let most = |line: &parity::Line| if ends_at(&line.ends[1]) { 8.0 } else { 4.0 };
            ensure!(report.lines.iter().all(|line| line.cost < most(line)), "a way that is not short");
        }
        Mode::AllQuad => {
            for (&face, &reason) in &left {
                let (others, border) = marked.reach(face);
                let has_way = mesh.face_half_edges(face).any(|h| marked.is_exit(h));
                ensure!(has_way != (reason == Reason::ClosedIn), "face {} is said to be {reason:?}", face.0);
                ensure!(!border, "face {} stays odd, but a line could go to the border", face.0);
                let free = others.iter().find(|other| !ends.contains(other));
                ensure!(free.is_none(), "face {} stays odd, but a line could go to {free:?}", face.0);
            }
        }
    }
    Ok(())
}
