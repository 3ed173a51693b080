//! What differs between the mesh that a case expects and the one that the rules made.

use super::TOLERANCE;
use super::sketch::{Element, Sketch};
use crate::mesh::{Mesh, Value};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// A statement of a case without its value: its rank in a list, and its text.
type Statement = (u8, String);

/// Statements that were expected (`-`) or found (`+`) only; `None` when there are none.
pub(super) fn difference(
    expected: &Sketch,
    mesh: &Mesh,
    (fired, counts): (&BTreeMap<String, u64>, BTreeMap<String, u64>),
) -> Option<String> {
    let mut new = 0;
    let mut free = vec![true; expected.vertices.len()];
    let found = Sketch::of_mesh(mesh, |position| {
        let here = |v: &usize| free[*v] && near_points(expected.vertices[*v].position, position);
        if let Some(v) = (0..free.len()).find(here) {
            free[v] = false;
            return expected.vertices[v].name.clone();
        }
        new += 1;
        format!("new{new}")
    });
    let mut report = Vec::new();
    if *fired != counts {
        report.extend([format!("- {}", show_fired(fired)), format!("+ {}", show_fired(&counts))]);
    }
    let [expected, found] = [expected, &found].map(statements);
    let all: BTreeSet<&Statement> = expected.keys().chain(found.keys()).collect();
    for statement in all {
        let (wanted, is) = (expected.get(statement), found.get(statement));
        if wanted.zip(is).is_some_and(|(a, b)| near(a.as_ref(), b.as_ref())) {
            continue;
        }
        report.extend(wanted.map(|value| format!("- {}", show(statement, value.as_ref()))));
        report.extend(is.map(|value| format!("+ {}", show(statement, value.as_ref()))));
    }
    (!report.is_empty()).then(|| report.join("\n"))
}

/// What a sketch says, one statement per fact.
fn statements(sketch: &Sketch) -> BTreeMap<Statement, Option<Value>> {
    let element = |element: &Element| {
        let (rank, letter) = match element.len() {
            1 => (2, 'v'),
            2 => (4, 'h'),
            _ => (3, 'f'),
        };
        (rank, format!("{letter} {}", sketch.names(element)))
    };
    let vertices = sketch
        .vertices
        .iter()
        .map(|vertex| ((0, format!("v {}", vertex.name)), Some(Value::Vector(vertex.position))));
    let faces = sketch.faces.iter().map(|face| ((1, element(face).1), None));
    let attributes = sketch.attributes.iter().map(|(node, name, value)| {
        let (rank, node) = element(node);
        ((rank, format!("{node} {name}=")), Some(value.clone()))
    });
    let links = sketch.links.iter().map(|(from, label, to)| {
        let (rank, from) = element(from);
        ((rank, format!("{from} {label}> {}", sketch.names(to))), None)
    });
    let sharp = sketch.sharp.iter().map(|(element, sharpness)| {
        let mut element = element.clone();
        element.sort_by_key(|&v| &sketch.vertices[v].name);
        let keyword = if element.len() == 1 { "corner" } else { "crease" };
        ((5, format!("{keyword} {} ", sketch.names(&element))), Some(Value::Number(*sharpness)))
    });
    vertices.chain(faces).chain(attributes).chain(links).chain(sharp).collect()
}

fn near_points(a: DVec3, b: DVec3) -> bool {
    a.distance(b) <= TOLERANCE
}

fn near(a: Option<&Value>, b: Option<&Value>) -> bool {
    let close = |a: f64, b: f64| (a - b).abs() <= TOLERANCE;
    match (a, b) {
        (Some(Value::Number(a)), Some(Value::Number(b))) => close(*a, *b),
        (Some(Value::Vector(a)), Some(Value::Vector(b))) => near_points(*a, *b),
        (Some(Value::Numbers(a)), Some(Value::Numbers(b))) => {
            a.len() == b.len() && a.iter().zip(b.iter()).all(|(a, b)| close(*a, *b))
        }
        (a, b) => a == b,
    }
}

fn show((rank, text): &Statement, value: Option<&Value>) -> String {
    match value {
        None => text.clone(),
        Some(Value::Vector(p)) if *rank == 0 => {
            format!("{text} {} {} {}", number(p.x), number(p.y), number(p.z))
        }
        Some(Value::Number(x)) => format!("{text}{}", number(*x)),
        Some(Value::Text(word)) => format!("{text}\"{word}\""),
        Some(Value::Vector(p)) => format!("{text}({}, {}, {})", number(p.x), number(p.y), number(p.z)),
        Some(Value::Numbers(numbers)) => {
            let list: Vec<String> = numbers.iter().copied().map(number).collect();
            format!("{text}[{}]", list.join(", "))
        }
    }
}

/// As many digits as the comparison looks at, and some more.
fn number(x: f64) -> String {
    ((x * 1e9).round() / 1e9 + 0.0).to_string()
}

fn show_fired(fired: &BTreeMap<String, u64>) -> String {
    let list: Vec<String> = fired.iter().map(|(name, count)| format!("{name} {count}")).collect();
    format!("fired {}", list.join(", "))
}
