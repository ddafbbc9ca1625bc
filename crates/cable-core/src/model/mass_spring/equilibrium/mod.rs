//! These modules find equilibria and steps without inertia.
//!
//! | room | content |
//! |---|---|
//! | `static_rest.rs` | the cable at rest where its supports are |
//! | `quasi_static.rs` | steps without inertia: supports move, the cable rests, friction remembers |
//! | `newton.rs` | Newton's method on the energy of the mesh, with a Levenberg shift |
//! | `system.rs` | gradient, banded Hessian and factor; σ in the place of a pulley node's x |
//! | `assembly.rs` | energies of springs, loads and bending with their derivatives |
//! | `contact_energy.rs` | contact springs and friction measured from anchors, as energies |

pub(in crate::model::mass_spring) mod assembly;
pub(in crate::model::mass_spring) mod contact_energy;
pub(in crate::model::mass_spring) mod newton;
pub(in crate::model::mass_spring) mod quasi_static;
pub(in crate::model::mass_spring) mod static_rest;
pub(in crate::model::mass_spring) mod system;

pub(in crate::model::mass_spring) use contact_energy::Anchors;
pub(in crate::model::mass_spring) use quasi_static::quasi_static_step;
pub(in crate::model::mass_spring) use static_rest::find_equilibrium;
