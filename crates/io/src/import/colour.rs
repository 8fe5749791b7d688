//! Colours of files, which store what a screen shows, to linear light.

use crate::model::{Colour, srgb};

/// sRGB components in `[0, 1]` and an opacity as a [`Colour`]; what lies outside is clamped.
pub(super) fn linear([r, g, b]: [f64; 3], opacity: f64) -> Colour {
    let light = |c: f64| srgb::decoded(c.clamp(0.0, 1.0)) as f32;
    [light(r), light(g), light(b), opacity.clamp(0.0, 1.0) as f32]
}
