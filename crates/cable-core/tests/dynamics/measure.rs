//! These functions make scenes of one cable and starts away from rest, and read figures off a
//! motion.

use cable_core::scene::{Scene, Support, SupportKind, catalog};
use cable_core::state::State;
use cable_core::{Model, Settings, Simulation, Vec2};

/// Gravity of these scenes, m/s².
pub const G: f64 = cable_core::scene::STANDARD_GRAVITY;

/// A cable alone, see [`catalog::cable_alone`], of so many bars.
pub fn cable(figures: [f64; 3], segments: usize, supports: Vec<Support>) -> Scene {
    let mut scene = catalog::cable_alone(figures, supports);
    scene.cables[0].segments = Some(segments);
    scene
}

/// A lump of mass (kg) on an end.
pub fn lump(name: &str, mass_kg: f64) -> Support {
    Support { mass_kg: Some(mass_kg), force_n: Some([0.0, 0.0]), ..Support::new(name, SupportKind::Load) }
}

/// Lets no vibration be so fast that a model would take shorter steps than it is told.
const ANY: f64 = 1e9;

/// The scene settled; its steps are those asked for.
pub fn settled(scene: &Scene, model: Model) -> Simulation {
    settled_within(ANY, scene, model)
}

/// The scene settled, to be followed with a tolerance.
fn settled_within(tolerance: f64, scene: &Scene, model: Model) -> Simulation {
    let settings = Settings { tolerance, ..Settings::default() };
    let mut sim = Simulation::with_settings(scene.clone(), model, settings).unwrap();
    sim.settle().unwrap();
    sim
}

/// A motion that begins at t = 0 from the resting place as `change` changes it.
pub fn started(scene: &Scene, change: impl FnOnce(&mut State)) -> Simulation {
    started_within(ANY, scene, change)
}

/// The same, followed with a tolerance.
pub fn started_within(tolerance: f64, scene: &Scene, change: impl FnOnce(&mut State)) -> Simulation {
    let mut sim = settled_within(tolerance, scene, Model::Fem);
    // A first step hands the shape from statics to dynamics, which keeps velocities.
    sim.step(1e-4).unwrap();
    let mut states = sim.states();
    states[0].time_s = 0.0;
    states[0].velocity_m_per_s.fill(Vec2::zeros());
    change(&mut states[0]);
    sim.set_states(&states).unwrap();
    sim
}

/// `probe` before the first and after every `every`-th of the inner steps `h` (s), `count` + 1
/// values.
pub fn sampled(
    sim: &mut Simulation,
    (h, every): (f64, usize),
    count: usize,
    probe: impl Fn(&State) -> f64,
) -> Vec<f64> {
    let mut out = vec![probe(&sim.states()[0])];
    for _ in 0..count {
        for _ in 0..every {
            sim.step(h).unwrap();
        }
        out.push(probe(&sim.states()[0]));
    }
    out
}

/// Mass of each node, kg: half of the bars beside it.
pub fn masses(scene: &Scene, state: &State) -> Vec<f64> {
    let (s, n) = (&state.arc_length_m, state.arc_length_m.len());
    let cable = &scene.cables[0];
    let mut mass = vec![0.0; n];
    for e in 0..n - 1 {
        for k in [e, e + 1] {
            mass[k] += 0.5 * cable.linear_density_kg_per_m * (s[e + 1] - s[e]);
        }
    }
    let last = cable.supports.len() - 1;
    mass[0] += cable.supports[0].mass_kg.unwrap_or(0.0);
    mass[n - 1] += cable.supports[last].mass_kg.unwrap_or(0.0);
    mass
}

/// Mass of nodes beyond half of the bars beside them, and mass that couples the nodes of each bar,
/// both in m of arc length, of stretches of so many bars of a length: the mean of lumped and
/// consistent mass with end weights (docs/notes/mass-matrix.md).
fn spread(stretches: &[(usize, f64)]) -> (Vec<f64>, Vec<f64>) {
    let alpha = 167.75f64.sqrt() - 13.0;
    let (mut more, mut coupling) = (vec![0.0], Vec::new());
    for &(count, bar) in stretches {
        let first = coupling.len();
        coupling.resize(first + count, bar / 12.0);
        more.resize(coupling.len() + 1, 0.0);
        let last = coupling.len();
        let ends = [([first, first + 1, first + 2], first), ([last, last - 1, last.saturating_sub(2)], last - 1)];
        for (nodes, end_bar) in ends.into_iter().filter(|_| count > 1) {
            let weights = [-3.0 - 2.0 * alpha, 4.0 + 4.0 * alpha, -1.0 - 2.0 * alpha];
            nodes.iter().zip(weights).for_each(|(k, weight)| more[*k] += weight * bar / 48.0);
            coupling[end_bar] = (1.0 - alpha) * bar / 12.0;
        }
    }
    (more, coupling)
}

/// The mass of a cable of `fem` that can touch nothing: of each node, and what couples the nodes of
/// each bar, kg.
pub struct Mass {
    pub node: Vec<f64>,
    pub coupling: Vec<f64>,
}

impl Mass {
    /// Of the mesh of a state.
    pub fn of(scene: &Scene, state: &State) -> Self {
        let (s, cable) = (&state.arc_length_m, &scene.cables[0]);
        let whole = cable.length_m;
        let at = |a: f64, b: f64| (a - b).abs() < 1e-6 * whole;
        let is_break = |k: usize| {
            let load = scene.loads.iter().any(|l| at(l.arc_length_m, s[k]));
            let support = cable.supports.iter().any(|p| p.arc_length_m.is_some_and(|a| at(a, s[k])));
            k == 0 || k + 1 == s.len() || load || support
        };
        let breaks: Vec<usize> = (0..s.len()).filter(|k| is_break(*k)).collect();
        let even = |pair: &[usize]| (pair[1] - pair[0], (s[pair[1]] - s[pair[0]]) / (pair[1] - pair[0]) as f64);
        let (more, beside) = spread(&breaks.windows(2).map(even).collect::<Vec<_>>());
        let density = cable.linear_density_kg_per_m;
        let lumped = masses(scene, state);
        Self {
            node: lumped.iter().zip(&more).map(|(m, more)| m + density * more).collect(),
            coupling: beside.iter().map(|l| density * l).collect(),
        }
    }

    /// Its product with places or velocities.
    pub fn times(&self, v: &[Vec2]) -> Vec<Vec2> {
        let mut out: Vec<Vec2> = v.iter().zip(&self.node).map(|(v, m)| v * *m).collect();
        for (e, c) in self.coupling.iter().enumerate() {
            let turned = (v[e + 1] - v[e]) * *c;
            out[e] += turned;
            out[e + 1] -= turned;
        }
        out
    }
}

/// Motion, height and stretching of a cable of `fem` that can touch nothing together, J.
pub fn spread_energy(scene: &Scene, state: &State) -> f64 {
    let (mass, lumped) = (Mass::of(scene, state), masses(scene, state));
    let (x, v) = (&state.position_m, &state.velocity_m_per_s);
    let g = scene.environment.gravity_m_per_s2;
    let turned: f64 = mass.coupling.iter().enumerate().map(|(e, c)| -0.5 * c * (v[e + 1] - v[e]).norm_squared()).sum();
    let more = (0..x.len()).map(|k| (mass.node[k] - lumped[k]) * (0.5 * v[k].norm_squared() + g * x[k].y));
    energy(scene, state) + turned + more.sum::<f64>()
}

/// Motion, height and stretching together, the mass lumped at the nodes, J.
pub fn energy(scene: &Scene, state: &State) -> f64 {
    let mass = masses(scene, state);
    let g = scene.environment.gravity_m_per_s2;
    let ea = scene.cables[0].axial_stiffness_n;
    let (x, v, s) = (&state.position_m, &state.velocity_m_per_s, &state.arc_length_m);
    let lumps: f64 = (0..mass.len()).map(|k| mass[k] * (0.5 * v[k].norm_squared() + g * x[k].y)).sum();
    let bars: f64 = (1..s.len())
        .map(|k| {
            let rest = s[k] - s[k - 1];
            let strain = (x[k] - x[k - 1]).norm() / rest - 1.0;
            if strain > 0.0 { 0.5 * ea * rest * strain * strain } else { 0.0 }
        })
        .sum();
    lumps + bars
}

/// A decaying swing.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    /// Circular frequency, 1/s.
    pub omega: f64,
    /// Decay rate of the amplitude, 1/s.
    pub decay: f64,
}

/// Frequency and decay of e^{−σt} cos(ωt + φ) + c sampled every `dt` (s), the first sample left out
/// (the first step is implicit Euler's): differences d of the samples obey d₊ = a d − b d₋ with a =
/// 2e^{−σdt} cos ωdt, b = e^{−2σdt}, fitted by least squares.
pub fn ring(samples: &[f64], dt: f64) -> Ring {
    let d: Vec<f64> = samples[1..].windows(2).map(|w| w[1] - w[0]).collect();
    let mut m = nalgebra::Matrix2::zeros();
    let mut r = nalgebra::Vector2::zeros();
    for w in d.windows(3) {
        let row = nalgebra::Vector2::new(w[1], -w[0]);
        m += row * row.transpose();
        r += row * w[2];
    }
    let ab = m.lu().solve(&r).unwrap();
    let decay = -0.5 * ab[1].ln() / dt;
    Ring { omega: (0.5 * ab[0] / ab[1].sqrt()).acos() / dt, decay }
}

/// Part of BDF3 in even steps of a cable that can touch nothing.
pub const THIRD: f64 = 0.48;

/// Frequency and decay without the effect of steps: steps of `h` (s) turn λ into μ with λh =
/// δ(e^{−μh}), δ(z) = (1 − z) + (1 − z)²/2 + β (1 − z)³/3.
pub fn behind(Ring { omega, decay }: Ring, h: f64) -> Ring {
    let times = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let (size, angle) = ((decay * h).exp(), omega * h);
    let first = [1.0 - size * angle.cos(), size * angle.sin()];
    let second = times(first, first);
    let third = times(second, first);
    let lambda = [0, 1].map(|k| (first[k] + 0.5 * second[k] + THIRD / 3.0 * third[k]) / h);
    Ring { omega: lambda[1], decay: -lambda[0] }
}

/// Part by which steps of `h` (s) swing too slowly: (1 − β)(ωh)²/3.
pub fn slows(omega: f64, h: f64) -> f64 {
    (1.0 - THIRD) * (omega * h).powi(2) / 3.0
}

/// Decay rate that steps of `h` (s) add to the order h³: (1 − 2β) ω⁴h³/4, 1/s.
pub fn damps(omega: f64, h: f64) -> f64 {
    (1.0 - 2.0 * THIRD) * omega.powi(4) * h.powi(3) / 4.0
}

/// Errors of ever finer rungs: the first at most `bound`, each step of at least order `least`.
pub fn climbs(name: &str, errors: &[f64], least: f64, bound: f64) {
    let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).abs().log2()).collect();
    let shown: Vec<String> = errors.iter().map(|e| format!("{e:.2e}")).collect();
    println!("{name}: {} order {:.2?}", shown.join(" "), orders);
    assert!(errors[0].abs() <= bound, "{name}: rung 0 is {:.3e}, not {bound:.3e}", errors[0]);
    for o in orders {
        assert!(o >= least, "{name}: order {o:.2}, less than {least}");
    }
}

/// Errors of ever finer rungs: each below `bound` divided by its refinement, each step of order
/// `order` ± 0.25.
pub fn ladder(name: &str, errors: &[f64], order: f64, bound: f64) {
    let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).abs().log2()).collect();
    let shown: Vec<String> = errors.iter().map(|e| format!("{e:.2e}")).collect();
    println!("{name}: {} order {:.2?}", shown.join(" "), orders);
    for (k, e) in errors.iter().enumerate() {
        let most = bound / 2f64.powf(order * k as f64);
        assert!(e.abs() <= 1.3 * most, "{name}: rung {k} is {e:.3e}, not {most:.3e}");
    }
    for o in orders {
        assert!((o - order).abs() <= 0.25, "{name}: order {o:.2} instead of {order}");
    }
}
