//! Twin of `glsl/include/border_reach.glsl`: how far a sheet's terms of second order reach, and where a face's surface
//! goes on beyond the ends of its domain.
//!
//! The second derivatives are differences of first ones over `h`, [`ASIDE`] of the patch. With `f` for the homogeneous
//! pixel, and along `u` alone:
//!
//! ```text
//!   f_uu ≈ (f_u(h) - f_u(0)) / h = f_uu + h f_uuu / 2 + …        so the terms of second order leave out, at u,
//!                                                                   f_uuu (u³ / 6 - h u² / 4)
//!   f(h) - f(0) - h (f_u(0) + f_u(h)) / 2 = -h³ f_uuu / 12 + …   `end_u`: it tells f_uuu, as the trapezoid's error
//!
//!   f_uv ≈ mean of (f_v(h, 0) - f_v) / h = f_uv + h f_uuv / 2 and (f_u(0, h) - f_u) / h = f_uv + h f_uvv / 2
//!          their difference, h (f_uuv - f_uvv) / 2, is `twist`
//! ```
//!
//! The mixed terms are at most `|u v| (|u| + |v|) / 2` times the larger of `f_uuv` and `f_uvv`, for which their
//! difference stands: at a pole and at a tip, where they matter, one of them is small. Terms of fourth order are left
//! out. So [`remainder_px`] is an estimate: `src/parity/border_reach.rs` compares it with balls, cones and rings.
//!
//! ```text
//!   error on another GPU, whose quotients are off by d = 2.5 * 2^-23 and whose roots by 2 d:
//!     pixels of a change   3 d (|change| + |place| |change of W|) / |W|
//!     third order          the same, times its factor, and 3 d of itself
//! ```

pub use crate::abi::constants::border_reach::{ASIDE, MOST_FROM_MIDDLE, REMAINDER_PX};
use crate::abi::{BORDER_U0, BORDER_U1, BORDER_V0, BORDER_V1, FACE_MEETS_U, FACE_MEETS_V, FACE_POINTS};

/// Factors of [`third_order`]'s sizes.
pub const FACTORS: [f32; 3] = [2.0 / (ASIDE * ASIDE * ASIDE), 2.0 / (ASIDE * ASIDE * ASIDE), 1.0 / ASIDE];

/// A change of a homogeneous pixel, in pixels.
pub fn pixels_of(q: [f32; 4], change: [f32; 4]) -> [f32; 2] {
    std::array::from_fn(|axis| {
        let at = q[axis] / q[3];
        (change[axis] - at * change[3]) / q[3]
    })
}

/// Factors of [`remainder_px`] along u and v, and across, from a sheet's `end_u`, `end_v` and `twist`.
pub fn third_order(q: [f32; 4], [end_u, end_v, twist]: [[f32; 4]; 3]) -> [f32; 3] {
    let changes = [end_u, end_v, twist];
    std::array::from_fn(|k| {
        let [x, y] = pixels_of(q, changes[k]);
        (x * x + y * y).sqrt() * FACTORS[k]
    })
}

/// What the terms of second order leave out on the way to `(u, v)` from the middle, in pixels.
pub fn remainder_px(third: [f32; 3], uv: [f32; 2]) -> f32 {
    let [u, v] = uv.map(f32::abs);
    let alone = |far: f32| far * far * (far + 1.5 * ASIDE);
    third[0] * alone(u) + third[1] * alone(v) + third[2] * (u * v * (u + v))
}

/// Whether the terms of second order hold at `(u, v)` from the middle, which is at `middle` of the patch.
pub fn is_in_reach(third: [f32; 3], middle: [f32; 2], uv: [f32; 2]) -> bool {
    let beside = [0, 1].map(|axis| (middle[axis] + uv[axis] - 0.5).abs());
    remainder_px(third, uv) <= REMAINDER_PX && beside[0].max(beside[1]) <= MOST_FROM_MIDDLE
}

/// Of a place beyond the domain of a face whose sides meet there: the same place, over the seam.
pub fn over_seams(flags: u32, at: [f32; 2]) -> [f32; 2] {
    let meets = [FACE_MEETS_U, FACE_MEETS_V];
    std::array::from_fn(|axis| {
        let is_over = flags & meets[axis] != 0 && !(0.0..=1.0).contains(&at[axis]);
        if is_over { at[axis] - at[axis].floor() } else { at[axis] }
    })
}

/// Whether a place lies beyond a side of the face's surface that is a point.
pub fn is_over_pole(flags: u32, at: [f32; 2]) -> bool {
    let bit = |is_beyond: bool, bit: u32| if is_beyond { bit } else { 0 };
    let sides = bit(at[0] < 0.0, BORDER_U0)
        | bit(at[0] > 1.0, BORDER_U1)
        | bit(at[1] < 0.0, BORDER_V0)
        | bit(at[1] > 1.0, BORDER_V1);
    (flags >> FACE_POINTS) & sides != 0
}
