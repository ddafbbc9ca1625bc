//! The tuned constants of the model in contact and in motion. [`Tuning::default`] has the values
//! that the program uses; a measurement (`cargo run --release -p cable-benches --bin
//! tuned-settings`) tries others.
//!
//! Constants that rounding or an error bound fixes stand beside their code, and so do those of the
//! equilibria without contact (`free`) and of the elastica, whose iterations end at rounding.

use serde::{Deserialize, Serialize};

/// The tuned constants of the model, in groups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tuning {
    /// The barrier of contacts, and the sliding at which friction acts whole.
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
    /// The first mesh, and equilibria taken over from other models.
    pub start: StartTuning,
}

/// Constants of the barrier and of friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactTuning {
    /// Gap at which contact begins (d̂), m. Where the cable is taut a corner lifts it by this: 1e-3
    /// adds 2 % to the tension of a soft cable of 12 m over two beams, 1e-4 nothing that shows.
    /// Smaller takes more iterations, larger lifts the cable.
    pub reach_m: f64,
    /// Stiffness of the barrier, in weights of an even bar. Smaller rebounds, and costs 30 % more
    /// at a twentieth; larger brings contacts to the edge of the reach, where they come and go.
    pub stiffness_weights: f64,
    /// The same in greatest tensions, where that is more. With a hundredth of it the gap of a node
    /// that a taut cable turns at is still a millionth of a metre; with the weight alone a cable of
    /// 1e6 N came as near as 1e-9 m, and no Newton step moved it. Larger lifts the cable.
    pub stiffness_tensions: f64,
    /// Greatest factor of the stiffness from one step to the next. Smaller lags behind a snatch,
    /// larger jolts what lies in contact.
    pub stiffness_rise: f64,
    /// Least such factor. Smaller jolts what lies in contact, larger stays hard after a snatch.
    pub stiffness_fall: f64,
    /// Times the stiffness for its tension that a failed step is tried again with: the tension may
    /// grow in it. Smaller fails where a step draws the cable taut, larger lifts it.
    pub retry_stiffening: f64,
    /// Sliding at which friction acts whole (ε) in motion, and the most of it at rest, m. 1e-6
    /// costs half as many iterations again, 1e-4 creeps.
    pub slip_m: f64,
    /// ε at rest in parts of what the cable stretches under its weight or its greatest tension:
    /// where holding ground gives way by as much as the cable stretches, nothing shows that it
    /// holds. Of the tension where a pull has turned round 1e-3 loses up to 3 %, 1e-4 up to 0.9 %;
    /// smaller costs iterations.
    pub slip_stretch_fraction: f64,
    /// Least ε, m. Friction of newtons is then a spring of 1e9 N/m, and the rounding of a
    /// coordinate of 10 m still a millionth of ε. Smaller comes near to rounding, larger creeps at
    /// rest.
    pub min_slip_m: f64,
    /// Steps for which a contact without load is remembered. Fewer: trembling contacts creep. Many
    /// more: a cable that was lifted and put back is held as if it had stayed.
    pub remembered_steps: usize,
    /// Steps for which lists of what is near are made. Fewer: they are made more often. More: they
    /// are longer.
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

/// Constants of Newton's method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonTuning {
    /// Iterations of the mixed method in contact before the minimiser is asked. Fewer: one of its
    /// iterations costs as much as five of these. More: where it is needed after all they are lost:
    /// of eight drops of 600 bars 250 of 960 steps come to it with 20 as with 40, in 14 600
    /// iterations and in 20 700.
    pub mixed_iterations: usize,
    /// The same where nothing is touched. Measured: 2 to 5 in a swing, up to 12 where a slack chain
    /// snaps taut.
    pub free_iterations: usize,
    /// Parts of the push of bars that are counted where all of it makes the matrix indefinite, one
    /// after the other. Iterations of a cable of 1000 bars that drops, over 24 drops, with none of
    /// it at once: 15 % more; with 0.5 and none: 2 % more.
    pub push_fractions: [f64; 3],
    /// Part of the first residual with which what was reached is handed on to the minimiser.
    /// Smaller: it begins anew though it is near. Larger: it begins from where nothing is gained.
    pub handed_on_residual_fraction: f64,
    /// Rounds of adding contacts ahead to the active set. Fewer: a step runs into what it has not
    /// seen. More find nothing new where a front of contact runs along the cable.
    pub active_set_rounds: usize,
    /// Part of a step that may be free without looking for what is in its way. Smaller: steps are
    /// cut short. Larger: the same step is solved twice.
    pub free_step_fraction: f64,
    /// Least descent of a step held by contacts ahead, of that of the free one. Smaller: steps that
    /// only bend round corners and gain nothing. Larger: good ones are given up.
    pub min_descent_fraction: f64,
    /// Gap at which contacts ahead land, of the barrier's reach: about where it holds a node.
    /// Smaller: they land too hard. Larger: they are let down in more steps.
    pub landing_gap_fraction: f64,
    /// Part of the room that constraints and step bound leave to each other: contacts within the
    /// reach are held to this part of the loss that the bound lets them, and wider gaps are bound
    /// to this part of where foreseen contacts land. Smaller: more steps. Larger: rounding lets the
    /// bound cut a step that lands.
    pub bound_margin: f64,
    /// Stiffness of a constraint, in the largest stiffness at its nodes. Softer: nodes still run
    /// into the barrier. Much harder: rounding.
    pub constraint_hardness: f64,
    /// Change of what a constraint leaves, in gaps left, that is not followed. Smaller: rounds for
    /// nothing. Larger: a bar that turns runs into its corner.
    pub constraint_tolerance: f64,
    /// Part of each gap that a step leaves. Smaller: gaps shrink faster than Newton opens them
    /// again (with 0.2 twice as many steps of ends thrown about are halved, five times as many
    /// where the cable meets itself). Larger: more steps.
    pub kept_gap_fraction: f64,
    /// Least part of the cable between a sliding node and its neighbour that an iteration leaves.
    /// Smaller: a bar shrinks to nothing in a few iterations. Larger: more iterations.
    pub kept_cable_fraction: f64,
    /// Sufficient decrease of the line search (Armijo), of what the slope promises. Smaller: steps
    /// that gain nothing. Larger: good steps are cut.
    pub decrease: f64,
    /// Halvings of the line search before the step is given up. Fewer: steps fail. More: a failure
    /// costs more.
    pub max_halvings: usize,
    /// Unbalanced force, in tolerances, that is accepted where iterating gains nothing more: 3e-5
    /// of the whole load. Smaller: rounding fails steps. Larger: forces are off by as much.
    pub stalled_residual: f64,
    /// Unbalanced force of a stretch of cable at rest, in tolerances: those of its nodes add up.
    /// Smaller: iterations for nothing that shows. Larger: the laws, which ask this of stretches to
    /// 1e-5 of the forces, refuse steps.
    pub stretch_residual: f64,
    /// Short moves of held nodes towards their targets before they are stopped. Fewer: supports lag
    /// that could have got there. More: iterations spent on what the next step does as well.
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

/// Constants of steps in time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepTuning {
    /// Longest inner step, s, where none is asked for. At 1/240 the tip of a falling chain of 10 m
    /// is within 5e-4 m of that of rigid links (`tests/dynamics`). Smaller is dearer, larger
    /// coarser.
    pub longest_s: f64,
    /// Part of a step that the first one of a motion takes, the next ones each as long as all
    /// before. It has no history: implicit Euler carries a cable let go ½ a h² too far, and BDF2
    /// makes ¾ a h² of that. Larger: a free fall at 1/240 s is off by ¾ of this part's square times
    /// 1.7e-4 m. Smaller: one step more for each halving.
    pub first_fraction: f64,
    /// The shortest step, of the longest: with 1/240 s frequencies up to 17 Hz are exact to 1e-3,
    /// those of 40 Hz to 6e-3. Smaller: a vibrating cable costs more than its vibration is worth.
    /// Larger: only lower frequencies are exact.
    pub shortest_fraction: f64,
    /// Amplitude, of the cable's length, below which vibrations are left as they are: what is left
    /// over from coming to rest rings at any frequency, and 0.1 mm in 10 m is no motion that a user
    /// sees. Smaller: short steps for nothing. Larger: vibrations are damped.
    pub vibration_fraction: f64,
    /// Greatest factor of the step from one frame to the next; BDF2 is stable up to 2.4. Smaller:
    /// the step lags behind the motion.
    pub max_change: f64,
    /// Time constant of the memory of a motion, s. Half a period of a motion that needs shorter
    /// steps passes in it. Smaller: the step is short where a vibration turns and long where it is
    /// fastest. Larger: short steps go on after the vibration.
    pub memory_s: f64,
    /// Time for which a cable must have been still to sleep, s. Smaller: a slow swing that turns
    /// round may be caught. Larger: rest costs for longer.
    pub sleep_delay_s: f64,
    /// Distance by which a node may have moved in that time, in reaches of the barrier: a trembling
    /// contact moves its neighbours by a few. Smaller: trembling keeps a cable awake. Larger: a
    /// slow motion is caught.
    pub sleep_distance_reaches: f64,
    /// Most halvings of a step. Fewer: steps fail. More: a failure costs more.
    pub max_halvings: usize,
    /// Halvings of a step before the robot has to wait for the cable. Fewer: it jerks. More: it
    /// costs.
    pub halvings_before_robot_waits: usize,
    /// Newton iterations of a step. Fewer: steps are halved that would have converged. More: a
    /// failure costs more.
    pub max_iterations: usize,
    /// Newton iterations of the hardest step of a frame up to which the next frame may take longer
    /// steps again. Of a cable of 1000 bars that drops on rubble, fewer: 7 cost 1.7 times as many
    /// iterations in all, in shorter steps. More: 40 have three times as many steps refused.
    pub easy_iterations: usize,
    /// Rounds of finding out which sliding nodes hold in which no fewer are wrong than before,
    /// until they are changed one at a time. Fewer: steps of a few nodes that free each other in
    /// turn take longer, or are halved. More: a cycle costs more.
    pub grip_rounds: usize,
    /// Rounds beside those for each sliding node. Fewer: steps in which many begin to slip one
    /// after the other are halved. More: what does not end costs more.
    pub grip_rounds_each: usize,
    /// Rounds in which friction follows its normal forces. With none the greatest tension of a
    /// stiff cable (1 N m²) that drops on rubble is 537, 352 and 789 N with 84, 168 and 336 bars at
    /// 1/960 s, with one 427, 399 and 463 N; a second changes that by 2 %, and costs as much as the
    /// step (a pile: 1.5 s, 0.9 with one).
    pub friction_rounds: usize,
    /// Change of a friction force that is none, of the greatest. Smaller: sliding costs twice as
    /// much and changes by nothing that shows. Larger: impacts rub late.
    pub friction_change: f64,
    /// Part of the greatest friction of a sliding node by which its friction may differ from that
    /// of its turn and grip after a step. Smaller: rounds for nothing that shows. Larger: friction
    /// beyond its cone (the checker asks for 1e-3 of the normal force).
    pub grip_tolerance: f64,
    /// Normal speed below which a contact is left alone by the plastic impulse, m/s. Smaller:
    /// resting contacts are asked for nothing. Larger: slow impacts rebound.
    pub plastic_speed_m_per_s: f64,
    /// Gap that a support keeps from what it is driven against, in reaches. The bar beside it
    /// presses there with hardly a lever. Smaller: its normal force, 1e14 N at 1e-8 m, is all that
    /// Newton sees. Larger: the support stops short.
    pub support_gap_reaches: f64,
    /// Part of its gap that a support keeps in one step. Smaller: it comes into the barrier with
    /// its whole speed. Larger: it lags.
    pub kept_support_gap_fraction: f64,
    /// Halvings of the way of a support that comes too near, before it stays where it is. Fewer: it
    /// stops early.
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
            support_gap_reaches: 0.2,
            kept_support_gap_fraction: 0.2,
            stand_off_tries: 4,
        }
    }
}

/// Constants of steps without inertia and of the search for an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EquilibriumTuning {
    /// Work that one search for an equilibrium may do: iterations times nodes. Smaller: scenes that
    /// converge slowly are refused. Larger: a search that fails reports it after minutes. The value
    /// is 20 000 iterations of 200 nodes, and takes some 10 s.
    pub max_work: usize,
    /// Newton iterations of a step. Fewer: relaxations that a few more would have spared. More: a
    /// failure costs more.
    pub max_iterations: usize,
    /// Halvings of a step before the cable is let down to its rest instead. Fewer: on the way down
    /// corners slip, and keep that (1 to 3 % of the tension in 4 of 200 scenes). More: cables that
    /// need it take longer.
    pub halvings_before_relaxation: usize,
    /// Steps of relaxation before it is given up. Fewer: equilibria are missed. More: a failure
    /// costs more.
    pub max_relaxation_steps: usize,
    /// Rounds of refreshing the normal forces of friction in a step. Fewer: steps are halved. More:
    /// a cycle costs more.
    pub lag_rounds: usize,
    /// Rounds after which the limits of friction are sought between two that were tried: where a
    /// contact that rubs more lifts its neighbour, which then rubs less, taking what the last round
    /// allows never ends. A step of relaxation, which need not end, has no others. Fewer: what
    /// converges by itself takes longer. More: fewer rounds are left.
    pub whole_lag_rounds: usize,
    /// Whole load, in weights of the cable, from which dead loads set the first resistance.
    /// Smaller: a way down with a little load is slower than it need be. Larger: loads of that many
    /// weights throw the cable about.
    pub dead_load_weights: f64,
    /// Unbalanced force, in tolerances, that is accepted where contact forces are known no better:
    /// 1e-3 of the whole load. Smaller: cables that a support squeezes find no rest. Larger: a node
    /// a rounding away from a corner makes any force a rest (6e10 N were taken for one).
    pub squeezed_residual: f64,
    /// Part of all loads on a cable that may be held by nothing. Smaller: what rests is refused for
    /// what its nodes are let off with. Larger: what slides slowly is said to rest. Of slopes,
    /// posts, beams and drapes at random those that held left up to 4e-5, those with 0.3 % too
    /// little friction 3e-4 and more.
    pub unheld_load_fraction: f64,
    /// Unbalanced force of a polished rest, in tolerances. It is polished in three stages, whose
    /// residuals fall evenly from one tolerance to this. Smaller: nothing but rounding is gained.
    /// Larger: the forces left at a hundred nodes of a cable that all but slides show in the
    /// balance of the whole.
    pub polish_residual: f64,
    /// Newton iterations of the first stage, which continues a search that came to its last
    /// iteration. Fewer: a cable that slides as a whole on smooth ground does not come to rest.
    pub polish_iterations: usize,
    /// Times a rest is sought again because corners were met or left on the way to it. Fewer: it is
    /// refused. More: a cycle costs more.
    pub corner_rounds: usize,
    /// Turn the wrong way round a corner from which a step is taken again without that corner, rad.
    /// Smaller: more steps are taken twice. Larger: other corners slip by what it pulls (at 0.02
    /// and 50 N by 2 %), and keep that.
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

/// Constants of the moving outline of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutlineTuning {
    /// Longest way of the outline in a step without inertia, m. Smaller: more steps. Larger: the
    /// cable is thrown ahead of it.
    pub max_way_m: f64,
    /// Distance within which bars go with the outline, m, beside four of its ways. Smaller: bars
    /// just beyond are folded against those that go. Larger: what lies on the ground some way off
    /// is moved for nothing.
    pub carried_distance_m: f64,
    /// Parts of its way that are tried. Smaller parts: a cable squeezed against a wall is asked
    /// again. Larger: the outline stops before it must.
    pub way_fractions: [f64; 4],
    /// Part of a gap that is left when what stands in the way pushes back. Smaller: nodes in a
    /// corner come into the barrier. Larger: more rounds.
    pub kept_gap_fraction: f64,
    /// Rounds of giving gaps back. Fewer: a node in a corner between outline and ground stays near.
    /// More: a squeezed one, which never ends, costs more.
    pub max_rounds: usize,
    /// Distance by which a hitch that a wall stopped is left behind, m; then the outline waits for
    /// it. Smaller: the robot is stopped by what it could pass. Larger: hitch and robot part.
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

/// Constants of changes of the mesh between steps. Lengths of bars are in even bars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RemeshTuning {
    /// Turn below which corners are left to the barrier, rad: there a chain jerks by less than 1e-3
    /// of its tension. Smaller: sliding nodes on every facet of the ground. Larger: jerks.
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
    /// Tension, in weights of an even bar, from which a corner gets a sliding node. It loses it
    /// below half of that: a slack cable lies on corners with its nodes, and the barrier carries it
    /// as well. Smaller: a slack cable gets them, and loses them again. Larger: chains jerk at
    /// corners, node by node.
    pub sliding_tension_weights: f64,
    /// Turn the wrong way round a corner that a step may end with, rad; the node leaves after it.
    /// Smaller: more steps are taken twice. Larger: its tangents would lie inside the obstacle.
    pub max_reverse_turn_rad: f64,
    /// √(EI/T), in even bars, beyond which a cable's bend is seen by the mesh. Smaller: chains jerk
    /// at corners, node by node. Larger: what a corner's bend costs is left out where it need not
    /// be.
    pub resolved_bend: f64,
    /// Half of the turn up to which a slack cable may leave a round with one node, rad. Smaller: it
    /// hangs there. Larger: the node is far from the round.
    pub max_left_half_turn_rad: f64,
    /// Half of the turn up to which the node that takes the place of a sliding one goes where the
    /// tangents meet, and up to which one mark of a round can carry the cable, rad. Smaller: a bar
    /// cuts the corner. Larger: it is put far away.
    pub max_tangent_half_turn_rad: f64,
    /// Turn below which a node that leaves its corner is taken out, rad; else it becomes a node of
    /// the cable. Smaller: more nodes. Larger: the cable loses a bend.
    pub removed_turn_rad: f64,
    /// Length of two bars together below which the node between them is taken out. Smaller: more
    /// nodes. Larger: they come and go.
    pub spare_bars: f64,
    /// Length of the sum of the directions before and after a node below which the cable counts as
    /// folded there. Smaller: folds get sliding nodes. Larger: sharp turns get none.
    pub fold_direction_sum: f64,
    /// Tension of a taut cable in motion, in EA (v/c)^(4/3): something that it hits across at a
    /// speed v makes 0.63 of it. Smaller: sliding nodes come and go where a falling cable strikes.
    /// Larger: a cable drawn fast over corners jerks at them.
    pub impact_tension: f64,
    /// Distance from a corner within which speeds count, m of arc length. Smaller: what comes is
    /// not seen. Larger: motion elsewhere counts.
    pub neighbourhood_m: f64,
    /// Part by which a change of the mesh may change tension in motion. Smaller: sliding nodes come
    /// late. Larger: jerks.
    pub max_tension_change: f64,
    /// Part of the cable's weight that counts as tension there. Smaller: what is nearly slack keeps
    /// its nodes. Larger: jerks in slack.
    pub weight_fraction: f64,
    /// Most changes of one kind after one step. Fewer: the rest waits for the next. More: a cycle
    /// costs more.
    pub max_changes: usize,
    /// Arc from the tangent to the first mark beyond which another mark is put in its middle, rad.
    /// Smaller: more nodes. Larger: tension jumps along the round.
    pub max_marked_arc_rad: f64,
    /// Bars on a round up to which it keeps one mark. Smaller: more nodes. Larger: their weight
    /// acts in one point.
    pub one_mark_bars: f64,
    /// Gap that a bar must have when a node is taken out, in reaches. Smaller: the barrier throws
    /// it. Larger: nodes stay.
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

/// Constants of the first mesh and of equilibria taken over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartTuning {
    /// Length of a bar, m, where neither scene nor settings give a number, there are no obstacles,
    /// and the bounds of their number allow it. Smaller is dearer, larger coarser.
    pub free_bar_m: f64,
    /// The same where there are obstacles.
    pub bar_m: f64,
    /// Least number of bars then. Fewer are visibly angular.
    pub min_bars: f64,
    /// Greatest number of bars then. More are dearer.
    pub max_bars: f64,
    /// Least distance of a corner of the route from other nodes, in even bars, to get a node of its
    /// own. Smaller: short bars. Larger: corners of the route are cut.
    pub route_node_bars: f64,
    /// The solution of `spans` is accepted as the initial equilibrium if no support force changes
    /// by more than this part of the greatest tension. Smaller: coarse meshes reject it and relax
    /// into folds. Larger: bars that are too long for the ground, held by friction at both ends,
    /// keep a tension that nothing else requires (25 bars on a robot's ground: 220 %).
    pub max_force_change: f64,
    /// The same for a stiff cable, whose initial shape is that of a flexible one: its bending
    /// contributes to the support forces.
    pub max_stiff_force_change: f64,
    /// Number of bars from which on the search for the initial equilibrium begins at that of a
    /// coarser mesh. Fewer: meshes that need no help are solved twice. More: a relaxation of a
    /// thousand bars takes minutes.
    pub two_mesh_bars: usize,
    /// Ratio of the bar lengths of the two meshes. Smaller: more meshes, each nearer to the next.
    /// Larger: the coarse solution differs from that of the fine mesh.
    pub mesh_ratio: usize,
    /// Least axial stiffness, in whole loads, of a cable whose search for the initial equilibrium
    /// begins at that of a softer one. Smaller: cables that find theirs by themselves come to lie
    /// otherwise. Larger: slack ones in folds find none (of 300 over posts and beams 10 did not).
    pub eased_loads: f64,
    /// Least axial stiffness, in whole loads, of these softer ones. Smaller: they stretch by more,
    /// and rest elsewhere. Larger: some folds find no rest yet.
    pub softest_loads: f64,
    /// Ratio of the axial stiffnesses of two such cables. Smaller: more of them. Larger: the next
    /// does not come to rest from where the one before did.
    pub stiffness_ratio: f64,
    /// Most bars to which a mesh is refined by itself. More: 1e-3 is met by more scenes, each twice
    /// as dear as with half as many.
    pub max_refined_bars: usize,
    /// Marks on a round that is taken over, for each bar that would lie on it. Fewer: tension jumps
    /// by more (1.2e-3 of the greatest with 1 round a post of 450°, 7e-4 with 1.5). More: more
    /// nodes.
    pub marks_per_bar: f64,
    /// Part of a bar that a new node of a state taken over keeps away from its ends. Smaller: bars
    /// without mass. Larger: corners beside a node are still cut off.
    pub min_part: f64,
    /// Length of a cable with self-contact, in lengths of its way, from which it begins on an arc.
    /// At 2.4 the first parts that may touch do, laid along a straight line. Smaller: cables that
    /// need no arc begin there, and take longer. Larger: some begin pressed on themselves.
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
