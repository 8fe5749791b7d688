//! Files and text that every command writes.

use anyhow::{Context, Result};
use comfy_table::{Table, TableComponent, presets};
use selvedge::picture::FrameStats;
use selvedge_io::import::{Import, ImportReport};
use serde::Serialize;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Prints results. A reader that went away (`selvedge info m.step | head`) is no error.
pub fn print(text: &str) -> Result<()> {
    match writeln!(io::stdout().lock(), "{text}") {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output"),
    }
}

/// Creates `path`, lets `fill` write to it, and names it when either fails.
pub fn file(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> Result<()>) -> Result<()> {
    let write = || -> Result<()> {
        let mut to = BufWriter::new(File::create(path)?);
        fill(&mut to)?;
        Ok(to.flush()?)
    };
    write().with_context(|| format!("cannot write {}", path.display()))
}

/// `value` as readable JSON.
pub fn json(path: &Path, value: &impl Serialize) -> Result<()> {
    file(path, |to| {
        serde_json::to_writer_pretty(&mut *to, value)?;
        Ok(writeln!(to)?)
    })
}

/// sRGB colour and opacity, row 0 on top.
pub fn png(path: &Path, (width, height): (u32, u32), pixels: &[[u8; 4]]) -> Result<()> {
    file(path, |to| {
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

/// Faces of the file that the model lacks, and why; `None` when it is complete.
pub fn missing_faces(report: &ImportReport) -> Option<String> {
    let missing: usize = report.dropped.values().sum();
    let reasons: Vec<String> = report.dropped.iter().map(|(why, n)| format!("{n} x {why}")).collect();
    (missing > 0).then(|| format!("{missing} of {} faces are missing: {}", report.faces, reasons.join(", ")))
}

/// Tells what the importer warns of (it bounds their number and counts the rest), then what is missing.
pub fn warnings(import: &Import) {
    for warning in &import.warnings {
        tracing::warn!("{warning}");
    }
    if let Some(missing) = missing_faces(&import.report) {
        tracing::warn!("{missing}");
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
