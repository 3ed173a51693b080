//! Limits by name: `--limit faces=1000`, `--rule-limit growth=4`.

use std::time::Duration;
use welt::{grammar, io};

/// Sets one limit.
type Set<L> = fn(&mut L, u64);

/// A limit of files and its value.
#[derive(Clone, Copy)]
pub struct Import(Set<io::Limits>, u64);

/// A limit of rules and its value.
#[derive(Clone, Copy)]
pub struct Rules(Set<grammar::Limits>, u64);

impl Import {
    pub fn set(&self, limits: &mut io::Limits) {
        self.0(limits, self.1);
    }
}

impl Rules {
    pub fn set(&self, limits: &mut grammar::Limits) {
        self.0(limits, self.1);
    }
}

const IMPORT: [(&str, Set<io::Limits>); 4] = [
    ("vertices", |limits, most| limits.max_vertices = most),
    ("faces", |limits, most| limits.max_faces = most),
    ("face-vertices", |limits, most| limits.max_arity = most),
    ("vertex-faces", |limits, most| limits.max_valence = most),
];

const RULES: [(&str, Set<grammar::Limits>); 7] = [
    ("applications", |limits, most| limits.applications = most),
    ("steps", |limits, most| limits.steps = most),
    ("changes", |limits, most| limits.edits = most),
    ("depth", |limits, most| limits.depth = usize::try_from(most).unwrap_or(usize::MAX)),
    ("growth", |limits, most| limits.growth = most),
    ("extra", |limits, most| limits.extra = most),
    ("seconds", |limits, most| limits.time = Some(Duration::from_secs(most))),
];

pub fn import(text: &str) -> Result<Import, String> {
    named(text, &IMPORT).map(|(set, most)| Import(set, most))
}

pub fn rules(text: &str) -> Result<Rules, String> {
    named(text, &RULES).map(|(set, most)| Rules(set, most))
}

fn named<F: Copy>(text: &str, known: &[(&str, F)]) -> Result<(F, u64), String> {
    let (name, most) = text.split_once('=').ok_or("write NAME=COUNT")?;
    let names = || known.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let &(_, set) = known
        .iter()
        .find(|(known, _)| *known == name)
        .ok_or_else(|| format!("there is no limit {name}; there are {}", names()))?;
    let most = most.parse().map_err(|_| format!("'{most}' is no whole number from 0 to 2^64 - 1"))?;
    Ok((set, most))
}
