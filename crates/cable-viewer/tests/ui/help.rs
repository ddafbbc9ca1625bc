//! What helps: guided scenes, hover help and a name on every control, the picture in words, the keyboard alone.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::guide::GUIDES;
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
fn controls(harness: &Harness<'_, ViewerApp>) -> Vec<(String, Role, Pos2)> {
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
        apply(&mut harness, Command::View(ViewCommand::Hold));
        let all = controls(&harness);
        assert!(all.len() > 60, "{}", all.len());
        let nameless: Vec<_> = all.iter().filter(|(name, ..)| name.trim().is_empty()).collect();
        assert!(nameless.is_empty(), "{nameless:?}");
    }
}

#[test]
fn u11_every_control_explains_itself_on_hover() {
    let mut harness = open(catalog::robot_drive());
    apply(&mut harness, Command::View(ViewCommand::Hold));
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
    // What says in its own words all there is to say.
    let plain = ["File", "Edit", "View", "Scenes", "Learn"];
    silent.retain(|(name, _)| !plain.contains(&name.as_str()));
    assert!(silent.is_empty(), "{} without help: {silent:?}", silent.len());
}

#[test]
fn u11_every_entry_of_the_menus_explains_itself_on_hover() {
    for menu in ["File", "Edit", "View", "Scenes", "Learn"] {
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
        assert!(entries.len() >= 6, "{menu}: {entries:?}");
        let mut silent = Vec::new();
        for (name, _, at) in entries {
            // The pointer comes from beside: a menu that has just opened takes no notice of one that was there.
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
    for part in ["1 cable", "1 obstacle", "a robot", "riser at (0.000, 5.000) m", "largest tension", "standing"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    apply(&mut harness, Command::View(ViewCommand::Select(Some(Item::Robot))));
    assert!(told(&harness).contains("picked: the robot"));
}

#[test]
fn t01_six_guided_scenes_lead_from_step_to_step() {
    let mut harness = open_span();
    for (k, guide) in GUIDES.iter().enumerate() {
        harness.get_by_label("Learn").click();
        harness.run_steps(3);
        harness.get_by_label(&format!("{}. {}", k + 1, guide.title)).click();
        harness.run_steps(4);
        // The scene before may have unsaved changes.
        if state(&harness).dialog.is_some() {
            harness.get_by_label("Go on without saving").click();
            harness.run_steps(4);
        }
        assert_eq!(state(&harness).guide.map(|p| (p.guide, p.step)), Some((k, 0)), "{}", guide.title);
        harness.get_by_label_contains(guide.steps[0].text);
    }
    // The first one, done.
    apply(&mut harness, Command::File(FileCommand::Discard(Box::new(Command::File(FileCommand::OpenGuide(0))))));
    let item = Item::Support { cable: 0, support: 1 };
    apply(&mut harness, Command::Scene(SceneCommand::Move { item, to_m: [9.0, 5.0] }));
    harness.run_steps(2);
    assert_eq!(state(&harness).guide.map(|p| p.step), Some(1), "what was done is seen");
    harness.get_by_label("Next").click();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    harness.get_by_label("Done");
    harness.get_by_label("End guide").click();
    harness.run_steps(2);
    assert_eq!(state(&harness).guide, None);
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
    let before = state(&harness).scene.clone();
    harness.key_press_modifiers(Modifiers::ALT, Key::ArrowUp);
    harness.run_steps(2);
    assert_ne!(state(&harness).scene, before);
    key(&mut harness, Key::Escape);
    key(&mut harness, Key::Space);
    harness.run_steps(10);
    key(&mut harness, Key::Space);
    let now = state(&harness).snapshot.solution.as_ref().unwrap().time_s;
    assert!(now > 0.1);
    key(&mut harness, Key::ArrowLeft);
    assert!(state(&harness).snapshot.solution.as_ref().unwrap().time_s < now);
    key(&mut harness, Key::R);
    // Everything else by name.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(4);
    harness.get_by_label("Command").type_text("hold this");
    harness.run_steps(3);
    key(&mut harness, Key::Enter);
    harness.run_steps(3);
    assert_eq!(state(&harness).held.len(), 1);
    // Tab walks the controls: after the first press something has the focus, and the next is another.
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
        assert_eq!(state(&harness).snapshot.error, None, "{scale}");
    }
}
