//! A solution is the answer to a question about a scene: plain data, whichever model gave it.
//!
//! | room | data |
//! |---|---|
//! | `mod.rs` | [`Solution`], [`CableSolution`]: nodes, supports, contacts, warnings |
//! | `energy.rs` | [`Energy`]: of motion, height, stretch and bending |
//! | `energy_account.rs` | [`EnergyAccount`]: where a cable's energy came from and went to |
//! | `error_estimates.rs` | [`ErrorEstimates`]: how wrong each figure is |
//! | `robot_report.rs` | [`robot_report::RobotReport`]: the vehicle at the same instant |
//! | `shared_nodes.rs` | [`SharedNodes`]: the copies of an answer have them in common |
//! | `model_reason.rs` | [`ModelReason`]: why that model answered |
//! | `inertia_effect.rs` | [`InertiaEffect`]: how fast a motion is, and what it would be without inertia |
//! | `cheaper_choice_error.rs` | [`NextCheaper`]: what the next cheaper choice would have cost |
//! | `material_point_motion.rs` | displacements and accelerations of the nodes, from earlier ones |
//! | `warning/` | [`Warning`]: what a user should know, as data |

mod cheaper_choice_error;
mod energy;
mod energy_account;
pub(crate) mod error_estimates;
mod inertia_effect;
pub(crate) mod material_point_motion;
mod model_reason;
pub(crate) mod robot_report;
mod shared_nodes;
mod warning;

use serde::{Deserialize, Serialize};

use crate::math::{Vec2, larger};
use crate::model_id::Model;
use crate::verification_report::Verification;

pub use self::cheaper_choice_error::{NeglectedEffect, NextCheaper};
pub use self::energy::Energy;
pub use self::energy_account::EnergyAccount;
pub use self::error_estimates::ErrorEstimates;
pub use self::inertia_effect::{InertiaEffect, MotionNumbers};
pub use self::model_reason::{AssumedStiffness, LikelyBending, ModelReason};
pub use self::robot_report::{DriveState, RobotReport, RobotWork};
pub use self::shared_nodes::SharedNodes;
pub use self::warning::{EndMove, Histories, MeanTension, ShownEquilibrium, SlideReason};
pub use self::warning::{Warning, WarningCause, WarningKind};

/// The answer of a model at an instant, all cables of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Solution {
    /// Time, s.
    pub time_s: f64,
    /// The model that gave it.
    pub model: Model,
    /// The reason for that model.
    pub reason: ModelReason,
    /// The error of the next cheaper choice, of a choice by `auto` at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next_cheaper: Option<NextCheaper>,
    /// One a cable, in the scene's order.
    pub cables: Vec<CableSolution>,
    /// Warnings for the user.
    pub warnings: Vec<Warning>,
    /// Cost of the last solve or step.
    pub cost: Cost,
    /// Energy of all cables.
    #[serde(default)]
    pub energy: Energy,
    /// The verification of the answer; `None` if it was not verified (the answer of a single model,
    /// a run read from files).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verification: Option<Verification>,
    /// The robot, where the scene has one that can move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<RobotReport>,
}

/// The answer for one cable.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CableSolution {
    /// The cable's name.
    pub name: String,
    /// Nodes in order of arc length.
    pub nodes: SharedNodes,
    /// Supports in the scene's order.
    pub supports: Vec<SupportReaction>,
    /// Contacts in order of arc length.
    pub contacts: Vec<ContactReport>,
    /// Estimated relative error of the largest tension; None = not estimated.
    pub error_estimate: Option<f64>,
    /// Estimated errors of its figures, each in its own unit.
    #[serde(default)]
    pub errors: ErrorEstimates,
    /// The sharpest bend of its line: the cable's own curve where it is free, the round it is led
    /// by elsewhere; None = nearly straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tightest_bend: Option<Bend>,
    /// Its sharpest bend where nothing leads it: that of its line, or the wider one in which its
    /// bending stiffness, known or likely, lets it hang.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_bend: Option<Bend>,
    /// The sharpest bend where a support or obstacle guides the cable, at a corner or round as the
    /// bending stiffness, known or likely, allows; warnings refer to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub judged_bend: Option<JudgedBend>,
    /// The place at which it is pressed hardest against what leads it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sidewall_pressure: Option<Pressure>,
    /// Index of the first node of each further piece, where the cable has broken; empty while it is
    /// whole. The last node of one piece and the first of the next are the same point of the cable,
    /// at two places. 0 and the number of nodes where it tore off what held it at its start and at
    /// its end.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub breaks: Vec<usize>,
    /// The effects that the answer took into account.
    #[serde(default)]
    pub assumptions: Assumptions,
    /// The greatest tensions of the last step, whose inner steps pull harder than its end; None at
    /// rest and without inertia.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peaks: Option<TensionPeaks>,
    /// Its momentum before and after the last step, and the impulses between; None at rest, without
    /// inertia, and where the model keeps no account of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub momentum: Option<MomentumAccount>,
    /// Its energy since it began to move, and the work of each kind of force; None at rest, without
    /// inertia, and where the model keeps no account of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy_account: Option<EnergyAccount>,
    /// Its unstretched length, m, while it goes to that of the scene: an edit of the length or the
    /// temperature of a moving cable takes effect in time. None otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unstretched_length_m: Option<f64>,
}

/// Balance of a cable's momentum in a step: what it had, and what each kind of force gave it, added
/// up over the inner steps from the very forces that moved it there. Before and impulses add up to
/// after.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MomentumAccount {
    /// The time it is of, s.
    pub over_s: f64,
    /// Momentum of cable and lumped masses as the step began, kg·m/s: that of the answer before.
    pub before_kg_m_per_s: [f64; 2],
    /// The same as it ended, kg·m/s.
    pub after_kg_m_per_s: [f64; 2],
    /// Impulse of the weight of cable and lumped masses, N·s.
    pub weight_n_s: [f64; 2],
    /// Impulse of wind, current and loads, N·s.
    pub loads_n_s: [f64; 2],
    /// Impulse of the supports, pulleys among them, on the cable, N·s.
    pub supports_n_s: [f64; 2],
    /// Impulse of obstacles and floor on the cable, friction and impacts included, N·s.
    pub contacts_n_s: [f64; 2],
}

impl MomentumAccount {
    /// The impulses in the order of the fields, N·s.
    #[must_use]
    pub fn impulses_n_s(&self) -> [[f64; 2]; 4] {
        [self.weight_n_s, self.loads_n_s, self.supports_n_s, self.contacts_n_s]
    }

    /// The same of a similar copy whose times are so many times as long, forces as great.
    pub(crate) fn scale_times(&mut self, by: f64) {
        let Self { over_s, before_kg_m_per_s, after_kg_m_per_s, weight_n_s, loads_n_s, supports_n_s, contacts_n_s } =
            self;
        *over_s *= by;
        let vectors = [before_kg_m_per_s, after_kg_m_per_s, weight_n_s, loads_n_s, supports_n_s, contacts_n_s];
        vectors.into_iter().flatten().for_each(|c| *c *= by);
    }

    /// The account of two pieces of a cable.
    #[must_use]
    pub(crate) fn with(&self, other: &Self) -> Self {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Self {
            before_kg_m_per_s: sum(self.before_kg_m_per_s, other.before_kg_m_per_s),
            after_kg_m_per_s: sum(self.after_kg_m_per_s, other.after_kg_m_per_s),
            over_s: self.over_s,
            ..self.then(other)
        }
    }

    /// The account of this step and the one `after` it.
    #[must_use]
    pub fn then(&self, after: &Self) -> Self {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Self {
            over_s: self.over_s + after.over_s,
            before_kg_m_per_s: self.before_kg_m_per_s,
            after_kg_m_per_s: after.after_kg_m_per_s,
            weight_n_s: sum(self.weight_n_s, after.weight_n_s),
            loads_n_s: sum(self.loads_n_s, after.loads_n_s),
            supports_n_s: sum(self.supports_n_s, after.supports_n_s),
            contacts_n_s: sum(self.contacts_n_s, after.contacts_n_s),
        }
    }
}

/// The greatest tensions of a while in motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TensionPeaks {
    /// The greatest tension of any inner step, not averaged.
    pub greatest: TensionPeak,
    /// The greatest mean over `over_s` at a point of the cable, and when that time ended: where it
    /// reaches the breaking tension the cable breaks.
    pub held: TensionPeak,
    /// The time that means are taken over, s.
    pub over_s: f64,
}

impl TensionPeaks {
    /// The greater of each; `other` of the same cable.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let larger = |a: TensionPeak, b: TensionPeak| if b.tension_n > a.tension_n { b } else { a };
        Self { greatest: larger(self.greatest, other.greatest), held: larger(self.held, other.held), ..other }
    }
}

/// A tension, where on the cable and when.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TensionPeak {
    /// Tension, N.
    pub tension_n: f64,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// Time, s.
    pub time_s: f64,
}

/// The effects of its cable that an answer took into account. What it left out is an error of the
/// model, not an unbalanced force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Assumptions {
    /// Bending stiffness EI, N·m²; 0 = perfectly flexible. After an edit of a cable in motion it is
    /// that of the instant.
    pub bending_stiffness_n_m2: f64,
    /// True if the cable is an obstacle to itself.
    pub self_contact: bool,
    /// True if masses accelerate: forces on a piece of cable then do not add up to nothing.
    pub inertia: bool,
}

impl CableSolution {
    /// The greatest tensions of the step that ended at a time (s): of one without inner steps that
    /// are gauged, and at rest, the greatest of the nodes, which is held.
    #[must_use]
    pub fn peaks_at(&self, time_s: f64) -> TensionPeaks {
        self.peaks.unwrap_or_else(|| {
            let top = MaxTension::of(std::slice::from_ref(self));
            let now = TensionPeak { tension_n: larger(top.tension_n, 0.0), arc_length_m: top.arc_length_m, time_s };
            TensionPeaks { greatest: now, held: now, over_s: 0.0 }
        })
    }

    /// The nodes of each piece, in order of arc length: one piece while the cable is whole.
    pub fn pieces(&self) -> impl Iterator<Item = &[Node]> {
        let starts = std::iter::once(0).chain(self.breaks.iter().copied());
        let ends = self.breaks.iter().copied().chain(std::iter::once(self.nodes.len()));
        starts.zip(ends).filter_map(|(a, b)| self.nodes.get(a..b))
    }
}

/// A bend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bend {
    /// Radius of the centre line, m.
    pub radius_m: f64,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// Its place, m.
    pub x_m: f64,
    /// Its place, m.
    pub y_m: f64,
}

/// A bend as the cable has it with its bending stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JudgedBend {
    /// Place and curvature.
    #[serde(flatten)]
    pub bend: Bend,
    /// The bending stiffness by which corners are judged, N·m²: the cable's own, of one taken as
    /// flexible that which its preset is likely to have; 0 = none is known, and corners bend it to
    /// the radius of their own arc.
    pub bending_stiffness_n_m2: f64,
}

/// Normal force per metre on what leads the cable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pressure {
    /// Tension over radius, N/m.
    pub pressure_n_per_m: f64,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// Its place, m.
    pub x_m: f64,
    /// Its place, m.
    pub y_m: f64,
}

/// One point of the cable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Unstretched arc length at rest temperature, m.
    pub arc_length_m: f64,
    /// Position, m.
    pub x_m: f64,
    /// Position, m.
    pub y_m: f64,
    /// Velocity, m/s.
    pub vx_m_per_s: f64,
    /// Velocity, m/s.
    pub vy_m_per_s: f64,
    /// Tension at this point (not the mean of an element), N.
    pub tension_n: f64,
    /// Engineering strain.
    pub strain: f64,
    /// Tension over the full round cross-section, Pa.
    pub stress_pa: f64,
    /// d(angle)/d(unstretched length), 1/m.
    pub curvature_per_m: f64,
    /// Internal force just beyond this node (at the last one just before it), N: what the cable of
    /// greater arc length does to the cable before it. Its size is the tension of a flexible cable;
    /// a stiff one has shear as well.
    #[serde(default)]
    pub force_n: [f64; 2],
    /// Distance of its material from where it was when the run began, m.
    #[serde(default)]
    pub displacement_m: [f64; 2],
    /// Mean acceleration of its material over the last step with inertia, m/s²; 0 at rest and
    /// without inertia.
    #[serde(default)]
    pub acceleration_m_per_s2: [f64; 2],
}

impl Node {
    /// Position, m.
    #[must_use]
    pub fn at(&self) -> Vec2 {
        Vec2::new(self.x_m, self.y_m)
    }

    /// Internal force, N.
    #[must_use]
    pub fn force(&self) -> Vec2 {
        Vec2::new(self.force_n[0], self.force_n[1])
    }
}

/// The action of the cable on a support.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SupportReaction {
    /// The support's name.
    pub name: String,
    /// Its place, m.
    pub x_m: f64,
    /// Its place, m.
    pub y_m: f64,
    /// Force of the cable on the support, N.
    pub reaction_x_n: f64,
    /// Force of the cable on the support, N.
    pub reaction_y_n: f64,
    /// Place on the cable it sits now, m.
    pub arc_length_m: f64,
    /// Pulley: tension on the side of smaller arc length, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tension_before_n: Option<f64>,
    /// Pulley: tension on the side of greater arc length, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tension_after_n: Option<f64>,
    /// The hand that holds the support by a spring, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hand: Option<HandReport>,
}

/// A hand that holds a support by a linear spring, with a damper beside it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HandReport {
    /// The spring's free end, m.
    pub x_m: f64,
    /// The spring's free end, m.
    pub y_m: f64,
    /// Of the spring, N/m.
    pub stiffness_n_per_m: f64,
    /// Force of the hand on the cable, N.
    pub force_x_n: f64,
    /// Force of the hand on the cable, N.
    pub force_y_n: f64,
}

impl HandReport {
    /// Size of its force, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.force_x_n.hypot(self.force_y_n)
    }
}

/// State of a contact: it sticks or slides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactState {
    /// Held by friction.
    #[default]
    Stick,
    /// Sliding.
    Slip,
}

/// One contact of the cable with an obstacle: a point, or a stretch (a lay or a wrap).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactReport {
    /// The obstacle's name.
    pub obstacle: String,
    /// Middle of the contact, m.
    pub x_m: f64,
    /// Middle of the contact, m.
    pub y_m: f64,
    /// Arc length of its middle, m.
    pub arc_length_m: f64,
    /// Outward normal (obstacle to cable), unit vector.
    pub normal: [f64; 2],
    /// Normal force integrated over the contact, N.
    pub normal_n: f64,
    /// Friction force on the cable along growing arc length, integrated over the contact, N.
    pub friction_n: f64,
    /// Holds or slides.
    pub state: ContactState,
    /// Wrap angle: the turn of the cable along growing arc length, °, positive anticlockwise (to
    /// the left) and negative clockwise, with whole turns counted. A cable that runs to the right
    /// over a post and down on its far side has about −180.
    pub turn_deg: f64,
    /// Tension before the contact (smaller arc length), N.
    pub tension_before_n: f64,
    /// Tension after the contact (greater arc length), N.
    pub tension_after_n: f64,
    /// Arc length where it begins, m; its middle for a point.
    #[serde(default)]
    pub begins_m: f64,
    /// Arc length where it ends, m; its middle for a point.
    #[serde(default)]
    pub ends_m: f64,
    /// The stretches of a contact of which some stick while others have slid, in order; slip fronts
    /// are where they meet. The list is empty if the whole contact is in the state `state`, and if
    /// the model does not know.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<ContactPart>,
    /// Whole force of the obstacle on the cable, N: normal force and friction. Of a contact of the
    /// cable with itself it is nothing.
    #[serde(default)]
    pub force_n: [f64; 2],
    /// The same along the contact, in order of arc length: it adds up to `force_n`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub samples: Vec<ContactSample>,
}

/// Force of an obstacle on a short stretch of the cable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactSample {
    /// Arc length of its middle, m.
    pub arc_length_m: f64,
    /// Force on the cable, N.
    pub force_n: [f64; 2],
}

impl ContactSample {
    /// A force (N) at an arc length (m).
    #[must_use]
    pub fn new(arc_length_m: f64, force: Vec2) -> Self {
        Self { arc_length_m, force_n: [force.x, force.y] }
    }
}

/// A stretch of a contact that sticks or has slid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactPart {
    /// Arc length where it begins, m.
    pub begins_m: f64,
    /// Arc length where it ends, m.
    pub ends_m: f64,
    /// Slip: friction is at its limit there, and a little more pull moves it on.
    pub state: ContactState,
}

impl ContactReport {
    /// Sets the forces along the contact and their sum.
    pub(crate) fn set_samples(&mut self, samples: Vec<ContactSample>) {
        self.force_n = samples.iter().fold([0.0; 2], |sum, s| [sum[0] + s.force_n[0], sum[1] + s.force_n[1]]);
        self.samples = samples;
    }

    /// Returns where on the cable it begins and ends, m: never empty of its middle.
    #[must_use]
    pub fn extent_m(&self) -> [f64; 2] {
        let middle = self.arc_length_m;
        if self.begins_m <= middle && middle <= self.ends_m { [self.begins_m, self.ends_m] } else { [middle; 2] }
    }
}

/// Cost of a solve or step. The core has no clock: wall time is the caller's to measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Newton iterations, or explicit sub-steps.
    pub iterations: usize,
    /// Steps that had to be halved.
    pub halved_steps: usize,
    /// Largest unbalanced force left, N.
    pub residual_n: f64,
    /// Inner time step, s; 0 for statics.
    pub inner_step_s: f64,
}

/// The largest tension and where.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaxTension {
    /// Tension, N.
    pub tension_n: f64,
    /// Index of the cable.
    pub cable: usize,
    /// Arc length, m.
    pub arc_length_m: f64,
}

impl MaxTension {
    /// The greatest tension of some cables (NaN propagates).
    #[must_use]
    pub fn of(cables: &[CableSolution]) -> Self {
        let mut best = Self { tension_n: f64::NEG_INFINITY, ..Self::default() };
        for (cable, c) in cables.iter().enumerate() {
            for n in &c.nodes {
                if n.tension_n > best.tension_n || n.tension_n.is_nan() {
                    best = Self { tension_n: n.tension_n, cable, arc_length_m: n.arc_length_m };
                }
                if n.tension_n.is_nan() {
                    return best;
                }
            }
        }
        best
    }
}

impl Solution {
    /// The largest tension over all cables (NaN propagates).
    #[must_use]
    pub fn max_tension(&self) -> MaxTension {
        MaxTension::of(&self.cables)
    }

    /// The greatest tensions of the step that ended here, over all cables.
    #[must_use]
    pub fn peaks(&self) -> TensionPeaks {
        let all = self.cables.iter().map(|c| c.peaks_at(self.time_s));
        all.reduce(TensionPeaks::with).unwrap_or_default()
    }

    /// The energy accounts of all cables that have one together.
    #[must_use]
    pub fn energy_account(&self) -> Option<EnergyAccount> {
        self.cables.iter().filter_map(|c| c.energy_account).reduce(|a, b| a.with(&b))
    }
}
