//! The clipboard holds what was copied, for this window and as text for other programs.

use cable_core::math::Point;
use cable_core::scene::Support;
use cable_core::{Cable, Load, Obstacle};

/// The things that were copied.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clipboard {
    /// The things.
    pub things: Vec<Thing>,
    /// The middle of the copied items, m.
    pub middle_m: Point,
    /// The text as it was given to the system: if pasted text differs, it comes from another
    /// program.
    pub text: String,
}

impl Clipboard {
    /// Nothing was copied.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.things.is_empty()
    }
}

/// A copy of a thing of the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Thing {
    /// A cable.
    Cable(Box<Cable>),
    /// A support, and where it was, m.
    Support(Box<Support>, Point),
    /// An obstacle.
    Obstacle(Obstacle),
    /// A point load.
    Load(Load),
}
