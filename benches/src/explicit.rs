//! This module takes explicit steps of `mass-spring` up to their stability limit and beyond.
//!
//! A bar of equal springs between two walls swings along itself at ω = 2√(EA/ρ)/l₀ at most, l₀ the
//! length of a spring, if its loss does not stiffen it. A material of the same loss factor 2ζ at
//! every frequency has the modulus (iω/ω₀)^γ, γ = (2/π) atan 2ζ, above the lowest frequency ω₀ of
//! the loss. A leapfrog is stable as long as dt ω √M < 2, M the modulus of the fastest motion.

use std::f64::consts::{FRAC_2_PI, PI};
use std::sync::Arc;

use cable_core::model::mass_spring::{MassSpringModel, SubStepTuning, Tuning};
use cable_core::model::{Mechanics, Stepping};
use cable_core::scene::{Support, catalog};
use cable_core::{Error, Model, Settings, Simulation, SolveError, Vec2};

/// Length of the bar, m; its density, kg/m; its stiffness, N; and how far it is stretched.
const LENGTH_M: f64 = 20.0;
const DENSITY: f64 = 1.0;
const EA_N: f64 = 1e4;
const STRETCH: f64 = 1.05;
/// A step that is many of those of the bar, s.
const LONG_S: f64 = 1.0;
/// Springs of the bar. The fastest mode of so many is 8e-4 below ω.
pub const SPRINGS: usize = 40;

/// Lower end of the band of constant loss, rad/s: half of the distance of two relaxation branches
/// below the first of them, at 0.1 Hz.
const LOWEST_LOSS: f64 = 0.2;

/// Returns the greatest dt·ω that is stable at a damping ratio of the material, by theory.
#[must_use]
pub fn limit_by_theory(damping: f64) -> f64 {
    2.0 / modulus(damping, fastest()).sqrt()
}

/// Returns the greatest dt·ω that the model takes for stable at a damping ratio, as a long step of
/// a bar at rest shows.
///
/// # Errors
/// The model does not come to rest.
pub fn limit_of_model(damping: f64) -> Result<f64, Error> {
    let mut bar = Bar::with_fraction(Model::MassSpring, [1.0, LONG_S], damping)?;
    bar.simulation.step(LONG_S)?;
    Ok(bar.simulation.solution().cost.inner_step_s * fastest())
}

/// Greatest frequency of the bar without loss, rad/s.
fn fastest() -> f64 {
    2.0 * (EA_N / DENSITY).sqrt() / (LENGTH_M / SPRINGS as f64)
}

/// Stiffness at a frequency (rad/s), of that of slow motion.
fn modulus(damping: f64, omega: f64) -> f64 {
    (omega / LOWEST_LOSS).powf(FRAC_2_PI * (2.0 * damping).atan())
}

/// The bar at rest, and the steps that it takes.
pub struct Bar {
    simulation: Simulation,
    /// Step, s.
    step_s: f64,
    /// Damping ratio of the material.
    damping: f64,
}

impl Bar {
    /// Makes the bar, by `mass-spring` in steps of `dt_omega` over its greatest frequency, however
    /// far beyond the limit; another model takes its own steps up to those.
    ///
    /// # Errors
    /// The model does not come to rest.
    pub fn new(model: Model, dt_omega: f64, damping: f64) -> Result<Self, Error> {
        let wanted_s = dt_omega / fastest();
        // The model takes a part of its own limit.
        let stable_fraction = dt_omega / limit_of_model(damping)?;
        Self::with_fraction(model, [stable_fraction, wanted_s], damping)
    }

    /// Makes the bar, in steps of `step_s` (s) up to a part of the limit of `mass-spring`.
    fn with_fraction(model: Model, [stable_fraction, step_s]: [f64; 2], damping: f64) -> Result<Self, Error> {
        let supports = vec![Support::fixed("a", [0.0, 0.0]), Support::fixed("b", [STRETCH * LENGTH_M, 0.0])];
        let mut scene = catalog::cable_alone([LENGTH_M, DENSITY, EA_N], supports);
        scene.environment.gravity_m_per_s2 = 0.0;
        for cable in &mut scene.cables {
            cable.damping_ratio = damping;
            cable.segments = Some(SPRINGS);
        }
        let tuning = Arc::new(Tuning {
            sub_step: SubStepTuning { stable_fraction, ..SubStepTuning::default() },
            ..Tuning::default()
        });
        let settings = Settings {
            stepping: Stepping::Explicit,
            inner_step_s: Some(step_s),
            histories: false,
            // A cable whose motion grows without end would break.
            breaks: false,
            ..Settings::default()
        };
        let build = move |problem, settings| -> Result<Box<dyn Mechanics>, SolveError> {
            Ok(Box::new(MassSpringModel::with_tuning(problem, settings, tuning.clone())?))
        };
        let mut simulation = match model {
            Model::MassSpring => Simulation::with_mechanics(scene, settings, build)?,
            other => Simulation::with_settings(scene, other, settings)?,
        };
        simulation.settle()?;
        Ok(Self { simulation, step_s, damping })
    }

    /// Moves all of it along itself: by the first mode and the fastest, each so far (m).
    fn pluck(&mut self, [first, fastest]: [f64; 2]) -> Result<(), SolveError> {
        let mut states = self.simulation.states();
        for state in &mut states {
            for (k, (at, s)) in state.position_m.iter_mut().zip(&state.arc_length_m).enumerate() {
                let mode = |m: usize| (PI * m as f64 * s / LENGTH_M).sin();
                let inside = k > 0 && k < SPRINGS;
                let moved = if inside { first * mode(1) + fastest * mode(SPRINGS - 1) } else { 0.0 };
                *at = Vec2::new(STRETCH * s + moved, 0.0);
            }
            state.in_motion = true;
        }
        self.simulation.set_states(&states)
    }

    /// Makes so many steps. A hair less than a whole number is asked of the model, which divides
    /// what is asked evenly.
    fn go(&mut self, steps: u32) -> Result<(), SolveError> {
        self.simulation.step(f64::from(steps) * self.step_s * (1.0 - 1e-9))
    }

    /// The greatest distance of a node from where a function has it, m.
    fn off(&self, moved: impl Fn(f64) -> f64) -> f64 {
        let states = self.simulation.states();
        let nodes = states.iter().flat_map(|s| s.position_m.iter().zip(&s.arc_length_m));
        let off = nodes.map(|(at, s)| (at - Vec2::new(STRETCH * s + moved(*s), 0.0)).norm());
        off.fold(0.0, |most, d| if d > most || d.is_nan() { d } else { most })
    }

    /// Step that the model took last, over the one that was asked for.
    #[must_use]
    pub fn step_taken(&self) -> f64 {
        self.simulation.solution().cost.inner_step_s / self.step_s
    }

    /// Returns whether a touch of the fastest mode grows without end: a ten-thousandfold in some
    /// thousands of steps.
    #[must_use]
    pub fn grows(&mut self) -> bool {
        let touch = 1e-8 * LENGTH_M;
        if self.pluck([0.0, touch]).is_err() {
            return false;
        }
        // A step that is refused has run away.
        (0..40).any(|_| self.go(100).is_err() || !(self.off(|_| 0.0) < 1e4 * touch))
    }

    /// Follows a swing of the first mode, with a touch of the fastest, for one period, `look` at
    /// each few steps. Returns how far a node is from where theory has it at the end, over the
    /// swing.
    ///
    /// # Errors
    /// The model refuses a step.
    pub fn swing(&mut self, mut look: impl FnMut(&Simulation)) -> Result<f64, SolveError> {
        let swing = 1e-2 * LENGTH_M;
        let relaxed = fastest() * (0.5 * PI / SPRINGS as f64).sin();
        let omega = relaxed * modulus(self.damping, relaxed).sqrt();
        let zeta = self.damping;
        self.pluck([swing, 1e-3 * swing])?;
        // A few steps in each look, the last of them at the end of the period.
        let steps = (2.0 * PI / (omega * self.step_s)).round() as u32;
        let mut left = steps;
        while left > 0 {
            let now = left.min(4);
            self.go(now)?;
            look(&self.simulation);
            left -= now;
        }
        let (decay, ring) = (zeta * omega, omega * (1.0 - zeta * zeta).sqrt());
        let time_s = self.step_s * f64::from(steps);
        let now = swing * (-decay * time_s).exp() * ((ring * time_s).cos() + decay / ring * (ring * time_s).sin());
        Ok(self.off(|s| now * (PI * s / LENGTH_M).sin()) / swing)
    }
}

/// Returns the dt·ω from which on a touch of the fastest mode grows, measured at a damping ratio.
///
/// # Errors
/// The model does not come to rest.
pub fn limit_measured(damping: f64) -> Result<f64, Error> {
    let [mut stable, mut grows] = [0.5, 4.0];
    while grows - stable > 1e-3 * stable {
        let middle = 0.5 * (stable + grows);
        if Bar::new(Model::MassSpring, middle, damping)?.grows() { grows = middle } else { stable = middle }
    }
    Ok(0.5 * (stable + grows))
}
