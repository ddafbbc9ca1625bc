//! The thing that leads a cable while time runs.

use cable_core::math::Point;

use crate::geometry::bounds::Bounds;
use crate::geometry::robot::robot_outline;
use crate::geometry::supports::support_position;
use crate::state::AppState;

/// The kind of a thing that leads a cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeaderKind {
    /// The robot.
    Robot,
    /// A support that moves by a schedule.
    MovingEnd,
    /// The cable itself.
    Cable,
}

impl LeaderKind {
    /// Its name within a sentence.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Robot => "robot",
            Self::MovingEnd => "moving end",
            Self::Cable => "cable",
        }
    }
}

/// The thing that leads a cable, and where it is.
#[derive(Clone, Copy, Debug)]
pub struct Leader {
    /// What it is.
    pub kind: LeaderKind,
    /// Least and greatest corner, m.
    pub bounds_m: [Point; 2],
}

/// The robot, else the supports that move by a schedule, else the cables themselves; None where
/// time has not run.
#[must_use]
pub fn leader(state: &AppState) -> Option<Leader> {
    let solution = state.live.snapshot.solution.as_ref().filter(|s| s.time_s > 0.0)?;
    let robot =
        bounds_of(robot_outline(state).into_iter()).map(|bounds_m| Leader { kind: LeaderKind::Robot, bounds_m });
    let cables = state.document.scene.cables.iter().enumerate();
    let scheduled = cables.flat_map(|(k, cable)| {
        let moves = cable.supports.iter().enumerate().filter(|(_, s)| s.motion.is_some());
        moves.filter_map(move |(support, _)| support_position(state, k, support))
    });
    let scheduled = || bounds_of(scheduled).map(|bounds_m| Leader { kind: LeaderKind::MovingEnd, bounds_m });
    let nodes = solution.cables.iter().flat_map(|c| &c.nodes).map(|n| [n.x_m, n.y_m]);
    let whole = || bounds_of(nodes).map(|bounds_m| Leader { kind: LeaderKind::Cable, bounds_m });
    robot.or_else(scheduled).or_else(whole)
}

fn bounds_of(points: impl Iterator<Item = Point>) -> Option<[Point; 2]> {
    let mut bounds = Bounds::EMPTY;
    points.for_each(|p| bounds.add(p));
    (bounds.low[0] <= bounds.high[0]).then_some([bounds.low, bounds.high])
}
