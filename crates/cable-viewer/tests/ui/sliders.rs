//! Sliders are fine about the value that they have: 16 points of movement had taken a length from
//! 10.8 to 16.5 m.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::state::Item;
use egui::{Key, Modifiers, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{open, press, select};

/// The form of a cable of 10.8 m, and the knob of its length.
fn form() -> (Harness<'static, ViewerApp>, Pos2) {
    let mut scene = catalog::hanging_span();
    scene.cables[0].length_m = 10.8;
    let mut harness = open(scene);
    select(&mut harness, Item::Cable(0));
    let rail = harness.get_by_label("Length slider").rect();
    let share = ((10.8_f32 / 0.5).ln() / (200.0_f32 / 0.5).ln()).clamp(0.0, 1.0);
    // The knob's middle stays half its width within the rail.
    let run = rail.shrink2(Vec2::new(0.4 * rail.height(), 0.0));
    let knob = Pos2::new(run.left() + share * run.width(), run.center().y);
    (harness, knob)
}

fn length_m(harness: &Harness<'_, ViewerApp>) -> f64 {
    harness.state().state.document.scene.cables[0].length_m
}

fn take(harness: &mut Harness<'_, ViewerApp>, at: Pos2) {
    harness.hover_at(at);
    harness.step();
    press(harness, at, true);
    harness.run_steps(2);
}

fn lead(harness: &mut Harness<'_, ViewerApp>, from: Pos2, points: f32) {
    harness.hover_at(from + Vec2::new(points, 0.0));
    harness.run_steps(2);
}

#[test]
fn a_knob_that_is_taken_moves_its_value_by_half_a_percent_a_point_at_first() {
    let (mut harness, knob) = form();
    take(&mut harness, knob + Vec2::new(2.0, 0.0));
    assert_eq!(length_m(&harness), 10.8, "to take it changes nothing");
    let knob = knob + Vec2::new(2.0, 0.0);
    lead(&mut harness, knob, 1.0);
    let first = length_m(&harness) / 10.8 - 1.0;
    assert!((0.003..0.008).contains(&first), "{first}");
    lead(&mut harness, knob, 16.0);
    let after = length_m(&harness);
    assert!((12.0..13.0).contains(&after), "16 points: {after} m");
    // The way back is the way there.
    lead(&mut harness, knob, 0.0);
    assert_eq!(length_m(&harness), 10.8);
    // All of it within a hand's movement.
    lead(&mut harness, knob, 120.0);
    assert_eq!(length_m(&harness), 200.0);
    lead(&mut harness, knob, 4.0);
    let nice = length_m(&harness);
    assert!((10.9..11.3).contains(&nice) && (nice * 100.0 - (nice * 100.0).round()).abs() < 1e-9, "{nice}");
    press(&harness, knob + Vec2::new(4.0, 0.0), false);
    harness.run_steps(3);
    assert_eq!(length_m(&harness), nice, "to let go of it changes nothing");
    // One drag is one edit.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(length_m(&harness), 10.8);
}

/// The first frame that sees the press may see the pointer elsewhere already, and a frame may see
/// the last movement with the release.
#[test]
fn frames_that_come_late_change_nothing() {
    let (mut harness, knob) = form();
    let by = |points: f32| knob + Vec2::new(points, 0.0);
    harness.hover_at(knob);
    harness.run_steps(2);
    press(&harness, knob, true);
    harness.hover_at(by(12.0));
    harness.run_steps(2);
    let first = length_m(&harness);
    assert!((11.5..12.0).contains(&first), "{first}");
    harness.hover_at(by(16.0));
    press(&harness, by(16.0), false);
    harness.run_steps(3);
    let last = length_m(&harness);
    assert!((12.0..13.0).contains(&last) || last == first, "{last}");
    // Taken again at once.
    let (mut harness, knob) = form();
    take(&mut harness, knob);
    lead(&mut harness, knob, 16.0);
    press(&harness, knob + Vec2::new(16.0, 0.0), false);
    harness.step();
    let after = length_m(&harness);
    take(&mut harness, knob + Vec2::new(2.0, 0.0));
    assert_eq!(length_m(&harness), after);
    press(&harness, knob + Vec2::new(2.0, 0.0), false);
    harness.run_steps(2);
}

#[test]
fn shift_moves_a_tenth_as_far_and_a_rest_makes_it_fine_again() {
    let (mut harness, knob) = form();
    take(&mut harness, knob);
    lead(&mut harness, knob, 60.0);
    let far = length_m(&harness);
    assert!(far > 30.0, "{far}");
    // Rested for half a second: fine about where it is.
    harness.run_steps(30);
    lead(&mut harness, knob, 61.0);
    let moved = length_m(&harness) / far - 1.0;
    assert!((0.002..0.008).contains(&moved), "{moved}");
    let before = length_m(&harness);
    harness.event(egui::Event::ModifiersChanged(Modifiers::SHIFT));
    harness.step();
    lead(&mut harness, knob, 71.0);
    let moved = length_m(&harness) / before - 1.0;
    assert!((0.002..0.008).contains(&moved), "ten points with Shift: {moved}");
    press(&harness, knob + Vec2::new(71.0, 0.0), false);
    harness.run_steps(2);
}

#[test]
fn a_press_on_the_rail_goes_there_and_arrows_step() {
    let (mut harness, knob) = form();
    let rail = harness.get_by_label("Length slider").rect();
    let at = Pos2::new(rail.right() - 3.0, knob.y);
    take(&mut harness, at);
    assert!(length_m(&harness) > 150.0, "{}", length_m(&harness));
    press(&harness, at, false);
    harness.run_steps(2);
    let before = length_m(&harness);
    harness.get_by_label("Length slider").focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowLeft);
    harness.run_steps(2);
    let stepped = length_m(&harness);
    assert!(stepped < before && stepped > 0.7 * before, "{before} to {stepped}");
}

#[test]
fn a_share_and_a_speed_are_fine_too() {
    let (mut harness, _) = form();
    let friction = harness.state().state.document.scene.cables[0].friction;
    harness.get_by_label("Friction slider").scroll_to_me();
    harness.run_steps(4);
    let rail = harness.get_by_label("Friction slider").rect();
    let run = rail.shrink2(Vec2::new(0.4 * rail.height(), 0.0));
    let knob = Pos2::new(run.left() + (friction / 1.5) as f32 * run.width(), run.center().y);
    take(&mut harness, knob);
    lead(&mut harness, knob, 10.0);
    let by = harness.state().state.document.scene.cables[0].friction - friction;
    assert!((0.03..0.06).contains(&by), "{by}");
    press(&harness, knob + Vec2::new(10.0, 0.0), false);
    harness.run_steps(2);
    let rail = harness.get_by_label("Speed slider").rect();
    let run = rail.shrink2(Vec2::new(0.4 * rail.height(), 0.0));
    let share = (1.0_f32 / 0.01).ln() / (4.0_f32 / 0.01).ln();
    let knob = Pos2::new(run.left() + share * run.width(), run.center().y);
    take(&mut harness, knob);
    lead(&mut harness, knob, -10.0);
    let speed = harness.state().state.live.playback.speed;
    assert!((0.9..0.97).contains(&speed), "{speed}");
}
