//! These tests drag an end past the length while time runs (D10.9). It is
//! refused unless the user wants the end to pull.

use std::sync::Arc;

use cable_core::Settings;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, ViewCommand};
use cable_viewer::geometry;
use cable_viewer::state::Item;
use egui::{Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open_span, press, support};

/// The right end of the span (10 m apart, 12 m of cable), held by the mouse while time runs.
fn held(stiffness_n_per_m: f64) -> (Harness<'static, ViewerApp>, Pos2) {
    let mut harness = open_span();
    let hand_stiffness_n_per_m = Some(stiffness_n_per_m);
    let settings =
        Settings { hand_stiffness_n_per_m, hand_speed_m_per_s: 4.0, ..harness.state().state.solver.settings };
    apply(&mut harness, Command::SetSettings(settings));
    apply(&mut harness, Command::View(ViewCommand::Zoom { about_m: [3.0, 4.0], factor: 0.6 }));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    let from = support(&harness, "right");
    harness.hover_at(from);
    harness.step();
    press(&harness, from, true);
    harness.step();
    (harness, from)
}

/// Moves the pointer in small steps.
fn lead(harness: &mut Harness<'_, ViewerApp>, from: Pos2, by_m: f64) -> Pos2 {
    let points = by_m * harness.state().state.view.camera.points_per_m;
    for k in 1..=20 {
        harness.hover_at(from + Vec2::new((points * f64::from(k) / 20.0) as f32, 0.0));
        harness.run_steps(2);
    }
    from + Vec2::new(points as f32, 0.0)
}

fn tension_n(harness: &Harness<'_, ViewerApp>) -> f64 {
    harness.state().state.live.latest.solution.as_ref().unwrap().max_tension().tension_n
}

#[test]
fn a_pull_past_the_length_is_refused_at_first() {
    let (mut harness, from) = held(1e3);
    lead(&mut harness, from, 5.0);
    let state = &harness.state().state;
    assert!(state.document.fault.is_some() && state.live.playback.paused);
}

/// Issue 20: time stood still from then on, although the end was led back and let go within reach.
#[test]
fn issue_020_time_goes_on_once_an_end_is_back_within_reach() {
    for (ran, let_go_between) in [(true, false), (true, true), (false, false)] {
        let (mut harness, from) = held(1e3);
        if !ran {
            apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
        }
        let mut at = lead(&mut harness, from, 5.0);
        assert!(harness.state().state.document.fault.is_some() && harness.state().state.live.playback.paused);
        if let_go_between {
            press(&harness, at, false);
            harness.run_steps(3);
            assert!(harness.state().state.live.playback.paused, "out of reach");
            let now = support(&harness, "right");
            harness.hover_at(now);
            harness.step();
            press(&harness, now, true);
            harness.step();
            at = now;
        }
        let stopped_s = harness.state().state.live.now_s();
        let at = lead(&mut harness, at, -5.5);
        press(&harness, at, false);
        harness.run_steps(5);
        let state = &harness.state().state;
        assert_eq!((&state.document.fault, &state.live.latest.error), (&None, &None));
        assert_eq!(state.live.playback.paused, !ran, "as before the drag");
        harness.run_steps(30);
        let state = &harness.state().state;
        assert_eq!(state.live.now_s() > stopped_s + 0.3, ran, "{} s after {stopped_s} s", state.live.now_s());
        // It went on from where the cable was, without a snatch.
        let peak_n = state.live.history.samples.iter().map(|s| s.max_tension_n).fold(0.0, f64::max);
        assert!(!ran || peak_n < 3e3, "{peak_n} N");
    }
}

/// Issue 20: let go of out of reach, the support was put back where the cable had held it, in a
/// scene that has an answer, while the window went on refusing the one that it had been drawn to.
#[test]
fn issue_020_an_end_let_go_of_out_of_reach_stays_in_the_scene_that_is_refused() {
    let (mut harness, from) = held(1e3);
    let at = lead(&mut harness, from, 5.0);
    let place = |h: &Harness<'_, ViewerApp>| h.state().state.document.scene.cables[0].supports[1].at_m.unwrap();
    let drawn_to = place(&harness);
    assert!(drawn_to[0] > 14.0, "{drawn_to:?}");
    press(&harness, at, false);
    harness.run_steps(5);
    let state = &harness.state().state;
    assert_eq!(place(&harness), drawn_to);
    assert_eq!(state.document.fault.is_some(), state.document.scene.validate().is_err());
    assert!(state.document.fault.is_some() && state.live.playback.paused);
    // The mend that is offered is one of the scene that is shown.
    let mend = harness.get_all_by_label_contains("Set to ").next().expect("a mend is offered");
    mend.click();
    harness.run_steps(10);
    let state = &harness.state().state;
    assert_eq!((&state.document.fault, place(&harness)), (&None, drawn_to));
}

/// A pause while the end is out of reach stops time.
#[test]
fn issue_020_a_pause_out_of_reach_is_kept() {
    let (mut harness, from) = held(1e3);
    let at = lead(&mut harness, from, 5.0);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let at = lead(&mut harness, at, -5.5);
    press(&harness, at, false);
    harness.run_steps(10);
    let state = &harness.state().state;
    assert!(state.document.fault.is_none() && state.live.latest.error.is_none() && state.live.playback.paused);
}

/// A pull that was refused did not tell that it can pull.
#[test]
fn a_pull_that_is_refused_offers_to_pull_past_the_length() {
    let (mut harness, from) = held(1e3);
    let at = lead(&mut harness, from, 5.0);
    harness.run_steps(3);
    assert!(harness.state().state.document.fault.is_some());
    press(&harness, at, false);
    harness.run_steps(3);
    harness.get_by_label("Allow pulling beyond the cable's length").click();
    harness.run_steps(3);
    let state = &harness.state().state;
    assert!(state.solver.pulls_past_length && state.document.fault.is_none(), "{:?}", state.document.fault);
    assert!(harness.query_by_label("Allow pulling beyond the cable's length").is_none());
    // The drag had stopped time, and while that stands the same pull would be refused once more.
    assert!(!state.live.playback.paused, "a hand pulls while time runs");
    let again = support(&harness, "right");
    harness.hover_at(again);
    harness.step();
    press(&harness, again, true);
    harness.step();
    lead(&mut harness, again, 4.0);
    harness.run_steps(30);
    let state = &harness.state().state;
    assert!(state.document.fault.is_none() && !state.live.playback.paused, "{:?}", state.document.fault);
    assert!(tension_n(&harness) > 500.0, "{} N", tension_n(&harness));
    // A length that was typed is no pull.
    let mut harness = open_span();
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.length_m = 7.0;
    let edit = cable_viewer::command::SceneCommand::SetCable { cable: 0, value: Box::new(cable) };
    apply(&mut harness, Command::Scene(edit));
    assert!(harness.state().state.document.fault.is_some());
    assert!(harness.query_by_label("Allow pulling beyond the cable's length").is_none());
}

#[test]
fn s15_a_pull_past_the_length_pulls_harder_and_harder_until_the_cable_breaks() {
    let (mut harness, from) = held(4e3);
    apply(&mut harness, Command::Playback(PlaybackCommand::PullPastLength(true)));
    // Taut at 12 m: a metre beyond the spring pulls with kilonewtons.
    let mut at = lead(&mut harness, from, 3.0);
    harness.run_steps(60);
    let state = &harness.state().state;
    assert!(state.document.fault.is_none() && !state.live.playback.paused, "{:?}", state.document.fault);
    assert!(state.document.scene.validate().is_ok(), "the scene keeps a place that the cable reaches");
    let first_n = tension_n(&harness);
    assert!((1e3..8e3).contains(&first_n), "{first_n} N");
    at = lead(&mut harness, at, 0.6);
    harness.run_steps(60);
    let second_n = tension_n(&harness);
    assert!(second_n > first_n + 500.0 && second_n < 1e4, "{first_n} N, then {second_n} N");
    let broken = |h: &Harness<'_, ViewerApp>| {
        h.state().state.live.latest.solution.as_ref().is_some_and(|s| s.cables.iter().any(|c| !c.breaks.is_empty()))
    };
    assert!(!broken(&harness));
    at = lead(&mut harness, at, 2.0);
    harness.run_steps(60);
    assert!(broken(&harness), "{} N", tension_n(&harness));
    // Let go: the window goes on, and a reset makes the cable whole, held where it just reaches.
    press(&harness, at, false);
    harness.run_steps(10);
    assert!(harness.state().state.document.fault.is_none());
    assert_eq!(harness.state().state.live.latest.error, None);
    // Each support stands where its piece hangs, or where the cable last reached it, with no spring
    // beside it.
    let state = &harness.state().state;
    let solution = state.live.snapshot.solution.as_ref().unwrap();
    for (k, now) in solution.cables[0].supports.iter().enumerate() {
        let holds = now.reaction_x_n != 0.0 || now.reaction_y_n != 0.0;
        let last = state.document.scene.cables[0].supports[k].at_m;
        let stands = if holds { Some([now.x_m, now.y_m]) } else { last };
        assert_eq!(geometry::supports::support_position(state, 0, k), stands, "{}", now.name);
        assert_eq!(geometry::supports::hand_spring(state, 0, k), None, "{}", now.name);
    }
    // Issue 20: the form of a support that a piece hangs on said only where the scene had it first.
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    apply(&mut harness, Command::View(ViewCommand::Select(Some(Item::Support { cable: 0, support: 1 }))));
    harness.run_steps(3);
    // One that is torn off stands where the canvas has it, and says so.
    let [x, y] = geometry::supports::support_position(&harness.state().state, 0, 1).unwrap();
    let place = format!("({x:.3}, {y:.3}) m");
    assert_eq!(harness.query_all_by_label_contains(&place).count(), 1, "{place}");
    harness.get_by_label_contains("nothing, torn off");
    let said = |h: &Harness<'_, ViewerApp>| h.query_all_by_label_contains("(14.000, 5.000) m").count() > 0;
    assert!(!said(&harness), "it is where the form says");
    let live = &mut harness.state_mut().state.live;
    let mut answer = (**live.snapshot.solution.as_ref().unwrap()).clone();
    (answer.cables[0].supports[1].x_m, answer.cables[0].supports[1].reaction_y_n) = (14.0, 20.0);
    live.snapshot.solution = Some(Arc::new(answer));
    harness.run_steps(1);
    assert!(said(&harness));
    apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
    harness.run_steps(3);
    assert!(!broken(&harness) && tension_n(&harness) < 1e4, "{} N", tension_n(&harness));
}

/// Issue 20: a cable tore off both ends in a drag. The view went with what fell, and the held end
/// with the view, until the scene was refused as too short: time stood still.
#[test]
fn issue_020_a_cable_that_tears_in_a_drag_neither_moves_the_view_nor_stops_time() {
    let mut scene = cable_core::scene::catalog::hanging_span();
    (scene.cables[0].breaking_tension_n, scene.cables[0].service_tension_n) = (150.0, 100.0);
    let mut harness = crate::open(scene);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    let from = support(&harness, "right");
    harness.hover_at(from);
    harness.step();
    press(&harness, from, true);
    harness.step();
    let camera = harness.state().state.view.camera;
    let at = lead(&mut harness, from, 1.9);
    let mut broken_for = 0;
    for _ in 0..240 {
        harness.run_steps(1);
        let state = &harness.state().state;
        assert_eq!((&state.document.fault, &state.live.latest.error), (&None, &None));
        assert!(!state.live.playback.paused);
        broken_for += u32::from(!state.live.latest.solution.as_ref().unwrap().cables[0].breaks.is_empty());
    }
    assert!(broken_for > 60, "it tears: {broken_for}");
    assert_eq!(harness.state().state.view.camera, camera);
    // Past the length of the whole cable there is nothing that would be too short.
    let at = lead(&mut harness, at, 1.0);
    let state = &harness.state().state;
    assert!(state.document.fault.is_none() && !state.live.playback.paused, "{:?}", state.document.fault);
    press(&harness, at, false);
    harness.run_steps(10);
    let state = &harness.state().state;
    assert!(state.document.fault.is_none() && state.document.scene.validate().is_ok());
    assert_ne!(state.view.camera, camera, "let go, it goes with what falls");
}
