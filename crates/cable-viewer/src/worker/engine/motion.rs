//! Time that runs, and a hand that draws meanwhile.

use std::time::Instant;

use cable_core::math::vec2;
use cable_core::model::Inertia;
use cable_core::timeline::usual_step;
use cable_core::{Error, Model, Settings, Simulation, Solution};

use super::outbox::Report;
use super::run::{Run, is_quasi_static};
use super::{Engine, HeldSupport, Phase};
use crate::state::Playback;
use crate::worker::draft::{self, MeshResolution};
use crate::worker::request::Drag;
use crate::worker::timing::{COARSE_AFTER_S, FRAME_S, IDLE_S};

impl Engine {
    /// Lets one frame (1/60 s of wall time) pass.
    pub fn advance_frame(&mut self) -> Report {
        self.advance_part_of_frame(1.0)
    }

    /// Lets a share of a frame pass: of one that is late no more than a whole one, so that time
    /// runs slower instead of falling behind for ever.
    pub fn advance_part_of_frame(&mut self, share: f64) -> Report {
        if let Phase::CoarseMotion { moved_at } = self.phase
            && moved_at.elapsed().as_secs_f64() > IDLE_S
        {
            self.leave_coarse();
        }
        let began = Instant::now();
        let speed = self.playback.speed.clamp(Playback::MIN_SPEED, Playback::MAX_SPEED);
        let frame_s = FRAME_S * share.clamp(0.0, 1.0);
        let result = self.let_pass(frame_s * speed);
        let failed = result.is_err();
        if failed {
            self.playback.paused = true;
        }
        let between = if failed { None } else { self.answer_between_steps() };
        let wall = began.elapsed().as_secs_f64();
        let snapshot = &mut self.outbox.snapshot;
        snapshot.solve_wall_s = wall;
        snapshot.real_speed = (!failed).then(|| speed * (frame_s / wall.max(frame_s)));
        snapshot.edit = self.steering.drag_number.max(snapshot.edit);
        if !self.coarse() {
            self.wall_times.frame_s = wall;
        }
        self.show(result);
        self.outbox.show_between_steps(between);
        Report { paused_itself: failed, ..self.report() }
    }

    /// Passes a dragged support to the simulation.
    pub(super) fn drag(&mut self, drag: Drag) {
        if self.coarse() {
            self.phase = Phase::CoarseMotion { moved_at: Instant::now() };
        } else if self.refinement.is_later() && self.playing() && self.wall_times.frame_s > COARSE_AFTER_S {
            self.enter_coarse();
        }
        let Drag { cable, support, to_m, .. } = drag;
        self.steering.hand = drag.by_spring.then_some(HeldSupport { cable, support, at_m: to_m });
        if let Some(run) = &mut self.run {
            run.draw(|simulation| match drag.by_spring {
                true => simulation.pull_support(cable, support, vec2(to_m)),
                false => simulation.drag_support(cable, support, vec2(to_m)),
            });
        }
        if let Some(edit) = &mut self.edit {
            edit.scene = drag.scene;
        }
    }

    /// A coarse mesh follows the hand while time runs, where the full one is late: it goes on where
    /// that is.
    fn enter_coarse(&mut self) {
        if let Some(coarse) = self.with_mesh(MeshResolution::Coarse) {
            self.run = Some(Run::after(self.run.as_ref(), coarse));
            self.phase = Phase::CoarseMotion { moved_at: Instant::now() };
        }
    }

    /// The hand rests: the full mesh goes on where the coarse one is.
    fn leave_coarse(&mut self) {
        self.phase = Phase::Answer;
        if let Some(mut full) = self.with_mesh(MeshResolution::Full) {
            if let Some(hand) = self.steering.hand {
                full.pull_support(hand.cable, hand.support, vec2(hand.at_m));
            }
            self.run = Some(Run::after(self.run.as_ref(), full));
        }
    }

    /// The present motion on another mesh.
    fn with_mesh(&self, mesh: MeshResolution) -> Option<Simulation> {
        let (edit, run) = (self.edit.as_ref()?, self.run.as_ref()?);
        draft::with_mesh(edit, run.simulation(), mesh)
    }

    /// The part that inertia takes in the steps of the model that was asked for.
    fn inertia(&self) -> Inertia {
        let asked = self.edit.as_ref().map_or(Model::Auto, |e| e.model);
        if is_quasi_static(asked) { Inertia::QuasiStatic } else { Inertia::Dynamic }
    }

    /// Lets time (s) pass in whole steps; what is left of it passes with the next.
    pub(super) fn let_pass(&mut self, time_s: f64) -> Result<(), Error> {
        let inertia = self.inertia();
        let settings = self.edit.as_ref().map_or_else(Settings::default, |e| e.settings);
        let Some(run) = &mut self.run else { return Ok(()) };
        run.begin(inertia, settings)?;
        // The picture of a fast motion is as near in time as that of one at normal speed.
        let most = ((FRAME_S / usual_step(inertia).seconds()).round() as u64).max(1);
        let mut left = run.owe(time_s, inertia);
        while left > 0 {
            let count = left.min(most);
            let order = self.steering.robot_speed_command;
            let Some(run) = &mut self.run else { break };
            run.steer(|simulation| simulation.command_robot(order));
            run.make_steps(count, inertia)?;
            left -= count;
            self.sample();
        }
        Ok(())
    }

    /// The answer between two steps, which slow motion shows.
    pub(super) fn answer_between_steps(&self) -> Option<Solution> {
        let run = self.run.as_ref().filter(|_| self.playback.speed < 1.0)?;
        run.answer_between_steps(self.inertia())
    }
}
