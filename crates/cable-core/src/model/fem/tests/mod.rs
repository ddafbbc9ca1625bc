//! These tests draw and drop cables against closed forms.
//!
//! | room | content |
//! |---|---|
//! | `contact.rs` | friction on a floor, landing, corners, thrown ends; nothing is crossed |
//! | `sliding.rs` | cable drawn over corners, posts and pulleys: capstan law, ripple |

pub(in crate::model::fem) mod contact;
pub(in crate::model::fem) mod sliding;
