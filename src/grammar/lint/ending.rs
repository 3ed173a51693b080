//! Rules that may not come to an end.

use super::Kind;
use crate::gml::Diagnostic;
use crate::grammar::pattern::{Label, Pattern, PatternEdge, Test};
use crate::grammar::ruleset::{Rule, RuleSet};

pub(super) fn warnings(set: &RuleSet) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> = set.rules.iter().filter_map(|rule| stays_matched(set, rule)).collect();
    for phase in &set.phases {
        found.extend(circles(set, &set.rules[phase.clone()]));
    }
    found
}

/// Names of the attributes that a pattern tests and of the links it follows.
fn names(pattern: &Pattern) -> impl Iterator<Item = (Kind, &str)> {
    let tests = pattern
        .nodes
        .iter()
        .flat_map(|node| &node.tests)
        .map(|test| (Kind::Attribute, test.attribute.as_str()));
    tests.chain(pattern.edges.iter().filter_map(|edge| Some((Kind::Link, edge.label.link()?))))
}

/// The action touches nothing that the pattern, its `not`s and conditions look at.
fn stays_matched(set: &RuleSet, rule: &Rule) -> Option<Diagnostic> {
    let effects = &rule.effects;
    let alone = effects.annotations.is_empty() && !effects.topology && !effects.moves;
    // A condition may look at anything.
    if effects.sets_more || effects.deletes_more || (!rule.conditions.is_empty() && !alone) {
        return None;
    }
    // Faces and rings look different after an Euler operator; a pattern of single elements does not.
    let is_ring = |edge: &PatternEdge| {
        matches!(edge.label, Label::FaceCcw | Label::FaceCw | Label::VertexCcw | Label::VertexCw)
    };
    if effects.topology && rule.pattern.edges.iter().any(is_ring) {
        return None;
    }
    // Different nodes of a pattern are different elements.
    let takes_off =
        |node: usize, test: &Test| rule.deletes(set, Kind::Attribute, &test.attribute, Some(node));
    let takes = |(kind, name): (Kind, &str)| rule.deletes(set, kind, name, None);
    let gives = |(kind, name): (Kind, &str)| !rule.sets(set, kind, name).is_empty();
    let valued = rule.pattern.nodes.iter().flat_map(|node| &node.tests).filter(|test| test.value.is_some());
    let consumes =
        rule.pattern.nodes.iter().enumerate().any(|(i, node)| node.tests.iter().any(|t| takes_off(i, t)))
            || rule
                .pattern
                .edges
                .iter()
                .filter_map(|edge| edge.label.link())
                .any(|name| takes((Kind::Link, name)))
            || valued.into_iter().any(|test| gives((Kind::Attribute, test.attribute.as_str())))
            || rule
                .forbidden
                .iter()
                .flat_map(|forbidden| names(&forbidden.pattern))
                .any(|name| gives(name) || takes(name));
    (!consumes).then(|| {
        let message = format!(
            "rule {} may never end: its action changes nothing that its pattern looks at, so it matches at the same place again",
            rule.name
        );
        rule.warning(rule.span, message)
    })
}

/// Rules of one phase that make what the next one in the circle needs, without a condition, a comparison or a `not`
/// that could end it.
fn circles(set: &RuleSet, rules: &[Rule]) -> Vec<Diagnostic> {
    let is_bounded = |rule: &Rule| {
        let compared =
            rule.pattern.nodes.iter().flat_map(|node| &node.tests).any(|test| test.value.is_some());
        compared || !rule.conditions.is_empty() || !rule.forbidden.is_empty() || rule.effects.deletes_more
    };
    let feeds = |from: &Rule, to: &Rule| {
        !is_bounded(from) && to.needs().any(|(kind, name, _)| !from.sets(set, kind, name).is_empty())
    };
    let mut found = Vec::new();
    for (start, rule) in rules.iter().enumerate() {
        // Breadth first from the rule back to itself; each circle is told once, at its first rule.
        let mut came: Vec<Option<usize>> = vec![None; rules.len()];
        let mut queue = std::collections::VecDeque::from([start]);
        while let Some(at) = queue.pop_front() {
            for next in (start..rules.len()).filter(|&next| feeds(&rules[at], &rules[next])) {
                if came[next].is_none() {
                    came[next] = Some(at);
                    queue.push_back(next);
                }
            }
        }
        let Some(mut at) = came[start] else { continue };
        let mut circle = vec![rule.name.as_str()];
        while at != start {
            circle.insert(1, &rules[at].name);
            let Some(before) = came[at] else { break };
            at = before;
        }
        let message = match circle.as_slice() {
            [one] => {
                format!("rule {one} may never end: it makes what its own pattern needs, without a condition")
            }
            names => format!(
                "rules {} may never end: each makes what the next one needs, without a condition",
                names.join(", ")
            ),
        };
        found.push(rule.warning(rule.span, message));
    }
    found
}
