//! These modules integrate in time: BDF2, step sizes, sleep, hands, impulses, damping, impacts, and
//! rollback of failed steps.
//!
//! | room | content |
//! |---|---|
//! | `bdf2.rs` | weights of BDF2, blended with BDF3 without contact |
//! | `step_inertia.rs` | masses, predicted positions and damping of a step |
//! | `sliding_tensions.rs` | tensions between which friction acted at sliding nodes |
//! | `time_control.rs` | data of the time control: step size, sleep, tolerance, end of the advance |
//! | `step_size.rs` | step length from the observed frequency and the number of iterations |
//! | `hands.rs` | hands that drag supports, by a spring or directly, and their warnings |
//! | `plastic_impact.rs` | inelastic contacts: normal speed of an impact removed after the step |
//! | `loss_memory.rs` | state of the relaxation branches of material loss, from step to step |
//! | `step_impulses.rs` | impulse of each kind of force in a step, for the momentum account |
//! | `step_work.rs` | work of each kind of force in a step, for the energy account |
//! | `rollback.rs` | checkpoint of the state, restored if a step fails |
//! | `slack_recoil.rs` | impulses of bars that became slack, taken out of the history |
//! | `sleeping.rs` | a cable at rest is frozen until its loads or supports change |

pub(in crate::model::fem) mod bdf2;
pub(in crate::model::fem) mod hands;
pub(in crate::model::fem) mod loss_memory;
pub(in crate::model::fem) mod plastic_impact;
pub(in crate::model::fem) mod rollback;
pub(in crate::model::fem) mod slack_recoil;
pub(in crate::model::fem) mod sleeping;
pub(in crate::model::fem) mod sliding_tensions;
pub(in crate::model::fem) mod step_impulses;
pub(in crate::model::fem) mod step_inertia;
pub(in crate::model::fem) mod step_size;
pub(in crate::model::fem) mod step_work;
pub(in crate::model::fem) mod time_control;

pub(in crate::model::fem) use bdf2::Weights;
pub(in crate::model::fem) use hands::HandDrive;
#[cfg(test)]
pub(in crate::model::fem) use plastic_impact::land_on_itself;
pub(in crate::model::fem) use rollback::Rollback;
pub(in crate::model::fem) use slack_recoil::{forget_slack_impulses, remember_impulses};
pub(in crate::model::fem) use sleeping::Sleep;
pub(in crate::model::fem) use sliding_tensions::keep_balanced_tensions;
pub(in crate::model::fem) use step_impulses::{account_for_step, forces_in_step};
pub(in crate::model::fem) use step_inertia::set_inertia;
pub(in crate::model::fem) use step_size::StepSizeController;
pub(in crate::model::fem) use step_work::work_in_step;
pub(in crate::model::fem) use time_control::TimeControl;
