//! A user asks where the robot or an end can be taken, sees and reads it, and ends the search.

use std::time::{Duration, Instant};

use cable_core::analysis::safe_reach::line::{ReachMap, Trip};
use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::jobs::safe_reach::{
    Outcome, Progress, ROBOT_PLACES, ReachMaps, ReachSubject, SafeReachOptions, SafeReachQuery, SafeReachState, start,
};
use egui::{Key, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{apply, open};

fn reach<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a SafeReachState {
    &harness.state().state.analysis.safe_reach
}

fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

fn patiently(what: &str, mut done: impl FnMut() -> bool) {
    let began = Instant::now();
    while !done() {
        assert!(began.elapsed() < Duration::from_secs(120), "{what} takes too long");
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn tall(scene: cable_core::Scene) -> Harness<'static, ViewerApp> {
    let mut harness = open(scene);
    harness.set_size(Vec2::new(1280.0, 1800.0));
    harness.run_steps(3);
    harness
}

#[test]
fn safe_reach_of_a_robot_is_found_beside_the_window_and_can_be_ended() {
    let mut scene = catalog::robot_drive();
    scene.cables[0].segments = Some(24);
    let mut harness = tall(scene.clone());
    click(&mut harness, "Find safe reach");
    assert!(matches!(reach(&harness).progress, Progress::Running(..)), "{:?}", reach(&harness));
    // The window goes on meanwhile.
    harness.key_press(Key::ArrowRight);
    harness.run_steps(3);
    assert_eq!(harness.state().state.live.snapshot.error, None);
    click(&mut harness, "Cancel safe reach");
    assert!(!matches!(reach(&harness).progress, Progress::Running(..)));

    // A short search to its end.
    let settings = cable_core::Settings::default();
    let corners_m = [[9.9, 0.0], [10.1, 0.0]];
    let job = start(
        SafeReachQuery { scene: scene.clone(), now: None, settings, moved: ReachSubject::Robot, corners_m, across: 8 },
        || {},
    );
    let mut found: Option<Outcome> = None;
    patiently("a short search", || {
        match job.progress() {
            Progress::Done(done) => found = Some(done),
            Progress::Failed(why) => panic!("{why}"),
            Progress::None | Progress::Running(..) => {}
        }
        found.is_some()
    });
    let (maps, of) = found.unwrap();
    assert_eq!(*of, scene);
    let ReachMaps::Line(map) = maps else { panic!("{maps:?}") };
    let map: &ReachMap = &map;
    assert_eq!(map.places.len(), ROBOT_PLACES);
    assert!(map.safe_m(map.service_n, Trip::ThereAndBack).is_some());
}

/// A search that nobody waits for any more ends, and takes no more of the machine.
#[test]
fn a_search_that_is_dropped_ends() {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};
    let heard = Arc::new(AtomicUsize::new(0));
    let theirs = Arc::clone(&heard);
    let (scene, settings) = (catalog::robot_drive(), cable_core::Settings::default());
    let corners_m = [[0.0, 0.0], [20.0, 0.0]];
    let order = SafeReachQuery { scene, now: None, settings, moved: ReachSubject::Robot, corners_m, across: 8 };
    let job = start(order, move || {
        theirs.fetch_add(1, Ordering::Relaxed);
        std::thread::sleep(Duration::from_millis(20));
    });
    patiently("the first words", || heard.load(Ordering::Relaxed) > 2);
    assert!(matches!(job.progress(), Progress::Running(..)), "a search that is done says nothing of ending");
    drop(job);
    // The progress of the job, and its last message.
    std::thread::sleep(Duration::from_secs(1));
    let last = heard.load(Ordering::Relaxed);
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(heard.load(Ordering::Relaxed), last, "it goes on");
}

#[test]
fn safe_reach_of_an_end_is_a_map_of_the_plane_found_by_keys_alone_and_told_in_words() {
    let mut harness = tall(catalog::hanging_span());
    assert_eq!(reach(&harness).choice.moved, None);
    apply(
        &mut harness,
        Command::View(ViewCommand::SetSafeReachOptions(SafeReachOptions { across: 10, ..SafeReachOptions::default() })),
    );
    harness.get_by_label("Find safe reach").focus();
    harness.step();
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    assert!(matches!(reach(&harness).progress, Progress::Running(..)), "{:?}", reach(&harness));

    // An edit meanwhile is answered at once, and the map says that it is of the scene before.
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.length_m += 0.1;
    let edit = cable_viewer::command::SceneCommand::SetCable { cable: 0, value: Box::new(cable) };
    apply(&mut harness, Command::Scene(edit));
    assert!(harness.state().settled());
    patiently("a coarse map", || {
        harness.step();
        matches!(reach(&harness).progress, Progress::Done(_))
    });
    harness.get_by_label("Out of date: edited since");
    let Some((ReachMaps::Area(there, Some(ways)), _)) = reach(&harness).found().cloned() else {
        panic!("{:?}", reach(&harness))
    };
    let [low, high] = harness.state().state.view.visible_m;
    let inside = |p: [f64; 2]| (0..2).all(|k| p[k] >= low[k] - 1e-9 && p[k] <= high[k] + 1e-9);
    assert!((0..there.most_n.len()).all(|k| inside(there.at(k))), "all over what is in view, and no farther");
    let (rows, known) = (there.most_n.len() / there.columns, there.most_n.iter().filter(|n| n.is_finite()).count());
    assert!(rows >= 4 && there.columns >= 9 && known > 20, "{rows} {} {known}", there.columns);
    assert!((ways.spacing_m - 2.0 * there.spacing_m).abs() < 1e-12);

    let words = || {
        let node = harness.get_by_label("Canvas");
        node.accesskit_node().data().description().unwrap_or_default().to_owned()
    };
    assert!(words().contains("safe reach, there: Below service"), "{}", words());
    harness.get_by_label_contains("Below breaking");
    click(&mut harness, "There and back");
    assert_eq!(reach(&harness).choice.trip, Trip::ThereAndBack);
    click(&mut harness, "Clear");
    assert!(reach(&harness).found().is_none());
    assert!(harness.query_by_label("There and back").is_none(), "nothing to show");
}

/// Time has run and has taken the end elsewhere: the map begins there.
#[test]
fn safe_reach_begins_where_the_end_is_on_screen() {
    let mut scene = catalog::over_beam();
    scene.obstacles.clear();
    let (times_s, points_m) = (vec![0.0, 0.5], vec![[9.0, 0.5], [8.0, 1.0]]);
    scene.cables[0].supports[1].motion = Some(cable_core::scene::Motion { times_s, points_m });
    let mut harness = tall(scene);
    apply(
        &mut harness,
        Command::View(ViewCommand::SetSafeReachOptions(SafeReachOptions { across: 8, ..SafeReachOptions::default() })),
    );
    apply(&mut harness, Command::Playback(cable_viewer::command::PlaybackCommand::SetPaused(false)));
    harness.run_steps(50);
    apply(&mut harness, Command::Playback(cable_viewer::command::PlaybackCommand::SetPaused(true)));
    let there = harness.state().state.live.snapshot.solution.as_ref().unwrap().cables[0].supports[1].clone();
    assert!((there.x_m - 8.0).abs() < 1e-6, "{there:?}");
    click(&mut harness, "Find safe reach");
    patiently("a coarse map", || {
        harness.step();
        matches!(reach(&harness).progress, Progress::Done(_))
    });
    let Some((ReachMaps::Area(map, _), _)) = reach(&harness).found() else { panic!("{:?}", reach(&harness)) };
    assert!(
        (map.start_m[0] - there.x_m).abs() < 1e-9 && (map.start_m[1] - there.y_m).abs() < 1e-9,
        "{:?}",
        map.start_m
    );
}

#[test]
fn what_is_taken_somewhere_is_the_robot_else_what_is_picked_else_an_end_and_can_be_chosen() {
    let moved =
        |harness: &Harness<'_, ViewerApp>| cable_viewer::state::job_questions::reach_target(&harness.state().state);
    let mut harness = tall(catalog::robot_drive());
    assert_eq!(moved(&harness), Some(ReachSubject::Robot));
    harness.get_by_label("What is moved").click();
    harness.run_steps(3);
    let riser = harness.state().state.document.scene.cables[0].supports[0].name.clone();
    let label = format!("Support {riser} of {}", harness.state().state.document.scene.cables[0].name);
    // The canvas has a name of the same words.
    let entry =
        harness.get_all_by_label(&label).find(|n| n.accesskit_node().role() != egui::accesskit::Role::GraphicsSymbol);
    entry.unwrap().click();
    harness.run_steps(3);
    assert_eq!(moved(&harness), Some(ReachSubject::Support { cable: 0, support: 0 }));

    let mut harness = tall(catalog::hanging_span());
    assert_eq!(moved(&harness), Some(ReachSubject::Support { cable: 0, support: 1 }));
    let left = cable_viewer::state::Item::Support { cable: 0, support: 0 };
    apply(&mut harness, Command::View(ViewCommand::Select(Some(left))));
    assert_eq!(moved(&harness), Some(ReachSubject::Support { cable: 0, support: 0 }));
}

/// D10.11: cancelling threw away what was found, nobody knew how long it takes, and a place outside
/// the tank was safe.
#[test]
fn a_cancelled_search_keeps_what_it_found_and_none_of_it_lies_outside_the_tank() {
    let mut harness = tall(catalog::tank());
    // All of the tank, and as much again on both sides.
    apply(&mut harness, Command::View(ViewCommand::Zoom { about_m: [0.0, 4.0], factor: 0.4 }));
    let [low, high] = harness.state().state.view.visible_m;
    assert!(low[0] < -20.0 && high[0] > 20.0, "{low:?} {high:?}");
    apply(
        &mut harness,
        Command::View(ViewCommand::SetSafeReachOptions(SafeReachOptions { across: 12, ..SafeReachOptions::default() })),
    );
    click(&mut harness, "Find safe reach");
    patiently("a first part", || {
        harness.step();
        assert!(!matches!(reach(&harness).progress, Progress::Failed(_)), "{:?}", reach(&harness));
        matches!(reach(&harness).progress, Progress::Running(share, Some(_)) if share > 0.05)
    });
    harness.step();
    let eta = |text: &str| harness.query_all_by_label_contains(text).count();
    assert!(eta("s left") + eta("min left") + eta("seconds left") > 0, "how long it still takes");
    click(&mut harness, "Cancel safe reach");
    let Some((ReachMaps::Area(there, _), _)) = reach(&harness).found() else { panic!("{:?}", reach(&harness)) };
    assert!(there.most_n.iter().any(|n| n.is_finite()), "what was found is kept");
    let walls = harness.state().state.document.scene.obstacles.iter().find_map(|o| match &o.shape {
        // Their inner faces: above a wall is no place in the tank either.
        cable_core::scene::Shape::Terrain { points_m } => Some([points_m[1][0], points_m[points_m.len() - 2][0]]),
        _ => None,
    });
    let [left, right] = walls.unwrap();
    assert!((0..there.most_n.len()).all(|k| (left..=right).contains(&there.at(k)[0])), "{left} to {right}: {there:?}");
    harness.get_by_label_contains("Incomplete: stopped at");
    click(&mut harness, "Clear");
    assert!(reach(&harness).found().is_none() && reach(&harness).stopped.is_none());
}

/// The bar stood at 3 % while half of the places were known, because ways back that are never gone
/// counted by their length, and what was found so far read like the answer.
#[test]
fn progress_of_a_robots_reach_counts_places_and_what_is_found_so_far_is_said_to_be() {
    let ask = SafeReachQuery {
        scene: catalog::tank_robot(),
        now: None,
        settings: cable_core::Settings::default(),
        moved: ReachSubject::Robot,
        corners_m: [[4.0, 0.0], [7.0, 0.0]],
        across: 8,
    };
    let told = std::sync::Mutex::new(Vec::new());
    let job = start(ask, || ());
    patiently("a short reach", || {
        let progress = job.progress();
        if let Progress::Running(share, Some((ReachMaps::Line(map), _))) = &progress {
            told.lock().unwrap().push((*share, map.places.len()));
        }
        matches!(progress, Progress::Done(_))
    });
    let told = told.into_inner().unwrap();
    assert!(told.windows(2).all(|t| t[0].0 <= t[1].0), "{told:?}");
    let there = told.iter().filter(|(_, places)| *places < ROBOT_PLACES);
    for (share, places) in there {
        let expected = 0.5 * *places as f64 / ROBOT_PLACES as f64;
        assert!((share - expected).abs() < 0.03, "{share} with {places} of {ROBOT_PLACES} places");
    }
    let mut harness = tall(catalog::tank_robot());
    click(&mut harness, "Find safe reach");
    patiently("the first places", || {
        harness.step();
        reach(&harness).found().is_some_and(|(maps, _)| matches!(maps, ReachMaps::Line(map) if map.places.len() > 2))
    });
    if matches!(reach(&harness).progress, Progress::Running(..)) {
        assert!(harness.query_all_by_label_contains("So far: safe from").next().is_some());
    }
    click(&mut harness, "Cancel safe reach");
}

fn legend(harness: &Harness<'_, ViewerApp>) -> egui::Rect {
    let found = harness.output().shapes.iter().find_map(|shape| match &shape.shape {
        egui::Shape::Text(text) if text.galley.text() == "Above service" => Some(text.visual_bounding_rect()),
        _ => None,
    });
    found.expect("the map has a legend")
}

/// Issue 20: begun by the palette, a search showed neither its progress nor its result, which stood
/// below what was in sight; the hints of the first minute lay over its legend, and that over the
/// cable.
#[test]
fn issue_020_a_search_is_seen_wherever_it_was_begun() {
    let mut harness = open(catalog::tank_robot());
    harness.hover_at(harness.get_by_label("Canvas").rect().center());
    harness.run_steps(2);
    apply(&mut harness, Command::View(ViewCommand::SearchSafeReach));
    patiently("the first places", || {
        harness.run_steps(2);
        reach(&harness).found().is_some()
    });
    harness.run_steps(10);
    let screen = harness.ctx.content_rect();
    let bar = harness.get_by_label("Progress of the safe reach").rect();
    assert!(screen.contains_rect(bar), "{bar:?}");
    // At no size does its legend lie over cable, robot or hints: it stands beside the canvas, or
    // above it where there is no such panel.
    for size in [[1024.0, 640.0], [1280.0, 800.0]] {
        harness.set_size(size.into());
        harness.run_steps(3);
        let canvas = harness.get_by_label("Canvas").rect();
        assert!(!canvas.intersects(legend(&harness)), "{size:?}: {canvas:?} {:?}", legend(&harness));
    }
    harness.key_press(Key::CloseBracket);
    harness.run_steps(3);
    let canvas = harness.get_by_label("Canvas").rect();
    assert!(legend(&harness).max.y < canvas.min.y, "{canvas:?} {:?}", legend(&harness));
    apply(&mut harness, Command::View(ViewCommand::EndSafeReach));
}
