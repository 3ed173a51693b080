//! Patterns that nothing can match.

use super::shape::Shape;
use crate::gml::Diagnostic;
use crate::grammar::pattern::{Comparison, PatternNode, Test};
use crate::grammar::ruleset::{Forbidden, Rule, RuleSet};
use crate::grammar::search::compare;
use crate::mesh::Value;

pub(super) fn warnings(_set: &RuleSet, rule: &Rule) -> Vec<Diagnostic> {
    let never = |message: String| format!("rule {} never matches: {message}", rule.name);
    let mut found = Vec::new();
    for node in &rule.pattern.nodes {
        found.extend(tests(node).map(|(test, message)| rule.warning(test.span, never(message))));
    }
    if let Err((edge, message)) = Shape::of(rule) {
        let span = edge.map_or(rule.span, |edge| rule.pattern.edges[edge].span);
        found.push(rule.warning(span, never(message)));
    }
    for forbidden in rule.forbidden.iter().filter(|forbidden| is_implied(rule, forbidden)) {
        found.push(
            rule.warning(forbidden.span, never("its pattern holds what this `not` excludes".to_owned())),
        );
    }
    found
}

/// The first test of a node that no value can pass together with those before it.
fn tests(node: &PatternNode) -> Option<(&Test, String)> {
    node.tests.iter().enumerate().find_map(|(i, test)| {
        let same: Vec<(Comparison, &Value)> = node.tests[..=i]
            .iter()
            .filter(|other| other.attribute == test.attribute)
            .filter_map(|other| other.value.as_ref().map(|(comparison, value)| (*comparison, value)))
            .collect();
        (!is_possible(&same))
            .then(|| (test, format!("no value of `{}` passes all of its tests", test.attribute)))
    })
}

/// Some value passes all tests. Candidates are the values themselves, and numbers between and around them.
fn is_possible(tests: &[(Comparison, &Value)]) -> bool {
    let mut numbers: Vec<f64> = tests.iter().filter_map(|(_, value)| value.as_number()).collect();
    numbers.sort_by(f64::total_cmp);
    let between: Vec<f64> = numbers.windows(2).map(|pair| f64::midpoint(pair[0], pair[1])).collect();
    let around: Vec<f64> =
        numbers.first().map(|x| x - 1.0).into_iter().chain(numbers.last().map(|x| x + 1.0)).collect();
    let numbers = numbers.into_iter().chain(between).chain(around).map(Value::Number);
    // A text that is like no other passes where no number is wanted.
    let texts = tests.iter().map(|(_, value)| (*value).clone()).chain([Value::text("\0")]);
    numbers
        .chain(texts)
        .any(|value| tests.iter().all(|(comparison, wanted)| compare(&value, *comparison, wanted)))
}

/// Whatever matches the rule's pattern matches the `not`, too: it says nothing that the pattern does not say.
fn is_implied(rule: &Rule, forbidden: &Forbidden) -> bool {
    let main = |name: &str| rule.pattern.nodes.iter().find(|node| node.name == name);
    let node_of = |index: usize| forbidden.pattern.nodes[index].name.as_str();
    forbidden.pattern.nodes.iter().all(|node| {
        main(&node.name).is_some_and(|known| {
            (known.boundary || !node.boundary) && node.tests.iter().all(|test| implies(known, test))
        })
    }) && forbidden.pattern.edges.iter().all(|edge| {
        rule.pattern.edges.iter().any(|known| {
            let name = |index: usize| rule.pattern.nodes[index].name.as_str();
            known.label == edge.label
                && name(known.from) == node_of(edge.from)
                && name(known.to) == node_of(edge.to)
        })
    })
}

fn implies(node: &PatternNode, test: &Test) -> bool {
    node.tests
        .iter()
        .any(|known| known.attribute == test.attribute && (test.value.is_none() || known.value == test.value))
}
