//! One application of a rule, and what can match anew after it.

use super::{MOST_RECORDED, Run};
use crate::fault;
use crate::gml::{Environment, Failure, Fault};
use crate::grammar::error::RunError;
use crate::grammar::plan::{Hop, Reach};
use crate::grammar::search::View;
use crate::grammar::trace::Application;
use crate::mesh::{Checkpoint, Node};

impl Run<'_> {
    /// Runs the action of a rule on the match in `bound`.
    pub(in super::super) fn apply_here(&mut self, number: usize) -> Result<(), RunError> {
        let rule = &self.rules.rules[number];
        if self.total >= self.limits.applications {
            let limit = format!("more than {} applications", self.limits.applications);
            return Err(self.runaway(limit, rule));
        }
        if let Some(recorded) = &self.recorded {
            if recorded.len() >= MOST_RECORDED {
                let limit = format!("more than {MOST_RECORDED} applications, which no trace can hold");
                return Err(self.runaway(limit, rule));
            }
            let application = Application::new(&rule.name, &self.place(rule));
            self.recorded.get_or_insert_default().push(application);
        }
        let before = self.mesh.log_position();
        let mut environment = Environment {
            mesh: self.mesh,
            nodes: &self.bound,
            parameters: self.parameters,
            examples: self.examples,
            budget: &mut self.budget,
        };
        let failure = self.machine.run(&rule.action, &mut environment).err().or_else(|| {
            let left: Vec<String> =
                self.machine.stack().iter().map(|value| self.machine.show(value, self.mesh)).collect();
            (!left.is_empty()).then(|| {
                let message = format!("the action must leave the stack empty, but leaves {}", left.join(" "));
                Failure { fault: Fault::Error(message), op: rule.action.last_op() }
            })
        });
        if let Some(failure) = failure {
            // The place is told as it was when the rule was applied.
            self.mesh.rollback(before);
            return Err(self.script_error(rule, &rule.action, &failure));
        }
        self.counts[number] += 1;
        self.total += 1;
        fault::point("rules");
        self.after(number, before);
        Ok(())
    }

    /// Notes the faces that the application changed and queues the anchors from which the changes can be seen.
    fn after(&mut self, number: usize, before: Checkpoint) {
        let mesh = &*self.mesh;
        self.changed.clear();
        self.changed.extend(mesh.touched_since(before).map(Node::HalfEdge));
        self.changed.extend(mesh.annotated_since(before));
        self.changed.sort_unstable();
        self.changed.dedup();
        self.changed.retain(|&node| mesh.has_node(node));
        self.faces.clear();
        for h in mesh.touched_since(before).filter(|&h| mesh.has_half_edge(h)) {
            self.faces.push(mesh.face(h));
        }
        for v in mesh.moved_since(before).filter(|&v| mesh.has_vertex(v)) {
            self.faces.extend(mesh.outgoing(v).map(|h| mesh.face(h)));
        }
        self.faces.sort_unstable();
        self.faces.dedup();
        let real = self.faces.iter().filter(|face| !face.is_boundary());
        self.touched.extend(real.map(|&face| (face, number as u32)));

        let view = View { mesh, symbols: &self.symbols };
        for index in self.phase.clone() {
            let rule = &self.rules.rules[index];
            let plan = &rule.plans[rule.anchor_node];
            self.near.clear();
            for &node in &self.changed {
                for reach in rule.reach.iter().filter(|reach| reach.domain == node.domain()) {
                    anchors(view, node, reach, &mut self.walk, &mut self.near);
                }
            }
            // Looked at once each: the test of an attribute costs more than the walks.
            self.near.sort_unstable();
            self.near.dedup();
            for &id in &self.near {
                if view.may_anchor(Node::new(plan.domain, id), plan, &rule.anchor) {
                    self.queues[index].push(id);
                }
            }
        }
    }
}

/// Adds the anchors from which `node` can be seen by `reach` to `found`.
fn anchors(view: View<'_>, node: Node, reach: &Reach, lists: &mut [Vec<u32>; 2], found: &mut Vec<u32>) {
    if reach.single {
        found.push(reach.path.iter().fold(node.id(), |id, hop| match hop {
            Hop::One(via) => view.follow(*via, id),
            Hop::Many(_) => id,
        }));
        return;
    }
    lists[0].clear();
    lists[0].push(node.id());
    let mut domain = node.domain();
    for (hop, next) in reach.path.iter().zip(&reach.domains) {
        let [from, to] = lists;
        to.clear();
        for &id in from.iter() {
            view.neighbours(Node::new(domain, id), *hop, *next, to);
        }
        domain = *next;
        lists.swap(0, 1);
    }
    found.extend_from_slice(&lists[0]);
}
