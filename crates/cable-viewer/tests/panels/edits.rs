//! Edits in a panel change the scene; the widgets are found by their names.

use cable_core::Model;
use cable_core::scene::SupportKind;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::panels;
use cable_viewer::state::{AppState, Item, NoAnswer, WorkerStatus};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::fixture::{Bench, PanelUi, bench, driven, outline_and_form, state, warn, with_pulley};

const TALL: [f32; 2] = [320.0, 900.0];

fn open(panel: PanelUi) -> Harness<'static, Bench> {
    open_with(state(), panel)
}

fn open_with(state: AppState, panel: PanelUi) -> Harness<'static, Bench> {
    let mut harness = bench(state, panel, TALL);
    harness.run();
    harness
}

/// Types into a field and presses Enter.
fn enter(harness: &mut Harness<'static, Bench>, label: &str, text: &str) {
    harness.get_by_label(label).focus();
    harness.run();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.get_by_label(label).type_text(text);
    harness.run();
    harness.key_press(egui::Key::Enter);
    harness.run();
}

fn click(harness: &mut Harness<'static, Bench>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

#[test]
fn every_cable_property_has_a_slider_a_field_and_a_reset() {
    let mut harness = open(panels::cable::ui);
    for property in &panels::cable::property::PROPERTIES {
        let quantity = property.quantity;
        let before = (property.get)(&harness.state().state.document.scene.cables[0]);
        let middle = 0.7 * quantity.usual[1] / quantity.unit.si;
        let slider = format!("{} slider", quantity.name);
        harness.get_by_label(&slider).set_value_accesskit(middle);
        harness.run();
        let moved = (property.get)(&harness.state().state.document.scene.cables[0]);
        assert!((moved / (0.7 * quantity.usual[1]) - 1.0).abs() < 1e-9, "{slider}: {moved}");
        click(&mut harness, &format!("Reset {}", quantity.name.to_lowercase()));
        let back = (property.get)(&harness.state().state.document.scene.cables[0]);
        assert_eq!(back, before, "reset {}", quantity.name);
        enter(&mut harness, quantity.name, &format!("{}", 0.5 * middle));
        let typed = (property.get)(&harness.state().state.document.scene.cables[0]);
        assert!((typed / (0.35 * quantity.usual[1]) - 1.0).abs() < 1e-9, "{}: {typed}", quantity.name);
    }
    assert_eq!(harness.state().state.document.undo.can_undo_and_redo(), (true, false));
}

#[test]
fn units_may_be_typed() {
    let mut harness = open(panels::cable::ui);
    enter(&mut harness, "Axial stiffness", "3 MN");
    enter(&mut harness, "Diameter", "3 cm");
    let cable = &harness.state().state.document.scene.cables[0];
    assert_eq!((cable.axial_stiffness_n, cable.diameter_m), (3e6, 0.03));
}

#[test]
fn text_that_is_no_number_is_kept_and_explained() {
    let mut harness = open(panels::cable::ui);
    enter(&mut harness, "Length", "12,5");
    assert_eq!(harness.state().commands, vec![]);
    assert_eq!(harness.get_by_label("Length").value().as_deref(), Some("12,5"));
    harness.get_by_label_contains("write the decimal mark as a point");
    click(&mut harness, "Reset length");
    assert_eq!(harness.get_by_label("Length").value().as_deref(), Some("12.00 m"));
    assert!(harness.query_by_label_contains("decimal mark").is_none());
}

#[test]
fn escape_drops_what_was_typed() {
    let mut harness = open(panels::cable::ui);
    harness.get_by_label("Length").focus();
    harness.run();
    harness.get_by_label("Length").type_text("7");
    harness.run();
    harness.key_press(egui::Key::Escape);
    harness.run();
    assert_eq!(harness.state().commands, vec![]);
    assert_eq!(harness.get_by_label("Length").value().as_deref(), Some("12.00 m"));
}

#[test]
fn a_cable_that_is_too_short_is_kept_explained_and_put_right_by_one_click() {
    let mut harness = open(panels::cable::ui);
    enter(&mut harness, "Length", "9");
    assert_eq!(harness.state().state.document.scene.cables[0].length_m, 9.0);
    harness.get_by_label_contains("needs ≥ 10.00 m, is 9.00 m");
    click(&mut harness, "Set to 10.00 m");
    assert_eq!(harness.state().state.document.scene.cables[0].length_m, 10.0);
    assert_eq!(harness.state().state.document.fault, None);
}

#[test]
fn a_number_out_of_range_is_kept_and_explained() {
    let mut harness = open(panels::cable::ui);
    enter(&mut harness, "Friction", "-1");
    assert_eq!(harness.state().state.document.scene.cables[0].friction, -1.0);
    harness.get_by_label_contains("0 to 10");
    click(&mut harness, "Set to 0.5");
    assert_eq!(harness.state().state.document.fault, None);
}

#[test]
fn a_preset_fills_in_the_figures_and_leaves_the_rest() {
    let mut harness = open(panels::cable::ui);
    click(&mut harness, "Cable preset");
    harness.get_by_label("HMPE rope, 12 strands, 10 mm").click();
    harness.run();
    let cable = &harness.state().state.document.scene.cables[0];
    assert_eq!(cable.preset.as_deref(), Some("hmpe-10"));
    assert_eq!((cable.length_m, cable.diameter_m), (12.0, 0.010));
    assert_eq!(harness.state().state.document.fault, None);
}

#[test]
fn segments_can_be_fixed_and_freed_and_self_contact_chosen() {
    let mut harness = open(panels::cable::ui);
    click(&mut harness, "Fixed number of segments");
    assert_eq!(harness.state().state.document.scene.cables[0].segments, Some(48));
    enter(&mut harness, "Segments", "64");
    assert_eq!(harness.state().state.document.scene.cables[0].segments, Some(64));
    click(&mut harness, "Fixed number of segments");
    assert_eq!(harness.state().state.document.scene.cables[0].segments, None);
    click(&mut harness, "Self-contact");
    assert!(harness.state().state.document.scene.cables[0].self_contact);
}

#[test]
fn a_renamed_cable_keeps_its_loads_and_is_one_edit() {
    let mut harness = open(panels::cable::ui);
    enter(&mut harness, "Cable name", "umbilical");
    let scene = &harness.state().state.document.scene;
    assert_eq!((scene.cables[0].name.as_str(), scene.loads[0].cable.as_str()), ("umbilical", "umbilical"));
    assert_eq!(scene.validate(), Ok(()));
}

#[test]
fn the_environment_changes_by_slider_and_typing() {
    let mut harness = open(panels::environment::ui);
    harness.get_by_label("Gravity slider").set_value_accesskit(1.62);
    harness.run();
    enter(&mut harness, "Wind to the right", "-3.5");
    enter(&mut harness, "Wind upwards", "0.25");
    enter(&mut harness, "Temperature rise", "40");
    let e = &harness.state().state.document.scene.environment;
    assert_eq!((e.gravity_m_per_s2, e.wind_n_per_m, e.temperature_change_k), (1.62, [-3.5, 0.25], 40.0));
    click(&mut harness, "Reset gravity");
    assert_eq!(harness.state().state.document.scene.environment.gravity_m_per_s2, 9.80665);
    click(&mut harness, "Plan view");
    assert_eq!(harness.state().state.document.scene.view, cable_core::scene::View::Plan);
}

#[test]
fn the_model_and_its_mesh_can_be_chosen() {
    let mut harness = open(panels::solver::ui);
    click(&mut harness, "Mass-spring");
    assert_eq!(harness.state().state.solver.model, Model::MassSpring);
    harness.get_by_label("Tolerance slider").set_value_accesskit(1.0);
    harness.run();
    assert!((harness.state().state.solver.settings.tolerance - 0.01).abs() < 1e-12);
    click(&mut harness, "Same number of segments for every cable");
    assert_eq!(harness.state().state.solver.settings.segments, Some(48));
    harness.get_by_label("Segments per cable slider").set_value_accesskit(200.0);
    harness.run();
    assert_eq!(harness.state().state.solver.settings.segments, Some(200));
    click(&mut harness, "Diagnostics");
    harness.get_by_label("1.234 ms");
}

#[test]
fn playback_runs_steps_resets_and_changes_speed() {
    let mut harness = bench(state(), panels::playback::ui, [900.0, 60.0]);
    harness.run();
    click(&mut harness, "Play");
    assert!(!harness.state().state.live.playback.paused);
    click(&mut harness, "Pause");
    click(&mut harness, "Step");
    click(&mut harness, "Reset");
    harness.get_by_label("Speed slider").set_value_accesskit(0.1);
    harness.run();
    assert_eq!(harness.state().state.live.playback.speed, 0.1);
    enter(&mut harness, "Speed", "50");
    assert_eq!(harness.state().state.live.playback.speed, 4.0);
    click(&mut harness, "Real-time speed");
    assert_eq!(harness.state().state.live.playback.speed, 1.0);
    let asked = &harness.state().commands;
    assert!(asked.contains(&Command::Playback(PlaybackCommand::Step)));
    assert!(asked.contains(&Command::Playback(PlaybackCommand::Reset)));
}

#[test]
fn supports_are_moved_changed_renamed_and_taken_out() {
    let mut harness = open(outline_and_form);
    click(&mut harness, "Select left");
    enter(&mut harness, "x of left", "0.125");
    enter(&mut harness, "y of left", "450 cm");
    assert_eq!(harness.state().state.document.scene.cables[0].supports[0].at_m, Some([0.125, 4.5]));
    click(&mut harness, "Add waypoint");
    let supports = &harness.state().state.document.scene.cables[0].supports;
    assert_eq!(
        (supports.len(), supports[1].kind, supports[1].at_m),
        (3, SupportKind::Pulley, Some([5.0, 5.0 - 2.9652]))
    );
    // The new one is selected, so its details are open.
    enter(&mut harness, "Wheel radius", "150");
    enter(&mut harness, "Support name", "stop 1");
    click(&mut harness, "Kind of stop 1");
    click(&mut harness, "Fixed");
    let stop = &harness.state().state.document.scene.cables[0].supports[1];
    assert_eq!((stop.name.as_str(), stop.kind, stop.radius_m), ("stop 1", SupportKind::Fixed, None));
    assert!(stop.arc_length_m.is_some());
    assert_eq!(harness.state().state.document.fault, None);
    click(&mut harness, "Remove stop 1");
    assert_eq!(harness.state().state.document.scene.cables[0].supports.len(), 2);
}

#[test]
fn a_fault_of_a_support_stands_below_it() {
    let mut state = state();
    with_pulley(&mut state);
    state.selection.selected = Some(Item::Support { cable: 0, support: 1 });
    let mut harness = open_with(state, outline_and_form);
    enter(&mut harness, "Pulley friction", "-2");
    harness.get_by_label_contains("Friction: ");
    assert_eq!(harness.state().state.document.scene.cables[0].supports[1].friction, Some(-2.0));
}

#[test]
fn obstacles_are_moved_changed_added_and_taken_out() {
    let mut harness = open(outline_and_form);
    click(&mut harness, "Select post");
    enter(&mut harness, "x of post", "4.25");
    enter(&mut harness, "Radius", "0.3");
    enter(&mut harness, "Obstacle name", "pipe");
    click(&mut harness, "Select floor");
    enter(&mut harness, "y of corner 2", "0.5");
    let obstacles = &harness.state().state.document.scene.obstacles;
    assert_eq!(obstacles[1].name, "pipe");
    assert_eq!(obstacles[1].shape, cable_core::scene::Shape::Circle { center_m: [4.25, 2.5], radius_m: 0.3 });
    assert_eq!(obstacles[0].shape, cable_core::scene::Shape::Terrain { points_m: vec![[-1.0, 0.0], [20.0, 0.5]] });
    click(&mut harness, "Add obstacle");
    click(&mut harness, "Beam");
    assert_eq!(harness.state().state.document.scene.obstacles[2].name, "beam");
    click(&mut harness, "Select pipe");
    click(&mut harness, "Remove pipe");
    assert_eq!(harness.state().state.document.scene.obstacles.len(), 2);
    assert_eq!(harness.state().state.document.fault, None);
}

#[test]
fn loads_are_moved_changed_added_and_taken_off() {
    let mut harness = open(outline_and_form);
    click(&mut harness, "Select load 1");
    enter(&mut harness, "Place of load 1", "3");
    enter(&mut harness, "Force upwards of load 1", "-0.2 kN");
    let load = &harness.state().state.document.scene.loads[0];
    assert_eq!((load.arc_length_m, load.force_n), (3.0, Some([0.0, -200.0])));
    click(&mut harness, "Add load");
    assert_eq!(harness.state().state.document.scene.loads.len(), 2);
    click(&mut harness, "Select load 1");
    click(&mut harness, "Remove load 1");
    assert_eq!(harness.state().state.document.scene.loads.len(), 1);
}

#[test]
fn scenes_and_maps_can_be_picked() {
    let mut harness = open(panels::scene::ui);
    enter(&mut harness, "Scene name", "My tank");
    assert_eq!(harness.state().state.document.scene.name, "My tank");
    click(&mut harness, "Map");
    click(&mut harness, "None");
    assert!(harness.state().state.document.scene.obstacles.is_empty());
    click(&mut harness, "Open scene");
    click(&mut harness, "Hanging span");
    let opened = harness.state().commands.last();
    assert!(matches!(opened, Some(Command::File(FileCommand::OpenCatalogue(_)))), "{opened:?}");
}

#[test]
fn readouts_tell_the_figures_and_where() {
    let mut harness = open(panels::readouts::ui);
    assert_eq!(harness.get_all_by_label("717.1 N").count(), 3);
    harness.get_by_label("2.965 m");
    harness.get_by_label("± 0.0320 %");
    harness.get_by_label_contains("of service 800.0 N");
    harness.get_by_label("left: 717.1 N at -39°");
    click(&mut harness, "Show sag");
    let shown = harness.state().commands.last();
    assert_eq!(shown, Some(&Command::View(ViewCommand::CentreOn([5.0, 5.0 - 2.9652]))));
}

/// The work of the forces on a robot stands in its panel: together it is its energy of motion.
#[test]
fn the_robot_panel_tells_the_work_of_the_forces_on_it() {
    let harness = open_with(driven(), panels::robot::ui);
    for name in ["Work of the tracks", "Work of the cable", "Work of rolling resistance", "Work of weight and ground"] {
        harness.get_by_label(name);
    }
    for work_j in [2874.0, -1068.0, -1210.0, -474.5] {
        harness.get_by_label(&cable_viewer::units::format::energy(work_j));
    }
}

#[test]
fn warnings_show_their_place_and_offer_the_fix() {
    let mut state = state();
    warn(&mut state);
    let mut harness = open_with(state, crate::fixture::warnings);
    harness.get_by_label_contains("Above service tension at 0.00");
    assert!(harness.query_by_label("Show warning 1").is_none(), "one line each");
    click(&mut harness, "Details of warning 1");
    click(&mut harness, "Show warning 1");
    assert!(matches!(harness.state().commands.first(), Some(Command::View(ViewCommand::ZoomOn(_)))));
    click(&mut harness, "Details of warning 2");
    click(&mut harness, "Use 96 segments");
    assert_eq!(harness.state().state.solver.settings.segments, Some(96));
}

#[test]
fn a_broken_scene_and_a_dead_solver_are_said_with_their_fix() {
    let mut state = state();
    state.document.scene.cables[0].length_m = 9.0;
    state.document.fault = state.document.scene.validate().err();
    state.live.snapshot.error = Some(NoAnswer::Panicked { message: "something".to_owned() });
    state.solver.status = WorkerStatus::Dead("the solver thread has ended".to_owned());
    let mut harness = open_with(state, crate::fixture::warnings);
    harness.get_by_label_contains("last scene that could be solved");
    click(&mut harness, "Set to 10.00 m");
    assert_eq!(harness.state().state.document.fault, None);
    harness.get_by_label_contains("The solver stopped by a fault of its own (something)");
    click(&mut harness, "Restart the solver");
    assert!(harness.state().commands.contains(&Command::File(FileCommand::RestartWorker)));
    assert!(harness.state().commands.contains(&Command::Scene(SceneCommand::EditDone)));
}

#[test]
fn the_graphs_switch_quantity_and_say_their_last_values() {
    let mut harness = bench(state(), panels::plots::ui, [900.0, 260.0]);
    harness.run();
    harness.get_by_label("Over time");
    harness.get_by_label("Along the cable");
    for quantity in ["Stress", "Strain", "Tension"] {
        click(&mut harness, quantity);
    }
    click(&mut harness, "Follow");
    click(&mut harness, "Time window");
    click(&mut harness, "All");
    assert_eq!(harness.state().commands, vec![]);
}

#[test]
fn a_load_that_changes_with_time_is_a_table() {
    let mut state = state();
    state.selection.selected = Some(Item::Load(0));
    let mut harness = open_with(state, outline_and_form);
    let load = |h: &Harness<'static, Bench>| h.state().state.document.scene.loads[0].clone();
    let before = load(&harness);
    click(&mut harness, "load 1 changes with time");
    assert_eq!((load(&harness).times_s, load(&harness).forces_n), (vec![0.0, 5.0], vec![[0.0, -50.0]; 2]));
    enter(&mut harness, "Up 2 of load 1", "-90");
    enter(&mut harness, "Time 2 of load 1", "8");
    click(&mut harness, "Add a time after 1 of load 1");
    assert_eq!(load(&harness).times_s, [0.0, 4.0, 8.0]);
    assert_eq!(load(&harness).forces_n, [[0.0, -50.0], [0.0, -70.0], [0.0, -90.0]]);
    assert_eq!(harness.state().state.document.fault, None);
    // Times that do not increase are said where they are typed.
    enter(&mut harness, "Time 2 of load 1", "9");
    assert!(harness.state().state.document.fault.as_ref().is_some_and(|f| f.path.starts_with("loads[0].times_s")));
    click(&mut harness, "Remove time 2 of load 1");
    assert_eq!(harness.state().state.document.fault, None);
    click(&mut harness, "load 1 changes with time");
    assert_eq!(load(&harness), before);
}

#[test]
fn wind_that_changes_with_time_is_a_table() {
    let mut harness = open(panels::environment::ui);
    let wind = |h: &Harness<'static, Bench>| h.state().state.document.scene.environment.clone();
    let before = wind(&harness);
    click(&mut harness, "Wind changes with time");
    enter(&mut harness, "Right 2 of wind", "12");
    assert_eq!(wind(&harness).winds_n_per_m, [[0.0, 0.0], [12.0, 0.0]]);
    assert_eq!(wind(&harness).wind_times_s, [0.0, 5.0]);
    assert_eq!(harness.state().state.document.fault, None);
    enter(&mut harness, "Time 2 of wind", "-1");
    assert!(harness.state().state.document.fault.is_some());
    harness.get_by_label_contains("times must increase");
    click(&mut harness, "Wind changes with time");
    assert_eq!(wind(&harness), before);
}

#[test]
fn a_support_moves_lets_go_and_pulls_by_times() {
    let mut state = state();
    state.selection.selected = Some(Item::Support { cable: 0, support: 1 });
    let mut harness = open_with(state, outline_and_form);
    let right = |h: &Harness<'static, Bench>| h.state().state.document.scene.cables[0].supports[1].clone();
    let at_m = right(&harness).at_m.unwrap();
    click(&mut harness, "Follows a schedule");
    enter(&mut harness, "x 2 of right", "11");
    let motion = right(&harness).motion.expect("a motion");
    assert_eq!((motion.times_s, motion.points_m), (vec![0.0, 5.0], vec![at_m, [11.0, at_m[1]]]));
    // The motion begins at the place of the support.
    enter(&mut harness, "y 1 of right", "4.5");
    assert_eq!(right(&harness).at_m, Some([at_m[0], 4.5]));
    assert_eq!(harness.state().state.document.fault, None);
    click(&mut harness, "Follows a schedule");
    assert_eq!(right(&harness).motion, None);
    click(&mut harness, "Releases the cable at a set time");
    enter(&mut harness, "Release time", "2.5");
    assert_eq!(right(&harness).release_s, Some(2.5));
    assert_eq!(harness.state().state.document.fault, None);
    click(&mut harness, "Releases the cable at a set time");
    assert_eq!(right(&harness).release_s, None);
    // A dead load of a support.
    let support = &mut harness.state_mut().state.document.scene.cables[0].supports[1];
    (support.kind, support.at_m, support.force_n) = (SupportKind::Load, None, Some([0.0, -40.0]));
    harness.run();
    click(&mut harness, "Force changes with time");
    enter(&mut harness, "Up 2 of right", "-80");
    assert_eq!((right(&harness).force_n, right(&harness).forces_n), (None, vec![[0.0, -40.0], [0.0, -80.0]]));
    click(&mut harness, "Force changes with time");
    assert_eq!((right(&harness).force_n, right(&harness).times_s), (Some([0.0, -40.0]), vec![]));
}
