//! Twin of the pass [`split`](crate::passes): one number of segments per shared side, and as many
//! sub-patches as keep every number within the hardware's limit.
//!
//! ```text
//!    side v = 1:  high.u segments            splits      power of two: the largest factor of the patch and
//!    ┌───────────┬───────────┐                           of its two neighbours across, over 64
//!    │           │           │  side         inner       own factor
//!    ├───────────┼───────────┤  u = 1:       low, high   the larger factor of the two that share the side;
//!    │           │           │  high.v                   the inner one where nobody else is drawn
//!    └───────────┴───────────┘               each rounded up to the larger splits of those concerned
//!    side v = 0:  low.u segments
//! ```
//!
//! Both patches at a side see the same four factors around it, so they agree without talking; splits
//! are powers of two, so the larger is a multiple of the smaller; 64 splits is a multiple of every
//! split count, so rounding up never exceeds 64 segments in a sub-patch.
//!
//! Where a side is shared, interior and sides get powers of two. The tessellator joins a side of `n`
//! segments to an interior of `m` by triangles whose extent along the side is for it to choose, and the
//! bound of [`factor`](super::factor) holds for extents up to `1 / m`. Measured (`tests/gpu/transition.rs`):
//! of all pairs up to 64 the powers of two keep to it; 13 and 16 reach 1.7 times as far, 48 and 64 five
//! times, with up to 25 times the deviation. It costs a third more segments along the axis on average, a
//! patch without neighbours along it nothing.

use super::{MAX_FACTOR, MAX_SPLIT, Scene};
use crate::abi::{FACE_CLOSED_U, FACE_CLOSED_V, Face, Factors, Frame, Side};

/// What the pass writes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Split {
    /// Per item.
    pub factors: Vec<Factors>,
    /// All items as plain, then all as trimmed.
    pub sub_patch_counts: Vec<u32>,
    /// Tessellated vertices, likewise.
    pub vertex_counts: Vec<u32>,
}

/// Decides the segments of each item's sides from the factors of all patches of its face.
pub fn split(frame: &Frame, scene: &Scene<'_>, taus: &[u32]) -> Split {
    let n = frame.item_count as usize;
    let mut out =
        Split { factors: Vec::with_capacity(n), sub_patch_counts: vec![0; 2 * n], vertex_counts: vec![0; 2 * n] };
    for item in 0..n {
        let (placed, face, patch) = scene.item(item);
        let first = placed.first_item as usize;
        let patches = (face.count_u * face.count_v) as usize;
        let (factors, sub_patches, vertices) = patch_factors(&face, &taus[first..first + patches], item - first);
        out.factors.push(factors);
        let slot = if patch.side() == Side::Inside { item } else { n + item };
        out.sub_patch_counts[slot] = sub_patches;
        out.vertex_counts[slot] = vertices;
    }
    out
}

/// Factors, sub-patches and vertices of patch `n` of a face whose patches ask for `taus`.
fn patch_factors(face: &Face, taus: &[u32], n: usize) -> (Factors, u32, u32) {
    let count = [face.count_u as usize, face.count_v as usize];
    let closed = [face.flags & FACE_CLOSED_U != 0, face.flags & FACE_CLOSED_V != 0];
    let place = [n % count[0], n / count[0]];
    // tau along `axis` of the patch `steps` away across that axis; 0 beyond the border
    let tau_at = |axis: usize, steps: i32| {
        let across = 1 - axis;
        let (mut at, n) = (place[across] as i32 + steps, count[across] as i32);
        if at < 0 || at >= n {
            if !closed[across] {
                return 0;
            }
            at = at.rem_euclid(n);
        }
        let mut place = place;
        place[across] = at as usize;
        taus[place[1] * count[0] + place[0]] >> (16 * axis) & 0xffff
    };
    let (mut splits, mut inner, mut low, mut high) = ([0; 2], [0; 2], [0; 2], [0; 2]);
    for axis in 0..2 {
        let t: [u32; 5] = std::array::from_fn(|k| tau_at(axis, k as i32 - 2));
        let [before, own, after] = std::array::from_fn(|k| splits_for(t[k].max(t[k + 1]).max(t[k + 2])));
        splits[axis] = own;
        let asked = t[2].max(1);
        let met = t[1] != 0 || t[3] != 0;
        inner[axis] = if met { asked.next_power_of_two() } else { asked }.next_multiple_of(own);
        let side = |other: u32, splits: u32| match other {
            0 => inner[axis],
            tau => tau.max(asked).next_power_of_two().max(splits.max(own)),
        };
        (low[axis], high[axis]) = (side(t[1], before), side(t[3], after));
    }
    let most: [u32; 2] = std::array::from_fn(|a| inner[a].max(low[a]).max(high[a]) / splits[a]);
    let sub_patches = if taus[n] != 0 { splits[0] * splits[1] } else { 0 };
    let pack = |[a, b]: [u32; 2]| a | b << 16;
    let factors = Factors {
        inner: pack(inner),
        edge_u: pack([low[0], high[0]]),
        edge_v: pack([low[1], high[1]]),
        splits: pack(splits),
    };
    (factors, sub_patches, sub_patches * (most[0] + 1) * (most[1] + 1))
}

/// Sub-patches that keep `most` segments within [`MAX_FACTOR`] each.
fn splits_for(most: u32) -> u32 {
    most.div_ceil(MAX_FACTOR).max(1).next_power_of_two().min(MAX_SPLIT)
}

#[cfg(test)]
mod properties;
