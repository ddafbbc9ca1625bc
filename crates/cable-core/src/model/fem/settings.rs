//! These settings are the tuned constants of the model in contact and in motion.
//! [`Tuning::default`] has the values that the program uses; a measurement
//! (`cargo run --release -p cable-benches --bin tuned-settings`) tries others.
//!
//! Constants that round-off or an error bound fixes are defined beside their code, and so are those
//! of the equilibria without contact (`free`) and of the elastica, whose iterations end at
//! round-off.

use serde::{Deserialize, Serialize};

/// The tuned constants of the model, in groups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tuning {
    /// The barrier of contacts, and the slide at which friction is fully mobilised.
    pub contact: ContactTuning,
    /// Newton's method for a step.
    pub newton: NewtonTuning,
    /// Steps in time, and sleep.
    pub step: StepTuning,
    /// Steps without inertia and the search for an equilibrium.
    pub equilibrium: EquilibriumTuning,
    /// The moving outline of a robot.
    pub outline: OutlineTuning,
    /// Changes of the mesh between steps.
    pub remesh: RemeshTuning,
    /// The first mesh, and equilibria adopted from other models.
    pub start: StartTuning,
}

/// Constants of the barrier and of friction. The figures beside them are of single scenes; what the
/// others were tuned on is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactTuning {
    /// Gap at which contact begins (d̂), m. A corner lifts a taut cable by this: 1e-3 adds 2 % to
    /// the tension of a soft cable of 12 m over two beams, 1e-4 nothing visible. Smaller takes more
    /// iterations, larger lifts the cable.
    pub reach_m: f64,
    /// Stiffness of the barrier, in weights of an even bar. Smaller: contacts rebound, and a
    /// twentieth costs 30 % more; larger: contacts are at the edge of the reach, where they come
    /// and go.
    pub stiffness_weights: f64,
    /// Stiffness of the barrier in greatest tensions, if that is more. With a hundredth of it the
    /// gap of a node at which a taut cable turns is still a millionth of a metre; with the weight
    /// alone a cable of 1e6 N had a gap of 1e-9 m, and no Newton step moved it. Larger: the cable
    /// is lifted.
    pub stiffness_tensions: f64,
    /// Greatest factor of the stiffness from one step to the next. Smaller: it lags behind a
    /// snatch; larger: it jolts cable in contact.
    pub stiffness_rise: f64,
    /// Least such factor. Smaller: it jolts cable in contact; larger: the barrier stays hard after
    /// a snatch.
    pub stiffness_fall: f64,
    /// Factor of the stiffness with which a failed step is tried again, because the tension may
    /// grow in it. Smaller: steps that draw the cable taut fail; larger: the cable is lifted.
    pub retry_stiffening: f64,
    /// Slide ε at which friction is fully mobilised in motion, and its greatest value at rest, m.
    /// With 1e-6 there are half as many iterations again, with 1e-4 the cable creeps.
    pub slip_m: f64,
    /// ε at rest, as a fraction of the stretch of the cable under its weight or its greatest
    /// tension: if sticking contacts yield by as much as the cable stretches, they have no effect.
    /// After a pull is reversed 1e-3 loses up to 3 % of the tension, 1e-4 up to 0.9 %; smaller
    /// costs iterations.
    pub slip_stretch_fraction: f64,
    /// Least ε, m. Friction of newtons is then a spring of 1e9 N/m, and the round-off of a
    /// coordinate of 10 m is still a millionth of ε. Smaller: near round-off; larger: creep at
    /// rest.
    pub min_slip_m: f64,
    /// Number of steps for which the anchor of a contact without load is kept. Smaller: trembling
    /// contacts creep; much larger: a cable that was lifted and put back is held as if it had
    /// stayed.
    pub remembered_steps: usize,
    /// Number of steps for which neighbour lists are made. Smaller: they are made more often;
    /// larger: they are longer.
    pub listed_steps: f64,
    /// Move of a node, m, that these lists allow beside the one expected. Smaller and larger as
    /// above.
    pub listed_move_m: f64,
}

impl Default for ContactTuning {
    fn default() -> Self {
        Self {
            reach_m: 1e-4,
            stiffness_weights: 20.0,
            stiffness_tensions: 0.05,
            stiffness_rise: 2.0,
            stiffness_fall: 0.8,
            retry_stiffening: 8.0,
            slip_m: 1e-5,
            slip_stretch_fraction: 1e-4,
            min_slip_m: 1e-9,
            remembered_steps: 8,
            listed_steps: 4.0,
            listed_move_m: 2e-3,
        }
    }
}

/// Constants of Newton's method. The figures beside them are of drops of cables of 600 and 1000
/// bars; what the others were tuned on is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonTuning {
    /// Iterations of the mixed method in contact before the minimiser takes over. Smaller: more
    /// work for the minimiser, whose iterations cost five times as much. Larger: more iterations
    /// are lost if the minimiser is needed after all; in eight drops of 600 bars it takes over in
    /// 250 of 960 steps with 20 as with 40, after 14 600 and 20 700 iterations.
    pub mixed_iterations: usize,
    /// Iterations of the mixed method without contact. Measured: 2 to 5 in a swing, up to 12 if a
    /// slack chain snaps taut. Smaller: such steps are left to the minimiser. Larger: a failure
    /// costs more.
    pub free_iterations: usize,
    /// Fractions of the bars' compression that are kept in the matrix, one after the other, if all
    /// of it makes the matrix indefinite. Iterations over 24 drops of a cable of 1000 bars: 15 %
    /// more if all of it is dropped at once; 2 % more with 0.5 and 0.
    pub push_fractions: [f64; 3],
    /// Residual, as a fraction of the first one, from which the last iterate is handed on to the
    /// minimiser. Smaller: the minimiser starts anew although the iterate was near; larger: it
    /// starts from a useless iterate.
    pub handed_on_residual_fraction: f64,
    /// Rounds of adding predicted contacts to the active set. Smaller: a step runs into obstacles
    /// that it has not seen; larger: nothing new is found, even if a contact front runs along the
    /// cable.
    pub active_set_rounds: usize,
    /// Free fraction of a step from which no contacts are predicted. Smaller: steps are cut short.
    /// Larger: the same step is solved twice.
    pub free_step_fraction: f64,
    /// Least descent of a step with predicted contacts, as a fraction of that of the free step.
    /// Smaller: steps that only bend round corners and gain nothing. Larger: good ones are given
    /// up.
    pub min_descent_fraction: f64,
    /// Gap at which predicted contacts land, as a fraction of the barrier's reach: about where the
    /// barrier holds a node. Smaller: they land too hard. Larger: they come down in more steps.
    pub landing_gap_fraction: f64,
    /// Margin between constraints and step bound: contacts within the reach may lose this fraction
    /// of the gap that the bound allows, and wider gaps are bound to this fraction of the landing
    /// gap. Smaller: more steps. Larger: round-off makes the bound cut a step that lands.
    pub bound_margin: f64,
    /// Stiffness of a constraint, as a multiple of the largest stiffness at its nodes. Smaller:
    /// nodes still run into the barrier; much larger: round-off.
    pub constraint_hardness: f64,
    /// Change of the target of a constraint, relative to its least gap, below which it is not
    /// updated. Smaller: useless rounds. Larger: a bar that turns runs into its corner.
    pub constraint_tolerance: f64,
    /// Fraction of each gap that a step leaves. Smaller: gaps shrink faster than Newton's method
    /// opens them again (with 0.2 twice as many steps of ends thrown about are halved, five times
    /// as many with self-contact). Larger: more steps.
    pub kept_gap_fraction: f64,
    /// Least fraction of the cable between a sliding node and its neighbour that an iteration
    /// leaves. Smaller: a bar shrinks to nothing in a few iterations. Larger: more iterations.
    pub kept_cable_fraction: f64,
    /// Sufficient decrease of the line search (Armijo), as a fraction of the decrease that the
    /// slope predicts. Smaller: steps that gain nothing. Larger: good steps are cut.
    pub decrease: f64,
    /// Halvings of the line search before the step is given up. Fewer: steps fail. More: a failure
    /// costs more.
    pub max_halvings: usize,
    /// Unbalanced force, in tolerances, that is accepted when further iterations gain nothing: 3e-5
    /// of the whole load. Smaller: steps fail by round-off. Larger: forces are off by as much.
    pub stalled_residual: f64,
    /// Unbalanced force of a stretch of cable at rest, in tolerances: those of its nodes add up.
    /// Smaller: iterations without a visible effect. Larger: the verification, which checks
    /// stretches to 1e-5 of the forces, refuses answers.
    pub stretch_residual: f64,
    /// Number of short moves of held nodes towards their targets before they are stopped. Smaller:
    /// supports lag that could have reached them. Larger: iterations that the next step could save.
    pub max_pushes: usize,
    /// Greatest move of a node in an iteration, m: two longest inner steps at 100 m/s. Smaller:
    /// fast motion takes more iterations. Larger: a wild step goes farther before it is cut.
    pub max_move_m: f64,
}

impl Default for NewtonTuning {
    fn default() -> Self {
        Self {
            mixed_iterations: 20,
            free_iterations: 16,
            push_fractions: [0.7, 0.4, 0.0],
            handed_on_residual_fraction: 1e-2,
            active_set_rounds: 6,
            free_step_fraction: 0.99,
            min_descent_fraction: 0.1,
            landing_gap_fraction: 0.5,
            bound_margin: 0.9,
            constraint_hardness: 1e5,
            constraint_tolerance: 0.05,
            kept_gap_fraction: 0.5,
            kept_cable_fraction: 0.3,
            decrease: 1e-4,
            max_halvings: 30,
            stalled_residual: 30.0,
            stretch_residual: 4.0,
            max_pushes: 12,
            max_move_m: 2.0 / 240.0 * 100.0,
        }
    }
}

/// Constants of steps in time. The figures beside them are of the motions named there; what the
/// others were tuned on is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepTuning {
    /// Longest inner step, s, if the user gives none. At 1/240 the tip of a falling chain of 10 m
    /// is within 5e-4 m of that of rigid links (`tests/dynamics`). Smaller: more time; larger: less
    /// accurate.
    pub longest_s: f64,
    /// First step of a motion, as a fraction of a whole step; each of the next ones is as long as
    /// all before it. The first step has no history: implicit Euler moves a released cable ½ a h²
    /// too far, which BDF2 turns into ¾ a h². Larger: a free fall at 1/240 s is off by ¾ of this
    /// fraction's square times 1.7e-4 m. Smaller: one step more for each halving.
    pub first_fraction: f64,
    /// The shortest step, of the longest: with 1/240 s frequencies up to 17 Hz are exact to 1e-3,
    /// those of 40 Hz to 6e-3. Smaller: a vibrating cable costs more than its vibration is worth.
    /// Larger: only lower frequencies are exact.
    pub shortest_fraction: f64,
    /// Amplitude, as a fraction of the cable's length, below which vibrations do not shorten the
    /// step: the remainder of a relaxation rings at any frequency, and 0.1 mm in 10 m is not
    /// visible. Smaller: useless short steps. Larger: vibrations are damped.
    pub vibration_fraction: f64,
    /// Greatest factor of the step from one frame to the next; BDF2 is stable up to 2.4. Smaller:
    /// the step lags behind the motion. Larger: it is unstable.
    pub max_change: f64,
    /// Time constant (s) of the moving average of a motion: about half a period of a motion that
    /// needs shorter steps. Smaller: the step varies within a vibration, short at its turning
    /// points and long where it is fastest. Larger: short steps go on after the vibration.
    pub memory_s: f64,
    /// Time for which a cable must have been still before it sleeps, s. Smaller: a slow swing may
    /// fall asleep at its turning point. Larger: a cable at rest costs time for longer.
    pub sleep_delay_s: f64,
    /// Distance by which a node may have moved in that time, in reaches of the barrier: a trembling
    /// contact moves its neighbours by a few. Smaller: trembling keeps a cable awake. Larger: a
    /// slow motion falls asleep.
    pub sleep_distance_reaches: f64,
    /// Maximum number of halvings of a step. Smaller: steps fail. Larger: a failure costs more.
    pub max_halvings: usize,
    /// Halvings of a step before the robot has to wait for the cable. Smaller: the robot jerks.
    /// Larger: more time.
    pub halvings_before_robot_waits: usize,
    /// Newton iterations of a step. Fewer: steps are halved that would have converged. More: a
    /// failure costs more.
    pub max_iterations: usize,
    /// Newton iterations of the hardest step of a frame up to which the next frame may take longer
    /// steps again. Of a cable of 1000 bars that drops on rubble, fewer: 7 cost 1.7 times as many
    /// iterations in all, in shorter steps. More: 40 have three times as many steps refused.
    pub easy_iterations: usize,
    /// Rounds without a decrease of the number of wrong stick-slip states after which these are
    /// changed one at a time. Smaller: steps in which a few nodes release each other in turn take
    /// longer, or are halved. Larger: a cycle costs more.
    pub grip_rounds: usize,
    /// Additional rounds for each sliding node. Smaller: steps in which many nodes begin to slip
    /// one after the other are halved. Larger: a cycle costs more.
    pub grip_rounds_each: usize,
    /// Rounds in which friction follows its normal forces. With none the greatest tension of a
    /// stiff cable (1 N m²) that drops on rubble is 537, 352 and 789 N with 84, 168 and 336 bars at
    /// 1/960 s, with one 427, 399 and 463 N; a second changes that by 2 %, and costs as much as the
    /// step (a pile: 1.5 s, 0.9 with one).
    pub friction_rounds: usize,
    /// Change of a friction force that is neglected, relative to the greatest. Smaller: sliding
    /// costs twice as much without a visible change. Larger: the friction of impacts acts late.
    pub friction_change: f64,
    /// Difference, as a fraction of the greatest friction of a sliding node, between its friction
    /// and that of its turn and stick-slip state after a step. Smaller: rounds without a visible
    /// effect. Larger: friction beyond its cone (the verification allows 1e-3 of the normal force).
    pub grip_tolerance: f64,
    /// Normal speed below which a contact gets no plastic impulse, m/s. Smaller: useless work on
    /// resting contacts. Larger: slow impacts rebound.
    pub plastic_speed_m_per_s: f64,
    /// Energy that the remembered pull of bars which became slack gives the cable in a step beyond
    /// what they held, as a fraction of its kinetic energy and stretch, above which the step is
    /// balanced again without that pull. Smaller: more steps are balanced twice. Larger: cables
    /// that recoil gain energy.
    pub least_recoil: f64,
    /// Speed of the whole cable whose kinetic energy is added to that: a slower recoil does not
    /// count. Smaller and larger: as for `least_recoil`, of cables that hardly move.
    pub slow_recoil_m_per_s: f64,
    /// Gap that a support keeps from an obstacle against which it is driven, in reaches. The bar
    /// beside it presses there with hardly a lever. Smaller: its normal force, 1e14 N at 1e-8 m,
    /// dominates Newton's method. Larger: the support stops short.
    pub support_gap_reaches: f64,
    /// Fraction of its gap that a support keeps in one step. Smaller: it enters the barrier with
    /// its whole speed. Larger: it lags.
    pub kept_support_gap_fraction: f64,
    /// Halvings of the displacement of a support that comes too near, before it stays where it is.
    /// Smaller: it stops early. Larger: more checks, for displacements that cannot be seen.
    pub stand_off_tries: usize,
}

impl Default for StepTuning {
    fn default() -> Self {
        Self {
            longest_s: 1.0 / 240.0,
            first_fraction: 0.125,
            shortest_fraction: 0.125,
            vibration_fraction: 1e-5,
            max_change: 2.0,
            memory_s: 0.25,
            sleep_delay_s: 0.5,
            sleep_distance_reaches: 5.0,
            max_halvings: 10,
            halvings_before_robot_waits: 3,
            max_iterations: 120,
            easy_iterations: 10,
            grip_rounds: 6,
            grip_rounds_each: 3,
            friction_rounds: 1,
            friction_change: 0.05,
            grip_tolerance: 2e-4,
            plastic_speed_m_per_s: 0.05,
            least_recoil: 1e-2,
            slow_recoil_m_per_s: 0.5,
            support_gap_reaches: 0.2,
            kept_support_gap_fraction: 0.2,
            stand_off_tries: 4,
        }
    }
}

/// Constants of steps without inertia and of the search for an equilibrium. The figures beside them
/// are of random scenes; what the others were tuned on is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EquilibriumTuning {
    /// Work that one search for an equilibrium may do: iterations times nodes. Smaller: scenes that
    /// converge slowly are refused. Larger: a search that fails reports it after minutes. The value
    /// is 20 000 iterations of 200 nodes, and takes some 10 s.
    pub max_work: usize,
    /// Newton iterations of a step. Smaller: relaxations that a few more iterations would have
    /// saved. Larger: a failure costs more.
    pub max_iterations: usize,
    /// Halvings of a step before the cable is relaxed to its equilibrium instead. Smaller: corners
    /// slip during relaxation and keep that slip (1 to 3 % of the tension in 4 of 200 scenes).
    /// Larger: cables that need relaxation take longer.
    pub halvings_before_relaxation: usize,
    /// Steps of relaxation before it is given up. Fewer: equilibria are missed. More: a failure
    /// costs more.
    pub max_relaxation_steps: usize,
    /// Rounds of renewing the normal forces of friction in a step. Smaller: steps are halved.
    /// Larger: a cycle costs more.
    pub lag_rounds: usize,
    /// Rounds after which friction limits are sought between two limits that were tried: if more
    /// friction at one contact lifts its neighbour, which then has less friction, whole updates
    /// never converge. A relaxation step, which need not converge, has no other rounds. Smaller:
    /// steps that converge by themselves take longer. Larger: fewer rounds are left.
    pub whole_lag_rounds: usize,
    /// Whole load, in weights of the cable, from which dead loads set the first resistance.
    /// Smaller: a relaxation with a small load is slower than necessary. Larger: loads of that many
    /// weights throw the cable about.
    pub dead_load_weights: f64,
    /// Unbalanced force, in tolerances, that is accepted if contact forces are known no better:
    /// 1e-3 of the whole load. Smaller: cables squeezed by a support find no equilibrium. Larger:
    /// with a node a rounding away from a corner any force counts as equilibrium (6e10 N did).
    pub squeezed_residual: f64,
    /// Resultant of all forces on a cable without supports that counts as equilibrium, as a
    /// fraction of all loads. Smaller: resting cables are refused because of the unbalanced forces
    /// of their nodes. Larger: slowly sliding cables count as resting. On random slopes, posts,
    /// beams and drapes resting cables left up to 4e-5, those with 0.3 % too little friction 3e-4
    /// and more.
    pub unheld_load_fraction: f64,
    /// Unbalanced force of a polished equilibrium, in tolerances. It is polished in three stages,
    /// whose residuals fall evenly from one tolerance to this. Smaller: only round-off is gained.
    /// Larger: for a cable that nearly slides the forces left at a hundred nodes show in the
    /// balance of the whole.
    pub polish_residual: f64,
    /// Newton iterations of the first stage, which continues a search that used all its iterations.
    /// Smaller: a cable that slides as a whole on smooth ground does not come to rest. Larger: a
    /// failure costs more.
    pub polish_iterations: usize,
    /// Maximum number of times that an equilibrium is sought again because corners were met or
    /// left. Smaller: it is refused. Larger: a cycle costs more.
    pub corner_rounds: usize,
    /// Turn the wrong way round a corner from which a step is taken again without that corner, rad.
    /// Smaller: more steps are taken twice. Larger: other corners slip by the pull of this corner
    /// (at 0.02 and 50 N by 2 %), and keep that slip.
    pub max_corner_pull_rad: f64,
}

impl Default for EquilibriumTuning {
    fn default() -> Self {
        Self {
            max_work: 4_000_000,
            max_iterations: 150,
            halvings_before_relaxation: 4,
            max_relaxation_steps: 600,
            lag_rounds: 25,
            whole_lag_rounds: 8,
            dead_load_weights: 2.0,
            squeezed_residual: 1e3,
            unheld_load_fraction: 1e-4,
            polish_residual: 1e-2,
            polish_iterations: 600,
            corner_rounds: 8,
            max_corner_pull_rad: 1e-4,
        }
    }
}

/// Constants of the moving outline of a robot. What they were tuned on is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutlineTuning {
    /// Greatest displacement of the outline in a step without inertia, m. Smaller: more steps.
    /// Larger: the cable is thrown ahead of it.
    pub max_way_m: f64,
    /// Distance (m) within which bars move with the outline, in addition to four of its
    /// displacements. Smaller: bars just beyond are folded against the moved ones. Larger: cable
    /// farther off is moved without need.
    pub carried_distance_m: f64,
    /// Fractions of its displacement that are tried. With smaller ones a cable squeezed against a
    /// wall is tried again; with larger ones the outline stops before it must.
    pub way_fractions: [f64; 4],
    /// Fraction of a gap that is restored. Smaller: nodes in a corner come into the barrier.
    /// Larger: more rounds.
    pub kept_gap_fraction: f64,
    /// Rounds of restoring gaps. Smaller: a node in a corner between outline and ground stays near.
    /// Larger: a squeezed node, which never gets its gaps, costs more.
    pub max_rounds: usize,
    /// Greatest lag (m) of a hitch that a wall stops; beyond it the outline waits. Smaller: the
    /// robot is stopped by walls that it could pass. Larger: hitch and robot separate.
    pub max_hitch_lag_m: f64,
}

impl Default for OutlineTuning {
    fn default() -> Self {
        Self {
            max_way_m: 5e-3,
            carried_distance_m: 0.02,
            way_fractions: [1.0, 0.5, 0.25, 0.0625],
            kept_gap_fraction: 0.1,
            max_rounds: 40,
            max_hitch_lag_m: 0.06,
        }
    }
}

/// Constants of changes of the mesh between steps. Lengths of bars are in even bars. What they were
/// tuned on is not recorded; halved and doubled, most move nothing (`docs/notes/settings.md`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RemeshTuning {
    /// Turn below which a corner gets no sliding node and the barrier carries the cable, and a
    /// spare node is removed, rad: there a chain jerks by less than 1e-3 of its tension. Smaller:
    /// sliding nodes on every facet of the ground. Larger: jerks.
    pub min_turn_rad: f64,
    /// Shortest bar beside a sliding node. Smaller: the matrix is worse. Larger: nodes come and go
    /// all the time.
    pub min_bar: f64,
    /// Longest bar beside a sliding node. Smaller: nodes come and go all the time. Larger: the bars
    /// beside a corner are coarse.
    pub max_bar: f64,
    /// Distance within which a node is in the way of a new sliding node. Smaller: short bars.
    /// Larger: nodes are lost.
    pub removed_distance: f64,
    /// Tension, in weights of an even bar, from which a corner gets a sliding node; below half of
    /// that it loses it. A slack cable lies on corners with its nodes, and the barrier carries it
    /// as well. Smaller: a slack cable gets sliding nodes and loses them again. Larger: chains jerk
    /// at corners, node by node.
    pub sliding_tension_weights: f64,
    /// Turn the wrong way round a corner that a step may end with, rad; the node leaves after it.
    /// Smaller: more steps are taken twice. Larger: its tangents would lie inside the obstacle.
    pub max_reverse_turn_rad: f64,
    /// √(EI/T), in even bars, beyond which the mesh resolves a cable's bend. Smaller: chains jerk
    /// at corners, node by node. Larger: the bend at a corner is neglected although the mesh could
    /// resolve it.
    pub resolved_bend: f64,
    /// Half of the turn up to which a slack cable may leave a round with one node, rad. Smaller: it
    /// hangs there. Larger: the node is far from the round.
    pub max_left_half_turn_rad: f64,
    /// Half of the turn up to which the node that replaces a sliding one is placed where the
    /// tangents meet, and up to which one mark of a round can carry the cable, rad. Smaller: a bar
    /// cuts the corner. Larger: the node is placed far away.
    pub max_tangent_half_turn_rad: f64,
    /// Turn below which a node that leaves its corner is removed, rad; with more it becomes a
    /// material node. Smaller: more nodes. Larger: the cable loses a bend.
    pub removed_turn_rad: f64,
    /// Length of two bars together below which the node between them is removed. Smaller: more
    /// nodes. Larger: they come and go.
    pub spare_bars: f64,
    /// Length of the sum of the directions before and after a node below which the cable counts as
    /// folded there. Smaller: folds get sliding nodes. Larger: sharp turns get none.
    pub fold_direction_sum: f64,
    /// Tension from which a cable in motion counts as taut, in EA (v/c)^(4/3): a transverse impact
    /// at a speed v causes 0.63 of it. Smaller: sliding nodes come and go where a falling cable
    /// strikes. Larger: a cable drawn fast over corners jerks at them.
    pub impact_tension: f64,
    /// Distance from a corner within which speeds count, m of arc length. Smaller: approaching
    /// motion is missed. Larger: motion elsewhere counts.
    pub neighbourhood_m: f64,
    /// Relative change of tension by a change of the mesh that is allowed in motion. Smaller:
    /// sliding nodes come late. Larger: jerks.
    pub max_tension_change: f64,
    /// Fraction of the cable's weight that counts as tension in that comparison. Smaller: nearly
    /// slack cables keep their nodes. Larger: jerks in slack cables.
    pub weight_fraction: f64,
    /// Maximum number of changes of one kind after one step. Smaller: the rest waits for the next
    /// step. Larger: a cycle costs more.
    pub max_changes: usize,
    /// Arc from the tangent to the first mark beyond which another mark is put in its middle, rad.
    /// Smaller: more nodes. Larger: tension jumps along the round.
    pub max_marked_arc_rad: f64,
    /// Bars on a round up to which it keeps one mark. Smaller: more nodes. Larger: their weight
    /// acts in one point.
    pub one_mark_bars: f64,
    /// Gap that a bar must have when a node is removed, in reaches. Smaller: the barrier throws it.
    /// Larger: nodes stay.
    pub min_gap_reaches: f64,
}

impl Default for RemeshTuning {
    fn default() -> Self {
        Self {
            min_turn_rad: 0.05,
            min_bar: 0.35,
            max_bar: 1.6,
            removed_distance: 0.1,
            sliding_tension_weights: 4.0,
            max_reverse_turn_rad: 0.02,
            resolved_bend: 0.5,
            max_left_half_turn_rad: 1.0,
            max_tangent_half_turn_rad: 1.4,
            removed_turn_rad: 0.3,
            spare_bars: 1.3,
            fold_direction_sum: 0.2,
            impact_tension: 3.0,
            neighbourhood_m: 0.3,
            max_tension_change: 0.05,
            weight_fraction: 0.1,
            max_changes: 400,
            max_marked_arc_rad: 0.8,
            one_mark_bars: 0.3,
            min_gap_reaches: 0.05,
        }
    }
}

/// Constants of the first mesh and of adopted equilibria. Those of softer cables (`eased_loads`,
/// `softest_loads`, `stiffness_ratio`) were tuned on campaigns of slack cables
/// (`docs/notes/slack-cables.md`); what the others were tuned on is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartTuning {
    /// Length of a bar (m) without obstacles, if neither scene nor settings give a number of bars,
    /// within the bounds of that number. Smaller: more time; larger: less accurate.
    pub free_bar_m: f64,
    /// Length of a bar (m) with obstacles, under the same conditions. Smaller and larger as above.
    pub bar_m: f64,
    /// Least number of bars then. Smaller: the shape is visibly angular. Larger: more time.
    pub min_bars: f64,
    /// Greatest number of bars then. Smaller: long cables have longer bars. Larger: more time.
    pub max_bars: f64,
    /// Least distance of a corner of the route from other nodes, in even bars, to get a node of its
    /// own. Smaller: short bars. Larger: corners of the route are cut.
    pub route_node_bars: f64,
    /// The solution of `spans` is accepted as the initial equilibrium if no support force changes
    /// by more than this part of the greatest tension, and half the weight of a bar. Smaller:
    /// coarse meshes reject it and relax into folds. Larger: bars that are too long for the ground,
    /// held by friction at both ends, keep a tension that nothing else requires (25 bars on a
    /// robot's ground: 220 %).
    pub max_force_change: f64,
    /// The same fraction for a stiff cable, whose initial shape is that of a flexible one: its
    /// bending contributes to the support forces. Smaller and larger as above.
    pub max_stiff_force_change: f64,
    /// Number of bars from which the search for the initial equilibrium starts from that of a
    /// coarser mesh. Smaller: meshes that need no help are solved twice. Larger: a relaxation of a
    /// thousand bars takes minutes.
    pub two_mesh_bars: usize,
    /// Ratio of the bar lengths of the two meshes. Smaller: more meshes, each nearer to the next.
    /// Larger: the coarse solution differs from that of the fine mesh.
    pub mesh_ratio: usize,
    /// Least axial stiffness, in whole loads, of a cable whose search for the initial equilibrium
    /// starts from that of a softer one. Smaller: cables that need no help come to other
    /// equilibria. Larger: slack ones in folds find none (of 300 over posts and beams 10 did not).
    pub eased_loads: f64,
    /// Least axial stiffness, in whole loads, of these softer ones. Smaller: they stretch by more,
    /// and rest elsewhere. Larger: some folds do not yet come to rest.
    pub softest_loads: f64,
    /// Ratio of the axial stiffnesses of two such cables. Smaller: more of them. Larger: the next
    /// does not come to rest from where the one before did.
    pub stiffness_ratio: f64,
    /// Maximum number of bars of automatic refinement. Smaller: fewer scenes reach 1e-3. Larger:
    /// more do, each at twice the cost for twice the bars.
    pub max_refined_bars: usize,
    /// Number of marks on a round of an adopted equilibrium, for each bar that would lie on it.
    /// Smaller: tension jumps by more (by 1.2e-3 of the greatest with 1 on a post wrapped by 450°,
    /// 7e-4 with 1.5). Larger: more nodes.
    pub marks_per_bar: f64,
    /// Least distance of a new node of an adopted state from the ends of its bar, as a fraction of
    /// the bar. Smaller: bars without mass. Larger: corners beside a node are still cut off.
    pub min_part: f64,
    /// Length of a cable with self-contact, in lengths of its way, from which it begins on an arc.
    /// From 2.4 on parts of a cable laid along a straight line touch each other. Smaller: cables
    /// that need no arc begin there, and take longer. Larger: some begin pressed on themselves.
    pub arc_length_ratio: f64,
}

impl Default for StartTuning {
    fn default() -> Self {
        Self {
            free_bar_m: 0.2,
            bar_m: 0.12,
            min_bars: 60.0,
            max_bars: 200.0,
            route_node_bars: 0.3,
            max_force_change: 0.1,
            max_stiff_force_change: 0.5,
            two_mesh_bars: 500,
            mesh_ratio: 8,
            eased_loads: 1e5,
            softest_loads: 1e3,
            stiffness_ratio: 10.0,
            max_refined_bars: 800,
            marks_per_bar: 1.5,
            min_part: 0.05,
            arc_length_ratio: 2.0,
        }
    }
}
