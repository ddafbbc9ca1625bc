//! SI or US units on screen. Files, commands and the clipboard are SI whatever is shown.

use std::cell::Cell;

pub use cable_core::UnitSystem as System;
use cable_core::units::{FOOT_M as FOOT, POUND_FORCE_N as POUND_FORCE, POUND_KG as POUND};

use crate::units::unit::{LENGTHS, Unit};

thread_local! {
    /// The window is drawn by one thread, which says at the start of each frame what the whole
    /// frame is shown in: handing it to every figure would put it into every function that writes
    /// one.
    static CURRENT: Cell<System> = const { Cell::new(System::Si) };
}

/// From now on figures written by this thread are in these units.
pub fn set_current(system: System) {
    CURRENT.with(|s| s.set(system));
}

/// The units figures are written in.
#[must_use]
pub fn current() -> System {
    CURRENT.with(Cell::get)
}

/// A pound-force per square inch, Pa.
const PSI: f64 = POUND_FORCE / (0.0254 * 0.0254);

const FORCES: &[(&str, f64)] = &[("kip", 1e3 * POUND_FORCE), ("lbf", POUND_FORCE), ("kN", 1e3), ("N", 1.0)];
const MASSES: &[(&str, f64)] = &[("lb", POUND), ("kg", 1.0)];

/// Each unit and what stands in its place.
const US: [(&str, Unit); 13] = [
    ("m", Unit::of("ft", FOOT, LENGTHS)),
    ("mm", Unit::of("in", 0.0254, LENGTHS)),
    ("N", Unit::of("lbf", POUND_FORCE, FORCES)),
    ("kN", Unit::of("kip", 1e3 * POUND_FORCE, FORCES)),
    ("N·m²", Unit::of("lbf·ft²", POUND_FORCE * FOOT * FOOT, &[("N·m²", 1.0), ("lbfft2", POUND_FORCE * FOOT * FOOT)])),
    ("N/m", Unit::of("lbf/ft", POUND_FORCE / FOOT, &[("N/m", 1.0)])),
    ("kg/m", Unit::of("lb/ft", POUND / FOOT, &[("kg/m", 1.0)])),
    ("kg", Unit::of("lb", POUND, MASSES)),
    ("ppm/K", Unit::of("ppm/°F", 1.8e-6, &[("ppm/K", 1e-6)])),
    ("K", Unit::of("°F", 1.0 / 1.8, &[("K", 1.0), ("°C", 1.0)])),
    ("m/s", Unit::of("ft/s", FOOT, &[("m/s", 1.0), ("mph", 0.447_04)])),
    ("m/s²", Unit::of("ft/s²", FOOT, &[("ft/s2", FOOT), ("m/s²", 1.0), ("g", 9.80665)])),
    ("J", Unit::of("ft·lbf", FOOT * POUND_FORCE, &[("J", 1.0)])),
];

/// The unit shown in the place of an SI one.
#[must_use]
pub fn unit(of: Unit) -> Unit {
    if current() == System::Si {
        return of;
    }
    us(of).map_or(of, |us| Unit { decimals: of.decimals, ..us })
}

/// The US unit in the place of an SI one.
#[must_use]
pub fn us(of: Unit) -> Option<Unit> {
    US.iter().find(|(symbol, _)| *symbol == of.symbol).map(|(_, us)| *us)
}

/// Units of a quantity from large to small with the value (SI) each is used from on, and the one of
/// zero.
pub type Scale = (&'static [(&'static str, f64, f64)], usize);

const FORCE: [Scale; 2] = [
    (&[("MN", 1e6, 1e6), ("kN", 1e3, 1e4), ("N", 1.0, 0.0)], 2),
    (&[("kip", 1e3 * POUND_FORCE, 1e4 * POUND_FORCE), ("lbf", POUND_FORCE, 0.0)], 1),
];
const STRESS: [Scale; 2] = [
    (&[("GPa", 1e9, 1e9), ("MPa", 1e6, 1e6), ("kPa", 1e3, 1e3), ("Pa", 1.0, 0.0)], 3),
    (&[("ksi", 1e3 * PSI, 1e3 * PSI), ("psi", PSI, 0.0)], 1),
];
const LENGTH: [Scale; 2] =
    [(&[("m", 1.0, 1.0), ("mm", 1e-3, 1e-3), ("µm", 1e-6, 0.0)], 0), (&[("ft", FOOT, FOOT), ("in", 0.0254, 0.0)], 0)];
const ENERGY: [Scale; 2] = [(&[("kJ", 1e3, 1e4), ("J", 1.0, 0.0)], 1), (&[("ft·lbf", FOOT * POUND_FORCE, 0.0)], 0)];

/// The quantity of a figure on screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// N.
    Force,
    /// Pa.
    Stress,
    /// m.
    Length,
    /// J.
    Energy,
}

/// The unit for values of a size (SI), and how many SI units it holds.
#[must_use]
pub fn for_size(kind: Kind, size: f64) -> (&'static str, f64) {
    let scales = match kind {
        Kind::Force => &FORCE,
        Kind::Stress => &STRESS,
        Kind::Length => &LENGTH,
        Kind::Energy => &ENERGY,
    };
    let (units, zero) = scales[usize::from(current() == System::Us)];
    let size = size.abs();
    let found = if size > 0.0 && size.is_finite() { units.iter().find(|(.., from)| size >= *from) } else { None };
    found.or(units.get(zero)).map_or(("", 1.0), |(symbol, si, _)| (symbol, *si))
}

impl Unit {
    /// The unit it is shown in: itself, or that of the other system.
    #[must_use]
    pub fn display(self) -> Self {
        unit(self)
    }

    /// Without its symbol, for a column that has it in its heading; units may still be typed.
    #[must_use]
    pub fn bare(self) -> Self {
        Self { symbol: "", ..self.display() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::format;
    use super::*;

    /// By the definitions of the units, to the digits shown.
    #[test]
    fn figures_and_typed_text_follow_the_switch_and_values_do_not() {
        set_current(System::Us);
        assert_eq!(format::force(1000.0), "224.8 lbf");
        assert_eq!(format::force(1e6), "224.8 kip");
        assert_eq!(format::stress(1e6), "145.0 psi");
        assert_eq!(format::length(3.048), "10.00 ft");
        assert_eq!(Unit::KG_PER_M.text(1.0), "0.672 lb/ft");
        assert_eq!(Unit::K.text(10.0), "18.00 °F");
        assert_eq!(Unit::M_PER_S2.text(9.80665), "32.17 ft/s²");
        for (unit, text, si) in [
            (Unit::M, "10", 3.048),
            (Unit::M, "10 m", 10.0),
            (Unit::MM, "2", 0.0508),
            (Unit::N, "1 kN", 1000.0),
            (Unit::N, "100", 100.0 * POUND_FORCE),
        ] {
            assert!((unit.parse(text).unwrap() - si).abs() < 1e-12 * si, "{text}");
        }
        let exact = Unit::KN.exact(12_345.678);
        assert!((Unit::KN.parse(&exact).unwrap() / 12_345.678 - 1.0).abs() < 1e-13, "{exact}");
        set_current(System::Si);
        assert_eq!(format::force(1000.0), "1000 N");
        // Units of both systems may be typed in either.
        assert!((Unit::M.parse("10 ft").unwrap() - 3.048).abs() < 1e-15);
        assert!((Unit::KN.parse("20 lbf").unwrap() - 20.0 * POUND_FORCE).abs() < 1e-12);
        assert!((Unit::KG_PER_M.parse("2 lb/ft").unwrap() - 2.0 * POUND / FOOT).abs() < 1e-12);
        assert!((Unit::M_PER_S.parse("10 mph").unwrap() - 4.4704).abs() < 1e-12);
    }
}
