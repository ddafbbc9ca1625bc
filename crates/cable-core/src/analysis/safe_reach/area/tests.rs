//! These tests search small maps of safe reach.

use super::*;
use crate::math::Point;
use crate::scene::catalog;
use crate::scene::{Obstacle, Shape};
use std::sync::Arc;

fn look(query: &ReachQuery) -> Area {
    area(query, |_, _| ControlFlow::Continue(())).unwrap()
}

fn query(scene: Scene, corners_m: [Point; 2], spacing_m: f64) -> ReachQuery {
    let support = scene.cables[0].supports.len() - 1;
    ReachQuery { scene, now: None, settings: Settings::default(), cable: 0, support, corners_m, spacing_m, back: false }
}

/// Returns the position of the place nearest to a point, and its tension.
fn place(area: &Area, p: Point) -> (Point, f64) {
    let near = |k: &usize| (vec2(area.at(*k)) - vec2(p)).norm();
    let k = (0..area.most_n.len()).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
    assert!(near(&k) < area.spacing_m, "{p:?} is outside");
    (area.at(k), area.most_n[k])
}

fn block(name: &str, low: Point, high: Point) -> Obstacle {
    let points_m = vec![low, [high[0], low[1]], high, [low[0], high[1]]];
    Obstacle { name: name.to_owned(), shape: Shape::Polygon { points_m }, friction: None }
}

/// 10.8 m of cable from (0, 5) to (9, 0.5) with nothing in its way.
fn free() -> Scene {
    let mut scene = catalog::over_beam();
    scene.obstacles.clear();
    scene
}

#[test]
fn without_anything_to_touch_each_place_is_what_a_cable_laid_there_pulls() {
    let found = look(&query(free(), [[6.0, 0.0], [12.0, 5.0]], 0.75));
    let mut compared = 0;
    for (k, &there_n) in found.most_n.iter().enumerate() {
        let at = found.at(k);
        let far = (at[0] - 0.0).hypot(at[1] - 5.0) / 10.8;
        assert!(!found.guessed[k] || there_n.is_finite());
        if far < 1.0 {
            let mut scene = free();
            scene.cables[0].supports.last_mut().unwrap().at_m = Some(at);
            let pull_n = Simulation::new(scene, Model::Catenary).unwrap().settle().unwrap().max_tension().tension_n;
            // A guessed tension lies between four places that agree to 2 % of the service tension.
            let allowed = if found.guessed[k] { 0.02 * found.service_n } else { 1e-6 * pull_n };
            assert!((there_n - pull_n).abs() < allowed, "{at:?}: {there_n} for {pull_n} N");
            compared += 1;
        } else if far > 1.02 {
            assert!(!there_n.is_finite(), "{at:?}: {there_n} N");
        }
    }
    assert!(compared > 20 && found.guessed.iter().filter(|g| **g).count() < compared / 2, "{compared}");
    assert_eq!(found.start_m, [9.0, 0.5]);
    assert_eq!(place(&found, [9.0, 0.5]).0, [9.0, 0.5], "the start is a place");
}

#[test]
fn ways_go_round_what_is_in_the_way_and_nothing_is_known_of_what_is_shut_in() {
    let mut scene = free();
    scene.cables[0].length_m = 12.5;
    // A box with walls of 0.3 m, and a block right of the start.
    scene.obstacles = vec![
        block("left", [4.0, 0.0], [4.3, 2.0]),
        block("right", [5.7, 0.0], [6.0, 2.0]),
        block("top", [4.0, 1.7], [6.0, 2.0]),
        block("bottom", [4.0, 0.0], [6.0, 0.3]),
        block("stop", [9.4, -1.0], [9.8, 1.6]),
    ];
    scene.cables[0].route_m = vec![[0.0, 5.0], [4.0, 3.0], [8.0, 2.5], [9.0, 0.5]];
    // Walls that are thinner than a grid is wide shut in all the same.
    for spacing_m in [0.5, 0.35, 1.0] {
        let found = look(&query(scene.clone(), [[4.5, 0.0], [10.0, 2.5]], spacing_m));
        assert!(place(&found, [5.0, 1.0]).1.is_nan(), "shut in, {spacing_m} m");
    }
    let found = look(&query(scene, [[4.5, 0.0], [10.0, 2.5]], 0.5));
    assert!(place(&found, [9.5, 0.5]).1.is_nan(), "inside");
    assert!(place(&found, [8.0, 1.0]).1.is_finite());
    let (at, behind_n) = place(&found, [10.0, 0.5]);
    assert!(at[0] > 9.8 && behind_n > place(&found, [9.0, 0.5]).1, "{at:?} {behind_n}");
}

#[test]
fn the_way_back_over_an_edge_pulls_more_than_the_place() {
    let mut scene = free();
    scene.cables[0].friction = 0.5;
    scene.cables[0].length_m = 11.5;
    scene.obstacles = vec![block("beam", [4.0, 3.0], [4.6, 3.4])];
    scene.cables[0].route_m = vec![[0.0, 5.0], [4.3, 3.7], [9.0, 0.5]];
    let there = query(scene, [[7.5, 0.0], [10.0, 1.6]], 0.5);
    let both = look(&ReachQuery { back: true, ..there.clone() });
    let there = look(&there);
    let mut more = 0;
    for (out_n, back_n) in there.most_n.iter().zip(&both.most_n) {
        assert_eq!(out_n.is_finite(), back_n.is_finite(), "{out_n} {back_n}");
        if out_n.is_finite() {
            assert!(*back_n >= out_n * (1.0 - 1e-9), "{out_n} {back_n}");
            more += usize::from(*back_n > 1.02 * out_n);
        }
    }
    assert!(more > there.most_n.len() / 4, "{more} of {}", there.most_n.len());
    let start = place(&both, [9.0, 0.5]).1;
    assert!((start - place(&there, [9.0, 0.5]).1).abs() < 1e-9 * start, "no way, no snag");
}

#[test]
fn it_ends_when_it_is_told_to_and_is_the_same_each_time() {
    let query = query(free(), [[7.0, 0.0], [10.0, 2.0]], 0.5);
    let mut progress = 0;
    let found = area(&query, |_, share| {
        assert!((0.0..=1.0).contains(&share));
        progress += 1;
        if progress < 4 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    assert_eq!(found.unwrap().most_n.iter().filter(|n| !n.is_nan()).count(), 4, "the start and three ways");
    let bits = |a: &Area| a.most_n.iter().map(|n| n.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&look(&query)), bits(&look(&query)));
}

/// An unfinished fine map is filled from a coarse one and marked as guessed; at the end only places
/// between agreeing ones are.
#[test]
fn a_coarse_map_comes_first_and_finer_ones_go_on_from_it() {
    let query = query(free(), [[-2.0, -2.0], [12.0, 6.0]], 0.5);
    let mut first: Option<(Area, f64)> = None;
    let mut shares = vec![0.0];
    let found = area(&query, |so_far, share| {
        shares.push(share);
        let count = so_far.most_n.iter().filter(|n| n.is_finite()).count();
        if first.is_none() && count > 150 {
            first = Some((so_far.clone(), share));
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(shares.windows(2).all(|w| w[0] <= w[1]));
    let (coarse, share) = first.unwrap();
    let guessed = coarse.guessed.iter().filter(|g| **g).count();
    assert!(share < 0.3 && guessed > 100, "{share}: {guessed}");
    let mut compared = 0;
    for (k, early_n) in coarse.most_n.iter().enumerate().filter(|(_, n)| n.is_finite()) {
        let late_n = found.most_n[k];
        // Far from its greatest reach tension grows slowly.
        if found.at(k)[0] < 6.0 {
            assert!((early_n - late_n).abs() < 0.1 * found.service_n, "{:?}: {early_n} {late_n}", found.at(k));
            compared += 1;
        }
    }
    assert!(compared > 50, "{compared}");
    assert!(found.guessed.iter().zip(&found.most_n).all(|(g, n)| !g || n.is_finite()));
}

/// A hand has moved the end meanwhile: the map begins there, with the present state of the cable.
#[test]
fn it_begins_where_the_cable_lies_now() {
    let scene = free();
    let mut moved = Simulation::for_question(
        scene.clone(),
        Model::Auto,
        Settings::default(),
        Question::History(Inertia::QuasiStatic),
    )
    .unwrap();
    moved.settle().unwrap();
    moved.drag_support(0, 1, vec2([7.5, 2.0]));
    moved.step_quasi_static(1.0).unwrap();
    let now = Some(Arc::new(moved.solution()));
    let there = ReachQuery { now, ..query(scene, [[6.0, 0.0], [10.0, 4.0]], 1.0) };
    let found = look(&there);
    assert!((vec2(found.start_m) - vec2([7.5, 2.0])).norm() < 1e-9, "{:?}", found.start_m);
    let (at, n) = place(&found, [7.5, 2.0]);
    assert!((vec2(at) - vec2(found.start_m)).norm() < 1e-9 && (n - moved.largest_n([0])).abs() < 1e-3 * n, "{n}");
    let mut broken = moved.solution();
    broken.cables[0].breaks.push(3);
    assert!(area(&ReachQuery { now: Some(Arc::new(broken)), ..there }, |_, _| ControlFlow::Continue(())).is_err());
}

/// Over heaps of slack finite elements catch on corners: on these two ways they pulled by 16 and 5
/// kN. None of that is on the map.
#[test]
#[ignore = "open: on the way over heaps of slack the normal forces that friction uses do not come to an end in 25 rounds"]
fn ways_over_heaps_of_slack_pull_by_no_more_than_weight() {
    let query = query(catalog::tank(), [[-3.0, 0.0], [4.0, 6.0]], 1.0);
    let (exploration, start) = begin(&query).unwrap();
    let cable = &query.scene.cables[0];
    let weight_n = cable.linear_density_kg_per_m * query.scene.environment.gravity_m_per_s2 * cable.length_m;
    for to in [[0.0, 5.0], [-2.0, 4.0]] {
        let most_n = exploration.greatest_tension_on_way(&mut start.clone(), [vec2([3.2, 0.85]), vec2(to)]).unwrap();
        assert!(most_n < weight_n, "to {to:?}: {most_n} N of {weight_n} N");
    }
}

#[test]
fn what_has_no_place_is_refused_in_words() {
    let there = query(free(), [[7.0, 0.0], [10.0, 2.0]], 0.5);
    for wrong in [
        ReachQuery { cable: 3, ..there.clone() },
        ReachQuery { support: 9, ..there.clone() },
        ReachQuery { spacing_m: 0.0, ..there.clone() },
        ReachQuery { spacing_m: 1e-4, ..there.clone() },
        ReachQuery { corners_m: [[0.0; 2], [f64::NAN; 2]], ..there },
    ] {
        assert!(area(&wrong, |_, _| ControlFlow::Continue(())).is_err(), "{wrong:?}");
    }
}
