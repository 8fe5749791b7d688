//! The legend of the styles that show curvature.
//!
//! ```text
//!   ┌──────────────────────┐
//!   │ mean curvature, 1/mm │   in the lower right corner, on a ground of its own,
//!   │               ▓ 0.05 │   a whole number of pixels for each of its own
//!   │               ▒ 0    │
//!   │               ░ -0.05│
//!   └──────────────────────┘
//! ```

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_8X13};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Baseline, Text};
use selvedge::picture::Style;
use selvedge_check::light::curvature_scale;
use std::convert::Infallible;

const INK: Rgb888 = Rgb888::new(24, 28, 32);
const GROUND: Rgb888 = Rgb888::new(250, 250, 250);
/// Pixels of the picture's height for each one of the legend's own.
const HEIGHT: u32 = 600;
const MARGIN: i32 = 8;
const LINE: i32 = 15;
const BAR: Size = Size::new(14, 120);
const LETTER: i32 = 8;

/// Draws the scale into a picture, sRGB; other styles than those of curvature have none, nor have pictures without room for
/// it. `range` as [`FrameSettings::curvature_range`](selvedge::picture::FrameSettings::curvature_range).
pub fn legend(style: Style, range: f64, size: (u32, u32), pixels: &mut [[u8; 4]]) {
    let (title, end) = match style {
        Style::MeanCurvature => ("mean curvature, 1/mm", range),
        Style::GaussianCurvature => ("Gaussian curvature, 1/mm2", range * range),
        _ => return,
    };
    let mut canvas = Canvas { size, factor: (size.1 / HEIGHT).max(1), pixels };
    let width = LETTER * title.len() as i32 + 2 * MARGIN;
    let height = LINE + BAR.height as i32 + 3 * MARGIN;
    let room = canvas.size();
    let corner = Point::new(room.width as i32 - width - MARGIN, room.height as i32 - height - MARGIN);
    if corner.x < 0 || corner.y < 0 {
        return;
    }
    let Ok(()) = draw(&mut canvas, Rectangle::new(corner, Size::new(width as u32, height as u32)), title, end);
}

fn draw(canvas: &mut Canvas<'_>, panel: Rectangle, title: &str, end: f64) -> Result<(), Infallible> {
    let letters = MonoTextStyle::new(&FONT_8X13, INK);
    panel.into_styled(PrimitiveStyle::with_fill(GROUND)).draw(canvas)?;
    let inner = panel.top_left + Point::new_equal(MARGIN);
    Text::with_baseline(title, inner, letters, Baseline::Top).draw(canvas)?;
    let bar = Rectangle::new(inner + Point::new(0, LINE + MARGIN), BAR);
    for row in bar.rows() {
        let share = 1.0 - 2.0 * (f64::from(row - bar.top_left.y) + 0.5) / f64::from(BAR.height);
        let [r, g, b] = curvature_scale(share).to_array().map(|c| (255.0 * c).round() as u8);
        let line = Rectangle::new(Point::new(bar.top_left.x, row), Size::new(BAR.width, 1));
        line.into_styled(PrimitiveStyle::with_fill(Rgb888::new(r, g, b))).draw(canvas)?;
    }
    let right = bar.top_left.x + BAR.width as i32 + MARGIN;
    for (value, row) in [(end, 0), (0.0, BAR.height as i32 / 2), (-end, BAR.height as i32)] {
        let at = Point::new(right, bar.top_left.y + row - LINE / 2);
        Text::with_baseline(&short(value), at, letters, Baseline::Top).draw(canvas)?;
    }
    Ok(())
}

/// A number with as many digits as an end of a scale has.
fn short(value: f64) -> String {
    let text = format!("{value}");
    if text.len() <= 8 { text } else { format!("{value:.0e}") }
}

/// A picture whose pixels are `factor` times as large.
struct Canvas<'a> {
    size: (u32, u32),
    factor: u32,
    pixels: &'a mut [[u8; 4]],
}

impl OriginDimensions for Canvas<'_> {
    fn size(&self) -> Size {
        Size::new(self.size.0 / self.factor, self.size.1 / self.factor)
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, all: I) -> Result<(), Infallible> {
        let room = Rectangle::new(Point::zero(), self.size());
        for Pixel(at, colour) in all.into_iter().filter(|Pixel(at, _)| room.contains(*at)) {
            let (left, top) = (at.x as u32 * self.factor, at.y as u32 * self.factor);
            for y in top..top + self.factor {
                let first = (y * self.size.0 + left) as usize;
                self.pixels[first..first + self.factor as usize].fill([colour.r(), colour.g(), colour.b(), u8::MAX]);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(style: Style, size: (u32, u32)) -> Vec<[u8; 4]> {
        let mut pixels = vec![[0; 4]; (size.0 * size.1) as usize];
        legend(style, 0.05, size, &mut pixels);
        pixels
    }

    #[test]
    fn a_scale_of_curvature_has_a_legend_and_others_have_none() {
        let inked = |pixels: &[[u8; 4]]| pixels.iter().filter(|p| p[3] != 0).count();
        let mean = drawn(Style::MeanCurvature, (400, 300));
        // a panel as wide as twenty letters, and the bar's ends within it: red above, blue below
        assert_eq!(inked(&mean), (8 * 20 + 16) * (15 + 120 + 24));
        let row_of = |is: fn(&[u8; 4]) -> bool| mean.iter().position(is).expect("such a pixel") / 400;
        let red = row_of(|p| p[0] > 170 && p[1] < 40 && p[2] < 60 && p[3] == 255);
        let blue = row_of(|p| p[0] < 50 && p[2] > 160 && p[3] == 255);
        assert!(red < blue, "{red} {blue}");
        // twice as large in a picture twice as high
        assert_eq!(inked(&drawn(Style::MeanCurvature, (1600, 1200))), 4 * inked(&mean));
        for (style, size) in [(Style::Shaded, (400, 300)), (Style::MeanCurvature, (100, 100))] {
            assert_eq!(inked(&drawn(style, size)), 0);
        }
    }

    #[test]
    fn ends_are_short() {
        assert_eq!([short(0.05), short(-0.0025), short(0.0), short(1e-9)], ["0.05", "-0.0025", "0", "1e-9"]);
    }
}
