//! These laws hold for a cable that hangs at rest and touches nothing.

use super::measure::{base, dead_load, difference, larger, reactions_n, settle, span, weight_n};
use cable_core::math::Vec2;
use cable_core::scene::{Obstacle, Shape};
use cable_core::solution::{Solution, SupportReaction};
use cable_core::{Error, Model};

/// The number of nodes with a figure that is not finite.
pub(crate) fn not_finite(model: Model) -> Result<f64, Error> {
    let settled = settle(&base(), model)?;
    let bad = settled.cables[0].nodes.iter().filter(|n| {
        let figures = [n.x_m, n.y_m, n.tension_n, n.strain, n.stress_pa, n.curvature_per_m];
        !figures.iter().all(|v| v.is_finite())
    });
    Ok(bad.count() as f64)
}

pub(crate) fn not_repeatable(model: Model) -> Result<f64, Error> {
    Ok(difference(&settle(&base(), model)?, &settle(&base(), model)?))
}

/// The elastic catenary (H. Irvine, Cable structures, MIT Press, 1981) that leaves the first
/// support with the reaction the model reports, x(L) = H L/EA + H/w·[asinh((V+wL)/H) − asinh(V/H)],
/// z(L) = L/EA·(V + wL/2) + [T_B − T_A]/w: how far its end misses the second support, relative to
/// the length.
pub(crate) fn closure(model: Model) -> Result<f64, Error> {
    let scene = base();
    let settled = settle(&scene, model)?;
    let (c, r) = (&scene.cables[0], &settled.cables[0].supports[0]);
    let (h, v, l, ea) = (r.reaction_x_n, r.reaction_y_n, c.length_m, c.axial_stiffness_n);
    let w = c.linear_density_kg_per_m * scene.environment.gravity_m_per_s2;
    let end = v + w * l;
    let x = h * l / ea + h / w * ((end / h).asinh() - (v / h).asinh());
    let z = l / ea * (v + 0.5 * w * l) + (h.hypot(end) - h.hypot(v)) / w;
    let (a, b) = (c.supports[0].at_m.unwrap_or_default(), c.supports[1].at_m.unwrap_or_default());
    Ok((x - (b[0] - a[0])).hypot(z - (b[1] - a[1])) / l)
}

pub(crate) fn weight_not_held(model: Model) -> Result<f64, Error> {
    let weight = weight_n(&base());
    Ok((reactions_n(&settle(&base(), model)?)[1] + weight).abs() / weight)
}

pub(crate) fn sideways_sum(model: Model) -> Result<f64, Error> {
    Ok(reactions_n(&settle(&base(), model)?)[0].abs() / weight_n(&base()))
}

pub(crate) fn moved(model: Model) -> Result<f64, Error> {
    let moved = settle(&span([100.0, -45.0], [110.0, -46.0]), model)?;
    Ok(tension_difference(&settle(&base(), model)?, &moved, Order::Same))
}

pub(crate) fn mirrored(model: Model) -> Result<f64, Error> {
    let mirrored = settle(&span([0.0, 5.0], [-10.0, 4.0]), model)?;
    Ok(tension_difference(&settle(&base(), model)?, &mirrored, Order::Same))
}

pub(crate) fn asymmetry(model: Model) -> Result<f64, Error> {
    let level = settle(&span([0.0, 5.0], [10.0, 5.0]), model)?;
    Ok(tension_difference(&level, &level, Order::Reversed))
}

pub(crate) fn scaled(model: Model) -> Result<f64, Error> {
    let mut heavy = base();
    heavy.cables[0].linear_density_kg_per_m *= 8.0;
    heavy.cables[0].axial_stiffness_n *= 8.0;
    let mut scaled = settle(&heavy, model)?;
    for n in &mut scaled.cables[0].nodes {
        n.tension_n /= 8.0;
    }
    Ok(tension_difference(&settle(&base(), model)?, &scaled, Order::Same))
}

pub(crate) fn loaded_end(model: Model) -> Result<f64, Error> {
    hanging_load(model, None)
}

pub(crate) fn loaded_end_near_floor(model: Model) -> Result<f64, Error> {
    let shape = Shape::Terrain { points_m: vec![[-50.0, -20.0], [50.0, -20.0]] };
    hanging_load(model, Some(Obstacle { name: "floor".to_owned(), shape, friction: None }))
}

/// A cable that hangs from its start, a dead load on its end: how far the tension just inside the
/// end is from the load, the force on the end from its opposite, and the sum of both forces from
/// the weight; relative to the load.
fn hanging_load(model: Model, floor: Option<Obstacle>) -> Result<f64, Error> {
    let force = Vec2::new(20.0, -35.0);
    let mut scene = span([0.0, 5.0], [0.0, 0.0]);
    scene.cables[0].length_m = 4.0;
    scene.cables[0].supports[1] = dead_load("load", [force.x, force.y]);
    scene.obstacles.extend(floor);
    let weight = Vec2::new(0.0, -weight_n(&scene));
    let answer = settle(&scene, model)?;
    let [Some(held), Some(end)] = [0, 1].map(|k| answer.cables[0].supports.get(k)) else { return Ok(f64::NAN) };
    let reaction = |r: &SupportReaction| Vec2::new(r.reaction_x_n, r.reaction_y_n);
    let tension = answer.cables[0].nodes.last().map_or(f64::NAN, |n| n.tension_n);
    let off = [
        (tension - force.norm()).abs(),
        (reaction(end) + force).norm(),
        (reaction(held) + reaction(end) - weight).norm(),
    ];
    Ok(off.into_iter().fold(0.0, larger) / force.norm())
}

/// The order in which nodes of two answers are paired.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Order {
    Same,
    Reversed,
}

/// Greatest difference of tension between two answers on the same mesh, relative to the greatest.
fn tension_difference(a: &Solution, b: &Solution, order: Order) -> f64 {
    let (m, n) = (&a.cables[0].nodes, &b.cables[0].nodes);
    if m.len() != n.len() {
        return f64::NAN;
    }
    let top = a.max_tension().tension_n;
    let mut worst = 0.0;
    for (i, p) in m.iter().enumerate() {
        let partner = match order {
            Order::Same => i,
            Order::Reversed => n.len() - 1 - i,
        };
        let d = (p.tension_n - n[partner].tension_n).abs() / top;
        if d > worst || d.is_nan() {
            worst = d;
        }
    }
    worst
}
