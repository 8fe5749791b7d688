//! The background of pictures: a colour, a gradient from top to bottom, or nothing.
//!
//! ```text
//!   frame on nothing ──▶ straight colour c, opacity a ──▶ PNG as it is            --background none
//!                                └──▶ a c + (1 - a) g(y), in linear light ──▶ PNG     a gradient g
//!   frame on a colour ──▶ opaque ──▶ PNG                                          a colour
//! ```

use rayon::prelude::*;
use selvedge::model::{Colour, srgb};
use std::str::FromStr;

/// Top and bottom of the gradient, sRGB.
const TOP: [u8; 3] = [243, 245, 248];
const BOTTOM: [u8; 3] = [190, 197, 206];

/// The background of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Backdrop {
    /// A colour in linear light, and its opacity.
    Colour(Colour),
    /// From light above to darker below.
    Gradient,
    /// The PNG is transparent there.
    Nothing,
}

impl Backdrop {
    /// The background colour of the frame.
    pub fn colour(self) -> Colour {
        match self {
            Self::Colour(colour) => colour,
            Self::Gradient | Self::Nothing => [0.0; 4],
        }
    }

    /// Lays the backdrop under a picture that was drawn on its [`colour`](Self::colour).
    pub fn under(self, (width, height): (u32, u32), pixels: &mut [[u8; 4]]) {
        if self != Self::Gradient {
            return;
        }
        pixels.par_chunks_exact_mut(width as usize).enumerate().for_each(|(y, row)| {
            let ground = gradient((y as f64 + 0.5) / f64::from(height));
            // most pixels of most pictures: worked out once a row
            let bare = over([0; 4], ground);
            for pixel in row.iter_mut().filter(|pixel| pixel[3] < u8::MAX) {
                *pixel = if pixel[3] == 0 { bare } else { over(*pixel, ground) };
            }
        });
    }
}

/// Linear light of the gradient at a share of the height from above: even steps to the eye.
fn gradient(share: f64) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (top, bottom) = (f64::from(TOP[k]), f64::from(BOTTOM[k]));
        srgb::decoded((top + share * (bottom - top)) / 255.0)
    })
}

/// A pixel before an opaque ground.
fn over([r, g, b, a]: [u8; 4], ground: [f64; 3]) -> [u8; 4] {
    let opacity = f64::from(a) / 255.0;
    let mixed = |c: u8, ground: f64| {
        let light = opacity * srgb::decoded(f64::from(c) / 255.0) + (1.0 - opacity) * ground;
        (srgb::encoded(light) * 255.0).round() as u8
    };
    [mixed(r, ground[0]), mixed(g, ground[1]), mixed(b, ground[2]), u8::MAX]
}

impl FromStr for Backdrop {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => return Ok(Self::Nothing),
            "gradient" => return Ok(Self::Gradient),
            _ => {}
        }
        colour(text).map(Self::Colour).map_err(|error| format!("{error}, gradient or none"))
    }
}

/// A colour as style sheets write it, in linear light.
pub fn colour(text: &str) -> Result<Colour, String> {
    let colour = csscolorparser::parse(text).map_err(|_| {
        format!("`{text}` is no colour: wants a CSS colour, as in white, #f4f4f6 or rgb(20 30 40 / 50%)")
    })?;
    let light = |c: f32| srgb::decoded(f64::from(c.clamp(0.0, 1.0))) as f32;
    Ok([light(colour.r), light(colour.g), light(colour.b), colour.a.clamp(0.0, 1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_style_sheets() {
        let of = |text: &str| text.parse::<Backdrop>().expect("a backdrop");
        assert_eq!(of("white"), Backdrop::Colour([1.0; 4]));
        assert_eq!(of("#00f"), Backdrop::Colour([0.0, 0.0, 1.0, 1.0]));
        assert_eq!(of("transparent").colour(), [0.0; 4]);
        let Backdrop::Colour([r, _, _, a]) = of("#80808080") else { panic!("a colour") };
        // (128/255 + 0.055) / 1.055 to the power of 2.4
        assert!((r - 0.215_861).abs() < 1e-5 && (a - 128.0 / 255.0).abs() < 1e-6);
        assert_eq!((of("none"), of("gradient")), (Backdrop::Nothing, Backdrop::Gradient));
        for bad in ["", "whitish", "#12", "rgb(1,2)", "None of it"] {
            assert!(bad.parse::<Backdrop>().is_err(), "{bad}");
        }
    }

    /// Normals across the ray, all around: the outline of a smooth part.
    #[test]
    fn outlines_of_grey_parts_are_darker_than_the_gradient() {
        use glam::DVec3;
        use selvedge::model::{Bounds, Camera};
        use selvedge_check::light::{Key, studio};
        let bounds = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
        let camera = Camera::around(bounds, DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, (64, 64));
        let (right, up, _) = camera.axes();
        let brightest = |grey: f64| {
            let around = (0..720).map(|k| (f64::from(k) * std::f64::consts::TAU / 720.0).sin_cos());
            let lights =
                around.map(|(sin, cos)| studio(DVec3::splat(grey), right * cos + up * sin, &camera, Key::Lamp));
            lights.map(|light| srgb::encoded(light.y) * 255.0).fold(0.0, f64::max)
        };
        // a part without a colour, and sRGB 188
        let usual = brightest(f64::from(selvedge::model::GREY[0]));
        assert!(usual + 60.0 < f64::from(BOTTOM[1]), "{usual}");
        assert!(brightest(0.5) + 20.0 < f64::from(BOTTOM[1]), "{}", brightest(0.5));
        // as bright as the gradient somewhere: docs/design/light.md, Limits
        assert!(brightest(0.8) > f64::from(BOTTOM[1]));
    }

    #[test]
    fn a_gradient_shows_where_nothing_hides_it() {
        // nothing of a colour of opacity 0 is seen
        let mut pixels = [[0, 0, 0, 0], [10, 20, 30, 255], [255, 0, 0, 128], [90, 0, 0, 0]];
        Backdrop::Gradient.under((1, 4), &mut pixels);
        assert_eq!(pixels[1], [10, 20, 30, 255]);
        assert!(pixels.iter().all(|p| p[3] == 255));
        // from above to below, within its ends
        assert!(pixels[0][0] < TOP[0] && pixels[0][0] > pixels[3][0] && pixels[3][0] > BOTTOM[0]);
        // half of red's light and half of the ground's
        let [r, g, _, _] = pixels[2];
        assert!(r > 225 && (130..180).contains(&g), "{:?}", pixels[2]);
        let mut left = [[1, 2, 3, 4]];
        Backdrop::Nothing.under((1, 1), &mut left);
        assert_eq!(left, [[1, 2, 3, 4]]);
    }
}
