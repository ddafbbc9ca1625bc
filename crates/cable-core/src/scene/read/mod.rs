//! A scene file is read in three steps: parse, deserialize, validate. Every error carries its path
//! and its position in the text.
//!
//! | room | content |
//! |---|---|
//! | `file.rs` | TOML in and out |
//! | `text_position.rs` | line and column of a fault |
//! | `deserialize.rs` | from the parsed tree to a [`Scene`](super::Scene), unknown keys refused with the nearest known one |
//! | `validate.rs`, `support_rules.rs` | every number in range, every name known, every key where it belongs |
//! | `number_and_name_checks.rs` | the checks that those share: ranges, series in time, names used once |
//! | `length_check.rs` | the check that the cable is long enough for its supports |
//! | `self_touch.rs` | does the line of a terrain or beam cross or touch itself? |
//! | `key_path.rs`, `range.rs` | the name of a place in a scene; the allowed range of each number |
//! | `schema.rs` | the JSON Schema of a scene file |

pub mod deserialize;
pub mod file;
pub(crate) mod key_path;
mod length_check;
mod number_and_name_checks;
mod range;
pub mod schema;
mod self_touch;
mod support_rules;
mod text_position;
pub mod validate;
