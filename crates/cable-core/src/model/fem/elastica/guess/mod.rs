//! These modules make the first guess of an elastica from an answer: that of a flexible cable, of
//! the contact mesh, or of a chain of bars.
//!
//! | room | content |
//! |---|---|
//! | `contacts_of_answer.rs` | contacts read off an answer's nodes or reports, or off a chain, with friction |
//! | `pieces.rs` | the cable divided into pieces at contacts, holds and loads; reduced EI |
//! | `bends.rs` | angles and moments of the pieces: boundary layers e^{−s/λ} or those of the nodes |
//!
//! The contacts of that answer (`contacts_of_answer`), the supports and the loads divide the cable
//! into pieces (`pieces`). Their nodes lie along the curve of the answer, and are bent like those
//! of a stiff cable (`bends`).

pub(super) mod contacts_of_answer;

mod bends;
mod pieces;

use crate::math::Vec2;
use crate::model::fem::elastica::boundary_value::{Elastica, End, Joint};
use crate::model::fem::elastica::chain::{BarChain, ChainContact};
use crate::model::fem::elastica::reference_curve::ReferenceCurve;
use crate::model::fem::free::place as support_place;
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::CableSolution;

/// Distance below which two places of the cable are one (round-off), as a fraction of its length.
const SAME_PLACE_FRACTION: f64 = 1e-9;

/// A contact, support or load between two arc lengths (m).
#[derive(Clone, Copy, Debug)]
struct Attachment {
    from: f64,
    to: f64,
    joint: Joint,
}

/// The part of an answer from which contacts are read.
enum ContactSource<'a> {
    /// Nodes of a flexible cable that touch something.
    Nodes,
    /// The contacts that a mesh with bars of this length (m) reports.
    Reports { bar: f64 },
    /// The contacts of a chain with bars of this length (m).
    Chain { bar: f64, contacts: &'a [ChainContact] },
}

/// The first guess of an elastica under construction.
struct ElasticaGuess<'a> {
    problem: &'a Problem,
    time_s: f64,
    dragged: &'a [Option<Vec2>],
    answer: &'a CableSolution,
    /// The nodes of the answer.
    curve: ReferenceCurve<'a>,
    elastica: Elastica,
    attachments: Vec<Attachment>,
}

impl Elastica {
    /// Makes a first guess from the answer for a flexible cable, at rest at a time (s); None if the
    /// scene or the answer has things that an elastica does not model.
    pub fn from_flexible(
        problem: &Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        answer: &CableSolution,
    ) -> Option<Self> {
        ElasticaGuess::new(problem, time_s, dragged, answer)?.elastica_of(&ContactSource::Nodes)
    }

    /// Makes a first guess from an answer of the contact mesh for the stiff cable itself. `bar` is
    /// the length of its bars (m), and so the accuracy of its contact places.
    pub fn from_mesh(
        problem: &Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        answer: &CableSolution,
        bar: f64,
    ) -> Option<Self> {
        ElasticaGuess::new(problem, time_s, dragged, answer)?.elastica_of(&ContactSource::Reports { bar })
    }

    /// Makes a first guess from a chain of bars at rest.
    pub(super) fn from_chain(chain: &BarChain<'_>) -> Option<Self> {
        let chain_input = chain.chain_input;
        let contacts = chain_input.friction_source.map_or_else(Vec::new, |answer| answer.contacts.clone());
        let answer = CableSolution { nodes: chain.nodes().into(), contacts, ..CableSolution::default() };
        let source = ContactSource::Chain { bar: chain.bar, contacts: &chain.pushing_contacts() };
        ElasticaGuess::new(chain_input.problem, chain_input.time_s, chain_input.dragged, &answer)?.elastica_of(&source)
    }
}

impl<'a> ElasticaGuess<'a> {
    /// The cable with its supports and loads; None if the scene or the answer has things that an
    /// elastica does not model.
    fn new(problem: &'a Problem, time_s: f64, dragged: &'a [Option<Vec2>], answer: &'a CableSolution) -> Option<Self> {
        let alone =
            problem.knows_obstacles_at(time_s) && problem.floor_friction.is_none() && !problem.cable.self_contact;
        if !alone || answer.nodes.len() < 2 || !answer.breaks.is_empty() {
            return None;
        }
        let scale = problem.force_scale();
        let elastica = Elastica {
            axial_stiffness: problem.axial_stiffness,
            bending: problem.bending_stiffness,
            thermal_stretch: problem.thermal_stretch,
            body: problem.body_force(time_s),
            length: problem.length,
            scale: answer.nodes.iter().map(|n| n.tension_n).fold(scale, |m, t| if t > m { t } else { m }),
            pieces: Vec::new(),
            joints: Vec::new(),
            ends: [End::Loaded(Vec2::zeros()); 2],
            contacts: Vec::new(),
            steps: 0,
            work: 0,
            residual: 0.0,
            shrinking: None,
        };
        let curve = ReferenceCurve::new(&answer.nodes);
        let mut guess = Self { problem, time_s, dragged, answer, curve, elastica, attachments: Vec::new() };
        guess.attach_supports()?;
        guess.attach_loads();
        Some(guess)
    }

    /// Sets the ends, and attaches the supports between them; None where an end is at a pulley.
    fn attach_supports(&mut self) -> Option<()> {
        let problem = self.problem;
        let gravity =
            if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
        let last = problem.supports.len().checked_sub(1)?;
        for (k, s) in problem.supports.iter().enumerate() {
            let at = support_place(problem, k, self.time_s, self.dragged);
            let loaded = matches!(s.kind, SupportKind::Load | SupportKind::Free) || at.is_none();
            let force = s.force.at(self.time_s) + gravity * s.mass;
            let angle = s.angle.filter(|_| s.kind == SupportKind::Clamped);
            let place = at.filter(|_| !loaded);
            if k == 0 || k == last {
                if s.kind == SupportKind::Pulley {
                    return None;
                }
                self.elastica.ends[usize::from(k > 0)] = place.map_or(End::Loaded(force), |p| End::Held(p, angle));
            } else if s.kind != SupportKind::Pulley {
                let arc = s.arc_length?;
                let joint = match place {
                    Some(at) => Joint::Held { support: k, arc, at, angle },
                    None => Joint::Load { support: Some(k), arc, force },
                };
                self.attachments.push(Attachment { from: arc, to: arc, joint });
            }
        }
        Some(())
    }

    /// Attaches the point loads. One at an end adds to its load, or to the support there.
    fn attach_loads(&mut self) {
        let length = self.problem.length;
        for load in &self.problem.loads {
            let (arc, force) = (load.arc_length, load.force.at(self.time_s));
            let at_end = |(_, at): &(&mut End, f64)| (arc - at).abs() <= SAME_PLACE_FRACTION * length;
            match self.elastica.ends.iter_mut().zip([0.0, length]).find(at_end) {
                Some((End::Loaded(f), _)) => *f += force,
                Some(_) => {}
                None => {
                    let joint = Joint::Load { support: None, arc, force };
                    self.attachments.push(Attachment { from: arc, to: arc, joint });
                }
            }
        }
    }

    /// The elastica with the contacts of a source. With those of a flexible cable it begins nearly
    /// flexible, with boundary layers at the ends of its free pieces; otherwise it is bent like the
    /// nodes of the answer.
    fn elastica_of(mut self, source: &ContactSource<'_>) -> Option<Elastica> {
        match *source {
            ContactSource::Nodes => self.attach_touching_nodes(),
            ContactSource::Reports { bar } => self.attach_reported_contacts(bar),
            ContactSource::Chain { bar, contacts } => self.attach_chain_contacts(bar, contacts),
        }
        self.attachments.sort_by(|a, b| a.from.total_cmp(&b.from));
        if let ContactSource::Nodes = source {
            self.reduce_stiffness();
            self.divide()?;
            self.add_end_layers()?;
        } else {
            self.divide()?;
            self.bend_as_nodes()?;
        }
        Some(self.elastica)
    }
}
