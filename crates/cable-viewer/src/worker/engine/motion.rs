//! Time that runs, and a hand that draws meanwhile.

use std::time::Instant;

use cable_core::math::vec2;
use cable_core::model::Inertia;
use cable_core::timeline::RunMonitor;
use cable_core::{Error, Model, Settings, Simulation};

use super::{Engine, Hand, MOTION, Phase, Report, is_quasi_static};
use crate::state::Playback;
use crate::worker::draft::{self, MeshResolution};
use crate::worker::request::Drag;
use crate::worker::timing::{COARSE_AFTER_S, FRAME_S, IDLE_S};

impl Engine {
    /// Lets one frame (1/60 s of wall time) pass.
    pub fn advance_frame(&mut self) -> Report {
        self.advance_part_of_frame(1.0)
    }

    /// Lets a share of a frame pass.
    pub fn advance_part_of_frame(&mut self, share: f64) -> Report {
        if let Phase::CoarseMotion { moved_at } = self.phase
            && moved_at.elapsed().as_secs_f64() > IDLE_S
        {
            self.leave_coarse();
        }
        let began = Instant::now();
        let speed = self.playback.speed.clamp(Playback::MIN_SPEED, Playback::MAX_SPEED);
        // Slow motion takes finer steps, fast motion several: a step never exceeds one frame.
        let steps = speed.ceil().max(1.0);
        let dt = FRAME_S * share * speed / steps;
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
        self.snapshot.real_speed = (!failed).then(|| speed * (FRAME_S * share / wall.max(FRAME_S * share)));
        self.snapshot.edit = self.dragged.max(self.snapshot.edit);
        if !self.coarse() {
            self.frame_wall_s = wall;
        }
        self.show(result);
        self.report(failed)
    }

    pub(super) fn drag(&mut self, drag: Drag) -> Result<(), Error> {
        if self.coarse() {
            self.phase = Phase::CoarseMotion { moved_at: Instant::now() };
        } else if self.drafts && self.playing() && self.frame_wall_s > COARSE_AFTER_S {
            self.enter_coarse();
        }
        let Drag { cable, support, to_m, .. } = drag;
        let draw = |simulation: &mut Simulation| match drag.by_spring {
            true => simulation.pull_support(cable, support, vec2(to_m)),
            false => simulation.drag_support(cable, support, vec2(to_m)),
        };
        self.hand = drag.by_spring.then_some(Hand { cable, support, at_m: to_m });
        if let Some(simulation) = &mut self.simulation {
            draw(simulation);
        }
        if let Some(monitor) = &mut self.monitor {
            monitor.steer(draw);
        }
        if let Some(edit) = &mut self.edit {
            edit.scene = drag.scene;
        }
        if let Phase::Answer { start_kept } = &mut self.phase {
            *start_kept = false;
        }
        Ok(())
    }

    /// A coarse mesh follows the hand while time runs, where the full one is late: it goes on where
    /// that is.
    pub(super) fn enter_coarse(&mut self) {
        let (Some(edit), Some(old)) = (&self.edit, &self.simulation) else { return };
        if let Some(coarse) = draft::with_mesh(edit, old, MeshResolution::Coarse) {
            self.simulation = Some(coarse);
            self.monitor = None;
            self.phase = Phase::CoarseMotion { moved_at: Instant::now() };
        }
    }

    /// The hand rests: the full mesh goes on where the coarse one is.
    pub(super) fn leave_coarse(&mut self) {
        self.phase = Phase::Answer { start_kept: false };
        if let (Some(edit), Some(old)) = (&self.edit, &self.simulation)
            && let Some(mut full) = draft::with_mesh(edit, old, MeshResolution::Full)
        {
            if let Some(hand) = self.hand {
                full.pull_support(hand.cable, hand.support, vec2(hand.at_m));
            }
            self.simulation = Some(full);
            self.monitor = None;
        }
    }

    pub(super) fn step(&mut self, dt_s: f64) -> Result<(), Error> {
        let Some(simulation) = &mut self.simulation else {
            return Ok(());
        };
        let asked = self.edit.as_ref().map_or(Model::Auto, |e| e.model);
        let settings = self.edit.as_ref().map_or_else(Settings::default, |e| e.settings);
        let inertia = if is_quasi_static(asked) { Inertia::QuasiStatic } else { Inertia::Dynamic };
        let start_kept = matches!(self.phase, Phase::Answer { start_kept: true });
        let mut starts = start_kept && simulation.time_s() <= 0.0;
        if inertia == Inertia::Dynamic && is_quasi_static(simulation.model()) {
            let (moving, settled) = moving(simulation, settings)?;
            self.before_motion = Some(std::mem::replace(simulation, moving));
            starts &= settled;
        }
        if starts {
            self.monitor = Some(RunMonitor::with_errors(simulation, inertia));
        }
        let order = self.robot_speed_command;
        simulation.command_robot(order);
        if let Some(monitor) = &mut self.monitor {
            monitor.steer(|simulation| simulation.command_robot(order));
        }
        match inertia {
            Inertia::QuasiStatic => simulation.step_quasi_static(dt_s)?,
            Inertia::Dynamic => simulation.step(dt_s)?,
        }
        if let Some(monitor) = &mut self.monitor {
            monitor.follow(simulation);
        }
        self.sample();
        Ok(())
    }
}

/// The simulation that moves from where the one stands that `auto` chose for rest, and whether it
/// has come to rest there on its own mesh.
pub(super) fn moving(rest: &Simulation, settings: Settings) -> Result<(Simulation, bool), Error> {
    // Its warning of other histories would be gone with the first step.
    let settings = Settings { histories: false, ..settings };
    let mut moving = Simulation::for_question(rest.scene().clone(), Model::Auto, settings, MOTION)?;
    moving.carry(rest)?;
    let mut settled = moving.clone();
    match settled.settle() {
        Ok(_) => Ok((settled, true)),
        Err(_) => Ok((moving, false)),
    }
}
