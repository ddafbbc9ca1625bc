//! Nodes are placed evenly between supports and loads, along the route of the scene.

use crate::math::Vec2;
use crate::model::mass_spring::mesh::pulley::Pulley;
use crate::model::mass_spring::settings::MeshTuning;
use crate::problem::Problem;
use crate::state::State;

/// Points of the cable nearer to each other than this part of its length are one.
pub(super) const SAME_PLACE_FRACTION: f64 = 1e-9;

/// Arc lengths (m) of nodes with about `segments` elements on the whole cable, evenly between
/// supports (at `separated`, m) and loads.
pub(super) fn even_nodes(problem: &Problem, segments: usize, separated: &[f64]) -> Vec<f64> {
    let close = SAME_PLACE_FRACTION * problem.length;
    let at_pulleys: Vec<f64> = Pulley::all(problem).iter().map(|p| separated[p.support]).collect();
    let mut marks: Vec<f64> = problem.supports.iter().filter_map(|s| s.arc_length).collect();
    marks.extend(&at_pulleys);
    marks.extend(problem.loads.iter().map(|l| l.arc_length));
    marks.extend([0.0, problem.length]);
    marks.sort_by(f64::total_cmp);
    marks.dedup_by(|b, a| (*b - *a).abs() <= close);
    let is_pulley = |m: f64| at_pulleys.iter().any(|s| (s - m).abs() <= close);
    let mut nodes = vec![0.0];
    for w in marks.windows(2) {
        // Beside a pulley there is always a node that moves.
        let least = if is_pulley(w[0]) || is_pulley(w[1]) { 2.0 } else { 1.0 };
        let count = ((w[1] - w[0]) / problem.length * segments as f64).round().max(least);
        nodes.extend((1..=count as usize).map(|k| w[0] + (w[1] - w[0]) * k as f64 / count));
    }
    nodes
}

/// Arc length of each support (m): as the scene gives it; for supports that slide as `wanted`, but
/// apart from what they could run onto by a part of an even element, or by their share of the room.
/// Material lies on both sides of a pulley, however near to a support it stands.
pub(super) fn separate_supports(p: &Problem, tuning: &MeshTuning, wanted: &[f64], segments: usize) -> Vec<f64> {
    let least = tuning.min_spacing_lengths * p.length / segments as f64;
    let mut out: Vec<f64> = (0..p.supports.len())
        .map(|k| p.supports[k].arc_length.or(wanted.get(k).copied()).unwrap_or(f64::NAN))
        .collect();
    let slides: Vec<bool> = p.supports.iter().map(|s| s.arc_length.is_none()).collect();
    let mut k = 0;
    while k < out.len() {
        let count = slides[k..].iter().take_while(|s| **s).count();
        let low = if k > 0 { out[k - 1] } else { 0.0 };
        let high = out.get(k + count).copied().unwrap_or(p.length);
        let room = least.min(0.5 * (high - low) / (count + 1) as f64);
        for i in 0..count {
            let (floor, ceiling) = (low + room * (i + 1) as f64, high - room * (count - i) as f64);
            let floor = if i > 0 { floor.max(out[k + i - 1] + room) } else { floor };
            let even = low + (high - low) * (i + 1) as f64 / (count + 1) as f64;
            let here = if out[k + i].is_finite() { out[k + i] } else { even };
            out[k + i] = here.min(ceiling).max(floor);
        }
        k += count + 1;
    }
    out
}

/// Arc lengths of the supports before anything is known, m: material is even along the straight
/// path between those whose arc length is given; a hanging end gets what the path leaves.
pub(in crate::model::mass_spring) fn first_support_arc_lengths(p: &Problem, tuning: &MeshTuning) -> Vec<f64> {
    let count = p.supports.len();
    let mut path = vec![0.0; count];
    let mut last: Option<Vec2> = None;
    for k in 0..count {
        path[k] = if k > 0 { path[k - 1] } else { 0.0 };
        if let Some((at, _)) = p.supports[k].position_at(0.0) {
            path[k] += last.map_or(0.0, |l| (at - l).norm());
            last = Some(at);
        }
    }
    let known = |k: usize| p.supports[k].arc_length.filter(|_| p.supports[k].at.is_some());
    let whole = path.last().copied().unwrap_or(0.0);
    let scale_into = |room: f64, path: f64| {
        if path < tuning.max_path_fraction * room { 1.0 } else { tuning.max_path_fraction * room / path }
    };
    (0..count)
        .map(|k| {
            if let Some(s) = p.supports[k].arc_length {
                return s;
            }
            let before = (0..k).rev().find_map(|j| known(j).map(|s| (path[j], s)));
            let after = (k + 1..count).find_map(|j| known(j).map(|s| (path[j], s)));
            match (before, after) {
                (Some((wa, sa)), Some((wb, sb))) if wb > wa => sa + (sb - sa) * (path[k] - wa) / (wb - wa),
                (Some((wa, sa)), _) => sa + (path[k] - wa) * scale_into(p.length - sa, whole - wa),
                (None, Some((wb, sb))) => sb - (wb - path[k]) * scale_into(sb, wb),
                (None, None) => {
                    let scale = scale_into(p.length, whole);
                    0.5 * (p.length - whole * scale) + path[k] * scale
                }
            }
        })
        .collect()
}

/// Along the route, material spread evenly; without one, straight from support to support. A free
/// end goes on in the direction of gravity.
pub(super) fn first_shape(p: &Problem, s: &[f64], support_node: &[usize]) -> Vec<Vec2> {
    if p.route.len() >= 2 {
        let mut along = vec![0.0];
        for w in p.route.windows(2) {
            along.push(along[along.len() - 1] + (w[1] - w[0]).norm());
        }
        let scale = along[along.len() - 1] / p.length;
        let route = State { arc_length_m: along, position_m: p.route.clone(), ..State::default() };
        return s.iter().map(|v| route.position_at(v * scale).unwrap_or_default()).collect();
    }
    let fixed: Vec<(f64, Vec2)> =
        p.supports.iter().zip(support_node).filter_map(|(u, &k)| u.at.map(|at| (s[k], at))).collect();
    let down = p.body_force(0.0).try_normalize(0.0).unwrap_or(Vec2::new(0.0, -1.0));
    s.iter()
        .map(|&v| {
            let k = fixed.partition_point(|h| h.0 < v);
            match (k.checked_sub(1).and_then(|i| fixed.get(i)), fixed.get(k)) {
                (Some(a), Some(b)) => a.1 + (b.1 - a.1) * ((v - a.0) / (b.0 - a.0)),
                (Some(a), None) => a.1 + down * (v - a.0),
                (None, Some(b)) => b.1 + down * (b.0 - v),
                (None, None) => down * v,
            }
        })
        .collect()
}
