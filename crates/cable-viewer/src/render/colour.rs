//! A colour scale shows a quantity along the cable by a map, a range and a unit.

use cable_core::solution::Node;
use cable_core::{Model, Solution};
use egui::Color32;

use crate::units::system;

/// The colouring of the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourScale {
    /// The quantity that is coloured.
    pub quantity: CableQuantity,
    /// The map from values to colours.
    pub map: ColourMap,
    /// Least and greatest value in SI units (N, Pa, 1); None = those of the present answer.
    pub fixed: Option<[f64; 2]>,
}

impl Default for ColourScale {
    fn default() -> Self {
        Self { quantity: CableQuantity::Tension, map: ColourMap::Viridis, fixed: None }
    }
}

/// The quantity that the colour shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CableQuantity {
    /// Tension, N.
    Tension,
    /// Stress over the full round section, Pa.
    Stress,
    /// Engineering strain.
    Strain,
}

impl CableQuantity {
    /// All of them, in the order a picker shows.
    pub const ALL: [Self; 3] = [Self::Tension, Self::Stress, Self::Strain];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tension => "Tension",
            Self::Stress => "Stress",
            Self::Strain => "Strain",
        }
    }

    /// Its value at a node, SI.
    #[must_use]
    pub fn of(self, node: &Node) -> f64 {
        match self {
            Self::Tension => node.tension_n,
            Self::Stress => node.stress_pa,
            Self::Strain => node.strain,
        }
    }

    /// Unit shown and how many SI units it holds, for values up to `greatest` (SI).
    #[must_use]
    pub fn unit(self, greatest: f64) -> (&'static str, f64) {
        match self {
            Self::Tension => system::for_size(system::Kind::Force, greatest),
            Self::Stress if system::current() == system::System::Us => system::for_size(system::Kind::Stress, greatest),
            Self::Stress if greatest >= 1e5 => ("MPa", 1e6),
            Self::Stress => ("kPa", 1e3),
            Self::Strain if greatest >= 1e-3 => ("%", 1e-2),
            Self::Strain => ("µm/m", 1e-6),
        }
    }
}

/// The colours of [`Model::SOLVERS`], in their order.
const OF_SOLVERS: [Color32; 4] = [LINES[1], LINES[0], LINES[2], LINES[3]];

/// The colour of a model in every chart.
#[must_use]
pub fn of_model(model: Model) -> Color32 {
    let place = Model::SOLVERS.iter().position(|m| *m == model);
    place.and_then(|place| OF_SOLVERS.get(place)).copied().unwrap_or(Color32::GRAY)
}

/// A perceptually even, colour-blind-safe sequence of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourMap {
    /// Purple, green, yellow.
    Viridis,
    /// Blue, grey, yellow.
    Cividis,
}

/// Equally spaced stops of each map (after S. van der Walt and N. Smith, "A better default colormap
/// for Matplotlib", SciPy 2015; J. Nuñez, C. Anderton and R. Renslow, "Optimizing colormaps with
/// consideration for color vision deficiency", PLoS ONE 2018).
const VIRIDIS: [[u8; 3]; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];
const CIVIDIS: [[u8; 3]; 10] = [
    [0, 34, 78],
    [18, 53, 112],
    [59, 73, 108],
    [87, 93, 109],
    [112, 113, 115],
    [138, 134, 120],
    [165, 156, 116],
    [195, 179, 105],
    [225, 204, 85],
    [254, 232, 56],
];

impl ColourMap {
    /// Both, in the order a picker shows.
    pub const ALL: [Self; 2] = [Self::Viridis, Self::Cividis];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Viridis => "Viridis",
            Self::Cividis => "Cividis",
        }
    }

    /// The colour at a fraction 0 to 1; not finite = grey.
    #[must_use]
    pub fn at(self, fraction: f64) -> Color32 {
        if !fraction.is_finite() {
            return Color32::GRAY;
        }
        let stops: &[[u8; 3]] = match self {
            Self::Viridis => &VIRIDIS,
            Self::Cividis => &CIVIDIS,
        };
        let x = fraction.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        let k = (x as usize).min(stops.len() - 2);
        let f = x - k as f64;
        let mix = |i: usize| (f64::from(stops[k][i]) * (1.0 - f) + f64::from(stops[k + 1][i]) * f).round() as u8;
        Color32::from_rgb(mix(0), mix(1), mix(2))
    }
}

/// Least width of the range of colours, as a part of the greatest size in it. Smaller: noise is
/// drawn in all colours, as if much went on; larger: the tension of a span, which differs by what
/// the cable weighs, is hard to see.
const LEAST_RANGE: f64 = 0.1;

impl ColourScale {
    /// Least and greatest value shown, SI; never empty.
    #[must_use]
    pub fn range(&self, solution: &Solution) -> [f64; 2] {
        if let Some([low, high]) = self.fixed
            && high > low
        {
            return [low, high];
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in solution.cables.iter().flat_map(|c| &c.nodes).map(|n| self.quantity.of(n)).filter(|v| v.is_finite()) {
            low = low.min(v);
            high = high.max(v);
        }
        if !(low <= high) {
            return [0.0, 1.0];
        }
        let least = LEAST_RANGE * low.abs().max(high.abs());
        // A field of zeros would divide by zero.
        [low.min(high - least), high.max(low + 1e-18)]
    }

    /// Returns where a value lies in a range, 0 to 1 inside.
    #[must_use]
    pub fn fraction(value: f64, [low, high]: [f64; 2]) -> f64 {
        (value - low) / (high - low)
    }
}

/// Colours of the lines: apart in hue and in turn darker and lighter, for colour-blind eyes. None
/// is near the colour of what is selected or of what warns.
pub const LINES: [Color32; 4] = [
    Color32::from_rgb(0, 124, 118),
    Color32::from_rgb(214, 100, 170),
    Color32::from_rgb(125, 95, 190),
    Color32::from_rgb(132, 142, 40),
];
