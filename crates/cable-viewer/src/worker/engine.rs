//! What the worker does, without threads: it owns the simulation, answers requests and steps time.

use std::sync::Arc;
use std::time::Instant;

use cable_core::math::vec2;
use cable_core::{Error, Scene, Simulation};

use super::request::{Drag, Edit, Request};
use crate::history::Sample;
use crate::state::{Playback, Snapshot};

/// One frame of simulated time at normal speed, s.
pub const FRAME_S: f64 = 1.0 / 60.0;

/// Owns the simulation.
#[derive(Debug)]
pub struct Engine {
    simulation: Option<Simulation>,
    /// The last edit, for rebuilding.
    edit: Option<Edit>,
    /// `simulation` was settled from the present scene at t = 0: its `reset` is the start.
    start_kept: bool,
    playback: Playback,
    snapshot: Snapshot,
    samples: Vec<Sample>,
    /// The history starts again before the first of `samples`.
    history_restarts: bool,
}

/// What goes to the window.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The latest answer.
    pub snapshot: Snapshot,
    /// Forget the history shown so far.
    pub history_restarts: bool,
    /// New samples.
    pub samples: Vec<Sample>,
    /// The worker paused itself because a step failed.
    pub paused_itself: bool,
}

impl Default for Engine {
    fn default() -> Self {
        Self {
            simulation: None,
            edit: None,
            start_kept: false,
            playback: Playback { paused: true, speed: 1.0 },
            snapshot: Snapshot::default(),
            samples: Vec::new(),
            history_restarts: false,
        }
    }
}

impl Engine {
    /// Time runs.
    #[must_use]
    pub fn playing(&self) -> bool {
        !self.playback.paused && self.simulation.is_some()
    }

    /// Does what is asked; returns what to show.
    pub fn handle(&mut self, request: Request) -> Report {
        if let Some(playback) = request.playback {
            self.playback = playback;
        }
        let began = Instant::now();
        let mut solved = request.edit.is_some() || request.reset || request.steps > 0;
        let mut result = Ok(());
        if let Some(edit) = request.edit {
            result = self.take_edit(edit);
        }
        if let Some(drag) = request.drag {
            solved = true;
            result = result.and_then(|()| self.drag(drag));
        }
        if request.reset {
            result = self.reset();
        }
        for _ in 0..request.steps {
            result = result.and_then(|()| self.step(FRAME_S));
        }
        self.snapshot.edit = request.number.max(self.snapshot.edit);
        if solved {
            self.snapshot.solve_wall_s = began.elapsed().as_secs_f64();
            self.show(result);
        }
        self.report(false)
    }

    /// Lets one frame (1/60 s of wall time) pass.
    pub fn tick(&mut self) -> Report {
        let began = Instant::now();
        let speed = self.playback.speed.clamp(Playback::MIN_SPEED, Playback::MAX_SPEED);
        // Slow motion takes finer steps, fast motion several: a step never exceeds one frame.
        let steps = speed.ceil().max(1.0);
        let dt = FRAME_S * speed / steps;
        let mut result = Ok(());
        for _ in 0..steps as u32 {
            result = result.and_then(|()| self.step(dt));
        }
        let failed = result.is_err();
        if failed {
            self.playback.paused = true;
        }
        let wall = began.elapsed().as_secs_f64();
        self.snapshot.solve_wall_s = wall;
        self.snapshot.real_speed = (!failed).then(|| speed * (FRAME_S / wall.max(FRAME_S)));
        self.show(result);
        self.report(failed)
    }

    /// The solver panicked: what it held cannot be trusted any more.
    pub fn abandon(&mut self, message: &str) -> Report {
        self.simulation = None;
        self.start_kept = false;
        self.playback.paused = true;
        self.snapshot.error = Some(format!(
            "the solver stopped by a fault of its own ({message}): the picture is the last good one; \
             change the scene, choose another model, or reset"
        ));
        self.snapshot.stale = true;
        self.report(true)
    }

    fn take_edit(&mut self, edit: Edit) -> Result<(), Error> {
        let old = if edit.fresh { None } else { self.simulation.take() };
        if edit.fresh {
            self.simulation = None;
            self.snapshot.solution = None;
            self.history_restarts = true;
            self.samples.clear();
        }
        // Models are compared by what they answer for the scene as laid, not for where another model left the cable.
        let same_model = self.edit.as_ref().is_some_and(|e| e.model == edit.model && e.settings == edit.settings);
        let from = old.as_ref().filter(|o| same_model || o.time_s() > 0.0);
        let rebuilt = self.rebuild(&edit, from);
        self.edit = Some(edit);
        match rebuilt {
            Ok((simulation, kept)) => {
                self.simulation = Some(simulation);
                self.start_kept = kept;
                Ok(())
            }
            Err(e) => {
                // The old one stays: undoing the edit goes on from it.
                self.simulation = old;
                self.start_kept = false;
                self.playback.paused = true;
                Err(e)
            }
        }
    }

    /// The simulation of an edited scene, carrying over where the cables are, and whether it is at its start.
    fn rebuild(&self, edit: &Edit, old: Option<&Simulation>) -> Result<(Simulation, bool), Error> {
        let mut fresh = Simulation::with_settings(edit.scene.clone(), edit.model, edit.settings)?;
        let time_s = old.map_or(0.0, Simulation::time_s);
        let same_cables = old.is_some_and(|o| {
            let (a, b) = (&o.scene().cables, &edit.scene.cables);
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.name == b.name)
        });
        if let Some(old) = old
            && same_cables
        {
            let mut carried = fresh.clone();
            if carried.adopt(&old.states()).is_ok() {
                if !self.playback.paused {
                    return Ok((carried, false));
                }
                if carried.settle().is_ok() {
                    return Ok((carried, time_s <= 0.0));
                }
            }
        }
        fresh.settle()?;
        Ok((fresh, true))
    }

    fn drag(&mut self, drag: Drag) -> Result<(), Error> {
        if let Some(simulation) = &mut self.simulation {
            simulation.drag_support(drag.cable, drag.support, vec2(drag.to_m));
        }
        if let Some(edit) = &mut self.edit {
            edit.scene = drag.scene;
        }
        self.start_kept = false;
        Ok(())
    }

    fn reset(&mut self) -> Result<(), Error> {
        self.history_restarts = true;
        self.samples.clear();
        // At the start already: lay the cable anew, which forgets the friction of edits since.
        if self.start_kept
            && let Some(simulation) = &mut self.simulation
            && simulation.time_s() > 0.0
        {
            simulation.reset();
            return Ok(());
        }
        if let Some(edit) = self.edit.clone() {
            self.simulation = Some(self.rebuild(&edit, None)?.0);
            self.start_kept = true;
        }
        Ok(())
    }

    fn step(&mut self, dt_s: f64) -> Result<(), Error> {
        let Some(simulation) = &mut self.simulation else {
            return Ok(());
        };
        simulation.step(dt_s)?;
        if self.samples.len() < crate::history::History::CAPACITY {
            self.samples.push(Sample::of(&simulation.solution()));
        }
        Ok(())
    }

    fn show(&mut self, result: Result<(), Error>) {
        let scene: Option<Arc<Scene>> = self.edit.as_ref().map(|e| Arc::new(e.scene.clone()));
        match (result, &self.simulation) {
            (Ok(()), Some(simulation)) => {
                self.snapshot.solution = Some(Arc::new(simulation.solution()));
                self.snapshot.scene = scene;
                self.snapshot.error = None;
                self.snapshot.stale = false;
            }
            (Ok(()), None) => {}
            (Err(e), _) => {
                self.snapshot.error = Some(e.to_string());
                self.snapshot.stale = true;
            }
        }
        if self.playback.paused {
            self.snapshot.real_speed = None;
        }
    }

    fn report(&mut self, paused_itself: bool) -> Report {
        Report {
            snapshot: self.snapshot.clone(),
            history_restarts: std::mem::take(&mut self.history_restarts),
            samples: std::mem::take(&mut self.samples),
            paused_itself,
        }
    }
}
