//! The robot report describes the tracked vehicle in an answer: its place, the forces on it, and
//! what determines its speed.

use serde::{Deserialize, Serialize};

/// State of its motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DriveState {
    /// The robot has no command and stands.
    #[default]
    Standing,
    /// The robot has the commanded speed, or accelerates towards it.
    Driving,
    /// Slower than commanded: what it pulls costs it speed.
    Slowed,
    /// It would have to pull more than its drive can.
    Stalled,
    /// It would have to pull more than its tracks can hold on the ground.
    Slipping,
    /// The cable draws it over the ground against its will.
    Dragged,
    /// The ground ends or is too steep.
    Blocked,
    /// The robot's own cable is in its way and cannot move out of it.
    Jammed,
}

impl DriveState {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Standing => "standing",
            Self::Driving => "driving",
            Self::Slowed => "slowed by its load",
            Self::Stalled => "stalled: the drive is too weak",
            Self::Slipping => "tracks slipping: not enough traction",
            Self::Dragged => "dragged by the cable",
            Self::Blocked => "blocked: too steep, or the ground ends",
            Self::Jammed => "jammed: the cable is in its way",
        }
    }
}

/// Work of each force on the vehicle (force times displacement), J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RobotWork {
    /// Of its tracks while they hold: the drive, less what it brakes.
    pub drive_j: f64,
    /// Of its tracks while they slip.
    pub slip_j: f64,
    /// Of rolling resistance.
    pub rolling_j: f64,
    /// Of its weight, by how high it stands.
    pub weight_j: f64,
    /// Of the cable, on its hitch by how that goes, and on its outline along the ground.
    pub cable_j: f64,
    /// Of the ground where it tips the vehicle over corners: that takes nothing from its speed.
    pub ground_j: f64,
    /// Energy lost where the ground or a cable squeezed against a wall stops it.
    pub impact_j: f64,
}

impl RobotWork {
    /// Of all forces: the change of its kinetic energy.
    #[must_use]
    pub fn total_j(&self) -> f64 {
        self.drive_j + self.slip_j + self.rolling_j + self.weight_j + self.cable_j + self.ground_j + self.impact_j
    }
}

/// Its state at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotReport {
    /// Middle of its tracks on the ground, m.
    pub x_m: f64,
    /// Middle of its tracks on the ground, m.
    pub y_m: f64,
    /// Slope it stands on, °, positive where it climbs to the right.
    pub pitch_deg: f64,
    /// Speed along the ground, positive to the right, m/s.
    pub speed_m_per_s: f64,
    /// Acceleration that the governor commanded, positive to the right, m/s²; 0 if something else
    /// held the robot up.
    #[serde(default)]
    pub governor_m_per_s2: f64,
    /// Commanded speed, m/s.
    pub commanded_m_per_s: f64,
    /// Force of its tracks along the ground, N.
    pub thrust_n: f64,
    /// Force of the ground on it, across it, N.
    pub normal_n: f64,
    /// Most force its tracks could transmit now, N.
    pub traction_n: f64,
    /// Force of the cable on its hitch, N.
    pub hitch_x_n: f64,
    /// Force of the cable on its hitch, N.
    pub hitch_y_n: f64,
    /// Force of the cable on its outline, N.
    #[serde(default)]
    pub push_x_n: f64,
    /// Force of the cable on its outline, N.
    #[serde(default)]
    pub push_y_n: f64,
    /// Work of the forces on it since it began.
    #[serde(default)]
    pub work: RobotWork,
    /// The reason for the present speed.
    pub going: DriveState,
    /// The leg of its path it is on; None by hand or at the end.
    pub leg: Option<usize>,
}
