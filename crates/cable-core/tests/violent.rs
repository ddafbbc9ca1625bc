//! These tests are of violent motion: cables thrown about over random ground, beams and posts,
//! dropped, let go at an end, and torn. Which laws are broken is counted in every output step.
//! Asked: no figure that is no number, nothing inside anything, no friction beyond its cone, no
//! energy said to come from nowhere, and less than one step in a thousand that stops. Torn cables
//! are counted by themselves.
//!
//! All 600 scenes: `cargo test --locked -p cable-core --test violent -- --ignored --nocapture`
//! (five minutes); `FROM=100 TO=200` takes some of them, `TELL=friction NODES=1` tells what was
//! found of a law, `EDIT=3` makes all edits of one kind.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;
mod momentum_balance;

use std::collections::BTreeMap;

use cable_core::answer_verifier::Law;
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::WarningKind;
use cable_core::{Model, Settings, Simulation};

use self::dice::Dice;

/// Rough ground, up to two beams and two posts in the air, a cable above them: held at both ends,
/// let go at one or both, or thrown about by an end.
fn scene(number: u64) -> Scene {
    let mut dice = Dice(number.wrapping_mul(0x1000_0001) + 7);
    let mut scene = catalog::hanging_span();
    let rough = dice.within(0.0, 0.5);
    let points_m = (0..=80).map(|k| [-20.0 + 0.5 * f64::from(k), dice.within(-rough, rough)]).collect();
    let mut rub = || Some(dice.within(0.0, 1.0));
    let mut obstacles =
        vec![Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: rub() }];
    let friction = [rub(), rub(), rub(), rub()];
    for (k, friction) in friction.into_iter().enumerate() {
        if dice.unit() < 0.4 {
            continue;
        }
        let at = [-3.0 + 1.8 * k as f64 + dice.within(-0.3, 0.3), dice.within(0.9, 1.7)];
        let shape = if k % 2 == 0 {
            let (b, h) = (dice.within(0.03, 0.6), dice.within(0.03, 0.3));
            Shape::Polygon { points_m: vec![at, [at[0] + b, at[1]], [at[0] + b, at[1] + h], [at[0], at[1] + h]] }
        } else {
            Shape::Circle { center_m: at, radius_m: dice.within(0.03, 0.3) }
        };
        obstacles.push(Obstacle { name: format!("thing {k}"), shape, friction });
    }
    scene.obstacles = obstacles;
    let c = &mut scene.cables[0];
    c.length_m = dice.within(8.2, 13.0);
    c.axial_stiffness_n = 10f64.powf(dice.within(4.0, 7.0));
    c.segments = Some(dice.within(32.0, 120.0) as usize);
    // Every third cable breaks where it is pulled hard.
    let strength = if dice.unit() < 0.33 { dice.within(300.0, 3000.0) } else { 1e12 };
    (c.breaking_tension_n, c.service_tension_n) = (strength, strength);
    let mut ends = [Support::fixed("left", [-4.0, 3.0]), Support::fixed("right", [4.0, 3.0])];
    for end in &mut ends {
        let kind = dice.unit();
        if kind < 0.3 {
            end.release_s = Some(dice.within(0.05, 0.6));
        } else if kind < 0.75 {
            let home = end.at_m.expect("a fixed end");
            let knots = 5;
            let mut points_m = vec![home];
            points_m.extend((1..knots).map(|_| [home[0] + dice.within(-1.5, 1.5), dice.within(2.2, 4.5)]));
            let quick = dice.within(0.12, 0.6);
            end.motion = Some(Motion { times_s: (0..knots).map(|k| quick * k as f64).collect(), points_m });
        }
    }
    assert!(ends.iter().all(|e| e.kind == SupportKind::Fixed));
    c.supports = ends.into();
    scene
}

/// The same with a bending stiffness.
fn stiff_scene(number: u64) -> Scene {
    let mut scene = scene(number);
    let mut dice = Dice(number.wrapping_mul(0x3000_0005) + 5);
    scene.cables[0].bending_stiffness_n_m2 = 10f64.powf(dice.within(-2.0, 1.5));
    scene
}

/// The faults found in a campaign.
#[derive(Debug, Default)]
struct Found {
    steps: usize,
    /// Edits, and those that were refused.
    edits: usize,
    refused: Vec<String>,
    halved: usize,
    broke: usize,
    /// First rests that were not found.
    no_rest: Vec<String>,
    /// Steps that stopped.
    stopped: Vec<String>,
    /// Answers with a figure that is no number.
    no_number: usize,
    /// Output steps in which a law was broken, by law, and the worst of each.
    broken: BTreeMap<String, (usize, f64, String)>,
    /// Momentum that came from nowhere in an output step, of the greatest impulse, and where.
    imbalance: Vec<(f64, String)>,
    /// Steps that moved without an account of momentum.
    no_account: usize,
    /// Steps told to have energy from nowhere.
    grown: Vec<String>,
}

const RATE: f64 = 240.0;

/// Time between two edits of a scene, s.
const EDITED_EVERY_S: f64 = 0.2;

/// Random edits, or those of one kind.
struct Edits {
    dice: Dice,
    only: Option<usize>,
}

/// The scene after a random edit: a length, stiffness, density, friction, an end, the temperature,
/// the number of bars, the bending stiffness, an obstacle that goes, comes or moves; None if it
/// cannot be.
fn edited(scene: &Scene, Edits { dice, only }: &mut Edits) -> Option<Scene> {
    let mut scene = scene.clone();
    let cable = &mut scene.cables[0];
    let which = (dice.unit() * 11.0) as usize;
    let which = only.unwrap_or(which);
    if std::env::var("TELL").is_ok_and(|t| t == "edits") {
        println!("edit {which} of {:?} N m²", cable.bending_stiffness_n_m2);
    }
    match which {
        0 => cable.length_m *= dice.within(0.93, 1.1),
        1 => cable.axial_stiffness_n *= 10f64.powf(dice.within(-0.3, 0.3)),
        2 => cable.linear_density_kg_per_m *= dice.within(0.7, 1.4),
        3 => cable.friction = dice.within(0.0, 1.0),
        4 => {
            let end = cable.supports.get_mut(dice.within(0.0, 2.0) as usize)?;
            let at_m = end.at_m.as_mut().filter(|_| end.motion.is_none())?;
            (at_m[0], at_m[1]) = (at_m[0] + dice.within(-0.4, 0.4), at_m[1] + dice.within(-0.4, 0.4));
        }
        5 => {
            cable.thermal_expansion_per_k = 2e-5;
            scene.environment.temperature_change_k = dice.within(-40.0, 40.0);
        }
        6 => {
            let last = scene.obstacles.len().checked_sub(1).filter(|last| *last > 0)?;
            scene.obstacles.remove(last);
        }
        7 => cable.segments = Some(dice.within(20.0, 150.0) as usize),
        8 => cable.bending_stiffness_n_m2 = [0.0, 0.01, 0.3, 3.0, 10.0][(dice.unit() * 5.0) as usize],
        9 => {
            let shape = Shape::Circle { center_m: [dice.within(-3.0, 3.0), 6.0], radius_m: 0.2 };
            scene.obstacles.push(Obstacle { name: "another".to_owned(), shape, friction: None });
        }
        _ => {
            let by = [dice.within(-0.02, 0.02), dice.within(-0.02, 0.02)];
            match &mut scene.obstacles.last_mut()?.shape {
                Shape::Circle { center_m, .. } => {
                    (center_m[0], center_m[1]) = (center_m[0] + by[0], center_m[1] + by[1]);
                }
                Shape::Polygon { points_m } => {
                    points_m.iter_mut().for_each(|p| (p[0], p[1]) = (p[0] + by[0], p[1] + by[1]))
                }
                _ => return None,
            }
        }
    }
    scene.validate().is_ok().then_some(scene)
}

fn run(number: u64, seconds: f64, found: &mut Found) {
    run_with((number, scene(number)), seconds, None, found);
}

/// Runs a scene, with random edits on the way if there are dice for them.
fn run_with((number, scene): (u64, Scene), seconds: f64, mut edits: Option<Edits>, found: &mut Found) {
    let mut sim = Simulation::with_settings(scene, Model::Fem, Settings::default()).expect("a sound scene");
    if let Err(e) = sim.settle() {
        found.no_rest.push(format!("{number}: {e}"));
        return;
    }
    let mut before: Option<[f64; 2]> = None;
    for step in 0..(seconds * RATE) as usize {
        found.steps += 1;
        if step > 0
            && step % (EDITED_EVERY_S * RATE) as usize == 0
            && let Some(edits) = &mut edits
            && let Some(scene) = edited(sim.scene(), edits)
        {
            match sim.with_scene(scene, Settings::default()) {
                Ok(next) => (sim, before, found.edits) = (next, None, found.edits + 1),
                // A broken cable has no other length.
                Err(e) => found.refused.push(format!("{number} at step {step}: {e}")),
            }
        }
        let stop = sim.step(1.0 / RATE);
        let answer = sim.solution();
        if let Err(e) = stop {
            found.stopped.push(format!("{number} at step {step}: {e}"));
            break;
        }
        found.halved += answer.cost.halved_steps;
        let grown = answer.warnings.iter().filter(|w| w.kind == WarningKind::EnergyGrows);
        found.grown.extend(grown.map(|w| format!("{number} at step {step}: {w}")));
        let cable = &answer.cables[0];
        match &cable.momentum {
            Some(account) => {
                let part = momentum_balance::imbalance(account);
                found.imbalance.push((part, format!("scene {number} step {step}: {account:?}")));
                if cable.breaks.is_empty()
                    && let Some(before) = before
                {
                    assert_eq!(before, account.before_kg_m_per_s, "scene {number} step {step}");
                }
            }
            None => found.no_account += usize::from(cable.assumptions.inertia),
        }
        before = cable.momentum.map(|a| a.after_kg_m_per_s);
        let sound = |n: &cable_core::solution::Node| n.x_m.is_finite() && n.y_m.is_finite() && n.tension_n.is_finite();
        found.no_number += usize::from(!cable.nodes.iter().all(sound));
        for f in answer.verification.iter().flat_map(|v| &v.findings) {
            let torn = if cable.breaks.is_empty() { "" } else { " (torn)" };
            let entry = found.broken.entry(format!("{}{torn}", f.law.name())).or_insert((0, 0.0, String::new()));
            entry.0 += 1;
            let over = f.value / if f.limit > 0.0 { f.limit } else { 1.0 };
            if over > entry.1 {
                (entry.1, entry.2) = (over, format!("scene {number} step {step}: {f}"));
            }
            if std::env::var("TELL").is_ok_and(|t| f.law.name().starts_with(&t)) {
                println!("scene {number} step {step}: {f}");
                if std::env::var("NODES").is_ok() {
                    for n in cable.nodes.iter().filter(|n| (n.arc_length_m - f.arc_length_m).abs() < 0.4) {
                        println!("    s {:.4} at {:.4} {:.4} T {:.2}", n.arc_length_m, n.x_m, n.y_m, n.tension_n);
                    }
                    for c in &cable.contacts {
                        println!(
                            "    {} s {:.4} [{:.4} {:.4}] N {:.4} F {:.4} {:?} turn {:.2} T {:.3} {:.3} samples {}",
                            c.obstacle,
                            c.arc_length_m,
                            c.begins_m,
                            c.ends_m,
                            c.normal_n,
                            c.friction_n,
                            c.state,
                            c.turn_deg,
                            c.tension_before_n,
                            c.tension_after_n,
                            c.samples.len()
                        );
                    }
                }
            }
        }
    }
    found.broke += usize::from(!sim.solution().cables[0].breaks.is_empty());
}

fn tell(found: &Found) {
    println!(
        "{} steps, {} halved, {} scenes broke, {} without a first rest, {} stopped, {} answers with no number",
        found.steps,
        found.halved,
        found.broke,
        found.no_rest.len(),
        found.stopped.len(),
        found.no_number
    );
    for line in found.no_rest.iter().chain(&found.stopped) {
        println!("  {line}");
    }
    println!("{} steps told to have energy from nowhere", found.grown.len());
    let scene = |line: &str| line.split(' ').next().map(str::to_owned);
    let mut lines: Vec<&String> = found.grown.iter().collect();
    lines.dedup_by_key(|line| scene(line));
    for line in lines {
        println!("  {line}");
    }
    println!("{} steps that move without an account of momentum", found.no_account);
    momentum_balance::tell_imbalance(&found.imbalance);
    for (law, (count, over, worst)) in &found.broken {
        println!("  {law}: {count} output steps, worst {over:.2} times what is let pass: {worst}");
    }
}

fn campaign(scenes: std::ops::Range<u64>, seconds: f64) -> Found {
    let mut found = Found::default();
    for number in scenes {
        run(number, seconds, &mut found);
    }
    tell(&found);
    found
}

/// Output steps in which a law was broken, torn cables counted in.
fn count(found: &Found, law: Law) -> usize {
    found.broken.iter().filter(|(name, _)| name.starts_with(law.name())).map(|(_, b)| b.0).sum()
}

#[test]
fn ten_violent_scenes_obey_the_laws() {
    let found = campaign(0..10, 1.0);
    assert!(found.no_number == 0 && count(&found, Law::Penetration) == 0 && found.stopped.is_empty(), "{found:?}");
    assert!(found.no_rest.len() <= 1 && found.grown.is_empty(), "{found:?}");
}

/// A gap had come below the rounding of its coordinates, and the step was taken for balanced with
/// 2e11 N of contact that nothing held: 28 steps of a contact's impulse of up to 5e8 N s.
#[test]
fn no_step_is_balanced_by_a_gap_lost_in_rounding() {
    let mut found = Found::default();
    run(485, 1.75, &mut found);
    tell(&found);
    let worst = found.imbalance.iter().map(|i| i.0).fold(0.0, f64::max);
    assert!(found.stopped.is_empty() && worst < 1e-3, "{worst} {:?}", found.stopped);
}

/// A cable lay round a post so slack that it hung from it in places: friction that was said to come
/// from there made -inf N of 1.2 N, and moved the cable into the post.
#[test]
fn issue_016_a_slack_wrap_has_a_tension() {
    let mut found = Found::default();
    run(20_387, 1.5, &mut found);
    assert!(found.no_number == 0 && count(&found, Law::Finite) == 0, "{:?}", found.broken);
    assert_eq!(count(&found, Law::Penetration), 0, "{:?}", found.broken);
}

/// For one frame the report had 4e11 N on a post that a cable was whirled round, and the cable in
/// it (see `weighted_capstan.rs`).
#[test]
fn issue_016_a_whirled_wrap_has_the_tension_of_its_ends() {
    let mut found = Found::default();
    run(30_540, 1.5, &mut found);
    assert_eq!(count(&found, Law::Penetration), 0, "{:?}", found.broken);
    assert!(found.grown.is_empty(), "{:?}", found.grown.first());
}

/// A cable that is whirled round a post is slack there now and then. The loss of its slack bars
/// pushed, and friction was reckoned from that, up to 132 N beyond its cone in 111 of 71 714 steps.
/// Later it was reckoned where only the weight beside a mark pulled (30002: 1.5 N beyond its cone).
#[test]
fn issue_016_slack_wraps_rub_within_the_cone() {
    for scene in [3033, 3070, 3127, 3147, 30_002] {
        let mut found = Found::default();
        run(scene, 2.0, &mut found);
        assert_eq!(count(&found, Law::Friction), 0, "{scene}: {:?}", found.broken);
    }
}

/// A fold that was whipped round the edge of a beam was found under it at the end of a step: the
/// undamped Newton had strayed into another valley, above the start of the step, and the cable had
/// 352 J in place of 47.
#[test]
fn issue_016_no_step_ends_above_its_start() {
    let mut found = Found::default();
    run(20_330, 1.75, &mut found);
    assert!(found.grown.is_empty() && found.stopped.is_empty(), "{:?} {:?}", found.grown.first(), found.stopped);
}

/// Edits of a cable that is thrown about break no law.
#[test]
fn edited_scenes_obey_the_laws() {
    edited_campaign(0..8, 1.0, None);
}

/// A torn piece fell through the ground that the whole cable could not reach, 4.7 m deep, after an
/// obstacle elsewhere had been taken away.
#[test]
fn issue_016_a_torn_piece_keeps_its_ground_after_an_edit() {
    let mut scene = scene(11);
    let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, Settings::default()).unwrap();
    sim.settle().unwrap();
    for step in 0..360 {
        if [48, 96, 144].contains(&step) && scene.obstacles.len() > 1 {
            scene.obstacles.pop();
            sim = sim.with_scene(scene.clone(), Settings::default()).unwrap();
        }
        sim.step(1.0 / RATE).unwrap();
        let found = sim.solution().verification.unwrap().findings;
        assert!(found.iter().all(|finding| finding.law != Law::Penetration), "step {step}: {found:?}");
    }
    assert!(!sim.solution().cables[0].breaks.is_empty(), "it is torn");
}

/// Random edits of these scenes, or those of one kind.
fn campaign_of_edits(scenes: impl IntoIterator<Item = (u64, Scene)>, seconds: f64, only: Option<usize>) -> Found {
    let mut found = Found::default();
    for (number, scene) in scenes {
        run_with((number, scene), seconds, Some(Edits { dice: Dice(number + 99), only }), &mut found);
    }
    tell(&found);
    println!("{} edits, {} refused", found.edits, found.refused.len());
    for line in found.refused.iter().filter(|line| !line.contains("broken")) {
        println!("  {line}");
    }
    assert!(found.no_number == 0 && count(&found, Law::Penetration) == 0, "{:?}", found.broken);
    assert!(found.grown.is_empty(), "{:?}", found.grown.first());
    let worst = found.imbalance.iter().map(|i| i.0).fold(0.0, f64::max);
    assert!(worst < 1e-4, "momentum from nowhere: {worst:e}");
    found
}

fn edited_campaign(scenes: impl IntoIterator<Item = u64>, seconds: f64, only: Option<usize>) {
    let found = campaign_of_edits(scenes.into_iter().map(|number| (number, scene(number))), seconds, only);
    assert!(found.edits > 0 && found.no_rest.is_empty(), "{} edits, {:?}", found.edits, found.no_rest);
    assert!(found.stopped.is_empty(), "{:?}", found.stopped);
    assert_eq!(count(&found, Law::Friction), 0, "{:?}", found.broken);
}

/// The momentum that nodes gave to obstacles where an edit divided a stiff cable anew was counted
/// in the next step: 1.1e-3 of its impulse.
#[test]
fn issue_016_the_momentum_that_an_edit_gives_is_no_impulse_of_obstacles() {
    edited_campaign(3495..3496, 1.6, None);
}

/// While the length of a cable changed, friction at corners where it stuck was reported up to 5.4 N
/// beyond its cone: forces on material were taken for forces on the cable, which has another
/// length.
#[test]
fn issue_016_friction_is_within_its_cone_while_a_length_changes() {
    edited_campaign([3501, 3618], 2.0, None);
}

/// The kind of edit that changes the bending stiffness.
const BENDING: usize = 8;

/// Cables that got a greater bending stiffness than one too small to see kept the hinges on rounds
/// that their nodes had been, which let go of 18 to 39 J at once. One that lost its stiffness was
/// pulled with 144 kN for 46 N (4440).
#[test]
fn issue_016_a_bending_stiffness_that_changes_obeys_the_laws() {
    edited_campaign([5336, 5359, 5471, 5493], 2.0, Some(BENDING));
    edited_campaign([4440], 1.2, None);
}

/// Cables that got a bending stiffness, of which the bars were slack or stretched by the mesh on
/// which they were laid (14 kN for 49 N), or that lost nodes on the way (262 J in a step), were
/// told to have energy from nowhere. So were those that kept all but the first of their nodes on a
/// round, where they bent without a moment (4009). One lay 14 mm inside an obstacle (2346), two
/// stopped (2350 and 2555).
#[test]
fn issue_016_a_cable_that_gets_a_bending_stiffness_obeys_the_laws() {
    edited_campaign([2001, 2069, 2106, 2346, 2350, 2555, 4009], 2.0, None);
}

#[test]
#[ignore = "minutes: random edits of violent scenes, of EDIT=kind, of STIFF=1 cables"]
fn many_edited_scenes_obey_the_laws() {
    let number = |name: &str, or: u64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(or);
    let only = std::env::var("EDIT").ok().and_then(|kind| kind.parse().ok());
    let scene = if std::env::var("STIFF").is_ok() { stiff_scene } else { scene };
    let found = campaign_of_edits((number("FROM", 0)..number("TO", 200)).map(|k| (k, scene(k))), 2.0, only);
    assert!((found.stopped.len() as f64) <= 1e-3 * found.steps as f64, "{:?}", found.stopped);
    assert!((count(&found, Law::Friction) as f64) < 1e-4 * found.steps as f64, "{:?}", found.broken);
}

#[test]
#[ignore = "five minutes: 600 violent scenes"]
fn six_hundred_violent_scenes_obey_the_laws() {
    let number = |name: &str, or: u64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(or);
    check_all(&campaign(number("FROM", 0)..number("TO", 600), 2.0));
}

fn check_all(found: &Found) {
    assert!(found.no_number == 0 && count(found, Law::Penetration) == 0, "{:?}", found.broken);
    assert!(found.grown.is_empty(), "{:?}", found.grown.first());
    assert!((found.stopped.len() as f64) < 1e-3 * found.steps as f64, "{:?}", found.stopped);
    assert_eq!(count(found, Law::Friction) + count(found, Law::Momentum), 0, "{:?}", found.broken);
    assert!(found.no_rest.is_empty(), "{:?}", found.no_rest);
}

/// A stiff cable that trembled by less than its nodes may move was put to sleep as it was, with
/// 0.03 N of 35 N out of balance.
#[test]
fn issue_016_a_cable_that_falls_asleep_is_in_balance() {
    let mut found = Found::default();
    for number in [27, 56, 91] {
        run_with((number, stiff_scene(number)), 0.6, None, &mut found);
    }
    assert_eq!(count(&found, Law::Balance), 0, "{:?}", found.broken);
    check_all(&found);
}

/// The contact of a stiff cable with an edge went on along the line of the edge where that had
/// ended: wholly beyond a beam (105), and from the top of a hill into the air (173). The checker
/// saw it, so that there was no answer.
#[test]
fn issue_016_a_stiff_cable_lies_on_no_edge_beyond_its_end() {
    for number in [105, 173] {
        let mut sim = Simulation::with_settings(stiff_scene(number), Model::Fem, Settings::default()).unwrap();
        let found = sim.settle().map(|answer| answer.verification.unwrap().findings);
        assert_eq!(found.map_err(|e| e.to_string()), Ok(Vec::new()), "{number}");
    }
}

/// Elements of the elastica that turn far were drawn by straight lines longer than their arcs, by
/// up to 0.2 %, because the forces at their ends alone had been asked for: the checker refused the
/// rest (four of 900 scenes).
#[test]
fn issue_016_a_stiff_cable_is_drawn_as_long_as_it_is() {
    for number in [32, 438, 805] {
        let mut sim = Simulation::with_settings(stiff_scene(number), Model::Fem, Settings::default()).unwrap();
        let found = sim.settle().map(|answer| answer.verification.unwrap().findings);
        assert_eq!(found.map_err(|e| e.to_string()), Ok(Vec::new()), "{number}");
    }
}

#[test]
#[ignore = "minutes: 300 violent scenes of stiff cables"]
fn many_stiff_violent_scenes_obey_the_laws() {
    let number = |name: &str, or: u64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(or);
    let mut found = Found::default();
    for number in number("FROM", 0)..number("TO", 300) {
        run_with((number, stiff_scene(number)), 2.0, None, &mut found);
    }
    tell(&found);
    check_all(&found);
    assert_eq!(count(&found, Law::Balance), 0, "{:?}", found.broken);
}
