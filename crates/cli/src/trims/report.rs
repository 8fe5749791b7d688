//! The measurements as a table and as CSV.

use super::measure::{Row, Sweep};
use crate::{output, target};
use anyhow::Result;
use comfy_table::CellAlignment;
use indicatif::HumanBytes;
use std::path::Path;

/// One line a measurement.
pub fn table(rows: &[Row]) -> String {
    let mut table = output::table([
        "model",
        "sweep",
        "way",
        "knob",
        "zoom",
        "size",
        "trim, ms",
        "gaps, ms",
        "frame, ms",
        "turning: trim",
        "frame, ms",
        "trim bytes",
        "all bytes",
        "wrong",
        "judged",
        "worst, px",
    ]);
    for row in rows {
        let ms = |x: Option<f64>| x.map_or("no room".into(), |x| format!("{x:.2}"));
        let cost = row.cost.as_ref();
        let error = row.error.as_ref();
        table.add_row([
            row.model.clone(),
            sweep(row.sweep).into(),
            row.way.to_string(),
            row.knob_at.to_string(),
            row.zoom.to_string(),
            format!("{} x {}", row.size[0], row.size[1]),
            ms(cost.map(|c| c.trim_ms)),
            ms(cost.map(|c| c.gaps_ms)),
            ms(cost.map(|c| c.frame_ms)),
            ms(cost.map(|c| c.turning_trim_ms)),
            ms(cost.map(|c| c.turning_frame_ms)),
            HumanBytes(row.trim_bytes as u64).to_string(),
            cost.map_or(String::new(), |c| HumanBytes(c.bytes).to_string()),
            error.map_or(String::new(), |e| e.wrong.to_string()),
            error.map_or(String::new(), |e| e.judged.to_string()),
            error.map_or(String::new(), |e| format!("{:.3}", e.worst_shift_px)),
        ]);
    }
    table.column_iter_mut().skip(3).for_each(|c| c.set_cell_alignment(CellAlignment::Right));
    table.to_string()
}

pub fn sweep(sweep: Sweep) -> &'static str {
    match sweep {
        Sweep::Zoom => "zoom",
        Sweep::Size => "size",
        Sweep::Knob => "knob",
    }
}

/// The same without the passes and objects, which the JSON has; empty where the device had no room.
pub fn csv(path: &Path, rows: &[Row]) -> Result<()> {
    target::write(path, |to| {
        let mut lines = csv::Writer::from_writer(to);
        lines.write_record([
            "model",
            "sweep",
            "way",
            "knob",
            "knob_at",
            "zoom",
            "width",
            "height",
            "prepare_ms",
            "trim_ms",
            "own_passes_ms",
            "gaps_ms",
            "frame_ms",
            "turning_trim_ms",
            "turning_frame_ms",
            "trim_bytes",
            "all_bytes",
            "trim_segments",
            "trim_intercepts",
            "clamps",
            "judged",
            "wrong",
            "worst_shift_px",
            "device",
        ])?;
        for row in rows {
            let (cost, error) = (row.cost.as_ref(), row.error.as_ref());
            let of = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
            let count = |x: Option<u64>| x.map_or(String::new(), |x| x.to_string());
            lines.write_record([
                row.model.clone(),
                sweep(row.sweep).into(),
                row.way.to_string(),
                row.knob.into(),
                row.knob_at.to_string(),
                row.zoom.to_string(),
                row.size[0].to_string(),
                row.size[1].to_string(),
                row.prepare_ms.to_string(),
                of(cost.map(|c| c.trim_ms)),
                of(cost.map(|c| c.own_passes_ms)),
                of(cost.map(|c| c.gaps_ms)),
                of(cost.map(|c| c.frame_ms)),
                of(cost.map(|c| c.turning_trim_ms)),
                of(cost.map(|c| c.turning_frame_ms)),
                row.trim_bytes.to_string(),
                count(cost.map(|c| c.bytes)),
                count(cost.map(|c| c.trim_segments)),
                count(cost.map(|c| c.trim_intercepts)),
                count(cost.map(|c| c.clamps)),
                count(error.map(|e| e.judged)),
                count(error.map(|e| e.wrong)),
                of(error.map(|e| e.worst_shift_px)),
                row.device.clone(),
            ])?;
        }
        Ok(lines.flush()?)
    })
}
