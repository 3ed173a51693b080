//! Why a run ended before it came to its end, and where.

use super::Run;
use crate::gml::{Failure, Fault, Program, Stop};
use crate::grammar::error::{Place, RunError};
use crate::grammar::ruleset::Rule;
use crate::job::Cancelled;
use crate::mesh::{FaceId, Node};

/// Why a search for a match ended early.
pub(in super::super) enum Failed {
    Stopped(Stop),
    Script(usize, Failure),
    NotOneNumber(usize),
}

impl From<Stop> for Failed {
    fn from(stop: Stop) -> Self {
        Self::Stopped(stop)
    }
}

impl Run<'_> {
    pub(in super::super) fn failed(&self, rule: &Rule, failed: Failed) -> RunError {
        match failed {
            Failed::Stopped(stop) => self.stopped(stop, rule),
            Failed::Script(condition, failure) => {
                self.script_error(rule, &rule.conditions[condition], &failure)
            }
            Failed::NotOneNumber(condition) => {
                let program = &rule.conditions[condition];
                let failure = Failure {
                    fault: Fault::Error("a condition must leave one number, and nothing else".to_owned()),
                    op: program.last_op(),
                };
                self.script_error(rule, program, &failure)
            }
        }
    }

    pub(super) fn place(&self, rule: &Rule) -> Place {
        let nodes = rule.nodes.iter().zip(&self.bound);
        Place::new(self.mesh, nodes.map(|((name, domain), &id)| (name.as_str(), Node::new(*domain, id))))
    }

    pub(super) fn script_error(&self, rule: &Rule, program: &Program, failure: &Failure) -> RunError {
        let message = match &failure.fault {
            Fault::Error(message) => message.clone(),
            Fault::Thrown(value) => format!("the script threw {value} and nothing caught it"),
            Fault::Stopped(stop) => return self.stopped(*stop, rule),
        };
        RunError::Script {
            rule: rule.name.clone(),
            place: self.place(rule),
            diagnostic: Box::new(program.error(failure.op, message)),
        }
    }

    pub(super) fn stopped(&self, stop: Stop, rule: &Rule) -> RunError {
        match stop {
            Stop::Cancelled => RunError::Cancelled(Cancelled),
            Stop::Steps => self.runaway(format!("more than {} steps", self.limits.steps), rule),
            Stop::Edits => self.runaway(format!("more than {} changes of the mesh", self.limits.edits), rule),
            Stop::Elements => {
                let most = self.limits.allowance(self.elements).elements;
                let limit =
                    format!("more than {most} vertices, edges and faces, which were {}", self.elements);
                self.runaway(limit, rule)
            }
            Stop::Time => {
                let time = self.limits.time.unwrap_or_default();
                self.runaway(format!("more than {} s", time.as_secs_f64()), rule)
            }
        }
    }

    pub(super) fn runaway(&self, limit: String, rule: &Rule) -> RunError {
        RunError::Runaway {
            diagnostic: rule.diagnostic(&format!("{limit}, here in rule {}", rule.name)),
            limit,
            rule: rule.name.clone(),
            place: self.place(rule),
        }
    }

    pub(super) fn broken(&self, face: FaceId, problem: String) -> RunError {
        let last = self.touched.iter().rev().find(|(touched, _)| *touched == face);
        let rule = &self.rules.rules[last.map_or(0, |(_, rule)| *rule as usize)];
        let message =
            format!("rule {} was the last to change {}", rule.name, self.mesh.describe(Node::Face(face)));
        let position = self.mesh.place(Node::Face(face));
        RunError::BrokenFace {
            rule: rule.name.clone(),
            problem,
            position,
            diagnostic: rule.diagnostic(&message),
        }
    }
}
