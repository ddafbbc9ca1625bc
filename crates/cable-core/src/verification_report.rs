//! The report of a verification says which laws of mechanics an answer was asked, and which it
//! breaks; [`crate::answer_verifier`] makes it.

use serde::{Deserialize, Serialize};

use crate::units::Quantity;

/// A law that an answer must obey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Law {
    /// Every number is finite.
    Finite,
    /// Arc length grows from 0 to the cable's length.
    Material,
    /// Supports, contacts, loads and weight add up to nothing, of every piece, its free ends with
    /// it.
    Balance,
    /// They add up to nothing of the whole cable, as they are reported.
    TotalBalance,
    /// The stiff cable's moments balance its shear.
    Moment,
    /// The cable is where its supports hold it.
    Support,
    /// The tension of a flexible cable is the size of the force in it.
    Tension,
    /// A flexible cable does not push.
    Compression,
    /// A stiff cable pushes with no more than what would bend it aside.
    Stability,
    /// Tension is strain times axial stiffness, and the line through the nodes has the length of
    /// the stretched material.
    Length,
    /// Slack in the air has the tension that belongs to its shape.
    Slack,
    /// Nothing is inside an obstacle.
    Penetration,
    /// A contact pushes.
    Push,
    /// Friction lies within its cone.
    Friction,
    /// The cable does not run through itself.
    SelfContact,
    /// In motion: what a step changes of the momentum is what weight, loads, supports and contacts
    /// gave.
    Momentum,
}

impl Law {
    /// Its name in a sentence.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Finite => "finite numbers",
            Self::Material => "material from end to end",
            Self::Balance => "balance of forces",
            Self::TotalBalance => "balance of the whole cable",
            Self::Moment => "balance of moments",
            Self::Support => "held by its supports",
            Self::Tension => "tension is the force",
            Self::Compression => "no compression",
            Self::Stability => "stability",
            Self::Length => "length",
            Self::Slack => "slack in the air pulls",
            Self::Penetration => "nothing inside obstacles",
            Self::Push => "contacts push",
            Self::Friction => "friction within its cone",
            Self::SelfContact => "nothing through itself",
            Self::Momentum => "momentum",
        }
    }

    /// The law in words, as it is broken.
    #[must_use]
    pub fn broken(self) -> &'static str {
        match self {
            Self::Finite => "a number is not finite",
            Self::Material => "the nodes do not run from one end of the material to the other",
            Self::Balance => "forces are out of balance",
            Self::TotalBalance => "the forces that are reported of the whole cable are out of balance",
            Self::Moment => "moments are out of balance",
            Self::Support => "the cable is not where it is held",
            Self::Tension => "tension is not the force in the cable",
            Self::Compression => "a flexible cable pushes",
            Self::Stability => "a stiff cable pushes with more than would bend it aside",
            Self::Length => "the way drawn is not as long as the cable",
            Self::Slack => "segments too long for slack that hangs in the air leave out its pull",
            Self::Penetration => "the cable lies inside an obstacle",
            Self::Push => "a contact pulls",
            Self::Friction => "friction exceeds its cone",
            Self::SelfContact => "the cable runs through itself",
            Self::Momentum => "the change of momentum is not the impulse of what acts",
        }
    }

    /// Returns whether it is a law of the whole cable, which no place of it breaks.
    #[must_use]
    pub fn is_of_whole(self) -> bool {
        matches!(self, Self::TotalBalance | Self::Momentum)
    }

    /// The quantity that is measured.
    #[must_use]
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Finite => Quantity::Number,
            Self::Material | Self::Support | Self::Length | Self::Penetration | Self::SelfContact => Quantity::Length,
            Self::Moment => Quantity::Moment,
            Self::Momentum => Quantity::Impulse,
            Self::Balance
            | Self::TotalBalance
            | Self::Tension
            | Self::Compression
            | Self::Stability
            | Self::Slack
            | Self::Push
            | Self::Friction => Quantity::Force,
        }
    }
}

/// A broken law with its place: the worst of its kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The law.
    pub law: Law,
    /// Name of the cable.
    pub cable: String,
    /// Arc length, m.
    pub arc_length_m: f64,
    /// Place, m.
    pub at_m: [f64; 2],
    /// The obstacle or support there; empty if there is none.
    pub with: String,
    /// By how much, in the SI unit of [`Law::quantity`].
    pub value: f64,
    /// Its limit.
    pub limit: f64,
}

/// The forces on all cables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Weight, wind and loads, N.
    pub loads_n: [f64; 2],
    /// Supports on the cable, N.
    pub supports_n: [f64; 2],
    /// Obstacles and the floor of a plan view on the cable, N, as the cable's own forces ask for
    /// it.
    pub contacts_n: [f64; 2],
    /// Residual force of the worst piece, N.
    pub residual_n: f64,
    /// The force that residuals are compared with, N: the greatest tension or load.
    pub scale_n: f64,
}

/// A law that was not asked of a cable, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotChecked {
    /// Balance and length of a cable that moves.
    MovingBalance {
        /// Name of the cable.
        cable: String,
    },
    /// Balance and length of a cable that is broken.
    BrokenBalance {
        /// Name of the cable.
        cable: String,
    },
    /// Contact of a cable with itself, which only a full check asks for.
    SelfContact {
        /// Name of the cable.
        cable: String,
    },
}

/// Findings of a check.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verification {
    /// Broken laws, the worst first; empty = sound.
    pub findings: Vec<Finding>,
    /// Laws that were asked.
    pub checked: Vec<Law>,
    /// Laws that were not asked, and why.
    pub not_checked: Vec<NotChecked>,
    /// Forces on all cables.
    pub balance: Balance,
    /// Length of material beyond the line through the nodes, m: cable in folds or layers, which the
    /// plane cannot show.
    pub folded_m: f64,
}

impl Verification {
    /// Returns whether no law is broken.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.findings.is_empty()
    }

    /// The worst broken law.
    #[must_use]
    pub fn worst(&self) -> Option<&Finding> {
        self.findings.first()
    }

    pub(crate) fn ask(&mut self, law: Law) {
        if !self.checked.contains(&law) {
            self.checked.push(law);
        }
    }

    /// Of several findings of one law on one cable the worst is kept.
    pub(crate) fn report(&mut self, finding: Finding) {
        // A value that is no number is the worst.
        let excess = |f: &Finding| if f.value.is_finite() { f.value / f.limit } else { f64::INFINITY };
        match self.findings.iter_mut().find(|f| f.law == finding.law && f.cable == finding.cable) {
            Some(known) if excess(known) >= excess(&finding) => {}
            Some(known) => *known = finding,
            None => self.findings.push(finding),
        }
        self.findings.sort_by(|a, b| excess(b).total_cmp(&excess(a)));
    }
}
