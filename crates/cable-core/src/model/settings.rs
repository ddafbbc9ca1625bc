//! The settings are the mesh and accuracy of a model; they are checked before it is built.

use serde::{Deserialize, Serialize};

use super::{hand, smoothed_target};
use crate::error::SolveError;
use crate::units::Quantity;

/// The mesh and the accuracy of a model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Wanted relative accuracy of the tension; models choose their mesh by it if the scene gives
    /// none.
    pub tolerance: f64,
    /// Elements per cable; overrides the scene's `segments`.
    pub segments: Option<usize>,
    /// Integrator of dynamic steps of `mass-spring`.
    #[serde(default)]
    pub stepping: Stepping,
    /// Longest inner step of `fem` with inertia, s, 1e-9 to 1, of the cable at the scale at which
    /// it is solved; None = 1/240 s.
    #[serde(default)]
    pub inner_step_s: Option<f64>,
    /// Greatest speed at which a support follows the hand that drags it in steps with inertia, m/s.
    #[serde(default = "hand_speed")]
    pub hand_speed_m_per_s: f64,
    /// Stiffness of the spring by which a hand holds a support while masses move, N/m; None: that
    /// of [`hand::default_hand_stiffness`].
    #[serde(default)]
    pub hand_stiffness_n_per_m: Option<f64>,
    /// True if an equilibrium that friction makes one of many is reported with the tensions that
    /// other histories leave: `spans` seeks an equilibrium for each, which takes some times as long
    /// as the first one. No figure of the answer depends on it.
    #[serde(default = "yes")]
    pub histories: bool,
    /// True if `fem` keeps the energy account of a cable in motion
    /// ([`crate::solution::CableSolution::energy_account`]): 7 to 10 % of the instructions of an
    /// inner step. No other figure depends on it.
    #[serde(default = "yes")]
    pub energy_account: bool,
    /// True if a cable breaks where its tension reaches its breaking tension; otherwise there is
    /// only a warning.
    #[serde(default = "yes")]
    pub breaks: bool,
}

fn yes() -> bool {
    true
}

fn hand_speed() -> f64 {
    hand::HAND_SPEED
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-3,
            segments: None,
            stepping: Stepping::Auto,
            inner_step_s: None,
            hand_speed_m_per_s: hand_speed(),
            hand_stiffness_n_per_m: None,
            histories: true,
            energy_account: true,
            breaks: true,
        }
    }
}

/// Greatest move of a support in one solve without inertia where friction remembers the way, of the
/// cable's length. Smaller: more solves for the same answer (1 % halved changed the drags of the
/// reference scenes by less than 1e-6). Larger: sliding that starts and reverses inside a step is
/// missed.
pub(crate) const MAX_MOVE_FRACTION: f64 = 0.01;
/// Least meaningful tolerance: below it round-off is larger. From 1 on nothing is required, which a
/// test of one mesh may want.
pub(crate) const MIN_TOLERANCE: f64 = 1e-14;
/// Least speed limit of a hand, m/s: a slower hand would move nothing in practice.
const MIN_HAND_SPEED: f64 = 0.01;
/// Segments, as a scene's own.
const SEGMENT_RANGE: (usize, usize) = (1, 100_000);
/// Range of inner steps, s. Smaller: a second of motion takes too long; larger: motion is not
/// resolved.
const INNER_STEP_RANGE_S: std::ops::RangeInclusive<f64> = 1e-9..=1.0;
/// Factor of the longest inner step of the hidden coarser runs that accompany a run.
const COARSEST_STEP_FACTOR: f64 = 3.0;

impl Settings {
    /// Refuses settings with which no model can work.
    ///
    /// # Errors
    /// `Setting`, with the value and what is allowed.
    pub fn validate(&self) -> Result<(), SolveError> {
        if let Some(value) = self.inner_step_s.filter(|step| !INNER_STEP_RANGE_S.contains(step)) {
            return Err(refused("inner_step_s", value, ends(&INNER_STEP_RANGE_S), Quantity::Time));
        }
        self.validate_for_coarse_runs()
    }

    /// As [`Self::validate`], for a run that may be one of the hidden coarser ones.
    pub(crate) fn validate_for_coarse_runs(&self) -> Result<(), SolveError> {
        if !(self.tolerance >= MIN_TOLERANCE && self.tolerance.is_finite()) {
            let allowed = [MIN_TOLERANCE, f64::INFINITY];
            return Err(refused("tolerance", self.tolerance, allowed, Quantity::Number));
        }
        let coarsest = *INNER_STEP_RANGE_S.start()..=COARSEST_STEP_FACTOR * INNER_STEP_RANGE_S.end();
        if let Some(value) = self.inner_step_s.filter(|step| !coarsest.contains(step)) {
            return Err(refused("inner_step_s", value, ends(&INNER_STEP_RANGE_S), Quantity::Time));
        }
        if !(MIN_HAND_SPEED..=smoothed_target::MAX_SPEED).contains(&self.hand_speed_m_per_s) {
            let allowed = [MIN_HAND_SPEED, smoothed_target::MAX_SPEED];
            return Err(refused("hand speed", self.hand_speed_m_per_s, allowed, Quantity::Speed));
        }
        if let Some(value) = self.hand_stiffness_n_per_m.filter(|k| !hand::HAND_STIFFNESSES.contains(k)) {
            let allowed = ends(&hand::HAND_STIFFNESSES);
            return Err(refused("hand stiffness", value, allowed, Quantity::ForcePerLength));
        }
        match self.segments {
            Some(n) if !(SEGMENT_RANGE.0..=SEGMENT_RANGE.1).contains(&n) => {
                #[expect(clippy::cast_precision_loss, reason = "only shown")]
                let [value, least, most] = [n, SEGMENT_RANGE.0, SEGMENT_RANGE.1].map(|n| n as f64);
                Err(refused("segments", value, [least, most], Quantity::Number))
            }
            _ => Ok(()),
        }
    }
}

fn refused(name: &'static str, value: f64, allowed: [f64; 2], quantity: Quantity) -> SolveError {
    SolveError::Setting { name, value, allowed, quantity }
}

fn ends(range: &std::ops::RangeInclusive<f64>) -> [f64; 2] {
    [*range.start(), *range.end()]
}

/// The integrator of dynamic steps of `mass-spring`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stepping {
    /// Explicit, or a preview if explicit steps would take more than 1000 sub-steps in 1/60 s.
    #[default]
    Auto,
    /// Always explicit.
    Explicit,
    /// Always a preview (cables with bending stiffness excepted).
    Preview,
}

impl Stepping {
    /// The stepping with this name on the command line.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "auto" => Some(Self::Auto),
            "explicit" => Some(Self::Explicit),
            "preview" => Some(Self::Preview),
            _ => None,
        }
    }
}
