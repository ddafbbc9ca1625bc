//! These sentences say what an import changed, and why a text is not imported.

use super::{Sentence, display_in_si};
use crate::scene::import::{ImportChange, ImportFault};
use crate::units::UnitSystem;

display_in_si!(ImportChange, ImportFault);

impl std::error::Error for ImportFault {}

impl Sentence for ImportChange {
    fn sentence(&self, _: UnitSystem) -> String {
        match self {
            Self::HeadingsLeftOut { count } => format!("{count} heading line(s) left out"),
            Self::PointsMerged { count } => format!("{count} point(s) merged with the one before"),
            Self::GroundTurned => "ground that ran to the left turned: it is solid below".to_owned(),
            Self::TransformsLeftOut => "transforms are not applied: flatten them first if lines lie wrong".to_owned(),
            Self::AxisTurned => "y turned upwards (SVG has it downwards)".to_owned(),
        }
    }
}

impl Sentence for ImportFault {
    fn sentence(&self, _: UnitSystem) -> String {
        match self {
            Self::Unit => "a unit is longer than 0 m".to_owned(),
            Self::NoLine => {
                "there is no line in it: a table needs two numbers a line, an SVG a path, polyline or polygon"
                    .to_owned()
            }
            Self::TooManyPoints { most } => format!("more than {most} points"),
            Self::Row { line, text } => format!("line {line}: `{text}` is not two finite numbers"),
            Self::TooFewPoints { count, least } => format!("a line of {count} point(s): it needs {least}"),
            Self::Number { text } => format!("`{text}` is not a finite number"),
            Self::List { text } => format!("`{text}` is not a list of numbers"),
            Self::PathCommand { command } => {
                format!("path command `{command}` is not read: turn arcs and smooth curves into lines first")
            }
        }
    }
}
