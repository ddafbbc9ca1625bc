//! The canvas says how much too thick the cable is drawn, where it lay when the run began, and
//! where it broke.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, ViewCommand};
use cable_viewer::render::colour::{CableQuantity, ColourScale};
use cable_viewer::state::{Layers, OpenPanels};
use egui::{Key, Rect, Shape, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::warnings::galleys;
use crate::{apply, drag, open};

/// Everything that is written, and where.
fn texts(harness: &Harness<'_, ViewerApp>) -> Vec<(String, Rect)> {
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|s| galleys(&s.shape, &mut all));
    all.into_iter().map(|(text, r, _)| (text, r)).collect()
}

fn canvas_texts(harness: &Harness<'_, ViewerApp>) -> Vec<(String, Rect)> {
    let canvas = harness.get_by_label("Canvas").rect();
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|s| galleys(&s.shape, &mut all));
    all.into_iter().filter(|(_, r, _)| canvas.contains(r.center())).map(|(text, r, _)| (text, r)).collect()
}

/// A cable of 28 mm is drawn five times as thick in the tank, and nothing said so.
#[test]
fn a_cable_drawn_thicker_than_it_is_is_said_to_be() {
    for size in [[1024.0, 640.0], [1280.0, 800.0]] {
        let mut harness = open(catalog::tank());
        harness.set_size(Vec2::from(size));
        harness.run_steps(4);
        let note = |h: &Harness<'_, ViewerApp>| texts(h).into_iter().find(|(t, _)| t.contains("drawn "));
        let state = &harness.state().state;
        let points = state.document.scene.cables[0].diameter_m * state.view.camera.points_per_m;
        let (text, place) = note(&harness).expect("it is said");
        let told: f64 = text.trim_start_matches("drawn ").split('×').next().unwrap().parse().unwrap();
        assert!((told / (4.5 / points) - 1.0).abs() < 0.06, "{text}: {points} points");
        assert!(text.starts_with("drawn ") && text.contains('×'), "{text}");
        // It lies over nothing else that is written.
        let others = texts(&harness).into_iter().filter(|(t, _)| *t != text);
        let over: Vec<_> = others.filter(|(_, r)| r.intersects(place)).collect();
        assert!(over.is_empty(), "{over:?}");
        // Without a grid too; near enough it is as thick as it is.
        let layers = Layers { grid: false, ..harness.state().state.view.layers };
        apply(&mut harness, Command::View(ViewCommand::SetLayers(layers)));
        assert!(note(&harness).is_some());
        let about_m = harness.state().state.view.camera.centre_m;
        apply(&mut harness, Command::View(ViewCommand::Zoom { about_m, factor: 20.0 }));
        assert!(note(&harness).is_none());
        // Without a panel that has the legend it stands in the strip above the canvas.
        apply(&mut harness, Command::View(ViewCommand::Fit));
        let folded = OpenPanels { edit: false, results: false, graphs: false };
        apply(&mut harness, Command::View(ViewCommand::ShowPanels(folded)));
        harness.run_steps(2);
        assert!(note(&harness).is_some());
    }
}

/// Words in the strip above the results lie over nothing else in it.
#[test]
fn the_words_of_the_legend_keep_apart_for_every_quantity() {
    let mut harness = open(catalog::tank());
    for quantity in CableQuantity::ALL {
        apply(&mut harness, Command::View(ViewCommand::SetColour(ColourScale { quantity, ..ColourScale::default() })));
        let strip = harness.get_by_label("Colours of the cable").rect();
        let words: Vec<_> = texts(&harness).into_iter().filter(|(_, r)| strip.contains(r.center())).collect();
        assert!(words.iter().any(|(t, _)| t.contains('×')), "{words:?}");
        for (k, (text, place)) in words.iter().enumerate() {
            let over = words[..k].iter().find(|(_, r)| r.intersects(*place));
            assert!(over.is_none(), "{text} lies over {over:?}");
        }
    }
}

/// The bar at the top of a small window had its last entries below the greatest tension.
#[test]
fn the_bar_at_the_top_of_small_windows_has_no_words_over_words() {
    for size in [[640.0, 400.0], [760.0, 500.0], [800.0, 600.0], [1024.0, 640.0]] {
        let mut harness = open(catalog::robot_drive());
        harness.set_size(Vec2::from(size));
        harness.run_steps(6);
        let bar: Vec<_> = texts(&harness).into_iter().filter(|(t, r)| r.center().y < 24.0 && !t.is_empty()).collect();
        for (k, (text, place)) in bar.iter().enumerate() {
            let over = bar[..k].iter().find(|(_, r)| r.shrink(0.5).intersects(*place));
            assert!(over.is_none(), "{size:?}: {text} lies over {over:?}");
        }
        assert!(bar.iter().any(|(t, _)| t.starts_with("Max ")), "{size:?}: {bar:?}");
    }
}

/// At 800×600 both legends lay over the robot and its cable: they stand in the panel there.
#[test]
fn legends_of_small_windows_lie_over_no_handle() {
    for size in [[800.0, 600.0], [640.0, 480.0]] {
        let mut harness = open(catalog::robot_drive());
        harness.set_size(Vec2::from(size));
        harness.run_steps(6);
        let on_canvas = canvas_texts(&harness);
        let legend: Vec<_> = on_canvas.iter().filter(|(t, _)| t.starts_with("Tension (") || t == "holds").collect();
        assert!(legend.is_empty(), "{size:?}: {legend:?}");
        assert!(texts(&harness).iter().any(|(t, _)| t.starts_with("Tension (")), "{size:?}");
    }
}

/// With all panels folded both legends lay over the robot and its cable.
#[test]
fn legends_lie_on_no_canvas_with_all_panels_folded() {
    for size in [[640.0, 400.0], [800.0, 600.0], [1280.0, 800.0]] {
        let mut harness = open(catalog::robot_drive());
        harness.set_size(Vec2::from(size));
        let folded = OpenPanels { edit: false, results: false, graphs: false };
        apply(&mut harness, Command::View(ViewCommand::ShowPanels(folded)));
        harness.run_steps(6);
        let canvas = harness.get_by_label("Canvas").rect();
        let strip = harness.get_by_label("Colours of the cable").rect();
        assert!(!canvas.intersects(strip.shrink(1.0)), "{size:?}: {canvas:?} {strip:?}");
        let on_canvas = canvas_texts(&harness);
        let legend: Vec<_> = on_canvas.iter().filter(|(t, _)| t.starts_with("Tension (") || t == "holds").collect();
        assert!(legend.is_empty(), "{size:?}: {legend:?}");
        let words: Vec<_> = texts(&harness).into_iter().filter(|(_, r)| strip.contains(r.center())).collect();
        assert!(words.iter().any(|(t, _)| t.starts_with("Tension (")), "{size:?}: {words:?}");
    }
}

/// Counts the short straight lines of the canvas.
fn dashes(harness: &Harness<'_, ViewerApp>) -> usize {
    fn count(shape: &Shape, canvas: Rect) -> usize {
        match shape {
            Shape::LineSegment { points, stroke } => {
                let short = points[0].distance(points[1]) < 9.0 && (stroke.width - 1.8).abs() < 0.01;
                usize::from(short && canvas.contains(points[0]))
            }
            Shape::Vec(all) => all.iter().map(|s| count(s, canvas)).sum(),
            _ => 0,
        }
    }
    let canvas = harness.get_by_label("Canvas").rect();
    harness.output().shapes.iter().map(|s| count(&s.shape, canvas)).sum()
}

#[test]
fn the_shape_at_the_start_is_shown_beside_the_present_one() {
    let mut harness = open(catalog::swinging_span());
    harness.key_press(Key::Space);
    harness.run_steps(40);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let before = dashes(&harness);
    harness.get_by_label("View").click();
    harness.run_steps(3);
    harness.get_by_label("Shape at the start").click();
    harness.run_steps(3);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.state().state.view.layers.start_shape);
    assert!(dashes(&harness) > before + 20, "{before}, then {}", dashes(&harness));
}

/// A broken cable had bare ends, and a sag between supports that it no longer hung on.
#[test]
fn torn_ends_are_marked_and_a_cable_that_nothing_holds_has_no_sag() {
    let mut scene = catalog::hanging_span();
    (scene.cables[0].breaking_tension_n, scene.cables[0].service_tension_n) = (30.0, 20.0);
    scene.cables[0].breaking_time_s = 0.0;
    let mut harness = open(scene);
    let said = |h: &Harness<'_, ViewerApp>| canvas_texts(h).iter().any(|(t, _)| t.starts_with("broke at 30"));
    assert!(!said(&harness));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(30);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let state = &harness.state().state;
    let answer = state.live.snapshot.solution.clone().unwrap();
    assert!(!answer.cables[0].breaks.is_empty());
    assert!(said(&harness), "{:?}", canvas_texts(&harness));
    // A cross of two strokes, each on a wider one of the background, at each torn end in view.
    let canvas = harness.get_by_label("Canvas").rect();
    let camera = state.view.camera;
    let marks = |at: egui::Pos2| {
        let crosses = |s: &&egui::epaint::ClippedShape| match &s.shape {
            Shape::LineSegment { points, .. } => {
                let middle = points[0] + 0.5 * (points[1] - points[0]);
                middle.distance(at) < 0.5 && points[0].distance(points[1]) > 10.0
            }
            _ => false,
        };
        harness.output().shapes.iter().filter(crosses).count()
    };
    let nodes = &answer.cables[0].nodes;
    for k in &answer.cables[0].breaks {
        for node in [k.checked_sub(1), Some(*k)].into_iter().flatten().filter_map(|k| nodes.get(k)) {
            let at = camera.to_screen(canvas, [node.x_m, node.y_m]);
            assert!(!canvas.contains(at) || marks(at) >= 4, "{} at {at}", marks(at));
        }
    }
    harness.get_by_label_contains("sag –");
}

/// Issue 20: at 1024×640 a label could lie behind the hints of the first minute.
#[test]
fn issue_020_no_label_lies_behind_the_hints() {
    let mut harness = open(catalog::tank_robot());
    harness.set_size(Vec2::new(1024.0, 640.0));
    harness.run_steps(4);
    let hints = ["Drag the robot", "Press Space to play", "Scroll to zoom", "Start here…"];
    let places = |harness: &Harness<'_, ViewerApp>| {
        let of_hints = hints.map(|hint| harness.get_by_label(hint).rect()).into_iter().reduce(Rect::union).unwrap();
        let others = canvas_texts(harness).into_iter().filter(|(text, _)| !hints.contains(&text.as_str()));
        (of_hints, others.collect::<Vec<_>>())
    };
    // The view is moved so that the labels of the hitch would stand where the hints are.
    let (of_hints, labels) = places(&harness);
    let (_, hitch) = labels.iter().find(|(text, _)| text.starts_with("hitch ")).expect("the hitch has a label");
    let empty = harness.get_by_label("Canvas").rect().left_top() + Vec2::new(120.0, 60.0);
    drag(&mut harness, empty, Vec2::new(0.0, of_hints.center().y - hitch.center().y));
    harness.run_steps(2);
    let (of_hints, labels) = places(&harness);
    assert!(labels.len() > 3, "{labels:?}");
    let behind: Vec<_> = labels.iter().filter(|(_, place)| place.intersects(of_hints)).collect();
    assert!(behind.is_empty(), "{behind:?}");
}
