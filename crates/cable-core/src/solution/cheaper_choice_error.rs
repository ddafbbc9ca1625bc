//! The next cheaper choice is reported beside an answer, with what it would have cost in error.

use serde::{Deserialize, Serialize};

use crate::model_id::Model;

/// An effect that a cheaper model leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NeglectedEffect {
    /// The bending stiffness of the cable.
    BendingStiffness,
    /// The contact of the cable with itself.
    SelfContact,
    /// The friction of the floor in plan view.
    FloorFriction,
    /// The obstacles.
    Obstacles,
    /// The friction of wheels and eyes.
    WheelFriction,
    /// The inertia of all masses.
    Inertia,
}

/// The next cheaper choice of a model, with its error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NextCheaper {
    /// The model.
    pub model: Model,
    /// The effect that it neglects.
    pub neglects: NeglectedEffect,
    /// Greatest difference of a support's force and of the greatest tension, as a fraction of the
    /// greatest tension; `None` if the cheaper model has no answer.
    pub force_error: Option<f64>,
    /// Greatest distance between the two places of a point of the cable, m; `None` if the cheaper
    /// model has no answer.
    pub position_error_m: Option<f64>,
    /// True if it was given up because it took more work than the answer itself: its errors are not
    /// known, and it is not cheaper.
    #[serde(default)]
    pub costs_more: bool,
}
