//! Twin of the pass `split`: one number of segments for each shared side, and enough sub-patches that no number exceeds
//! the hardware's limit.
//!
//! ```text
//!    side v = 1:  high.u segments            splits      power of two: the largest factor of the patch and
//!    ┌───────────┬───────────┐                           of its two neighbours across, over 64
//!    │           │           │  side         inner       own factor
//!    ├───────────┼───────────┤  u = 1:       low, high   the larger factor of the two that share the side;
//!    │           │           │  high.v                   the inner one if no other patch is drawn there
//!    └───────────┴───────────┘               each rounded up to the larger splits of those patches
//!    side v = 0:  low.u segments
//! ```
//!
//! If faces share sides ([`Link`](crate::abi::Link)), all sides on one curve get numbers of segments of the whole
//! curve: a side that is a quarter of it gets a quarter. A patch with a side beside far shorter ones may need more than
//! 64 sub-patches; then the side gets as many segments as 64 allow, and a crack narrower than the deviation may remain.
//!
//! Both patches at a side use the same four factors around it, so they get the same result independently. Splits are
//! powers of two, so the larger is a multiple of the smaller. 64 is a multiple of every number of splits, so rounding
//! up never exceeds 64 segments in a sub-patch.
//!
//! If a side is shared, the interior and the sides get powers of two. The tessellator joins a side of `n` segments to
//! an interior of `m` by triangles whose extent along the side it may choose, and the bound of
//! [`factor`](super::factor) holds for extents up to `1 / m`. Powers of two stay within it, and other pairs may exceed
//! it several times (`tests/gpu/transition.rs`). They cost more segments along the axis; a patch without neighbours
//! along the axis is not affected.

use super::occlusion::is_drawn;
use super::{
    CORNER_LIST, CORNER_VERTICES, MAX_FACTOR, MAX_SPLIT, PLAIN_LIST, Scene, TRIMMED_CORNER_LIST, TRIMMED_LIST,
};
use crate::abi::{FACE_CLOSED_U, FACE_CLOSED_V, Factors, Frame, Side};

/// What the pass writes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Split {
    /// One for each patch instance.
    pub factors: Vec<Factors>,
    /// All patch instances as members of the list of plain ones, then of the others: each is a member of one list.
    pub sub_patch_counts: Vec<u32>,
    /// Vertices, likewise.
    pub vertex_counts: Vec<u32>,
}

/// Decides the segments of each patch instance's sides from the factors of all patches of its part.
pub fn split(frame: &Frame, scene: &Scene<'_>, taus: &[u32]) -> Split {
    let n = frame.listed_patch_instances as usize;
    let empty = vec![0; frame.patch_lists() as usize * n];
    let mut out = Split { factors: Vec::with_capacity(n), sub_patch_counts: empty.clone(), vertex_counts: empty };
    for patch_instance in 0..n {
        let (placed, face, patch) = scene.patch_instance(patch_instance);
        let part =
            Part { scene, taus, first_patch_instance: placed.first_patch_instance, first_patch: face.first_patch };
        let (factors, sub_patches, vertices) = part.patch_factors(
            face.first_patch + patch_instance as u32 - placed.first_patch_instance,
            is_drawn(taus[patch_instance]),
        );
        out.factors.push(factors);
        let (list, by_corners) = match patch.side() {
            Side::Inside => (PLAIN_LIST, CORNER_LIST),
            Side::Outside | Side::Boundary => (TRIMMED_LIST, TRIMMED_CORNER_LIST),
        };
        let (list, vertices) = match by_corners < frame.patch_lists() && is_one_cell(&factors) {
            true => (by_corners, CORNER_VERTICES * sub_patches),
            false => (list, vertices),
        };
        let slot = list as usize * n + patch_instance;
        out.sub_patch_counts[slot] = sub_patches;
        out.vertex_counts[slot] = vertices;
    }
    out
}

/// A placed part; its patch instances have the order of its patches.
struct Part<'a> {
    scene: &'a Scene<'a>,
    taus: &'a [u32],
    /// First patch instance of one of its faces.
    first_patch_instance: u32,
    first_patch: u32,
}

impl Part<'_> {
    fn tau(&self, patch: u32, axis: u32) -> u32 {
        self.taus[(self.first_patch_instance + patch - self.first_patch) as usize] >> (16 * axis) & 0x7fff
    }

    /// The patch of the same face beyond a side: 0 to 3 for `u = 0`, `v = 0`, `u = 1`, `v = 1`.
    fn beyond(&self, patch: u32, side: u32) -> Option<u32> {
        let face = &self.scene.faces[self.scene.patches[patch as usize].face as usize];
        let (count, across) = ([face.count_u, face.count_v], (side & 1) as usize);
        let n = patch - face.first_patch;
        let mut place = [n % count[0], n / count[0]];
        let closed = face.flags & [FACE_CLOSED_U, FACE_CLOSED_V][across] != 0;
        let border = if side < 2 { place[across] == 0 } else { place[across] + 1 == count[across] };
        place[across] = (place[across] + if side < 2 { count[across] - 1 } else { 1 }) % count[across];
        (!border || closed).then(|| face.first_patch + place[1] * count[0] + place[0])
    }

    /// The other sides that share this one, with their halvings on the ring's curve; and the halvings of this side.
    fn ring(&self, patch: u32, side: u32) -> (Vec<(u32, u32, u32)>, u32) {
        let name = 4 * patch + side;
        let link = |name: u32| self.scene.links.get(name as usize).copied().unwrap_or_default();
        let own = link(name);
        let mut others = Vec::new();
        let mut at = own.next;
        while own.is_shared() && at != name {
            others.push((at / 4, at % 4, link(at).halvings()));
            at = link(at).next;
        }
        (others, own.halvings())
    }

    /// The largest `value` of the other patches along a side, scaled to the side's length; `least` if there are none.
    fn most_beyond(&self, patch: u32, side: u32, least: u32, value: impl Fn(u32, u32) -> u32) -> u32 {
        match self.beyond(patch, side) {
            Some(beyond) => value(beyond, axis_of(side)),
            None => {
                let (others, halvings) = self.ring(patch, side);
                let of_ring = others.iter().map(|&(patch, side, halvings)| value(patch, axis_of(side)) << halvings);
                of_ring.fold(least, u32::max).div_ceil(1 << halvings)
            }
        }
    }

    /// The largest tau of other patches along a side; 0 if none of them is drawn.
    fn tau_beyond(&self, patch: u32, side: u32) -> u32 {
        self.most_beyond(patch, side, 0, |patch, axis| self.tau(patch, axis))
    }

    fn splits(&self, patch: u32, axis: u32) -> u32 {
        let [low, high] = sides_of(axis).map(|side| self.tau_beyond(patch, side));
        splits_for(self.tau(patch, axis).max(low).max(high))
    }

    /// Factors, sub-patches and vertices.
    fn patch_factors(&self, patch: u32, drawn: bool) -> (Factors, u32, u32) {
        let (mut splits, mut inner, mut low, mut high) = ([0; 2], [0; 2], [0; 2], [0; 2]);
        for axis in 0..2 {
            let (a, tau) = (axis as usize, self.tau(patch, axis));
            let others = sides_of(axis).map(|side| self.tau_beyond(patch, side));
            splits[a] = splits_for(tau.max(others[0]).max(others[1]));
            let asked = tau.max(1);
            inner[a] = if others == [0, 0] { asked } else { asked.next_power_of_two() }.next_multiple_of(splits[a]);
            let side = |side: u32, other: u32| match other {
                0 => inner[a],
                tau => {
                    let of_drawn = |p, axis| if self.tau(p, axis) == 0 { 0 } else { self.splits(p, axis) };
                    let others_splits = self.most_beyond(patch, side, 1, of_drawn);
                    let n = tau.max(asked).next_power_of_two().max(others_splits.max(splits[a]));
                    n.min(MAX_FACTOR * splits[a])
                }
            };
            let [at_low, at_high] = sides_of(axis);
            (low[a], high[a]) = (side(at_low, others[0]), side(at_high, others[1]));
        }
        let most = std::array::from_fn(|a| inner[a].max(low[a]).max(high[a]) / splits[a]);
        let sub_patches = if drawn { splits[0] * splits[1] } else { 0 };
        let pack = |[a, b]: [u32; 2]| a | b << 16;
        let factors = Factors {
            inner: pack(inner),
            edge_u: pack([low[0], high[0]]),
            edge_v: pack([low[1], high[1]]),
            splits: pack(splits),
        };
        (factors, sub_patches, sub_patches * vertices(most))
    }
}

/// The patch has one segment a side and one inside: two triangles.
fn is_one_cell(f: &Factors) -> bool {
    [f.inner, f.edge_u, f.edge_v, f.splits] == [1 | 1 << 16; 4]
}

/// The most vertices of a sub-patch with at most these segments along each axis.
fn vertices(most: [u32; 2]) -> u32 {
    // the tessellator makes two segments of one along an axis, unless all numbers are one
    let [u, v] = if most == [1, 1] { most } else { most.map(|n| n.max(2)) };
    (u + 1) * (v + 1)
}

/// The axis along which a side runs.
fn axis_of(side: u32) -> u32 {
    1 - (side & 1)
}

/// The sides along an axis.
fn sides_of(axis: u32) -> [u32; 2] {
    [1 - axis, 3 - axis]
}

/// Sub-patches such that `most` segments are at most [`MAX_FACTOR`] in each.
fn splits_for(most: u32) -> u32 {
    most.div_ceil(MAX_FACTOR).max(1).next_power_of_two().min(MAX_SPLIT)
}

#[cfg(test)]
mod properties;
