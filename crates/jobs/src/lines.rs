//! Lines along edges, as wide as a picture of any size needs.

use selvedge::picture::EdgeSettings;

/// Default width of the thinnest line, pixels: each pixel along an edge is then covered by more than the tenth from
/// which the image of edges counts it.
const LEAST_PX: f64 = 1.0;

/// The usual lines, `width_px` pixels wide in a picture of this height. Without a width they are as wide as the renderer's own,
/// but never thinner than one pixel.
pub fn lines(width_px: Option<f64>, height: u32) -> EdgeSettings {
    let usual = EdgeSettings::default();
    let at_1080 = EdgeSettings::HEIGHT / f64::from(height.max(1));
    let width = match width_px {
        Some(width_px) => width_px * at_1080,
        None => usual.width.max(LEAST_PX * at_1080).min(EdgeSettings::MOST_WIDTH),
    };
    EdgeSettings {
        width,
        thin_width: width * usual.thin_width / usual.width,
        section_width: usual.wider(width),
        ..usual
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_never_too_thin_to_be_seen() {
        let px = |settings: EdgeSettings, height: u32| settings.width * f64::from(height) / EdgeSettings::HEIGHT;
        assert!((px(lines(None, 1080), 1080) - 1.25).abs() < 1e-12);
        assert!((px(lines(None, 64), 64) - 1.0).abs() < 1e-12);
        assert!((px(lines(Some(3.0), 64), 64) - 3.0).abs() < 1e-12);
        assert!(lines(None, 1).check().is_ok() && lines(Some(9.0), 1).check().is_err());
        assert!((lines(Some(3.0), 64).thin_width / lines(Some(3.0), 64).width - 0.48).abs() < 1e-12);
    }
}
