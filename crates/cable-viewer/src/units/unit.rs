//! A [`Unit`] says how a quantity is shown and what may be typed for it; values are SI inside.

/// Digits of a figure on screen. Fewer hide differences an engineer decides on, more are noise.
pub const DIGITS: usize = 4;

/// A unit a quantity is shown in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The symbol behind the number; empty for plain numbers.
    pub symbol: &'static str,
    /// SI units in one of it.
    pub si: f64,
    /// Units of the same quantity that may be typed instead, with their SI size.
    pub others: &'static [(&'static str, f64)],
    /// Decimals shown; None = so many that [`DIGITS`] digits are.
    pub decimals: Option<usize>,
}

/// Every unit of length that may be typed.
pub const LENGTHS: &[(&str, f64)] =
    &[("km", 1e3), ("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("ft", 0.3048), ("in", 0.0254)];
const FORCES: &[(&str, f64)] = &[("MN", 1e6), ("kN", 1e3), ("N", 1.0)];
/// Every unit of time that may be typed.
pub const TIMES: &[(&str, f64)] = &[("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)];
const MASSES: &[(&str, f64)] = &[("t", 1e3), ("kg", 1.0), ("g", 1e-3)];
const DENSITIES: &[(&str, f64)] = &[("kg/m", 1.0), ("g/m", 1e-3)];
const RATIOS: &[(&str, f64)] = &[("%", 1e-2)];

impl Unit {
    /// A unit that holds so many SI units, and what may be typed instead.
    #[must_use]
    pub const fn of(symbol: &'static str, si: f64, others: &'static [(&'static str, f64)]) -> Self {
        Self { symbol, si, others, decimals: None }
    }

    /// Metres of a coordinate, to the millimetre.
    pub const COORDINATE: Self = Self { decimals: Some(3), ..Self::M };
    /// Whole numbers.
    pub const COUNT: Self = Self { decimals: Some(0), ..Self::PLAIN_NUMBER };

    /// Metres.
    pub const M: Self = Self::of("m", 1.0, LENGTHS);
    /// Millimetres.
    pub const MM: Self = Self::of("mm", 1e-3, LENGTHS);
    /// Newtons.
    pub const N: Self = Self::of("N", 1.0, FORCES);
    /// Kilonewtons.
    pub const KN: Self = Self::of("kN", 1e3, FORCES);
    /// Newton square metres.
    pub const N_M2: Self = Self::of("N·m²", 1.0, &[("Nm2", 1.0)]);
    /// Newtons per metre.
    pub const N_PER_M: Self = Self::of("N/m", 1.0, &[]);
    /// Kilograms per metre.
    pub const KG_PER_M: Self = Self::of("kg/m", 1.0, DENSITIES);
    /// Kilograms.
    pub const KG: Self = Self::of("kg", 1.0, MASSES);
    /// Parts per million per kelvin.
    pub const PPM_PER_K: Self = Self::of("ppm/K", 1e-6, &[("1/K", 1.0)]);
    /// Kelvins (a difference).
    pub const K: Self = Self::of("K", 1.0, &[("°C", 1.0)]);
    /// Metres per second.
    pub const M_PER_S: Self = Self::of("m/s", 1.0, &[("km/h", 1.0 / 3.6)]);
    /// Metres per second squared.
    pub const M_PER_S2: Self = Self::of("m/s²", 1.0, &[("m/s2", 1.0), ("g", 9.80665)]);
    /// Hundredths.
    pub const PERCENT: Self = Self::of("%", 1e-2, RATIOS);
    /// Plain numbers.
    pub const PLAIN_NUMBER: Self = Self::of("", 1.0, &[]);
    /// Degrees.
    pub const DEGREE: Self = Self::of("°", 1.0, &[]);
    /// Seconds.
    pub const S: Self = Self::of("s", 1.0, TIMES);
    /// Milliseconds.
    pub const MS: Self = Self::of("ms", 1e-3, TIMES);
    /// Times real time.
    pub const TIMES: Self = Self::of("×", 1.0, &[("x", 1.0)]);
}
