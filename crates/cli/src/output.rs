//! The output of all commands: results, JSON, pictures, warnings.

use crate::target;
use anyhow::Result;
use comfy_table::{Table, TableComponent, presets};
use selvedge::picture::FrameStats;
use selvedge_io::import::Import;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Prints results.
pub fn print(text: &str) -> Result<()> {
    target::standard(format!("{text}\n").as_bytes())
}

/// The same, to standard error where one of the files goes to standard output.
pub fn print_beside<'p>(text: &str, mut files: impl Iterator<Item = &'p PathBuf>) -> Result<()> {
    if files.any(|path| target::is_standard(path)) {
        eprintln!("{text}");
        return Ok(());
    }
    print(text)
}

/// `value` as readable JSON.
pub fn json(path: &Path, value: &impl Serialize) -> Result<()> {
    target::write(path, |to| {
        serde_json::to_writer_pretty(&mut *to, value)?;
        Ok(writeln!(to)?)
    })
}

/// sRGB colour and opacity, row 0 on top.
pub fn png(path: &Path, (width, height): (u32, u32), pixels: &[[u8; 4]]) -> Result<()> {
    target::write(path, |to| {
        let mut encoder = png::Encoder::new(to, width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(pixels.as_flattened())?;
        Ok(writer.finish()?)
    })
}

/// A table with a line under its header and no other.
pub fn table<'a>(header: impl IntoIterator<Item = &'a str>) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::UTF8_HORIZONTAL_ONLY);
    for line in [TableComponent::HorizontalLines, TableComponent::MiddleIntersections] {
        table.remove_style(line);
    }
    table.set_header(header);
    table
}

/// Tells what the importer warns of: it bounds their number and counts the rest.
pub fn warnings(import: &Import) {
    for warning in &import.warnings {
        tracing::warn!("{warning}");
    }
}

/// Tells where the frame could not be cut finely enough.
pub fn clamps(stats: &FrameStats) {
    if stats.clamps > 0 {
        tracing::warn!(
            "{} patches were not split finely enough, or rays not followed to their ends: the tolerance is not kept there",
            stats.clamps
        );
    }
    if stats.open_clear > 0 {
        tracing::warn!("{} parts to be seen through are not closed: they are drawn opaque", stats.open_clear);
    }
    if stats.shadowless > 0 {
        tracing::warn!(
            "{} parts and solids cast no shadow: to be seen through, cut open by a volume, or too many triangles",
            stats.shadowless
        );
    }
}
