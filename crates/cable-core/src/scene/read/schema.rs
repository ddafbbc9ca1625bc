//! The JSON Schema describes a scene file.

use serde_json::{Value, json};

use crate::scene::{Scene, preset};

/// Keys that a cable's file must give even with a preset.
const REQUIRED_KEYS: [&str; 3] = ["name", "length_m", "supports"];

impl Scene {
    /// The JSON Schema of a scene file, derived from the types that hold it: unknown keys are
    /// refused, and what a preset gives may be left out where there is one.
    #[must_use]
    pub fn json_schema() -> Value {
        let mut schema = schemars::schema_for!(Self).to_value();
        if let Some(cable) = schema.pointer_mut("/$defs/Cable").and_then(Value::as_object_mut) {
            let needed = cable.get("required").cloned().unwrap_or_default();
            cable.insert("required".to_owned(), json!(REQUIRED_KEYS));
            cable.insert("anyOf".to_owned(), json!([{ "required": ["preset"] }, { "required": needed }]));
        }
        let ids: [(&str, Vec<&str>); 2] = [
            ("Cable", preset::cable_presets().iter().map(|p| p.id).collect()),
            ("Robot", preset::robot_presets().iter().map(|p| p.id).collect()),
        ];
        for (name, ids) in ids {
            if let Some(Value::Object(at)) = schema.pointer_mut(&format!("/$defs/{name}/properties/preset")) {
                at.insert("enum".to_owned(), json!(ids));
                at.insert("type".to_owned(), json!("string"));
            }
        }
        if let Some(Value::Object(version)) = schema.pointer_mut("/properties/version") {
            version.insert("const".to_owned(), json!(crate::scene::VERSION));
        }
        schema
    }
}
