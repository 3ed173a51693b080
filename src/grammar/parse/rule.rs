//! One rule: its pattern, its `not`s and conditions, its action.

use super::expect::{check_free, expect_brace, expect_name, skip_to_keyword};
use super::{MOST_RULES, Reader};
use crate::gml::{Cursor, Diagnostic, Effects, Leaves, Scope, Span, Strings, check, compile_tokens, script};
use crate::grammar::pattern::{Pattern, infer_kinds};
use crate::grammar::plan::{Graph, NodePlan, Step, edges, number_tests};
use crate::grammar::ruleset::{Forbidden, Rule};
use crate::mesh::Domain;
use std::sync::Arc;

impl Reader<'_> {
    pub(super) fn rule(&mut self, cursor: &mut Cursor) -> Result<(), Diagnostic> {
        let source = Arc::clone(cursor.source());
        let (name, span) = expect_name(cursor, "the name of a rule")?;
        if self.rules.rules.len() == MOST_RULES {
            cursor.give_up_at_once();
            return Err(cursor.error(span, format!("there are more than {MOST_RULES} rules")));
        }
        if self.rules.rules.iter().any(|known| known.name == name) {
            self.errors.push(cursor.error(span, format!("rule `{name}` is there twice")));
        }
        let brace = expect_brace(cursor, "the pattern of the rule")?;
        let pattern = Pattern::parse(cursor, brace, &mut self.errors);
        for node in &pattern.nodes {
            if let Err(error) = self.check_node_name(cursor, &node.name, node.span) {
                self.errors.push(error);
            }
        }
        let kinds = infer_kinds(&source, &pattern, Vec::new(), &mut self.errors);
        let nodes: Vec<(String, Domain)> =
            pattern.nodes.iter().map(|node| node.name.clone()).zip(kinds.iter().copied()).collect();
        let names = &mut self.rules.names;
        let place: Vec<usize> = (0..nodes.len()).collect();
        let main_edges = edges(&pattern, &place, names);
        let node_plan =
            |node: &crate::grammar::pattern::PatternNode, domain: Domain, names: &mut Strings| NodePlan {
                domain,
                tests: number_tests(names, &node.tests),
                boundary: node.boundary,
                others: Vec::new(),
            };
        let plans: Vec<NodePlan> =
            pattern.nodes.iter().zip(&kinds).map(|(node, &domain)| node_plan(node, domain, names)).collect();
        let mut graph = Graph { nodes: plans, edges: main_edges };
        let (plan, seeds) = graph.plan();
        let Some(Step::Seed { anchor, to: anchor_node }) = plan.steps.first().cloned() else {
            // Only an empty pattern has no steps, and that was reported.
            skip_to_keyword(cursor);
            return Ok(());
        };
        let mut reach = graph.reach(anchor_node);
        let mut forbidden = Vec::new();
        let mut conditions = Vec::new();
        let mut effects = Effects::default();
        let parameters = self.parameter_names();
        let action = loop {
            cursor.skip_space();
            let start = cursor.offset();
            let before = cursor.clone();
            let part = cursor.name();
            let part_span = if part.is_empty() { cursor.span_here() } else { cursor.span_from(start) };
            match part.as_str() {
                "not" => {
                    let brace = expect_brace(cursor, "a pattern")?;
                    let inner = Pattern::parse(cursor, brace, &mut self.errors);
                    let mut place = Vec::new();
                    let mut known = Vec::new();
                    let mut count = nodes.len();
                    for node in &inner.nodes {
                        let main = nodes.iter().position(|(name, _)| *name == node.name);
                        known.push(main.map(|index| nodes[index].1));
                        place.push(main.unwrap_or(count));
                        if main.is_none() {
                            count += 1;
                            if let Err(error) = self.check_node_name(cursor, &node.name, node.span) {
                                self.errors.push(error);
                            }
                        }
                    }
                    let kinds = infer_kinds(&source, &inner, known, &mut self.errors);
                    let names = &mut self.rules.names;
                    let mut all = graph.nodes.clone();
                    let mut tests = Vec::new();
                    for ((node, &domain), &at) in inner.nodes.iter().zip(&kinds).zip(&place) {
                        if at >= nodes.len() {
                            all.push(node_plan(node, domain, names));
                        } else if !node.tests.is_empty() || node.boundary {
                            let further = number_tests(names, &node.tests);
                            tests.push(Step::Test { node: at, tests: further, boundary: node.boundary });
                        }
                    }
                    let own = edges(&inner, &place, names);
                    let mut rest = Graph { nodes: all, edges: own };
                    let (mut plan, seeds) = rest.plan_rest(nodes.len());
                    if seeds > 0 {
                        self.errors.push(
                            cursor
                                .error(part_span, "a part of this `not` is not joined to the rule's pattern"),
                        );
                    }
                    plan.steps.splice(0..0, tests);
                    let mut joined = Graph { nodes: rest.nodes.clone(), edges: graph.edges.clone() };
                    joined.edges.extend(rest.edges.iter().copied());
                    reach.extend(joined.reach(anchor_node).into_iter().skip(nodes.len()));
                    forbidden.push(Forbidden { pattern: inner, span: part_span, plans: rest.nodes, plan });
                }
                "where" | "action" => {
                    let brace = expect_brace(cursor, "a script")?;
                    let tokens = script(cursor, Some(brace), &mut self.errors);
                    let end = cursor.offset();
                    let end = Span { start: end.saturating_sub(1), end };
                    let scope = Scope { nodes: &nodes, parameters: &parameters, read_only: part == "where" };
                    let strings = &mut self.rules.strings;
                    let mistakes = self.errors.len();
                    let program = compile_tokens(
                        &source,
                        &tokens,
                        end,
                        &scope,
                        &self.definitions,
                        strings,
                        &mut self.errors,
                    );
                    if mistakes == self.errors.len() {
                        let leaves = if part == "action" { Leaves::Nothing } else { Leaves::OneNumber };
                        let checked = check(&program, leaves);
                        self.errors.extend(checked.mistake);
                        self.rules.script_warnings.extend(checked.warnings);
                        effects = checked.effects;
                    }
                    if part == "action" {
                        break program;
                    }
                    conditions.push(program);
                }
                _ => {
                    *cursor = before;
                    return Err(cursor.error(
                        part_span,
                        format!("expected `not`, `where` or `action` of rule `{name}` here"),
                    ));
                }
            }
        };
        self.rules.rules.push(Rule {
            name,
            phase: self.phase.clone(),
            source,
            span,
            nodes,
            pattern,
            plans: graph.nodes,
            plan,
            anchor,
            anchor_node,
            forbidden,
            looks_further: !conditions.is_empty() || seeds > 1,
            conditions,
            action,
            effects,
            reach,
        });
        Ok(())
    }

    fn check_node_name(&self, cursor: &Cursor, name: &str, span: Span) -> Result<(), Diagnostic> {
        check_free(cursor, name, span)?;
        if self.rules.parameters.iter().any(|parameter| parameter.name == name) {
            return Err(
                cursor.error(span, format!("`{name}` is a parameter; a node needs a name of its own"))
            );
        }
        if self.definitions.iter().any(|definition| definition.name == name) {
            return Err(cursor.error(span, format!("`{name}` is defined above; a node needs another name")));
        }
        Ok(())
    }
}
