//! The state of the engine as the window shows it.

use std::sync::Arc;

use cable_core::solution::Histories;
use cable_core::{Error, Scene, Simulation, Solution};

use super::{Engine, LastAnswer, Phase, Report};
use crate::state::{NoAnswer, Snapshot};
use crate::worker::timing::MAX_ANSWERS;

impl Engine {
    /// Adds the present instant to the history: the start as well as every step.
    pub(super) fn sample(&mut self) {
        if let Some(simulation) = &self.simulation
            && self.answers.len() < MAX_ANSWERS
        {
            self.answers.push(self.solution_of(simulation));
        }
    }

    /// The answer without what it says of other histories while these are being sought.
    pub(super) fn solution_of(&self, simulation: &Simulation) -> Solution {
        let mut solution = simulation.solution();
        if self.seeks_histories() {
            solution.warnings.retain(|w| w.cause.histories() != Some(&Histories::NotSought));
        }
        solution
    }

    pub(super) fn show(&mut self, result: Result<(), Error>) {
        let scene: Option<Arc<Scene>> = self.edit.as_ref().map(|e| Arc::new(e.scene.clone()));
        match (result, &self.simulation) {
            (Ok(()), Some(simulation)) => {
                let solution = self.solution_of(simulation);
                self.snapshot.solution = Some(Arc::new(solution));
                self.snapshot.seeks_histories = self.seeks_histories();
                self.snapshot.peaks = self.monitor.as_ref().map_or_else(Vec::new, |m| m.peaks().to_vec());
                self.snapshot.error = match &self.phase {
                    Phase::Refused { reason } => Some(reason.clone()),
                    _ => None,
                };
                self.snapshot.stale = self.refused();
                self.snapshot.draft = self.draft() || self.coarse();
                if self.refused() {
                    self.show_last_answer();
                } else {
                    self.snapshot.scene = scene;
                    self.keep_answer();
                }
            }
            (Ok(()), None) => {
                if let Phase::Refused { reason } = &self.phase {
                    self.snapshot.error = Some(reason.clone());
                    self.snapshot.stale = true;
                }
            }
            (Err(e), _) => {
                self.snapshot.error = Some(NoAnswer::Error(e));
                self.snapshot.stale = true;
                self.show_last_answer();
            }
        }
        if self.playback.paused {
            self.snapshot.real_speed = None;
        }
    }

    /// Keeps an answer that is on screen: it stays while later scenes have none.
    pub(super) fn keep_answer(&mut self) {
        if let (false, Some(solution)) = (self.snapshot.draft, &self.snapshot.solution) {
            let Snapshot { scene, peaks, .. } = &self.snapshot;
            let (scene, solution, peaks) = (scene.clone(), Arc::clone(solution), peaks.clone());
            self.last_answer = Some(LastAnswer { scene, solution, peaks });
        }
    }

    /// A draft of a scene is no answer, least of all to another one.
    pub(super) fn show_last_answer(&mut self) {
        self.snapshot.draft = false;
        self.snapshot.seeks_histories = false;
        if let Some(last) = &self.last_answer {
            self.snapshot.solution = Some(Arc::clone(&last.solution));
            self.snapshot.scene.clone_from(&last.scene);
            self.snapshot.peaks.clone_from(&last.peaks);
        }
    }

    pub(super) fn report(&mut self, paused_itself: bool) -> Report {
        Report {
            snapshot: self.snapshot.clone(),
            history_restarts: std::mem::take(&mut self.history_restarts),
            answers: std::mem::take(&mut self.answers),
            routes: self.routes.clone(),
            paused_itself,
        }
    }
}
