//! These sentences say why a scene is refused: the place in its file, the fault, and what mends it.

use super::figures::{Figures, six_digits};
use super::{Sentence, display_in_si};
use crate::error::{DocumentFault, SceneError, SceneFault};
use crate::units::{Quantity, UnitSystem};

display_in_si!(SceneError, SceneFault);

impl std::error::Error for SceneError {}
impl std::error::Error for SceneFault {}

impl Sentence for SceneError {
    fn sentence(&self, units: UnitSystem) -> String {
        let at = self.at.map(|a| format!("line {}, column {}: ", a.line, a.column)).unwrap_or_default();
        let path = if self.path.is_empty() { String::new() } else { format!("{}: ", self.path) };
        format!("{at}{path}{}", self.fault.sentence(units))
    }
}

impl Sentence for SceneFault {
    fn sentence(&self, units: UnitSystem) -> String {
        let f = Figures(units);
        let length = |length_m: f64| f.given(Quantity::Length, length_m);
        match self {
            Self::Syntax { message } => message.clone(),
            Self::Range { value, allowed: [low, high], quantity } => format!(
                "{} is outside the allowed range {} to {}",
                f.bound(*quantity, *value),
                f.bound(*quantity, *low),
                f.with_unit(*quantity, f.bound(*quantity, *high))
            ),
            Self::Version { value } => {
                format!("{value} is outside the allowed range 1, the only version this program reads")
            }
            Self::UnknownKey { nearest } => format!("unknown key{}", hint(nearest.as_deref())),
            Self::NotUtf8 { encoding } => {
                let hint = encoding.map(|name| format!(", it looks like {name}: save it as UTF-8"));
                format!("this is not UTF-8 text{}", hint.unwrap_or_default())
            }
            Self::Type { found, needed } => format!("{found} where {needed} is needed"),
            Self::Elements { count, needed } => format!("{count} elements where {needed} is needed"),
            Self::Document(fault) => fault.sentence(units),
            Self::TooMany { count, most } => format!("{count} are more than the {most} allowed"),
            Self::TooFewPoints { count, least } => {
                format!("{count} points where at least {least} are needed")
            }
            Self::UnequalCounts { values, times } => format!("{values} values for {times} times"),
            Self::TimesNotIncreasing { time_s, before_s } => {
                format!("times must increase: {} s after {} s", six_digits(*time_s), six_digits(*before_s))
            }
            Self::ThermalFactor { factor, allowed: [low, high] } => {
                let factor = six_digits(*factor);
                format!("with temperature_change_k the length changes by a factor {factor}, beyond {low} to {high}")
            }
            Self::ServiceAboveBreaking { service_n, breaking_n } => format!(
                "{} must not be above the breaking tension ({})",
                f.given(Quantity::Force, *service_n),
                f.given(Quantity::Force, *breaking_n)
            ),
            Self::BeyondEnd { arc_length_m, length_m } => {
                format!("{} is beyond the cable's end at {}", length(*arc_length_m), length(*length_m))
            }
            Self::OutOfOrder { arc_length_m, between_m: [before, after] } => format!(
                "{} is out of order: it must lie between {} and {}",
                length(*arc_length_m),
                length(*before),
                length(*after)
            ),
            Self::MotionStartsElsewhere { motion_m, support_m } => format!(
                "at 0 s the schedule is at {}, but its support is placed at {}: make them agree",
                f.given_point(*motion_m),
                f.given_point(*support_m)
            ),
            Self::EdgesCross { other, edges_m } => {
                let [edge, others] = edges_m.map(|ends| ends.map(|at| f.given_point(at)).join(" to "));
                format!(
                    "the edge that starts here, {edge}, crosses or touches the edge from point {other}, {others}: move or remove one of their points"
                )
            }
            Self::UnknownName { what, name, nearest } => {
                format!("there is no {what} named `{name}`{}", hint(nearest.as_deref()))
            }
            Self::RouteInside { obstacle, depth_m, x_m, y_m } => format!(
                "from here the route leads {} deep through `{obstacle}` at {}: lead it past, on the side where the cable is to lie",
                f.length(*depth_m, 3),
                f.point([*x_m, *y_m], 3)
            ),
            Self::SupportInside { name, obstacle, depth_m, clear_m } => {
                let clear =
                    clear_m.map(|at| format!(": the nearest place clear of it is {}", f.point([at[0], at[1]], 4)));
                let depth = f.length(*depth_m, 4);
                format!("support `{name}` is {depth} inside `{obstacle}`{}", clear.unwrap_or_default())
            }
            Self::NoRoom { support } => {
                format!("support `{support}` sits where obstacles leave no room for the cable's diameter")
            }
            Self::NoWay { from, to, apart_m, inside } => {
                let reason = inside.as_ref().map(|inner| {
                    let outer = if inner == from { to } else { from };
                    format!("`{inner}` lies inside the wheel of `{outer}`")
                });
                format!(
                    "`{from}` and `{to}` are {} apart, and no cable leads from one to the other: {}. Move one, make the wheel smaller, or leave one out",
                    f.length(*apart_m, 4),
                    reason.unwrap_or_else(|| "they are in the same place".to_owned())
                )
            }
            Self::TooShort { length_m, way_m, needed_n, breaking_n } => format!(
                "the route between the supports is {way} but the cable is only {} long; stretching it that far takes {}, and it breaks at {}: make length_m at least {way}",
                f.length(*length_m, 4),
                f.significant(Quantity::Force, *needed_n, 4),
                f.given(Quantity::Force, *breaking_n),
                way = f.length(*way_m, 4)
            ),
        }
    }
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map(|n| format!(", did you mean `{n}`?")).unwrap_or_default()
}

impl Sentence for DocumentFault {
    fn sentence(&self, _: UnitSystem) -> String {
        let text = match self {
            Self::Refused { message } => return message.clone(),
            Self::Missing => "is missing",
            Self::MissingForKind { kind } => return format!("is missing: a {kind} support needs it"),
            Self::NotForKind { kind } => return format!("does not belong to a {kind} support"),
            Self::UnknownWord { word, known, nearest } => {
                return format!("`{word}` is not one of {}{}", alternatives(known), hint(nearest.as_deref()));
            }
            Self::LongText { bytes, most } => {
                return format!("the text has {bytes} bytes, more than the {most} a scene may have");
            }
            Self::EmptyText => "the text is empty: a scene begins with `version = 1`",
            Self::EmptyName => "a name must not be empty",
            Self::LongName { most } => return format!("a name has at most {most} bytes"),
            Self::TakenName { name } => return format!("`{name}` is already taken: names are unique"),
            Self::NoCable => "a scene needs at least one cable",
            Self::TooFewSupports => {
                "a cable needs two supports, its start and its end (kind = \"free\" for a loose end)"
            }
            Self::HitchWithoutRobot => "hangs on the robot, but the scene has no [robot]",
            Self::PulleyAtEnd => "a pulley cannot hold an end of the cable: it slides through",
            Self::FreeWithin => "only an end of the cable can be free",
            Self::ArcLengthAtEnd => "leave it out: the first and last support sit at the ends",
            Self::MissingArcLength => "is missing: where on the cable does it sit?",
            Self::ShortRoute => "a route needs two points or more",
            Self::TwoForces => "give either force_n, or times_s and forces_n",
            Self::NoForce => "is missing: give force_n, or times_s and forces_n",
            Self::NoTime => "needs at least one time",
            Self::TerrainLeftwards => {
                "terrain goes from left to right, solid below: its last point must lie right of its first"
            }
            Self::PolygonClosedTwice => "repeats the first point: a polygon closes by itself",
            Self::PolygonWithoutArea => "a polygon needs an area: these points lie on a line or cross it back",
            Self::RepeatedPoint => "is the same point as the one before it: leave one out",
            Self::Tangled => {
                "so many edges lie side by side that crossings cannot be ruled out in a second: give it fewer or shorter ones"
            }
        };
        text.to_owned()
    }
}

/// The words of a list, the last after an "or".
fn alternatives(words: &[&str]) -> String {
    let mut text = String::new();
    for (i, word) in words.iter().enumerate() {
        text.push_str(match i {
            0 => "",
            _ if i + 1 == words.len() => " or ",
            _ => ", ",
        });
        text += &format!("`{word}`");
    }
    text
}
