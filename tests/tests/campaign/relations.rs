//! A relation leads from a scene to another one that must have the same answer, or one that follows
//! from it.

use super::case::Point;
use cable_core::Solution;
use cable_core::scene::{Scene, Shape};

/// Forces on the first and last support of a changed scene, seen as those of the first one.
pub type Back = fn([Point; 2]) -> [Point; 2];

/// A changed scene, and how the forces of the first one look in it.
pub struct Relation {
    pub name: &'static str,
    pub scene: Scene,
    /// Forces on the first and last support of the changed scene, seen as those of the first.
    pub back: Back,
}

fn same(f: [Point; 2]) -> [Point; 2] {
    f
}

/// Applies a map to every point of a scene.
fn map_points(scene: &mut Scene, map: impl Fn(Point) -> Point) {
    let each = |points: &mut Vec<Point>| points.iter_mut().for_each(|p| *p = map(*p));
    for c in &mut scene.cables {
        each(&mut c.route_m);
        for s in &mut c.supports {
            s.at_m = s.at_m.map(&map);
        }
    }
    for o in &mut scene.obstacles {
        match &mut o.shape {
            Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                each(points_m)
            }
            Shape::Circle { center_m, .. } => *center_m = map(*center_m),
        }
    }
}

/// Left for right.
pub fn mirrored(scene: &Scene) -> Scene {
    let mut s = scene.clone();
    map_points(&mut s, |p| [-p[0], p[1]]);
    for o in &mut s.obstacles {
        if let Shape::Terrain { points_m } = &mut o.shape {
            points_m.reverse();
        }
    }
    s.environment.wind_n_per_m[0] *= -1.0;
    for c in &mut s.cables {
        for p in &mut c.supports {
            p.angle_deg = p.angle_deg.map(|a| 180.0 - a);
            p.force_n = p.force_n.map(|f| [-f[0], f[1]]);
        }
    }
    for l in &mut s.loads {
        l.force_n = l.force_n.map(|f| [-f[0], f[1]]);
    }
    s
}

/// From end to start.
pub fn reversed(scene: &Scene) -> Scene {
    let mut s = scene.clone();
    for c in &mut s.cables {
        let length = c.length_m;
        c.supports.reverse();
        c.route_m.reverse();
        for p in &mut c.supports {
            p.arc_length_m = p.arc_length_m.map(|a| length - a);
            p.angle_deg = p.angle_deg.map(|a| if a > 0.0 { a - 180.0 } else { a + 180.0 });
        }
        for l in &mut s.loads {
            l.arc_length_m = length - l.arc_length_m;
        }
    }
    s
}

/// All lengths k times as long under the same forces: weight and wind per metre fall, EI grows with
/// k².
pub fn longer(scene: &Scene, k: f64) -> Scene {
    let mut s = scene.clone();
    map_points(&mut s, |p| [k * p[0], k * p[1]]);
    for o in &mut s.obstacles {
        match &mut o.shape {
            Shape::Circle { radius_m, .. } => *radius_m *= k,
            Shape::Polyline { thickness_m, .. } => *thickness_m *= k,
            _ => {}
        }
    }
    s.environment.wind_n_per_m = s.environment.wind_n_per_m.map(|w| w / k);
    for c in &mut s.cables {
        c.length_m *= k;
        c.linear_density_kg_per_m /= k;
        c.bending_stiffness_n_m2 *= k * k;
        c.diameter_m *= k;
        for p in &mut c.supports {
            p.arc_length_m = p.arc_length_m.map(|a| a * k);
            p.radius_m = p.radius_m.map(|a| a * k);
        }
    }
    for l in &mut s.loads {
        l.arc_length_m *= k;
    }
    s
}

/// All forces k times as great.
fn heavier(scene: &Scene, k: f64) -> Scene {
    let mut s = scene.clone();
    s.environment.wind_n_per_m = s.environment.wind_n_per_m.map(|w| w * k);
    for c in &mut s.cables {
        c.linear_density_kg_per_m *= k;
        c.axial_stiffness_n *= k;
        c.bending_stiffness_n_m2 *= k;
        for p in &mut c.supports {
            p.force_n = p.force_n.map(|f| [f[0] * k, f[1] * k]);
            p.mass_kg = p.mass_kg.map(|m| m * k);
        }
    }
    for l in &mut s.loads {
        l.force_n = l.force_n.map(|f| [f[0] * k, f[1] * k]);
    }
    s
}

fn shifted(scene: &Scene, by: Point) -> Scene {
    let mut s = scene.clone();
    map_points(&mut s, |p| [p[0] + by[0], p[1] + by[1]]);
    s
}

/// Obstacles in another order, each edge in two.
fn redrawn(scene: &Scene) -> Scene {
    let mut s = scene.clone();
    s.obstacles.reverse();
    for o in &mut s.obstacles {
        let (points, closed) = match &mut o.shape {
            Shape::Terrain { points_m } | Shape::Polyline { points_m, .. } => (points_m, false),
            Shape::Polygon { points_m } => (points_m, true),
            Shape::Circle { .. } => continue,
        };
        let n = points.len();
        let mut out = Vec::new();
        for k in 0..n {
            let (a, b) = (points[k], points[(k + 1) % n]);
            out.push(a);
            if closed || k + 1 < n {
                out.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
            }
        }
        *points = out;
    }
    s
}

/// One of the relations of a scene.
pub fn relation(scene: &Scene, which: usize) -> Relation {
    let (name, changed, back): (_, _, Back) = match which % COUNT {
        0 => ("mirrored", mirrored(scene), |f| f.map(|f| [-f[0], f[1]])),
        1 => ("from end to start", reversed(scene), |[a, b]| [b, a]),
        2 => ("twice as long", longer(scene, 2.0), same),
        3 => ("three times as heavy", heavier(scene, 3.0), |f| f.map(|f| [f[0] / 3.0, f[1] / 3.0])),
        4 => ("a kilometre away", shifted(scene, [1000.0, -300.0]), same),
        5 => ("drawn otherwise", redrawn(scene), same),
        _ => {
            let mut s = scene.clone();
            s.cables[0].length_m *= 1.0 + 1e-7;
            s.cables[0].axial_stiffness_n *= 1.0 + 1e-7;
            ("a touch more", s, same)
        }
    };
    Relation { name, scene: changed, back }
}

/// Their number.
pub const COUNT: usize = 7;

/// Forces on the first and last support of the first cable, N.
pub fn end_forces(answer: &Solution) -> [Point; 2] {
    let supports = answer.cables.first().map(|c| c.supports.as_slice()).unwrap_or_default();
    let of = |k: usize| supports.get(k).map_or([f64::NAN; 2], |r| [r.reaction_x_n, r.reaction_y_n]);
    [of(0), of(supports.len().saturating_sub(1))]
}
