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

/// Everything that stands in the window's panel of figures, with its row.
fn texts(harness: &Harness<'_, ViewerApp>) -> Vec<String> {
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|s| crate::warnings::galleys(&s.shape, &mut all));
    all.into_iter().map(|(text, ..)| text).collect()
}

fn geometry_length(value_m: f64) -> String {
    cable_viewer::units::format::length(value_m)
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

fn flat<'a>(shape: &'a Shape, all: &mut Vec<&'a Shape>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|s| flat(s, all)),
        other => all.push(other),
    }
}
