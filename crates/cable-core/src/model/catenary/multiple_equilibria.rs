//! This module finds the other equilibria of a slack cable over frictionless pulleys.
//!
//! A loop between two pulleys pulls the harder the longer it is, so that the slack may
//! rest in one span as well as in another: the energy has more than one minimum in the material at
//! the pulleys. It is minimised from the slack of each part of the cable in each of its spans.

use std::sync::Arc;

use super::CatenaryModel;
use super::equilibrium::{Equilibrium, SlidingStart, solve};
use super::first_guess::{first_arcs, taut_arc_lengths};
use super::results::report;
use super::sliding_problem::PulleyMode;
use super::supports_and_loads::{SupportLayout, SupportNode};
use crate::math::{larger, smaller};
use crate::model::Settings;
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Histories, Node};

/// First excess material of a taut span, as a fraction of its length. Smaller: it pulls so hard
/// that it draws the slack over at once; larger: the slack begins in more than one span.
const SPARE_FRACTION: f64 = 1e-3;
/// Greatest fraction of the slack that is used for that.
const SPARE_SLACK_FRACTION: f64 = 0.1;
/// Slack below which there is none, as a fraction of the length.
const LEAST_SLACK_FRACTION: f64 = 1e-6;
/// Difference of the material at a pulley from which two equilibria are different, as a fraction of
/// the length. Smaller: two answers of one search count as two; larger: nearby equilibria count as
/// one.
const DIFFERENT_MATERIAL_FRACTION: f64 = 1e-5;
/// Most starts. Smaller: balances of cables over many pulleys are missed; larger: they take long.
const MAX_STARTS: usize = 24;

/// Tensions of a balance at the start, at the end and at most, N.
fn tensions(nodes: &[Node]) -> [f64; 3] {
    let at = |n: Option<&Node>| n.map_or(f64::NAN, |n| n.tension_n);
    [at(nodes.first()), at(nodes.last()), nodes.iter().map(|n| n.tension_n).fold(0.0, larger)]
}

/// The material at the anchors with the slack of one part of the cable in one of its spans, for
/// each span, m.
fn starts(problem: &Problem, layout: &SupportLayout, sigma: &[f64]) -> Vec<Vec<f64>> {
    let way: Vec<f64> = taut_arc_lengths(layout).into_iter().map(|w| w / problem.thermal_stretch).collect();
    let last = sigma.len() - 1;
    let bounds: Vec<usize> =
        (0..=last).filter(|&k| k == 0 || k == last || layout.anchors[k].material_point.is_some()).collect();
    let mut out = Vec::new();
    for part in bounds.windows(2) {
        let [from, to] = [part[0], part[1]];
        let taut = way[to] - way[from];
        let slack = sigma[to] - sigma[from] - taut;
        if to - from < 2 || !(slack > LEAST_SLACK_FRACTION * problem.length) {
            continue;
        }
        let spare = 1.0 + smaller(SPARE_FRACTION, SPARE_SLACK_FRACTION * slack / taut);
        for receives in from..to {
            let mut start = sigma.to_vec();
            for k in from + 1..to {
                start[k] = if k <= receives {
                    sigma[from] + (way[k] - way[from]) * spare
                } else {
                    sigma[to] - (way[to] - way[k]) * spare
                };
            }
            out.push(start);
        }
    }
    out.truncate(MAX_STARTS);
    out
}

/// The tensions of the other equilibria of a cable over frictionless pulleys, with those of an
/// answer at a time (s). None if none was found, or if obstacles, bending stiffness or friction
/// require other models.
pub(crate) fn other_equilibria(problem: &Problem, answer: &CableSolution, time_s: f64) -> Option<Histories> {
    let slides = problem.supports.iter().any(|s| s.kind == SupportKind::Pulley);
    if !slides || problem.supports.iter().any(|s| s.friction > 0.0) {
        return None;
    }
    let model = CatenaryModel::new(Arc::new(problem.clone()), Settings::default()).ok()?;
    let layout = model.layout(time_s).ok()?;
    let slides =
        |material_point: Option<f64>| if material_point.is_none() { PulleyMode::Slip(0.0) } else { PulleyMode::Stick };
    let modes: Vec<PulleyMode> = layout.anchors.iter().map(|a| slides(a.material_point)).collect();
    let from = |sigma: Vec<f64>| -> Option<Equilibrium> {
        let rest_points = sigma.clone();
        solve(
            problem,
            &layout,
            SlidingStart { rest_points: &rest_points, sigma, modes: modes.clone(), arcs: first_arcs(&layout) },
        )
        .ok()
    };
    let material = |a: &SupportNode| a.material_point.or(Some(answer.supports.get(a.support)?.arc_length_m));
    let shown = from(layout.anchors.iter().map(material).collect::<Option<_>>()?)?;
    let mut found = vec![shown];
    for start in starts(problem, &layout, &found[0].sigma) {
        let Some(other) = from(start).filter(|e| !e.runs_away) else { continue };
        let apart = |e: &Equilibrium| {
            e.sigma.iter().zip(&other.sigma).any(|(a, b)| (a - b).abs() > DIFFERENT_MATERIAL_FRACTION * problem.length)
        };
        if found.iter().all(apart) && model.refuse_contact(&layout, &report(problem, &layout, &other).0).is_ok() {
            found.push(other);
        }
    }
    let others: Vec<[f64; 3]> = found.iter().skip(1).map(|e| tensions(&report(problem, &layout, e).0)).collect();
    Histories::slack_elsewhere(tensions(&answer.nodes), &others)
}
