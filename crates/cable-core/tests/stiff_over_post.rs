//! A stiff cable that a dead load holds is drawn over a rubbing post without inertia or gravity.
//!
//! In the air ½M²/EI + F·t does not change along the cable. Far from the post M is zero, and on it
//! EI/r: with the far force F₀ the tension where the contact begins is F₀ − EI/2r². The rest of F₀
//! is the shear force there, which the post takes in that point, and which rubs as well; between
//! the two ends of the contact the tension grows as on a capstan.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::{Model, Simulation};
use dice::MmixDice;

/// A cable over a post: radius of the centre line there (m), bending stiffness (N·m²), friction,
/// and the load (N).
struct Post {
    radius: f64,
    stiffness: f64,
    friction: f64,
    load: f64,
    /// The angle of wrap by which it is laid, rad.
    wrap: f64,
}

impl Post {
    fn new(seed: u64) -> Self {
        let mut r = MmixDice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1);
        r.within(0.0, 1.0);
        let (radius, wrap, friction) = (r.within(0.1, 0.6), r.within(0.7, 3.0), r.within(0.1, 0.5));
        let load = r.within(50f64.ln(), 800f64.ln()).exp();
        let stiffness = load * radius * radius * 10f64.powf(r.within(-2.5, 0.0));
        Self { radius, stiffness, friction, load, wrap }
    }

    /// The scene, the end of the cable drawn along its own line.
    fn scene(&self) -> Scene {
        let free = (12.0 * (self.stiffness / self.load).sqrt()).max(1.5);
        let (half, r) = (0.5 * self.wrap, self.radius);
        let end = |side: f64, along: f64| {
            let at = free + along;
            [side * (r * half.sin() + at * half.cos()), r * half.cos() - at * half.sin()]
        };
        let mut scene = catalog::hanging_span();
        scene.environment.gravity_m_per_s2 = 0.0;
        scene.loads.clear();
        let cable = &mut scene.cables[0];
        (cable.length_m, cable.linear_density_kg_per_m, cable.axial_stiffness_n) =
            (2.0 * free + self.wrap * r, 1.0, 1e7);
        (cable.diameter_m, cable.bending_stiffness_n_m2, cable.segments) = (0.02, self.stiffness, None);
        (cable.breaking_tension_n, cable.service_tension_n) = (1e12, 1e12);
        let force_n = Some([-self.load * half.cos(), -self.load * half.sin()]);
        let load = Support { force_n, ..Support::new("load", SupportKind::Load) };
        let mut hand = Support::fixed("hand", end(1.0, 0.0));
        hand.motion = Some(Motion { times_s: vec![0.0, 3.0], points_m: vec![end(1.0, 0.0), end(1.0, 0.3 * free)] });
        let arc = (0..9).map(|k| {
            let (outside, a) = (r / (self.wrap / 18.0).cos(), self.wrap * (f64::from(k) + 0.5) / 9.0 - half);
            [outside * a.sin(), outside * a.cos()]
        });
        cable.route_m = std::iter::once(end(-1.0, 0.0)).chain(arc).chain([end(1.0, 0.0)]).collect();
        cable.supports = vec![load, hand];
        let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: r - 0.01 };
        scene.obstacles = vec![Obstacle { name: "post".into(), shape, friction: Some(self.friction) }];
        scene
    }

    /// The force that draws the cable over a turn (rad), N; None if it hardly lies on the post.
    fn drawing_force(&self, turn: f64) -> Option<f64> {
        let less = 0.5 * self.stiffness / (self.radius * self.radius);
        // Tension, shear force and turn up to the contact, of a far force.
        let end = |far: f64| {
            let tension = far - less;
            (tension, (far * far - tension * tension).sqrt(), (tension / far).acos())
        };
        if self.load <= less {
            return None;
        }
        let (tension, shear, bent) = end(self.load);
        let arc = |far: f64| turn - bent - end(far).2;
        let lacks = |far: f64| {
            let (held, pressed, _) = end(far);
            (tension + self.friction * shear) * (self.friction * arc(far)).exp() - (held - self.friction * pressed)
        };
        let (mut low, mut high) = (self.load, 3.0 * self.load * (self.friction * turn).exp());
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if lacks(middle) > 0.0 { low = middle } else { high = middle }
        }
        (arc(low) > 0.05).then_some(low)
    }
}

/// Of 24 such cables 9 were refused on the way, most by the law of moments on bars too long to show
/// them, and the others were up to 2.1 % off without an estimate.
#[test]
fn issue_016_stiff_cables_are_drawn_over_rubbing_posts() {
    let mut compared = 0;
    for seed in 0..12 {
        let post = Post::new(seed);
        let mut sim = Simulation::new(post.scene(), Model::Auto).unwrap();
        sim.settle().unwrap();
        for _ in 0..60 {
            sim.step_quasi_static(0.05).unwrap_or_else(|e| panic!("{seed}: {e}"));
        }
        let answer = &sim.answers()[0];
        let hand = answer.supports.last().unwrap();
        let pull = hand.reaction_x_n.hypot(hand.reaction_y_n);
        let turn = 0.5 * post.wrap - (-hand.reaction_y_n).atan2(-hand.reaction_x_n);
        let Some(expected) = post.drawing_force(turn) else { continue };
        let stated = answer.errors.support_force_n.unwrap_or_else(|| panic!("{seed}: no estimate"));
        let off = (pull - expected).abs();
        println!("{seed}: {pull:.3} N of {expected:.3} N, {:.1e} of it, stated {stated:.2e} N", off / expected);
        assert!(off <= 1e-3 * expected, "{seed}: {pull} N for {expected} N");
        assert!(off <= stated, "{seed}: {off} N off, {stated} N stated");
        compared += 1;
    }
    assert!(compared >= 8, "{compared}");
}

/// A bar longer than √(EI/T) cannot show the moment beside the end of a contact, and neither can
/// the bars beside it: coarse meshes asked for by hand are answered, with their error.
#[test]
fn issue_016_coarse_meshes_of_stiff_cables_over_posts_are_answered() {
    for seed in 0..6 {
        let post = Post::new(seed);
        let mut scene = post.scene();
        scene.cables[0].segments = Some(40);
        let mut sim = Simulation::new(scene, Model::Fem).unwrap();
        sim.settle().unwrap();
        for _ in 0..60 {
            sim.step_quasi_static(0.05).unwrap_or_else(|e| panic!("{seed}: {e}"));
        }
        assert!(sim.answers()[0].errors.support_force_n.is_some(), "{seed}");
    }
}

/// Beyond a corner over which a cable slips, the bars of a step are multiplied by the factor of
/// friction, and the bends were not: they were too stiff or too soft by it. None of these meshes
/// came through; the finest that did was of 240 bars.
#[test]
fn issue_016_bends_beyond_a_slipping_corner_are_those_of_the_cable() {
    let scene = Scene::from_toml(include_str!("data/stiff_drag_over_box.toml")).unwrap();
    let pulls = |segments: usize| {
        let mut scene = scene.clone();
        scene.cables[0].segments = Some(segments);
        let mut sim = Simulation::new(scene, Model::Fem).unwrap();
        sim.settle().unwrap();
        let pull = |sim: &Simulation| {
            let answer = &sim.answers()[0];
            let hand = answer.supports.last().unwrap();
            (hand.reaction_x_n.hypot(hand.reaction_y_n), answer.errors.support_force_n.unwrap_or(f64::INFINITY))
        };
        let mut pulls = Vec::new();
        for _ in 0..12 {
            sim.step_quasi_static(0.25).unwrap_or_else(|e| panic!("{segments}: {e}"));
            pulls.push(pull(&sim));
        }
        pulls
    };
    let finest = pulls(240);
    for segments in [40, 61, 120] {
        for (k, ((pull, stated), (fine, too))) in pulls(segments).into_iter().zip(&finest).enumerate() {
            println!(
                "{segments} bars, {} s: {pull:.3} ± {stated:.3} N for {fine:.3} ± {too:.3} N",
                0.25 * (k + 1) as f64
            );
            assert!((pull - fine).abs() <= stated + too, "{segments} {k}: {pull} N for {fine} N, {stated} N stated");
        }
    }
}
