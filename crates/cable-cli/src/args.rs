//! This file declares the arguments of the program.

use std::path::PathBuf;

use cable_core::analysis::Bending;
use cable_core::model::Stepping;
use cable_core::record::{NodeChoice, NodeColumns, NodeInterval};
use cable_core::scene::FrictionMobilised;
use cable_core::{Model, Settings};
use clap::{Args, Parser, Subcommand};

#[derive(Debug, Parser)]
#[command(
    name = "cable",
    version,
    about = "Where a cable goes, how hard it pulls, where it rubs",
    after_help = "Exit codes: 0 answered, 1 no solution or not converged, 2 bad input, 74 could not write; \
                  130 and 143 where SIGINT (Ctrl-C) or SIGTERM ended a run, whose folder then holds what was reached."
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: CableCommand,
}

#[derive(Debug, Subcommand)]
pub enum CableCommand {
    /// Find where everything rests at time 0
    Solve(SolveArguments),
    /// Follow the scene over time and write a run folder
    Run(RunArguments),
    /// Say whether a scene can be solved, without solving it; of a run folder, whether it is
    /// complete and how far it came
    Check {
        /// Scene file (TOML), or run folder
        scene: PathBuf,
    },
    /// Print the JSON Schema of a scene file
    Schema,
}

#[derive(Debug, Args)]
pub struct Common {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// auto, catenary, spans, fem or mass-spring
    #[arg(long, default_value = "auto", value_parser = model)]
    pub model: Model,
    /// Relative accuracy asked of the tension [default: 1e-3]; a run in motion for which it is
    /// given is refined up to twice (see --refine of `cable run`)
    #[arg(long, value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Friction at rest: least-sliding, or fully used against a cable drawn towards-start or
    /// towards-end [default: what the scene says]
    #[arg(long, value_parser = mobilised)]
    pub mobilised: Option<FrictionMobilised>,
    /// Bending stiffness of cables that have none in the scene: as-written (stay flexible), likely
    /// (use the likely value of their preset), or where-it-matters (use that value only for cables
    /// that at rest without it would bend too tightly, curl up, lie in folds or cross themselves)
    #[arg(long, default_value = "as-written", value_parser = bending)]
    pub bending: Bending,
    /// Do not report what the likely bending stiffness of a preset would change; the report needs a
    /// second solution
    #[arg(long)]
    pub no_bending: bool,
    /// Print JSON objects (one a line) instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct SolveArguments {
    #[command(flatten)]
    pub common: Common,
    /// Also say how stiffly the cable holds its ends: a dozen small moves of each, without inertia,
    /// friction remembered
    #[arg(long)]
    pub stiffness: bool,
    /// Also answer by every model, on 25 to 400 segments where it has any, and say by how much each
    /// differs and how long it took
    #[arg(long)]
    pub compare: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
A run folder holds scene.toml, run.toml (what was asked, and whether the run is complete), history.csv (a row per time), \
nodes.csv (a row per node and time) and events.csv (warnings and breaks as they begin). DIR must be new, empty or the folder of an \
earlier run, which is kept until the new run is complete; until then that is in DIR/unfinished-N. A run that was ended early \
(Ctrl-C, a full disk, no solution) leaves readable tables up to its last whole instant, and status = \"partial\" in run.toml.")]
pub struct RunArguments {
    #[command(flatten)]
    pub common: Common,
    /// Duration: 10s, 250ms, 2min
    #[arg(long = "for", value_parser = duration_s)]
    pub duration_s: f64,
    /// Time between steps; outputs do not change it [default: 1/240 s, without inertia 1/60 s]
    #[arg(long, value_parser = interval_s)]
    pub step: Option<f64>,
    /// Time between outputs, which changes nothing but what is written [default: 1/60 s, with
    /// inertia at most a 500th of the run]
    #[arg(long, value_parser = interval_s)]
    pub every: Option<f64>,
    /// Without inertia: supports move infinitely slowly, friction remembers
    #[arg(long)]
    pub quasi_static: bool,
    /// Largest number of refinements: while force errors exceed --tolerance and get smaller, halve
    /// segments and steps; each refinement takes four times as long [default: 2 where --tolerance
    /// is given, else 0]
    #[arg(long, value_name = "TIMES", value_parser = clap::value_parser!(u32).range(0..=6), conflicts_with = "no_errors")]
    pub refine: Option<u32>,
    /// Skip the two coarser runs that estimate the errors of a run with inertia (they add a
    /// third to three quarters to its cost)
    #[arg(long)]
    pub no_errors: bool,
    /// Stepping of mass-spring: auto, explicit or preview
    #[arg(long, default_value = "auto", value_parser = stepping)]
    pub stepping: Stepping,
    /// Time between outputs to nodes.csv, which is by far the largest table, or "never" [default:
    /// as --every]
    #[arg(long, value_name = "TIME", value_parser = node_interval)]
    pub nodes_every: Option<NodeInterval>,
    /// Columns of nodes.csv beside time_s and cable, with commas between: arc_length_m, x_m, y_m,
    /// vx_m_per_s, vy_m_per_s, tension_n, strain, stress_pa, curvature_per_m, dx_m, dy_m,
    /// ax_m_per_s2, ay_m_per_s2 [default: all]
    #[arg(long, value_name = "COLUMNS", value_parser = node_columns)]
    pub node_columns: Option<NodeColumns>,
    /// Folder to write into: a new one, an empty one, or that of an earlier run
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

fn model(text: &str) -> Result<Model, String> {
    Model::from_name(text).ok_or_else(|| "the models are auto, catenary, spans, fem and mass-spring".to_owned())
}

/// Refinements of a run for which an accuracy was requested: a third one would take 64 times as
/// long.
const REFINEMENTS_TO_A_TOLERANCE: u32 = 2;

impl Common {
    /// The requested accuracy, or the default.
    pub fn tolerance(&self) -> f64 {
        self.tolerance.unwrap_or(Settings::default().tolerance)
    }
}

impl RunArguments {
    /// Times that elements and steps may be halved.
    pub fn refinements(&self) -> u32 {
        let for_tolerance = self.common.tolerance.filter(|_| !self.no_errors).map(|_| REFINEMENTS_TO_A_TOLERANCE);
        self.refine.or(for_tolerance).unwrap_or(0)
    }

    /// Time between outputs, s. It is shorter in a short run, so that a motion of half a second is
    /// resolved.
    pub fn every_s(&self) -> f64 {
        let part = if self.quasi_static { f64::INFINITY } else { self.duration_s / 500.0 };
        self.every.unwrap_or((1.0_f64 / 60.0).min(part))
    }

    /// The content of nodes.csv.
    pub fn node_choice(&self) -> Result<NodeChoice, String> {
        let interval = self.nodes_every.unwrap_or(NodeInterval::EveryOutput);
        match interval {
            NodeInterval::Seconds(nodes_s) if nodes_s < self.every_s() => Err(format!(
                "--nodes-every {nodes_s} s is shorter than the {} s between outputs: make --every shorter",
                self.every_s()
            )),
            _ => Ok(NodeChoice { columns: self.node_columns.unwrap_or(NodeColumns::ALL), interval }),
        }
    }
}

fn stepping(text: &str) -> Result<Stepping, String> {
    Stepping::from_name(text).ok_or_else(|| "the choices are auto, explicit and preview".to_owned())
}

fn mobilised(text: &str) -> Result<FrictionMobilised, String> {
    let names = || "the choices are least-sliding, towards-start and towards-end".to_owned();
    FrictionMobilised::from_name(text).ok_or_else(names)
}

fn bending(text: &str) -> Result<Bending, String> {
    match text {
        "as-written" => Ok(Bending::AsWritten),
        "likely" => Ok(Bending::Likely),
        "where-it-matters" => Ok(Bending::WhereItMatters),
        _ => Err("the choices are as-written, likely and where-it-matters".to_owned()),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(v) if v > 0.0 && v < 1.0 => Ok(v),
        _ => Err("must be a number above 0 and below 1".to_owned()),
    }
}

/// A time with its unit: `10s`, `250ms`, `2min`; a bare number is seconds.
fn time_s(text: &str) -> Option<f64> {
    let text = text.trim();
    let units = [("ms", 1e-3), ("min", 60.0), ("s", 1.0)];
    let (number, unit_s) = units.iter().find_map(|(u, s)| text.strip_suffix(u).map(|n| (n, *s))).unwrap_or((text, 1.0));
    number.trim().parse::<f64>().ok().map(|v| v * unit_s).filter(|v| v.is_finite())
}

fn duration_s(text: &str) -> Result<f64, String> {
    time_s(text)
        .filter(|v| (0.0..=1e7).contains(v))
        .ok_or_else(|| "must be a time from 0s to 1e7s, such as 10s".to_owned())
}

fn interval_s(text: &str) -> Result<f64, String> {
    time_s(text)
        .filter(|v| (1e-6..=1e7).contains(v))
        .ok_or_else(|| "must be a time from 1e-6s to 1e7s, such as 0.02s".to_owned())
}

fn node_interval(text: &str) -> Result<NodeInterval, String> {
    match text.trim() {
        "never" => Ok(NodeInterval::Never),
        text => interval_s(text).map(NodeInterval::Seconds).map_err(|e| format!("{e}, or never")),
    }
}

fn node_columns(text: &str) -> Result<NodeColumns, String> {
    NodeColumns::named(text.split(',').map(str::trim).filter(|name| !name.is_empty())).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_with_units() {
        assert_eq!(time_s("10s"), Some(10.0));
        assert_eq!(time_s("0.02s"), Some(0.02));
        assert_eq!(time_s("250ms"), Some(0.25));
        assert_eq!(time_s("2min"), Some(120.0));
        assert_eq!(time_s("1.5"), Some(1.5));
        for bad in ["", "s", "ten", "NaNs", "infs", "1e400s", "10 parsecs"] {
            assert_eq!(time_s(bad), None, "{bad}");
        }
        assert!(duration_s("-1s").is_err() && interval_s("0s").is_err() && tolerance("NaN").is_err());
    }

    #[test]
    fn the_command_line_is_sound() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
