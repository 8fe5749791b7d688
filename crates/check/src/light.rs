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

/// Directions of the key light, the fill and the rim, in view space: to the right, up, towards the eye.
pub const KEY: DVec3 = DVec3::new(-0.65, 0.46, 0.60);
const FILL: DVec3 = DVec3::new(0.21, 0.33, 0.92);
const RIM: DVec3 = DVec3::new(0.50, 0.50, -0.70);

/// Of the fill beside the lamp.
const FILL_STRENGTH: f64 = 0.34;

/// What a black face reflects.
const BLACK: f64 = 0.03;

/// Linear light of a face of linear `colour` and unit normal `n`, in model space, towards the viewer.
///
/// Twin of `shade.glsl`.
pub fn studio(colour: DVec3, n: DVec3, camera: &Camera, key: Key) -> DVec3 {
    let v = in_view(n, camera);
    let fill = if key == Key::Lamp { FILL_STRENGTH } else { 0.20 };
    let (light, shine) = match key {
        Key::Shadow => (0.0, 0.0),
        Key::Lamp => (lamp(v, KEY, 0.86), v.dot((KEY + DVec3::Z).normalize())),
        Key::Sun(towards) => {
            let half_way = (in_view(towards, camera) + DVec3::Z).normalize_or_zero();
            (0.62 * n.dot(towards).max(0.0), v.dot(half_way))
        }
    };
    toned(reflected(colour, v, light, fill) + 0.10 * shine.max(0.0).powi(48))
}

/// The same of a face of clay, which has no highlight.
pub fn clay(n: DVec3, camera: &Camera) -> DVec3 {
    let v = in_view(n, camera);
    toned(reflected(DVec3::new(0.58, 0.52, 0.46), v, lamp(v, KEY, 0.86), FILL_STRENGTH))
}

fn in_view(d: DVec3, camera: &Camera) -> DVec3 {
    let (right, up, forward) = camera.axes();
    DVec3::new(right.dot(d), up.dot(d), -forward.dot(d))
}

fn lamp(v: DVec3, towards: DVec3, strength: f64) -> f64 {
    strength * v.dot(towards).max(0.0).powi(2)
}

fn reflected(colour: DVec3, v: DVec3, key: f64, fill: f64) -> DVec3 {
    let sky = 0.12 + (0.20 - 0.12) * (0.5 + 0.5 * v.y);
    let colour = colour + (BLACK - colour.max_element()).max(0.0);
    colour * (key + lamp(v, FILL, fill) + lamp(v, RIM, 0.25) + sky)
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
    use selvedge_geometry::model::Bounds;

    /// Of a view: a camera at this azimuth and elevation, degrees.
    fn camera(azimuth: f64, elevation: f64) -> Camera {
        let (a, e) = (azimuth.to_radians(), elevation.to_radians());
        let from = DVec3::new(a.sin() * e.cos(), -a.cos() * e.cos(), e.sin());
        let bounds = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
        Camera::around(bounds, from, DVec3::Z, 0.6, (64, 64))
    }

    /// Lightness as the eye tells it: L* of CIE 1976, 0 to 100.
    fn lightness(grey: f64, n: DVec3, camera: &Camera) -> f64 {
        let light = studio(DVec3::splat(grey), n, camera, Key::Lamp).y;
        if light > 216.0 / 24389.0 { 116.0 * light.cbrt() - 16.0 } else { light * 24389.0 / 27.0 }
    }

    /// Sides of a block that meet in an edge differ in lightness, from nearly all directions, and in the usual view
    /// by ten steps.
    #[test]
    fn sides_of_a_block_differ() {
        let sides = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        for grey in [0.2, 0.5, 0.85] {
            let (mut pairs, mut alike) = (0, 0);
            for (azimuth, elevation) in (0..30).flat_map(|a| (0..24).map(move |e| (3 * a, 5 * e - 45))) {
                let camera = camera(f64::from(azimuth), f64::from(elevation));
                let (_, _, forward) = camera.axes();
                let seen: Vec<_> = sides.into_iter().filter(|side| side.dot(forward) < -0.15).collect();
                for (i, a) in seen.iter().enumerate() {
                    for b in &seen[..i] {
                        pairs += 1;
                        let apart = (lightness(grey, *a, &camera) - lightness(grey, *b, &camera)).abs();
                        alike += usize::from(apart < 6.0);
                    }
                }
            }
            assert!(5 * alike < pairs, "{grey}: {alike} of {pairs}");
            let camera = camera(45.0, 35.26);
            let [left, right, top] = [DVec3::NEG_Y, DVec3::X, DVec3::Z].map(|n| lightness(grey, n, &camera));
            assert!(top > left + 10.0 && left > right + 10.0, "{grey}: {top}, {left}, {right}");
        }
    }

    /// Where a grey surface that is seen turns by a degree, its lightness changes by a fifth of a step nearly
    /// everywhere; and the change has no corner, which would be seen as a stripe.
    #[test]
    fn light_shows_how_a_surface_turns() {
        let camera = camera(0.0, 0.0);
        let degree = 1.0_f64.to_radians();
        let (mut seen, mut flat) = (0, 0);
        for (x, y) in (-20..=20).flat_map(|x| (-20..=20).map(move |y| (f64::from(x) / 20.0, f64::from(y) / 20.0))) {
            let toward = 1.0 - x * x - y * y;
            if toward < 0.0625 {
                continue;
            }
            let n = DVec3::new(x, -toward.sqrt(), y);
            let (across, along) = n.any_orthonormal_pair();
            let turned = |way: DVec3| lightness(0.5, (n + degree * way).normalize(), &camera);
            let here = lightness(0.5, n, &camera);
            seen += 1;
            flat += usize::from((turned(across) - here).hypot(turned(along) - here) < 0.2);
        }
        assert!(seen > 1000 && 10 * flat < seen, "{flat} of {seen}");
        for lean in [-0.6_f64, -0.35, 0.0, 0.35] {
            let around = (-90..=90).map(|k| {
                let (sin, cos) = (f64::from(k) * degree).sin_cos();
                lightness(0.5, DVec3::new(sin, -cos, lean).normalize(), &camera)
            });
            let lights: Vec<f64> = around.collect();
            let bend = lights.windows(3).map(|l| (l[0] - 2.0 * l[1] + l[2]).abs()).fold(0.0, f64::max);
            assert!(bend < 0.15, "{lean}: {bend}");
        }
    }

    /// Black reflects as little as dark paint, and its shape is seen.
    #[test]
    fn black_is_no_blob() {
        let camera = camera(0.0, 0.0);
        let lights = [KEY, DVec3::new(0.3, 0.0, 0.95), DVec3::X].map(|v| {
            let (right, up, forward) = camera.axes();
            lightness(0.0, right * v.x + up * v.y - forward * v.z, &camera)
        });
        assert!(lights[0] > lights[1] + 3.0 && lights[1] > lights[2] + 3.0 && lights[2] > 1.0, "{lights:?}");
    }

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
