//! The end stiffness of a cable is the change of force per metre that an end is moved.
//!
//! Each end is moved a little right and left, up and down, quasi-statically from the equilibrium,
//! with friction memory: sticking contacts stay so, and if a contact slides in one of the
//! directions, the figure is the mean of two. The derivative is the central difference of the
//! forces, K = −ΔR/2h with R the force of the cable on the support. Everything else is fixed:
//! motions, robots and loads have their values at time 0.

use serde::{Deserialize, Serialize};

use crate::any_error::Error;
use crate::math::{Point, Vec2, larger, vec2};
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::problem::TimeSeries;
use crate::scene::{Scene, SupportKind};
use crate::simulation::Simulation;

/// Change of the force by a move, as a fraction of the greatest tension. Larger: the difference is
/// no longer the derivative (its error is the square of this); smaller: the solver's unbalanced
/// force, 1e-8 of the tension, shows.
const FORCE_CHANGE_FRACTION: f64 = 1e-3;
/// First move, from which the others are scaled, in lengths of the cable. Larger: taut steel ropes
/// are overloaded; smaller: the answers of the mesh do not change.
const FIRST_MOVE_FRACTION: f64 = 1e-7;
/// Longest move, in lengths of the cable: a cable that yields so easily has no stiffness to speak
/// of.
const MAX_MOVE_FRACTION: f64 = 1e-3;
/// Time for a move, s; without inertia any value will do.
const MOVE_TIME_S: f64 = 0.01;

/// The stiffness of one end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EndStiffness {
    /// The cable's name.
    pub cable: String,
    /// The support's name.
    pub support: String,
    /// Change of the force with which the end must be held, right and up, for each metre it is
    /// moved: the first row is of the force to the right by moves to the right and up, the second
    /// that of the force upwards.
    pub stiffness_n_per_m: [[f64; 2]; 2],
    /// Distance of the move, m.
    pub moved_m: f64,
}

/// The stiffness of every held end of every cable, by the model for equilibrium.
///
/// # Errors
/// As [`Simulation::settle`] and [`Simulation::step_quasi_static`].
pub fn end_stiffness(scene: &Scene, model: Model, settings: Settings) -> Result<Vec<EndStiffness>, Error> {
    let still = scene_at_time_zero(scene);
    let question = if model.is_automatic() { Question::History(Inertia::QuasiStatic) } else { Question::Rest };
    let settings = Settings { histories: false, ..settings };
    let mut rest = Simulation::for_question(still.clone(), model, settings, question)?;
    let answer = rest.settle()?;
    let mut out = Vec::new();
    for (k, cable) in still.cables.iter().enumerate() {
        let mut ends = vec![0, cable.supports.len().saturating_sub(1)];
        ends.dedup();
        for support in ends {
            let Some(s) = cable.supports.get(support) else { continue };
            let (Some(at), true) = (s.at_m, matches!(s.kind, SupportKind::Fixed | SupportKind::Clamped)) else {
                continue;
            };
            let top = answer.cables.get(k).map_or(0.0, |c| c.nodes.iter().map(|n| n.tension_n).fold(0.0, larger));
            // Nothing is drawn or held through a part of the cable that lies loose, so the end
            // feels the equilibrium at its new place. A history would lift the cable off the ground
            // bar by bar.
            let is_loose = answer.cables.get(k).is_some_and(|c| c.nodes.iter().any(|n| n.tension_n <= 0.0));
            let moved = |by: Vec2| -> Result<Vec2, Error> {
                let answer = if is_loose {
                    let mut aside = still.clone();
                    if let Some(s) = aside.cables.get_mut(k).and_then(|c| c.supports.get_mut(support)) {
                        s.at_m = Some((vec2(at) + by).into());
                    }
                    Simulation::for_question(aside, model, settings, Question::Rest)?.settle()?
                } else {
                    let mut run = rest.clone();
                    run.drag_support(k, support, vec2(at) + by);
                    run.step_quasi_static(MOVE_TIME_S)?;
                    run.solution()
                };
                let reaction = answer.cables.get(k).and_then(|c| c.supports.get(support));
                Ok(reaction.map_or_else(Vec2::zeros, |r| Vec2::new(r.reaction_x_n, r.reaction_y_n)))
            };
            let difference = |way: Vec2, h: f64| Ok::<_, Error>((moved(way * -h)? - moved(way * h)?) / (2.0 * h));
            let probe = FIRST_MOVE_FRACTION * cable.length_m;
            let stiffest = larger(difference(Vec2::x(), probe)?.norm(), difference(Vec2::y(), probe)?.norm());
            let far = MAX_MOVE_FRACTION * cable.length_m;
            let wanted = FORCE_CHANGE_FRACTION * top / stiffest;
            let h = if wanted < probe {
                probe
            } else if wanted < far {
                wanted
            } else {
                far
            };
            let [by_x, by_y] = [difference(Vec2::x(), h)?, difference(Vec2::y(), h)?];
            out.push(EndStiffness {
                cable: cable.name.clone(),
                support: s.name.clone(),
                stiffness_n_per_m: [[by_x.x, by_y.x], [by_x.y, by_y.y]],
                moved_m: h,
            });
        }
    }
    Ok(out)
}

/// The scene as it is at time 0, with nothing that moves or changes.
fn scene_at_time_zero(scene: &Scene) -> Scene {
    let mut still = scene.clone();
    let hitch = scene.hitch_m();
    still.robot = None;
    let first = |times: &mut Vec<f64>, values: &mut Vec<Point>| {
        let value = (!times.is_empty()).then(|| TimeSeries::new(times, values).at(0.0));
        times.clear();
        values.clear();
        value.map(|v| [v.x, v.y])
    };
    for cable in &mut still.cables {
        for s in &mut cable.supports {
            if s.kind == SupportKind::Robot {
                s.kind = SupportKind::Fixed;
                s.at_m = hitch;
            }
            if let Some(motion) = s.motion.take() {
                let at = motion.at(0.0).0;
                s.at_m = Some([at.x, at.y]);
            }
            s.release_s = s.release_s.filter(|t| *t <= 0.0);
            s.force_n = first(&mut s.times_s, &mut s.forces_n).or(s.force_n);
        }
    }
    for load in &mut still.loads {
        load.force_n = first(&mut load.times_s, &mut load.forces_n).or(load.force_n);
    }
    let e = &mut still.environment;
    e.wind_n_per_m = first(&mut e.wind_times_s, &mut e.winds_n_per_m).unwrap_or(e.wind_n_per_m);
    still
}
