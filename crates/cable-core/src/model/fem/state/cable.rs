//! The state of a cable: its mesh, contacts and history, the loads of the present step, and its
//! answers. It knows nothing of solvers and of the control of time.

use std::sync::Arc;

use crate::contact::barrier::Barrier;
use crate::error::{Place, SolveError, Unsupported};
use crate::math::{Vec2, bounded};
use crate::model::fem::mesh::sliding_node::SlideOver;
use crate::model::fem::newton::initial_guess::{depenetrate, place_nodes, route};
use crate::model::fem::settings::{ContactTuning, StartTuning, Tuning};
use crate::model::fem::state::history::Motion;
use crate::model::fem::state::moving_outline::MovingOutline;
use crate::model::fem::system::assembly::Mesh;
use crate::model::fem::system::friction_state::{ContactPair, ContactSet, slip_at_rest};
use crate::model::fem::system::loss::Loss;
use crate::model::fem::system::step_input::{StepInput, Unknowns, load_scale, tolerance};
use crate::model::fem::touches_nothing;
use crate::model::{Model, Settings};
use crate::problem::{Problem, Series};
use crate::scene::SupportKind;
use crate::solution::CableSolution;
use crate::state::State;

/// Tension at the nodes of a mesh.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct Gauged {
    /// Arc length of each node, m.
    pub(in crate::model::fem) arc_length: Vec<f64>,
    /// Tension at each node, N.
    pub(in crate::model::fem) tension: Vec<f64>,
    /// Tension of each bar, N.
    pub(in crate::model::fem) bars: Vec<f64>,
}

/// The division of the cable into bars, and the nodes of supports and loads.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct Meshing {
    /// True if corners and posts get sliding nodes.
    pub(in crate::model::fem) slides: bool,
    /// True if there is no obstacle and no pulley that nodes could slide over.
    pub(in crate::model::fem) never_slides: bool,
    /// Number of bars of the even mesh.
    pub(in crate::model::fem) even_bars: usize,
    /// Normal force of an even bar on flat ground, N.
    pub(in crate::model::fem) bar_weight: f64,
    /// Node of each support; None for one that slides.
    pub(in crate::model::fem) support_node: Vec<Option<usize>>,
    /// Node of each point load, and its force.
    pub(in crate::model::fem) loads: Vec<(usize, Series)>,
    /// True if the last step was found to touch nothing but its supports.
    pub(in crate::model::fem) freely: bool,
    /// Room for the contacts among which corners are looked for.
    pub(in crate::model::fem) found: Vec<ContactPair>,
}

/// Report of the last step.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct StepAnswers {
    /// Force of the cable on each node that is held, N.
    pub(in crate::model::fem) reaction: Vec<Vec2>,
    /// Supports that were stopped short of their target.
    pub(in crate::model::fem) held_back: Vec<usize>,
    /// The answer of the last step of an advance, as it was balanced: the mesh is changed after it,
    /// for the next.
    pub(in crate::model::fem) stepped: Option<Box<CableSolution>>,
    /// True if the answer is kept before the mesh is changed.
    pub(in crate::model::fem) keeps: bool,
    /// The answer that was kept.
    pub(in crate::model::fem) kept: Option<Box<CableSolution>>,
    /// Tension after the last step, on the mesh that it balanced.
    pub(in crate::model::fem) gauged: Gauged,
}

/// The state of a cable in contact.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct CableState {
    pub(in crate::model::fem) problem: Arc<Problem>,
    pub(in crate::model::fem) mesh: Mesh,
    pub(in crate::model::fem) meshing: Meshing,
    pub(in crate::model::fem) contacts: ContactSet,
    pub(in crate::model::fem) motion: Motion,
    /// Loss of taut bars where the cable can touch nothing.
    pub(in crate::model::fem) loss: Loss,
    /// The outline of the robot, if there is one.
    pub(in crate::model::fem) outline: Option<MovingOutline>,
    /// Supports and loads of the present step.
    pub(in crate::model::fem) input: StepInput,
    pub(in crate::model::fem) answers: StepAnswers,
}

impl CableState {
    /// The cable along its route.
    pub(in crate::model::fem) fn new(problem: Arc<Problem>, settings: Settings, tuning: Arc<Tuning>) -> Self {
        let Tuning { contact, start, .. } = *tuning;
        let (outline, problem) = MovingOutline::of(problem);
        let route = route(&problem);
        let segments = segments(&problem, settings, &start);
        let even = problem.length / segments as f64;
        let mut breaks = vec![0.0, problem.length];
        breaks.extend(problem.supports.iter().filter_map(|s| s.arc_length));
        breaks.extend(problem.loads.iter().map(|l| l.arc_length));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b < 1e-9 * problem.length);
        if !problem.world.is_empty() || problem.cable.self_contact {
            for (s, _) in &route {
                if breaks.iter().all(|b| (b - s).abs() > start.route_node_bars * even) {
                    breaks.push(*s);
                }
            }
            breaks.sort_by(f64::total_cmp);
        }
        let mesh = Mesh::new(&problem, tuning, &breaks, segments, spreads_mass(&problem));
        let n = mesh.nodes();
        let support_node: Vec<Option<usize>> =
            problem.supports.iter().map(|s| s.arc_length.and_then(|a| mesh.node_at(a))).collect();
        let loads = problem.loads.iter().filter_map(|l| Some((mesh.node_at(l.arc_length)?, l.force.clone()))).collect();
        let (normal_per_m, whole) = load_scale(&problem);
        let barrier = Barrier { reach: contact.reach_m, stiffness: contact.stiffness_weights * normal_per_m * even };
        let input = StepInput { tolerance: tolerance(&problem, whole), ..StepInput::default() };
        let mut cable = Self {
            contacts: ContactSet::new(barrier, contact, n),
            motion: Motion {
                x: place_nodes(&mesh, &route),
                v: vec![Vec2::zeros(); n],
                x_before: vec![Vec2::zeros(); n],
                v_before: vec![Vec2::zeros(); n],
                x_older: vec![Vec2::zeros(); if mesh.spread.is_lumped() { 0 } else { n }],
                v_older: vec![Vec2::zeros(); if mesh.spread.is_lumped() { 0 } else { n }],
                s_before: mesh.arc_length.clone(),
                w: vec![0.0; n],
                w_before: vec![0.0; n],
                followers: vec![None; problem.supports.len()],
                hands: vec![None; problem.supports.len()],
                placement: problem.outline.as_ref().map(|o| o.placement),
                ..Motion::default()
            },
            meshing: Meshing {
                // A sliding node scales the forces of all that lies beyond it; what touches itself
                // has one scale.
                slides: !problem.cable.self_contact,
                never_slides: problem.world.is_empty()
                    && problem.supports.iter().all(|s| s.kind != SupportKind::Pulley),
                even_bars: segments,
                bar_weight: normal_per_m * even,
                support_node,
                loads,
                freely: false,
                found: Vec::with_capacity(n),
            },
            loss: if mesh.spread.is_lumped() { Loss::default() } else { Loss::of(&problem, even) },
            answers: StepAnswers {
                reaction: vec![Vec2::zeros(); n],
                held_back: Vec::new(),
                stepped: None,
                keeps: false,
                kept: None,
                gauged: Gauged::default(),
            },
            outline,
            mesh,
            input,
            problem,
        };
        if cable.problem.cable.self_contact {
            cable.contacts.own.shape.diameter = cable.problem.cable.diameter_m;
            cable.contacts.own.friction = cable.problem.cable.friction;
        }
        cable.forget_history();
        cable.prepare_input(0.0, None);
        for k in 0..n {
            if cable.mesh.held[k] {
                cable.motion.x[k] = cable.input.target[k];
            }
        }
        cable.thread_pulleys(None);
        let mut x = std::mem::take(&mut cable.motion.x);
        depenetrate(&cable.problem, &cable.mesh, &mut x, 0.9 * contact.reach_m);
        cable.motion.x = x;
        cable.forget_history();
        cable
    }

    /// True if there is nothing to touch: no obstacle, and the cable can pass itself.
    pub(in crate::model::fem) fn meets_nothing(&self) -> bool {
        self.problem.world.is_empty() && !self.contacts.own.shape.is_on()
    }

    /// Takes the friction of a balanced step over into the memory of the contacts.
    pub(in crate::model::fem) fn commit_contacts(&mut self, unknowns: &Unknowns) {
        self.contacts.commit(&self.problem, &self.mesh, &unknowns.x, &self.motion.x, &unknowns.slide);
    }

    /// Forgets the steps before the present instant.
    pub(in crate::model::fem) fn forget_history(&mut self) {
        self.answers.stepped = None;
        let m = &mut self.motion;
        m.x_before.clone_from(&m.x);
        m.v_before.clone_from(&m.v);
        m.w_before.clone_from(&m.w);
        m.s_before.clone_from(&self.mesh.arc_length);
        m.step_before = 0.0;
        m.branch.clear();
        self.forget_account();
    }

    /// Sets the input anew after a change of the mesh, for what is read off it between steps.
    pub(in crate::model::fem) fn renew_input(&mut self) {
        self.prepare_input(self.motion.time, None);
    }

    /// Centre of a pulley, m; None for other supports and pulleys that have let go.
    fn pulley_center(&self, support: usize) -> Option<Vec2> {
        self.mesh.sliding.iter().flatten().find(|s| s.slide_over == SlideOver::Pulley(support)).map(|s| s.end.center)
    }

    /// Position of a support, m.
    pub(in crate::model::fem) fn support_position(&self, support: usize) -> Option<Vec2> {
        match self.meshing.support_node.get(support).copied().flatten() {
            Some(node) => self.motion.x.get(node).copied(),
            None => self.pulley_center(support),
        }
    }

    /// Points to which hands draw supports in a part of the path that is left.
    pub(in crate::model::fem) fn aim(&self, aims: &mut Vec<Option<Vec2>>, dragged: &[Option<Vec2>], part: f64) {
        aims.clear();
        aims.extend(dragged.iter().enumerate().map(|(k, target)| {
            let (target, now) = ((*target)?, self.support_position(k));
            Some(now.filter(|_| part < 1.0 - 1e-9).map_or(target, |now| now + (target - now) * part))
        }));
    }

    pub(in crate::model::fem) fn refuse(&self) -> Result<(), SolveError> {
        let pulleys = self.mesh.sliding.iter().flatten().any(|s| matches!(s.slide_over, SlideOver::Pulley(_)));
        if self.problem.cable.self_contact && pulleys {
            let feature = Unsupported::SelfContactWithPulleys;
            return Err(SolveError::Unsupported { model: Model::Fem, feature });
        }
        Ok(())
    }

    /// The barrier's stiffness follows the greatest tension; `change` bounds by how much, up and
    /// down; `ahead` is how many times that tension is reckoned with.
    pub(in crate::model::fem) fn adapt_stiffness(&mut self, [up, down]: [f64; 2], ahead: f64) {
        if self.meets_nothing() {
            return;
        }
        let most = self.greatest_tension();
        let ContactTuning { stiffness_weights, stiffness_tensions, .. } = self.contacts.tuning;
        let least = stiffness_weights * self.meshing.bar_weight;
        let wanted = if stiffness_tensions * most > least { stiffness_tensions * most } else { least };
        let now = self.contacts.barrier.stiffness;
        self.contacts.barrier.stiffness = bounded(wanted * ahead, now * down, now * up);
    }

    /// The same for the sliding at which friction is fully mobilised, where inertia does not count.
    pub(in crate::model::fem) fn adapt_slip(&mut self) {
        let (weight, tension) = (load_scale(&self.problem).0 * self.problem.length, self.greatest_tension());
        self.contacts.set_slip(slip_at_rest(
            &self.contacts.tuning,
            &self.problem,
            if tension > weight { tension } else { weight },
        ));
    }

    /// Greatest tension of a bar, N.
    fn greatest_tension(&self) -> f64 {
        let tension = |e| self.mesh.bar(e).tension(self.mesh.path(e, &self.motion.x).length);
        (0..self.mesh.rest_length.len()).map(tension).fold(0.0, |most, t| if t > most { t } else { most })
    }

    /// `h` (s), or less where a support lets go on the way.
    pub(in crate::model::fem) fn until_release(&self, h: f64) -> f64 {
        let now = self.motion.time;
        let releases = self.problem.supports.iter().filter_map(|s| s.release_between(now, now + h));
        releases.fold(h, |least, r| if r - now < least { r - now } else { least })
    }

    /// The place of a node, in the words of the scene.
    pub(in crate::model::fem) fn place(&self, node: usize) -> Box<Place> {
        let arc_length = self.mesh.arc_length.get(node).copied().unwrap_or(f64::NAN);
        let at = self.motion.x.get(node).copied().unwrap_or(Vec2::repeat(f64::NAN));
        self.problem.place(arc_length, at, self.motion.time)
    }

    /// True if masses accelerate: it moves, or came here in a step with inertia.
    pub(in crate::model::fem) fn inertia_counts(&self) -> bool {
        self.motion.step_before > 0.0 || self.motion.v.iter().any(|v| v.norm_squared() > 0.0)
    }

    /// Time reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.motion.time
    }

    /// Positions and velocities of the cable.
    #[must_use]
    pub fn state(&self) -> State {
        State {
            time_s: self.motion.time,
            arc_length_m: self.mesh.arc_length.clone(),
            position_m: self.motion.x.clone(),
            velocity_m_per_s: self.motion.v.clone(),
            in_motion: false,
        }
    }

    /// The answer at this instant.
    #[must_use]
    pub fn solution(&self) -> CableSolution {
        self.answers.stepped.as_ref().map_or_else(|| self.solution_now(), |s| CableSolution::clone(s))
    }

    /// Keeps the answer of a step before the first change of its mesh.
    pub(in crate::model::fem) fn keep_answer(&mut self) {
        if self.answers.keeps && self.answers.kept.is_none() {
            self.answers.kept = Some(Box::new(self.solution_now()));
        }
    }

    /// Smallest gap of any free node or segment, m (infinite if nothing is near).
    #[cfg(test)]
    pub(in crate::model::fem) fn smallest_gap(&self) -> f64 {
        let mut touches = Vec::new();
        self.contacts.find(&self.problem, &self.mesh, &self.motion.x, &mut touches);
        touches.iter().map(|t| t.pair.gap.gap_m).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    }
}

/// True if the mass is spread over the bars. Where the cable can touch something it is lumped all
/// the time: contacts take momentum of one node, nodes come and go with corners and pulleys, and a
/// mass that changed as contact begins would change the energy.
fn spreads_mass(problem: &Problem) -> bool {
    touches_nothing(problem) && problem.supports.iter().all(|s| s.kind != SupportKind::Pulley)
}

/// Elements of a cable where neither the scene nor the settings give a number: finer where it can
/// touch an obstacle.
fn segments(problem: &Problem, settings: Settings, tuning: &StartTuning) -> usize {
    let element = if problem.world.is_empty() { tuning.free_bar_m } else { tuning.bar_m };
    let automatic = (problem.length / element).ceil().max(tuning.min_bars).min(tuning.max_bars) as usize;
    settings.segments.or(problem.cable.segments).unwrap_or(automatic).max(2)
}
