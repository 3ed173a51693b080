//! Where the time of a feature goes.

use std::time::Instant;

/// Time per stage, summed over passes.
pub(super) struct Clock {
    last: Instant,
    laps: Vec<(&'static str, f64)>,
}

impl Clock {
    pub(super) fn start() -> Self {
        Self { last: Instant::now(), laps: Vec::new() }
    }

    pub(super) fn lap(&mut self, stage: &'static str) {
        let now = Instant::now();
        let milliseconds = now.duration_since(self.last).as_secs_f64() * 1e3;
        self.last = now;
        match self.laps.iter_mut().find(|lap| lap.0 == stage) {
            Some(lap) => lap.1 += milliseconds,
            None => self.laps.push((stage, milliseconds)),
        }
    }

    pub(super) fn laps(&mut self) -> Vec<(&'static str, f64)> {
        self.lap("report");
        std::mem::take(&mut self.laps)
    }
}
