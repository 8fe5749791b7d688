//! Twin of `glsl/include/view.glsl`: from part coordinates to the picture.
//!
//! ```text
//!        (X, Y)        pixel = (X, Y) / W          a box is outside when all 8 corners are on the
//!   p ─▶   D     ─▶    depth = D                   outer side of one of the picture's 6 planes,
//!          W           W = D, or 1 if parallel     the planes widened by `margin` pixels
//! ```
//!
//! The planes are linear in `(X, Y, D, W)`, so the test also holds for corners behind the eye.

use crate::abi::{FACE_OPERAND, Face, Frame, Instance, View};

fn row_times(row: [f32; 4], p: [f32; 4]) -> f32 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] * p[3]
}

/// Homogeneous pixels `(X, Y, D, W)` of a homogeneous point in part coordinates.
pub fn to_pixel(view: &View, p: [f32; 4]) -> [f32; 4] {
    [row_times(view.x, p), row_times(view.y, p), row_times(view.depth, p), row_times(view.w, p)]
}

/// The smallest `W` of the box `lo..hi` (part coordinates) in front of the near plane: 1 in a parallel
/// view. `None` when no part of the box can be seen in the picture widened by `margin` pixels, in front of `far`.
///
/// Conservative: a box that passes may still be out of sight, near a corner of the picture.
pub fn visible_w(view: &View, frame: &Frame, lo: [f32; 3], hi: [f32; 3], margin: f32, far: f32) -> Option<f32> {
    let mut w_min = 3.0e38f32;
    let mut outside = 63u32;
    for corner in 0..8u32 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { lo[axis] } else { hi[axis] };
        let [x, y, depth, w] = to_pixel(view, [pick(0), pick(1), pick(2), 1.0]);
        w_min = w_min.min(w);
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
    (outside == 0).then(|| if frame.perspective != 0 { w_min.max(frame.near) } else { 1.0 })
}

/// Pixels that one part unit can cover at homogeneous weight `w`; derived in [`factor`](super::factor).
pub fn pixels_per_unit(frame: &Frame, instance: &Instance, w: f32) -> f32 {
    frame.focal * frame.slant * instance.scale / w
}

/// Depth beyond which a face is not seen: those of operands tell a ray's way to the end.
pub fn far_of(face: &Face, frame: &Frame) -> f32 {
    if face.flags & FACE_OPERAND != 0 { 3.0e38 } else { frame.far }
}
