//! A property of a cable has a name, a unit, a usual range and a place in the cable.

use cable_core::Cable;

use crate::units::unit::Unit;
use crate::widgets::property::PropertyQuantity;

/// A property of a cable.
pub struct Property {
    /// Its key in a scene file.
    pub key: &'static str,
    /// Its form on screen.
    pub quantity: PropertyQuantity,
    /// Reads it, SI.
    pub get: fn(&Cable) -> f64,
    /// Writes it, SI.
    pub set: fn(&mut Cable, f64),
}

macro_rules! property {
    ($key:ident, $name:literal, $unit:expr, $usual:expr, $log:literal, $help:literal) => {
        Property {
            key: stringify!($key),
            quantity: PropertyQuantity { name: $name, unit: $unit, usual: $usual, logarithmic: $log, help: $help },
            get: |cable| cable.$key,
            set: |cable, value| cable.$key = value,
        }
    };
}

/// All of them but the segments, in the order shown.
pub const PROPERTIES: [Property; 13] = [
    property!(
        length_m,
        "Length",
        Unit::M,
        [0.5, 200.0],
        true,
        "Unstretched length at rest temperature. Shorter than the way between its supports, a cable has to stretch or break."
    ),
    property!(
        linear_density_kg_per_m,
        "Linear density",
        Unit::KG_PER_M,
        [0.01, 20.0],
        true,
        "Mass per metre of unstretched length. Tension at rest grows in proportion to it."
    ),
    property!(
        axial_stiffness_n,
        "Axial stiffness",
        Unit::KN,
        [1e4, 1e8],
        true,
        "EA, tension divided by strain. Low: stretches visibly. High: every change of length becomes tension."
    ),
    property!(
        bending_stiffness_n_m2,
        "Bending stiffness",
        Unit::N_M2,
        [0.0, 100.0],
        true,
        "EI, bending moment divided by curvature; 0 = perfectly flexible. A real cable lies anywhere between strands that slip and strands that stick, about 1 to 10 apart: a single value is an assumption."
    ),
    Property {
        key: "bending_damping_ratio",
        quantity: PropertyQuantity {
            name: "Bending damping",
            unit: Unit::PERCENT,
            usual: [0.0, 1.0],
            logarithmic: true,
            help: "Half the loss factor of the material in bending; that of stretching until it is set to another. It calms vibration and does not change where the cable rests.",
        },
        get: Cable::bending_damping,
        set: |cable, value| cable.bending_damping_ratio = (value != cable.damping_ratio).then_some(value),
    },
    property!(
        diameter_m,
        "Diameter",
        Unit::MM,
        [0.002, 0.2],
        true,
        "Outside diameter. The centre line keeps half of it off every obstacle, and stress is tension over the full round section."
    ),
    property!(
        damping_ratio,
        "Damping",
        Unit::PERCENT,
        [0.0, 1.0],
        true,
        "Half the loss factor of the material in stretching, at every frequency; with FEM a cable that can touch something has more in fast motion. It calms vibration and does not change where the cable rests."
    ),
    property!(
        thermal_expansion_per_k,
        "Thermal expansion",
        Unit::PPM_PER_K,
        [0.0, 2e-4],
        false,
        "Change of unstretched length per kelvin, in millionths. Acts with the temperature change of the environment."
    ),
    property!(
        service_tension_n,
        "Service tension",
        Unit::N,
        [10.0, 1e5],
        true,
        "Tension of the first warning: what the cable may carry every day."
    ),
    property!(
        breaking_tension_n,
        "Breaking tension",
        Unit::KN,
        [100.0, 1e6],
        true,
        "Tension at which the cable breaks. Not below the service tension."
    ),
    property!(
        breaking_time_s,
        "Breaking time",
        Unit::MS,
        [0.0, 5e-3],
        false,
        "In motion the cable breaks where the mean of its tension over this time reaches the breaking tension; at 0 each instant counts. No measurement of cables stands behind its value: it is the time over which means of tension agree between meshes in a drop on rubble."
    ),
    property!(
        min_bend_radius_m,
        "Min bend radius",
        Unit::MM,
        [0.0, 2.0],
        true,
        "Bent tighter than this, the cable is damaged; 0 = no limit stated."
    ),
    property!(
        friction,
        "Friction",
        Unit::PLAIN_NUMBER,
        [0.0, 1.5],
        false,
        "Coulomb coefficient with every obstacle that does not say otherwise. It is poorly known: half a turn round a post multiplies tension by 4.8 at 0.5 and by 12 at 0.8, so try low and high."
    ),
];

/// The field of segments when the cable sets their number.
pub const SEGMENTS: PropertyQuantity = PropertyQuantity {
    name: "Segments",
    unit: Unit::COUNT,
    usual: [4.0, 1000.0],
    logarithmic: true,
    help: "Elements this cable is cut into by models that cut it. More: finer and slower.",
};
