//! Selectors as text: `ring:12,13`, `edge:4,5@0.3#piped`.

use super::DEFAULT_KIND;
use super::curve::{self, Course, Curve};
use glam::DVec3;
use std::path::PathBuf;

/// Which edges to mark.
#[derive(Clone, PartialEq, Debug)]
pub enum Shape {
    /// `edge:A,B` or `edge:A,B@t`: one edge, crossed at `t` from A (0.5 unless given).
    Edge {
        /// The edge's vertices.
        edge: (u32, u32),
        /// Place along the edge, in (0, 1).
        t: f64,
    },
    /// `ring:A,B`: the edges that a loop cut from edge AB crosses: opposite edges of quads, both ways.
    Ring {
        /// The edge to start from.
        edge: (u32, u32),
    },
    /// `path:A,B:C,D`: the edges that the shortest path of quads between two edges crosses, both included.
    Path {
        /// The first edge.
        from: (u32, u32),
        /// The last edge.
        to: (u32, u32),
    },
    /// `cut:V,V,...`: all edges that leave a set of vertices: a closed loop around it.
    Cut {
        /// The vertices inside.
        vertices: Vec<u32>,
    },
    /// `polyline:X,Y,Z;X,Y,Z;...` or `spline:...`, with `;closed` at the end if wanted: a curve on or near the surface,
    /// which the feature follows whatever the edges do.
    Curve {
        /// Points it goes through.
        points: Vec<DVec3>,
        /// How it runs between them.
        course: Course,
        /// Whether it closes.
        closed: bool,
    },
    /// `select:FILE`: marks and curves from a JSON file, `{"marks": [{"edge": [A, B], "t": 0.5, "kind": "red"}, ...],
    /// "curves": [{"points": [[X, Y, Z], ...], "course": "polyline" or "spline", "closed": false, "kind": "red"}]}`;
    /// what is not needed may be left out.
    File(PathBuf),
}

/// A shape and the kind of mark it sets.
#[derive(Clone, PartialEq, Debug)]
pub struct Selector {
    /// Which edges.
    pub shape: Shape,
    /// The kind, `"red"` unless `#name` says otherwise. Rule files tell marks apart by it; features take marks of
    /// every kind.
    pub kind: String,
}

/// A selector that cannot be read.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("mark '{text}': {problem}")]
pub struct SelectorError {
    /// The selector as given.
    pub text: String,
    /// What is wrong and what would be right.
    pub problem: String,
}

const FORMS: &str = "a mark is edge:A,B[@t], ring:A,B, path:A,B:C,D, cut:V,V,..., polyline:X,Y,Z;..., spline:X,Y,Z;... or select:FILE, with #kind at the end if wanted";

impl Selector {
    /// Reads a selector. Vertex numbers are 0-based.
    ///
    /// # Errors
    /// What is wrong with the text, and the forms that exist.
    pub fn parse(text: &str) -> Result<Self, SelectorError> {
        parse(text).map_err(|problem| SelectorError { text: text.to_owned(), problem })
    }
}

fn parse(text: &str) -> Result<Selector, String> {
    let (name, rest) = text.split_once(':').ok_or(FORMS)?;
    let (rest, kind) = match rest.rsplit_once('#') {
        Some((rest, kind)) if !kind.is_empty() => (rest, kind),
        Some(_) => return Err("a kind is missing after '#'".into()),
        None => (rest, DEFAULT_KIND),
    };
    let shape = match name {
        "edge" => {
            let (edge, t) = match rest.split_once('@') {
                Some((edge, t)) => (edge, place(t)?),
                None => (rest, 0.5),
            };
            Shape::Edge { edge: pair(edge)?, t }
        }
        "ring" => Shape::Ring { edge: pair(rest)? },
        "path" => {
            let (from, to) = rest.split_once(':').ok_or("a path is path:A,B:C,D, two edges")?;
            Shape::Path { from: pair(from)?, to: pair(to)? }
        }
        "cut" => Shape::Cut { vertices: rest.split(',').map(vertex).collect::<Result<_, _>>()? },
        "polyline" | "spline" => {
            let (points, closed) = curve::parse(rest)?;
            let course = if name == "spline" { Course::Spline } else { Course::Polyline };
            let curve = Curve { points, course, closed, kind: kind.to_owned() };
            match curve.problem() {
                Some(problem) => return Err(problem),
                None => Shape::Curve { points: curve.points, course, closed },
            }
        }
        "select" if rest.is_empty() => return Err("a file name is missing after 'select:'".into()),
        "select" => Shape::File(rest.into()),
        _ => return Err(format!("there is no selector '{name}'; {FORMS}")),
    };
    Ok(Selector { shape, kind: kind.to_owned() })
}

fn vertex(text: &str) -> Result<u32, String> {
    text.trim().parse().map_err(|_| format!("'{text}' is not a vertex number (0, 1, 2, ...)"))
}

fn pair(text: &str) -> Result<(u32, u32), String> {
    let (a, b) = text
        .split_once(',')
        .ok_or_else(|| format!("'{text}' is not an edge; an edge is two vertex numbers, A,B"))?;
    Ok((vertex(a)?, vertex(b)?))
}

fn place(text: &str) -> Result<f64, String> {
    text.trim()
        .parse()
        .ok()
        .filter(|t| *t > 0.0 && *t < 1.0)
        .ok_or_else(|| format!("'{text}' is not a place on an edge; it lies between 0 and 1, ends excluded"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_every_form() {
        let shape = |text| Selector::parse(text).map(|s| s.shape);
        assert_eq!(shape("edge:1,2"), Ok(Shape::Edge { edge: (1, 2), t: 0.5 }));
        assert_eq!(shape("edge:1,2@0.25"), Ok(Shape::Edge { edge: (1, 2), t: 0.25 }));
        assert_eq!(shape("ring:7,8"), Ok(Shape::Ring { edge: (7, 8) }));
        assert_eq!(shape("path:1,2:3,4"), Ok(Shape::Path { from: (1, 2), to: (3, 4) }));
        assert_eq!(shape("cut:5,6,7"), Ok(Shape::Cut { vertices: vec![5, 6, 7] }));
        assert_eq!(shape("select:a/b.json"), Ok(Shape::File("a/b.json".into())));
        assert_eq!(Selector::parse("ring:7,8#piped").map(|s| s.kind), Ok("piped".into()));
    }

    #[test]
    fn refuses_with_a_remedy() {
        let problem = |text| Selector::parse(text).map_err(|e| e.problem);
        assert_eq!(problem("edge:1"), Err("'1' is not an edge; an edge is two vertex numbers, A,B".into()));
        assert_eq!(
            problem("edge:1,2@1.5"),
            Err("'1.5' is not a place on an edge; it lies between 0 and 1, ends excluded".into())
        );
        assert_eq!(problem("cut:1,x"), Err("'x' is not a vertex number (0, 1, 2, ...)".into()));
        assert_eq!(problem("ring:1,2#"), Err("a kind is missing after '#'".into()));
        assert!(problem("loop:1,2").is_err_and(|p| p.starts_with("there is no selector 'loop'")));
    }
}
