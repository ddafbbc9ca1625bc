//! This check finds parts of a cable inside an obstacle or inside the cable itself.

use super::checked_cable::CheckedCable;
use super::surroundings::{Neighbours, distance};
use super::tolerance::{DEPTH_DIAMETERS, DEPTH_LENGTHS, DEPTH_M, MATERIAL_TOLERANCE};
use crate::math::{larger, smaller};
use crate::verification_report::{Law, Verification};

/// Checks that neither nodes nor the bars between them are deeper in an obstacle than allowed.
pub(super) fn check_penetration(checked: &CheckedCable<'_>, found: &mut Verification, near: &Neighbours) {
    found.ask(Law::Penetration);
    let radius = 0.5 * checked.cable.diameter_m;
    let to_scale = larger(DEPTH_M, DEPTH_LENGTHS * checked.cable.length_m);
    let allowed = (DEPTH_DIAMETERS * checked.cable.diameter_m).min(to_scale);
    let nodes = &checked.answer.nodes;
    // If the scene itself holds the axis on a surface, the cable is as deep there as its radius.
    let support_places = checked.support_places();
    let on_surface = MATERIAL_TOLERANCE * checked.cable.length_m;
    for (k, n) in nodes.iter().enumerate() {
        // After a bar without near obstacles the depth is that of the node before.
        if k > 0 && near.of(k - 1).is_empty() {
            continue;
        }
        if let Some((body, depth)) = checked.surroundings.inside(n.at()) {
            if depth <= on_surface && support_places.contains(&n.at()) {
                continue;
            }
            let mut finding = checked.finding(Law::Penetration, k, depth + radius, allowed);
            checked.surroundings.name(body).clone_into(&mut finding.with);
            found.report(finding);
        }
    }
    // There is no cable between the pieces of a broken one.
    let is_cable = |k: usize| !near.of(k).is_empty() && !checked.answer.breaks.contains(&(k + 1));
    for k in (0..nodes.len() - 1).filter(|k| is_cable(*k)) {
        // Between two nodes a round cable is drawn straight.
        let pair = &nodes[k..=k + 1];
        let way = (pair[1].at() - pair[0].at()).norm();
        let bend = pair.iter().map(|n| n.curvature_per_m.abs()).fold(0.0, larger);
        let sagitta = smaller(bend * way * way / 8.0, DEPTH_LENGTHS * checked.cable.length_m);
        for n in near.of(k) {
            let value = radius - n.distance;
            let end = n.at == pair[0].at() || n.at == pair[1].at();
            let given = if support_places.contains(&n.at) { radius } else { 0.0 };
            let limit = allowed + given + if end { 0.0 } else { sagitta };
            if !(value <= limit) {
                let mut finding = checked.finding(Law::Penetration, k, value, limit);
                checked.surroundings.name(n.body).clone_into(&mut finding.with);
                finding.at_m = n.at.into();
                found.report(finding);
            }
        }
    }
}

/// Checks every bar against every other that is farther along the cable than its thickness.
pub(super) fn check_self_contact(checked: &CheckedCable<'_>, found: &mut Verification) {
    found.ask(Law::SelfContact);
    let nodes = &checked.answer.nodes;
    let thick = checked.cable.diameter_m;
    let limit = (DEPTH_DIAMETERS * thick).min(DEPTH_M);
    let edge = |k: usize| (nodes[k].at(), nodes[k + 1].at());
    for i in 0..nodes.len() - 1 {
        for j in i + 1..nodes.len() - 1 {
            let apart = nodes[j].arc_length_m - nodes[i + 1].arc_length_m;
            if apart < 2.0 * std::f64::consts::PI * thick {
                continue;
            }
            let ((a, b), (c, d)) = (edge(i), edge(j));
            let value = thick - distance(a, b, c, d);
            if !(value <= limit) {
                found.report(checked.finding(Law::SelfContact, i, value, limit));
            }
        }
    }
}
