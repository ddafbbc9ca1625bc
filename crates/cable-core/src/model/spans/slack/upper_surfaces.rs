//! Upper surfaces are the parts of boundaries that face the load: cable that comes down lies on
//! them.
//!
//! All coordinates are in the frame of the load: u across it, v against it.

use crate::math::{Vec2, cross, larger, perp, smaller};
use crate::model::spans::boundary::{Curve, PieceShape};
use crate::model::spans::section::SolveContext;

/// Cosine between a boundary's normal and the load below which the boundary is a wall, beside which
/// the cable hangs.
const WALL_COSINE: f64 = 1e-9;

/// Lengths that count as zero, m: the round-off of kilometres.
pub(in crate::model::spans) const NONE_M: f64 = 1e-9;

/// The directions across the load and against it, unit vectors.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct LoadFrame {
    across: Vec2,
    pub up: Vec2,
}

/// A piece of boundary that holds cable that falls on it.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct UpperSurface {
    pub body: usize,
    pub friction: f64,
    /// Piece of the body's boundary, with the solid right of travel.
    piece: i64,
    /// Distance along the piece at which the surface begins.
    start: f64,
    /// Its first and last coordinate u, across the direction in which cable falls, m.
    pub range: [f64; 2],
    pub top: SurfaceShape,
}

/// The form of a surface: v as a function of u.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) enum SurfaceShape {
    Line { from: Vec2, slope: f64 },
    Round { center: Vec2, radius: f64 },
}

/// A directed part of a boundary: index of the curve, piece, and p at both ends.
pub(in crate::model::spans) type BoundaryInterval = (usize, i64, [f64; 2]);

impl LoadFrame {
    /// The frame of a load; None if the load is zero.
    pub fn of(load: Vec2) -> Option<Self> {
        let up = -load.try_normalize(0.0)?;
        Some(Self { across: -perp(up), up })
    }

    /// The components of a vector in this frame.
    pub fn split(self, at: Vec2) -> Vec2 {
        Vec2::new(at.dot(&self.across), at.dot(&self.up))
    }

    /// The point with these coordinates.
    pub fn point(self, u: f64, v: f64) -> Vec2 {
        self.across * u + self.up * v
    }
}

impl SurfaceShape {
    pub fn height(&self, u: f64) -> f64 {
        match *self {
            Self::Line { from, slope } => from.y + slope * (u - from.x),
            Self::Round { center, radius } => center.y + larger(radius * radius - (u - center.x).powi(2), 0.0).sqrt(),
        }
    }

    /// Coordinates at which two surfaces have the same height, at most two.
    pub fn crossings(&self, other: &Self) -> [f64; 2] {
        match (*self, *other) {
            (Self::Line { from, slope }, Self::Line { from: g, slope: n }) => {
                [g.x + (from.y + slope * (g.x - from.x) - g.y) / (n - slope), f64::NAN]
            }
            (Self::Line { from, slope }, Self::Round { center, radius })
            | (Self::Round { center, radius }, Self::Line { from, slope }) => {
                let d = Vec2::new(1.0, slope).normalize();
                let off = from - center;
                let along = off.dot(&d);
                let root = (along * along - off.norm_squared() + radius * radius).sqrt();
                [-along - root, -along + root].map(|t| from.x + t * d.x)
            }
            (Self::Round { center, radius }, Self::Round { center: c, radius: r }) => {
                let d = c - center;
                let apart = d.norm();
                let a = 0.5 * (apart + (radius * radius - r * r) / apart);
                let half = (radius * radius - a * a).sqrt();
                let (middle, aside) = (center + d * (a / apart), perp(d / apart) * half);
                [middle.x - aside.x, middle.x + aside.x]
            }
        }
    }
}

impl UpperSurface {
    /// Its height at a place.
    pub fn height(&self, u: f64) -> f64 {
        self.top.height(u)
    }

    /// Its slope there.
    pub fn slope(&self, u: f64) -> f64 {
        match self.top {
            SurfaceShape::Line { slope, .. } => slope,
            SurfaceShape::Round { center, .. } => (center.x - u) / larger(self.height(u) - center.y, f64::MIN_POSITIVE),
        }
    }

    /// Distance of a place of it along its piece.
    fn along(&self, u: f64) -> f64 {
        self.start
            + match self.top {
                SurfaceShape::Line { slope, .. } => (u - self.range[0]) * 1.0f64.hypot(slope),
                SurfaceShape::Round { center, radius } => {
                    // The angle is measured from the place where the surface rises plumb.
                    let rounding = 4.0 * f64::EPSILON * (center.x.abs() + radius) / radius;
                    let angle = |u: f64| {
                        let c = (center.x - u) / radius;
                        // Near that place the error of the angle would be the root of the
                        // round-off.
                        let c = if 1.0 - c.abs() <= rounding { c.signum() } else { c };
                        larger(1.0 - c * c, 0.0).sqrt().atan2(c)
                    };
                    angle(u) - angle(self.range[0])
                }
            }
    }

    /// The interval of its body's boundary from one coordinate to another, in the direction of the
    /// second.
    pub fn stretch(&self, curves: &[Curve], u: [f64; 2]) -> BoundaryInterval {
        let forward = &curves[2 * self.body];
        let [a, b] = u.map(|u| self.along(u));
        if b >= a {
            return (2 * self.body, self.piece, [a, b].map(|x| forward.origin(self.piece) + x));
        }
        let piece = forward.pieces().count() as i64 - 1 - self.piece;
        let extent = forward.piece(self.piece).extent;
        // A post begins in the direction of x in either sense.
        let whole = if extent.is_finite() { extent } else { std::f64::consts::PI };
        let back = &curves[2 * self.body + 1];
        (2 * self.body + 1, piece, [a, b].map(|x| back.origin(piece) + whole - x))
    }
}

/// All boundaries that face the load, in order of their first coordinate.
#[derive(Debug)]
pub(in crate::model::spans) struct UpperSurfaces {
    pub all: Vec<UpperSurface>,
    /// The greatest u that the surfaces up to each reach.
    reach: Vec<f64>,
}

impl UpperSurfaces {
    /// The upper surfaces of the bodies of a context.
    pub fn new(context: &SolveContext, bodies: usize, frame: LoadFrame) -> Self {
        let mut all = Vec::new();
        for body in 0..bodies {
            if let Some(curve) = context.curves.get(2 * body) {
                curve.pieces().for_each(|piece| upper_surfaces_of(curve, body, piece, frame, &mut all));
            }
        }
        all.sort_by(|a, b| a.range[0].total_cmp(&b.range[0]));
        let mut far = f64::NEG_INFINITY;
        let reach = all.iter().map(|r| (far = larger(far, r.range[1]), far).1).collect();
        Self { all, reach }
    }

    /// The indices of surfaces in an interval of u.
    pub fn over(&self, low: f64, high: f64) -> impl Iterator<Item = usize> {
        let first = self.reach.partition_point(|far| *far <= low);
        let last = self.all.partition_point(|r| r.range[0] < high);
        (first..last.max(first)).filter(move |&k| self.all[k].range[1] > low)
    }
}

/// Adds the parts of a piece of a boundary on which cable can lie from above.
fn upper_surfaces_of(curve: &Curve, body: usize, piece: i64, frame: LoadFrame, out: &mut Vec<UpperSurface>) {
    let (given, friction) = (curve.piece(piece), curve.friction);
    match given.form {
        PieceShape::Edge { from, tangent } => {
            let (from, along) = (frame.split(from + curve.shift), frame.split(tangent));
            if along.x > WALL_COSINE && given.extent > 0.0 {
                let u = [from.x, from.x + along.x * given.extent];
                out.push(UpperSurface {
                    body,
                    friction,
                    piece,
                    start: 0.0,
                    range: u,
                    top: SurfaceShape::Line { from, slope: along.y / along.x },
                });
            }
        }
        PieceShape::Arc { center, radius, from } => {
            let center = frame.split(center + curve.shift);
            // The distance along it at which the cable would rise plumb.
            let rises = -curve.sense * cross(from, frame.up).atan2(from.dot(&frame.up));
            let turn = std::f64::consts::TAU;
            let turns: &[f64] = if given.extent.is_finite() { &[-1.0, 0.0, 1.0] } else { &[0.0] };
            for k in turns {
                let first = rises + k * turn;
                let (mut low, mut high) = (first, first + std::f64::consts::PI);
                if given.extent.is_finite() {
                    (low, high) = (larger(low, 0.0), smaller(high, given.extent));
                }
                if !(high > low) {
                    continue;
                }
                let across = |x: f64| center.x - radius * (x - first).cos();
                let u = [across(low), across(high)];
                if u[1] > u[0] {
                    out.push(UpperSurface {
                        body,
                        friction,
                        piece,
                        start: low,
                        range: u,
                        top: SurfaceShape::Round { center, radius },
                    });
                }
            }
        }
    }
}
