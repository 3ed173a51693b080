//! Whether a rule matches at an anchor.

use super::{Failed, Run};
use crate::gml::{Environment, Value};
use crate::grammar::ruleset::Rule;
use crate::grammar::search::{View, bind};
use crate::mesh::Node;

impl Run<'_> {
    /// Looks for a match with its anchor at `id`; the match is in `bound`.
    pub(super) fn find(&mut self, rule: &Rule, id: u32) -> Result<bool, Failed> {
        let view = View { mesh: self.mesh, symbols: &self.symbols };
        let node = &rule.plans[rule.anchor_node];
        if !view.mesh.has_node(Node::new(node.domain, id))
            || !bind(view, node, id, &mut self.bound, rule.anchor_node)
        {
            return Ok(false);
        }
        let mut found =
            self.search.start(view, &rule.plan, &rule.plans, 1, &mut self.bound, &mut self.budget)?;
        while found {
            if self.stands(rule)? {
                return Ok(true);
            }
            let view = View { mesh: self.mesh, symbols: &self.symbols };
            found = self.search.resume(view, &rule.plan, &rule.plans, &mut self.bound, &mut self.budget)?;
        }
        Ok(false)
    }

    /// No `not` excludes the match in `bound`, and the conditions hold.
    pub(in super::super) fn stands(&mut self, rule: &Rule) -> Result<bool, Failed> {
        Ok(!self.is_forbidden(rule)? && self.conditions_hold(rule)?)
    }

    fn is_forbidden(&mut self, rule: &Rule) -> Result<bool, Failed> {
        let view = View { mesh: self.mesh, symbols: &self.symbols };
        for forbidden in &rule.forbidden {
            let search = &mut self.forbidden_search;
            if search.start(view, &forbidden.plan, &forbidden.plans, 0, &mut self.bound, &mut self.budget)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn conditions_hold(&mut self, rule: &Rule) -> Result<bool, Failed> {
        for (i, condition) in rule.conditions.iter().enumerate() {
            let mut environment = Environment {
                mesh: self.mesh,
                nodes: &self.bound,
                parameters: self.parameters,
                examples: self.examples,
                budget: &mut self.budget,
            };
            self.machine.run(condition, &mut environment).map_err(|failure| Failed::Script(i, failure))?;
            match self.machine.stack() {
                [Value::Number(truth)] => {
                    if *truth == 0.0 {
                        return Ok(false);
                    }
                }
                _ => return Err(Failed::NotOneNumber(i)),
            }
        }
        Ok(true)
    }
}
