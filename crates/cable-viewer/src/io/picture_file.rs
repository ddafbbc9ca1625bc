//! A picture is written as a PNG file.

use std::io::Cursor;
use std::path::Path;

use cable_core::files;
use image::{ImageFormat, RgbaImage};

/// Writes a picture to a file whose name ends in `.png`.
///
/// # Errors
/// In words: another ending, or the path refuses.
pub fn save(path: &Path, picture: &RgbaImage) -> Result<(), String> {
    if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        return Err("its name must end in .png".to_owned());
    }
    files::write_atomic(path, &png(picture)?).map_err(|e| e.to_string())
}

/// The bytes of a picture as PNG.
///
/// # Errors
/// In words: the picture cannot be encoded.
pub fn png(picture: &RgbaImage) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|e| e.to_string())?;
    Ok(bytes.into_inner())
}
