//! The selection is what is picked, hovered and dragged on the canvas.

use cable_core::math::Point;

/// A thing on the canvas that can be picked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Item {
    /// A whole cable.
    Cable(usize),
    /// A support of a cable.
    Support {
        /// Index of the cable.
        cable: usize,
        /// Index of the support.
        support: usize,
    },
    /// A whole obstacle.
    Obstacle(usize),
    /// A corner of an obstacle.
    Corner {
        /// Index of the obstacle.
        obstacle: usize,
        /// Index of the corner.
        corner: usize,
    },
    /// A point load.
    Load(usize),
    /// The head of a load's arrow: its force.
    Head(usize),
    /// The robot.
    Robot,
    /// Where a leg of the robot's path ends.
    Leg(usize),
}

/// A place on a cable whose tension is taken apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Index of the cable.
    pub cable: usize,
    /// Where on it, m.
    pub arc_length_m: f64,
    /// The end the sum begins at.
    pub from: cable_core::analysis::tension_budget::StartEnd,
}

/// A thing being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grab {
    /// What.
    pub item: Item,
    /// From the pointer to it when it was picked up, m.
    pub offset_m: Point,
}
