//! These sentences say why a scene is refused: the place in its file, the fault, and what mends it.

use super::{Figures, Sentence, display_in_si};
use crate::error::{SceneError, SceneFault};
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
                f.bare(*quantity, *value),
                limit(f, *quantity, *low),
                f.with_unit(*quantity, limit(f, *quantity, *high))
            ),
            Self::Version { value } => {
                format!("{value} is outside the allowed range 1, the only version this program reads")
            }
            Self::UnknownKey { nearest } => format!("unknown key{}", hint(nearest.as_deref())),
            Self::Shape { what } => what.clone(),
            Self::TooMany { count, most } => format!("{count} are more than the {most} allowed"),
            Self::TooFewPoints { count, least } => {
                format!("{count} points where at least {least} are needed")
            }
            Self::UnequalCounts { values, times } => format!("{values} values for {times} times"),
            Self::TimesNotIncreasing { time_s, before_s } => {
                format!("times must increase: {time_s} s after {before_s} s")
            }
            Self::ThermalFactor { factor, allowed: [low, high] } => {
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
                "{} must lie between {} and {}, in order",
                length(*arc_length_m),
                length(*before),
                length(*after)
            ),
            Self::MotionStartsElsewhere { motion_m, support_m } => format!(
                "at 0 s it is at {}, its support's at_m is {}: they must agree",
                f.bare_point(*motion_m),
                f.bare_point(*support_m)
            ),
            Self::EdgesCross { other, edges_m } => {
                let [edge, others] = edges_m.map(|ends| ends.map(|at| f.bare_point(at)).join(" to "));
                format!(
                    "the edge from here, {edge}, crosses or touches the edge from point {other}, {others}: move a point of one, or leave it out"
                )
            }
            Self::UnknownName { what, name, nearest } => {
                format!("there is no {what} named `{name}`{}", hint(nearest.as_deref()))
            }
            Self::RouteInside { obstacle, depth_m, x_m, y_m } => format!(
                "from here the route leads {} deep through `{obstacle}` at {}: lead it past, on the side where the cable shall lie",
                f.length(*depth_m, 3),
                f.point([*x_m, *y_m], 3)
            ),
            Self::SupportInside { name, obstacle, depth_m, clear_m } => {
                let clear = clear_m.map(|at| {
                    let [x, y] = at.map(|c| Quantity::Length.convert(c, units));
                    format!(": the nearest place clear of it is [{x:.4}, {y:.4}]")
                });
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
                "the way between the supports is {way}, the cable is {} long, and stretching to it takes {} where it breaks at {}: make length_m at least {way}",
                f.length(*length_m, 4),
                f.power(Quantity::Force, *needed_n, 4),
                f.power(Quantity::Force, *breaking_n, 4),
                way = f.length(*way_m, 4)
            ),
        }
    }
}

/// The end of a range; a power of ten where it is small or large.
fn limit(f: Figures, quantity: Quantity, value: f64) -> String {
    let text = f.bare(quantity, value);
    match text.parse::<f64>() {
        Ok(shown) if shown != 0.0 && !(1e-3..1e6).contains(&shown.abs()) => format!("{shown:e}"),
        _ => text,
    }
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map(|n| format!(", did you mean `{n}`?")).unwrap_or_default()
}
