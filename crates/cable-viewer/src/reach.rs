//! The map of where the robot can go, computed beside the window.

use std::sync::Arc;

use cable_core::robot::reach::{self, Map};
use cable_core::{Scene, Settings};

use crate::background;

/// Places looked at. More: finer and, with the way back from each, slower by the square; fewer: mounds fall between them.
pub const PLACES: usize = 41;

/// What the map asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The scene.
    pub scene: Scene,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// From where to where, m.
    pub ends_m: [f64; 2],
}

/// The map, and the scene it is of.
pub type Found = (Arc<Map>, Arc<Scene>);
/// How far it is.
pub type Progress = background::Progress<Found>;
/// A map being computed.
pub type Job = background::Job<Found>;

/// Starts one; `shown` is called whenever there is something new to show.
#[must_use]
pub fn start(order: Order, shown: impl Fn() + Send + 'static) -> Job {
    let work = move |heard: background::Heard<'_>| {
        let map = reach::reach(&order.scene, order.settings, (order.ends_m, PLACES), heard);
        map.map(|map| (Arc::new(map), Arc::new(order.scene))).map_err(|e| e.to_string())
    };
    Job::start("safe reach", work, shown)
}
