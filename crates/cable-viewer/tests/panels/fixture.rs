//! The tests of panels share a fixed answer and a window with one panel in it. Nothing here is
//! solved: figures never change.

use std::sync::Arc;

use cable_core::scene::{Obstacle, Shape, Support, catalog};
use cable_core::solution::{
    CableSolution, ContactReport, ContactState, Cost, DriveState, Energy, ModelReason, Node, RobotReport, RobotWork,
    Solution, SupportReaction, Warning, WarningCause, WarningKind,
};
use cable_core::{Load, Model, Scene};
use cable_viewer::command::effects::Effects;
use cable_viewer::command::{self, Command};
use cable_viewer::record::sample::Sample;
use cable_viewer::state::{AppState, Reference, Snapshot};
use egui_kittest::Harness;

pub type PanelUi = fn(&mut egui::Ui, &AppState, &mut Vec<Command>);

/// The state that a panel under test reads, and the commands that it pushed.
pub struct Bench {
    pub state: AppState,
    pub commands: Vec<Command>,
}

/// Depth of the parabola over 10 m that is 12 m long, stretched, m.
const DEPTH_M: f64 = 2.9652;

/// The hanging span with a floor, a post and a load, as a parabola.
pub fn state() -> AppState {
    let mut state = AppState::new(scene(), None);
    let solution = answer(&state.document.scene);
    for k in 0..600 {
        let time_s = f64::from(k) / 60.0;
        let swing = (2.0 * time_s).sin() * (-0.2 * time_s).exp();
        state.live.history.push(Sample {
            time_s,
            max_tension_n: 640.0 + 180.0 * swing,
            energy_j: [20.0 * swing * swing, 512.0, 0.9, 0.0],
            robot: None,
            reactions_n: vec![[560.0 + 150.0 * swing, -310.0], [-560.0 - 120.0 * swing, -290.0]],
        });
    }
    state.live.snapshot = Snapshot {
        scene: Some(Arc::new(state.document.scene.clone())),
        solution: Some(Arc::new(solution)),
        solve_wall_s: 1.234e-3,
        real_speed: Some(0.98),
        ..Snapshot::default()
    };
    state
}

pub fn scene() -> Scene {
    let mut scene = catalog::hanging_span();
    scene.cables[0].preset = Some("soow-6-4".to_owned());
    scene.obstacles.push(Obstacle {
        name: "floor".to_owned(),
        shape: Shape::Terrain { points_m: vec![[-1.0, 0.0], [20.0, 0.0]] },
        friction: Some(0.5),
    });
    scene.obstacles.push(Obstacle {
        name: "post".to_owned(),
        shape: Shape::Circle { center_m: [4.0, 2.5], radius_m: 0.2 },
        friction: None,
    });
    scene.loads.push(Load {
        cable: "cable".to_owned(),
        arc_length_m: 6.0,
        force_n: Some([0.0, -50.0]),
        times_s: Vec::new(),
        forces_n: Vec::new(),
    });
    scene
}

fn answer(scene: &Scene) -> Solution {
    let cable = &scene.cables[0];
    let nodes: Vec<_> = (0..=48)
        .map(|i| {
            let u = f64::from(i) / 48.0;
            let tension_n = 560.0 * (1.0 + 0.64 * (2.0 * u - 1.0).powi(2)).sqrt();
            Node {
                arc_length_m: cable.length_m * u,
                x_m: 10.0 * u,
                y_m: 5.0 - 4.0 * DEPTH_M * u * (1.0 - u),
                tension_n,
                strain: tension_n / cable.axial_stiffness_n,
                stress_pa: tension_n / cable.area_m2(),
                curvature_per_m: 0.08 / (1.0 + 0.16 * (2.0 * u - 1.0).powi(2)),
                ..Node::default()
            }
        })
        .collect();
    let reaction = |name: &str, x_m: f64, x_n: f64, y_n: f64| SupportReaction {
        name: name.to_owned(),
        x_m,
        y_m: 5.0,
        reaction_x_n: x_n,
        reaction_y_n: y_n,
        arc_length_m: if x_m > 0.0 { cable.length_m } else { 0.0 },
        ..SupportReaction::default()
    };
    let contact = ContactReport {
        obstacle: "post".to_owned(),
        arc_length_m: 4.8,
        normal_n: 120.0,
        friction_n: 30.0,
        state: ContactState::Slip,
        ..ContactReport::default()
    };
    Solution {
        time_s: 9.983,
        model: Model::Fem,
        reason: ModelReason::Inertia,
        cables: vec![CableSolution {
            name: cable.name.clone(),
            nodes: nodes.into(),
            supports: vec![reaction("left", 0.0, 560.0, -448.0), reaction("right", 10.0, -560.0, -448.0)],
            contacts: vec![contact],
            error_estimate: Some(3.2e-4),
            ..CableSolution::default()
        }],
        warnings: Vec::new(),
        cost: Cost { iterations: 7, halved_steps: 0, residual_n: 3.4e-7, inner_step_s: 1.0 / 240.0 },
        energy: Energy { kinetic_j: 12.5, gravity_j: 512.0, stretch_j: 0.9, bending_j: 0.0 },
        robot: None,
        next_cheaper: None,
        verification: None,
    }
}

/// Warnings of several kinds.
pub fn warn(state: &mut AppState) {
    let warning = |kind, arc_length_m, value: f64, limit: f64, message: &str| {
        let cause = WarningCause::Recorded { kind, message: message.to_owned() };
        Warning::new(cause, "cable", arc_length_m, [value, limit])
    };
    let mut solution = (**state.live.snapshot.solution.as_ref().unwrap()).clone();
    solution.warnings = vec![
        warning(
            WarningKind::NotUnique,
            4.8,
            0.0,
            0.0,
            "With friction there are many resting places; this is the one of a cable laid from its supports with the least sliding.",
        ),
        warning(
            WarningKind::ServiceTension,
            0.0,
            912.0,
            800.0,
            "Tension is above the service tension. A longer cable or another waypoint lowers it.",
        ),
        warning(
            WarningKind::Accuracy,
            6.0,
            4.1e-3,
            1e-3,
            "The mesh is too coarse at the load: the largest tension may be off by 0.41 %.",
        ),
    ];
    state.live.snapshot.solution = Some(Arc::new(solution));
}

/// Ten seconds recorded, with three events, and an earlier time shown.
pub fn recorded() -> AppState {
    let mut state = state();
    let answer = (**state.live.snapshot.solution.as_ref().unwrap()).clone();
    let event = |k: u32| match k {
        120..150 => Some(WarningKind::ServiceTension),
        300..400 => Some(WarningKind::Slack),
        480.. => Some(WarningKind::Broken),
        _ => None,
    };
    for k in 0..600_u32 {
        let warning = |kind| {
            let cause = WarningCause::Recorded { kind, message: "as it says".to_owned() };
            Warning::new(cause, "cable", 0.0, [912.0, 800.0])
        };
        let warnings = event(k).map(warning).into_iter().collect();
        state.live.recording.push(Solution { time_s: f64::from(k) / 60.0, warnings, ..answer.clone() });
    }
    state.live.latest = state.live.snapshot.clone();
    state.live.show_time(Some(4.2));
    state
}

/// Two answers held: one of a longer and lighter cable.
pub fn compared() -> AppState {
    let mut state = state();
    let mut other = state.document.scene.clone();
    other.cables[0].length_m = 12.5;
    other.cables[0].linear_density_kg_per_m = 1.0;
    let mut answer = (**state.live.snapshot.solution.as_ref().unwrap()).clone();
    for node in &mut answer.cables[0].nodes {
        node.tension_n *= 0.83;
        node.y_m -= 0.1;
    }
    for (scene, solution) in [(state.document.scene.clone(), None), (other, Some(answer))] {
        let solution = solution.map_or_else(|| state.live.snapshot.solution.clone().unwrap(), Arc::new);
        let changes = state.analysis.changes_to(&scene, &state.document.saved);
        let (scene, folder, run) = (Arc::new(scene), None, None);
        state.analysis.references.push(Reference { scene, changes, folder, solution, wall_s: 2.5e-3, run });
    }
    state
}

/// A robot on its path.
pub fn driven() -> AppState {
    let mut state = state();
    let mut scene = catalog::robot_drive();
    scene.name.clone_from(&state.document.scene.name);
    state.live.snapshot.scene = Some(Arc::new(scene.clone()));
    state.document.scene = scene;
    let mut answer = (**state.live.snapshot.solution.as_ref().unwrap()).clone();
    answer.robot = Some(RobotReport {
        x_m: 11.2,
        y_m: 0.05,
        pitch_deg: 4.5,
        speed_m_per_s: 0.482,
        commanded_m_per_s: 0.6,
        thrust_n: 2310.0,
        normal_n: 9612.0,
        traction_n: 4325.0,
        hitch_x_n: -980.0,
        hitch_y_n: 212.0,
        going: DriveState::Slowed,
        leg: Some(0),
        work: RobotWork {
            drive_j: 2874.0,
            rolling_j: -1210.0,
            weight_j: -471.0,
            cable_j: -1068.0,
            impact_j: -3.5,
            ..RobotWork::default()
        },
        ..RobotReport::default()
    });
    state.live.snapshot.solution = Some(Arc::new(answer));
    state
}

/// A support and its reaction in the middle.
pub fn with_pulley(state: &mut AppState) {
    let mut pulley = Support::pulley("stop 1", [5.0, 4.0]);
    pulley.radius_m = Some(0.1);
    pulley.friction = Some(0.1);
    state.document.scene.cables[0].supports.insert(1, pulley);
    state.document.fault = state.document.scene.validate().err();
}

/// The panel that lists the items of the scene, and the form of the selected one.
pub fn outline_and_form(ui: &mut egui::Ui, state: &AppState, commands: &mut Vec<Command>) {
    cable_viewer::panels::scene::outline::ui(ui, state, commands);
    if state.selection.selected.is_some() {
        cable_viewer::panels::selected_item::ui(ui, state, commands);
    }
}

/// A window with one panel. Commands are applied as the window does.
pub fn bench(state: AppState, panel: PanelUi, size: [f32; 2]) -> Harness<'static, Bench> {
    Harness::builder().with_size(size).with_theme(egui::Theme::Light).with_render_cursor(false).build_ui_state(
        move |ui, bench: &mut Bench| {
            cable_viewer::render::theme::install(ui.ctx());
            egui::Frame::central_panel(ui.style()).show(ui, |ui| {
                ui.set_min_size(ui.available_size());
                let mut commands = Vec::new();
                panel(ui, &bench.state, &mut commands);
                let mut effects = Effects::default();
                for command in commands {
                    command::apply(&mut bench.state, command.clone(), &mut effects);
                    bench.commands.push(command);
                }
            });
        },
        Bench { state, commands: Vec::new() },
    )
}

/// Up a slope, over a post with friction and down on its far side, in figures that add up by hand.
pub fn wrapped() -> AppState {
    let mut state = state();
    let w = state.document.scene.cables[0].linear_density_kg_per_m * 9.80665;
    let mut answer = (**state.live.snapshot.solution.as_ref().unwrap()).clone();
    let node =
        |s: f64, x_m: f64, y_m: f64, tension_n: f64| Node { arc_length_m: s, x_m, y_m, tension_n, ..Node::default() };
    let (rise, fall, rubbed) = (5.0 * w, -2.0 * w, 150.0);
    let nodes = vec![
        node(0.0, 0.0, 0.0, 200.0),
        node(6.0, 3.0, 5.0, 200.0 + rise),
        node(6.5, 3.5, 5.0, 200.0 + rise + rubbed),
        node(12.0, 9.0, 3.0, 200.0 + rise + rubbed + fall),
    ];
    let cable = &mut answer.cables[0];
    cable.contacts = vec![ContactReport {
        obstacle: "post".to_owned(),
        arc_length_m: 6.25,
        begins_m: 6.0,
        ends_m: 6.5,
        turn_deg: -79.0,
        tension_before_n: nodes[1].tension_n,
        tension_after_n: nodes[2].tension_n,
        ..ContactReport::default()
    }];
    cable.nodes = nodes.into();
    state.live.snapshot.solution = Some(Arc::new(answer));
    state
}

/// All warnings as the window has them: the worst, and below it the others.
pub fn warnings(
    ui: &mut egui::Ui,
    state: &cable_viewer::state::AppState,
    commands: &mut Vec<cable_viewer::command::Command>,
) {
    cable_viewer::panels::warnings::worst(ui, state, commands);
    cable_viewer::panels::warnings::ui(ui, state, commands);
}
