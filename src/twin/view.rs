//! Twin of `glsl/include/view.glsl`: from part coordinates to the picture.
//!
//! ```text
//!        (X, Y)        pixel = (X, Y) / W          a box is outside when all 8 corners are on the
//!   p ─▶   D     ─▶    depth = D                   outer side of one of the picture's 6 planes,
//!          W           W = D, or 1 if parallel     the planes widened by `margin` pixels
//! ```
//!
//! The planes are linear in `(X, Y, D, W)`, so the test also holds for corners behind the eye.

use crate::abi::{Frame, Instance, View};

fn row_times(row: [f32; 4], p: [f32; 4]) -> f32 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] * p[3]
}

/// Homogeneous pixels `(X, Y, D, W)` of a homogeneous point in part coordinates.
pub fn to_pixel(view: &View, p: [f32; 4]) -> [f32; 4] {
    [row_times(view.x, p), row_times(view.y, p), row_times(view.depth, p), row_times(view.w, p)]
}

/// A box as the picture sees it.
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

/// The box `lo..hi` (part coordinates) in the picture widened by `margin` pixels; `None` when no part of it can be
/// seen.
///
/// Conservative: a box that passes may still be out of sight, near a corner of the picture. Pixel and slope are quotients
/// of linear functions, so corners have the largest ones where all are in front of the eye; where one is not, the
/// picture's slant and no limits stand.
pub fn see(view: &View, frame: &Frame, lo: [f32; 3], hi: [f32; 3], margin: f32) -> Option<Seen> {
    let mut seen = Seen { w: 3.0e38, slant: 0.0, low: [3.0e38; 2], high: [-3.0e38; 2] };
    let mut steepest = 0.0f32;
    let mut outside = 63u32;
    for corner in 0..8u32 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { lo[axis] } else { hi[axis] };
        let [x, y, depth, w] = to_pixel(view, [pick(0), pick(1), pick(2), 1.0]);
        seen.w = seen.w.min(w);
        let pixel = [x / w, y / w];
        let slope = std::array::from_fn::<f32, 2, _>(|a| (pixel[a] - 0.5 * frame.size[a]) / frame.focal);
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
            depth > frame.far,
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

/// Rounding of a vertex' pixel; far above that of single precision for pictures up to 16384 pixels.
const PIXEL_ROUNDING: f32 = 0.015625;

/// Whether the centre of a pixel is within `margin` pixels of what is seen.
pub fn covers_a_centre(seen: &Seen, margin: f32) -> bool {
    let reach = margin + PIXEL_ROUNDING;
    (0..2).all(|a| (seen.low[a] - reach - 0.5).ceil() <= (seen.high[a] + reach - 0.5).floor())
}

/// Pixels that one part unit of what is seen can cover; derived in [`factor`](super::factor).
pub fn pixels_per_unit(frame: &Frame, instance: &Instance, seen: &Seen) -> f32 {
    frame.focal * seen.slant * instance.scale / seen.w
}
