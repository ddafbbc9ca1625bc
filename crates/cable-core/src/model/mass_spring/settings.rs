//! These settings are the tuned constants of the model. [`Tuning::default`] has the values that the
//! program uses; a measurement (`cargo run --release -p cable-benches --bin tuned-settings`) tries
//! others.

use serde::{Deserialize, Serialize};

/// The tuned constants of the model, in groups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tuning {
    /// The mesh.
    pub mesh: MeshTuning,
    /// Explicit sub-steps.
    pub sub_step: SubStepTuning,
    /// Impulses of contacts in a sub-step.
    pub impact: ImpactTuning,
    /// The limits of a motion that runs away.
    pub runaway: RunawayTuning,
    /// Sub-steps of the preview.
    pub preview: PreviewTuning,
    /// Contact and friction at rest.
    pub contact: ContactTuning,
    /// Newton's method.
    pub newton: NewtonTuning,
    /// Quasi-static steps.
    pub quasi_static: QuasiStaticTuning,
    /// Error estimates.
    pub estimate: EstimateTuning,
}

/// Constants of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeshTuning {
    /// Elements where neither scene nor settings give a number. Fewer is visibly angular, more
    /// makes sub-steps shorter and dearer.
    pub segments: usize,
    /// Least distance between nodes, in even lengths, with which nodes of another model are
    /// adopted, and first distance of a sliding support from its neighbours. Smaller: short
    /// sub-steps; larger: shapes are resampled, and their elements cut corners.
    pub min_spacing_lengths: f64,
    /// Greatest first fraction of the cable on the path to the last support if the path is longer
    /// than the cable: the rest hangs, and the first equilibrium corrects it. Smaller: a start
    /// farther from a taut equilibrium; larger: a hanging end gets no element.
    pub max_path_fraction: f64,
    /// Damping ratio, at the fastest axial mode, of the viscous loss that a spring has in the
    /// sub-step in which it becomes taut. Smaller lets springs that go slack and taut near the
    /// stability limit pump energy into violent motion (without any, an undamped cable dropped into
    /// its supports gained 270 kJ in 4 s); larger stops what snaps taut.
    pub impact_damping: f64,
    /// Greatest damping ratio, of the fastest modes, of the viscous loss that is asked for beyond
    /// the constant one. Smaller takes damping from slower modes that the scene asks for, larger
    /// shortens the stable step without visible change.
    pub max_mode_damping: f64,
    /// Straight part of an element beside a pulley, of the even length, below which its other node
    /// is removed. Smaller shortens the stable step, larger remeshes more often.
    pub min_straight_lengths: f64,
    /// Straight part of an element beside a pulley, of the even length, beyond which it is halved.
    /// Smaller remeshes more often, larger leaves long elements.
    pub max_straight_lengths: f64,
    /// Straight part of an element, of the even length, at which material stops beside a node that
    /// cannot be removed. Smaller shortens the stable step, larger stops a support or load farther
    /// from the pulley.
    pub blocked_straight_lengths: f64,
    /// Greatest sag of a new node, as a fraction of half of the element that it divides. Smaller:
    /// nodes on the chord; larger: the sag is computed from the meaningless tension of slack
    /// elements.
    pub max_sag_lengths: f64,
    /// Greatest change of rest length that is spread over a stretch beside a pulley, of the rest of
    /// it. Smaller lets tension jump where nodes change, larger moves nodes along the material.
    pub max_spread_fraction: f64,
    /// Ratio of the tension to the weight of half an element below which the direction of the force
    /// at a pulley is that of the element. Smaller: the direction of slack cable is used; larger:
    /// weight is neglected.
    pub direction_tension_ratio: f64,
}

impl Default for MeshTuning {
    fn default() -> Self {
        Self {
            segments: 60,
            min_spacing_lengths: 0.2,
            max_path_fraction: 0.95,
            impact_damping: 0.1,
            max_mode_damping: 1.0,
            min_straight_lengths: 0.3,
            max_straight_lengths: 1.7,
            blocked_straight_lengths: 0.1,
            max_sag_lengths: 0.1,
            max_spread_fraction: 0.01,
            direction_tension_ratio: 4.0,
        }
    }
}

/// Constants of explicit sub-steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SubStepTuning {
    /// Number of sub-steps in a display frame of 1/60 s beyond which a step is a preview by
    /// default; at 100 elements 1000 of them take some 100 ms a simulated second. Smaller previews
    /// cables that could be computed, larger lets the window fall behind.
    pub max_per_frame: f64,
    /// Part of the stable sub-step that is used. Smaller is slower, larger is unstable as elements
    /// stretch.
    pub stable_fraction: f64,
    /// Greatest distance that a node travels in a sub-step beside obstacles, of the cable's radius.
    /// Smaller is slower, larger could pass a thin obstacle.
    pub max_travel_radii: f64,
    /// Shortest sub-step, of the stable one, below which a motion has run away. Smaller computes
    /// longer before it refuses, larger refuses fast motion.
    pub min_stable_fraction: f64,
}

impl Default for SubStepTuning {
    fn default() -> Self {
        Self { max_per_frame: 1000.0, stable_fraction: 0.8, max_travel_radii: 0.25, min_stable_fraction: 1e-6 }
    }
}

/// Constants of contacts in sub-steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImpactTuning {
    /// Distance from obstacles at which contacts are looked for beside what is travelled, m.
    /// Smaller asks for distances more often, larger keeps more contacts that do not touch.
    pub skin_m: f64,
    /// Greatest speed at which a penetration is pushed out, m/s. Smaller lets the cable sink for
    /// longer, larger throws it off.
    pub push_out_speed_m_per_s: f64,
    /// Time in which a shallow penetration is pushed out, s. Smaller makes a cable jump that rests
    /// a few micrometres deep, larger lets it sink for longer.
    pub push_out_time_s: f64,
    /// Passes over the contacts of a sub-step. One leaves neighbours in each other's way, more than
    /// two change nothing visible.
    pub passes: usize,
}

impl Default for ImpactTuning {
    fn default() -> Self {
        Self { skin_m: 1e-4, push_out_speed_m_per_s: 1.0, push_out_time_s: 0.02, passes: 2 }
    }
}

/// Limits of a motion that runs away.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunawayTuning {
    /// Greatest ratio of the kinetic energy to the energy that supports, loads and stretch can have
    /// given. Smaller damps real whips, larger shows an explosion first.
    pub max_energy_ratio: f64,
    /// Factor of velocities after a sub-step with more energy: 0.7 removes a tenfold energy in
    /// seven sub-steps. Smaller stops the cable at once, larger lets the energy grow on.
    pub brake_factor: f64,
}

impl Default for RunawayTuning {
    fn default() -> Self {
        Self { max_energy_ratio: 10.0, brake_factor: 0.7 }
    }
}

/// Constants of the preview.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PreviewTuning {
    /// Longest sub-step, s. Smaller costs in proportion, larger damps motion and softens contacts
    /// visibly.
    pub max_sub_step_s: f64,
    /// Shortest sub-step, of the longest. Smaller computes snaps, larger damps them, for a sub-step
    /// or two.
    pub min_sub_step_fraction: f64,
    /// Greatest ω²h² of swings across the cable; 4/3 is unstable. Smaller costs more.
    pub max_swing: f64,
    /// Times that springs and contacts are solved in turns in a sub-step. Fewer let contacts of a
    /// fine mesh stretch it, more cost where much strikes at once.
    pub max_contact_passes: usize,
    /// Change of a contact's position that is neglected, in elements times the greatest strain.
    /// Larger: tensions beside contacts tremble; smaller: more passes.
    pub contact_strain_fraction: f64,
    /// Rounds that leave out compressed elements and decide between stick and slip at pulleys. In
    /// most sub-steps one suffices; the last round is accepted as it is, with an error of one
    /// sub-step.
    pub max_rounds: usize,
}

impl Default for PreviewTuning {
    fn default() -> Self {
        Self {
            max_sub_step_s: 1.0 / 600.0,
            min_sub_step_fraction: 1.0 / 64.0,
            max_swing: 1.0,
            max_contact_passes: 20,
            contact_strain_fraction: 0.01,
            max_rounds: 8,
        }
    }
}

/// Constants of contact and friction at rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactTuning {
    /// Gap at which the contact force begins, m; the whole load on one contact closes it. Smaller
    /// is stiffer and takes more steps, larger lifts the cable.
    pub offset_m: f64,
    /// Distance to an obstacle, m, within which the cable of the first shape lies on it: the
    /// barrier of `fem` keeps a millimetre. Smaller lets the cable slide while it falls that far,
    /// larger anchors stretches that hang beside.
    pub first_contact_m: f64,
    /// Slide at which friction is fully mobilised, m. Smaller: more steps; larger: creep, and near
    /// a supported end, where a stiff cable moves by less, friction is not fully mobilised.
    pub slip_m: f64,
    /// Distance along the material, in even lengths, within which a contact takes over an anchor.
    /// Smaller forgets friction where contacts move along the cable, larger takes the anchor of a
    /// neighbour.
    pub anchor_reach_lengths: f64,
    /// Part of the greatest friction from which on a contact counts as sliding. Smaller reports
    /// sticking contacts as sliding, larger the reverse.
    pub slip_fraction: f64,
    /// Slide through a pulley at which its friction is fully mobilised, m. Smaller: more steps;
    /// larger: creep.
    pub pulley_slip_m: f64,
}

impl Default for ContactTuning {
    fn default() -> Self {
        Self {
            offset_m: 2e-5,
            first_contact_m: 2e-3,
            slip_m: 5e-6,
            anchor_reach_lengths: 0.75,
            slip_fraction: 0.999,
            pulley_slip_m: 1e-6,
        }
    }
}

/// Constants of Newton's method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonTuning {
    /// Unbalanced force at equilibrium in the air, of the force scale. Smaller is hindered by
    /// round-off, larger shows in the reactions.
    pub residual: f64,
    /// The same tolerance for a cable that can touch an obstacle: contacts that come and go leave
    /// more.
    pub touching_residual: f64,
    /// Factor by which the stiffness that elements have from their first tension fades in each
    /// step. (Bars of `fem` are shorter by their sag, which is more than a stiff spring stretches,
    /// so springs in its shape are slack.) Smaller starts with wild steps, larger makes truly slack
    /// elements slow.
    pub first_stiffness_fade: f64,
    /// Greatest number of steps. The hardest scene of the catalogue takes some 200. Smaller refuses
    /// scenes, larger takes longer to refuse.
    pub max_steps: usize,
    /// First shift of the diagonal, of EA over the shortest element. Smaller starts with wild
    /// steps, larger wastes a few.
    pub first_shift: f64,
    /// Factor of the shift after a step that lowers the energy. Smaller follows with wild steps,
    /// larger wastes steps.
    pub shift_decrease: f64,
    /// Factor of the shift after a step that does not. Smaller takes more trials, larger shortens
    /// the next steps too much.
    pub shift_increase: f64,
    /// Shift, of EA over the shortest element or of the stiffness of contacts, beyond which the
    /// solve fails. Smaller gives up early, larger late.
    pub max_shift: f64,
    /// Steps in which friction follows the normal forces at once, which is fastest; later ones
    /// first solve with them frozen, as the first may run in circles. Smaller freezes soon, larger
    /// circles for longer.
    pub eager_friction_steps: usize,
    /// Greatest number of steps with frozen normal forces. Smaller follows half-solved forces,
    /// larger solves for forces that are out of date.
    pub max_frozen_steps: usize,
    /// Greatest move of a node in a step beside obstacles, of the cable's radius. Smaller takes
    /// more steps, larger steps over an edge.
    pub max_move_radii: f64,
    /// Greatest slide through a pulley in a step, of the even length. Smaller takes more steps,
    /// larger turns an element inside out.
    pub max_slide_lengths: f64,
}

impl Default for NewtonTuning {
    fn default() -> Self {
        Self {
            residual: 1e-9,
            touching_residual: 1e-7,
            first_stiffness_fade: 0.1,
            max_steps: 1500,
            first_shift: 1e-8,
            shift_decrease: 0.1,
            shift_increase: 8.0,
            max_shift: 1e3,
            eager_friction_steps: 150,
            max_frozen_steps: 25,
            max_move_radii: 0.5,
            max_slide_lengths: 0.25,
        }
    }
}

/// Constants of quasi-static steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct QuasiStaticTuning {
    /// Longest path of supports between two equilibria, of the even length (friction is measured
    /// from where the material was, and a longer path leaves that element) and of the cable's
    /// radius beside obstacles (a longer path stretches the end so far that Newton's first steps
    /// draw a node in under a corner, where it locks). Smaller is slower.
    pub max_path_lengths: f64,
    /// Greatest number of equilibria in a step. Smaller goes farther at once in long steps, larger
    /// takes longer.
    pub max_parts: f64,
    /// Points of a motion within a step that measure its path. Fewer miss a motion to and fro.
    pub path_samples: u32,
}

impl Default for QuasiStaticTuning {
    fn default() -> Self {
        Self { max_path_lengths: 0.5, max_parts: 1e4, path_samples: 8 }
    }
}

/// Constants of error estimates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EstimateTuning {
    /// Least error of the finest of three meshes, of the difference of the coarser two: 0.5 is that
    /// of the first order. Smaller states too small errors at corners, larger too great ones in the
    /// air.
    pub first_order_fraction: f64,
    /// Least number of nodes that share the turn of a round; fewer make a corner. Smaller takes
    /// corners for rounds and states too small errors, larger the reverse.
    pub round_nodes: usize,
    /// Part of the largest turn at a node from which on another node shares it. Smaller takes
    /// corners for rounds, larger the reverse.
    pub turn_share: f64,
    /// Least turn of an obstacle, rad: the nodes of a cable on a flat floor differ by less. Smaller
    /// finds corners on floors, larger overlooks them.
    pub min_turn_rad: f64,
    /// Greatest angle used in the error bound, rad (1.4 is 80°): for larger ones the bound would
    /// grow without meaning. Smaller: too small errors at sharp corners.
    pub max_turn_rad: f64,
}

impl Default for EstimateTuning {
    fn default() -> Self {
        Self { first_order_fraction: 0.5, round_nodes: 3, turn_share: 0.2, min_turn_rad: 1e-3, max_turn_rad: 1.4 }
    }
}
