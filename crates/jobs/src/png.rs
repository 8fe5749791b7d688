//! Pictures as PNG.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes sRGB colour and opacity, row 0 on top.
///
/// # Errors
/// Those of `to`.
pub fn write(to: impl Write, (width, height): (u32, u32), pixels: &[[u8; 4]]) -> io::Result<()> {
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    Ok(writer.finish()?)
}

/// The same to a file.
///
/// # Errors
/// Those of the file.
pub fn save(path: &Path, size: (u32, u32), pixels: &[[u8; 4]]) -> io::Result<()> {
    let mut to = BufWriter::new(File::create(path)?);
    write(&mut to, size, pixels)?;
    to.flush()
}
