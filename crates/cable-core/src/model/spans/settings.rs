//! The settings of `spans` are its tuned constants in one place, grouped by purpose.
//!
//! They were chosen by trial: limits of iterations, first steps, distances within which things
//! count as one. Constants that round-off or an error bound fixes are defined beside their code,
//! and so are the tolerances of the model's own checks.
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
    /// Residual, as a fraction of T/EA, above which an accepted solution gets one more step: forces
    /// are then off by a hundredth of this fraction. Smaller: one more step in each solve. Larger:
    /// forces of stiff cables are only as accurate as their tolerance, 1e-8.
    pub refined_residual_factor: f64,
    /// Multiple of the wanted residual below which a residual that no step lowers counts as
    /// round-off. Smaller: steps fail by round-off. Larger: a step that was halved often enough is
    /// accepted without being solved.
    pub stalled_residual_factor: f64,
    /// Greatest turn of a contact's end in one iteration, rad. Smaller: more iterations round a
    /// post. Larger: the end jumps a turn of a post.
    pub max_turn: f64,
    /// Least fraction of its material that a span keeps in one iteration. Smaller: a span shrinks
    /// to round-off in a few iterations. Larger: more iterations for a shrinking span.
    pub kept_material_fraction: f64,
    /// Residual below which modes are judged. Smaller: iterations spent on a mode that will not
    /// last. Larger: a contact slides because of temporary tensions of an iterate, and a cable held
    /// at neither end slides away.
    pub mode_residual: f64,
    /// Iterations without progress after which modes are judged all the same. Smaller: as with a
    /// larger [`Self::mode_residual`]. Larger: iterations spent on a mode that will not last.
    pub mode_stalled_iterations: usize,
    /// Multiple of round-off up to which violations of the friction cone are tolerated if modes
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
    /// Most rounds of the predictor's Newton method, and most changes of sides in addition to two
    /// per contact. Smaller: a worse guess, or none if many contacts change. Larger: each costs a
    /// tenth of a Newton iteration of the section.
    pub newton_rounds: usize,
    /// Relative change of tension from which another round is worth its cost: the error after it is
    /// about the square of the change. Smaller: more rounds. Larger: a worse guess.
    pub round_tolerance: f64,
    /// Relative change of tension in the last round up to which the guess is used. Smaller: guesses
    /// are discarded. Larger: bad guesses are used.
    pub accepted_tension_change: f64,
    /// Greatest factor by which the tension of a span may change in a round. Smaller: no prediction
    /// in large steps. Larger: the linearised spans of the guess are no longer valid.
    pub max_tension_factor: f64,
    /// Greatest angle by which a contact's end follows its span, rad. Smaller: ends stay behind in
    /// large steps. Larger: an end follows round a post.
    pub max_followed_angle: f64,
}

/// Steps from an equilibrium to another, and the way to the first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContinuationSettings {
    /// Greatest move of a support in one solve, as a fraction of the cable's length. Smaller: more
    /// solves. Larger: sliding that starts and reverses within a step is missed, and cable that
    /// comes down in a step is laid with the tension at its start.
    pub max_move_fraction: f64,
    /// Most halvings of a step: 2⁻¹² of a step of 1 % of the cable is a hair's breadth. Smaller:
    /// steps fail. Larger: a failure costs more.
    pub max_halvings: u32,
    /// First step, as a fraction of the path to an instant. Smaller: more steps. Larger: a long
    /// span sags into obstacles below it.
    pub first_step: f64,
    /// Half of the greatest step, as a fraction of that path. Smaller: more steps. Larger: more of
    /// them fail.
    pub grown_step: f64,
    /// Least step, as a fraction, over which a cable that runs away is followed. Smaller: the place
    /// from which it runs is located too exactly. Larger: it is followed without need.
    pub runaway_step_fraction: f64,
    /// Most halvings of steps shorter than that fraction, without a longer failed step between
    /// them, before the cable is followed as one that runs away. Smaller: it is followed although a
    /// few short steps would do. Larger: the path is covered in steps of a millionth.
    pub max_short_step_halvings: u32,
    /// Work of a search for the first equilibrium, from all first shapes together, in contacts and
    /// spans times iterations. Smaller: equilibria far from the route are not found. Larger: a
    /// cable that has none is refused later. Of 2360 random scenes none that was found took more
    /// than 37 152, and none that was not more than 229 407, from four shapes and without this
    /// limit.
    pub max_work: usize,
    /// Work of one search in tension for a cable that could also lie loose, in contacts and spans
    /// times iterations. Smaller: it lies loose although it could rest in tension. Larger: slack
    /// cables in tanks take seconds. Tuned on the campaign's slack cables of seed 77000: of 450
    /// searches that found an equilibrium none took more than 24 022, and of 132 in the tank, with
    /// 365 000 each, none found one.
    pub max_work_beside_loose: usize,
    /// First drag of a cable that runs away, relative to the load per metre. Smaller: steps fail
    /// where it runs fast. Larger: more steps.
    pub drag_factor: f64,
    /// Fraction of that drag below which it has come to rest. Smaller: more steps. Larger: it
    /// counts as resting while it runs.
    pub rest_drag_fraction: f64,
    /// First drag with which an unstable equilibrium is left, relative to the load per metre.
    /// Smaller: steps lead back to it. Larger: more steps.
    pub leaving_drag_factor: f64,
    /// Displacement of material that leaves it, as a fraction of the length. Smaller: more steps.
    /// Larger: a nearby equilibrium is missed.
    pub leaving_fraction: f64,
    /// Slack on both sides of a contact, as a fraction of the shorter chord, from which another
    /// equilibrium is sought, and the fraction that is left on the side from which it is taken.
    /// Smaller: searches that find nothing; larger: equilibria of steep spans are missed.
    pub least_slack_fraction: f64,
    /// Most searches for other equilibria. Smaller: some are missed; larger: cables over many
    /// obstacles take long.
    pub max_other_equilibria: usize,
    /// Difference of the material at a contact from which two equilibria are different, as a
    /// fraction of the length. Smaller: two answers of one search count as two; larger: nearby
    /// equilibria count as one.
    pub other_balance_fraction: f64,
    /// Most successive rises of the drag. Smaller: a cable that runs fast is given up. Larger: a
    /// failure costs more.
    pub max_drag_raises: usize,
    /// Friction that may be missing in the step in which a load comes down, as a fraction of the
    /// force there. Smaller: more steps. Larger: forces are off by as much during such a step.
    pub missing_friction_fraction: f64,
    /// Fraction of the path below which no step is shortened for a load that comes down. Smaller:
    /// more steps. Larger: more steps with an error of its friction.
    pub landing_step_fraction: f64,
    /// Most spans that are tried as pockets in one step. Smaller: slack in two kinks at once is no
    /// answer. Larger: failures cost more, because each halving tries again.
    pub max_pockets: usize,
    /// Tension with which an equilibrium is first sought, in weights of the cable: so taut that it
    /// touches only the obstacles that its route bends round. Smaller: it touches more than the
    /// taut string of the route. Larger: more steps from there.
    pub first_tension_weights: f64,
    /// Tension of a second search, if the first finds nothing: corners that the string bends round
    /// and the cable does not touch need more length than the first shrinkage. Smaller: those
    /// corners remain. Larger: more steps.
    pub second_tension_weights: f64,
    /// Fraction of the load that acts at first. Smaller: nothing gained. Larger: a long span sags
    /// into obstacles below it before they can be met step by step.
    pub first_load_fraction: f64,
    /// Fractions of the friction cone that a cable adopted from another model may not use, tried in
    /// turn: at the very edge of the cone the slip front is undetermined, and Newton's method
    /// stalls. The first has no visible effect, the second leaves a little reserve. Smaller:
    /// Newton's method stalls. Larger: less of the other model's friction is kept.
    pub unused_cone_fractions: [f64; 3],
    /// First extra friction that is tried for a sliding cable, as a fraction of its friction; it is
    /// doubled after each try. Smaller: more tries. Larger: a wider bracket of the missing
    /// friction.
    pub first_missing_part: f64,
    /// Greatest extra friction that is tried. Smaller: large missing frictions are not reported.
    /// Larger: more time if no friction holds the cable.
    pub max_missing_part: f64,
    /// Relative distance from sliding within which contacts count as about to slide. Smaller: the
    /// missing friction would need more digits. Larger: a failed search passes for sliding.
    pub mobilised_fraction: f64,
}

/// The first shape: the contacts of the route, and the laying of the cable on them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InitialSettings {
    /// Distance within which an end of a route lies on a boundary, in radii of the cable. Smaller:
    /// a roughly drawn end hangs beside the surface. Larger: an end held just above a surface
    /// counts as lying on it.
    pub lying_end_radii: f64,
    /// The same distance for a free end and the points of the route behind it, which fall down.
    /// Smaller: an end drawn by hand a little above the ground hangs from its support, through the
    /// ground. Larger: cable that hangs beside an obstacle is laid on it.
    pub falling_end_radii: f64,
    /// Distance within which inner points of a route lie on a boundary, in radii of the cable:
    /// routes follow the surface, and the centre line cuts off kinks. Smaller: kinks are missed.
    /// Larger: a route that passes near is laid on it.
    pub route_contact_radii: f64,
    /// Least tension of a newly laid cable with free spans, in weights of the cable. Smaller: spans
    /// over hollows shrink to nothing. Larger: friction at a free end has to hold it, and it slides
    /// there first.
    pub laid_tension_weights: f64,
    /// Excess of the route over the cable's length, as a fraction of it, from which the cable is
    /// laid along the taut string instead: no cable is strained so much. Smaller: a cable laid taut
    /// is laid anew with other tensions. Larger: the first guess is far off.
    pub route_excess_fraction: f64,
    /// Distance along the route, in radii of a post, within which the cable may meet it before or
    /// after the string does: less than half a turn. Smaller: a contact is placed off the route.
    /// Larger: turns are mistaken for each other.
    pub post_approach_radii: f64,
    /// Distance from a wheel's centre beyond the nearest one, in radii, up to which a route counts
    /// as drawn round the wheel. Smaller: the chords of a coarse polygon are left. Larger: more of
    /// a route that only passes near counts as wrapped.
    pub wheel_route_radii: f64,
    /// Distance within which a node of another model's answer touches a boundary, m. Smaller: a
    /// contact with the gap of a barrier is missed. Larger: a cable that passes near is laid on it.
    pub adopted_contact_distance_m: f64,
}

/// Contacts that are made, joined, extended and released between solves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChangeSettings {
    /// Most changes in one solve (a cold start over 24 corners takes 60), and most steps over which
    /// a cable that runs away is followed. Smaller: a long route fails, or a cable is given up on
    /// its way. Larger: a cycle, or a failure, costs more.
    pub max_changes: usize,
    /// Negligible length, as a fraction of the section: two contacts of a first guess keep so much
    /// material between them, and a contact beside a load that has less is released when Newton's
    /// method stalls. Smaller: spans without length; Newton's method gets so short only after many
    /// halvings. Larger: contacts near each other are moved apart, or laid down again without need.
    pub least_material_fraction: f64,
    /// Most changes of loads in one solve when Newton's method stalls. Smaller: a load between
    /// contacts fails a step. Larger: a failure costs more.
    pub max_load_releases: usize,
    /// Distance from a contact within which a load is set down on it when Newton's method stalls,
    /// as a fraction of the section. Smaller: the step fails. Larger: a hanging load is laid down.
    pub catch_distance_fraction: f64,
    /// Number of points of a span among which the nearest to a tunnelled corner is sought. Smaller:
    /// the contact begins beside the corner. Larger: more time.
    pub corner_search_points: usize,
    /// Least fraction of a contact that the first guess of a lifted end leaves lying. Smaller: the
    /// contact has no length. Larger: the guessed span is too short.
    pub lying_fraction: f64,
    /// Greatest tension of a span that may be slack in a kink, of the section's weight. Smaller:
    /// slack is found late. Larger: spans are tried as pockets that have tension.
    pub pocket_tension_fraction: f64,
    /// Greatest fraction of the neighbouring contacts that a span across a kink takes. Smaller: it
    /// is too short for its material. Larger: a contact has no length left.
    pub kink_span_fraction: f64,
}

/// Causes of failures, and tunnelled corners.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AcceptanceSettings {
    /// Force across the load, of the weight of a span, up to which it hangs in one line. Smaller: a
    /// fold is not reported. Larger: a span that sags is reported as a fold.
    pub fold_force_fraction: f64,
    /// Number of points of a span, and of a contact, that are compared before and after a step.
    /// Smaller: a tunnelled corner is missed. Larger: more time.
    pub tunnelling_points: usize,
    /// Move of a contact's ends up to which the ends alone are compared, rad or m. Smaller: points
    /// are compared in every step. Larger: a contact moves round a corner undetected.
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
            max_work: 1_000_000,
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
