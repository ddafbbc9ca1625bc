//! The settings of `spans` are its tuned constants in one place, grouped by what they govern.
//!
//! Here stands what was chosen by trial: limits of iterations, first steps, distances within which
//! things are taken for one. Constants that rounding or an error bound fixes stand beside the code
//! that they belong to, as do the tolerances by which the model checks its own answers.
//!
//! The values were found on the scenes of the catalogue and on random scenes; the program
//! `tuned-settings` halves and doubles each and prints what moves (`docs/notes/settings.md`).

use serde::{Deserialize, Serialize};

use crate::model::settings::MAX_MOVE_FRACTION;

/// All settings of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SpansSettings {
    /// Newton's method for a section.
    pub newton: NewtonSettings,
    /// Steps from an equilibrium to another.
    pub continuation: ContinuationSettings,
    /// The first shape.
    pub initial: InitialSettings,
    /// Contacts that come and go.
    pub changes: ChangeSettings,
    /// Causes of failures, and corners passed through.
    pub acceptance: AcceptanceSettings,
}

/// Newton's method for a section, and the prediction of slip before it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonSettings {
    /// Most iterations. Smaller: steps are halved that would have converged. Larger: a failure
    /// costs more, and is not cured.
    pub max_iterations: usize,
    /// Most iterations without progress. Smaller: a slow start counts as a failure. Larger: a
    /// failure costs more.
    pub max_stalled: usize,
    /// Most halvings of one step. Smaller: the edge of a contact stops a step for good. Larger: a
    /// failure costs more.
    pub max_halvings: usize,
    /// Residual wanted: of lengths in hundredths of the section, of angles, of tensions relative.
    /// Smaller: iterations spent on rounding. Larger: forces are off by as much.
    pub residual: f64,
    /// Part of T/EA above which a residual that suffices is lowered by one more step: forces are
    /// off by a hundredth of this part then. Smaller: a step more in each solve. Larger: forces of
    /// stiff cables are as exact as their tolerance, 1e-8.
    pub refined_residual_factor: f64,
    /// Multiple of the residual wanted below which a residual that no step lowers counts as
    /// rounding. Smaller: rounding fails a step. Larger: a step that was halved often enough is
    /// taken without having been solved.
    pub stalled_residual_factor: f64,
    /// Greatest turn of a contact's end in one iteration, rad. Smaller: more iterations round a
    /// post. Larger: the end jumps a turn of a post.
    pub max_turn: f64,
    /// Part of its material that a span keeps at least in one iteration. Smaller: a span shrinks to
    /// rounding in a few iterations. Larger: more iterations where one shrinks.
    pub kept_material_fraction: f64,
    /// Residual below which modes are judged. Smaller: iterations spent on a mode that will not
    /// last. Larger: a contact slides because an iterate has tensions it will not keep, and what is
    /// held at neither end slides away.
    pub mode_residual: f64,
    /// Iterations without progress after which modes are judged all the same. Smaller: as with a
    /// larger [`Self::mode_residual`]. Larger: iterations spent on a mode that will not last.
    pub mode_stalled_iterations: usize,
    /// Multiple of rounding up to which violations of the friction cone are tolerated where modes
    /// cycle. Smaller: cycles at the edge of the cone fail. Larger: friction beyond its cone is
    /// accepted.
    pub cycle_rounding_factor: f64,
    /// Most changes of mode of one contact while iterating; four times as many between converged
    /// states. Smaller: a mode stays wrong, and the step is halved. Larger: cycles last longer.
    pub max_mode_changes: u32,
    /// The prediction of slip.
    pub slip: SlipSettings,
}

/// The prediction of which contacts slide in a step, before it is solved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SlipSettings {
    /// Most rounds of Newton's method, and of changing sides beside two for each contact. Smaller:
    /// a worse guess, or none where many contacts change. Larger: each costs a tenth of an
    /// iteration of Newton's method for the whole.
    pub newton_rounds: usize,
    /// Change of tension, as part of it, from which another round is worth its cost: what is left
    /// after it is about that squared. Smaller: more rounds. Larger: a worse guess.
    pub round_tolerance: f64,
    /// Change of tension, as part of it, in the last of all rounds with which its guess is still
    /// taken. Smaller: guesses are thrown away. Larger: guesses are taken that lead away.
    pub accepted_tension_change: f64,
    /// Greatest factor by which the tension of a span may change in a round. Smaller: no prediction
    /// in large steps. Larger: the linear spans of the guess no longer hold.
    pub max_tension_factor: f64,
    /// Greatest angle by which a contact's end follows its span, rad. Smaller: ends stay behind in
    /// large steps. Larger: an end follows round a post.
    pub max_followed_angle: f64,
}

/// Steps from an equilibrium to another, and the way to the first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContinuationSettings {
    /// Greatest move of a support in one solve, of the cable's length. Smaller: more solves.
    /// Larger: sliding that starts and reverses inside a step is missed, and what is laid down in a
    /// step is laid with the tension it began with.
    pub max_move_fraction: f64,
    /// Most halvings of a step: 2⁻¹² of a step of 1 % of the cable is a hair's breadth. Smaller:
    /// steps fail. Larger: a failure costs more.
    pub max_halvings: u32,
    /// Part of the way to an instant at which a step is first tried. Smaller: more steps. Larger: a
    /// long span sags into what is below it.
    pub first_step: f64,
    /// Part of that way up to twice which steps that succeed grow. Smaller: more steps. Larger:
    /// more of them fail.
    pub grown_step: f64,
    /// Part of a step over which a cable that runs away is followed at least. Smaller: the place
    /// from which it runs is found more exactly than matters. Larger: it is followed where it need
    /// not be.
    pub runaway_step_fraction: f64,
    /// Most halvings of steps that are shorter than that part, with none longer between them that
    /// failed: beyond it the cable is followed as one that runs away. Smaller: it is, where a few
    /// short steps would do. Larger: a way is gone in steps of a millionth.
    pub max_short_step_halvings: u32,
    /// Work of one search in tension for a cable that could as well lie loose, in contacts and
    /// spans times iterations. Smaller: it lies loose where it would rest in tension, too. Larger:
    /// slack cables in tanks take seconds. Tuned on the campaign's slack cables of seed 77000: of
    /// 450 searches that found an equilibrium none took more than 24 022, and of 132 in the tank,
    /// with 365 000 each, none found one.
    pub max_work_beside_loose: usize,
    /// Drag with which a cable that runs away is followed at first, of the load per metre. Smaller:
    /// steps fail where it runs fast. Larger: more of them.
    pub drag_factor: f64,
    /// Part of that drag below which it has come to rest. Smaller: more steps. Larger: it is
    /// taken for resting while it runs.
    pub rest_drag_fraction: f64,
    /// Drag with which a balance that runs away is left, of the load per metre. Smaller: steps lead
    /// back to it. Larger: more of them.
    pub leaving_drag_factor: f64,
    /// Part of the length by which material is passed on to leave it. Smaller: more steps. Larger:
    /// a rest that is near is passed.
    pub leaving_fraction: f64,
    /// Slack on both sides of a contact, of the shorter chord, from which another balance is
    /// sought, and the part of it that is left where it is taken from. Smaller: searches that find
    /// nothing; larger: balances of steep spans are missed.
    pub least_slack_fraction: f64,
    /// Most searches for other balances. Smaller: some are missed; larger: cables over many things
    /// take long.
    pub max_other_equilibria: usize,
    /// Part of the length by which the material at a contact differs in another balance. Smaller:
    /// two answers of one search are two balances; larger: balances near each other are one.
    pub other_balance_fraction: f64,
    /// Most times in a row that the drag is raised. Smaller: it is given up where it runs fast.
    /// Larger: a failure costs more.
    pub max_drag_raises: usize,
    /// Part of the force there that friction may lack in the step in which a load comes down.
    /// Smaller: more steps. Larger: forces are off by as much while such a step lasts.
    pub missing_friction_fraction: f64,
    /// Part of the whole below which no step is shortened for a load that comes down. Smaller: more
    /// steps. Larger: its friction is off in more of them.
    pub landing_step_fraction: f64,
    /// Most spans that are tried as pockets in one step. Smaller: slack in two kinks at once is no
    /// answer. Larger: dearer failures, each halving tries again.
    pub max_pockets: usize,
    /// Tension at which a rest is first searched, of the weight of the cable: so taut that it
    /// touches only what it is led round. Smaller: it lies on more than the string of the route.
    /// Larger: more steps from there.
    pub first_tension_weights: f64,
    /// The same where that finds none: corners that the string of the route bends round and the
    /// cable does not give away more than it was shrunk by. Smaller: those corners stay. Larger:
    /// more steps.
    pub second_tension_weights: f64,
    /// Part of the load that acts at first. Smaller: nothing gained. Larger: a long span sags into
    /// what is below it before it can be met step by step.
    pub first_load_fraction: f64,
    /// Parts of the cone of friction that a cable taken over from another model may not use, in
    /// turn: along the very edge of the cone sliding from an end would stop anywhere, and Newton
    /// stalls. The first changes nothing that shows, the second holds a little first. Smaller:
    /// Newton stalls. Larger: less of what the other model holds is held.
    pub unused_cone_fractions: [f64; 3],
    /// Friction over what there is that is first tried where a cable slides, as a part of it; then
    /// twice that, and so on. Smaller: more of them are tried. Larger: what is missing is bracketed
    /// by more.
    pub first_missing_part: f64,
    /// Most of it that is tried. Smaller: much that is missing is not told. Larger: dearer where no
    /// friction holds the cable.
    pub max_missing_part: f64,
    /// Part of the tensions by which a contact may be off sliding where less friction does not
    /// hold. Smaller: what is missing would have to be found to more digits. Larger: a failure to
    /// find an answer is taken for sliding.
    pub mobilised_fraction: f64,
}

/// The first shape: which contacts the route has, and how the cable is laid on them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InitialSettings {
    /// Distance within which an end of a route lies on a boundary, of the cable's radius. Smaller:
    /// an end drawn roughly hangs beside what it lies on. Larger: an end held just above a surface
    /// lies on it.
    pub lying_end_radii: f64,
    /// The same of a free end and of the points of the route behind it, which fall on what is below
    /// them. Smaller: an end drawn by hand a little above the ground hangs from its support,
    /// through the ground. Larger: what hangs beside an obstacle is laid on it.
    pub falling_end_radii: f64,
    /// Distance within which points of a route between its ends lie on a boundary, of the cable's
    /// radius: routes follow the surface, the centre line is cut off at kinks. Smaller: kinks are
    /// left. Larger: a route that passes near is laid on it.
    pub route_contact_radii: f64,
    /// Tension with which the cable is laid at least where it does not lie in one piece, of its
    /// weight. Smaller: spans over hollows shrink to nothing. Larger: friction at a free end has to
    /// hold it, and it slides there first.
    pub laid_tension_weights: f64,
    /// Part of the cable's length by which a route may be longer than it: no cable is strained so,
    /// and it is laid along the string then. Smaller: a cable laid taut is laid anew with other
    /// tensions. Larger: the first guess is far off.
    pub route_excess_fraction: f64,
    /// Distance along the route, in radii of a post, within which the cable may come up to it
    /// before or after the string does: less than half a turn. Smaller: a contact is placed where
    /// the route is not. Larger: turns are mistaken for each other.
    pub post_approach_radii: f64,
    /// Distance from a wheel's centre beyond the nearest one, in radii, up to which a route counts
    /// as drawn round the wheel. Smaller: the chords of a coarse polygon are left. Larger: of a
    /// route that only comes near more is taken for its round.
    pub wheel_route_radii: f64,
    /// Distance within which a node of another model's answer touches a boundary, m. Smaller: a
    /// contact that a barrier holds off is missed. Larger: a cable that passes near is laid on it.
    pub adopted_contact_distance_m: f64,
}

/// Contacts that are made, joined, extended and released between solves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChangeSettings {
    /// Most changes in one solve (a cold start over 24 corners takes 60), and most steps over which
    /// a cable that runs away is followed. Smaller: a long route fails, or a cable is given up on
    /// its way. Larger: a cycle, or a failure, costs more.
    pub max_changes: usize,
    /// Part of the section that is next to nothing: two contacts of a first guess keep so much
    /// material between them, and a contact beside a load that has less is released when Newton
    /// stalls. Smaller: spans of no length; Newton comes so near to its end only after many
    /// halvings. Larger: contacts near each other are moved apart, or laid down again for nothing.
    pub least_material_fraction: f64,
    /// Most times in one solve that something is done about loads where Newton stalls. Smaller: a
    /// load between contacts fails a step. Larger: a failure costs more.
    pub max_load_releases: usize,
    /// Distance from a contact within which a load is caught by it when Newton stalls, of the
    /// section. Smaller: the step fails. Larger: a load that hangs is laid down.
    pub catch_distance_fraction: f64,
    /// Points of a span among which the nearest to a corner that was passed is sought. Smaller: the
    /// contact begins beside the corner. Larger: dearer.
    pub corner_search_points: usize,
    /// Part of a contact that the first guess of a lifted end leaves lying at least. Smaller: the
    /// contact has no length. Larger: the span is guessed too short.
    pub lying_fraction: f64,
    /// Greatest tension of a span that may be slack in a kink, of the section's weight. Smaller:
    /// slack is found late. Larger: spans are tried as pockets that have tension.
    pub pocket_tension_fraction: f64,
    /// Part of the contacts beside it that a span drawn across a kink takes at most. Smaller: it is
    /// too short for its material. Larger: a contact has no length left.
    pub kink_span_fraction: f64,
}

/// Causes of failures, and corners that a step passed through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AcceptanceSettings {
    /// Force across the load, of the weight of a span, up to which it hangs in one line. Smaller: a
    /// fold is not reported. Larger: a span that sags is reported as a fold.
    pub fold_force_fraction: f64,
    /// Points of a span, and of a contact, that are compared before and after a step. Smaller: a
    /// corner is passed unseen. Larger: dearer.
    pub tunnelling_points: usize,
    /// Move of a contact's ends up to which the ends alone are compared, rad or m. Smaller: points
    /// are compared in every step. Larger: a contact moves round a corner unseen.
    pub unchecked_move: f64,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            max_iterations: 60,
            max_stalled: 12,
            max_halvings: 14,
            residual: 1e-11,
            refined_residual_factor: 1e-8,
            stalled_residual_factor: 20.0,
            max_turn: 0.7,
            kept_material_fraction: 0.1,
            mode_residual: 1e-3,
            mode_stalled_iterations: 3,
            cycle_rounding_factor: 1e4,
            max_mode_changes: 6,
            slip: SlipSettings::default(),
        }
    }
}

impl Default for SlipSettings {
    fn default() -> Self {
        Self {
            newton_rounds: 6,
            round_tolerance: 2e-3,
            accepted_tension_change: 0.02,
            max_tension_factor: 4.0,
            max_followed_angle: 0.2,
        }
    }
}

impl Default for ContinuationSettings {
    fn default() -> Self {
        Self {
            max_move_fraction: MAX_MOVE_FRACTION,
            max_halvings: 12,
            first_step: 0.05,
            grown_step: 0.2,
            runaway_step_fraction: 1e-3,
            max_short_step_halvings: 24,
            max_work_beside_loose: 40_000,
            drag_factor: 10.0,
            rest_drag_fraction: 1e-3,
            leaving_drag_factor: 2.0,
            leaving_fraction: 1e-2,
            least_slack_fraction: 0.02,
            max_other_equilibria: 16,
            other_balance_fraction: 1e-5,
            max_drag_raises: 5,
            missing_friction_fraction: 3e-4,
            landing_step_fraction: 1.0 / 64.0,
            max_pockets: 3,
            first_tension_weights: 4.0,
            second_tension_weights: 400.0,
            first_load_fraction: 1e-3,
            unused_cone_fractions: [1e-5, 1e-3, 1e-2],
            first_missing_part: 0.04,
            max_missing_part: 1e4,
            mobilised_fraction: 2e-2,
        }
    }
}

impl Default for InitialSettings {
    fn default() -> Self {
        Self {
            lying_end_radii: 0.05,
            falling_end_radii: 1.0,
            route_contact_radii: 0.5,
            laid_tension_weights: 1e-3,
            route_excess_fraction: 0.05,
            post_approach_radii: 2.5,
            wheel_route_radii: 0.1,
            adopted_contact_distance_m: 2.5e-4,
        }
    }
}

impl Default for ChangeSettings {
    fn default() -> Self {
        Self {
            max_changes: 200,
            least_material_fraction: 1e-4,
            max_load_releases: 4,
            catch_distance_fraction: 0.02,
            corner_search_points: 64,
            lying_fraction: 0.02,
            pocket_tension_fraction: 1e-2,
            kink_span_fraction: 0.3,
        }
    }
}

impl Default for AcceptanceSettings {
    fn default() -> Self {
        Self { fold_force_fraction: 5e-3, tunnelling_points: 24, unchecked_move: 0.5 }
    }
}
