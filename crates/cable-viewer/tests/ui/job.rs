//! These tests set up a tank job from the first scene as someone does who knows nothing of it: map,
//! robot, opening; every model asked about it.

use cable_core::scene::{Ground, SupportKind, catalog, preset};
use cable_core::{Model, Scene};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::jobs::model_comparison::Progress;
use cable_viewer::state::{AppState, Item};
use egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn tall(scene: Scene) -> Harness<'static, ViewerApp> {
    let mut harness = open(scene);
    harness.set_size(Vec2::new(1280.0, 1800.0));
    harness.run_steps(3);
    harness
}

/// Clicks the last thing of a name: an open list is above what it covers.
fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_all_by_label(label).last().unwrap_or_else(|| panic!("{label}")).click();
    harness.run_steps(3);
}

#[test]
fn a_first_robot_stands_in_the_tank_with_the_cable_on_its_hitch() {
    for map in preset::map_presets() {
        for robot in preset::robot_presets() {
            let mut harness = tall(catalog::hanging_span());
            crate::select(&mut harness, Item::Scene);
            click(&mut harness, "Map");
            click(&mut harness, &map.name);
            let end = state(&harness).document.scene.cables[0].supports[1].at_m.unwrap();
            let before = state(&harness).document.scene.clone();
            click(&mut harness, "Robot");
            click(&mut harness, &robot.name);
            let what = format!("{} in {}", robot.name, map.name);
            let scene = &state(&harness).document.scene;
            assert_eq!(scene.cables[0].supports[1].kind, SupportKind::Robot, "{what}");
            let at = scene.robot.as_ref().unwrap_or_else(|| panic!("{what}: none")).at_m;
            let stand = Ground::of(scene).stand(at[0], robot.track_half_length_m());
            let stand = stand.unwrap_or_else(|| panic!("{what}: no ground at {at:?}"));
            assert!(stand.pitch.abs() < 0.21 && (stand.height - at[1]).abs() < 1e-9, "{what}: {stand:?}, {at:?}");
            assert!(at[1] < end[1] && at[0].abs() < 0.5 * map.inside_width_m.value, "{what}: on the wall, {at:?}");
            // One step back for all of it.
            harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
            harness.run_steps(2);
            assert_eq!(state(&harness).document.scene, before, "{what}");
        }
    }
}

#[test]
fn a_robot_turns_its_back_to_where_the_cable_comes_from() {
    let mut scene = catalog::hanging_span();
    scene.cables[0].supports.reverse();
    scene.cables[0].supports[0].name = "start".to_owned();
    scene.obstacles.push(catalog::robot_drive().obstacles[0].clone());
    let mut harness = tall(scene);
    crate::select(&mut harness, Item::Scene);
    click(&mut harness, "Robot");
    click(&mut harness, &preset::robot_presets()[0].name);
    let scene = &state(&harness).document.scene;
    let (robot, hitch) = (scene.robot.as_ref().unwrap(), scene.hitch_m().unwrap());
    assert_eq!(robot.heading, cable_core::scene::Heading::Left);
    assert!(hitch[0] > robot.at_m[0] && hitch[0].abs() < 1.0, "{hitch:?}, {:?}", robot.at_m);
}

/// In a plan view the robot was drawn from the side.
#[test]
fn issue_020_a_robot_in_a_plan_view_is_seen_from_above() {
    let mut scene = catalog::robot_drive();
    scene.view = cable_core::scene::View::Plan;
    scene.obstacles.clear();
    let wide = preset::robot_preset(&scene.robot.as_ref().unwrap().preset).unwrap().width_m.value;
    let harness = tall(scene);
    let outline = cable_viewer::geometry::robot::robot_outline(state(&harness));
    let hitch = state(&harness).document.scene.hitch_m().unwrap();
    let [low, high] = cable_viewer::geometry::robot::extent(outline.iter().map(|p| p[1]));
    assert!((high - low - wide).abs() < 1e-9 && (0.5 * (low + high) - hitch[1]).abs() < 1e-9, "{outline:?} {hitch:?}");
}

#[test]
fn a_tank_job_is_set_up_and_driven_from_the_first_scene() {
    let mut harness = tall(catalog::hanging_span());
    let map = preset::map_presets().iter().find(|m| m.id == "saltcake-75ft").unwrap();
    crate::select(&mut harness, Item::Scene);
    click(&mut harness, "Map");
    click(&mut harness, &map.name);
    click(&mut harness, "Robot");
    click(&mut harness, &preset::robot_presets()[0].name);
    click(&mut harness, "Route the cable through the tank opening");
    assert_eq!(state(&harness).document.scene.cables[0].supports[0].at_m, Some(map.riser_at_m));
    assert!(harness.query_by_label("Route the cable through the tank opening").is_none(), "it is there");
    // Too short for that, which is said with the remedy.
    assert!(state(&harness).document.fault.is_some());
    harness.get_all_by_label_contains("Set to ").next().expect("the fix is offered").click();
    harness.run_steps(3);
    assert_eq!(state(&harness).document.fault, None);
    assert_eq!(state(&harness).live.snapshot.error, None);
    let x = |h: &Harness<'_, ViewerApp>| state(h).live.latest.solution.as_ref().unwrap().robot.unwrap().x_m;
    let before = x(&harness);
    let key = |pressed| egui::Event::Key {
        key: Key::A,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    harness.event(key(true));
    harness.run_steps(90);
    harness.event(key(false));
    harness.run_steps(2);
    assert_eq!(state(&harness).live.snapshot.error, None);
    assert!(x(&harness) < before - 0.1, "{before} m to {} m", x(&harness));
}

fn asked(harness: &mut Harness<'_, ViewerApp>) {
    let began = std::time::Instant::now();
    while matches!(state(harness).analysis.models, Progress::Running(..)) {
        assert!(began.elapsed() < std::time::Duration::from_secs(60), "it takes too long");
        std::thread::sleep(std::time::Duration::from_millis(5));
        harness.step();
    }
    harness.run_steps(2);
}

#[test]
fn s16_every_model_of_a_scene_is_held_with_its_cost_and_refusals_are_told() {
    let mut harness = tall(catalog::over_beam());
    click(&mut harness, "Compare all models");
    asked(&mut harness);
    let models: Vec<Model> = state(&harness).analysis.references.iter().map(|h| h.solution.model).collect();
    assert_eq!(models, [Model::Spans, Model::Fem, Model::MassSpring]);
    harness.get_by_label_contains("Catenary cannot answer this scene: ");
    let most: Vec<f64> =
        state(&harness).analysis.references.iter().map(|h| h.solution.max_tension().tension_n).collect();
    assert!(most.iter().all(|n| (n / most[0] - 1.0).abs() < 0.1), "{most:?}");
    for held in &state(&harness).analysis.references {
        assert!(held.wall_s > 0.0 && held.solution.time_s == 0.0);
        let cost = cable_viewer::units::format::rough_duration(held.wall_s);
        assert!(harness.query_all_by_label(&cost).next().is_some(), "{cost}");
    }
    // Again: in their place, not beside them.
    click(&mut harness, "Compare all models");
    asked(&mut harness);
    assert_eq!(state(&harness).analysis.references.len(), 3);
    // On the way its progress is shown, and it can be ended.
    harness.state_mut().state.analysis.models = Progress::Running(0.5, None);
    harness.run_steps(2);
    harness.get_by_label("Progress of the comparison");
    click(&mut harness, "Cancel comparison");
    assert!(matches!(state(&harness).analysis.models, Progress::None));
    // A job that was ended leaves no result, however soon one comes.
    apply(&mut harness, Command::View(ViewCommand::RemoveReferences(None)));
    let ctx = harness.ctx.clone();
    let commands = [ViewCommand::CompareModels, ViewCommand::EndModelComparison].map(Command::View);
    harness.state_mut().apply(&ctx, commands.into());
    std::thread::sleep(std::time::Duration::from_millis(300));
    harness.run_steps(3);
    assert!(
        matches!(state(&harness).analysis.models, Progress::None) && state(&harness).analysis.references.is_empty()
    );
}
