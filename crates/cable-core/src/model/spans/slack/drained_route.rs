//! A drained route is the shape of a route after it has fallen along the load on to obstacles.
//!
//! With enough cable, only obstacles below hold the cable up: each point of the route falls along
//! the load to the first boundary that faces it. It passes through nothing while falling, so the
//! result is on the same side of every obstacle as the route. The result is a sequence of two kinds
//! of legs: the cable *lies* along a boundary, or *hangs* plumb where the boundary below it ends
//! and the next one is lower or higher. If a leg returns over the one before it, both cancel.
//!
//! All coordinates are in the frame of the load: u across it, v against it.

use crate::contact::geometry::Body;
use crate::math::{Vec2, larger, smaller};
use crate::model::spans::slack::upper_surfaces::{LoadFrame, NONE_M, SurfaceShape, UpperSurfaces};

/// Maximum number of upper surfaces over which a cable that nothing holds slides down.
const MAX_SURFACES_DOWN: usize = 1000;

/// A leg of a drained route.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum RouteLeg {
    /// It hangs plumb, from one height to another.
    Hangs { u: f64, v: [f64; 2] },
    /// It lies on a surface, from one coordinate across the load to another.
    Lies { surface: usize, u: [f64; 2] },
}

impl RouteLeg {
    /// The reversed leg.
    fn back(&self) -> Self {
        match *self {
            Self::Hangs { u, v: [a, b] } => Self::Hangs { u, v: [b, a] },
            Self::Lies { surface, u: [a, b] } => Self::Lies { surface, u: [b, a] },
        }
    }
}

/// The legs of a drained route.
pub(in crate::model::spans) struct DrainedRoute {
    pub legs: Vec<RouteLeg>,
}

struct RouteDraining<'a> {
    surfaces: &'a UpperSurfaces,
    bodies: &'a [Body],
    frame: LoadFrame,
    legs: Vec<RouteLeg>,
    /// Height of its end so far.
    height: f64,
}

impl DrainedRoute {
    /// Drains a route; None if the cable falls off everything.
    pub fn new(surfaces: &UpperSurfaces, bodies: &[Body], frame: LoadFrame, route: &[Vec2]) -> Option<Self> {
        let points: Vec<Vec2> = route.iter().map(|p| frame.split(*p)).collect();
        let (first, last) = (points.first()?, points.last()?);
        let mut draining = RouteDraining { surfaces, bodies, frame, legs: Vec::new(), height: first.y };
        for pair in points.windows(2) {
            draining.fall(pair[0], pair[1])?;
        }
        draining.add_plumb_leg(last.x, last.y);
        if !draining.legs.iter().any(|leg| matches!(leg, RouteLeg::Lies { .. })) {
            // The ends are plumb above each other, or in one place: the route goes down to the
            // surface below both. Down and up do not cancel here, because the surplus lies there.
            (draining.height, draining.legs) = (first.y, Vec::new());
            draining.slide_down(first.x, smaller(first.y, last.y))?;
            let down = draining.legs.clone();
            draining.add_plumb_leg(last.x, last.y);
            // It goes up again over the surface on which it came down.
            let last_lying = down.iter().rposition(|leg| matches!(leg, RouteLeg::Lies { .. })).unwrap_or(0);
            let from = down.iter().position(|leg| matches!(leg, RouteLeg::Lies { .. })).unwrap_or(0);
            if last_lying > from {
                draining.legs.truncate(down.len());
                draining.legs.extend(down[from..last_lying].iter().rev().map(|leg| leg.back()));
                draining.height = draining.start_of(&down[from]);
                draining.add_plumb_leg_up(last.x, last.y);
            }
        }
        Some(Self { legs: draining.legs })
    }

    /// The route from a point plumb down.
    pub fn plumb_down(surfaces: &UpperSurfaces, bodies: &[Body], frame: LoadFrame, from: Vec2) -> Option<Self> {
        let at = frame.split(from);
        let mut draining = RouteDraining { surfaces, bodies, frame, legs: Vec::new(), height: at.y };
        draining.slide_down(at.x, at.y)?;
        Some(Self { legs: draining.legs })
    }

    /// The same route in the other direction.
    pub fn back(&self) -> Self {
        Self { legs: self.legs.iter().rev().map(RouteLeg::back).collect() }
    }

    /// Removes the plumb legs of ends that nothing holds: they fall on what is below them.
    pub fn drop_free_ends(&mut self, has_support: [bool; 2]) {
        let hangs = |leg: Option<&RouteLeg>| matches!(leg, Some(RouteLeg::Hangs { .. }));
        if !has_support[0] && hangs(self.legs.first()) {
            self.legs.remove(0);
        }
        if !has_support[1] && hangs(self.legs.last()) {
            self.legs.pop();
        }
    }
}

impl RouteDraining<'_> {
    /// Moves on to the first surface below a point, and down to where friction or a kink stops the
    /// cable; None if it falls off everything.
    fn slide_down(&mut self, u: f64, v: f64) -> Option<()> {
        let here = self.surfaces.over(u - NONE_M, u + NONE_M).filter_map(|k| {
            let surface = self.surfaces.all.get(k)?;
            let u = larger(surface.range[0], smaller(u, surface.range[1]));
            Some((k, u, surface.height(u))).filter(|f| f.2 <= v + NONE_M)
        });
        let (mut surface, on, height) = here.reduce(|a, b| if b.2 > a.2 { b } else { a })?;
        self.add_plumb_leg(u, height);
        self.height = height;
        let mut u = on;
        // Cable that does not stick there slides down, to the first place that holds it.
        for _ in 0..MAX_SURFACES_DOWN {
            let here = &self.surfaces.all[surface];
            let slope = here.slope(u);
            if slope.abs() <= here.friction {
                break;
            }
            let end = here.range[usize::from(slope < 0.0)];
            if (end - u).abs() > NONE_M {
                self.add_lying_leg(surface, [u, end]);
            }
            let beyond = end + if slope < 0.0 { 2.0 * NONE_M } else { -2.0 * NONE_M };
            let next = self.surfaces.over(beyond - NONE_M, beyond + NONE_M).filter_map(|k| {
                let other = self.surfaces.all.get(k)?;
                let on = larger(other.range[0], smaller(end, other.range[1]));
                Some((k, on, other.height(on))).filter(|f| f.2 <= self.height + NONE_M)
            });
            let (other, on, height) = next.reduce(|a, b| if b.2 > a.2 { b } else { a })?;
            self.add_plumb_leg(end, height);
            // In a kink it stays.
            let level = (self.height - height).abs() <= NONE_M;
            let rises = self.surfaces.all[other].slope(on) * slope < 0.0;
            (surface, u) = (other, on);
            if level && rises {
                break;
            }
        }
        self.legs.push(RouteLeg::Lies { surface, u: [u; 2] });
        Some(())
    }

    /// The height at which a leg begins.
    fn start_of(&self, leg: &RouteLeg) -> f64 {
        match *leg {
            RouteLeg::Hangs { v, .. } => v[0],
            RouteLeg::Lies { surface, u } => self.surfaces.all[surface].height(u[0]),
        }
    }

    /// Lets the stretch of the route between two points fall on the surfaces below it; None if
    /// there is none below a part of it.
    fn fall(&mut self, from: Vec2, to: Vec2) -> Option<()> {
        let (low, high) = (smaller(from.x, to.x), larger(from.x, to.x));
        if high - low <= NONE_M {
            return Some(());
        }
        let route = SurfaceShape::Line { from, slope: (to.y - from.y) / (to.x - from.x) };
        let over: Vec<usize> = self.surfaces.over(low, high).collect();
        let mut stops = vec![low, high];
        for k in &over {
            stops.extend(self.surfaces.all[*k].range.iter().filter(|u| **u > low && **u < high));
        }
        stops.sort_by(f64::total_cmp);
        let mut fallen: Vec<(usize, [f64; 2])> = Vec::new();
        let (mut next, mut active, mut at) = (0, Vec::new(), low);
        for stop in stops {
            if stop - at <= NONE_M {
                continue;
            }
            let middle = 0.5 * (at + stop);
            while next < over.len() && self.surfaces.all[over[next]].range[0] <= middle {
                active.push(over[next]);
                next += 1;
            }
            active.retain(|k| self.surfaces.all[*k].range[1] >= middle);
            self.between(at, stop, &active, &route, &mut fallen)?;
            at = stop;
        }
        if to.x < from.x {
            fallen.reverse();
        }
        for (surface, [a, b]) in fallen {
            let u = if to.x < from.x { [b, a] } else { [a, b] };
            self.add_plumb_leg(u[0], self.surfaces.all[surface].height(u[0]));
            self.add_lying_leg(surface, u);
        }
        Some(())
    }

    /// Appends the surfaces on which the route falls to `out`, with their ranges of u, on a stretch
    /// where the order of the surfaces does not change; None if there is none below a part of it.
    fn between(
        &self,
        low: f64,
        high: f64,
        active: &[usize],
        route: &SurfaceShape,
        out: &mut Vec<(usize, [f64; 2])>,
    ) -> Option<()> {
        let mut cuts = vec![low, high];
        for (k, a) in active.iter().enumerate() {
            let top = &self.surfaces.all[*a].top;
            let others = active[k + 1..].iter().map(|b| &self.surfaces.all[*b].top).chain([route]);
            cuts.extend(others.flat_map(|other| top.crossings(other)).filter(|u| *u > low && *u < high));
        }
        cuts.sort_by(f64::total_cmp);
        let mut at = low;
        for (k, cut) in cuts.iter().enumerate().skip(1) {
            // The last cut is never too near, because the whole stretch is not.
            if cut - at <= NONE_M && k + 1 < cuts.len() {
                continue;
            }
            let middle = 0.5 * (at + cut);
            let below = active.iter().copied().filter(|k| self.is_below(*k, middle, route.height(middle)));
            let high = |k: &usize| self.surfaces.all[*k].height(middle);
            let first = below.max_by(|a, b| high(a).total_cmp(&high(b)))?;
            out.push((first, [at, *cut]));
            at = *cut;
        }
        Some(())
    }

    /// True if the route passes above a surface; where it cuts into the body of the surface, true
    /// if it enters from above.
    fn is_below(&self, surface: usize, u: f64, v: f64) -> bool {
        let surface = &self.surfaces.all[surface];
        if surface.height(u) <= v + NONE_M {
            return true;
        }
        let Some(body) = self.bodies.get(surface.body) else { return false };
        let gap = body.signed_gap(self.frame.point(u, v), f64::INFINITY).filter(|g| g.gap_m < 0.0);
        gap.is_some_and(|g| body.is_ground() || g.normal.dot(&self.frame.up) > 0.0)
    }

    /// Adds a plumb leg upwards.
    fn add_plumb_leg_up(&mut self, u: f64, to: f64) {
        let v = [self.height, to];
        if v[1] - v[0] > NONE_M {
            self.legs.push(RouteLeg::Hangs { u, v });
        }
    }

    /// Adds a plumb leg to a height, or changes the last leg if that is plumb.
    fn add_plumb_leg(&mut self, u: f64, to: f64) {
        let v = [self.height, to];
        if (v[1] - v[0]).abs() <= NONE_M {
            return;
        }
        self.height = to;
        if let Some(RouteLeg::Hangs { v: before, .. }) = self.legs.last_mut() {
            before[1] = to;
            if (before[1] - before[0]).abs() <= NONE_M {
                self.legs.pop();
            }
        } else {
            self.legs.push(RouteLeg::Hangs { u, v });
        }
    }

    /// Adds a leg on a surface, or changes the last leg if that is on it.
    fn add_lying_leg(&mut self, surface: usize, u: [f64; 2]) {
        self.height = self.surfaces.all[surface].height(u[1]);
        if let Some(RouteLeg::Lies { surface: before, u: known }) = self.legs.last_mut()
            && *before == surface
        {
            known[1] = u[1];
            if (known[1] - known[0]).abs() <= NONE_M {
                self.legs.pop();
            }
        } else {
            self.legs.push(RouteLeg::Lies { surface, u });
        }
    }
}
