//! Traces: which rule was applied where, in order, recorded and played again.

use super::error::Place;
use crate::mesh::{Domain, Mesh, Node};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::{Mutex, PoisonError};

/// An application of a rule.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Application {
    /// Name of the rule.
    pub rule: String,
    /// The nodes of its pattern: name and element, in words.
    pub at: BTreeMap<String, String>,
    /// A point to look at.
    pub position: [f64; 3],
    /// The elements by their kind (`v`, `h`, `f`) and id, in the order of the pattern.
    pub nodes: Vec<String>,
}

impl Application {
    pub(super) fn new(rule: &str, place: &Place) -> Self {
        let at = place.nodes.iter().map(|(name, _, element)| (name.clone(), element.clone())).collect();
        let nodes = place.nodes.iter().map(|(_, node, _)| write_node(*node)).collect();
        Self { rule: rule.to_owned(), at, position: place.position.to_array(), nodes }
    }

    /// The elements.
    pub(super) fn elements(&self) -> Option<Vec<Node>> {
        self.nodes.iter().map(|text| read_node(text)).collect()
    }

    /// The place in words.
    pub(super) fn place(&self) -> String {
        let list: Vec<String> = self.at.iter().map(|(name, element)| format!("{name} = {element}")).collect();
        list.join(", ")
    }
}

fn write_node(node: Node) -> String {
    let letter = match node.domain() {
        Domain::Vertex => 'v',
        Domain::HalfEdge => 'h',
        Domain::Face => 'f',
    };
    format!("{letter}{}", node.id())
}

fn read_node(text: &str) -> Option<Node> {
    let domain = match text.chars().next()? {
        'v' => Domain::Vertex,
        'h' => Domain::HalfEdge,
        'f' => Domain::Face,
        _ => return None,
    };
    Some(Node::new(domain, text.get(1..)?.parse().ok()?))
}

/// One run of the rules. A feature runs them several times, until width and depth are reached; the last run counts.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Pass {
    /// What was done, in order.
    pub applications: Vec<Application>,
    /// [`digest`] of the mesh before the rules.
    pub before: String,
    /// [`digest`] of the mesh after the rules.
    pub after: String,
}

/// A line of a trace file.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Line {
    Begin {
        pass: usize,
        before: String,
    },
    Step {
        pass: usize,
        step: usize,
        #[serde(flatten)]
        application: Application,
    },
    End {
        pass: usize,
        after: String,
    },
}

/// Which rule was applied where, in order.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Trace {
    /// The runs of the rules, in order.
    pub passes: Vec<Pass>,
}

impl Trace {
    /// The trace as JSON lines. Passes and steps count from 1.
    ///
    /// # Errors
    /// A number that JSON cannot hold.
    pub fn to_lines(&self) -> Result<String, serde_json::Error> {
        let mut text = String::new();
        let mut line = |line: Line| -> Result<(), serde_json::Error> {
            let _ = writeln!(text, "{}", serde_json::to_string(&line)?);
            Ok(())
        };
        for (i, run) in self.passes.iter().enumerate() {
            let pass = i + 1;
            line(Line::Begin { pass, before: run.before.clone() })?;
            for (i, application) in run.applications.iter().enumerate() {
                line(Line::Step { pass, step: i + 1, application: application.clone() })?;
            }
            line(Line::End { pass, after: run.after.clone() })?;
        }
        Ok(text)
    }

    /// Reads what [`to_lines`](Self::to_lines) wrote.
    ///
    /// # Errors
    /// The number of the line, from 1, and what is wrong with it.
    pub fn from_lines(text: &str) -> Result<Self, (usize, String)> {
        let mut trace = Self::default();
        for (i, line) in text.lines().enumerate() {
            let wrong = |message: String| (i + 1, message);
            let line: Line =
                serde_json::from_str(line).map_err(|_| wrong("this is no line of a trace".to_owned()))?;
            let (Line::Begin { pass, .. } | Line::Step { pass, .. } | Line::End { pass, .. }) = &line;
            let expected = trace.passes.len() + usize::from(matches!(line, Line::Begin { .. }));
            if *pass != expected {
                return Err(wrong(format!("pass {pass} stands where pass {expected} is expected")));
            }
            let open = trace.passes.last_mut();
            match (line, open) {
                (Line::Begin { before, .. }, _) => trace.passes.push(Pass { before, ..Pass::default() }),
                (Line::Step { application, .. }, Some(open)) => open.applications.push(application),
                (Line::End { after, .. }, Some(open)) => open.after = after,
                (_, None) => return Err(wrong("a trace begins with a pass".to_owned())),
            }
        }
        Ok(trace)
    }
}

/// Watches the runs of rules that are given it, or tells them what to do.
#[derive(Debug)]
pub struct Tracer {
    replays: bool,
    state: Mutex<State>,
}

#[derive(Default, Debug)]
struct State {
    trace: Trace,
    /// The next run to play.
    next: usize,
}

impl Tracer {
    /// Records every run.
    pub fn record() -> Self {
        Self { replays: false, state: Mutex::default() }
    }

    /// Makes every run do what the trace says, run by run.
    pub fn replay(trace: Trace) -> Self {
        Self { replays: true, state: Mutex::new(State { trace, next: 0 }) }
    }

    /// What was recorded so far, or is played.
    pub fn trace(&self) -> Trace {
        self.lock().trace.clone()
    }

    /// The next run to play; `None` when this tracer records.
    pub(super) fn next_pass(&self) -> Option<Option<Pass>> {
        if !self.replays {
            return None;
        }
        let mut state = self.lock();
        state.next += 1;
        Some(state.trace.passes.get(state.next - 1).cloned())
    }

    pub(super) fn add(&self, pass: Pass) {
        self.lock().trace.passes.push(pass);
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A number that tells meshes apart: FNV-1a over the bits of positions, the faces and the sharpness, as 16 hexadecimal
/// digits.
pub fn digest(mesh: &Mesh) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |number: u64| {
        for byte in number.to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    let polygons = mesh.to_polygons();
    polygons.positions.iter().flat_map(|p| p.to_array()).for_each(|x| add(x.to_bits()));
    polygons.face_sizes.iter().chain(&polygons.face_vertices).for_each(|&x| add(x.into()));
    for (a, b, sharpness) in &polygons.creases {
        [*a, *b, sharpness.to_bits()].into_iter().for_each(|x| add(x.into()));
    }
    for (v, sharpness) in &polygons.corners {
        [*v, sharpness.to_bits()].into_iter().for_each(|x| add(x.into()));
    }
    format!("{hash:016x}")
}
