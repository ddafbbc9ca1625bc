//! These tests compare the error that `fem` states with answers that have none: free spans of every
//! kind beside the catenary.
//!
//! `FEM_SPANS=1000 cargo test -p cable-core --test fem_estimate -- --nocapture` prints what came of
//! more of them; `FEM_FIRST` says from which.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};
use cable_core::solution::{CableSolution, WarningKind};
use cable_core::{Load, Model, Settings, Simulation, Solution};

use self::dice::Dice;

fn number(name: &str, other: u64) -> u64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(other)
}

/// A free span: 0.1 m to 10 km, 0.9 to 30 times its chord, level to plumb, EA from 1e3 to 1e9 times
/// its weight, here and there with wind, warmth, point loads, and a mesh that is given.
fn span(case: u64) -> (Scene, Settings) {
    let mut dice = Dice(0x5a1e_0000 + case);
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 9.80665;
    scene.environment.temperature_change_k = 0.0;
    scene.loads.clear();
    let chord = dice.log(0.1, 1e4);
    let slope = if dice.unit() < 0.2 { dice.within(1.4, 1.57) } else { dice.within(-1.2, 1.2) };
    let end = [chord * f64::cos(slope), chord * f64::sin(slope)];
    let ratio = match case % 4 {
        0 => 1.0 + dice.log(1e-6, 1e-2),
        1 => 1.0 + dice.log(1e-2, 1.0),
        2 => dice.log(2.0, 30.0),
        _ => 1.0 - dice.log(1e-5, 0.05),
    };
    let density = dice.log(0.01, 50.0);
    let weight = density * 9.80665 * chord * ratio;
    if dice.unit() < 0.3 {
        let size = 0.5 * density * 9.80665;
        scene.environment.wind_n_per_m = [dice.within(-size, size), dice.within(-size, size)];
    }
    let c = &mut scene.cables[0];
    c.length_m = chord * ratio;
    c.linear_density_kg_per_m = density;
    c.axial_stiffness_n = (weight * dice.log(1e3, 1e9)).clamp(1.0, 1e12);
    (c.bending_stiffness_n_m2, c.thermal_expansion_per_k) = (0.0, 0.0);
    (c.service_tension_n, c.breaking_tension_n, c.segments) = (1e15, 1e15, None);
    c.diameter_m = 1e-3 * chord;
    c.route_m.clear();
    c.supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", end)];
    if dice.unit() < 0.3 {
        let (name, at) = (c.name.clone(), dice.within(0.1, 0.9) * c.length_m);
        let force_n = [dice.within(-1.0, 1.0) * weight, -dice.within(0.0, 2.0) * weight];
        scene.loads.push(Load {
            cable: name,
            arc_length_m: at,
            force_n: Some(force_n),
            times_s: vec![],
            forces_n: vec![],
        });
    }
    let tolerance = [1e-3, 1e-4, 1e-5][(case % 3) as usize];
    let segments = (dice.unit() < 0.3).then(|| dice.within(8.0, 60.0) as usize);
    (scene, Settings { tolerance, segments, ..Settings::default() })
}

fn settle(scene: &Scene, model: Model, settings: Settings) -> Result<Solution, String> {
    let mut sim = Simulation::with_settings(scene.clone(), model, settings).map_err(|e| e.to_string())?;
    sim.settle().map_err(|e| e.to_string())
}

/// Greatest error of a force on a support, in parts of the greatest tension.
fn error(found: &CableSolution, exact: &CableSolution) -> f64 {
    let most = exact.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max);
    let off = found
        .supports
        .iter()
        .zip(&exact.supports)
        .map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).abs().max((a.reaction_y_n - b.reaction_y_n).abs()));
    off.fold(0.0, f64::max) / most
}

#[test]
fn every_force_of_a_free_span_is_within_what_is_said() {
    let (first, cases) = (number("FEM_FIRST", 0), number("FEM_SPANS", 200));
    let (mut wrong, mut loose, mut coarse, mut refused) = (Vec::new(), 0, 0, 0);
    for case in first..first + cases {
        let (scene, settings) = span(case);
        let exact = match settle(&scene, Model::Catenary, settings) {
            Ok(exact) => exact,
            Err(e) => panic!("{case}: {e}"),
        };
        let found = match settle(&scene, Model::Fem, settings) {
            Ok(found) => found,
            Err(e) => {
                println!("{case}: refused: {e}");
                refused += 1;
                continue;
            }
        };
        let said = found.cables[0].error_estimate.unwrap_or(f64::NAN);
        let off = error(&found.cables[0], &exact.cables[0]);
        // Two answers, each with its rounding.
        if !(off <= said) {
            if std::env::var("FEM_SHOW").is_ok() {
                println!("{case}: {}", found.cables[0].nodes.len());
                found.cables[0]
                    .supports
                    .iter()
                    .zip(&exact.cables[0].supports)
                    .for_each(|(a, b)| println!("{a:?}\n{b:?}"));
                println!("{}", scene.to_toml());
            }
            wrong.push((case, off, said));
        }
        loose += usize::from(said > 10.0 * off && said > 1e-9);
        let warned = found.warnings.iter().any(|w| w.kind == WarningKind::Accuracy);
        assert!(said <= settings.tolerance || warned, "{case}: {said:.1e} and no warning");
        coarse += usize::from(said > settings.tolerance && settings.segments.is_none());
    }
    println!(
        "{cases}: {} outside what they say, {loose} say ten times too much, {coarse} coarser than asked, {refused} refused: {wrong:.1?}",
        wrong.len()
    );
    assert!(wrong.is_empty() && refused == 0, "{wrong:?}");
}

/// A cable in contact: on a bed (level or sloped, straight or with corners), over a post or over
/// the corner of a block; friction 0 to 1, taut to a twentieth longer than its way.
fn in_contact(case: u64) -> Scene {
    let mut dice = Dice(0x00be_d000 + 31 * case);
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 9.80665;
    (scene.environment.temperature_change_k, scene.environment.wind_n_per_m) = (0.0, [0.0, 0.0]);
    scene.loads.clear();
    let size = dice.log(2.0, 60.0);
    let friction = Some(if dice.unit() < 0.3 { 0.0 } else { dice.within(0.05, 1.0) });
    let density = dice.log(0.1, 3.0);
    let diameter = 0.004;
    let r = 0.5 * diameter;
    let (shape, route) = match case % 4 {
        // One end on a bed, the other above it.
        0 => {
            let slope = dice.within(-0.1, 0.1);
            let y = |x: f64| slope * x;
            let up = r * (1.0 + slope * slope).sqrt();
            let b = [size, y(size) + size * dice.log(0.005, 0.5)];
            let line = vec![[-size, y(-size)], [3.0 * size, y(3.0 * size)]];
            (Shape::Terrain { points_m: line }, vec![[0.0, up], b])
        }
        // Both above it.
        1 => {
            let rise = dice.log(0.01, 0.1) * size;
            let bump = dice.within(0.0, 0.5) * rise;
            let points_m = vec![[-size, 0.0], [0.4 * size, bump], [0.5 * size, 1.2 * bump], [2.0 * size, 0.0]];
            (Shape::Terrain { points_m }, vec![[0.0, rise + bump], [size, dice.within(0.5, 2.0) * rise + bump]])
        }
        2 => {
            let radius_m = dice.log(0.01, 0.1) * size;
            let at = [dice.within(0.3, 0.7) * size, 0.0];
            let top = [at[0], radius_m + r];
            let shape = Shape::Circle { center_m: at, radius_m };
            (shape, vec![[0.0, -dice.within(0.0, 0.3) * size], top, [size, -dice.within(0.0, 0.3) * size]])
        }
        _ => {
            let (left, right) = (dice.within(0.3, 0.45) * size, dice.within(0.5, 0.7) * size);
            let low = -0.4 * size;
            let points_m = vec![[left, low], [right, low], [right, 0.0], [left, 0.0]];
            let ends = [-dice.within(0.02, 0.3) * size, -dice.within(0.02, 0.3) * size];
            (Shape::Polygon { points_m }, vec![[0.0, ends[0]], [left, r], [right, r], [size, ends[1]]])
        }
    };
    scene.obstacles = vec![Obstacle { name: "thing".to_owned(), shape, friction }];
    let way: f64 = route.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
    let c = &mut scene.cables[0];
    c.length_m = way * (1.0 + dice.log(1e-4, 0.05));
    (c.linear_density_kg_per_m, c.diameter_m) = (density, diameter);
    c.axial_stiffness_n = dice.log(1e4, 1e8);
    (c.bending_stiffness_n_m2, c.thermal_expansion_per_k) = (0.0, 0.0);
    (c.service_tension_n, c.breaking_tension_n, c.segments) = (1e15, 1e15, None);
    c.supports = vec![Support::fixed("A", route[0]), Support::fixed("B", route[route.len() - 1])];
    c.route_m = route;
    scene
}

/// Contact scenes by number: how many say an error, how many of those lie within it, how many are
/// coarser than asked.
fn contact_campaign(first: u64, cases: u64) -> [usize; 5] {
    let [mut compared, mut said_so, mut within, mut met, mut refused] = [0; 5];
    let segments = std::env::var("FEM_SEGMENTS").ok().and_then(|v| v.parse().ok());
    let settings = Settings { segments, ..Settings::default() };
    for case in first..first + cases {
        let scene = in_contact(case);
        let Ok(exact) = settle(&scene, Model::Spans, settings) else { continue };
        let found = match settle(&scene, Model::Fem, settings) {
            Ok(found) => found,
            Err(e) => {
                println!("{case}: refused: {e}");
                refused += 1;
                continue;
            }
        };
        compared += 1;
        let off = error(&found.cables[0], &exact.cables[0]);
        let Some(said) = found.cables[0].error_estimate else {
            println!("{case}: says nothing, {off:.1e}");
            continue;
        };
        said_so += 1;
        within += usize::from(off <= said);
        met += usize::from(off <= settings.tolerance);
        if !(off <= said) || std::env::var("FEM_SHOW").is_ok() {
            println!("{case}: {off:.1e}, says {said:.1e}, {} nodes", found.cables[0].nodes.len());
        }
    }
    println!("{compared} compared: {said_so} say an error, {within} within it, {met} within 1e-3; {refused} refused");
    [compared, said_so, within, met, refused]
}

#[test]
fn the_error_of_a_cable_in_contact_is_said() {
    let [compared, said, within, _, refused] = contact_campaign(number("FEM_FIRST", 0), number("FEM_CONTACTS", 24));
    // Open: case 22 rests with friction beyond its cone, and is refused for that.
    assert!(refused.saturating_sub(1) * 50 <= compared, "{refused} refused");
    assert_eq!(said, compared);
    assert!(within as f64 >= 0.95 * compared as f64, "{within} of {compared}");
}

/// 300 of them: `cargo test --locked -p cable-core --test fem_estimate -- --ignored --nocapture`.
#[test]
#[ignore = "300 scenes, some seconds"]
fn the_error_of_300_cables_in_contact_is_said() {
    let [compared, said, within, _, refused] = contact_campaign(5000, 300);
    assert!(refused * 50 <= compared && said == compared, "{refused} refused, {said} of {compared} say");
    assert!(within as f64 >= 0.95 * compared as f64, "{within} of {compared}");
}

/// Slack ten times its span: the greatest tension was right to 2e-6, the horizontal force wrong by
/// 1.15e-4 of it.
#[test]
fn a_slack_span_is_refined_until_its_horizontal_force_is_right() {
    let (mut scene, _) = span(1);
    (scene.environment.gravity_m_per_s2, scene.environment.wind_n_per_m) = (10.0, [0.0, 0.0]);
    scene.loads.clear();
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n, c.diameter_m) = (1000.0, 2.0, 5e4, 1e-4);
    c.supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [100.0, 0.0])];
    let settings = Settings { tolerance: 1e-5, ..Settings::default() };
    let [found, exact] = [Model::Fem, Model::Catenary].map(|m| settle(&scene, m, settings).unwrap().cables.remove(0));
    let (off, said) = (error(&found, &exact), found.error_estimate.unwrap());
    assert!(off <= said && said <= 1e-5, "{off:.1e} {said:.1e}");
}

/// A cable on a slope without friction, its hanging end bent in 2 m: 7.81 N at B without a word,
/// where 7.8625 N is right. `fem` finds it no better yet (6.7e-3 off): what it says covers that by
/// far.
#[test]
fn a_cable_on_a_slope_says_its_error() {
    let mut scene = in_contact(0);
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m) = (60.80425040198193, 0.3720217293741137);
    (c.axial_stiffness_n, c.diameter_m) = (54_577_869.393_525_45, 0.002);
    let (a, b) = ([0.0, 0.0], [60.78921234607203, 0.3545806646615981]);
    c.supports = vec![Support::fixed("A", a), Support::fixed("B", b)];
    c.route_m = vec![a, [54.07770275956691, 0.20601900229872488], b];
    let points_m = vec![[-50.0, -0.1914842473277252], [260.789212346072, 0.9925246913917917]];
    scene.obstacles =
        vec![Obstacle { name: "bed".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.0) }];
    let found = settle(&scene, Model::Fem, Settings::default()).unwrap();
    let at_b = &found.cables[0].supports[1];
    let (off, said) =
        ((at_b.reaction_x_n.hypot(at_b.reaction_y_n) - 7.8625).abs() / 7.8625, found.cables[0].error_estimate);
    println!("{off:.1e}, says {said:?}");
    assert!(off <= said.unwrap() && found.warnings.iter().any(|w| w.kind == WarningKind::Accuracy));
}
