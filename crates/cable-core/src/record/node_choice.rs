//! A choice says which nodes of a run go into `nodes.csv`, by far the largest table, and with which
//! of their figures.

use crate::solution::Node;

/// Figures of a node, in the order of the table's columns.
pub(super) fn node_values(n: &Node) -> [f64; NodeColumns::COUNT] {
    let ([dx_m, dy_m], [ax_m_per_s2, ay_m_per_s2]) = (n.displacement_m, n.acceleration_m_per_s2);
    [
        n.arc_length_m,
        n.x_m,
        n.y_m,
        n.vx_m_per_s,
        n.vy_m_per_s,
        n.tension_n,
        n.strain,
        n.stress_pa,
        n.curvature_per_m,
        dx_m,
        dy_m,
        ax_m_per_s2,
        ay_m_per_s2,
    ]
}

/// The node with these figures.
pub(super) fn node_of(values: [f64; NodeColumns::COUNT]) -> Node {
    let [arc_length_m, x_m, y_m, vx_m_per_s, vy_m_per_s, tension_n, strain, stress_pa, curvature_per_m, more @ ..] =
        values;
    let [dx_m, dy_m, ax_m_per_s2, ay_m_per_s2] = more;
    Node {
        arc_length_m,
        x_m,
        y_m,
        vx_m_per_s,
        vy_m_per_s,
        tension_n,
        strain,
        stress_pa,
        curvature_per_m,
        displacement_m: [dx_m, dy_m],
        acceleration_m_per_s2: [ax_m_per_s2, ay_m_per_s2],
        ..Node::default()
    }
}

/// Columns of `nodes.csv` beside `time_s` and `cable`, which it always has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeColumns([bool; Self::COUNT]);

/// A column that `nodes.csv` does not know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownColumn {
    /// As it was asked for.
    pub name: String,
}

impl NodeColumns {
    /// Their number.
    pub const COUNT: usize = 13;

    /// Their names, in the order of the table.
    pub const NAMES: [&str; Self::COUNT] = [
        "arc_length_m",
        "x_m",
        "y_m",
        "vx_m_per_s",
        "vy_m_per_s",
        "tension_n",
        "strain",
        "stress_pa",
        "curvature_per_m",
        "dx_m",
        "dy_m",
        "ax_m_per_s2",
        "ay_m_per_s2",
    ];

    /// All of them.
    pub const ALL: Self = Self([true; Self::COUNT]);

    /// Those named; their order does not matter.
    ///
    /// # Errors
    /// A name that is none of them.
    pub fn named<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, UnknownColumn> {
        let mut chosen = [false; Self::COUNT];
        for name in names {
            let place = Self::NAMES.iter().zip(&mut chosen).find(|(known, _)| **known == name);
            let (_, chosen) = place.ok_or_else(|| UnknownColumn { name: name.to_owned() })?;
            *chosen = true;
        }
        Ok(Self(chosen))
    }

    /// Names of those chosen.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        self.pick(Self::NAMES)
    }

    /// Returns what belongs to those chosen.
    pub(super) fn pick<T>(self, all: [T; Self::COUNT]) -> impl Iterator<Item = T> {
        all.into_iter().zip(self.0).filter_map(|(value, chosen)| chosen.then_some(value))
    }
}

/// At which of a run's output times nodes are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NodeInterval {
    /// At each.
    EveryOutput,
    /// At the first one, the last one, and the first one in each interval of so long, s.
    Seconds(f64),
    /// At none: the table has its header alone.
    Never,
}

/// The content of `nodes.csv`; by default all nodes at all outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeChoice {
    /// Its columns.
    pub columns: NodeColumns,
    /// Its interval.
    pub interval: NodeInterval,
}

impl Default for NodeChoice {
    fn default() -> Self {
        Self { columns: NodeColumns::ALL, interval: NodeInterval::EveryOutput }
    }
}

/// An output that comes before the beginning of an interval by less than this part of it is at its
/// beginning: times of outputs are sums that round. Less than 1e-9 is round-off of long runs; at
/// 0.1 and more, outputs of the interval before would count.
const TIME_TOLERANCE_FRACTION: f64 = 1e-6;

impl NodeChoice {
    /// Returns whether nodes are written at a time, s: then the interval that this time is in.
    /// `last` is the one of the nodes before.
    pub(super) fn due(&self, time_s: f64, last: Option<f64>) -> Option<f64> {
        match self.interval {
            NodeInterval::EveryOutput => Some(time_s),
            NodeInterval::Seconds(every_s) => {
                let interval = (time_s / every_s + TIME_TOLERANCE_FRACTION).floor();
                last.is_none_or(|last| interval > last).then_some(interval)
            }
            NodeInterval::Never => None,
        }
    }

    pub(super) fn header(&self) -> Vec<&'static str> {
        ["time_s", "cable"].into_iter().chain(self.columns.names()).collect()
    }
}
