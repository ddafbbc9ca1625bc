//! A snapshot is the state of the engine as the window shows it.

use std::sync::Arc;

use cable_core::solution::Histories;
use cable_core::{Error, Scene, Simulation, Solution};

use super::outbox::{self, Report};
use super::{Engine, Phase};
use crate::state::NoAnswer;

impl Engine {
    /// Adds the present instant, the start included, to the history; but not that of a coarse mesh
    /// that follows a hand, whose tensions are not those of the cable.
    pub(super) fn sample(&mut self) {
        if let Some(run) = &self.run
            && !self.coarse()
        {
            let answer = self.solution_of(run.simulation());
            self.outbox.answers.push(answer);
            outbox::thin(&mut self.outbox.answers);
        }
    }

    /// The answer without what it says of other histories while these are being sought.
    fn solution_of(&self, simulation: &Simulation) -> Solution {
        let mut solution = simulation.solution();
        if self.seeks_histories() {
            solution.warnings.retain(|w| w.cause.histories() != Some(&Histories::NotSought));
        }
        solution
    }

    /// Puts the result of a solve or step into the snapshot.
    pub(super) fn show(&mut self, result: Result<(), Error>) {
        let scene: Option<Arc<Scene>> = self.edit.as_ref().map(|e| Arc::new(e.scene.clone()));
        let refused = self.refused();
        match (result, &self.run) {
            (Ok(()), Some(run)) => {
                let solution = self.solution_of(run.simulation());
                let (peaks, seeks_histories) = (run.peaks(), self.seeks_histories());
                let draft = self.draft() || self.coarse();
                let brought_to_rest = run.is_brought_to_rest();
                let snapshot = &mut self.outbox.snapshot;
                snapshot.solution = Some(Arc::new(solution));
                snapshot.seeks_histories = seeks_histories;
                snapshot.peaks = peaks;
                snapshot.brought_to_rest = brought_to_rest;
                snapshot.error = match &self.phase {
                    Phase::Refused { reason } => Some(reason.clone()),
                    _ => None,
                };
                snapshot.stale = refused;
                snapshot.draft = draft;
                if refused {
                    self.outbox.show_last_answer();
                } else {
                    snapshot.scene = scene;
                    self.outbox.keep_answer();
                }
            }
            (Ok(()), None) => {
                if let Phase::Refused { reason } = &self.phase {
                    self.outbox.snapshot.error = Some(reason.clone());
                    self.outbox.snapshot.stale = true;
                }
            }
            (Err(e), _) => {
                self.outbox.snapshot.error = Some(NoAnswer::Error(e));
                self.outbox.snapshot.stale = true;
                self.outbox.show_last_answer();
            }
        }
        if self.playback.paused {
            self.outbox.snapshot.real_speed = None;
        }
    }

    pub(super) fn report(&mut self) -> Report {
        self.outbox.report()
    }
}
