//! The nodes of an answer are shared by its copies until one of them is changed.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::{Deserialize, Serialize, Serializer};

use super::Node;

/// The nodes of a cable, in order of arc length, read and changed like a `Vec<Node>`.
///
/// An answer is kept by its model, for a reset, in a recording and on the screen. Copies share the
/// nodes, which are nearly all of it; a copy that is changed gets its own first.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(from = "Vec<Node>")]
pub struct SharedNodes(Arc<Vec<Node>>);

impl Deref for SharedNodes {
    type Target = Vec<Node>;

    fn deref(&self) -> &Vec<Node> {
        &self.0
    }
}

impl DerefMut for SharedNodes {
    fn deref_mut(&mut self) -> &mut Vec<Node> {
        Arc::make_mut(&mut self.0)
    }
}

impl From<Vec<Node>> for SharedNodes {
    fn from(nodes: Vec<Node>) -> Self {
        Self(Arc::new(nodes))
    }
}

impl Serialize for SharedNodes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl From<SharedNodes> for Vec<Node> {
    fn from(nodes: SharedNodes) -> Self {
        Arc::unwrap_or_clone(nodes.0)
    }
}

impl FromIterator<Node> for SharedNodes {
    fn from_iter<I: IntoIterator<Item = Node>>(nodes: I) -> Self {
        Vec::from_iter(nodes).into()
    }
}

impl IntoIterator for SharedNodes {
    type Item = Node;
    type IntoIter = std::vec::IntoIter<Node>;

    fn into_iter(self) -> Self::IntoIter {
        Vec::from(self).into_iter()
    }
}

impl<'a> IntoIterator for &'a SharedNodes {
    type Item = &'a Node;
    type IntoIter = std::slice::Iter<'a, Node>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a> IntoIterator for &'a mut SharedNodes {
    type Item = &'a mut Node;
    type IntoIter = std::slice::IterMut<'a, Node>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_share_their_memory_until_one_is_changed() {
        let first: SharedNodes = vec![Node::default(); 3].into();
        let mut copy = first.clone();
        assert!(std::ptr::eq(first.as_ptr(), copy.as_ptr()));
        copy[1].tension_n = 2.0;
        assert!((first[1].tension_n, copy[1].tension_n) == (0.0, 2.0));
    }
}
