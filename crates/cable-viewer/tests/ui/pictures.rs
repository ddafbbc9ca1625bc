//! Pictures of the canvas are compared with those in `tests/snapshots`. After an intended change:
//! `UPDATE_SNAPSHOTS=1 cargo test -p cable-viewer --test ui`.

use cable_core::error::{SceneError, SceneFault};
use cable_core::scene::catalog;
use cable_core::solution::{CableSolution, ContactReport, ContactState, Cost, ModelReason, Node};
use cable_core::{Model, Solution};
use cable_viewer::app::screenshot;
use cable_viewer::canvas;
use cable_viewer::command::{Command, PlaybackCommand};
use cable_viewer::render::theme;
use cable_viewer::state::{AppState, Item, NoAnswer};
use egui::{Theme, Vec2};
use egui_kittest::Harness;

use crate::gpu::renderer;

/// A reason why a scene has no answer.
fn refusal(text: &str) -> NoAnswer {
    let fault = SceneFault::Syntax { message: text.to_owned() };
    NoAnswer::Error(SceneError { path: String::new(), fault, at: None }.into())
}

/// Compares the canvas of a state with its picture. Skips with a notice where nothing can draw,
/// except in CI.
fn compare(name: &str, mut state: AppState, theme: Theme) {
    state.ui.first_steps.hide();
    let renderer = match renderer() {
        Ok(renderer) => renderer,
        Err(why) if std::env::var("CI").is_ok_and(|v| v == "true") => panic!("{why}"),
        Err(why) => return eprintln!("{name}: skipped, {why}"),
    };
    let mut harness = Harness::builder()
        .with_size(Vec2::new(720.0, 480.0))
        .with_theme(theme)
        .with_context_setup(theme::install)
        .with_render_cursor(false)
        .renderer(renderer)
        .build_ui_state(|ui, state| canvas::ui(ui, state, &mut Vec::new()), state);
    harness.run_steps(2);
    harness.snapshot(name);
}

fn solved(scene: cable_core::Scene) -> AppState {
    solved_with(scene, Model::Fem)
}

fn solved_with(scene: cable_core::Scene, model: Model) -> AppState {
    let mut harness = crate::open(scene);
    crate::apply(&mut harness, Command::SetModel(model));
    let mut state = harness.into_state().state;
    assert_eq!(state.live.snapshot.error, None);
    state.view.camera.fit_wanted = true;
    state
}

#[test]
fn waypoints_dark() {
    let mut state = solved(catalog::pulley_waypoints());
    state.selection.selected = Some(Item::Support { cable: 0, support: 1 });
    compare("waypoints_dark", state, Theme::Dark);
}

/// A hand 2 m ahead of the end it draws while time runs.
#[test]
fn a_hand_draws_an_end_dark() {
    let mut state = solved(catalog::hanging_span());
    let mut answer = state.live.snapshot.solution.as_deref().expect("an answer").clone();
    answer.cables[0].assumptions.inertia = true;
    state.live.snapshot.solution = Some(answer.into());
    state.live.playback.paused = false;
    let at = state.document.scene.cables[0].supports[1].at_m.expect("held");
    state.document.scene.cables[0].supports[1].at_m = Some([at[0] - 1.0, at[1] + 1.7]);
    compare("a_hand_draws_an_end_dark", state, Theme::Dark);
}

#[test]
fn loads_and_wind_light() {
    compare("loads_and_wind_light", solved(catalog::loads_wind_heat()), Theme::Light);
}

#[test]
fn slip_front_and_place_light() {
    let mut state = solved_with(catalog::draped_slipping(), Model::Spans);
    state.document.scene.obstacles.truncate(1);
    let from = cable_core::analysis::tension_budget::StartEnd::Slacker;
    state.analysis.tension_marker = Some(cable_viewer::state::TensionMarker { cable: 0, arc_length_m: 6.0, from });
    compare("slip_front_and_place_light", state, Theme::Light);
}

#[test]
fn over_service_tension_dark() {
    let mut state = solved(catalog::hanging_span());
    let scene = state.live.snapshot.scene.as_deref().expect("a scene");
    let mut scene = scene.clone();
    let most = state.live.snapshot.solution.as_ref().expect("an answer").max_tension().tension_n;
    scene.cables[0].service_tension_n = 0.93 * most;
    state.live.snapshot.scene = Some(scene.into());
    compare("over_service_tension_dark", state, Theme::Dark);
}

#[test]
fn no_answer_dark() {
    let mut state = solved(catalog::hanging_span());
    state.live.snapshot.error =
        Some(refusal("fem did not converge in 60 iterations: unbalanced force 3.2 N at node 7"));
    state.live.snapshot.stale = true;
    compare("no_answer_dark", state, Theme::Dark);
}

/// A contact is drawn the same whatever a model would answer: a cable laid over a beam by hand.
#[test]
fn contacts_dark() {
    let scene = catalog::over_beam();
    let ends: Vec<[f64; 2]> = scene.cables[0].supports.iter().filter_map(|s| s.at_m).collect();
    let top = [0.5 * (ends[0][0] + ends[1][0]), ends[0][1].max(ends[1][1]) - 0.5];
    let node = |s: f64, p: [f64; 2], tension_n: f64| Node {
        arc_length_m: s,
        x_m: p[0],
        y_m: p[1],
        tension_n,
        ..Node::default()
    };
    let contact = |x: f64, normal_n: f64, friction_n: f64, state: ContactState| ContactReport {
        x_m: top[0] + x,
        y_m: top[1],
        arc_length_m: 5.0,
        normal: [0.0, 1.0],
        normal_n,
        friction_n,
        state,
        ..ContactReport::default()
    };
    let cable = CableSolution {
        name: scene.cables[0].name.clone(),
        nodes: vec![node(0.0, ends[0], 120.0), node(5.0, top, 150.0), node(10.0, ends[1], 90.0)].into(),
        contacts: vec![contact(-0.3, 60.0, 25.0, ContactState::Stick), contact(0.3, 20.0, -20.0, ContactState::Slip)],
        ..CableSolution::default()
    };
    let mut state = AppState::new(scene, None);
    state.live.snapshot.solution = Some(std::sync::Arc::new(Solution {
        time_s: 0.0,
        model: Model::Fem,
        reason: ModelReason::Requested,
        next_cheaper: None,
        cables: vec![cable],
        warnings: Vec::new(),
        cost: Cost::default(),
        energy: cable_core::solution::Energy::default(),
        robot: None,
        verification: None,
    }));
    compare("contacts_dark", state, Theme::Dark);
}

#[test]
fn obstacles_light() {
    let mut state = AppState::new(catalog::tank(), None);
    state.live.snapshot.error = Some(refusal("nothing was solved for this picture"));
    state.selection.selected = Some(Item::Obstacle(0));
    compare("obstacles_light", state, Theme::Light);
}

#[test]
fn robot_light() {
    let mut scene = catalog::over_beam();
    scene.robot =
        Some(cable_core::Robot { preset: "brokk-170".to_owned(), at_m: [10.0, 0.0], ..cable_core::Robot::default() });
    let end = scene.cables[0].supports.last_mut().expect("an end");
    (end.kind, end.at_m) = (cable_core::scene::SupportKind::Robot, None);
    compare("robot_light", solved(scene), Theme::Light);
}

#[test]
fn safe_reach_and_path_dark() {
    use cable_core::analysis::safe_reach::line::{ReachMap, ReachPlace, Trip};
    let mut state = solved(catalog::robot_drive());
    // By hand: what a search would find depends on the solver.
    let place = |k: u32| {
        let x = 2.0 + 0.4 * f64::from(k);
        let mound = 0.12 * (1.0 - ((x - 12.0) / 0.9).powi(2)).max(0.0);
        let there_and_back_n = if x > 14.2 { f64::INFINITY } else { 60.0 + 20.0 * ((x - 8.0) / 1.5).powi(4).min(60.0) };
        ReachPlace { at_m: [x, mound], there_n: there_and_back_n, there_and_back_n, jammed: false }
    };
    let map = ReachMap { places: (0..41).map(place).collect(), start_x_m: 10.0, service_n: 800.0, breaking_n: 1e4 };
    let scene = std::sync::Arc::new(state.document.scene.clone());
    let maps = cable_viewer::jobs::safe_reach::ReachMaps::Line(std::sync::Arc::new(map));
    state.analysis.safe_reach.progress = cable_viewer::jobs::safe_reach::Progress::Done((maps, scene));
    state.analysis.safe_reach.choice.trip = Trip::ThereAndBack;
    state.selection.selected = Some(Item::PathLeg(2));
    compare("safe_reach_and_path_dark", state, Theme::Dark);
}

/// A robot that has backed over its own slack cable and pushes it as a heap: what of it the cable
/// meets is dashed, above the ground.
#[test]
fn robot_pushes_its_cable_dark() {
    let mut scene = catalog::robot_drive();
    scene.cables[0].length_m = 15.5;
    scene.cables[0].segments = Some(40);
    let mut harness = crate::open(scene);
    crate::apply(&mut harness, Command::Playback(PlaybackCommand::DriveRobot(Some(-0.6))));
    harness.run_steps(130);
    let mut state = harness.into_state().state;
    let contacts = state.live.snapshot.solution.iter().flat_map(|s| &s.cables).flat_map(|c| &c.contacts);
    assert!(contacts.into_iter().any(|c| c.obstacle == "robot"), "{:?}", state.live.snapshot.error);
    // By hand from here: how a heap lies depends on the solver.
    let mut answer = Solution::clone(state.live.snapshot.solution.as_deref().expect("an answer"));
    let robot = answer.robot.as_mut().expect("a robot");
    (robot.x_m, robot.y_m, robot.pitch_deg) = (8.8, 0.0, 0.0);
    let cable = &mut answer.cables[0];
    let first = cable.nodes[0];
    let heap = |x: f64| 0.014 + 0.35 * (-((x - 7.45) / 0.22).powi(2)).exp();
    let lies = (0..=70).map(|k| 4.0 + 0.055 * f64::from(k));
    cable.nodes =
        lies.map(|x| Node { arc_length_m: x, x_m: x, y_m: heap(x), tension_n: 10.0 * (8.0 - x), ..first }).collect();
    let touch = ContactReport {
        x_m: 7.98,
        y_m: 0.2,
        normal: [-1.0, 0.0],
        normal_n: 15.0,
        friction_n: 0.0,
        ..cable.contacts[0].clone()
    };
    cable.contacts =
        vec![ContactReport { obstacle: "robot".to_owned(), begins_m: 7.85, ends_m: 7.85, parts: Vec::new(), ..touch }];
    cable.supports.clear();
    answer.warnings.clear();
    state.live.snapshot.solution = Some(std::sync::Arc::new(answer));
    (state.view.camera.fit_wanted, state.view.camera.points_per_m, state.view.camera.centre_m) =
        (false, 110.0, [8.0, 0.6]);
    compare("robot_pushes_its_cable_dark", state, Theme::Dark);
}

/// A span with the map of its right end: by hand, as a search would depend on the solver.
fn end_reached() -> AppState {
    use cable_core::analysis::safe_reach::area::Area;
    let mut state = solved(catalog::over_beam());
    let mut area = Area {
        origin_m: [-1.0, 0.5],
        spacing_m: 0.5,
        columns: 27,
        most_n: vec![f64::NAN; 27 * 12],
        guessed: vec![false; 27 * 12],
        start_m: [9.0, 0.5],
        service_n: 800.0,
        breaking_n: 1e4,
    };
    area.most_n = (0..area.most_n.len())
        .map(|k| {
            let [x, y] = area.at(k);
            let far = (x.hypot(y - 5.0) / 10.8).min(2.0);
            match () {
                () if (3.5..4.6).contains(&x) && (1.9..3.1).contains(&y) => f64::NAN,
                () if far > 1.06 => f64::INFINITY,
                () => 70.0 + 60.0 * x.abs() + 2e4 * (far - 0.85).max(0.0).powi(2) * 12.0,
            }
        })
        .collect();
    let scene = std::sync::Arc::new(state.document.scene.clone());
    let maps = cable_viewer::jobs::safe_reach::ReachMaps::Area(std::sync::Arc::new(area), None);
    state.analysis.safe_reach.progress = cable_viewer::jobs::safe_reach::Progress::Done((maps, scene));
    state
}

#[test]
fn safe_reach_of_an_end_light() {
    compare("safe_reach_of_an_end_light", end_reached(), Theme::Light);
}

#[test]
fn safe_reach_of_an_end_dark() {
    compare("safe_reach_of_an_end_dark", end_reached(), Theme::Dark);
}

#[test]
fn several_picked_in_us_units_light() {
    let mut state = solved(catalog::loads_wind_heat());
    state.selection.selected = Some(Item::Support { cable: 0, support: 0 });
    state.selection.also_selected = vec![Item::Load(0)];
    state.selection.marquee_m = Some([[2.0, 1.0], [6.0, 4.0]]);
    state.view.layers.components = true;
    // The window says this at the start of each frame.
    cable_viewer::units::system::set_current(cable_viewer::units::system::System::Us);
    compare("several_picked_in_us_units_light", state, Theme::Light);
    cable_viewer::units::system::set_current(cable_viewer::units::system::System::Si);
}

#[test]
fn guide_light() {
    use cable_viewer::ViewerApp;

    let draw = |app: &mut ViewerApp, ctx: &egui::Context| {
        app.state.view.theme = egui::ThemePreference::Light;
        app.apply(ctx, vec![Command::File(cable_viewer::app::guidance::tutorials::open(0))]);
        (app.state.live.snapshot.solve_wall_s, app.state.live.latest.solve_wall_s) = (1e-3, 1e-3);
    };
    let picture = screenshot::draw(catalog::hanging_span(), [1100, 640], draw).unwrap();
    // The strip alone: the rest of the window says how long it took.
    let strip = image::imageops::crop_imm(&picture, 0, 24, 1100, 34).to_image();
    egui_kittest::image_snapshot(&strip, "guide_light");
}
