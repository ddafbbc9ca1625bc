//! These modules describe the boundary of an obstacle, the tension of a cable that slides along it
//! with its friction memory, and cable that lies loose on it.
//!
//! | room | content |
//! |---|---|
//! | `curve.rs` | obstacle boundary offset to the centre line: edges, arcs, coordinate p, breaks |
//! | `capstan/` | capstan law with weight: tension and material along edges and arcs |
//! | `arc.rs` | closed forms of tension and material along a stretch of an arc |
//! | `segment_cursor.rs` | one boundary piece seen from a point; where two tensions become equal |
//! | `friction_memory.rs` | tension profile of a contact: stick zone, slip fronts, breakpoints |
//! | `loose_section.rs` | a section without tension: parts that hang, lie, or are heaped |

pub(in crate::model::spans) mod arc;
pub(in crate::model::spans) mod capstan;
pub(in crate::model::spans) mod curve;
pub(in crate::model::spans) mod friction_memory;
pub(in crate::model::spans) mod loose_section;
pub(in crate::model::spans) mod segment_cursor;

pub(in crate::model::spans) use capstan::{CableLaw, ContactPath, SlideResult};
pub(in crate::model::spans) use curve::{BoundaryPoint, ChainRange, Curve, PieceShape, SUPPORT_CONTACT_DISTANCE_M};
pub(in crate::model::spans) use friction_memory::{
    Breakpoint, Ends, Mode, SlipFront, StickZone, SweepDirection, TensionProfile,
};
pub(in crate::model::spans) use loose_section::{BearingEdge, Heap, LooseSection, LyingStretch, SlackForm, SlackPart};
pub(in crate::model::spans) use segment_cursor::{CachedPiece, SegmentCursor};
