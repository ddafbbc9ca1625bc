//! The stepper takes the implicit steps of a meshed cable: with inertia, without it, and those of a
//! relaxation to its equilibrium.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | [`Stepper`]: the state of the cable and what steps need beside it; the input of a step |
//! | `advance.rs` | an advance in inner steps, and its report |
//! | `dynamic_step.rs` | one step with inertia |
//! | `halving.rs` | a step that fails, taken again in halves |
//!
//! Steps without inertia and the search for an equilibrium are in `equilibrium`.

mod advance;
mod dynamic_step;
mod halving;

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::fem::first_shape::cable_along_route;
use crate::model::fem::newton::{MixedFreeSolver, NodalWays, SolverMemory, WorkspaceMemory};
use crate::model::fem::obstacle::prepare_way;
use crate::model::fem::results;
use crate::model::fem::settings::Tuning;
use crate::model::fem::state::CableState;
use crate::model::fem::system::{Failure, Unknowns, WorkBudget};
use crate::model::fem::time::{HandDrive, Rollback, Sleep, StepSizeController, TimeControl, Weights, set_inertia};
use crate::model::{Inertia, Settings};
use crate::problem::Problem;
use crate::solution::CableSolution;

/// The request that all steps of an `advance` share.
#[derive(Clone, Copy, Debug)]
struct StepRequest<'a> {
    /// End of the `advance`, s: without inertia hands drag supports evenly to their positions at
    /// that time.
    due: f64,
    inertia: Inertia,
    /// The places to which supports are dragged, m.
    dragged: &'a [Option<Vec2>],
}

/// A meshed cable in motion, or at rest with possible contacts, and the solvers that advance it.
#[derive(Clone, Debug)]
pub struct Stepper {
    pub(super) cable: CableState,
    pub(super) hand_drive: HandDrive,
    pub(super) time_control: TimeControl,
    pub(super) solver: SolverMemory,
    pub(super) rollback: Rollback,
    /// True if it has come to rest, or moves from an equilibrium.
    pub(super) rested: bool,
    /// True if an energy account is kept.
    pub(super) accounts_energy: bool,
}

impl Stepper {
    /// Builds the cable along its route.
    ///
    /// # Errors None today: a feature that the model lacks is refused when it is requested.
    pub fn new(problem: Arc<Problem>, settings: Settings, tuning: Arc<Tuning>) -> Result<Self, SolveError> {
        let longest = tuning.step.longest_s;
        let cable = cable_along_route(problem, settings, tuning);
        Ok(Self {
            rollback: Rollback::default(),
            solver: SolverMemory {
                unknowns: Unknowns::default(),
                memory: WorkspaceMemory(None),
                free: MixedFreeSolver::default(),
                ways: NodalWays::default(),
                decay: Vec::new(),
                work_left: WorkBudget::Unlimited,
                work_of_advance: WorkBudget::Unlimited,
            },
            time_control: TimeControl {
                step_size: StepSizeController::new(settings.inner_step_s.unwrap_or(longest)),
                sleep: Sleep::default(),
                tolerance: settings.tolerance,
                due: f64::INFINITY,
            },
            hand_drive: HandDrive {
                hand_speed: settings.hand_speed_m_per_s,
                hand_stiffness: settings.hand_stiffness_n_per_m,
                pulled: vec![false; cable.problem.supports.len()],
                hand_targets: Vec::new(),
            },
            rested: false,
            accounts_energy: settings.energy_account,
            cable,
        })
    }

    /// Forgets the earlier steps, and the frequency observed in them.
    pub(super) fn forget_history(&mut self) {
        self.cable.forget_history();
        self.time_control.step_size.forget();
    }

    /// The answer at this instant.
    #[must_use]
    pub fn solution(&self) -> CableSolution {
        results::solution(&self.cable)
    }

    /// Sets the input of a step of `h` (s); returns the weights of its history.
    pub(in crate::model::fem) fn begin_step(&mut self, h: f64, dragged: &[Option<Vec2>]) -> Result<Weights, Failure> {
        self.hand_drive.follow(&mut self.cable, self.time_control.due, h, dragged);
        let now = self.cable.motion.time;
        prepare_way(&mut self.cable, [now, now + h], Some(dragged))?;
        self.cable.contacts.set_slip(self.cable.contacts.tuning.slip_m);
        let contact = self.cable.contacts.tuning;
        self.cable.adapt_stiffness([contact.stiffness_rise, contact.stiffness_fall], 1.0);
        let weights = Weights::of_step(&self.cable.motion, h);
        set_inertia(&mut self.cable, weights, h, &mut self.solver.decay);
        let (m, input, mesh) = (&self.cable.motion, &self.cable.input, &self.cable.mesh);
        self.cable.contacts.list_neighbours(&self.cable.problem, mesh, &m.positions, |k| {
            if mesh.fixity[k] { (input.supports.target[k] - m.positions[k]).norm() } else { m.velocities[k].norm() * h }
        });
        Ok(weights)
    }
}
