//! Colours of files, which store what a screen shows, to linear light.

use crate::model::Colour;

/// sRGB components in `[0, 1]` and an opacity as a [`Colour`]; what lies outside is clamped.
///
/// `c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055)^2.4` (IEC 61966-2-1).
pub(super) fn linear([r, g, b]: [f64; 3], opacity: f64) -> Colour {
    let linear = |c: f64| {
        let c = c.clamp(0.0, 1.0);
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    [linear(r) as f32, linear(g) as f32, linear(b) as f32, opacity.clamp(0.0, 1.0) as f32]
}
