//! The window driven as a user would, without a display.
#[test]
fn nothing() {}
