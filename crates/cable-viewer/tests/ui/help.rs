//! The window helps its user: guided scenes, hover help and a name on every control, the picture in
//! words, the keyboard alone.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::app::guidance::tutorials::TUTORIALS;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::dialog::SceneReplacement;
use cable_viewer::state::{AppState, Item};
use egui::accesskit::Role;
use egui::{Key, Modifiers, Order, Pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{apply, open, open_span};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

/// Controls of the window: what they are called, their kind, and where they are.
pub fn controls(harness: &Harness<'_, ViewerApp>) -> Vec<(String, Role, Pos2)> {
    let mut out = Vec::new();
    let mut left = vec![harness.root()];
    while let Some(node) = left.pop() {
        left.extend(node.children());
        let inner = node.accesskit_node();
        let role = inner.role();
        let kinds = [
            Role::Button,
            Role::CheckBox,
            Role::RadioButton,
            Role::Slider,
            Role::SpinButton,
            Role::TextInput,
            Role::MultilineTextInput,
            Role::ComboBox,
            Role::Link,
        ];
        if kinds.contains(&role) {
            let name = inner.label().unwrap_or_default();
            out.push((name, role, node.rect().center()));
        }
    }
    out
}

#[test]
fn u11_every_control_has_a_name() {
    for scene in [catalog::robot_drive(), catalog::loads_wind_heat(), catalog::pulley_waypoints()] {
        let mut harness = open(scene);
        apply(&mut harness, Command::View(ViewCommand::AddReference));
        let all = controls(&harness);
        assert!(all.len() > 60, "{}", all.len());
        // A sign is no name.
        let nameless: Vec<_> = all.iter().filter(|(name, ..)| !name.contains(char::is_alphabetic)).collect();
        assert!(nameless.is_empty(), "{nameless:?}");
    }
}

#[test]
fn u11_every_control_explains_itself_on_hover() {
    every_control_explains_itself(open(catalog::robot_drive()), None);
}

/// These panels open for a selection, or exist in some scenes only.
#[test]
fn u11_every_control_of_what_is_picked_explains_itself_on_hover() {
    for (scene, item) in [
        (catalog::loads_wind_heat(), Item::Load(0)),
        (catalog::pulley_waypoints(), Item::Support { cable: 0, support: 1 }),
        (catalog::over_beam(), Item::Obstacle(0)),
        (catalog::round_post(), Item::Obstacle(0)),
    ] {
        every_control_explains_itself(open(scene), Some(item));
    }
    // A support that moves and lets go; a cable that is too short, with what puts it right.
    let mut scene = catalog::floor_drag();
    let moved = scene.cables[0].supports.iter().position(|s| s.motion.is_some()).unwrap();
    scene.cables[0].supports[moved].release_s = Some(1.0);
    every_control_explains_itself(open(scene), Some(Item::Support { cable: 0, support: moved }));
    let mut harness = open(catalog::hanging_span());
    let mut value = state(&harness).document.scene.cables[0].clone();
    value.length_m = 7.0;
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(value) }));
    apply(&mut harness, Command::View(ViewCommand::SetFrictionRange { shown: true, factors: [0.5, 1.5] }));
    let from = cable_core::analysis::tension_budget::StartEnd::Start;
    let probe = cable_viewer::state::TensionMarker { cable: 0, arc_length_m: 4.0, from };
    apply(&mut harness, Command::View(ViewCommand::SetTensionMarker(Some(probe))));
    every_control_explains_itself(harness, None);
}

fn every_control_explains_itself(mut harness: Harness<'static, ViewerApp>, picked: Option<Item>) {
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    apply(&mut harness, Command::View(ViewCommand::Select(picked)));
    harness.ctx.all_styles_mut(|style| {
        style.interaction.tooltip_delay = 0.0;
        style.interaction.show_tooltips_only_when_still = false;
    });
    // Tall enough that nothing is scrolled out of sight.
    harness.set_size(egui::Vec2::new(1600.0, 3000.0));
    harness.run_steps(4);
    let mut silent = Vec::new();
    for (name, role, at) in controls(&harness) {
        harness.hover_at(at);
        harness.run_steps(3);
        let told = harness.ctx.memory(|m| m.areas().visible_layer_ids().iter().any(|l| l.order == Order::Tooltip));
        if !told {
            silent.push((name, role));
        }
    }
    // These controls need no help beyond their own words.
    let plain = ["File", "Edit", "View", "Tools", "Scenes", "Learn"];
    silent.retain(|(name, _)| !plain.contains(&name.as_str()));
    assert!(silent.is_empty(), "{} without help: {silent:?}", silent.len());
}

#[test]
fn u11_every_entry_of_the_menus_explains_itself_on_hover() {
    for menu in ["File", "Edit", "View", "Tools", "Scenes", "Learn"] {
        let mut harness = open(catalog::hanging_span());
        harness.ctx.all_styles_mut(|style| {
            style.interaction.tooltip_delay = 0.0;
            style.interaction.show_tooltips_only_when_still = false;
        });
        harness.set_size(egui::Vec2::new(1600.0, 1600.0));
        harness.run_steps(4);
        let before: Vec<String> = controls(&harness).into_iter().map(|(name, ..)| name).collect();
        harness.get_by_role_and_label(Role::Button, menu).click();
        harness.run_steps(3);
        let entries: Vec<_> = controls(&harness).into_iter().filter(|(name, ..)| !before.contains(name)).collect();
        // Half of the tools stand in their sections too.
        assert!(entries.len() >= 4, "{menu}: {entries:?}");
        let mut silent = Vec::new();
        for (name, _, at) in entries {
            // The pointer comes from beside: a menu that has just opened takes no notice of one
            // that was there.
            for by in [3.0, 0.0] {
                harness.hover_at(at + egui::Vec2::new(by, 0.0));
                harness.run_steps(2);
            }
            let layers = harness.ctx.memory(|m| m.areas().visible_layer_ids());
            if !layers.iter().any(|l| l.order == Order::Tooltip) {
                silent.push(name);
            }
        }
        // It opens its own list when the pointer is on it.
        silent.retain(|name| name != "Colours");
        assert!(silent.is_empty(), "{menu}: {silent:?}");
    }
}

#[test]
fn the_picture_is_told_in_words() {
    let mut harness = open(catalog::robot_drive());
    let told = |h: &Harness<'_, ViewerApp>| h.get_by_label("Canvas").accesskit_node().description().unwrap_or_default();
    let text = told(&harness);
    for part in ["1 cable", "1 obstacle", "a robot", "riser at (0.000, 5.000) m", "greatest tension", "standing"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    apply(&mut harness, Command::View(ViewCommand::Select(Some(Item::Robot))));
    assert!(told(&harness).contains("selected: the robot"));
}

#[test]
fn t01_six_guided_scenes_lead_from_step_to_step() {
    let mut harness = open_span();
    for (k, guide) in TUTORIALS.iter().enumerate() {
        harness.get_by_label("Learn").click();
        harness.run_steps(3);
        harness.get_by_label(&format!("{}. {}", k + 1, guide.title)).click();
        harness.run_steps(4);
        // The scene before may have unsaved changes.
        if state(&harness).ui.dialog.is_some() {
            harness.get_by_label("Discard changes").click();
            harness.run_steps(4);
        }
        assert_eq!(state(&harness).ui.tutorial.map(|p| (p.tutorial, p.step)), Some((k, 0)), "{}", guide.title);
        harness.get_by_label_contains(guide.steps[0].text);
    }
    // The first one, done.
    apply(
        &mut harness,
        Command::File(FileCommand::Discard(SceneReplacement::OpenTutorial { tutorial: 0, scene: TUTORIALS[0].scene })),
    );
    let item = Item::Support { cable: 0, support: 1 };
    apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: [9.0, 5.0] }));
    harness.run_steps(2);
    assert_eq!(state(&harness).ui.tutorial.map(|p| p.step), Some(1), "what was done is seen");
    harness.get_by_label("Next").click();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    harness.get_by_label("Done");
    harness.get_by_label("End guide").click();
    harness.run_steps(2);
    assert_eq!(state(&harness).ui.tutorial, None);
}

/// Each step of each guide, done as it says: the guide sees it and goes on, and what it says
/// happens.
#[test]
fn t01_every_step_of_every_guide_can_be_done_as_it_says() {
    fn at(harness: &Harness<'_, ViewerApp>) -> Option<usize> {
        state(harness).ui.tutorial.map(|p| p.step)
    }
    fn next(harness: &mut Harness<'_, ViewerApp>) {
        harness.get_by_label("Next").click();
        harness.run_steps(2);
    }
    fn start(k: usize) -> Harness<'static, ViewerApp> {
        let mut harness = open_span();
        harness.set_size(egui::Vec2::new(1280.0, 1800.0));
        apply(&mut harness, Command::SetModel(cable_core::Model::Auto));
        apply(
            &mut harness,
            Command::File(FileCommand::Discard(SceneReplacement::OpenTutorial {
                tutorial: k,
                scene: TUTORIALS[k].scene,
            })),
        );
        harness.run_steps(3);
        assert_eq!(at(&harness), Some(0), "{}", TUTORIALS[k].title);
        harness
    }
    fn hold(harness: &mut Harness<'_, ViewerApp>, key: Key, frames: usize) {
        let modifiers = Modifiers::NONE;
        for pressed in [true, false] {
            harness.event(egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
            harness.run_steps(if pressed { frames } else { 2 });
        }
    }
    fn typed(harness: &mut Harness<'_, ViewerApp>, label: &str, text: &str) {
        let field = harness.get_all_by_label(label).find(|n| n.accesskit_node().role() == Role::TextInput).unwrap();
        field.focus();
        harness.step();
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.step();
        let field = harness.get_all_by_label(label).find(|n| n.accesskit_node().role() == Role::TextInput).unwrap();
        field.type_text(text);
        harness.step();
        harness.key_press(Key::Enter);
        harness.run_steps(4);
    }

    // 1. Drag an end.
    let mut harness = start(0);
    let from = crate::support(&harness, "right");
    crate::drag(&mut harness, from, egui::Vec2::new(-60.0, -40.0));
    assert_eq!(at(&harness), Some(1));
    harness.get_by_label("Readouts");
    next(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    harness.get_by_label("Done");

    // 2. Change the cable.
    let mut harness = start(1);
    harness.get_by_label("Select cable").click();
    harness.run_steps(3);
    assert_eq!(at(&harness), Some(1));
    typed(&mut harness, "Linear density", "2");
    assert_eq!(at(&harness), Some(2));
    next(&mut harness);
    typed(&mut harness, "Length", "8.5");
    assert_eq!(at(&harness), Some(4), "{:?}", state(&harness).document.fault);
    harness.get_by_label("The scene cannot be solved");
    let fix = harness.get_all_by_label_contains("Set to ").next().expect("the fix is offered");
    fix.click();
    harness.run_steps(3);
    assert_eq!(state(&harness).document.fault, None);
    harness.get_by_label("Done");

    // 3. Waypoints.
    let mut harness = start(2);
    let answer = state(&harness).live.snapshot.solution.clone().unwrap();
    let node = answer.cables[0].nodes[answer.cables[0].nodes.len() / 2];
    let canvas = harness.get_by_label("Canvas").rect();
    let place = state(&harness).view.camera.to_screen(canvas, [node.x_m, node.y_m]);
    harness.hover_at(place);
    harness.step();
    for pressed in [true, false, true, false] {
        crate::press(&harness, place, pressed);
        harness.step();
    }
    harness.run_steps(3);
    assert_eq!(at(&harness), Some(1));
    let canvas = harness.get_by_label("Canvas").rect();
    let rise = 2.8 * state(&harness).view.camera.points_per_m as f32;
    let place = state(&harness)
        .view
        .camera
        .to_screen(canvas, state(&harness).document.scene.cables[0].supports[1].at_m.unwrap());
    crate::drag(&mut harness, place, egui::Vec2::new(0.0, -rise));
    assert_eq!(at(&harness), Some(2), "{:?}", state(&harness).document.scene.cables[0].supports[1]);
    assert_eq!(state(&harness).live.snapshot.error, None);
    harness.get_by_label("Wheel radius");
    harness.key_press(Key::Delete);
    harness.run_steps(3);
    harness.get_by_label("Done");

    // 4. Time.
    let mut harness = start(3);
    harness.key_press(Key::Space);
    harness.run_steps(30);
    assert_eq!(at(&harness), Some(1));
    assert!(state(&harness).live.history.samples.len() > 10, "the graphs fill");
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert_eq!(at(&harness), Some(2));
    harness.key_press(Key::ArrowLeft);
    harness.run_steps(3);
    assert_eq!(at(&harness), Some(3));
    harness.get_by_label("Latest").click();
    harness.run_steps(3);
    harness.get_by_label("Done");

    // 5. Drive.
    let mut harness = start(4);
    hold(&mut harness, Key::D, 80);
    assert_eq!(at(&harness), Some(1), "{:?}", state(&harness).live.latest.solution.as_ref().and_then(|s| s.robot));
    harness.get_by_label("Select robot").click();
    harness.run_steps(3);
    for row in ["Slope", "Pull of the cable", "Track force"] {
        harness.get_by_label(row);
    }
    assert_eq!(at(&harness), Some(2));
    harness.get_by_label("Find safe reach").click();
    harness.run_steps(2);
    assert!(matches!(
        state(&harness).analysis.safe_reach.progress,
        cable_viewer::jobs::safe_reach::Progress::Running(..)
    ));

    // 6. Compare.
    let mut harness = start(5);
    harness.get_by_label("Pin this result").click();
    harness.run_steps(3);
    assert_eq!(at(&harness), Some(1));
    harness.get_by_label("Select cable").click();
    harness.run_steps(3);
    typed(&mut harness, "Length", "12.5");
    assert_eq!(at(&harness), Some(2));
    harness.get_by_label_contains("Length: ");
    assert!(harness.get_all_by_label_contains("Export").count() >= 2, "one beside each graph");
    harness.get_by_label("File").click();
    harness.run_steps(3);
    harness.get_by_label("Save run…");
}

#[test]
fn escape_closes_a_menu_or_list_before_it_drops_what_is_picked() {
    let mut harness = open_span();
    let item = Item::Support { cable: 0, support: 1 };
    apply(&mut harness, Command::View(ViewCommand::Select(Some(item))));
    for (opener, entry) in [("File", "Save run…"), ("Time window", "Last 60 s")] {
        harness.get_by_label(opener).click();
        harness.run_steps(3);
        harness.get_by_label(entry);
        harness.key_press(Key::Escape);
        harness.run_steps(3);
        assert!(harness.query_by_label(entry).is_none(), "{opener} is still open");
        assert_eq!(state(&harness).selection.selected, Some(item));
    }
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert_eq!(state(&harness).selection.selected, None);
}

/// Text fields stand out from their dialog in both themes.
#[test]
fn fields_stand_off_dialogs_and_panels() {
    let harness = open_span();
    for theme in [egui::Theme::Light, egui::Theme::Dark] {
        let visuals = harness.ctx.style_of(theme).visuals.clone();
        for behind in [visuals.window_fill, visuals.panel_fill] {
            let far = (0..3).map(|k| visuals.extreme_bg_color[k].abs_diff(behind[k])).max().unwrap();
            assert!(far >= 8, "{theme:?}: {:?} on {behind:?}", visuals.extreme_bg_color);
            let rail = visuals.widgets.inactive.bg_fill;
            let far = (0..3).map(|k| rail[k].abs_diff(behind[k])).max().unwrap();
            assert!(far >= 20, "{theme:?}: rails {rail:?} on {behind:?}");
        }
    }
}

/// If there is no room for graphs below the canvas, they are in the one panel, and the canvas is
/// larger than its labels.
#[test]
fn small_windows_keep_a_canvas_and_have_all_panels() {
    let mut harness = open(catalog::robot_drive());
    for (size, graphs_below) in [([640.0, 400.0], false), ([1280.0, 480.0], false), ([800.0, 600.0], true)] {
        harness.set_size(egui::Vec2::new(size[0], size[1]));
        harness.run_steps(4);
        let canvas = harness.get_by_label("Canvas").rect();
        assert!(canvas.height() > 180.0 && canvas.width() > 300.0, "{size:?}: {canvas}");
        assert_eq!(harness.query_by_label("Graphs").is_none(), graphs_below, "{size:?}");
        if !graphs_below {
            harness.get_by_label("Graphs").click();
            harness.run_steps(3);
            let graph = harness.get_by_label("Along the cable").rect();
            assert!(graph.height() > 60.0, "{size:?}: {graph}");
        }
        harness.get_by_label("Results").click();
        harness.run_steps(3);
        harness.get_by_label("Greatest tension");
        // The menu of the same name is above it.
        harness.get_all_by_label("Edit").find(|n| n.rect().top() > 24.0).unwrap().click();
        harness.run_steps(3);
    }
}

#[test]
fn the_keyboard_alone_opens_edits_runs_and_reads() {
    let mut harness = open_span();
    let key = |harness: &mut Harness<'_, ViewerApp>, key: Key| {
        harness.key_press(key);
        harness.run_steps(2);
    };
    // Pick, move, run, stop, step back, start again.
    key(&mut harness, Key::N);
    let before = state(&harness).document.scene.clone();
    harness.key_press_modifiers(Modifiers::ALT, Key::ArrowUp);
    harness.run_steps(2);
    assert_ne!(state(&harness).document.scene, before);
    key(&mut harness, Key::Escape);
    key(&mut harness, Key::Space);
    harness.run_steps(10);
    key(&mut harness, Key::Space);
    let now = state(&harness).live.snapshot.solution.as_ref().unwrap().time_s;
    assert!(now > 0.1);
    key(&mut harness, Key::ArrowLeft);
    assert!(state(&harness).live.snapshot.solution.as_ref().unwrap().time_s < now);
    key(&mut harness, Key::R);
    // Everything else by name.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(4);
    harness.get_by_label("Command").type_text("pin this");
    harness.run_steps(3);
    key(&mut harness, Key::Enter);
    harness.run_steps(3);
    assert_eq!(state(&harness).analysis.references.len(), 1);
    // Tab walks the controls: after the first press something has the focus, and the next is
    // another.
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..40 {
        key(&mut harness, Key::Tab);
        seen.extend(harness.ctx.memory(|m| m.focused()).map(|id| format!("{id:?}")));
    }
    assert!(seen.len() >= 35, "{}", seen.len());
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
}

#[test]
fn the_window_is_usable_at_scales_from_a_half_to_four() {
    let mut harness = open_span();
    for scale in [0.5, 1.0, 2.0, 4.0] {
        harness.ctx.set_zoom_factor(scale);
        harness.run_steps(4);
        apply(&mut harness, Command::View(ViewCommand::Fit));
        let canvas = harness.get_by_label("Canvas").rect();
        assert!(canvas.is_positive(), "{scale}: {canvas}");
        harness.get_by_label("Play");
        harness.key_press(Key::ArrowRight);
        harness.run_steps(2);
        assert_eq!(state(&harness).live.snapshot.error, None, "{scale}");
    }
}
