//! What a run leaves behind: a history in memory, and tables in CSV.
//!
//! A run folder holds `scene.toml` and three tables, every number in SI units that its column's name ends in:
//!
//! | table | a row per | columns |
//! |---|---|---|
//! | `history.csv` | time | `time_s`, `max_tension_n`, `max_tension_arc_length_m`, for each support `NAME.reaction_x_n`, `NAME.reaction_y_n` (`CABLE.NAME.…` where there are several cables), `kinetic_energy_j`, `gravity_energy_j`, `stretch_energy_j`, `bending_energy_j`, and with a robot `robot_x_m`, `robot_y_m`, `robot_pitch_deg`, `robot_speed_m_per_s`, `robot_thrust_n` |
//! | `nodes.csv` | node and time | `time_s`, `cable`, then the fields of [`crate::solution::Node`] |
//! | `events.csv` | event | `time_s`, `kind`, `cable`, `arc_length_m`, `value`, `limit`, `message` |
//!
//! Numbers are written with the fewest digits that read back to the same bits. [`RunWriter`] writes the tables to any
//! [`std::io::Write`]; [`read_history`], [`read_nodes`] and [`read_events`] read them again.

mod energy;
mod fingerprint;
mod history;
mod tables;

pub use fingerprint::Fingerprint;
pub use history::History;
pub use tables::{
    Event, Extra, HistoryTable, NodeRow, ReadError, RunWriter, SupportColumn, WriteError, read_events, read_history,
    read_nodes,
};
