//! Names and columns of the three tables of a run.

use crate::solution::Solution;

pub(super) const HISTORY: &str = "history.csv";
pub(super) const NODES: &str = "nodes.csv";
pub(super) const EVENTS: &str = "events.csv";
/// Columns of `history.csv` before those of the supports.
pub(super) const HISTORY_COLUMNS: [&str; 3] = ["time_s", "max_tension_n", "max_tension_arc_length_m"];
/// Columns of `history.csv` that are of no support.
pub(super) const ENERGY_COLUMNS: [&str; 4] =
    ["kinetic_energy_j", "gravity_energy_j", "stretch_energy_j", "bending_energy_j"];
/// Works since the cables began to move, in the order of the energy account, what was
/// exchanged and what is not accounted for; 0 where there is no account.
pub(super) const ACCOUNT_COLUMNS: [&str; 11] = [
    "supports_work_j",
    "loads_work_j",
    "outlines_work_j",
    "friction_work_j",
    "material_work_j",
    "impacts_work_j",
    "edits_work_j",
    "breaks_work_j",
    "numerical_work_j",
    "exchanged_energy_j",
    "unaccounted_energy_j",
];
/// The greatest tension of any inner step since the row before, and the greatest mean over the
/// breaking time; at rest and without inertia that of the instant.
pub(super) const PEAK_COLUMNS: [&str; 2] = ["peak_tension_n", "held_tension_n"];
pub(super) const ROBOT_COLUMNS: [&str; 5] =
    ["robot_x_m", "robot_y_m", "robot_pitch_deg", "robot_speed_m_per_s", "robot_thrust_n"];
/// The work of each force on the robot since the run began; rows of older tables end before.
pub(super) const ROBOT_WORK_COLUMNS: [&str; 7] = [
    "robot_drive_work_j",
    "robot_slip_work_j",
    "robot_rolling_work_j",
    "robot_weight_work_j",
    "robot_cable_work_j",
    "robot_ground_work_j",
    "robot_impact_work_j",
];
pub(super) const EVENT_COLUMNS: [&str; 8] =
    ["time_s", "kind", "cable", "arc_length_m", "value", "limit", "message", "cause"];
/// Columns of tables that were written before causes were.
pub(super) const OLD_EVENT_COLUMNS: usize = 7;

/// The columns of `history.csv` on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotColumns {
    /// The scene has a robot that can move.
    Written,
    /// It has none.
    LeftOut,
}

impl RobotColumns {
    /// Those of a run that has this answer.
    #[must_use]
    pub fn of(solution: &Solution) -> Self {
        if solution.robot.is_some() { Self::Written } else { Self::LeftOut }
    }
}

/// Columns of `history.csv` after those of the supports, but for those of the robot.
fn always_written() -> impl Iterator<Item = &'static str> {
    ENERGY_COLUMNS.into_iter().chain(PEAK_COLUMNS).chain(ACCOUNT_COLUMNS)
}

/// The name of a column of `history.csv` that is of no support; None where there is none of it.
pub(super) fn known_extra(name: &str) -> Option<&'static str> {
    always_written().chain(ROBOT_COLUMNS).chain(ROBOT_WORK_COLUMNS).find(|known| *known == name)
}

/// Columns of `history.csv`, from the names of the cables, and of their supports.
pub(super) fn history_columns<'a>(
    cables: impl Iterator<Item = (&'a str, impl Iterator<Item = &'a str>)>,
    count: usize,
    robot: RobotColumns,
) -> Vec<String> {
    let mut columns: Vec<String> = HISTORY_COLUMNS.map(String::from).to_vec();
    for (cable, supports) in cables {
        for support in supports {
            let name = if count > 1 { format!("{cable}.{support}") } else { support.to_owned() };
            columns.push(format!("{name}.reaction_x_n"));
            columns.push(format!("{name}.reaction_y_n"));
        }
    }
    columns.extend(always_written().map(String::from));
    if robot == RobotColumns::Written {
        columns.extend(ROBOT_COLUMNS.into_iter().chain(ROBOT_WORK_COLUMNS).map(String::from));
    }
    columns
}

/// The columns beside time, tension and reactions, each with its value.
pub(super) fn extras(s: &Solution) -> impl Iterator<Item = (&'static str, f64)> {
    let e = s.energy;
    let energies = [e.kinetic_j, e.gravity_j, e.stretch_j, e.bending_j];
    let robot = s.robot.map(|r| [r.x_m, r.y_m, r.pitch_deg, r.speed_m_per_s, r.thrust_n]);
    let peaks = s.peaks();
    let peaks = [peaks.greatest.tension_n, peaks.held.tension_n];
    let account = s.energy_account().unwrap_or_default();
    let balance = account.works_j().into_iter().chain([account.exchanged_j, account.unaccounted_j()]);
    let always = always_written().zip(energies.into_iter().chain(peaks).chain(balance));
    let work = s
        .robot
        .map(|r| r.work)
        .map(|w| [w.drive_j, w.slip_j, w.rolling_j, w.weight_j, w.cable_j, w.ground_j, w.impact_j]);
    let of_robot = ROBOT_COLUMNS.into_iter().zip(robot.into_iter().flatten());
    always.chain(of_robot).chain(ROBOT_WORK_COLUMNS.into_iter().zip(work.into_iter().flatten()))
}
