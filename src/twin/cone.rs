//! Twin of `glsl/include/cone.glsl`: patches of closed parts without trims that are turned away from the viewer.
//!
//! ```text
//!   eye ●─────── ray ───────▶ middle of the box, its corners within `around`
//!                                ╲
//!                                 ╲ axis of the outward normals, which are within θ of it
//!
//!   the whole patch is turned away if   ray · axis >= |ray| sin θ + around
//! ```
//!
//! *Proof.* With `φ` between ray and axis, a normal `n` and a point `p` of the patch,
//! `n · (p - eye) >= |ray| cos(φ + θ) - around`, and `cos(φ + θ) >= cos φ - sin θ` for `φ <= 90° - θ`.
//!
//! Nearer surfaces of a closed part hide such a patch, unless the near plane cuts them off; so the whole part must lie
//! behind that plane. Trimmed faces have gaps at their borders, and `gap_fill` finds these by the back faces behind
//! them, so patches of trimmed faces are drawn. So are patches of parts whose sides are not all linked
//! (`scene/link.rs`).
//!
//! The eye is the point whose homogeneous pixel is 0. Source: L. A. Shirman, S. S. Abi-Ezzi, *The cone of normals
//! technique
//! for fast processing of curved patches*, Computer Graphics Forum 12, 1993.

use crate::abi::constants::cone::EYE_ROUNDING;
use crate::abi::{Frame, Patch, View};

type Vector = [f32; 3];

fn times(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn across(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn xyz(row: [f32; 4]) -> Vector {
    [row[0], row[1], row[2]]
}

/// Whether the whole patch is turned away. `cone`: the axis of the outward normals, as long as the part's radius, 0
/// without a cone; the sine of half its angle.
pub fn looks_away(view: &View, frame: &Frame, patch: &Patch, cone: [f32; 4]) -> bool {
    let axis = xyz(cone);
    let radius = times(axis, axis).sqrt();
    let [x, y, depth, w] = [view.x, view.y, view.depth, view.w].map(xyz);
    let reach = radius * times(depth, depth).sqrt();
    if radius == 0.0 || view.depth[3] - reach < frame.near {
        return false;
    }
    let xy = across(x, y);
    if frame.perspective == 0 {
        let towards = if times(xy, depth) < 0.0 { -1.0 } else { 1.0 };
        return towards * times(xy, axis) >= radius * cone[3] * times(xy, xy).sqrt();
    }
    let (yw, wx) = (across(y, w), across(w, x));
    let volume = times(x, yw);
    let eye = std::array::from_fn(|k| -(view.x[3] * yw[k] + view.y[3] * wx[k] + view.w[3] * xy[k]) / volume);
    let ray = std::array::from_fn(|k| 0.5 * (patch.box_min[k] + patch.box_max[k]) - eye[k]);
    let half = std::array::from_fn(|k| 0.5 * (patch.box_max[k] - patch.box_min[k]));
    let around = times(half, half).sqrt() + EYE_ROUNDING * times(eye, eye).sqrt();
    times(ray, axis) >= radius * (cone[3] * times(ray, ray).sqrt() + around)
}
