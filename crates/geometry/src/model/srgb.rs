//! Conversion between sRGB (IEC 61966-2-1) and linear light, one component in `[0, 1]` at a time.

/// Linear light of a component.
pub fn decoded(c: f64) -> f64 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// The component of linear light; of colours in `shade.glsl`, too.
pub fn encoded(c: f64) -> f64 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}
