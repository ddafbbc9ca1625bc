//! The registry has one entry for each model: its name, capabilities and constructor. Code outside
//! this folder depends on capabilities of a model, never on its identity.

use std::sync::Arc;

use super::auto::{self, Question};
use super::layers::spans_then_fem::SwitchingModel;
use super::layers::{Layered, leavable_wheels, natural_scale};
use super::mechanics::{Constructor, Mechanics};
use super::mobilised_friction::refuse_mobilised;
use super::settings::Settings;
use super::{catenary, fem, mass_spring, spans};
use crate::error::{SolveError, Unsupported};
use crate::model_id::Model;
use crate::problem::Problem;

/// The capabilities of a model that code outside it needs to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "independent abilities, each asked for by itself")]
pub struct Capabilities {
    /// The model divides cables into elements, whose number a user may choose.
    pub mesh: bool,
    /// Its masses can accelerate.
    pub inertia: bool,
    /// It handles contact with obstacles.
    pub contact: bool,
    /// It handles contact with the outline of the robot; other models get the cable without it.
    pub robot_contact: bool,
    /// It accepts friction that is prescribed as fully mobilised towards one end.
    pub mobilised_friction: bool,
    /// Its nodes can catch on corners, so a sudden rise of tension may be wrong.
    pub nodes_catch: bool,
    /// It computes the tensions of other loading histories if no model knows them in closed form.
    pub explores_histories: bool,
    /// Its equilibria can take long: an editor may show a draft on a coarse mesh meanwhile.
    pub long_rests: bool,
    /// Its steps can take longer than a display frame: an editor may show a copy on a coarse mesh
    /// instead.
    pub long_steps: bool,
    /// It is a second opinion on a coarse mesh: a solution that violates a law is reported with the
    /// findings and not refused.
    pub reports_violations: bool,
}

/// No ability at all; each entry names those it has.
const NO_CAPABILITIES: Capabilities = Capabilities {
    mesh: false,
    inertia: false,
    contact: false,
    robot_contact: false,
    mobilised_friction: false,
    nodes_catch: false,
    explores_histories: false,
    long_rests: false,
    long_steps: false,
    reports_violations: false,
};

/// A result of building a model.
type Built = Result<Box<dyn Mechanics>, SolveError>;

/// An entry of the registry.
#[derive(Clone, Copy, Debug)]
pub struct ModelInfo {
    /// Its name.
    pub model: Model,
    /// Its name on a button or in a legend.
    pub label: &'static str,
    /// Its description in one line.
    pub summary: &'static str,
    /// Its use, and its limits, for a reader who chooses between the models.
    pub help: &'static str,
    /// Its capabilities.
    pub capabilities: Capabilities,
    /// Relative accuracy of its shape (limited by the mesh) and of its equilibrium (limited by the
    /// stopping criterion), which the conformance suite requires.
    pub accuracy: [f64; 2],
    construct: fn(Arc<Problem>, Settings) -> Built,
}

/// The models that solve by themselves, from the least to the most capable.
const SOLVERS: [ModelInfo; 4] = [
    ModelInfo {
        model: Model::Catenary,
        label: "Catenary",
        summary: "elastic catenaries between supports: no contact, no motion, no discretisation error",
        help: "Closed form between supports: no discretisation error. No contact, no bending stiffness; time runs without inertia",
        capabilities: NO_CAPABILITIES,
        accuracy: [1e-9, 1e-9],
        construct: |problem, settings| Ok(Box::new(catenary::CatenaryModel::new(problem, settings)?)),
    },
    ModelInfo {
        model: Model::Spans,
        label: "Spans",
        summary: "exact catenaries between contacts that are intervals of a boundary: friction without a mesh, no motion",
        help: "Exact spans between contacts that are intervals of an obstacle's surface: friction without a mesh. No bending \
               stiffness; time runs without inertia",
        capabilities: Capabilities { contact: true, mobilised_friction: true, long_rests: true, ..NO_CAPABILITIES },
        accuracy: [1e-9, 1e-9],
        construct: |problem, settings| Ok(Box::new(spans::SpansModel::new(problem, settings)?)),
    },
    ModelInfo {
        model: Model::Fem,
        label: "FEM",
        summary: "finite elements with contact, friction, bending and dynamics",
        help: "Finite elements with contact, friction, bending and dynamics",
        capabilities: Capabilities {
            mesh: true,
            inertia: true,
            contact: true,
            robot_contact: true,
            nodes_catch: true,
            explores_histories: true,
            long_rests: true,
            long_steps: true,
            ..NO_CAPABILITIES
        },
        accuracy: [1e-5, 1e-6],
        construct: |problem, settings| Ok(Box::new(fem::FemModel::new(problem, settings)?)),
    },
    ModelInfo {
        model: Model::MassSpring,
        label: "Mass-spring",
        summary: "lumped masses and springs, explicit in time",
        help: "Lumped masses and springs, explicit in time: a quick look at motion, a second opinion at rest",
        capabilities: Capabilities {
            mesh: true,
            inertia: true,
            contact: true,
            reports_violations: true,
            ..NO_CAPABILITIES
        },
        accuracy: [1e-3, 2e-5],
        construct: |problem, settings| Ok(Box::new(mass_spring::MassSpringModel::new(problem, settings)?)),
    },
];

/// The automatic choice: one of the other models, or two that take turns.
const AUTO: ModelInfo = ModelInfo {
    model: Model::Auto,
    label: "Automatic",
    summary: "the cheapest model that can answer",
    help: "The cheapest model that can answer the scene; the reason stands below",
    capabilities: Capabilities {
        mesh: true,
        inertia: true,
        contact: true,
        robot_contact: true,
        mobilised_friction: true,
        ..NO_CAPABILITIES
    },
    accuracy: [1e-5, 1e-6],
    construct: |problem, settings| match auto::choose(&problem, Question::Rest).0 {
        Model::Spans => Ok(Box::new(SwitchingModel::new(problem, settings)?)),
        chosen => construct(chosen, problem, settings),
    },
};

/// A model of the program's own, which [`ModelSource::External`] builds.
const EXTERNAL: ModelInfo = ModelInfo {
    model: Model::External,
    label: "External model",
    summary: "a model that the program brings along",
    help: "A model that the program brings along",
    capabilities: Capabilities { inertia: true, contact: true, ..NO_CAPABILITIES },
    accuracy: [1e-5, 1e-6],
    construct: |_, _| {
        let feature = Unsupported::ExternalModel;
        Err(SolveError::Unsupported { model: Model::External, feature })
    },
};

impl Model {
    /// The most capable model, which accepts what all others refuse.
    pub const MOST_CAPABLE: Self = Self::Fem;

    /// Its entry in the registry.
    #[must_use]
    pub fn info(self) -> ModelInfo {
        match self {
            Self::Auto => AUTO,
            Self::External => EXTERNAL,
            _ => SOLVERS.into_iter().find(|info| info.model == self).unwrap_or(AUTO),
        }
    }

    /// Returns what it can do.
    #[must_use]
    pub fn capabilities(self) -> Capabilities {
        self.info().capabilities
    }

    /// Returns whether the program chooses the model that answers.
    #[must_use]
    pub fn is_automatic(self) -> bool {
        self == Self::Auto
    }

    /// Returns its rank by capability: its place in the registry.
    #[must_use]
    pub fn rank(self) -> usize {
        SOLVERS.iter().position(|info| info.model == self).unwrap_or(0)
    }
}

/// The source of the mechanics of a cable, and of each piece into which it breaks.
#[derive(Clone)]
pub enum ModelSource {
    /// A model of the registry.
    Registered(Model),
    /// A model of the program's own.
    External(Arc<Constructor>),
}

impl std::fmt::Debug for ModelSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("ModelSource").field(&self.model()).finish()
    }
}

impl ModelSource {
    /// Its name.
    #[must_use]
    pub fn model(&self) -> Model {
        match self {
            Self::Registered(model) => *model,
            Self::External(_) => Model::External,
        }
    }

    /// Builds the mechanics of one cable.
    ///
    /// # Errors As [`build`], or those of the program's own constructor.
    pub fn build(&self, problem: Arc<Problem>, settings: Settings) -> Built {
        match self {
            Self::Registered(model) => build(*model, problem, settings),
            Self::External(constructor) => {
                settings.validate_for_coarse_runs()?;
                at_natural_scale(problem, settings, &|problem, settings| constructor(problem, settings))
            }
        }
    }
}

/// Builds the mechanics of one cable. `Auto` is resolved for rest (see `auto::choose`); where it
/// chooses `spans`, `fem` stands behind it (`spans_then_fem.rs`).
///
/// # Errors
/// `Setting` when the settings are out of range, `Unsupported` when the model lacks what the scene
/// needs.
pub fn build(model: Model, problem: Arc<Problem>, settings: Settings) -> Result<Box<dyn Mechanics>, SolveError> {
    settings.validate_for_coarse_runs()?;
    at_natural_scale(problem, settings, &|problem, settings| construct(model, problem, settings))
}

/// Builds a model of the cable, or of its similar copy at the scale that models are made for.
fn at_natural_scale(
    problem: Arc<Problem>,
    settings: Settings,
    construct: &dyn Fn(Arc<Problem>, Settings) -> Built,
) -> Built {
    let Some((by, copy)) = problem.similar.clone() else { return construct(problem, settings) };
    let hand_speed_m_per_s = settings.hand_speed_m_per_s * by.length / by.time;
    let hand_stiffness_n_per_m = settings.hand_stiffness_n_per_m.map(|k| k / by.length);
    let inner = construct(copy, Settings { hand_speed_m_per_s, hand_stiffness_n_per_m, ..settings })?;
    Ok(Box::new(natural_scale::ScaledModel::new(problem, by, inner)))
}

/// The model of a problem, within the layer for wheels that the cable may leave if it has any.
fn construct(model: Model, problem: Arc<Problem>, settings: Settings) -> Built {
    let info = model.info();
    refuse_mobilised(model, &problem)?;
    let bare = move |problem, settings| {
        let problem = if info.capabilities.robot_contact { problem } else { Problem::without_outline(problem) };
        (info.construct)(problem, settings)
    };
    let inner = bare(problem, settings)?;
    let problem = inner.problem().clone();
    let Some(wheels) = problem.wheels.clone().filter(|_| info.capabilities.contact) else { return Ok(inner) };
    let wheels = leavable_wheels::LeavableWheels::new(problem, wheels, settings, Arc::new(bare), inner);
    Ok(Box::new(Layered(wheels)))
}
