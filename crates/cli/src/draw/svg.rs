//! Strokes as an SVG file: a group a kind, paths in millimetres.
//!
//! Widths and dashes are those of ISO 128: outlines and visible edges thick, hidden lines thin and dashed.

use selvedge_check::drawing::{LineKind, Stroke};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Rounding of a coordinate, in shares of a pixel.
const ROUNDED: f64 = 5e-4;

/// The paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Page {
    /// Width and height, millimetres.
    pub size: (f64, f64),
    /// Millimetres for a pixel.
    pub per_pixel: f64,
}

/// Width and dashes of a kind of line, millimetres.
struct Pen {
    width: f64,
    colour: &'static str,
    dashes: Option<&'static str>,
}

const HIDDEN: Pen = Pen { width: 0.18, colour: "#666666", dashes: Some("1.2 0.6") };
const THICK: Pen = Pen { width: 0.35, colour: "#000000", dashes: None };
const THIN: Pen = Pen { width: 0.13, colour: "#000000", dashes: None };

/// Groups from bottom to top.
const GROUPS: [(bool, LineKind, &str); 8] = [
    (true, LineKind::Smooth, "smooth"),
    (true, LineKind::Sharp, "sharp"),
    (true, LineKind::Border, "border"),
    (true, LineKind::Silhouette, "silhouette"),
    (false, LineKind::Smooth, "smooth"),
    (false, LineKind::Sharp, "sharp"),
    (false, LineKind::Border, "border"),
    (false, LineKind::Silhouette, "silhouette"),
];

/// Writes the file; `full`: smooth edges are as thick as others.
pub fn write(to: &mut dyn Write, page: &Page, name: &str, strokes: &[Stroke], full: bool) -> io::Result<()> {
    let decimals = (-(ROUNDED * page.per_pixel).log10()).ceil().clamp(0.0, 12.0) as usize;
    let number = |x: f64| trimmed(format!("{x:.decimals$}"));
    let (width, height) = (number(page.size.0), number(page.size.1));
    writeln!(to, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(
        to,
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}">"#
    )?;
    if !name.is_empty() {
        writeln!(to, "<title>{}</title>", escaped(name))?;
    }
    writeln!(to, r#"<g fill="none" stroke-linecap="round" stroke-linejoin="round">"#)?;
    for (hidden, kind, word) in GROUPS {
        let of: Vec<&Stroke> = strokes.iter().filter(|s| (s.hidden, s.kind) == (hidden, kind)).collect();
        if of.is_empty() {
            continue;
        }
        let pen = match (hidden, kind) {
            (true, _) => HIDDEN,
            (false, LineKind::Smooth) if !full => THIN,
            _ => THICK,
        };
        let seen = if hidden { "hidden" } else { "visible" };
        let dashes = pen.dashes.map_or(String::new(), |d| format!(r#" stroke-dasharray="{d}""#));
        writeln!(
            to,
            r#"<g id="{seen}-{word}" class="{seen} {word}" stroke="{}" stroke-width="{}"{dashes}>"#,
            pen.colour, pen.width
        )?;
        for stroke in of {
            writeln!(to, r#"<path d="{}"/>"#, path(stroke, page.per_pixel, &number))?;
        }
        writeln!(to, "</g>")?;
    }
    writeln!(to, "</g>\n</svg>")
}

/// The commands of a path.
fn path(stroke: &Stroke, per_pixel: f64, number: &dyn Fn(f64) -> String) -> String {
    let mut text = String::new();
    let mut point = |command: &str, p: glam::DVec2| {
        let _ = write!(text, "{command}{} {}", number(p.x * per_pixel), number(p.y * per_pixel));
    };
    for (k, c) in stroke.curves.iter().enumerate() {
        if k == 0 {
            point("M", c[0]);
        }
        let chord = c[3] - c[0];
        let off = |p: glam::DVec2| (p - c[0]).perp_dot(chord).abs();
        if off(c[1]).max(off(c[2])) <= ROUNDED * chord.length() {
            point("L", c[3]);
        } else {
            point("C", c[1]);
            point(" ", c[2]);
            point(" ", c[3]);
        }
    }
    if stroke.closed {
        text.push('Z');
    }
    text
}

/// Without zeros at the end.
fn trimmed(text: String) -> String {
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

/// As text of an element; characters that XML does not have are left out.
fn escaped(text: &str) -> String {
    let allowed = text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}'));
    allowed.collect::<String>().replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
