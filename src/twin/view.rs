//! Twin of `glsl/include/view.glsl`: from part coordinates to the picture.
//!
//! ```text
//!        (X, Y)        pixel = (X, Y) / W          a box is outside when all 8 corners are on the
//!   p ─▶   D     ─▶    depth = D                   outer side of one of the picture's 6 planes,
//!          W           W = D, or 1 if parallel     the planes widened by `margin` pixels
//! ```
//!
//! The planes are linear in `(X, Y, D, W)`, so the test also holds for corners behind the eye.

use crate::abi::constants::view::{PIXEL_ROUNDING, SLAB_ROUNDING};
use crate::abi::{FACE_OPERAND, Face, Frame, Instance, View};

fn row_times(row: [f32; 4], p: [f32; 4]) -> f32 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] * p[3]
}

/// Homogeneous pixels `(X, Y, D, W)` of a homogeneous point in part coordinates.
pub fn to_pixel(view: &View, p: [f32; 4]) -> [f32; 4] {
    [row_times(view.x, p), row_times(view.y, p), row_times(view.depth, p), row_times(view.w, p)]
}

/// A box in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The smallest `W` in front of the near plane; 1 in a parallel view.
    pub w: f32,
    /// The largest stretch of a pixel towards the box's corners, at most the picture's.
    pub slant: f32,
    /// Its smallest pixel coordinates.
    pub low: [f32; 2],
    /// Its largest pixel coordinates.
    pub high: [f32; 2],
}

/// The box `lo..hi` (part coordinates) in the picture widened by `margin` pixels, in front of `far`; `None` if no part
/// of it is visible.
///
/// Conservative: a box that passes may still be out of sight, near a corner of the picture. Pixel and slope are
/// quotients of linear functions, so their extrema are at corners if all corners are in front of the eye. If one is
/// not, the result has the picture's slant and no limits.
pub fn see(view: &View, frame: &Frame, lo: [f32; 3], hi: [f32; 3], margin: f32, far: f32) -> Option<Seen> {
    let mut seen = Seen { w: 3.0e38, slant: 0.0, low: [3.0e38; 2], high: [-3.0e38; 2] };
    let mut steepest = 0.0f32;
    let mut outside = 63u32;
    for corner in 0..8u32 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { lo[axis] } else { hi[axis] };
        let [x, y, depth, w] = to_pixel(view, [pick(0), pick(1), pick(2), 1.0]);
        seen.w = seen.w.min(w);
        let pixel = [x / w, y / w];
        let slope = std::array::from_fn::<f32, 2, _>(|a| (pixel[a] - frame.principal_px[a]) / frame.focal_px[a]);
        for (a, pixel) in pixel.into_iter().enumerate() {
            (seen.low[a], seen.high[a]) = (seen.low[a].min(pixel), seen.high[a].max(pixel));
        }
        steepest = steepest.max(slope[0] * slope[0] + slope[1] * slope[1]);
        let planes = [
            x + margin * w < 0.0,
            x - (frame.size[0] + margin) * w > 0.0,
            y + margin * w < 0.0,
            y - (frame.size[1] + margin) * w > 0.0,
            depth < frame.near,
            depth > far,
        ];
        outside &= planes.iter().enumerate().fold(0, |bits, (i, &beyond)| bits | u32::from(beyond) << i);
    }
    if outside != 0 {
        return None;
    }
    Some(if frame.perspective == 0 {
        Seen { w: 1.0, slant: 1.0, ..seen }
    } else if seen.w < frame.near {
        Seen { w: frame.near, slant: frame.slant, low: [-3.0e38; 2], high: [3.0e38; 2] }
    } else {
        Seen { slant: (1.0 + steepest).sqrt().min(frame.slant), ..seen }
    })
}

/// A lower bound of `W` for the points `p` with `low <= n . p <= high` that a perspective picture, `margin` pixels
/// wider, shows; 0 if the eye is among them. Derived in `glsl/include/view.glsl`.
pub fn nearest_in_slab(view: &View, frame: &Frame, n: [f32; 3], (low, high): (f32, f32), margin: f32) -> f32 {
    let [x, y, w] = [view.x, view.y, view.w];
    let cross =
        |a: [f32; 4], b: [f32; 4]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let (yw, wx, xy) = (cross(y, w), cross(w, x), cross(x, y));
    let det = x[0] * yw[0] + x[1] * yw[1] + x[2] * yw[2];
    let [a, b, c] = [yw, wx, xy].map(|m| (n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) / det);
    let eye = [a * x[3], b * y[3], c * w[3]];
    let off = eye[0] + eye[1] + eye[2];
    let rounding = SLAB_ROUNDING * (eye[0].abs() + eye[1].abs() + eye[2].abs() + low.abs().max(high.abs()));
    let before = low + off - rounding;
    let behind = -(high + off) - rounding;
    let gap = before.max(behind);
    if gap <= 0.0 {
        return 0.0;
    }
    let side = if before > 0.0 { 1.0 } else { -1.0 };
    let most = [side * a, side * b].map(|slope| slope * -margin);
    let most = std::array::from_fn::<f32, 2, _>(|k| most[k].max(side * [a, b][k] * (frame.size[k] + margin)));
    let straight = side * c;
    let steepest = straight + most[0] + most[1];
    let slack = SLAB_ROUNDING * (straight.abs() + most[0].abs() + most[1].abs());
    if steepest + slack > 0.0 { gap / (steepest + slack) } else { 0.0 }
}

/// Whether the centre of a pixel is within `margin` pixels of the visible box.
pub fn covers_a_centre(seen: &Seen, margin: f32) -> bool {
    let reach = margin + PIXEL_ROUNDING;
    (0..2).all(|a| (seen.low[a] - reach - 0.5).ceil() <= (seen.high[a] + reach - 0.5).floor())
}

/// Most pixels that one part unit of a visible surface covers; derived in [`factor`](super::factor).
pub fn pixels_per_unit(frame: &Frame, instance: &Instance, seen: &Seen) -> f32 {
    frame.focal * seen.slant * instance.scale / seen.w
}

/// The depth beyond which a face is not drawn; faces of operands are drawn at any depth.
pub fn far_of(face: &Face, frame: &Frame) -> f32 {
    if face.flags & FACE_OPERAND != 0 { 3.0e38 } else { frame.far }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::Random;
    use glam::{DMat3, DVec3};

    const SIZE: [f32; 2] = [640.0, 360.0];

    /// A camera of this focal length in pixels near the origin: its rows, axes and eye.
    fn camera(random: &mut Random, focal: f64) -> (View, DMat3, DVec3) {
        let mut next = || random.range(-1.0, 1.0);
        let forward = DVec3::new(next(), next(), next()).normalize();
        let eye = DVec3::new(next(), next(), next()) * 3.0;
        let right = forward.any_orthonormal_vector();
        let down = forward.cross(right);
        let middle = [0, 1].map(|k: usize| 0.5 * f64::from(SIZE[k]));
        let row = |d: DVec3| d.extend(-d.dot(eye)).as_vec4().to_array();
        let view = View {
            x: row(right * focal + forward * middle[0]),
            y: row(down * focal + forward * middle[1]),
            depth: row(forward),
            w: row(forward),
        };
        (view, DMat3::from_cols(right, down, forward), eye)
    }

    /// No visible point of a slab is nearer than the bound, and the plane nearest to the eye almost attains it.
    #[test]
    fn a_slab_is_no_nearer_than_its_bound() {
        let mut random = Random::new(7);
        let frame = Frame { size: SIZE, perspective: 1, ..Frame::default() };
        let (mut bounded, mut reached) = (0, 0);
        for _ in 0..20_000 {
            let focal = 400.0;
            let (view, axes, eye) = camera(&mut random, focal);
            let mut next = || random.range(-1.0, 1.0);
            let n = DVec3::new(next(), next(), next());
            let n = (n / n.abs().element_sum()).as_vec3().to_array();
            let (middle, half) = (2.0 * next(), 0.1 * next().abs());
            let (low, high) = ((middle - half) as f32, (middle + half) as f32);
            let bound = f64::from(nearest_in_slab(&view, &frame, n, (low, high), 2.0));
            // the near side, at the picture's corners and its middle; linear in between
            let normal = DVec3::from_array(n.map(f64::from));
            let from = normal.dot(eye);
            if f64::from(low) <= from && from <= f64::from(high) {
                assert_eq!(bound, 0.0);
                continue;
            }
            let side = f64::from(if from < f64::from(low) { low } else { high });
            let pixels = [(-2.0, -2.0), (642.0, -2.0), (-2.0, 362.0), (642.0, 362.0), (320.0, 180.0)];
            let depths = pixels.map(|(x, y): (f64, f64)| {
                let ray = axes * DVec3::new((x - 320.0) / focal, (y - 180.0) / focal, 1.0);
                (side - from) / normal.dot(ray)
            });
            let nearest = depths.into_iter().filter(|w| *w > 0.0).fold(f64::INFINITY, f64::min);
            assert!(bound <= nearest, "{bound} and {nearest}");
            bounded += u32::from(bound > 0.0);
            reached += u32::from(bound > 0.99 * nearest);
        }
        assert!(bounded > 8_000 && reached * 10 > bounded * 9, "{bounded}, {reached}");
    }
}
