//! A reset takes the running simulation back to its start, and can itself be undone.

use cable_core::Error;

use super::{EndedRun, Engine, Phase};
use crate::state::Snapshot;
use crate::worker::engine::run::{Run, RunStart};
use crate::worker::request::Edit;

impl Engine {
    /// Keeps the run so far, which a reset ends, and leaves a copy of it in its place.
    fn keep_ended_run(&mut self) {
        let Some(run) = self.run.take_if(|run| run.simulation().time_s() > 0.0) else { return };
        let copy = run.checkpoint();
        let (edit, phase, snapshot) = (self.edit.clone(), self.phase.clone(), self.outbox.snapshot.clone());
        self.ended_run = Some(Box::new(EndedRun { run, edit, phase, snapshot }));
        self.run = Some(copy);
    }

    /// Takes the last reset back and goes on from the end of that run. Nothing is solved unless
    /// scene, model or mesh have changed since, which counts as an edit of that run.
    pub(super) fn undo_reset(&mut self, edit: Edit) -> Option<Result<(), Error>> {
        let EndedRun { run, edit: before, phase, snapshot } = *self.ended_run.take()?;
        // The run since then takes its place.
        self.keep_ended_run();
        let of = |e: &Edit| (e.scene.clone(), e.model, e.settings);
        let is_same = before.as_ref().is_some_and(|before| of(before) == of(&edit));
        (self.run, self.edit, self.phase) = (Some(run), before, phase);
        self.refinement.drop_histories();
        self.playback.paused = true;
        self.outbox.answers.clear();
        self.outbox.snapshot = Snapshot { real_speed: None, ..snapshot };
        self.outbox.keep_answer();
        (!is_same).then(|| self.take_edit(edit))
    }

    /// Takes the running simulation back to its start; its recording is kept.
    pub(super) fn reset(&mut self) -> Result<(), Error> {
        self.keep_ended_run();
        self.outbox.history_restarts = true;
        if self.coarse() {
            self.phase = Phase::Answer;
        }
        self.outbox.answers.clear();
        self.steering.hand = None;
        let answers = matches!(self.phase, Phase::Answer);
        if !self.run.as_mut().is_some_and(|run| answers && run.back_to_start())
            && let Some(edit) = self.edit.clone()
        {
            let mut edit = edit;
            self.refinement.put_off(edit.settings.histories);
            let simulation = self.settle_edit(&mut edit, None)?;
            self.run = Some(Run::new(simulation, RunStart::Settled));
            self.phase = Phase::Answer;
        }
        self.sample();
        Ok(())
    }
}
