//! The plots, as SVG: one line a way, both axes logarithmic.
//!
//! | file | over | of |
//! |---|---|---|
//! | `<model>-time-zoom.svg` | zoom | trim time |
//! | `<model>-time-size.svg` | pixels | trim time |
//! | `<model>-memory-zoom.svg` | zoom | bytes of the trims, whether the device has them or not |
//! | `<model>-time-error.svg` | worst shift | trim time, knob by knob |

use super::measure::{Row, Sweep};
use super::way::Way;
use crate::target;
use anyhow::Result;
use plotters::prelude::*;
use std::ops::Range;
use std::path::Path;

const SIZE: (u32, u32) = (640, 420);
/// Colours that the colour-blind tell apart. Source: P. Tol, *Colour schemes*, 2021 ("bright").
const COLOURS: [RGBColor; 6] = [
    RGBColor(0x44, 0x77, 0xAA),
    RGBColor(0xEE, 0x66, 0x77),
    RGBColor(0x22, 0x88, 0x33),
    RGBColor(0xCC, 0xBB, 0x44),
    RGBColor(0xAA, 0x33, 0x77),
    RGBColor(0x66, 0xCC, 0xEE),
];
/// Times below the clock's noise, and shifts of 0, are drawn here.
const LEAST: f64 = 1e-2;

/// The axes of a plot.
struct Plot<'a> {
    file: &'a str,
    title: &'a str,
    x: &'a str,
    y: &'a str,
    sweep: Sweep,
    point: fn(&Row) -> Option<(f64, f64)>,
}

const PLOTS: [Plot<'_>; 4] = [
    Plot {
        file: "time-zoom",
        title: "trim time over zoom",
        x: "zoom",
        y: "ms",
        sweep: Sweep::Zoom,
        point: |row| Some((row.zoom, row.cost.as_ref()?.trim_ms)),
    },
    Plot {
        file: "time-size",
        title: "trim time over picture size",
        x: "pixels",
        y: "ms",
        sweep: Sweep::Size,
        point: |row| Some((f64::from(row.size[0]) * f64::from(row.size[1]), row.cost.as_ref()?.trim_ms)),
    },
    Plot {
        file: "memory-zoom",
        title: "memory of the trims over zoom",
        x: "zoom",
        y: "bytes",
        sweep: Sweep::Zoom,
        point: |row| Some((row.zoom, row.trim_bytes)),
    },
    Plot {
        file: "time-error",
        title: "trim time over worst shift",
        x: "worst shift, px",
        y: "ms",
        sweep: Sweep::Knob,
        point: |row| Some((row.error.as_ref()?.worst_shift_px, row.cost.as_ref()?.trim_ms)),
    },
];

/// All plots of all models.
pub fn all(dir: &Path, rows: &[Row]) -> Result<()> {
    let mut models: Vec<&str> = rows.iter().map(|r| r.model.as_str()).collect();
    models.dedup();
    for model in models {
        for plot in &PLOTS {
            let path = dir.join(format!("{}-{}.svg", model.replace([' ', '/'], "_"), plot.file));
            if let Some(text) = draw(model, plot, rows)? {
                target::write(&path, |to| Ok(to.write_all(text.as_bytes())?))?;
            }
        }
    }
    Ok(())
}

/// The lines of a plot: a way and its points, in their order.
fn lines(model: &str, plot: &Plot<'_>, rows: &[Row]) -> Vec<(Way, Vec<(f64, f64)>)> {
    let mut lines: Vec<(Way, Vec<(f64, f64)>)> = Vec::new();
    for row in rows.iter().filter(|r| r.model == model && r.sweep == plot.sweep) {
        let Some((x, y)) = (plot.point)(row) else { continue };
        let point = (x.max(LEAST), y.max(LEAST));
        match lines.iter_mut().find(|(way, _)| *way == row.way) {
            Some((_, points)) => points.push(point),
            None => lines.push((row.way, vec![point])),
        }
    }
    lines
}

/// From the power of ten below the least to the one above the largest.
fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (lo, hi) = values.fold((f64::INFINITY, 0.0f64), |(lo, hi), x| (lo.min(x), hi.max(x)));
    let (from, to) = (10f64.powf(lo.log10().floor()), 10f64.powf(hi.log10().ceil()));
    from..to.max(10.0 * from)
}

/// The text of a plot, if it has points.
fn draw(model: &str, plot: &Plot<'_>, rows: &[Row]) -> Result<Option<String>> {
    let lines = lines(model, plot, rows);
    if lines.is_empty() {
        return Ok(None);
    }
    let mut text = String::new();
    let points = || lines.iter().flat_map(|(_, points)| points);
    let (x, y) = (decades(points().map(|p| p.0)), decades(points().map(|p| p.1)));
    let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(format!("{model}: {}", plot.title), ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(x.log_scale(), y.log_scale())?;
    let number = |x: &f64| format!("{x:e}");
    chart
        .configure_mesh()
        .x_desc(plot.x)
        .y_desc(plot.y)
        .x_label_formatter(&number)
        .y_label_formatter(&number)
        .light_line_style(WHITE)
        .draw()?;
    for ((way, points), colour) in lines.iter().zip(COLOURS.iter().cycle()) {
        let drawn = chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)).point_size(3))?;
        drawn.label(way.name()).legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.2))
        .draw()?;
    area.present()?;
    drop(chart);
    drop(area);
    Ok(Some(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_everything_in_whole_decades() {
        assert_eq!(decades([3.0, 450.0].into_iter()), 1.0..1000.0);
        let one = decades([1.0].into_iter());
        assert!(one.contains(&1.0) && one.end > one.start);
    }
}
