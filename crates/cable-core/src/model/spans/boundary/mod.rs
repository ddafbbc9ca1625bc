//! These modules describe the boundary of an obstacle, the tension of a cable that slides along it
//! with its friction memory, and cable that lies loose on it.
//!
//! | room | content |
//! |---|---|
//! | `curve.rs` | obstacle boundary offset to the centre line: edges, arcs, coordinate p, breaks |
//! | `capstan/` | capstan law with weight: tension and material along edges and arcs |
//! | `friction_memory.rs` | tension profile of a contact: stick zone, slip fronts, breakpoints |
//! | `loose_section.rs` | a section without tension: parts that hang, lie, or are heaped |

pub(in crate::model::spans) mod capstan;
pub(in crate::model::spans) mod curve;
pub(in crate::model::spans) mod friction_memory;
pub(in crate::model::spans) mod loose_section;

pub(in crate::model::spans) use capstan::{
    CableLaw, CachedPiece, ContactPath, SegmentCursor, SlideResult, slide_on_piece,
};
pub(in crate::model::spans) use curve::{BoundaryPoint, ChainRange, Curve, PieceShape, SUPPORT_CONTACT_DISTANCE_M};
pub(in crate::model::spans) use friction_memory::{
    Breakpoint, Ends, Mode, SlipFront, StickZone, SweepDirection, TensionProfile,
};
pub(in crate::model::spans) use loose_section::{BearingEdge, Heap, LooseSection, LyingStretch, SlackForm, SlackPart};
