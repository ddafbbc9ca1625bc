//! Presets of cables, robots and maps are embedded from `assets/`; every number has its source and
//! confidence.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use crate::error::SceneFault;
use crate::math::Point;
use crate::scene::nearest_name::nearest;
use crate::scene::obstacle::Obstacle;

/// Confidence in a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Confidence {
    /// Read in a source.
    A,
    /// Second-hand.
    B,
    /// Derived or remembered: show it as estimated.
    C,
}

/// A number with its source. Its unit is in the name of the field that holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// The likely value.
    pub value: f64,
    /// The least it may be, if a band is known.
    pub low: Option<f64>,
    /// The most it may be.
    pub high: Option<f64>,
    /// Confidence in it.
    pub confidence: Confidence,
    /// Its source.
    pub source: String,
}

/// A kind of cable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CablePreset {
    /// Its name in a scene file.
    #[serde(skip)]
    pub id: &'static str,
    /// Its name for a person.
    pub name: String,
    /// A description, and what to beware of.
    pub note: String,
    /// Mass per unstretched metre, kg/m.
    pub linear_density_kg_per_m: Figure,
    /// EA, N.
    pub axial_stiffness_n: Figure,
    /// EI, N·m².
    pub bending_stiffness_n_m2: Figure,
    /// EI by which bends at sharp corners are judged where a scene takes the cable as perfectly
    /// flexible, N·m²: the geometric mean of strands that slip and strands that stick.
    pub likely_bending_stiffness_n_m2: Figure,
    /// Outside diameter, m.
    pub diameter_m: Figure,
    /// Fraction of critical damping.
    pub damping_ratio: Figure,
    /// Thermal expansion, 1/K.
    pub thermal_expansion_per_k: Figure,
    /// Tension of the first warning, N.
    pub service_tension_n: Figure,
    /// Tension at which it breaks, N.
    pub breaking_tension_n: Figure,
    /// Time over which the mean tension has to reach that, s.
    pub breaking_time_s: Figure,
    /// Smallest bend radius, m.
    pub min_bend_radius_m: Figure,
    /// Coulomb friction.
    pub friction: Figure,
    /// Largest sidewall pressure T/R, N/m, where one is stated.
    pub sidewall_limit_n_per_m: Option<Figure>,
}

impl CablePreset {
    /// Its numbers under the keys a scene file gives them.
    #[must_use]
    pub fn figures(&self) -> [(&'static str, &Figure); 11] {
        [
            ("linear_density_kg_per_m", &self.linear_density_kg_per_m),
            ("axial_stiffness_n", &self.axial_stiffness_n),
            ("bending_stiffness_n_m2", &self.bending_stiffness_n_m2),
            ("diameter_m", &self.diameter_m),
            ("damping_ratio", &self.damping_ratio),
            ("thermal_expansion_per_k", &self.thermal_expansion_per_k),
            ("service_tension_n", &self.service_tension_n),
            ("breaking_tension_n", &self.breaking_tension_n),
            ("min_bend_radius_m", &self.min_bend_radius_m),
            ("friction", &self.friction),
            ("breaking_time_s", &self.breaking_time_s),
        ]
    }

    pub(in crate::scene) fn values(&self) -> Vec<(&'static str, f64)> {
        self.figures().into_iter().map(|(key, figure)| (key, figure.value)).collect()
    }
}

/// A kind of tracked vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotPreset {
    /// Its name in a scene file.
    #[serde(skip)]
    pub id: &'static str,
    /// Its name for a person.
    pub name: String,
    /// A description.
    pub note: String,
    /// Mass, kg.
    pub mass_kg: Figure,
    /// Width across the tracks, m.
    pub width_m: Figure,
    /// Height, m.
    pub height_m: Figure,
    /// Length, m.
    pub length_m: Figure,
    /// Greatest speed, m/s.
    pub speed_m_per_s: Figure,
    /// Greatest pull on the ground, N.
    pub drive_pull_n: Figure,
    /// Distance of the cable's hitch behind its tracks' middle, m.
    pub hitch_back_m: Figure,
    /// Height of the cable's hitch above the ground, m.
    pub hitch_up_m: Figure,
    /// Its outline looking right, m from where its tracks' middle touches the ground.
    pub outline_m: Vec<Point>,
}

impl RobotPreset {
    /// Half the length of its tracks on the ground, m: of the foot of its outline.
    #[must_use]
    pub fn track_half_length_m(&self) -> f64 {
        let foot = self.outline_m.iter().filter(|p| p[1] <= 1e-9).map(|p| p[0]);
        let [low, high] = foot.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
        if low < high { 0.5 * (high - low) } else { 0.5 * self.length_m.value }
    }
}

/// A tank or course to put a cable in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapPreset {
    /// Short name.
    #[serde(skip)]
    pub id: &'static str,
    /// Its name for a person.
    pub name: String,
    /// A description, and which of its shape is known.
    pub note: String,
    /// Diameter or width inside, m.
    pub inside_width_m: Figure,
    /// Greatest depth of waste, m.
    pub waste_depth_m: Figure,
    /// Height of the opening the cable comes through above the floor, m.
    pub riser_height_m: Figure,
    /// Width of that opening, m.
    pub riser_width_m: Figure,
    /// Position of the opening through which the cable comes, m.
    pub riser_at_m: Point,
    /// Terrain and what stands in it; the shape is drawn, not surveyed, unless the note says
    /// otherwise.
    pub obstacles: Vec<Obstacle>,
}

macro_rules! embedded {
    ($folder:literal: $($id:literal),+ $(,)?) => {
        &[$(($id, include_str!(concat!("../../../../../assets/", $folder, "/", $id, ".toml")))),+]
    };
}

const CABLES: &[(&str, &str)] = embedded!("cables":
    "soow-6-4", "soow-4-4", "h07rn-f-3g10", "h07rn-f-3g16", "h07rn-f-3g25", "rov-tether", "wire-rope-13",
    "wire-rope-10", "hmpe-10", "polyester-16", "nylon-16", "hydraulic-twin-hose", "heavy-umbilical");
const ROBOTS: &[(&str, &str)] = embedded!("robots":
    "foldtrack", "brokk-70", "brokk-110", "brokk-170", "brokk-bm150", "dxr-140", "dxr-310");
const MAPS: &[(&str, &str)] = embedded!("maps":
    "flat-75ft", "dished-75ft", "saltcake-75ft", "debris-75ft", "riser-drop-55in", "small-200-series");

/// Reads embedded texts once. Those that do not parse are left out (a test sees to it that none
/// is).
fn parsed<T: for<'de> Deserialize<'de>>(texts: &[(&'static str, &str)], name: fn(&mut T, &'static str)) -> Vec<T> {
    let read = |&(id, text): &(&'static str, &str)| {
        let mut preset: T = toml::from_str(text).ok()?;
        name(&mut preset, id);
        Some(preset)
    };
    texts.iter().filter_map(read).collect()
}

/// Every kind of cable, in the order a picker shows them.
pub fn cable_presets() -> &'static [CablePreset] {
    static PRESETS: OnceLock<Vec<CablePreset>> = OnceLock::new();
    PRESETS.get_or_init(|| parsed(CABLES, |p: &mut CablePreset, id| p.id = id))
}

/// Every kind of robot.
pub fn robot_presets() -> &'static [RobotPreset] {
    static PRESETS: OnceLock<Vec<RobotPreset>> = OnceLock::new();
    PRESETS.get_or_init(|| parsed(ROBOTS, |p: &mut RobotPreset, id| p.id = id))
}

/// Every map.
pub fn map_presets() -> &'static [MapPreset] {
    static PRESETS: OnceLock<Vec<MapPreset>> = OnceLock::new();
    PRESETS.get_or_init(|| parsed(MAPS, |p: &mut MapPreset, id| p.id = id))
}

/// The cable of an id.
#[must_use]
pub fn cable_preset(id: &str) -> Option<&'static CablePreset> {
    cable_presets().iter().find(|p| p.id == id)
}

/// The robot of an id.
#[must_use]
pub fn robot_preset(id: &str) -> Option<&'static RobotPreset> {
    robot_presets().iter().find(|p| p.id == id)
}

/// The map of an id.
#[must_use]
pub fn map_preset(id: &str) -> Option<&'static MapPreset> {
    map_presets().iter().find(|p| p.id == id)
}

/// There is no such preset.
pub(in crate::scene) fn unknown<'a>(what: &'static str, id: &str, known: impl Iterator<Item = &'a str>) -> SceneFault {
    SceneFault::UnknownName { what, name: id.chars().take(60).collect(), nearest: nearest(id, known) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_embedded_preset_is_read_and_sensible() {
        for (id, text) in CABLES {
            let read: CablePreset = toml::from_str(text).unwrap_or_else(|e| panic!("{id}: {e}"));
            assert!(read.service_tension_n.value < read.breaking_tension_n.value, "{id}");
        }
        for (id, text) in ROBOTS {
            let read: RobotPreset = toml::from_str(text).unwrap_or_else(|e| panic!("{id}: {e}"));
            let top = read.outline_m.iter().map(|p| p[1]).fold(0.0, f64::max);
            let (left, right) = read.outline_m.iter().fold((0.0_f64, 0.0_f64), |(l, r), p| (l.min(p[0]), r.max(p[0])));
            assert!(
                (top - read.height_m.value).abs() < 1e-9 && (right - left - read.length_m.value).abs() < 1e-9,
                "{id}"
            );
            assert!(read.outline_m.iter().all(|p| p[1] >= 0.0), "{id}");
        }
        for (id, text) in MAPS {
            let read: MapPreset = toml::from_str(text).unwrap_or_else(|e| panic!("{id}: {e}"));
            assert!(!read.obstacles.is_empty(), "{id}");
        }
        assert_eq!(
            (cable_presets().len(), robot_presets().len(), map_presets().len()),
            (CABLES.len(), ROBOTS.len(), MAPS.len())
        );
    }

    #[test]
    fn every_figure_has_a_source_and_lies_in_its_band() {
        let likely = cable_presets().iter().map(|p| (p.id, "likely", &p.likely_bending_stiffness_n_m2));
        for (id, _, f) in likely.clone() {
            let mean = (f.low.unwrap() * f.high.unwrap()).sqrt();
            assert!((f.value / mean - 1.0).abs() < 0.05, "{id}: {} is no mean of its band, {mean}", f.value);
        }
        let cables = cable_presets().iter().flat_map(|p| p.figures().map(|(key, f)| (p.id, key, f))).chain(likely);
        let robots = robot_presets().iter().flat_map(|p| {
            [
                &p.mass_kg,
                &p.width_m,
                &p.height_m,
                &p.length_m,
                &p.speed_m_per_s,
                &p.drive_pull_n,
                &p.hitch_back_m,
                &p.hitch_up_m,
            ]
            .map(|f| (p.id, "", f))
        });
        for (id, key, figure) in cables.chain(robots) {
            assert!(!figure.source.is_empty(), "{id} {key}");
            assert!(figure.low.is_none_or(|low| low <= figure.value), "{id} {key}");
            assert!(figure.high.is_none_or(|high| high >= figure.value), "{id} {key}");
        }
        let soow = cable_preset("soow-6-4").unwrap();
        assert_eq!(soow.linear_density_kg_per_m.value, 1.246);
        assert_eq!(soow.service_tension_n.value, 800.0);
        assert_eq!(soow.breaking_tension_n.value, 10_000.0);
        assert_eq!(soow.min_bend_radius_m.value, 0.14);
    }
}
