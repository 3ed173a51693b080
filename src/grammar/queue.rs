//! Anchors that are still to be examined, smallest id first.

use std::collections::BTreeSet;

/// The anchors of one rule.
#[derive(Default, Debug)]
pub(super) struct Queue {
    /// The anchors there were when the phase began.
    seeds: Seeds,
    /// Anchors near later changes.
    later: BTreeSet<u32>,
}

#[derive(Debug)]
enum Seeds {
    Ids(std::vec::IntoIter<u32>),
    /// All elements, so that nothing of the mesh's size is kept.
    Range(std::ops::Range<u32>),
}

impl Default for Seeds {
    fn default() -> Self {
        Self::Range(0..0)
    }
}

impl Queue {
    /// Starts again with `ids` (ascending), or with all ids below `bound`.
    pub(super) fn seed(&mut self, ids: Option<Vec<u32>>, bound: u32) {
        self.later.clear();
        self.seeds = match ids {
            Some(ids) => Seeds::Ids(ids.into_iter()),
            None => Seeds::Range(0..bound),
        };
    }

    pub(super) fn push(&mut self, id: u32) {
        self.later.insert(id);
    }

    pub(super) fn pop(&mut self) -> Option<u32> {
        let seed = match &self.seeds {
            Seeds::Ids(ids) => ids.as_slice().first().copied(),
            Seeds::Range(range) => (!range.is_empty()).then_some(range.start),
        };
        let later = self.later.first().copied();
        let least = match (seed, later) {
            (Some(seed), Some(later)) => seed.min(later),
            (one, other) => one.or(other)?,
        };
        if seed == Some(least) {
            match &mut self.seeds {
                Seeds::Ids(ids) => ids.next(),
                Seeds::Range(range) => range.next(),
            };
        }
        if later == Some(least) {
            self.later.pop_first();
        }
        Some(least)
    }
}
