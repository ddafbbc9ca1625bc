//! These tests look at what is on screen: the picture, the timeline and the figures beside it say
//! what is there.

use cable_core::scene::catalog;
use cable_core::{Scene, Settings};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, ViewCommand};
use cable_viewer::geometry;
use cable_viewer::render::colour::{CableQuantity, ColourScale};
use cable_viewer::state::{AppState, Item, OpenPanels};
use egui::{Key, Shape, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, drag, open, open_span, press, select, support};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn run(harness: &mut Harness<'_, ViewerApp>, frames: usize) {
    harness.key_press(Key::Space);
    harness.run_steps(frames);
    harness.key_press(Key::Space);
    harness.run_steps(2);
}

/// Issue 20: “Drag the robot”, begun at its hitch, moved the view.
#[test]
fn issue_020_a_drag_of_the_hitch_drags_the_robot() {
    let mut harness = open(catalog::tank_robot());
    let camera = state(&harness).view.camera;
    let at = state(&harness).document.scene.robot.as_ref().unwrap().at_m;
    let from = harness.get_by_label("Support hitch of umbilical").rect().center();
    drag(&mut harness, from, Vec2::new(-30.0, 0.0));
    let now = state(&harness).document.scene.robot.as_ref().unwrap().at_m;
    assert_eq!(state(&harness).view.camera.centre_m, camera.centre_m);
    assert!((now[0] - at[0] + 30.0 / camera.points_per_m).abs() < 0.02, "{at:?} {now:?}");
}

/// Issue 20: an end that had been pulled past the length, and was on its way back in a pause, was
/// drawn where it was sent and not at its cable.
#[test]
fn issue_020_a_support_on_its_way_is_drawn_at_its_cable() {
    let mut harness = open_span();
    let hand_stiffness_n_per_m = Some(2e4);
    let settings = Settings { hand_stiffness_n_per_m, hand_speed_m_per_s: 4.0, ..state(&harness).solver.settings };
    apply(&mut harness, Command::SetSettings(settings));
    apply(&mut harness, Command::Playback(PlaybackCommand::PullPastLength(true)));
    apply(&mut harness, Command::View(ViewCommand::Zoom { about_m: [3.0, 4.0], factor: 0.6 }));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    let from = support(&harness, "right");
    harness.hover_at(from);
    harness.step();
    press(&harness, from, true);
    harness.step();
    let points = 4.0 * state(&harness).view.camera.points_per_m;
    for k in 1..=40 {
        harness.hover_at(from + Vec2::new((points * f64::from(k) / 40.0) as f32, 0.0));
        harness.run_steps(2);
    }
    press(&harness, from + Vec2::new(points as f32, 0.0), false);
    harness.step();
    let mut was_away = false;
    for _ in 0..6 {
        apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
        harness.run_steps(2);
        let end = *state(&harness).live.snapshot.solution.as_ref().unwrap().cables[0].nodes.last().unwrap();
        let drawn = geometry::supports::support_position(state(&harness), 0, 1).unwrap();
        let to = state(&harness).document.scene.cables[0].supports[1].at_m.unwrap();
        was_away |= (to[0] - end.x_m).hypot(to[1] - end.y_m) > 2e-3;
        assert!((drawn[0] - end.x_m).hypot(drawn[1] - end.y_m) < 1e-6, "{drawn:?} at {} {}", end.x_m, end.y_m);
        apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
        harness.run_steps(2);
    }
    assert!(was_away, "the test sees a support on its way");
}

/// Issue 20: 3153.1 to 3155.8 N, which is noise, was drawn from violet to yellow.
#[test]
fn issue_020_colours_do_not_spread_over_noise() {
    let harness = open(catalog::near_taut());
    let mut solution = state(&harness).live.snapshot.solution.as_deref().unwrap().clone();
    for (k, node) in solution.cables[0].nodes.iter_mut().enumerate() {
        node.tension_n = 3153.1 + 2.7 * (k % 2) as f64;
    }
    let scale = ColourScale { quantity: CableQuantity::Tension, fixed: None, ..ColourScale::default() };
    let [low, high] = scale.range(&solution);
    assert!((high - 3155.8).abs() < 1e-9 && (high - low - 315.58).abs() < 1e-6, "{low} to {high}");
    let fixed = ColourScale { fixed: Some([3153.0, 3156.0]), ..scale };
    assert_eq!(fixed.range(&solution), [3153.0, 3156.0], "a range that was asked for stays");
}

/// Everything that stands in the window's panel of figures, with its row.
fn texts(harness: &Harness<'_, ViewerApp>) -> Vec<String> {
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|s| crate::warnings::galleys(&s.shape, &mut all));
    all.into_iter().map(|(text, ..)| text).collect()
}

/// Issue 20: “Tightest bend 14.00 mm”, “allowed ≥ 140.0 mm”, and no warning: the bend that is
/// judged is that of a guide, computed with the bending stiffness.
#[test]
fn issue_020_the_bend_that_is_judged_stands_beside_its_limit() {
    let mut seen = 0;
    for (id, scene) in catalog::all() {
        let harness = open(scene);
        let Some(answer) = state(&harness).live.snapshot.solution.clone() else { continue };
        let (cable, scene) = (&answer.cables[0], state(&harness).document.scene.clone());
        let limit = scene.cables[0].min_bend_radius_m;
        let (Some(raw), Some(judged)) = (cable.tightest_bend, cable.judged_bend) else { continue };
        if limit == 0.0 || judged.bend.radius_m <= raw.radius_m {
            continue;
        }
        seen += 1;
        let texts = texts(&harness);
        let at = texts.iter().position(|t| t == "Tightest bend").expect("the row");
        let value = &texts[at + 1];
        // Both numbers have the unit at the end.
        let parts: Vec<&str> = value.split(' ').collect();
        let &[radius, sign, least, _unit] = parts.as_slice() else { panic!("{id}: {value}") };
        let ratio = radius.parse::<f64>().unwrap() / least.parse::<f64>().unwrap();
        assert!((ratio / (judged.bend.radius_m / limit) - 1.0).abs() < 1e-3, "{id}: {value}");
        assert_eq!(sign, if judged.bend.radius_m < limit { "<" } else { "≥" }, "{id}: {value}");
    }
    assert!(seen > 0);
}

/// Issue 20: “Position” of a robot that drives was where it had started.
#[test]
fn issue_020_the_place_of_a_robot_is_called_its_start() {
    let mut harness = open(catalog::tank_robot());
    select(&mut harness, Item::Robot);
    run(&mut harness, 60);
    harness.get_by_label("Start position, m");
    assert!(harness.query_by_label("Position, m").is_none());
}

fn rail(harness: &Harness<'_, ViewerApp>) -> f32 {
    harness.get_by_label("Timeline").rect().width()
}

fn sized(scene: Scene, size: [f32; 2]) -> Harness<'static, ViewerApp> {
    let mut harness = open(scene);
    harness.set_size(Vec2::from(size));
    harness.run_steps(5);
    harness
}

/// Issue 20: the rail of the timeline was 80 points wide in the opening scene.
#[test]
fn issue_020_the_timeline_is_long_enough_to_aim_at() {
    for scene in [catalog::tank_robot(), catalog::tank()] {
        for size in [[1024.0, 640.0], [1280.0, 800.0], [1600.0, 900.0], [1920.0, 1080.0]] {
            let mut harness = sized(scene.clone(), size);
            run(&mut harness, 20);
            assert!(rail(&harness) >= 300.0, "{} at {size:?}", rail(&harness));
            apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.1))));
            assert!(rail(&harness) >= 300.0, "{} at {size:?} in the past", rail(&harness));
        }
    }
}

/// Issue 20: with the graphs the timeline went, too.
#[test]
fn issue_020_the_timeline_stays_where_the_graphs_are_folded() {
    for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
        let mut harness = sized(catalog::tank_robot(), size);
        let folded = OpenPanels { graphs: false, ..state(&harness).ui.panels };
        apply(&mut harness, Command::View(ViewCommand::ShowPanels(folded)));
        run(&mut harness, 30);
        let rect = harness.get_by_label("Timeline").rect();
        assert!(rect.width() >= 120.0 && rect.max.x <= size[0], "{rect:?} at {size:?}");
        let play = harness.get_by_label("Play").rect();
        assert!((rect.center().y - play.center().y).abs() < 4.0, "in the row of playback: {rect:?} {play:?}");
        // It scrubs, in one press from any place to any other.
        let (from, to) = (rect.right_center() - Vec2::new(6.0, 0.0), rect.center());
        drag(&mut harness, from, to - from);
        let shown = state(&harness).live.recording.shown_s.expect("an earlier picture");
        assert!((0.15..0.35).contains(&shown), "{shown} s at {size:?}");
        harness.get_by_label("Latest");
    }
}

/// Issue 20: the playhead was a thin grey line without a head.
#[test]
fn issue_020_the_playhead_has_a_head_in_every_graph_over_time() {
    let mut harness = open(catalog::tank_robot());
    run(&mut harness, 60);
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.5))));
    harness.run_steps(2);
    let colour = harness.ctx.global_style().visuals.text_color();
    let graph = harness.get_by_label("Over time").rect();
    let (mut heads, mut lines) = (0, 0);
    for clipped in &harness.output().shapes {
        let mut all = Vec::new();
        flat(&clipped.shape, &mut all);
        for shape in all {
            match shape {
                Shape::Path(p) if p.closed && p.points.len() == 3 && p.fill == colour => {
                    heads += usize::from(graph.contains(p.points[2]));
                }
                Shape::LineSegment { points, stroke } if stroke.width == 2.0 && stroke.color == colour => {
                    lines += usize::from(points[0].x == points[1].x && graph.expand(2.0).contains(points[0]));
                }
                _ => {}
            }
        }
    }
    assert_eq!((heads, lines), (1, 1));
}

fn flat<'a>(shape: &'a Shape, all: &mut Vec<&'a Shape>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|s| flat(s, all)),
        other => all.push(other),
    }
}

/// Issue 20: the wall of the tank was out of view, and ground below the lowest point took a third
/// of the picture.
#[test]
fn issue_020_a_fitted_tank_shows_its_walls_and_little_of_the_ground_below() {
    for scene in [catalog::tank_robot(), catalog::tank()] {
        for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
            let mut harness = sized(scene.clone(), size);
            harness.state_mut().state.ui.first_steps.hide();
            harness.key_press(Key::F);
            harness.run_steps(3);
            let canvas = harness.get_by_label("Canvas").rect();
            let [low, high] = state(&harness).view.camera.visible_m(canvas);
            assert!(low[0] < -11.43 && high[0] > 11.43, "{} at {size:?}: {low:?} {high:?}", scene.name);
            let lowest = -0.027;
            let below = (lowest - low[1]) / (high[1] - low[1]);
            assert!(below < 0.151, "{} at {size:?}: {below}", scene.name);
        }
    }
}
