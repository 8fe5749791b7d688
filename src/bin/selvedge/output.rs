//! Files and text that every command writes.

use anyhow::{Context, Result};
use selvedge::import::Import;
use selvedge::picture::FrameStats;
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

/// Tells what the importer warns of (it bounds their number and counts the rest), then what is missing.
pub fn warnings(import: &Import) {
    for warning in &import.warnings {
        tracing::warn!("{warning}");
    }
    let missing: usize = import.report.dropped.values().sum();
    if missing > 0 {
        let reasons: Vec<String> = import.report.dropped.iter().map(|(why, n)| format!("{n} x {why}")).collect();
        tracing::warn!("{missing} of {} faces are missing: {}", import.report.faces, reasons.join(", "));
    }
}

/// Tells where the frame could not be cut finely enough.
pub fn clamps(stats: &FrameStats) {
    if stats.clamps > 0 {
        tracing::warn!("{} patches were not split finely enough: the tolerance is not kept there", stats.clamps);
    }
}
