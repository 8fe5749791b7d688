//! The light of pictures, in `f64`: a studio that travels with the camera.

use glam::DVec3;
use selvedge_geometry::model::Camera;

/// The source of the key light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    /// The studio's lamp.
    Lamp,
    /// A sun in this direction, a unit vector in model space.
    Sun(DVec3),
    /// A sun hidden by an object.
    Shadow,
}

/// Linear light of a face of linear `colour` and unit normal `n`, in model space, towards the viewer.
///
/// Twin of `shade.glsl`.
pub fn studio(colour: DVec3, n: DVec3, camera: &Camera, key: Key) -> DVec3 {
    let (right, up, forward) = camera.axes();
    let in_view = |d: DVec3| DVec3::new(right.dot(d), up.dot(d), -forward.dot(d));
    let v = in_view(n);
    let lamp = DVec3::new(-0.42, 0.57, 0.71);
    let (cosine, shine) = match key {
        Key::Shadow => (0.0, 0.0),
        Key::Lamp => (v.dot(lamp), v.dot((lamp + DVec3::Z).normalize())),
        Key::Sun(towards) => (n.dot(towards), v.dot((in_view(towards) + DVec3::Z).normalize_or_zero())),
    };
    let fill =
        0.22 * v.dot(DVec3::new(0.71, 0.14, 0.69)).max(0.0) + 0.30 * v.dot(DVec3::new(0.64, 0.48, -0.60)).max(0.0);
    let sky = 0.12 + (0.26 - 0.12) * (0.5 + 0.5 * v.y);
    let highlight = 0.10 * shine.max(0.0).powi(48);
    toned(colour * (0.62 * cosine.max(0.0) + fill + sky) + highlight)
}

/// The sRGB colour of a curvature that is this share of the largest on the scale: from blue hollows over light grey to red
/// bulges, which `shade.glsl` darkens where the surface leans away.
pub fn curvature_scale(share: f64) -> DVec3 {
    let end = if share < 0.0 { DVec3::new(0.129, 0.400, 0.675) } else { DVec3::new(0.698, 0.094, 0.169) };
    DVec3::splat(0.941).lerp(end, share.abs().min(1.0))
}

/// The tone curve: identity up to the shoulder, then nearer and nearer to 1.
fn toned(light: DVec3) -> DVec3 {
    const SHOULDER: f64 = 0.76;
    let (peak, rest) = (light.max_element(), 1.0 - SHOULDER);
    if peak <= SHOULDER { light } else { light * ((1.0 - rest * rest / (peak - SHOULDER + rest)) / peak) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_light_is_clipped_and_more_is_more() {
        let shown: Vec<f64> = (0..500).map(|k| toned(DVec3::splat(f64::from(k) * 0.01)).x).collect();
        assert!(shown.windows(2).all(|pair| pair[0] < pair[1]) && shown.iter().all(|light| *light < 1.0));
        // one curve: no step, and no corner, at the shoulder
        let slope = |at: f64| (toned(DVec3::splat(at + 1e-6)).x - toned(DVec3::splat(at)).x) / 1e-6;
        assert!((slope(0.75) - 1.0).abs() < 1e-6 && (slope(0.761) - 1.0).abs() < 0.02);
        // hues stay
        let red = toned(DVec3::new(2.0, 1.0, 0.5));
        assert!((red.x / red.y - 2.0).abs() < 1e-12 && (red.y / red.z - 2.0).abs() < 1e-12);
    }
}
