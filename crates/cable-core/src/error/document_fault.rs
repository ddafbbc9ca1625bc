//! This file lists the faults of keys, names and lines that must be there or must not.

/// A key, a name or a line that must be there, or must not.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DocumentFault {
    /// A value that is refused in the words of the reader of its type.
    Refused {
        /// The words.
        message: String,
    },
    /// A key is missing.
    Missing,
    /// A key is missing that a kind of support needs.
    MissingForKind {
        /// The kind as files name it.
        kind: &'static str,
    },
    /// A key does not belong to a kind of support.
    NotForKind {
        /// The kind as files name it.
        kind: &'static str,
    },
    /// A word that is none of those known.
    UnknownWord {
        /// The word as given.
        word: String,
        /// The words known.
        known: &'static [&'static str],
        /// The nearest of them.
        nearest: Option<String>,
    },
    /// A text longer than a scene may be.
    LongText {
        /// Its length, bytes.
        bytes: usize,
        /// The most that it may have, bytes.
        most: usize,
    },
    /// A text without a word.
    EmptyText,
    /// A name without a letter.
    EmptyName,
    /// A name that is too long.
    LongName {
        /// The most that it may have, bytes.
        most: usize,
    },
    /// A name that another one of its kind has.
    TakenName {
        /// The name.
        name: String,
    },
    /// A scene without a cable.
    NoCable,
    /// A cable with fewer than two supports.
    TooFewSupports,
    /// A cable on a robot that the scene does not have.
    HitchWithoutRobot,
    /// A pulley at an end of a cable.
    PulleyAtEnd,
    /// A free support between the ends of a cable.
    FreeWithin,
    /// An arc length of a support at an end.
    ArcLengthAtEnd,
    /// No arc length of a support between the ends.
    MissingArcLength,
    /// A route of fewer than two points.
    ShortRoute,
    /// A constant force and a series.
    TwoForces,
    /// Neither a constant force nor a series.
    NoForce,
    /// A series without a time.
    NoTime,
    /// A terrain that does not go to the right.
    TerrainLeftwards,
    /// A polygon whose last point is its first.
    PolygonClosedTwice,
    /// A polygon without an area.
    PolygonWithoutArea,
    /// A point in the place of the one before it.
    RepeatedPoint,
    /// A line of which it cannot be found in time whether it crosses itself.
    Tangled,
}
