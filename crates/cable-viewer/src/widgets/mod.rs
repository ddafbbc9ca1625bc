//! This wing holds the small parts that panels, dialogs and graphs are made of.
//!
//! - `field`: number and text fields that keep what is typed until it can be read
//! - `progress`: a bar with the share that is done
//! - `property`: one quantity in a row with name, slider, value and reset
//! - `readout`: a name and a figure
//! - `slider`: a slider that is fine about the value it has
//! - `checkbox_and_radio`: boxes to tick and rings to choose by
//! - `time_table`: a vector that changes with time, as a table
//! - `icon`: painted signs
//! - `highlight`: a frame round the control that a guide speaks of
//! - `focus`: a frame round what has the keyboard focus

pub mod checkbox_and_radio;
pub mod field;
pub mod focus;
pub mod highlight;
pub mod icon;
pub mod progress;
pub mod property;
pub mod readout;
pub mod slider;
pub mod time_table;
