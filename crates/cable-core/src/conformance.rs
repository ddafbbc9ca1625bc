//! Every model must pass this suite: identities that hold whatever the method, each with the error
//! reached.

use crate::any_error::Error;
use crate::math::{Vec2, larger};
use crate::model_id::Model;
use crate::scene::{Obstacle, Scene, Shape, Support, SupportKind, catalog};
use crate::simulation::Simulation;
use crate::solution::{Solution, SupportReaction};

/// One property of a model, and how well it holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// What was tested.
    pub name: &'static str,
    /// How far from true, relative.
    pub error: f64,
    /// How far is allowed.
    pub tolerance: f64,
}

impl Check {
    /// Whether it holds; a number that is not one does not.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.error <= self.tolerance
    }
}

/// Runs the suite on a model.
///
/// # Errors
/// When the model has no answer to one of the scenes.
pub fn run(model: Model) -> Result<Vec<Check>, Error> {
    let [shape, equilibrium] = model.info().accuracy;
    let base = span([0.0, 5.0], [10.0, 4.0]);
    let settled = settle(&base, model)?;
    let mut out = Vec::new();
    let mut check = |name, error, tolerance| out.push(Check { name, error, tolerance });
    check("finite", non_finite(&settled), 0.0);
    check("bit-repeatable", f64::from(u8::from(settle(&base, model)? != settled)), 0.0);
    check("rests on the closed form of the elastic catenary", closure(&base, &settled), shape);
    let weight = 12.0 * base.cables[0].linear_density_kg_per_m * base.environment.gravity_m_per_s2;
    check("reactions sum to the weight", (sum_y(&settled) + weight).abs() / weight, equilibrium);
    check("reactions have no sum sideways", sum_x(&settled).abs() / weight, equilibrium);
    let moved = settle(&span([100.0, -45.0], [110.0, -46.0]), model)?;
    check("a scene moved gives the same tensions", tensions(&settled, &moved, false), 10.0 * equilibrium);
    let mirrored = settle(&span([0.0, 5.0], [-10.0, 4.0]), model)?;
    check("a scene mirrored gives the same tensions", tensions(&settled, &mirrored, false), 10.0 * equilibrium);
    let level = settle(&span([0.0, 5.0], [10.0, 5.0]), model)?;
    check("a level span is symmetric", tensions(&level, &level, true), 10.0 * equilibrium);
    let mut heavy = base.clone();
    heavy.cables[0].linear_density_kg_per_m *= 8.0;
    heavy.cables[0].axial_stiffness_n *= 8.0;
    let mut scaled = settle(&heavy, model)?;
    for n in &mut scaled.cables[0].nodes {
        n.tension_n /= 8.0;
    }
    check("forces scale with weight and stiffness", tensions(&settled, &scaled, false), 10.0 * equilibrium);
    let mut over = base.clone();
    over.cables[0].supports.insert(1, Support::pulley("eye", [5.0, 7.0]));
    let slid = settle(&over, model)?;
    check("a smooth pulley passes tension on", passed_on(&slid), shape);
    let pulled = (sum_y(&slid) + weight).abs() / weight;
    check("reactions with a pulley sum to the weight", pulled, 10.0 * equilibrium);
    let hung = "a dead load at a free end is the tension there";
    check(hung, loaded_end(model, false)?, 10.0 * equilibrium);
    // With something to touch each of a hundred nodes may be out of balance by 1e-6 of all that acts.
    let near = "a dead load at a free end is the tension there, with something to touch";
    check(near, loaded_end(model, true)?, 100.0 * equilibrium);
    Ok(out)
}

/// A cable that hangs from its start, a dead load on its end: how far the tension just inside the end is from the load, the
/// force on the end from its opposite, and the sum of both forces from the weight; relative to the load.
fn loaded_end(model: Model, floor: bool) -> Result<f64, Error> {
    let force = Vec2::new(20.0, -35.0);
    let mut scene = span([0.0, 5.0], [0.0, 0.0]);
    let c = &mut scene.cables[0];
    c.length_m = 4.0;
    c.supports[1] = Support { force_n: Some([force.x, force.y]), ..Support::new("load", SupportKind::Load) };
    let weight = Vec2::new(0.0, -4.0 * c.linear_density_kg_per_m * scene.environment.gravity_m_per_s2);
    if floor {
        let shape = Shape::Terrain { points_m: vec![[-50.0, -20.0], [50.0, -20.0]] };
        scene.obstacles.push(Obstacle { name: "floor".to_owned(), shape, friction: None });
    }
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

/// A flexible span of 12 m between two points.
fn span(left: [f64; 2], right: [f64; 2]) -> Scene {
    let mut scene = catalog::hanging_span();
    let c = &mut scene.cables[0];
    c.axial_stiffness_n = 1e5;
    c.bending_stiffness_n_m2 = 0.0;
    c.length_m = 12.0;
    c.supports = vec![Support::fixed("left", left), Support::fixed("right", right)];
    scene
}

/// Difference of tension at the pulley, relative.
fn passed_on(s: &Solution) -> f64 {
    match s.cables[0].supports.get(1).map(|p| (p.tension_before_n, p.tension_after_n)) {
        Some((Some(before), Some(after))) => (after - before).abs() / before,
        _ => f64::NAN,
    }
}

fn settle(scene: &Scene, model: Model) -> Result<Solution, Error> {
    Ok(Simulation::new(scene.clone(), model)?.settle()?)
}

fn non_finite(s: &Solution) -> f64 {
    let bad = s.cables[0].nodes.iter().filter(|n| {
        ![n.x_m, n.y_m, n.tension_n, n.strain, n.stress_pa, n.curvature_per_m].iter().all(|v| v.is_finite())
    });
    bad.count() as f64
}

fn sum_x(s: &Solution) -> f64 {
    s.cables[0].supports.iter().map(|r| r.reaction_x_n).sum()
}

fn sum_y(s: &Solution) -> f64 {
    s.cables[0].supports.iter().map(|r| r.reaction_y_n).sum()
}

/// The elastic catenary (H. Irvine, Cable structures, MIT Press, 1981) that leaves the first support with the reaction
/// the model reports, x(L) = H L/EA + H/w·[asinh((V+wL)/H) − asinh(V/H)], z(L) = L/EA·(V + wL/2) + [T_B − T_A]/w:
/// how far its end misses the second support, relative to the length.
fn closure(scene: &Scene, s: &Solution) -> f64 {
    let (c, r) = (&scene.cables[0], &s.cables[0].supports[0]);
    let (h, v, l, ea) = (r.reaction_x_n, r.reaction_y_n, c.length_m, c.axial_stiffness_n);
    let w = c.linear_density_kg_per_m * scene.environment.gravity_m_per_s2;
    let end = v + w * l;
    let x = h * l / ea + h / w * ((end / h).asinh() - (v / h).asinh());
    let z = l / ea * (v + 0.5 * w * l) + (h.hypot(end) - h.hypot(v)) / w;
    let (a, b) = (c.supports[0].at_m.unwrap_or_default(), c.supports[1].at_m.unwrap_or_default());
    (x - (b[0] - a[0])).hypot(z - (b[1] - a[1])) / l
}

/// Greatest difference of tension between two answers on the same mesh, relative to the greatest.
fn tensions(a: &Solution, b: &Solution, reversed: bool) -> f64 {
    let (m, n) = (&a.cables[0].nodes, &b.cables[0].nodes);
    if m.len() != n.len() {
        return f64::NAN;
    }
    let top = a.max_tension().tension_n;
    let mut worst = 0.0;
    for (i, p) in m.iter().enumerate() {
        let q = &n[if reversed { n.len() - 1 - i } else { i }];
        let d = (p.tension_n - q.tension_n).abs() / top;
        if d > worst || d.is_nan() {
            worst = d;
        }
    }
    worst
}
