//! Attributes and links that nobody brings, and those that stay.

use super::Kind;
use crate::gml::Diagnostic;
use crate::grammar::pattern::Test;
use crate::grammar::plan::Anchor;
use crate::grammar::ruleset::{Rule, RuleSet};
use crate::grammar::search::compare;
use crate::mesh::Value;

pub(super) fn warnings(set: &RuleSet, rule: &Rule) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let sets_all = !set.rules.iter().any(|rule| rule.effects.sets_more);
    for (kind, name, span) in rule.needs().filter(|_| sets_all) {
        if set.is_input(kind, name) {
            continue;
        }
        if !set.rules.iter().any(|other| !other.sets(set, kind, name).is_empty()) {
            let what = if kind == Kind::Attribute { "attribute" } else { "link" };
            let message = format!(
                "this never matches: no rule sets the {what} `{name}`; declare it if the caller does: input {name} \"...\""
            );
            found.push(rule.warning(span, message));
        }
    }
    for test in rule.pattern.nodes.iter().flat_map(|node| &node.tests).filter(|_| sets_all) {
        found.extend(no_such_value(set, rule, test));
    }
    found.extend(left_behind(set, rule));
    found
}

/// All values that the rules give to the attribute are written down, and none passes the test.
fn no_such_value(set: &RuleSet, rule: &Rule, test: &Test) -> Option<Diagnostic> {
    let (comparison, wanted) = test.value.as_ref()?;
    if set.is_input(Kind::Attribute, &test.attribute) {
        return None;
    }
    let sets = set.rules.iter().flat_map(|rule| rule.sets(set, Kind::Attribute, &test.attribute));
    let values: Option<Vec<Value>> = sets.collect();
    let values = values.filter(|values| !values.is_empty())?;
    if values.iter().any(|value| compare(value, *comparison, wanted)) {
        return None;
    }
    let message = format!("this never matches: the rules give other values to `{}` only", test.attribute);
    Some(rule.warning(test.span, message))
}

/// The mark at which the rule starts is not taken off by any rule.
fn left_behind(set: &RuleSet, rule: &Rule) -> Option<Diagnostic> {
    let (kind, name) = match &rule.anchor {
        Anchor::Value(_, name, _) | Anchor::Attribute(_, name) => (Kind::Attribute, *name),
        Anchor::Linked(_, name) => (Kind::Link, *name),
        Anchor::All(_) => return None,
    };
    let name = set.names.iter().nth(name)?;
    let changes = |other: &Rule| {
        let test = |test: &Test| test.attribute == name && test.value.is_some();
        let tested = rule.pattern.nodes.iter().flat_map(|node| &node.tests).any(test);
        other.effects.deletes_more
            || other.deletes(set, kind, name, None)
            || (tested && !other.sets(set, kind, name).is_empty())
    };
    if set.rules.iter().any(changes) {
        return None;
    }
    let (_, _, span) = rule.needs().find(|(k, n, _)| *k == kind && *n == name)?;
    let message = format!("no rule takes `{name}` away: it stays on the mesh as if nothing had handled it");
    Some(rule.warning(span, message))
}
