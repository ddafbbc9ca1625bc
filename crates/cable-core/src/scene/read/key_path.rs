//! A path names a place in a scene, such as `cables[0].supports[1].at_m`, and allocates only when
//! it is printed.

use std::fmt;

use crate::error::{DocumentFault, SceneError, SceneFault};

/// A place in a scene, as a chain on the stack.
#[derive(Clone, Copy)]
pub(crate) enum Path<'a> {
    /// The scene itself.
    Root,
    /// A key of a table.
    Key(&'a Path<'a>, &'static str),
    /// An element of an array.
    Index(&'a Path<'a>, usize),
}

impl Path<'_> {
    /// The place of a key below this one.
    pub(crate) fn key(&self, name: &'static str) -> Path<'_> {
        Path::Key(self, name)
    }

    /// The place of an element below this one.
    pub(crate) fn index(&self, index: usize) -> Path<'_> {
        Path::Index(self, index)
    }

    /// A fault here.
    pub(crate) fn fault(&self, fault: SceneFault) -> SceneError {
        SceneError { path: self.to_string(), fault, at: None }
    }

    /// Something here must be there, or must not.
    pub(crate) fn document_fault(&self, fault: DocumentFault) -> SceneError {
        self.fault(SceneFault::Document(fault))
    }
}

impl fmt::Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Path::Root => Ok(()),
            Path::Key(Path::Root, name) => f.write_str(name),
            Path::Key(above, name) => write!(f, "{above}.{name}"),
            Path::Index(above, index) => write!(f, "{above}[{index}]"),
        }
    }
}
