//! A beam between two hinges swings in bending at (nπ/L)² √(EI/ρ), one that is clamped at one end
//! at (1.8751/L)² √(EI/ρ). Its loss takes ζω of the amplitude a second at every frequency, with a
//! damping ratio of its own in bending, whether or not there is anything that it could touch.

use cable_core::Model;
use cable_core::scene::{Obstacle, Shape, Support, SupportKind};
use cable_core::state::State;

use super::mass_spring;
use super::measure::{Ring, cable, masses, ring, sampled, started};

const LENGTH: f64 = 10.0;
const EI: f64 = 100.0;
const DENSITY: f64 = 0.1;

/// The bending mode of a beam.
#[derive(Clone, Copy, Debug)]
enum Beam {
    /// Between hinges, with so many half waves.
    Hinged(f64),
    /// Clamped at one end, its first mode.
    Cantilever,
}

impl Beam {
    /// Its wave number times its length.
    fn wave(self) -> f64 {
        match self {
            Self::Hinged(half_waves) => half_waves * std::f64::consts::PI,
            Self::Cantilever => 1.875_104,
        }
    }

    /// Circular frequency of the beam of EI, rad/s.
    fn omega(self) -> f64 {
        (self.wave() / LENGTH).powi(2) * (EI / DENSITY).sqrt()
    }

    fn shape(self, s: f64) -> f64 {
        match self {
            Self::Hinged(_) => (self.wave() * s / LENGTH).sin(),
            Self::Cantilever => {
                let (k, part) = (self.wave() * s / LENGTH, 0.734_095_5);
                k.cosh() - k.cos() - part * (k.sinh() - k.sin())
            }
        }
    }

    fn supports(self) -> Vec<Support> {
        match self {
            Self::Hinged(_) => vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [LENGTH, 0.0])],
            Self::Cantilever => {
                let clamp =
                    Support { kind: SupportKind::Clamped, angle_deg: Some(0.0), ..Support::fixed("A", [0.0; 2]) };
                vec![clamp, Support { force_n: Some([0.0; 2]), ..Support::new("B", SupportKind::Load) }]
            }
        }
    }
}

/// Circular frequency and decay of the beam's free swing beside obstacles, of damping ratios in
/// stretching and in bending. Steps are a hundredth of the swing.
fn rings(model: Model, beam: Beam, [stretching, bending]: [f64; 2], obstacles: &[Obstacle]) -> Ring {
    let mut scene = cable([LENGTH, DENSITY, 1e5], 48, beam.supports());
    scene.environment.gravity_m_per_s2 = 0.0;
    let own = &mut scene.cables[0];
    (own.bending_stiffness_n_m2, own.damping_ratio) = (EI, stretching);
    own.bending_damping_ratio = (bending != stretching).then_some(bending);
    scene.obstacles = obstacles.to_vec();
    let plucked = |state: &mut State| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            p.y += 1e-4 * beam.shape(*s);
        }
    };
    let mut sim = match model {
        Model::MassSpring => mass_spring::started(&scene, plucked),
        _ => started(&scene, plucked),
    };
    let mass = masses(&scene, &sim.states()[0]);
    let h = std::f64::consts::TAU / beam.omega() / 100.0;
    let samples = sampled(&mut sim, (h, 20), 60, |state| {
        (0..mass.len()).map(|i| mass[i] * beam.shape(state.arc_length_m[i]) * state.position_m[i].y).sum()
    });
    ring(&samples, 20.0 * h)
}

fn post() -> Vec<Obstacle> {
    let shape = Shape::Circle { center_m: [0.5 * LENGTH, 0.6], radius_m: 0.1 };
    vec![Obstacle { name: "post".into(), shape, friction: Some(0.3) }]
}

const BEAMS: [Beam; 6] =
    [Beam::Hinged(1.0), Beam::Hinged(2.0), Beam::Hinged(4.0), Beam::Hinged(8.0), Beam::Hinged(12.0), Beam::Cantilever];

/// As EI is the relaxed stiffness, swings are the faster for the loss by (2ζ/π) ln(ω/ω₀) above ω₀ =
/// 0.63 rad/s.
#[test]
fn a_beam_rings_down_by_its_damping_ratio_in_bending_at_every_frequency() {
    for model in [Model::Fem, Model::MassSpring] {
        ring_down_in_bending_by(model);
    }
}

fn ring_down_in_bending_by(model: Model) {
    for ratios in [[0.005, 0.005], [0.02, 0.02], [0.0, 0.02], [0.05, 0.01]] {
        for beam in BEAMS {
            let [_, ratio] = ratios;
            let Ring { omega, decay } = rings(model, beam, ratios, &[]);
            let (found, faster) = (decay / omega / ratio, omega / beam.omega() - 1.0);
            let stiffened = 2.0 * ratio / std::f64::consts::PI * (beam.omega() / 0.628).ln();
            println!(
                "{model}, ratios {ratios:?}, {beam:?}, {:.2} rad/s: {found:.3} of what was asked, faster by {faster:.4} ({stiffened:.4})",
                beam.omega()
            );
            assert!((found - 1.0).abs() < 0.2, "{model}: {found} of a damping ratio of {ratio}: {beam:?}");
        }
    }
}

/// A cable near something had a viscous loss of 1 ms in bending: at 449 rad/s 22 % of critical in
/// place of 2 %.
#[test]
fn a_stiff_cable_swings_alike_beside_a_post_that_it_never_touches() {
    for ratios in [[0.02, 0.02], [0.0, 0.0]] {
        for beam in BEAMS {
            let [alone, beside] = [vec![], post()].map(|obstacles| rings(Model::Fem, beam, ratios, &obstacles));
            let [a, b] = [alone, beside].map(|ring| ring.decay / ring.omega);
            println!("ratio {}, {beam:?}: damped by {a:.5} alone, {b:.5} beside a post", ratios[1]);
            // Steps themselves take 6e-5 of critical where an obstacle is near.
            assert!((a - b).abs() < 0.05 * ratios[1] + 1e-4, "{beam:?}: {a} alone, {b} beside a post");
            // Masses are lumped where an obstacle is near, which swings too slowly by the order b².
            let lumped = beam.wave().powi(2) / (48.0 * 48.0 * 12.0);
            assert!((alone.omega / beside.omega - 1.0).abs() < lumped + 1e-3, "{beam:?}: {alone:?}, {beside:?}");
        }
    }
}
