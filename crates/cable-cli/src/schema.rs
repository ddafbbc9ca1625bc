//! The command `cable schema` prints the JSON Schema of a scene file.

use cable_core::Scene;

use crate::CommandResult;
use crate::output::Printer;

/// Prints the JSON Schema of a scene file.
pub fn schema() -> CommandResult {
    let mut out = Printer::new();
    out.line(&format!("{:#}", Scene::json_schema()))?;
    out.flush()
}
