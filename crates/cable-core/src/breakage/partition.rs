//! A partition says which stretch, supports and loads of a broken cable belong to which piece.

use crate::math::Vec2;
use crate::problem::{Departure, Problem, SupportPoint, TimeSeries};
use crate::scene::{PulleySide, SupportKind};
use crate::state::State;

/// The stretch of the whole cable that a piece is, and what hangs on it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CablePart {
    /// Arc length of the whole cable at its start, m.
    pub from: f64,
    /// Arc length of the whole cable at its end, m.
    pub to: f64,
    /// Supports in order along it, as indices in the scene; the first and last are its ends, None
    /// where it broke.
    pub supports: Vec<Option<usize>>,
    /// Indices of the point loads on it.
    pub loads: Vec<usize>,
}

/// A place to cut at, and what is known of the cable there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut<'a> {
    /// Its place, m on the whole cable.
    pub at: f64,
    /// Supports and loads as near as this (m) sit at the cut.
    pub near: f64,
    /// The cable gives way on the side of greater arc length of what sits at the cut.
    pub after: bool,
    /// Present place of each support of the scene, m on the whole cable.
    pub support_arc_lengths: &'a [f64],
    /// For each support of the scene whether it is a wheel that the cable hangs clear of.
    pub cleared_wheels: &'a [bool],
}

impl CablePart {
    /// The whole cable.
    pub fn whole(problem: &Problem) -> Self {
        Self {
            from: 0.0,
            to: problem.length,
            supports: (0..problem.supports.len()).map(Some).collect(),
            loads: (0..problem.loads.len()).collect(),
        }
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.to - self.from
    }

    /// The pieces this one breaks into: two, or itself torn off what held its end.
    pub fn cut(&self, problem: &Problem, cut: &Cut<'_>) -> Vec<Self> {
        if cut.at - self.from <= cut.near {
            return vec![self.detached(0, problem, cut)];
        }
        if self.to - cut.at <= cut.near {
            return vec![self.detached(self.supports.len() - 1, problem, cut)];
        }
        // A support or load at the cut stays with the side that does not give way.
        let before = |s: f64| s < cut.at - cut.near || (s <= cut.at + cut.near && cut.after);
        let last = self.supports.len() - 1;
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for (i, &k) in self.supports.iter().enumerate() {
            let Some(k) = k else { continue };
            let s = cut.support_arc_lengths.get(k).copied().unwrap_or(self.from);
            let pulley = problem.supports.get(k).is_some_and(|p| p.kind == SupportKind::Pulley);
            let cleared = cut.cleared_wheels.get(k).copied().unwrap_or(false);
            if pulley && (cleared || (s - cut.at).abs() <= cut.near) {
                continue; // it would slip off at once, or leads no piece
            }
            if i == 0 || (i < last && before(s)) { left.push(Some(k)) } else { right.push(Some(k)) }
        }
        if self.supports.first() == Some(&None) {
            left.insert(0, None);
        }
        if self.supports.last() == Some(&None) {
            right.push(None);
        }
        // A support that stays at the new end is that end.
        let at_cut = |k: Option<usize>| {
            k.and_then(|k| cut.support_arc_lengths.get(k)).is_some_and(|s| (s - cut.at).abs() <= cut.near)
        };
        if !(left.len() > 1 && at_cut(left[left.len() - 1])) {
            left.push(None);
        }
        if !(right.len() > 1 && at_cut(right[0])) {
            right.insert(0, None);
        }
        let (first, second) =
            self.loads.iter().partition(|&&l| before(problem.loads.get(l).map_or(0.0, |l| l.arc_length)));
        vec![
            Self { from: self.from, to: cut.at, supports: left, loads: first },
            Self { from: cut.at, to: self.to, supports: right, loads: second },
        ]
    }

    /// The support at the end where a cut tears the piece off, if there is one.
    pub fn support_at_end(&self, cut: &Cut<'_>) -> Option<usize> {
        let end = if cut.at - self.from <= cut.near { self.supports.first() } else { self.supports.last() };
        end.copied().flatten()
    }

    /// A copy whose end (0 or 1) no support holds; loads at the cut are dropped.
    fn detached(&self, end: usize, problem: &Problem, cut: &Cut<'_>) -> Self {
        let mut part = self.clone();
        if let Some(s) = part.supports.get_mut(end) {
            *s = None;
        }
        let at = if end == 0 { self.from } else { self.to };
        part.loads.retain(|&l| problem.loads.get(l).is_some_and(|l| (l.arc_length - at).abs() > cut.near));
        part
    }

    /// The same without a support that the cable has slipped off.
    pub fn without(&self, support: usize) -> Self {
        let mut part = self.clone();
        part.supports.retain(|s| *s != Some(support));
        part
    }

    /// The piece as a problem of its own: arc lengths from its start, its first route where it lies
    /// in `state` (whose arc lengths are the piece's own), as many elements as it had.
    pub fn problem(&self, whole: &Problem, state: &State) -> Problem {
        let length = self.length();
        let elements = state.arc_length_m.len().saturating_sub(1).max(MIN_ELEMENTS);
        let last = self.supports.len().saturating_sub(1);
        let mut supports = Vec::with_capacity(self.supports.len());
        for (i, &k) in self.supports.iter().enumerate() {
            let end = if i == 0 { Some(0.0) } else { (i == last).then_some(length) };
            let mut s = k.and_then(|k| whole.supports.get(k)).cloned().unwrap_or_else(free_end);
            s.arc_length = end.or(s.arc_length.map(|a| a - self.from));
            // Only whole cables go on past wheels that they have left.
            s.departure = Departure::Never;
            supports.push(s);
        }
        let mut loads: Vec<_> = self.loads.iter().filter_map(|&l| whole.loads.get(l)).cloned().collect();
        for l in &mut loads {
            l.arc_length = (l.arc_length - self.from).clamp(0.0, length);
        }
        let mut cable = whole.cable.clone();
        cable.length_m = length;
        cable.segments = Some(elements);
        Problem { length, supports, loads, route: route(state), cable, similar: None, wheels: None, ..whole.clone() }
    }
}

/// A piece has at least so many elements: the tension of its ends is read from the next node.
const MIN_ELEMENTS: usize = 2;

/// The way it lies, without points on each other.
fn route(state: &State) -> Vec<Vec2> {
    let mut points = state.position_m.clone();
    points.dedup_by(|a, b| a == b);
    points
}

fn free_end() -> SupportPoint {
    SupportPoint {
        name: String::new(),
        kind: SupportKind::Free,
        arc_length: None,
        at: None,
        motion: None,
        angle: None,
        wheel_radius: 0.0,
        side: PulleySide::Over,
        friction: 0.0,
        force: TimeSeries::default(),
        mass: 0.0,
        release: None,
        departure: Departure::Never,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Load, Support, catalog};

    /// A cable of 10 m with a load at each end of it, in its middle, and at its middle support.
    fn loaded() -> Problem {
        let mid = Support { arc_length_m: Some(6.0), ..Support::fixed("mid", [6.0, 0.0]) };
        let ends = [Support::fixed("a", [0.0, 0.0]), mid, Support::fixed("b", [9.9, 0.0])];
        let mut scene = catalog::cable_alone([10.0, 1.0, 1e5], ends.into());
        scene.cables[0].damping_ratio = 0.01;
        let load = |arc_length_m: f64| Load {
            cable: scene.cables[0].name.clone(),
            arc_length_m,
            force_n: Some([0.0, -1.0]),
            times_s: Vec::new(),
            forces_n: Vec::new(),
        };
        scene.loads = [0.0, 3.0, 6.0, 10.0].map(load).into();
        (*crate::problem::problems(&scene).unwrap()[0]).clone()
    }

    /// The part that keeps what sits at the cut: the cable breaks after it or before it.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum HeldSide {
        Before,
        After,
    }

    fn cut(problem: &Problem, at: f64, side: HeldSide) -> Vec<CablePart> {
        let after = side == HeldSide::Before;
        CablePart::whole(problem)
            .cut(problem, &Cut { at, near: 0.1, after, support_arc_lengths: &[0.0, 6.0, 10.0], cleared_wheels: &[] })
    }

    #[test]
    fn what_sits_at_the_cut_stays_with_the_side_that_holds() {
        let p = loaded();
        for (side, loads, supports) in [
            (HeldSide::Before, [vec![0, 1, 2], vec![3]], [vec![Some(0), Some(1)], vec![None, Some(2)]]),
            (HeldSide::After, [vec![0, 1], vec![2, 3]], [vec![Some(0), None], vec![Some(1), Some(2)]]),
        ] {
            let pieces = cut(&p, 6.05, side);
            assert_eq!([pieces[0].loads.clone(), pieces[1].loads.clone()], loads, "{side:?}");
            assert_eq!([pieces[0].supports.clone(), pieces[1].supports.clone()], supports, "{side:?}");
            assert_eq!((pieces[0].to, pieces[1].from), (6.05, 6.05));
        }
    }

    #[test]
    fn a_cable_torn_off_loses_what_hung_there() {
        let p = loaded();
        let [start] = &cut(&p, 0.05, HeldSide::Before)[..] else { panic!("torn off the start") };
        assert_eq!((start.supports[0], &start.loads[..]), (None, &[1, 2, 3][..]));
        let [end] = &cut(&p, 9.95, HeldSide::Before)[..] else { panic!("torn off the end") };
        assert_eq!((end.supports[2], &end.loads[..]), (None, &[0, 1, 2][..]));
    }

    /// τ = 2ζ/ω₁ with ω₁ = πc/L: a part of the cable has a faster first mode of its own, and the
    /// same τ and ζ.
    #[test]
    fn a_piece_is_of_the_same_material() {
        let p = loaded();
        let state = State {
            arc_length_m: vec![0.0, 1.0, 2.0],
            position_m: vec![Vec2::zeros(), Vec2::x(), Vec2::x() * 2.0],
            velocity_m_per_s: vec![Vec2::zeros(); 3],
            time_s: 0.0,
            in_motion: false,
        };
        let piece = &cut(&p, 2.0, HeldSide::Before)[0];
        let own = piece.problem(&p, &state);
        assert_eq!((own.length, own.cable.segments), (2.0, Some(2)));
        assert_eq!((own.cable.damping_ratio, own.damped_length), (p.cable.damping_ratio, p.length));
    }
}
