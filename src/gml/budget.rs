//! How much work a run may do before it is stopped.

use crate::job::Job;
use std::time::Instant;

/// Steps between two looks at the clock and at the job.
const SLICE: u64 = 1 << 14;

/// What ended a run from outside.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stop {
    /// All steps were used.
    Steps,
    /// All changes of the mesh were used.
    Edits,
    /// The mesh has as many elements as it may have.
    Elements,
    /// The time was used.
    Time,
    /// The caller cancelled.
    Cancelled,
}

/// What scripts may do.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Allowance {
    /// Steps, see [`Budget`].
    pub steps: u64,
    /// Changes of the mesh.
    pub edits: u64,
    /// Vertices, edges and faces that the mesh may have, together.
    pub elements: u64,
    /// Procedures and loops that may be open inside one another.
    pub depth: usize,
}

/// What scripts and searches may still do. One step is one operation of a script, one element copied by it,
/// or one step of a search for matches.
#[derive(Debug)]
pub struct Budget<'a> {
    /// Steps until the clock is looked at.
    slice: u64,
    left: u64,
    edits: u64,
    elements: u64,
    depth: usize,
    deadline: Option<Instant>,
    job: Option<&'a Job>,
}

impl<'a> Budget<'a> {
    /// What `allowance` says, until `deadline`, as long as `job` is not cancelled.
    pub fn new(allowance: Allowance, deadline: Option<Instant>, job: Option<&'a Job>) -> Self {
        let Allowance { steps, edits, elements, depth } = allowance;
        Self { slice: 0, left: steps, edits, elements, depth, deadline, job }
    }

    /// Procedures and loops that may be open inside one another.
    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    /// Takes one step.
    ///
    /// # Errors
    /// The reason to stop.
    #[inline]
    pub fn spend(&mut self) -> Result<(), Stop> {
        self.spend_many(1)
    }

    /// Takes `count` steps at once.
    ///
    /// # Errors
    /// The reason to stop.
    #[inline]
    pub fn spend_many(&mut self, count: u64) -> Result<(), Stop> {
        while self.slice < count {
            self.refill()?;
        }
        self.slice -= count;
        Ok(())
    }

    /// Takes `count` changes of the mesh.
    ///
    /// # Errors
    /// They are used up.
    pub(crate) fn edit(&mut self, count: u64) -> Result<(), Stop> {
        self.edits = self.edits.checked_sub(count).ok_or(Stop::Edits)?;
        Ok(())
    }

    /// Takes as many changes as `more` elements of a mesh that has `elements`.
    ///
    /// # Errors
    /// They are used up, or the mesh has no room for them.
    pub(crate) fn grow(&mut self, elements: usize, more: u64) -> Result<(), Stop> {
        if (elements as u64).saturating_add(more) > self.elements {
            return Err(Stop::Elements);
        }
        self.edit(more)
    }

    #[cold]
    fn refill(&mut self) -> Result<(), Stop> {
        if self.job.is_some_and(Job::is_cancelled) {
            return Err(Stop::Cancelled);
        }
        if self.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            return Err(Stop::Time);
        }
        if self.left == 0 {
            return Err(Stop::Steps);
        }
        let more = self.left.min(SLICE);
        self.left -= more;
        self.slice += more;
        Ok(())
    }
}
