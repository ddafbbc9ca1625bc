//! This module finds tensions along stretches, and the spans over concave kinks where the cable has
//! tension.
//!
//! On slopes steeper than the friction cone the cable pulls on the cable above it, through every
//! kink between. With slopes m₁ and m₂ of the edges on either side and H the force across the load,
//! a span leaves one edge and meets the other along its tangent:
//!
//! ```text
//! bσ = H (m₂ − m₁),   u = τ (Hσ/EA + H (asinh m₂ − asinh m₁)/b),   v = τ ((T₂ − T₁)/b + H² (m₂² − m₁²)/2bEA)
//! x₁ t₁ + x₂ t₂ = (u, v),   T₁(x₁) = H √(1 + m₁²)
//! ```
//!
//! with x₁ and x₂ the lengths of the edges that it does not touch and T₁(x₁) the tension along the
//! first. This is one equation for H.
//!
//! At a wall the span leaves the lying cable at the foot and meets the round above. The point where
//! it leaves determines T₁, H and the whole catenary; the right point is the one whose catenary is
//! tangent to the round.

use crate::math::{Vec2, cross, larger};
use crate::model::spans::boundary::{LyingStretch, SlackForm, SlackPart};
use crate::model::spans::slack::slack_parts::{HALVINGS, LooseShapes, STRAIGHT_TURN, SlackSolver};
use crate::numerics::bisect;

/// Maximum number of doublings of the force across the load in the search for an upper bound.
const MAX_FORCE_DOUBLINGS: usize = 60;

/// Distance from a round within which a span touches it, as a fraction of its radius. Larger: a
/// jump of the distance could pass for a root. Smaller: if tension hardly changes along the ground,
/// the round-off of p leaves more.
const TANGENCY_FRACTION: f64 = 1e-3;

/// A span from one stretch to the next, in the direction from which its tension is computed.
#[derive(Clone, Copy, Debug)]
struct DirectedSpan {
    /// Coordinates at which it leaves one stretch and meets the other.
    coordinates: [f64; 2],
    /// Tensions where it leaves and where it meets, N.
    tension: [f64; 2],
    material: f64,
}

/// The tensions along stretches, computed from one end.
pub(super) struct StretchTensions {
    /// Stretches, shortened by the spans over kinks.
    pub stretches: Vec<LyingStretch>,
    /// Tension where each is entered, N.
    pub enters: Vec<f64>,
    /// The span that begins after each stretch along the cable, and the index of the stretch at
    /// which it ends.
    pub spans: Vec<Option<(SlackPart, usize)>>,
    /// Tension where the last one is left, N.
    pub leaves: f64,
}

impl SlackSolver<'_> {
    /// The least tensions that friction allows along stretches, from a tension (N) at their start
    /// (side 0) or end; `walls` is the material of the plumb leg after each along the cable, m.
    /// None if a kink cannot be bridged.
    pub(super) fn profile(
        &self,
        stretches: &[LyingStretch],
        walls: &[Option<f64>],
        side: usize,
        begins: f64,
    ) -> Option<StretchTensions> {
        let n = stretches.len();
        let tensions = StretchTensions {
            stretches: stretches.to_vec(),
            enters: vec![0.0; n],
            spans: vec![None; n],
            leaves: begins,
        };
        let mut sweep = TensionSweep { solver: self, whole_stretches: stretches, walls, side, tensions };
        for i in 0..n {
            let k = if side == 0 { i } else { n - 1 - i };
            sweep.slide_along(k)?;
            sweep.cross_gap(k)?;
        }
        Some(sweep.tensions)
    }

    /// The least tension (N) that friction allows at p of a stretch that is entered on a side with
    /// the tension `enters`.
    fn least(&self, s: &LyingStretch, side: usize, enters: f64, p: f64) -> f64 {
        let friction = s.friction(self.context);
        let against = if side == 0 { -friction } else { friction };
        larger(s.slide(self.context, s.coordinates[side], p, enters, against).tension, 0.0)
    }

    /// True if a cable under tension would bridge the gap between two stretches.
    pub(super) fn bends_in(&self, a: &LyingStretch, b: &LyingStretch) -> bool {
        let [before, after] = [a.place(self.context, a.coordinates[1]), b.place(self.context, b.coordinates[0])];
        cross(before.tangent, after.tangent) * self.context.curves[a.curve].sense > STRAIGHT_TURN
    }

    /// The span from one edge to the next, from the tension at each p of the first; `way` is 1
    /// along the cable and −1 against it. None if it does not leave and meet them.
    fn span_between_edges(
        &self,
        [from, to]: [&LyingStretch; 2],
        way: f64,
        tension: &dyn Fn(f64) -> f64,
    ) -> Option<DirectedSpan> {
        let end = usize::from(way > 0.0);
        let (kink, next) =
            (from.place(self.context, from.coordinates[end]), to.place(self.context, to.coordinates[1 - end]));
        if kink.turn != 0.0 || next.turn != 0.0 {
            return None;
        }
        let sight = SpanFrame::new(self, kink.tangent * way)?;
        let t = [kink.tangent, next.tangent].map(|t| sight.split(t * way));
        let det = cross(t[0], t[1]);
        if !(t[1].x > 0.0 && det > 0.0) {
            return None;
        }
        let [m1, m2] = t.map(|t| t.y / t.x);
        let aside = |h: f64| {
            let (material, d) = sight.catenary(h, m1, m2);
            ([(d.x * t[1].y - d.y * t[1].x) / det, (t[0].x * d.y - t[0].y * d.x) / det], material)
        };
        let room = |s: &LyingStretch| s.coordinates[1] - s.coordinates[0];
        // Beyond the edge the tension is that at its start.
        let comes = |x: f64| tension(from.coordinates[end] - way * if x < room(from) { x } else { room(from) });
        let lacks = |h: f64| h * 1.0f64.hypot(m1) < comes(aside(h).0[0]);
        let (mut low, mut high) = (0.0, tension(from.coordinates[end]));
        for _ in 0..MAX_FORCE_DOUBLINGS {
            if !lacks(high) {
                break;
            }
            (low, high) = (high, 2.0 * high);
        }
        let [low, high] = bisect([low, high], HALVINGS, lacks);
        let h = 0.5 * (low + high);
        let ([x1, x2], material) = aside(h);
        let p = [from.coordinates[end] - way * x1, to.coordinates[1 - end] + way * x2];
        let tension = [m1, m2].map(|m| h * 1.0f64.hypot(m));
        (x1 < room(from) && x2 < room(to)).then_some(DirectedSpan { coordinates: p, tension, material })
    }

    /// The span from a stretch at the foot of a wall up to the round above it, from the tension at
    /// each p of the first. Some(None) if it leaves from before that stretch.
    fn climb(
        &self,
        [from, to]: [&LyingStretch; 2],
        way: f64,
        tension: &dyn Fn(f64) -> f64,
    ) -> Option<Option<DirectedSpan>> {
        let end = usize::from(way > 0.0);
        let above = to.place(self.context, to.coordinates[1 - end]);
        if above.turn == 0.0 {
            return None;
        }
        let radius = above.stretch;
        let foot = from.place(self.context, from.coordinates[end]);
        let sight = SpanFrame::new(self, foot.tangent * way)?;
        let center = sight.split(above.at - above.normal * radius);
        // The catenary from p: its force across the load, its slopes at both ends, its material,
        // and its distance from the round.
        let seen = |p: f64| {
            let place = from.place(self.context, p);
            let t = sight.split(place.tangent * way);
            let begins = sight.split(place.at);
            let (h, m1) = (tension(p) * t.x, t.y / t.x);
            let at = |angle: f64| begins + sight.catenary(h, m1, angle.tan()).1 - center;
            let [low, _] = bisect([m1.atan(), std::f64::consts::FRAC_PI_2], HALVINGS, |angle| {
                let (sin, cos) = angle.sin_cos();
                at(angle).dot(&Vec2::new(cos, sin)) < 0.0
            });
            // The round's centre is on its right: beyond it the span would be in the wall.
            let (sin, cos) = low.sin_cos();
            (h, [m1, low.tan()], cross(Vec2::new(cos, sin), at(low)) - radius)
        };
        // From the foot the span leads into the wall; from a place without tension it leads plumb
        // up beside it.
        let [_, near] = bisect([from.coordinates[1 - end], from.coordinates[end]], HALVINGS, |p| {
            !(tension(p) > 0.0) || seen(p).2 > 0.0
        });
        if tension(from.coordinates[1 - end]) > 0.0 && !(seen(from.coordinates[1 - end]).2 > 0.0) {
            return Some(None);
        }
        let (h, [m1, m2], off) = seen(near);
        if !(off.abs() <= TANGENCY_FRACTION * radius && h > 0.0) {
            return None;
        }
        let (material, _) = sight.catenary(h, m1, m2);
        // The direction along the cable in which it meets the round.
        let meets = sight.back(Vec2::new(1.0, m2).normalize()) * way;
        let turned = cross(above.tangent, meets).atan2(above.tangent.dot(&meets));
        let p = to.coordinates[1 - end] + turned / above.turn;
        let inside = p >= to.coordinates[0] && p <= to.coordinates[1];
        inside.then_some(Some(DirectedSpan {
            coordinates: [near, p],
            tension: [m1, m2].map(|m| h * 1.0f64.hypot(m)),
            material,
        }))
    }
}

/// The computation of tensions along stretches from one end.
struct TensionSweep<'a> {
    solver: &'a SlackSolver<'a>,
    /// Stretches before spans over kinks shorten them.
    whole_stretches: &'a [LyingStretch],
    walls: &'a [Option<f64>],
    /// The end from which it goes: 0 for the start.
    side: usize,
    tensions: StretchTensions,
}

impl TensionSweep<'_> {
    /// Index of the gap beyond stretch k, which is that of the stretch before it along the cable.
    fn gap_beyond(&self, k: usize) -> usize {
        if self.side == 0 { k } else { k.wrapping_sub(1) }
    }

    /// Computes the tension where stretch k is left. None if it is in tension, and a shape without
    /// is sought.
    fn slide_along(&mut self, k: usize) -> Option<()> {
        let (s, enters) = (self.tensions.stretches[k], self.tensions.leaves);
        self.tensions.enters[k] = enters;
        self.tensions.leaves = self.solver.least(&s, self.side, enters, s.coordinates[1 - self.side]);
        let in_tension = self.tensions.leaves > self.solver.most;
        (self.solver.sought != LooseShapes::NoTension || !in_tension).then_some(())
    }

    /// Goes from stretch k to the next, over a kink or along a wall. None if no cable can.
    fn cross_gap(&mut self, k: usize) -> Option<()> {
        let (solver, side, gap) = (self.solver, self.side, self.gap_beyond(k));
        let stretch = |i: usize| self.tensions.stretches.get(i).copied();
        let (Some(a), Some(b)) = (stretch(gap), stretch(gap.wrapping_add(1))) else { return Some(()) };
        let ([from, to], way) = if side == 0 { ([&a, &b], 1.0) } else { ([&b, &a], -1.0) };
        let in_tension = self.tensions.leaves > solver.most;
        match self.walls.get(gap).copied().flatten() {
            Some(height) if in_tension && height * way > 0.0 => {
                let (left, span) = self.climb_wall(k, to, way)?;
                self.add_span(left, gap, &span);
            }
            Some(height) => {
                // It hangs plumb from the round; the tension at the foot is that at the round less
                // its weight.
                self.tensions.leaves =
                    larger(self.tensions.leaves + solver.context.law.load.norm() * height * way, 0.0);
                if self.tensions.leaves > solver.most {
                    return None;
                }
            }
            None if in_tension && solver.bends_in(&a, &b) => {
                let enters = self.tensions.enters[k];
                let span = solver.span_between_edges([from, to], way, &|p| solver.least(from, side, enters, p))?;
                self.add_span(k, gap, &span);
            }
            None => {}
        }
        Some(())
    }

    /// The span from stretch k up the wall beyond it, with the index of the stretch from which it
    /// leaves; spans over kinks that it passes are dropped.
    fn climb_wall(&mut self, k: usize, to: &LyingStretch, way: f64) -> Option<(usize, DirectedSpan)> {
        let (solver, side) = (self.solver, self.side);
        let mut left = k;
        loop {
            let enters_at = self.tensions.stretches[left].coordinates[side];
            let coordinates = bounds(side, enters_at, self.whole_stretches[left].coordinates[1 - side]);
            let from = LyingStretch { coordinates, ..self.whole_stretches[left] };
            let enters = self.tensions.enters[left];
            if let Some(span) = solver.climb([&from, to], way, &|p| solver.least(&from, side, enters, p))? {
                return Some((left, span));
            }
            // The span has to begin on an earlier stretch.
            left = if side == 0 { left.checked_sub(1)? } else { left + 1 };
            let between = self.gap_beyond(left);
            if left >= self.whole_stretches.len() || self.walls[between].is_some() {
                return None;
            }
            self.tensions.spans[between] = None;
        }
    }

    /// Adds a span from stretch `left` over a gap; the stretches end where it begins and ends.
    fn add_span(&mut self, left: usize, gap: usize, span: &DirectedSpan) {
        let side = self.side;
        let (before, after) = if side == 0 { (left, gap + 1) } else { (gap, left) };
        let [p, ends] = [span.coordinates, span.tension].map(|[x, y]| if side == 0 { [x, y] } else { [y, x] });
        let stretches = &mut self.tensions.stretches;
        (stretches[before].coordinates[1], stretches[after].coordinates[0]) = (p[0], p[1]);
        let place = stretches[before].place(self.solver.context, p[0]);
        let form = SlackForm::Spans { from: place.at, force: place.tangent * ends[0] };
        let part = SlackPart { arc_lengths: [0.0, span.material], tension: ends, form };
        self.tensions.spans[before] = Some((part, after));
        self.tensions.leaves = span.tension[1];
    }
}

/// The coordinates of a stretch in order of p, from those where it is entered and left.
fn bounds(side: usize, enters: f64, leaves: f64) -> [f64; 2] {
    if side == 0 { [enters, leaves] } else { [leaves, enters] }
}

/// The frame of a span, with its direction to the right and the load down.
struct SpanFrame<'a> {
    drape: &'a SlackSolver<'a>,
    /// 1 or −1.
    right: f64,
}

impl<'a> SpanFrame<'a> {
    /// The frame of a span that leaves in a direction; None if that is plumb.
    fn new(drape: &'a SlackSolver<'a>, leaves: Vec2) -> Option<Self> {
        let across = drape.frame.split(leaves).x;
        (across != 0.0).then(|| Self { drape, right: across.signum() })
    }

    /// A vector as its components to the right and against the load.
    fn split(&self, at: Vec2) -> Vec2 {
        let at = self.drape.frame.split(at);
        Vec2::new(at.x * self.right, at.y)
    }

    fn back(&self, at: Vec2) -> Vec2 {
        self.drape.frame.point(at.x * self.right, at.y)
    }

    /// Material of a catenary with the force h across the load from one slope to another, m, and
    /// its chord.
    fn catenary(&self, h: f64, m1: f64, m2: f64) -> (f64, Vec2) {
        let law = &self.drape.context.law;
        let b = law.load.norm();
        let (material, [t1, t2]) = (h * (m2 - m1) / b, [m1, m2].map(|m| h * 1.0f64.hypot(m)));
        let u = law.thermal * (h * material * law.compliance + h * (m2.asinh() - m1.asinh()) / b);
        let v = law.thermal * ((t2 - t1) / b + 0.5 * h * h * (m2 * m2 - m1 * m1) / b * law.compliance);
        (material, Vec2::new(u, v))
    }
}
