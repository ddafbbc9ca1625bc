//! These tests draw and drop cables against closed forms.
//!
//! | room | content |
//! |---|---|
//! | `breaks.rs` | cables that break in their mesh |
//! | `contact.rs` | friction on a floor, landing, corners, thrown ends; nothing is crossed |
//! | `sliding.rs` | cable drawn over corners, posts and pulleys: capstan law, ripple |

mod breaks;
pub(in crate::model::fem) mod contact;
pub(in crate::model::fem) mod sliding;
