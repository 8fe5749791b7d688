//! The output of all commands: results, JSON, pictures, warnings.

use crate::{npy, target};
use anyhow::Result;
use comfy_table::{Table, TableComponent, presets};
use selvedge::picture::{FrameStats, Picture};
use selvedge_io::import::Import;
use selvedge_jobs::{Image, Values};
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
pub fn png(path: &Path, size: (u32, u32), pixels: &[[u8; 4]]) -> Result<()> {
    target::write(path, |to| Ok(selvedge_jobs::write_png(to, size, pixels)?))
}

/// An image as a NumPy array.
pub fn npy(path: &Path, image: Image, picture: &Picture) -> Result<()> {
    let (width, height) = (picture.size.0 as usize, picture.size.1 as usize);
    target::write(path, |mut to| {
        match image.of(picture) {
            Values::Floats(1, values) => npy::write(&mut to, &[height, width], values)?,
            Values::Floats(channels, values) => npy::write(&mut to, &[height, width, channels], values)?,
            Values::Numbers(values) => npy::write(&mut to, &[height, width], values)?,
        }
        Ok(())
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

/// Prints the importer's warnings: it bounds their number and counts the rest.
pub fn warnings(import: &Import) {
    for warning in &import.warnings {
        tracing::warn!("{warning}");
    }
}

/// Reports how often the frame could not be divided finely enough.
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
