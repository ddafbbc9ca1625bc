//! A checkpoint is the state to which a step that fails returns.

use crate::math::Vec2;
use crate::model::fem::state::motion::Motion;
use crate::model::fem::system::contact::contact_set::ContactSet;
use crate::model::fem::system::mesh::Mesh;

/// A state to go back to.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct Checkpoint {
    pub(in crate::model::fem) motion: Motion,
    pub(in crate::model::fem) mesh: Mesh,
    pub(in crate::model::fem) contacts: ContactSet,
    pub(in crate::model::fem) support_node: Vec<Option<usize>>,
    /// Nodes of the loads; their number never changes.
    pub(in crate::model::fem) load_node: Vec<usize>,
    pub(in crate::model::fem) reaction: Vec<Vec2>,
}
