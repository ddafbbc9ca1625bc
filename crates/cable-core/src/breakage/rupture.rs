//! A rupture is the place and the instant at which the tension first reaches the breaking tension.
//!
//! Tension is taken as linear in time between the instants and linear along the cable between
//! nodes: the first place to reach the breaking tension T_b is then a node, at the fraction f =
//! (T_b − T₀)/(T₁ − T₀) of the step.

use crate::math::Vec2;
use crate::solution::Node;
use crate::state::State;

/// Distance from the end of a part within which a node is its end, as a fraction of the part:
/// round-off. Smaller: two nodes at one place; larger: near nodes are lost.
const END_DISTANCE_FRACTION: f64 = 1e-9;

/// Place of a rupture, and its time within the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rupture {
    /// Index of the node of the later instant.
    pub node: usize,
    /// Fraction of the step, 0 to 1.
    pub fraction: f64,
}

/// The first rupture between two instants, if there is one. Nodes that `watched` refuses are left
/// out; of nodes that reach the limit at the same time the one that goes furthest beyond it breaks,
/// of equals the first.
pub(crate) fn first(
    before: &[Node],
    after: &[Node],
    breaking_n: f64,
    watched: impl Fn(f64) -> bool,
) -> Option<Rupture> {
    let mut best: Option<(Rupture, f64)> = None;
    for (node, n) in after.iter().enumerate() {
        let reached = n.tension_n;
        if !(reached >= breaking_n && watched(n.arc_length_m)) {
            continue;
        }
        let had = tension_at(before, n.arc_length_m);
        let fraction = if had < breaking_n { (breaking_n - had) / (reached - had) } else { 0.0 };
        if best.is_none_or(|(b, t)| fraction < b.fraction || (fraction == b.fraction && reached > t)) {
            best = Some((Rupture { node, fraction }, reached));
        }
    }
    best.map(|(rupture, _)| rupture)
}

/// The node nearest to an arc length (m).
pub(crate) fn nearest(nodes: &[Node], s: f64) -> usize {
    let k = nodes.partition_point(|n| n.arc_length_m < s);
    let off = |k: usize| nodes.get(k).map_or(f64::INFINITY, |n| (n.arc_length_m - s).abs());
    k.checked_sub(1).filter(|&before| off(before) < off(k)).unwrap_or(k)
}

/// The greatest tension, N: not a number if one is not.
pub(crate) fn greatest(nodes: &[Node]) -> f64 {
    nodes.iter().map(|n| n.tension_n).fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
}

/// Tension at an arc length, N, linear between nodes; 0 where nothing is known.
fn tension_at(nodes: &[Node], s: f64) -> f64 {
    let k = nodes.partition_point(|n| n.arc_length_m <= s);
    match (k.checked_sub(1).and_then(|i| nodes.get(i)), nodes.get(k)) {
        (Some(a), Some(b)) => {
            a.tension_n + (b.tension_n - a.tension_n) * (s - a.arc_length_m) / (b.arc_length_m - a.arc_length_m)
        }
        (Some(n), None) | (None, Some(n)) => n.tension_n,
        (None, None) => 0.0,
    }
}

/// The state at a fraction of the way between two instants. On different meshes it is the later
/// one: resampled, chords would cut corners, and a stiff cable would feel it as slack.
pub(crate) fn between(before: &State, after: &State, fraction: f64) -> State {
    let mut state = after.clone();
    state.time_s = before.time_s + (after.time_s - before.time_s) * fraction;
    let same = before.arc_length_m == after.arc_length_m && before.velocity_m_per_s.len() == before.position_m.len();
    if same {
        let mix = |a: &[Vec2], b: &mut [Vec2]| {
            for (a, b) in a.iter().zip(b) {
                *b = a + (*b - a) * fraction;
            }
        };
        mix(&before.position_m, &mut state.position_m);
        mix(&before.velocity_m_per_s, &mut state.velocity_m_per_s);
    }
    state
}

/// The part of a state between two arc lengths (m), with nodes at both; its arc lengths start at 0.
pub(crate) fn section(state: &State, from: f64, to: f64) -> State {
    let near = END_DISTANCE_FRACTION * (to - from);
    let inside = |s: f64| s > from + near && s < to - near;
    let mut out = State { time_s: state.time_s, ..State::default() };
    let mut push = |s: f64, x: Option<Vec2>, v: Option<Vec2>| {
        out.arc_length_m.push(s - from);
        out.position_m.push(x.unwrap_or_default());
        out.velocity_m_per_s.push(v.unwrap_or_default());
    };
    push(from, state.position_at(from), state.velocity_at(from));
    for (k, &s) in state.arc_length_m.iter().enumerate().filter(|(_, s)| inside(**s)) {
        push(s, state.position_m.get(k).copied(), state.velocity_m_per_s.get(k).copied());
    }
    push(to, state.position_at(to), state.velocity_at(to));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_in_between_is_linear_in_places_and_speeds() {
        let at = |time_s: f64, x: f64| State {
            time_s,
            arc_length_m: vec![0.0, 1.0],
            position_m: vec![Vec2::zeros(), Vec2::x() * x],
            velocity_m_per_s: vec![Vec2::zeros(), Vec2::y() * x],
            in_motion: false,
        };
        let mid = between(&at(1.0, 2.0), &at(3.0, 6.0), 0.25);
        assert_eq!(mid, at(1.5, 3.0));
        // On another mesh it is the later one, at the time of the break.
        let mut other = at(1.0, 2.0);
        other.arc_length_m[1] = 0.9;
        assert_eq!(between(&other, &at(3.0, 6.0), 0.25), at(1.5, 6.0));
    }
}
