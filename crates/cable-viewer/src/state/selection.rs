//! The selection is what is picked, hovered and dragged on the canvas.

use cable_core::math::Point;

use crate::state::clipboard::Clipboard;

/// The things that are picked, hovered, dragged and copied.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// The thing that the user picked.
    pub selected: Option<Item>,
    /// The things that were picked besides: they are moved, copied and removed with it.
    pub also_selected: Vec<Item>,
    /// Two corners of the frame being drawn round things to pick, m.
    pub marquee_m: Option<[Point; 2]>,
    /// The things that were copied.
    pub clipboard: Clipboard,
    /// The thing that the pointer is over.
    pub hovered: Option<Item>,
    /// The thing that is being dragged.
    pub grab: Option<Grab>,
    /// The support that the pointer holds by a spring while time runs.
    pub spring_support: Option<(usize, usize)>,
    /// The place where the pointer is, m; None outside the canvas.
    pub cursor_m: Option<Point>,
}

impl Selection {
    /// Everything picked.
    #[must_use]
    pub fn selected_items(&self) -> Vec<Item> {
        self.selected.into_iter().chain(self.also_selected.iter().copied()).collect()
    }

    /// Returns whether a thing is picked.
    #[must_use]
    pub fn contains(&self, item: Item) -> bool {
        self.selected == Some(item) || self.also_selected.contains(&item)
    }
}

/// A thing that can be picked, on the canvas or in the outline.
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
    LoadHead(usize),
    /// The robot.
    Robot,
    /// The end of a leg of the robot's path.
    PathLeg(usize),
    /// The scene as a whole: its name, map and robot.
    Scene,
    /// Gravity, wind, temperature and view.
    Environment,
    /// Model, mesh and accuracy.
    Solver,
}

/// A thing being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grab {
    /// The item.
    pub item: Item,
    /// From the pointer to it when it was picked up, m.
    pub offset_m: Point,
}
