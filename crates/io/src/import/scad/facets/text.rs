//! Text: glyphs of the fonts that are installed, laid out and turned into outlines as OpenSCAD does.
//!
//! ```text
//!        ┌─ ascent of the glyphs                size 10: an em of 10 · 100 / 72, so that capitals are
//!   x────┼── baseline                          about 10 high
//!        └─ descent                            curves: segments by $fn, $fa, $fs
//! ```
//!
//! Source: `FreetypeRenderer`, `DrawingCallback` and `TextNode` of OpenSCAD 2021.01.

use super::Region;
use crate::import::scad::Fault;
use crate::import::scad::args::{Args, Value};
use fontdb::{Database, Family, Query, Style, Weight};
use glam::DVec2;
use rustybuzz::ttf_parser::{GlyphId, OutlineBuilder};
use rustybuzz::{Direction, Face, Language, Script, UnicodeBuffer, shape};
use std::str::FromStr;
use std::sync::OnceLock;

/// OpenSCAD's own font.
const DEFAULT: &str = "Liberation Sans";
/// Segments of one curve of a glyph.
const MOST_SEGMENTS: f64 = 1000.0;

/// The fonts of the machine, looked for once.
pub(super) fn installed() -> &'static Database {
    static FONTS: OnceLock<Database> = OnceLock::new();
    FONTS.get_or_init(|| {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        fonts
    })
}

/// The outlines of a text, and a note on its font.
pub(super) fn text(args: &Args<'_>, fonts: &Database) -> Result<(Region, Option<String>), Fault> {
    let word = |name: &str, default: &str| match args.get(name) {
        Some(Value::Text(text)) if !text.is_empty() => text.clone(),
        _ => default.to_owned(),
    };
    let (size, spacing) = (args.number("size", 10.0)?, args.number("spacing", 1.0)?);
    if !size.is_finite() || !spacing.is_finite() {
        return Err(args.fault("a size or spacing that is not finite"));
    }
    let (id, note) = find(fonts, &word("font", DEFAULT)).map_err(|what| args.fault(what))?;
    let steps = ((args.segments(size.abs()) / 8.0).floor() + 1.0).clamp(2.0, MOST_SEGMENTS) as u32;
    let drawn = fonts.with_face_data(id, |data, index| {
        let face = Face::from_slice(data, index)?;
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(&word("text", ""));
        buffer.set_direction(match word("direction", "ltr").as_str() {
            "rtl" => Direction::RightToLeft,
            "ttb" => Direction::TopToBottom,
            "btt" => Direction::BottomToTop,
            _ => Direction::LeftToRight,
        });
        buffer.set_script(Script::from_str(&word("script", "Latn")).ok()?);
        buffer.set_language(Language::from_str(&word("language", "en")).ok()?);
        let em = size * 100.0 / 72.0 / f64::from(face.units_per_em());
        Some(lines(&face, buffer, &word("halign", "left"), &word("valign", "baseline"), spacing, steps, em))
    });
    let region = drawn.flatten().ok_or_else(|| args.fault("the font, the script or the language cannot be used"))?;
    Ok((region, note))
}

/// A face for `Family:style=Bold Italic`; another one, with a note, where there is none of that name.
fn find(fonts: &Database, asked: &str) -> Result<(fontdb::ID, Option<String>), String> {
    let mut parts = asked.split(':');
    let family = parts.next().unwrap_or_default().trim();
    let family = if family.is_empty() { DEFAULT } else { family };
    let style = parts.find_map(|p| p.trim().strip_prefix("style=")).unwrap_or_default().to_lowercase();
    let with = |name: &str| {
        fonts.query(&Query {
            families: &[Family::Name(name)],
            weight: if style.contains("bold") { Weight::BOLD } else { Weight::NORMAL },
            style: match () {
                () if style.contains("italic") => Style::Italic,
                () if style.contains("oblique") => Style::Oblique,
                () => Style::Normal,
            },
            ..Query::default()
        })
    };
    if let Some(id) = with(family) {
        return Ok((id, None));
    }
    match with(DEFAULT) {
        Some(id) => Ok((id, Some(format!("the font `{family}` is not installed: {DEFAULT} is used")))),
        None => Err(format!("the font `{family}` is not installed, nor is {DEFAULT}")),
    }
}

/// One line of glyphs, aligned.
fn lines(
    face: &Face<'_>,
    buffer: UnicodeBuffer,
    halign: &str,
    valign: &str,
    spacing: f64,
    steps: u32,
    em: f64,
) -> Region {
    let vertical = matches!(buffer.direction(), Direction::TopToBottom | Direction::BottomToTop);
    let shaped = shape(face, &[], buffer);
    let (mut pen, mut width) = (DVec2::ZERO, 0.0_f64);
    let (mut ascent, mut descent) = (0.0_f64, 0.0_f64);
    let mut glyphs = Vec::new();
    for (info, position) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
        let shift = DVec2::new(f64::from(position.x_offset), f64::from(position.y_offset));
        let mut outline = Outline { steps, ..Outline::default() };
        face.outline_glyph(GlyphId(info.glyph_id as u16), &mut outline);
        outline.close();
        ascent = ascent.max(outline.high.y);
        descent = descent.max(-outline.low.y);
        if vertical {
            width = width.max(outline.high.x - outline.low.x);
        } else {
            width += f64::from(position.x_advance) * spacing;
        }
        glyphs.push((pen + shift, outline.done));
        pen += spacing * DVec2::new(f64::from(position.x_advance), f64::from(position.y_advance));
    }
    let x = match halign {
        "right" => -width,
        "center" => -0.5 * width,
        _ => 0.0,
    };
    let y = match valign {
        "top" => -ascent,
        "center" => 0.5 * (descent - ascent),
        "bottom" => descent,
        _ => 0.0,
    };
    let placed = glyphs.into_iter().map(|(at, outlines)| {
        let moved = |o: Vec<DVec2>| o.into_iter().map(|p| em * (p + at + DVec2::new(x, y))).collect();
        Region::new(&outlines.into_iter().map(moved).collect::<Vec<_>>(), true)
    });
    Region::union(placed.collect())
}

/// The sides of a glyph, font units.
#[derive(Default)]
struct Outline {
    steps: u32,
    done: Vec<Vec<DVec2>>,
    open: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
}

impl Outline {
    fn point(&mut self, x: f32, y: f32) -> DVec2 {
        let p = DVec2::new(f64::from(x), f64::from(y));
        let first = self.done.is_empty() && self.open.is_empty();
        (self.low, self.high) = if first { (p, p) } else { (self.low.min(p), self.high.max(p)) };
        p
    }

    fn curve(&mut self, control: &[DVec2]) {
        for i in 1..=self.steps {
            let t = f64::from(i) / f64::from(self.steps);
            let mut row = control.to_vec(); // de Casteljau
            while row.len() > 1 {
                row = row.windows(2).map(|w| w[0].lerp(w[1], t)).collect();
            }
            self.open.push(row[0]);
        }
    }

    fn last(&self) -> DVec2 {
        self.open.last().copied().unwrap_or_default()
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.close();
        let p = self.point(x, y);
        self.open.push(p);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let p = self.point(x, y);
        self.open.push(p);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let control = [self.last(), self.point(x1, y1), self.point(x, y)];
        self.curve(&control);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let control = [self.last(), self.point(x1, y1), self.point(x2, y2), self.point(x, y)];
        self.curve(&control);
    }

    fn close(&mut self) {
        if self.open.len() > 2 {
            self.done.push(std::mem::take(&mut self.open));
        }
        self.open.clear();
    }
}
