//! Running rules until none matches.

mod apply;
mod failure;
mod find;

use failure::Failed;

use super::error::RunError;
use super::queue::Queue;
use super::ruleset::{Examples, RuleSet};
use super::search::{Search, View};
use super::trace::{Application, Pass, Tracer, digest};
use crate::gml::{Allowance, Budget, Machine};
use crate::job::Job;
use crate::mesh::{FaceId, Mesh, Node, Symbol};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What a run may cost.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Applications of rules.
    pub applications: u64,
    /// Steps of scripts and of the search for matches.
    pub steps: u64,
    /// Changes that scripts make to the mesh: each element made or removed, each vertex moved, each attribute, link and
    /// sharpness set counts. Bounds the memory, about 150 bytes each at most.
    pub edits: u64,
    /// Procedures and loops of a script that may be open inside one another.
    pub depth: usize,
    /// The mesh may have this many times as many vertices, edges and faces as before, together,
    pub growth: u64,
    /// and this many more.
    pub extra: u64,
    /// Time; `None` for as long as it takes. A run that ends by time is not reproducible.
    pub time: Option<Duration>,
}

impl Default for Limits {
    /// 10 million applications, 10^9 steps, 20 million changes, 1000 procedures and loops, 16 times the elements and a
    /// million more, one minute.
    fn default() -> Self {
        Self {
            applications: 10_000_000,
            steps: 1_000_000_000,
            edits: 20_000_000,
            depth: 1000,
            growth: 16,
            extra: 1_000_000,
            time: Some(Duration::from_secs(60)),
        }
    }
}

impl Limits {
    /// What scripts may do to a mesh that has `elements` elements.
    pub fn allowance(&self, elements: usize) -> Allowance {
        let elements = (elements as u64).saturating_mul(self.growth).saturating_add(self.extra);
        Allowance { steps: self.steps, edits: self.edits, elements, depth: self.depth }
    }
}

/// Applications that a trace can hold: about 500 bytes each.
const MOST_RECORDED: usize = 1_000_000;

/// How to run rules.
#[derive(Clone, Default, Debug)]
pub struct RunOptions<'a> {
    /// Values of parameters that differ from their defaults.
    pub parameters: BTreeMap<String, f64>,
    /// What the run may cost.
    pub limits: Limits,
    /// Watches and cancels the run.
    pub job: Option<&'a Job>,
    /// Records where rules are applied, or says where to apply them.
    pub tracer: Option<&'a Tracer>,
}

/// What a run did.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Outcome {
    /// Name of each rule and how often it was applied, in the order of the rules.
    pub applications: Vec<(String, u64)>,
    /// All applications together.
    pub steps: u64,
    /// Real faces whose edges or vertices changed and that still exist, ascending.
    pub touched: Vec<FaceId>,
}

/// Runs `rules` on `mesh` until none matches, phase by phase. Within a phase the first rule in the order of the text
/// that matches is applied, at its match with the smallest anchor id.
///
/// # Errors
/// See [`RunError`]; the mesh is as it was then.
pub fn run(rules: &RuleSet, mesh: &mut Mesh, options: &RunOptions<'_>) -> Result<Outcome, RunError> {
    let parameters = parameters(rules, options)?;
    let checkpoint = mesh.begin();
    let result = Run::new(rules, mesh, &parameters, options).rewrite(options.tracer);
    match result {
        Ok(outcome) => {
            mesh.commit(checkpoint);
            Ok(outcome)
        }
        Err(error) => {
            mesh.rollback(checkpoint);
            Err(error)
        }
    }
}

/// Applies rule number `rule` once to the elements `nodes`, whatever its conditions say; attributes that its action
/// misses have the values of the examples. The mesh is as it was when this fails.
pub(super) fn apply_to(rules: &RuleSet, rule: usize, mesh: &mut Mesh, nodes: &[u32]) -> Result<(), RunError> {
    let options = RunOptions::default();
    let parameters = parameters(rules, &options)?;
    let checkpoint = mesh.begin();
    let mut run = Run::new(rules, mesh, &parameters, &options);
    run.examples = Some(&rules.examples);
    run.bound[..nodes.len()].copy_from_slice(nodes);
    match run.apply_here(rule).and_then(|()| run.outcome()) {
        Ok(_) => mesh.commit(checkpoint),
        Err(error) => {
            mesh.rollback(checkpoint);
            return Err(error);
        }
    }
    Ok(())
}

fn parameters(rules: &RuleSet, options: &RunOptions<'_>) -> Result<Vec<f64>, RunError> {
    for name in options.parameters.keys() {
        if !rules.parameters.iter().any(|parameter| parameter.name == *name) {
            let known = rules.parameters.iter().map(|parameter| parameter.name.clone()).collect();
            return Err(RunError::UnknownParameter { name: name.clone(), known });
        }
    }
    rules
        .parameters
        .iter()
        .map(|parameter| {
            let value = options.parameters.get(&parameter.name).copied().unwrap_or(parameter.default);
            if value.is_finite() && (parameter.low..=parameter.high).contains(&value) {
                return Ok(value);
            }
            let (name, low, high) = (parameter.name.clone(), parameter.low, parameter.high);
            Err(RunError::ParameterOutOfRange { name, value, low, high })
        })
        .collect()
}

pub(super) struct Run<'a> {
    pub(super) rules: &'a RuleSet,
    pub(super) mesh: &'a mut Mesh,
    parameters: &'a [f64],
    /// What scripts find where an attribute is missing.
    examples: Option<&'a Examples>,
    pub(super) symbols: Vec<Symbol>,
    budget: Budget<'a>,
    limits: Limits,
    /// Elements of the mesh before the run.
    elements: usize,
    machine: Machine,
    search: Search,
    forbidden_search: Search,
    /// The elements of the present match.
    pub(super) bound: Vec<u32>,
    queues: Vec<Queue>,
    /// Applications when each rule's queue was filled last.
    seeded_at: Vec<u64>,
    counts: Vec<u64>,
    total: u64,
    /// What is done, when that is recorded.
    recorded: Option<Vec<Application>>,
    /// Faces that each application changed, with its rule.
    touched: Vec<(FaceId, u32)>,
    /// The rules of the present phase.
    phase: std::ops::Range<usize>,
    // Scratch lists of `after`.
    changed: Vec<Node>,
    faces: Vec<FaceId>,
    near: Vec<u32>,
    walk: [Vec<u32>; 2],
}

impl<'a> Run<'a> {
    fn new(rules: &'a RuleSet, mesh: &'a mut Mesh, parameters: &'a [f64], options: &RunOptions<'a>) -> Self {
        let symbols = rules.names.iter().map(|name| mesh.intern(name)).collect();
        let deadline = options.limits.time.and_then(|time| Instant::now().checked_add(time));
        let elements = mesh.element_count();
        let allowance = options.limits.allowance(elements);
        let most_nodes = rules
            .rules
            .iter()
            .flat_map(|rule| rule.forbidden.iter().map(|f| f.plans.len()).chain([rule.plans.len()]))
            .max();
        Self {
            rules,
            mesh,
            parameters,
            examples: None,
            symbols,
            budget: Budget::new(allowance, deadline, options.job),
            elements,
            limits: options.limits,
            machine: Machine::new(&rules.strings),
            search: Search::default(),
            forbidden_search: Search::default(),
            bound: vec![0; most_nodes.unwrap_or(0)],
            queues: rules.rules.iter().map(|_| Queue::default()).collect(),
            seeded_at: vec![0; rules.rules.len()],
            counts: vec![0; rules.rules.len()],
            total: 0,
            recorded: None,
            touched: Vec::new(),
            phase: 0..0,
            changed: Vec::new(),
            faces: Vec::new(),
            near: Vec::new(),
            walk: [Vec::new(), Vec::new()],
        }
    }

    /// Rewrites the mesh: by its own search, or as the tracer says.
    fn rewrite(mut self, tracer: Option<&Tracer>) -> Result<Outcome, RunError> {
        let Some(tracer) = tracer else {
            self.run_phases()?;
            return self.outcome();
        };
        if let Some(pass) = tracer.next_pass() {
            self.follow(pass.as_ref())?;
            return self.outcome();
        }
        let before = digest(self.mesh);
        self.recorded = Some(Vec::new());
        let result = self.run_phases();
        let applications = self.recorded.take().unwrap_or_default();
        // Of a run that failed, the trace shows how it came to that.
        tracer.add(Pass { applications, before, after: digest(self.mesh) });
        result?;
        self.outcome()
    }

    fn run_phases(&mut self) -> Result<(), RunError> {
        let rules = self.rules;
        let mut at = 0;
        while let Some(phase) = rules.phases.get(at) {
            let before = self.total;
            for rule in phase.clone() {
                self.seed(rule);
            }
            self.phase = phase.clone();
            self.run_phase(phase.clone())?;
            let name =
                |phase: &std::ops::Range<usize>| rules.rules.get(phase.start).map(|rule| rule.phase.as_str());
            let again = name(phase).and_then(|name| rules.again.get(name)).filter(|_| self.total > before);
            let target =
                again.and_then(|again| rules.phases.iter().position(|phase| name(phase) == Some(again)));
            at = target.unwrap_or(at + 1);
        }
        Ok(())
    }

    /// What was done, after a look at the faces that were changed.
    fn outcome(self) -> Result<Outcome, RunError> {
        let rules = self.rules;
        let mut faces: Vec<FaceId> = self.touched.iter().map(|(face, _)| *face).collect();
        faces.sort_unstable();
        faces.dedup();
        faces.retain(|&face| self.mesh.has_face(face));
        for &face in &faces {
            if let Err(problem) = self.mesh.validate_control_face(face) {
                return Err(self.broken(face, problem.to_string()));
            }
        }
        let names = rules.rules.iter().map(|rule| rule.name.clone());
        Ok(Outcome { applications: names.zip(self.counts).collect(), steps: self.total, touched: faces })
    }

    fn view(&self) -> View<'_> {
        View { mesh: self.mesh, symbols: &self.symbols }
    }

    fn seed(&mut self, rule: usize) {
        let anchor = &self.rules.rules[rule].anchor;
        let ids = self.view().candidates(anchor);
        let bound = self.view().bound(anchor.domain());
        self.queues[rule].seed(ids, bound);
        self.seeded_at[rule] = self.total;
    }

    /// Applies the rules of a phase until none matches.
    fn run_phase(&mut self, phase: std::ops::Range<usize>) -> Result<(), RunError> {
        loop {
            let mut applied = false;
            for rule in phase.clone() {
                if self.apply_next(rule)? {
                    applied = true;
                    break;
                }
            }
            if applied {
                continue;
            }
            // Nothing near a change matches. What rules see beyond their patterns may have changed, too.
            let stale = phase
                .clone()
                .filter(|&rule| self.rules.rules[rule].looks_further && self.seeded_at[rule] < self.total);
            let stale: Vec<usize> = stale.collect();
            if stale.is_empty() {
                return Ok(());
            }
            for rule in stale {
                self.seed(rule);
            }
        }
    }

    /// Applies a rule at the first of its anchors that has a match.
    fn apply_next(&mut self, number: usize) -> Result<bool, RunError> {
        let rule = &self.rules.rules[number];
        while let Some(anchor) = self.queues[number].pop() {
            match self.find(rule, anchor) {
                Ok(false) => {}
                Ok(true) => {
                    self.apply_here(number)?;
                    // The same anchor may have another match.
                    self.queues[number].push(anchor);
                    return Ok(true);
                }
                Err(failed) => return Err(self.failed(rule, failed)),
            }
        }
        Ok(false)
    }
}
