//! Open faults: the least that is known to go wrong, so that nothing more does.

/// Of the scenes of a family how many are known to be wrong, refused, and outside of what they say, and why.
pub struct Open {
    pub family: &'static str,
    pub wrong: usize,
    pub refused: usize,
    pub outside: usize,
    #[allow(dead_code)] // read by people
    pub reason: &'static str,
}

/// Of the two scenes of each family that are always asked.
pub const IN_CI: &[Open] = &[
    Open {
        family: "ground by fem",
        wrong: 1,
        refused: 0,
        outside: 0,
        reason: "1: over a crest of hardly any tension the sag of the bars beside is taken for more turn (208°) than there is; nodes on the \
                 round are drawn 1.5e-5 m apart from the bar beside",
    },
    Open {
        family: "slack over things",
        wrong: 0,
        refused: 1,
        outside: 0,
        reason: "0: loose cable over posts and boxes: friction of a contact is beyond its cone by a thousandth, and it is refused",
    },
    Open {
        family: "rubbing wheels",
        wrong: 0,
        refused: 0,
        outside: 1,
        reason: "0: answered one way round, refused the other: which side of a wheel presses is found by chance",
    },
];
