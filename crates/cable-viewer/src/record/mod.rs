//! This wing keeps what was seen since the last start, each part within a memory budget.
//!
//! - `recording`: whole answers, the events between them, and which of them is on screen
//! - `sample`, `sample_history`: a few figures of every instant, for graphs over time
//! - `decimation`: the thinning of the history, which keeps extremes
//! - `kept_run`: a whole run, kept to compare with
//! - `plotted_quantity`: the quantities that graphs show, and how to read them off a sample
//! - `series`, `pyramid`: points of a line, thinned to what a screen can show

mod decimation;
pub mod kept_run;
pub mod plotted_quantity;
pub mod pyramid;
pub mod recording;
pub mod sample;
pub mod sample_history;
pub mod series;
