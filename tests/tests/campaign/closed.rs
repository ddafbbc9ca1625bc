//! These closed forms are written for the tests alone.

use super::case::{Point, apart};

/// Forces of a free elastic cable on what holds its two ends, N (H. M. Irvine, "Cable structures",
/// 1981, chapter 1).
///
/// With b the load per metre, the force in the cable grows by −b s. The way from end to end is the
/// gradient of the complementary energy ∫ T + T²/2EA ds − F₀·Δ, which is convex in the force F₀ at
/// the start: Newton's method with Armijo's rule finds its least value.
pub fn free_span(ends: [Point; 2], length: f64, body: Point, ea: f64) -> Option<[Point; 2]> {
    let b = body[0].hypot(body[1]);
    // Axes across and against the load.
    let up = [-body[0] / b, -body[1] / b];
    let across = [up[1], -up[0]];
    let delta = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    let (dx, dy) = (dot(delta, across), dot(delta, up));
    let total = b * length;
    let span = Span { length, b, ea };
    let stretch = ea * (apart(ends[0], ends[1]) / length - 1.0);
    let mut at = if stretch > 0.0 {
        let d = dx.hypot(dy);
        [stretch * dx / d + 1e-3 * total, stretch * dy / d - 0.5 * total]
    } else {
        [0.5 * total * dx / length, -0.5 * total]
    };
    for _ in 0..500 {
        let (x, y, j) = span.way(at);
        let (gx, gy) = (x - dx, y - dy);
        let det = j[0] * j[2] - j[1] * j[1];
        let step = [-(j[2] * gx - j[1] * gy) / det, -(j[0] * gy - j[1] * gx) / det];
        let slope = gx * step[0] + gy * step[1];
        if !slope.is_finite() {
            return None;
        }
        if gx.hypot(gy) <= 1e-13 * length || step[0].hypot(step[1]) <= 1e-14 * at[0].hypot(at[1]) {
            let back = |f: Point| [f[0] * across[0] + f[1] * up[0], f[0] * across[1] + f[1] * up[1]];
            let end = back([at[0], at[1] + total]);
            return Some([back(at), [-end[0], -end[1]]]);
        }
        let energy = |f: Point| span.energy(f) - f[0] * dx - f[1] * dy;
        let before = energy(at);
        let mut part = 1.0;
        loop {
            let next = [at[0] + part * step[0], at[1] + part * step[1]];
            // Near the end the energy is flat to rounding.
            if energy(next) <= before + 1e-4 * part * slope + 1e-14 * before.abs() || part < 1e-8 {
                at = next;
                break;
            }
            part *= 0.5;
        }
    }
    None
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

struct Span {
    length: f64,
    b: f64,
    ea: f64,
}

impl Span {
    /// Way of the end, and its derivatives by the force at the start: xx, xy, yy.
    fn way(&self, [h, v]: Point) -> (f64, f64, [f64; 3]) {
        let Self { length, b, ea } = *self;
        let w = v + b * length;
        let (t0, t1) = (h.hypot(v), h.hypot(w));
        let turn = (w / h.abs()).asinh() - (v / h.abs()).asinh();
        let x = h * length / ea + h / b * turn;
        let y = (w + v) * length / (2.0 * ea) + (t1 - t0) / b;
        let part = w / t1 - v / t0;
        let mixed = h / b * (1.0 / t1 - 1.0 / t0);
        (x, y, [length / ea + (turn - part) / b, mixed, length / ea + part / b])
    }

    /// ∫ T + T²/2EA ds.
    fn energy(&self, [h, v]: Point) -> f64 {
        let Self { length, b, ea } = *self;
        let w = v + b * length;
        let area = |v: f64| 0.5 * (v * h.hypot(v) + h * h * (v / h.abs()).asinh());
        let square = h * h * length + (w * w * w - v * v * v) / (3.0 * b);
        (area(w) - area(v)) / b + square / (2.0 * ea)
    }
}

/// Forces on anchor and upper end of a cable whose anchor lies on level ground without friction,
/// and which leaves it somewhere; the upper end is `high` above the ground and `far` from the
/// anchor. None where nothing lies, or where more lies than the tension draws out. Bisection of the
/// horizontal force.
pub fn mooring([far, high]: Point, length: f64, w: f64, ea: f64) -> Option<[Point; 2]> {
    // Hanging length for a horizontal force, from its height.
    let hanging = |h: f64| {
        let height = |s: f64| {
            let v = w * s;
            v * v / (h.hypot(v) + h) / w + v * v / (2.0 * w * ea)
        };
        bisect(0.0, 2.0 * (length + high), |s| height(s) - high)
    };
    let reach = |h: f64| {
        let s = hanging(h);
        (length - s) * (1.0 + h / ea) + h * s / ea + h / w * (w * s / h).asinh()
    };
    let least = 1e-12 * w * length;
    let most = 1e3 * w * length + ea;
    if reach(least) > far || hanging(least) > length {
        return None;
    }
    let h = bisect(least, most, |h| reach(h) - far);
    let s = hanging(h);
    (s < length).then_some([[h, 0.0], [-h, -w * s]])
}

/// The zero of a function that grows.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..300 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Material that hangs plumb over a height: h = s + w s²/2EA.
pub fn plumb(height: f64, w: f64, ea: f64) -> f64 {
    bisect(0.0, height, |s| s + w * s * s / (2.0 * ea) - height)
}

#[test]
fn a_symmetric_span_carries_half_its_weight_at_each_end() {
    let [a, b] = free_span([[0.0, 0.0], [10.0, 0.0]], 12.0, [0.0, -10.0], 1e6).unwrap();
    assert!((a[1] - 60.0).abs() > 0.0 && (a[1] + 60.0).abs() < 1e-9 && (b[1] + 60.0).abs() < 1e-9, "{a:?} {b:?}");
    assert!((a[0] + b[0]).abs() < 1e-9 && a[0] > 0.0);
}
