//! The record is what a run leaves behind: a history in memory, and tables in CSV.
//!
//! | room | content |
//! |---|---|
//! | `history.rs` | tensions and reactions over time, in memory |
//! | `manifest.rs` | `run.toml`: what was asked, how far the run came, which files are its own |
//! | `run_tables.rs` | the three tables of a run, read together |
//! | `columns.rs`, `node_choice.rs` | names of the tables' columns; which nodes and figures are written |
//! | `run_writer.rs`, `page_aligned_rows.rs` | the tables are written in whole instants; rows that lie on one page of a file |
//! | `table_reader.rs`, `csv_records.rs` | the tables are read up to their last whole row |
//! | `table_error.rs` | faults of tables |
//! | `fingerprint.rs` | whether two runs are the same to the bit |
//!
//! A run folder holds `scene.toml`, `run.toml` ([`Manifest`]: what was asked, and whether the run
//! is complete) and three tables, every number in SI units that its column's name ends in:
//!
//! | table | a row per | columns |
//! |---|---|---|
//! | `history.csv` | time | `time_s`, `max_tension_n`, `max_tension_arc_length_m`, for each support `NAME.reaction_x_n`, `NAME.reaction_y_n` (`CABLE.NAME.…` where there are several cables), `kinetic_energy_j`, `gravity_energy_j`, `stretch_energy_j`, `bending_energy_j`, `peak_tension_n` (the greatest of any inner step since the row before), `held_tension_n` (the greatest mean over `breaking_time_s` since then), of the energy account since motion began (0 where a model keeps none) `supports_work_j`, `loads_work_j`, `outlines_work_j`, `friction_work_j`, `material_work_j`, `impacts_work_j`, `edits_work_j`, `breaks_work_j`, `numerical_work_j`, `exchanged_energy_j`, `unaccounted_energy_j`, and with a robot `robot_x_m`, `robot_y_m`, `robot_pitch_deg`, `robot_speed_m_per_s`, `robot_thrust_n`, and the work of each force on it since the run began, `robot_drive_work_j`, `robot_slip_work_j`, `robot_rolling_work_j`, `robot_weight_work_j`, `robot_cable_work_j`, `robot_ground_work_j`, `robot_impact_work_j` (together its energy of motion; older tables have none) |
//! | `nodes.csv` | node and time | `time_s`, `cable`, then the fields of [`crate::solution::Node`], or those chosen ([`NodeChoice`]) |
//! | `events.csv` | event | `time_s`, `kind`, `cable`, `arc_length_m`, `value`, `limit`, `message`, `cause` (JSON) |
//!
//! Numbers are written with the fewest digits that read back to the same bits (in a file some times
//! have zeros after them, so that no row lies on two pages of it). [`RunWriter`] writes the tables
//! to any [`std::io::Write`] in whole instants, `history.csv` last; `read_run` reads them again, up
//! to the last instant that is whole in all of them, wherever they were cut off. [`read_history`],
//! [`read_nodes`] and [`read_events`] read one of them. Folders are made and read in
//! [`crate::files`].

mod columns;
mod csv_records;
mod fingerprint;
mod history;
mod manifest;
mod node_choice;
mod page_aligned_rows;
mod run_tables;
mod run_writer;
mod table_error;
mod table_reader;
#[cfg(test)]
mod tables_tests;

pub use columns::RobotColumns;
pub use fingerprint::Fingerprint;
pub use history::History;
pub(crate) use manifest::MANIFEST_HEAD;
pub use manifest::{FileRecord, Manifest, NodeSummary, RunRequest, RunStatus, RunStop};
pub use node_choice::{NodeChoice, NodeColumns, NodeInterval, UnknownColumn};
pub(crate) use page_aligned_rows::Pages;
pub(crate) use run_tables::read_run;
pub use run_tables::{LeftOut, RunTables};
pub use run_writer::RunWriter;
pub use table_error::{ReadError, RowFault, WriteError, WrittenNumber};
pub(crate) use table_reader::has_rows;
pub use table_reader::{Event, Extra, HistoryTable, NodeRow, SupportColumn, read_events, read_history, read_nodes};
