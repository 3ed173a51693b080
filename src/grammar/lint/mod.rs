//! Warnings about rules that can be read, but are probably not what was meant.

mod contradiction;
mod ending;
mod shape;
mod supply;

pub(super) use shape::{Shape, Side};

use super::ruleset::{Rule, RuleSet};
use crate::gml::{Diagnostic, Op, Span, Value as Script, Word};
use crate::mesh::Value;

/// Attributes that marks bring (`mark::place`).
const OF_MARKS: [&str; 2] = ["color", "t"];

/// All warnings about `set`, in the order of the text.
pub(super) fn warnings(set: &RuleSet) -> Vec<Diagnostic> {
    let mut found = set.script_warnings.clone();
    found.extend(unused_parameters(set));
    for rule in &set.rules {
        found.extend(contradiction::warnings(set, rule));
        found.extend(supply::warnings(set, rule));
    }
    found.extend(ending::warnings(set));
    found.sort_by(|a, b| (&a.file, a.offset()).cmp(&(&b.file, b.offset())));
    found
}

fn unused_parameters(set: &RuleSet) -> impl Iterator<Item = Diagnostic> {
    let uses = |index: usize| {
        let programs = set.rules.iter().flat_map(|rule| rule.conditions.iter().chain([&rule.action]));
        programs.flat_map(|program| &program.ops).any(|op| *op == Op::Parameter(index as u32))
    };
    let unused = set.parameters.iter().zip(&set.declared).enumerate().filter(move |(i, _)| !uses(*i));
    unused.map(|(_, (parameter, (source, span)))| {
        let message = format!("no rule uses the parameter `{}`", parameter.name);
        Diagnostic::new(source, *span, message).into_warning()
    })
}

/// A name that patterns and scripts use: an attribute, or the label of a link.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Attribute,
    Link,
}

impl Rule {
    fn warning(&self, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(&self.source, span, message).into_warning()
    }

    /// Everything the pattern asks for: kind, name, and place of an attribute or link.
    fn needs(&self) -> impl Iterator<Item = (Kind, &str, Span)> {
        let tests = self.pattern.nodes.iter().flat_map(|node| &node.tests);
        let links =
            self.pattern.edges.iter().filter_map(|edge| edge.label.link().map(|name| (name, edge.span)));
        tests
            .map(|test| (Kind::Attribute, test.attribute.as_str(), test.span))
            .chain(links.map(|(name, span)| (Kind::Link, name, span)))
    }

    /// The values that the action gives to `name`; `None` for one that is not written in the script.
    fn sets(&self, set: &RuleSet, kind: Kind, name: &str) -> Vec<Option<Value>> {
        let word = if kind == Kind::Attribute { Word::AttrSet } else { Word::LinkSet };
        self.annotations(set, word, name)
            .map(|value| match value {
                Some(Script::Number(x)) => Some(Value::Number(x)),
                Some(Script::Text(id)) => Some(Value::text(&set.strings.get(id))),
                _ => None,
            })
            .collect()
    }

    /// The action takes `name` off some element; where `node` is given, off one that may be this node of the pattern.
    fn deletes(&self, set: &RuleSet, kind: Kind, name: &str, node: Option<usize>) -> bool {
        let word = if kind == Kind::Attribute { Word::AttrDel } else { Word::LinkDel };
        let mut effects = self.effects.annotations.iter();
        effects.any(|effect| {
            let elsewhere = effect.node.zip(node).is_some_and(|(there, here)| there as usize != here);
            effect.word == word && *set.strings.get(effect.key) == *name && !elsewhere
        })
    }

    fn annotations(&self, set: &RuleSet, word: Word, name: &str) -> impl Iterator<Item = Option<Script>> {
        let effects = self.effects.annotations.iter();
        effects
            .filter(move |effect| effect.word == word && *set.strings.get(effect.key) == *name)
            .map(|effect| effect.value)
    }
}

impl RuleSet {
    /// The caller brings it.
    fn is_input(&self, kind: Kind, name: &str) -> bool {
        self.inputs.iter().any(|input| input.name == name)
            || (kind == Kind::Attribute && OF_MARKS.contains(&name))
    }
}
