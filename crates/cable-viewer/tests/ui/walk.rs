//! These walks take the window through its main states and draw a picture of each, to be looked at.
//! They fail where a control is gone or a state cannot be drawn; otherwise a reader judges.
//! `KEEP_PICTURES=FOLDER cargo test --workspace --test ui walk -- --ignored`; without the variable
//! the pictures are in the temporary folder of the tests.

use std::path::PathBuf;

use cable_core::Scene;
use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::dialog::{Dialog, SceneReplacement};
use cable_viewer::state::{Item, TensionMarker};
use egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::gpu::renderer;
use crate::{apply, drag, support};

struct Walk {
    harness: Harness<'static, ViewerApp>,
    folder: PathBuf,
}

impl Walk {
    /// Opens a window on the scene.
    fn open(scene: Scene, [width, height]: [f32; 2]) -> Self {
        let folder =
            std::env::var_os("KEEP_PICTURES").map_or_else(|| env!("CARGO_TARGET_TMPDIR").into(), PathBuf::from);
        let harness = Harness::builder()
            .with_size(Vec2::new(width, height))
            .with_step_dt(1.0 / 60.0)
            .with_render_cursor(false)
            .with_accessibility_check(false)
            .renderer(renderer().unwrap())
            .build_eframe(|cc| ViewerApp::inline(&cc.egui_ctx, scene, None));
        let mut walk = Self { harness, folder };
        walk.harness.run_steps(6);
        walk
    }

    fn look(&mut self, name: &str) {
        self.harness.run_steps(4);
        let picture = self.harness.render().unwrap();
        picture.save(self.folder.join(format!("{name}.png"))).unwrap();
    }

    fn does(&mut self, command: Command) {
        apply(&mut self.harness, command);
    }

    fn view(&mut self, command: ViewCommand) {
        self.does(Command::View(command));
    }

    fn plays(&mut self, frames: usize) {
        self.does(Command::Playback(PlaybackCommand::SetPaused(false)));
        self.harness.run_steps(frames);
        self.does(Command::Playback(PlaybackCommand::SetPaused(true)));
    }

    fn click(&mut self, label: &str) {
        self.harness.get_all_by_label(label).next().unwrap().click();
        self.harness.run_steps(3);
    }

    fn light(&mut self) {
        self.view(ViewCommand::SetTheme(egui::ThemePreference::Light));
    }

    fn holds(&mut self, key: Key, frames: usize) {
        for pressed in [true, false] {
            let modifiers = Modifiers::NONE;
            self.harness.event(egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
            self.harness.run_steps(if pressed { frames } else { 2 });
        }
    }

    fn dialog(&mut self, dialog: Dialog) {
        self.does(Command::File(FileCommand::SetDialog(Some(dialog))));
    }
}

const WINDOW: [f32; 2] = [1280.0, 800.0];

#[test]
#[ignore = "pictures to look at, half a minute"]
fn walk_a_span() {
    let mut walk = Walk::open(catalog::hanging_span(), WINDOW);
    walk.look("a01-start-dark");
    walk.light();
    walk.look("a02-start-light");
    let from = support(&walk.harness, "right");
    drag(&mut walk.harness, from, Vec2::new(-60.0, -40.0));
    walk.look("a03-dragged");
    walk.plays(150);
    walk.look("a04-played");
    walk.view(ViewCommand::AddReference);
    let mut cable = walk.harness.state().state.document.scene.cables[0].clone();
    cable.length_m *= 1.15;
    walk.does(Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    walk.look("a05-held-and-changed");
    walk.view(ViewCommand::SetTensionMarker(Some(TensionMarker {
        cable: 0,
        arc_length_m: 4.0,
        from: cable_core::analysis::tension_budget::StartEnd::Start,
    })));
    walk.look("a06-probe");
    for (k, menu) in ["File", "Edit", "View", "Tools", "Scenes", "Learn"].into_iter().enumerate() {
        walk.click(menu);
        walk.look(&format!("a1{k}-menu-{}", menu.to_lowercase()));
        walk.harness.key_press(Key::Escape);
        walk.harness.run_steps(3);
    }
    for (k, dialog) in [
        Dialog::About,
        Dialog::Help,
        Dialog::Palette { text: "hold".to_owned() },
        Dialog::Open { path: "scene.toml".to_owned() },
        Dialog::ImportMap { path: String::new(), text: "0;0\n1;0,5\n2;0".to_owned(), unit_m: "1".to_owned() },
        Dialog::Feedback { answers: cable_viewer::io::feedback::Answers::default(), path: "feedback.csv".to_owned() },
        Dialog::SaveRun { path: "run".to_owned() },
        Dialog::Recover { scene: Box::new(catalog::tank()) },
        Dialog::Unsaved { then: SceneReplacement::Quit },
        Dialog::OpenRun { path: "run".to_owned(), hold: true },
    ]
    .into_iter()
    .enumerate()
    {
        walk.dialog(dialog);
        walk.look(&format!("a2{k}-dialog"));
    }
}

#[test]
#[ignore = "pictures to look at, half a minute"]
fn walk_b_faults_and_loads() {
    let mut walk = Walk::open(catalog::hanging_span(), WINDOW);
    let mut cable = walk.harness.state().state.document.scene.cables[0].clone();
    cable.length_m = 7.0;
    walk.does(Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable.clone()) }));
    walk.look("b01-too-short");
    cable.length_m = 10.02;
    walk.does(Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    walk.look("b02-taut");
    let mut walk = Walk::open(catalog::loads_wind_heat(), WINDOW);
    walk.view(ViewCommand::Select(Some(Item::Load(0))));
    walk.look("b03-loads");
    walk.light();
    walk.view(ViewCommand::SetUnits(cable_viewer::units::system::System::Us));
    walk.look("b04-loads-us");
    let mut walk = Walk::open(catalog::pile(), WINDOW);
    walk.look("b05-pile");
    let mut walk = Walk::open(catalog::plan_posts(), WINDOW);
    walk.look("b06-plan");
    let mut walk = Walk::open(catalog::pulley_waypoints(), WINDOW);
    walk.view(ViewCommand::Select(Some(Item::Support { cable: 0, support: 1 })));
    walk.look("b07-waypoints");
    let mut scene = catalog::hanging_span();
    scene.cables[0].breaking_tension_n = 90.0;
    scene.cables[0].service_tension_n = 60.0;
    let mut walk = Walk::open(scene, WINDOW);
    walk.look("b08-over-breaking-at-rest");
    walk.plays(30);
    walk.look("b09-broken");
}

#[test]
#[ignore = "pictures to look at, half a minute"]
fn walk_c_tank() {
    let mut walk = Walk::open(catalog::tank(), WINDOW);
    walk.look("c01-tank");
    walk.plays(240);
    walk.look("c02-tank-4s");
    walk.light();
    walk.look("c03-tank-light");
    walk.view(ViewCommand::Select(Some(Item::Obstacle(1))));
    walk.look("c04-obstacle-picked");
    walk.does(Command::Playback(PlaybackCommand::ShowTime(Some(2.0))));
    walk.look("c05-scrubbed");
}

#[test]
#[ignore = "pictures to look at, half a minute"]
fn walk_d_robot() {
    let mut walk = Walk::open(catalog::robot_drive(), WINDOW);
    walk.look("d01-robot");
    walk.holds(Key::D, 120);
    walk.look("d02-driven");
    walk.holds(Key::D, 300);
    walk.look("d03-stalled");
    walk.light();
    walk.view(ViewCommand::Select(Some(Item::Robot)));
    walk.look("d04-robot-picked-light");
    walk.click("Robot speed");
    walk.look("d05-robot-speed-graph");
}

#[test]
#[ignore = "pictures to look at, half a minute"]
fn walk_e_sizes() {
    for (k, (size, scale)) in [
        ([1280.0, 800.0], 0.5),
        ([1280.0, 800.0], 2.0),
        ([2560.0, 1600.0], 4.0),
        ([800.0, 600.0], 1.0),
        ([640.0, 400.0], 1.0),
        ([1920.0, 1080.0], 1.0),
    ]
    .into_iter()
    .enumerate()
    {
        let mut walk = Walk::open(catalog::robot_drive(), size);
        walk.harness.ctx.set_zoom_factor(scale);
        walk.harness.run_steps(4);
        walk.view(ViewCommand::Fit);
        walk.look(&format!("e{k}-size-{}x{}-at-{scale}", size[0], size[1]));
        if (2..=4).contains(&k) {
            walk.click("Results");
            walk.look(&format!("e{k}-size-{}x{}-at-{scale}-read", size[0], size[1]));
        }
    }
}

#[test]
#[ignore = "pictures to look at, half a minute"]
fn walk_g_small_dialogs() {
    let mut walk = Walk::open(catalog::hanging_span(), [640.0, 400.0]);
    for (name, dialog) in [("about", Dialog::About), ("help", Dialog::Help)] {
        walk.dialog(dialog);
        walk.look(&format!("g-{name}-640x400"));
    }
    let mut walk = Walk::open(catalog::hanging_span(), WINDOW);
    walk.plays(90);
    walk.harness.get_by_label("Along the cable").focus();
    walk.harness.run_steps(2);
    for key in [Key::ArrowRight, Key::Enter, Key::ArrowRight, Key::ArrowRight, Key::ArrowUp] {
        walk.harness.key_press(key);
        walk.harness.run_steps(2);
    }
    walk.look("g-graph-by-keys");
    for (name, dialog) in [("about", Dialog::About), ("help", Dialog::Help)] {
        walk.dialog(dialog);
        walk.look(&format!("g-{name}"));
    }
}

#[test]
#[ignore = "pictures to look at, half a minute"]
fn walk_f_tall_panels() {
    for (name, scene) in [("robot", catalog::robot_drive()), ("tank", catalog::tank())] {
        let mut walk = Walk::open(scene, [1280.0, 2400.0]);
        walk.view(ViewCommand::AddReference);
        walk.look(&format!("f-tall-{name}-dark"));
        walk.light();
        walk.view(ViewCommand::SetUnits(cable_viewer::units::system::System::Us));
        walk.look(&format!("f-tall-{name}-light-us"));
        let node = walk.harness.get_by_label("Canvas");
        println!("{name}: {}", node.accesskit_node().data().description().unwrap_or_default());
    }
}
