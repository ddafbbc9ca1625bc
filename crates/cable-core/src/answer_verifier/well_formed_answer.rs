//! This check finds whether an answer has finite numbers and nodes in order along the material;
//! without that the other laws cannot be checked.

use super::checked_cable::CheckedCable;
use super::tolerance::MATERIAL_TOLERANCE;
use crate::solution::{ContactReport, Node, SupportReaction};
use crate::verification_report::{Finding, Law, Verification};

/// The first number of an answer that is not finite, or the lack of nodes.
pub(super) fn not_finite(checked: &CheckedCable<'_>) -> Option<Finding> {
    // This form has no branch for each number.
    let all = |values: &[f64]| values.iter().fold(true, |all, v| all & v.is_finite());
    let node = |n: &Node| {
        all(&[n.arc_length_m, n.x_m, n.y_m, n.vx_m_per_s, n.vy_m_per_s, n.tension_n])
            && all(&[n.strain, n.stress_pa, n.curvature_per_m, n.force_n[0], n.force_n[1]])
    };
    let support = |s: &SupportReaction| {
        all(&[s.x_m, s.y_m, s.reaction_x_n, s.reaction_y_n, s.arc_length_m])
            && all(&[s.tension_before_n.unwrap_or(0.0), s.tension_after_n.unwrap_or(0.0)])
    };
    let contact = |c: &ContactReport| {
        all(&[c.x_m, c.y_m, c.arc_length_m, c.normal_n, c.friction_n, c.turn_deg, c.force_n[0], c.force_n[1]])
            && all(&[c.tension_before_n, c.tension_after_n, c.begins_m, c.ends_m])
    };
    let bad = |k: usize, with: &str| {
        let mut finding = checked.finding(Law::Finite, k, f64::INFINITY, 0.0);
        with.clone_into(&mut finding.with);
        finding
    };
    let a = checked.answer;
    if a.nodes.len() < 2 {
        return Some(bad(0, "nodes"));
    }
    if let Some(k) = a.nodes.iter().position(|n| !node(n)) {
        return Some(bad(k, ""));
    }
    if let Some(s) = a.supports.iter().find(|s| !support(s)) {
        return Some(bad(0, &s.name));
    }
    a.contacts.iter().find(|c| !contact(c)).map(|c| bad(0, &c.obstacle))
}

/// Returns whether the nodes are in order along the material; without that no other law can be
/// checked.
pub(super) fn check_material(checked: &CheckedCable<'_>, found: &mut Verification) -> bool {
    found.ask(Law::Material);
    let before = found.findings.len();
    let nodes = &checked.answer.nodes;
    let limit = MATERIAL_TOLERANCE * checked.cable.length_m;
    let first = nodes.first().map_or(f64::NAN, |n| n.arc_length_m.abs());
    let last = nodes.last().map_or(f64::NAN, |n| (n.arc_length_m - checked.cable.length_m).abs());
    for (node, value) in [(0, first), (nodes.len() - 1, last)] {
        if !(value <= limit) {
            found.report(checked.finding(Law::Material, node, value, limit));
        }
    }
    for (k, pair) in nodes.windows(2).enumerate() {
        let back = pair[0].arc_length_m - pair[1].arc_length_m;
        if !(back <= limit) {
            found.report(checked.finding(Law::Material, k + 1, back, limit));
        }
    }
    found.findings.len() == before
}
