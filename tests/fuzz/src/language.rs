//! Texts that people write: rule files, scripts, profiles; and traces, which the program wrote.

use super::models::{cube, sheet};
use std::time::Duration;
use welt::feature::Profile;
use welt::gml::{Budget, Environment, Machine, Scope, Source, Strings, compile};
use welt::grammar::{Limits, RuleSet, RunOptions, Sample, Trace, run};
use welt::mark::{Selection, Selector, place};
use welt::mesh::{Domain, VertexId};

const LIMITS: Limits = Limits {
    applications: 200,
    steps: 50_000,
    edits: 5_000,
    depth: 100,
    growth: 8,
    extra: 1000,
    time: Some(Duration::from_secs(2)),
};

/// A rule file: checked, drawn, run on a marked sheet.
pub fn rules(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let rules = match RuleSet::parse("fuzz.rules", text, &|_| None) {
        Ok(rules) => rules,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return false;
        }
    };
    rules.warnings();
    if rules.rules().len() <= 8 {
        for rule in rules.rules() {
            let _ = Sample::new(&rules, rule);
        }
    }
    let mut mesh = sheet();
    let selectors = ["ring:0,1", "edge:6,7@0.3#blue"].map(|text| Selector::parse(text).expect("a selector"));
    let selection = Selection::resolve(&mesh, &selectors).expect("edges of the sheet");
    place(&mut mesh, &selection.marks);
    let before = mesh.to_polygons();
    let options = RunOptions { limits: LIMITS, ..RunOptions::default() };
    match run(&rules, &mut mesh, &options) {
        Ok(_) => {
            mesh.validate().expect("a valid mesh");
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            assert!(mesh.to_polygons() == before, "{error}: the mesh was changed");
            false
        }
    }
}

/// The action of a rule, on a cube.
pub fn script(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let mut mesh = cube();
    let edge = mesh.find_half_edge(VertexId(0), VertexId(1)).expect("an edge of the cube");
    let nodes = [("e".to_owned(), Domain::HalfEdge), ("v".to_owned(), Domain::Vertex)];
    let scope = Scope { nodes: &nodes, parameters: &["width".to_owned()], read_only: false };
    let source = Source::new("fuzz", text);
    let mut strings = Strings::default();
    let Ok(program) = compile(&source, &scope, &mut strings) else { return false };
    let checkpoint = mesh.begin();
    let mut machine = Machine::new(&strings);
    let mut budget = Budget::new(LIMITS.allowance(mesh.element_count()), None, None);
    let mut environment = Environment {
        mesh: &mut mesh,
        nodes: &[edge.0, 7],
        parameters: &[0.25],
        examples: None,
        budget: &mut budget,
    };
    let ran = machine.run(&program, &mut environment).is_ok();
    if ran {
        for value in machine.stack() {
            machine.show(value, &mesh);
        }
    }
    mesh.rollback(checkpoint);
    assert!(mesh.to_polygons() == cube().to_polygons(), "the cube was not restored");
    ran
}

/// A profile file.
pub fn profile(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    match Profile::parse("fuzz.toml", text) {
        Ok(_) => true,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// A trace.
pub fn trace(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let Ok(trace) = Trace::from_lines(text) else { return false };
    let again = trace.to_lines().expect("numbers that came from JSON");
    assert_eq!(Trace::from_lines(&again).ok().and_then(|t| t.to_lines().ok()), Some(again));
    true
}
