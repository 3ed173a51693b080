//! Applying rules where a trace says, instead of where they match first.

use super::error::RunError;
use super::plan::{Choice, Hop, Step};
use super::ruleset::Rule;
use super::run::Run;
use super::search::{View, bind};
use super::trace::{Application, Pass, digest};
use crate::mesh::Node;

impl Run<'_> {
    /// Does what `pass` says; `None` when the trace holds no further run.
    pub(super) fn follow(&mut self, pass: Option<&Pass>) -> Result<(), RunError> {
        let Some(pass) = pass else {
            return Err(differs(None, "the trace ends before this run of the rules"));
        };
        if digest(self.mesh) != pass.before {
            return Err(differs(None, "the mesh is not the one the trace was made on"));
        }
        for (i, application) in pass.applications.iter().enumerate() {
            let step = Some((i + 1, application));
            let rule = self.rules.rules.iter().position(|rule| rule.name == application.rule);
            let rule = rule.ok_or_else(|| differs(step, "there is no such rule"))?;
            let nodes =
                application.elements().filter(|nodes| nodes.len() == self.rules.rules[rule].nodes.len());
            let nodes = nodes.ok_or_else(|| differs(step, "the rule has other nodes"))?;
            if !self.matches_at(rule, &nodes)? {
                return Err(differs(step, "the rule does not match there"));
            }
            self.apply_here(rule)?;
        }
        if digest(self.mesh) != pass.after {
            return Err(differs(None, "the mesh after the last step is another one"));
        }
        Ok(())
    }

    /// True when the rule matches just there; the match is in `bound` then.
    fn matches_at(&mut self, number: usize, nodes: &[Node]) -> Result<bool, RunError> {
        let rule = &self.rules.rules[number];
        let view = View { mesh: self.mesh, symbols: &self.symbols };
        let fits = rule.plan.steps.iter().all(|step| match step {
            Step::Hop { from, hop, to } => {
                bind_to(view, rule, *to, nodes, &mut self.bound) && view.leads(nodes[*from], *hop, nodes[*to])
            }
            Step::Seed { to, .. } => bind_to(view, rule, *to, nodes, &mut self.bound),
            Step::Check { from, via, to } => view.leads(nodes[*from], Hop::One(*via), nodes[*to]),
            Step::CheckLink { from, label, to } => {
                view.leads(nodes[*from], Hop::Many(Choice::Link(*label)), nodes[*to])
            }
            Step::Test { .. } => true,
        });
        Ok(fits && self.stands(rule).map_err(|failed| self.failed(rule, failed))?)
    }
}

/// Binds node `to` to the element that the trace names.
fn bind_to(view: View<'_>, rule: &Rule, to: usize, nodes: &[Node], bound: &mut [u32]) -> bool {
    let (node, plan) = (nodes[to], &rule.plans[to]);
    node.domain() == plan.domain && view.mesh.has_node(node) && bind(view, plan, node.id(), bound, to)
}

fn differs(step: Option<(usize, &Application)>, problem: &str) -> RunError {
    let place = step.map_or(String::new(), |(step, application)| {
        format!(" at step {step}, rule {} at {}", application.rule, application.place())
    });
    RunError::Replay { problem: format!("{problem}{place}") }
}
