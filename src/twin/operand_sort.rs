//! Twin of `glsl/solids/operand_sort.comp`: sorts the fragments of each pixel by operand and depth, so that entries and
//! exits alternate.
//!
//! ```text
//!   mesh    E  E     L  L       a counter rises at entries and falls at exits; the ray is within where it is
//!           E  ·     ·  L       not 0
//!
//!   faces   E  ·  L  L          the second L lacks an entry: a skirt's fragment E between the two supplies it, if
//!                 E? L          the ray passes through a gap; otherwise the L is removed. With as many exits as
//!                               entries: as for a mesh
//! ```

use crate::abi::constants::scene::FAILED_FRAGMENTS;
use crate::abi::{
    Counters, FRAGMENT_LEAVES, FRAGMENT_PATCH, FRAGMENT_SKIRT, FRAGMENT_WITHIN, Fragment, Frame, Leaf, TILE,
};

const FLAGS: u32 = FRAGMENT_LEAVES | FRAGMENT_SKIRT | FRAGMENT_PATCH | FRAGMENT_WITHIN;

/// Leaves, their centres relative to the eye, and a leaf of each operand.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryOperands<'a> {
    /// All leaves of the Blist.
    pub leaves: &'a [Leaf],
    /// Centres of their boxes.
    pub centres: &'a [[f32; 3]],
    /// Indices into `leaves`.
    pub operand_leaves: &'a [u32],
}

/// Sorts the fragments of each pixel of a band, and returns the number that stays of each; these come first. Pixel `n`
/// has `starts[n]` to `starts[n + 1]`.
pub fn operand_sort(
    frame: &Frame,
    boundary_operands: BoundaryOperands<'_>,
    starts: &[u32],
    fragments: &mut [Fragment],
    counters: &mut Counters,
) -> Vec<u32> {
    let wanted = starts[starts.len() - 1];
    let counted = starts.is_sorted(); // otherwise the count exceeds 32 bits
    counters.fragments = counters.fragments.wrapping_add(wanted);
    counters.band_fragments = counters.band_fragments.max(if counted { wanted } else { u32::MAX });
    if wanted > frame.fragment_capacity || !counted {
        counters.failed |= FAILED_FRAGMENTS;
    }
    for row in (0..starts.len() - 1).step_by(frame.size[0] as usize * TILE as usize) {
        let next = (row + frame.size[0] as usize * TILE as usize).min(starts.len() - 1);
        counters.row_fragments = counters.row_fragments.max(starts[next].wrapping_sub(starts[row]));
    }
    let pixel = |ends: &[u32]| {
        let end = if ends[1] < ends[0] || ends[1] > frame.fragment_capacity { ends[0] } else { ends[1] };
        if end == ends[0] {
            return 0;
        }
        let here = &mut fragments[ends[0] as usize..end as usize];
        here.sort_by(|a, b| {
            let depth = a.depth.partial_cmp(&b.depth).expect("depths are numbers");
            let rest = (a.what, a.operand, a.uv).cmp(&(b.what, b.operand, b.uv));
            operand_of(a).cmp(&operand_of(b)).then(depth).then(rest)
        });
        let mut kept = Vec::with_capacity(here.len());
        for of_one in here.chunk_by(|a, b| operand_of(a) == operand_of(b)) {
            let cuts = cuts(frame, boundary_operands, operand_of(&of_one[0]));
            let real: Vec<Fragment> = of_one.iter().filter(|f| f.operand & FRAGMENT_SKIRT == 0).copied().collect();
            let sum: i32 = real.iter().map(|f| if leaves(f) { 1 } else { -1 }).sum();
            let number = if cuts.0 { sum } else { 0 };
            let before = kept.len();
            let mended = counters.mended;
            let patches = of_one[0].operand & FRAGMENT_PATCH != 0;
            let turns = if patches {
                in_turn(of_one, cuts.0, &mut kept, counters)
            } else {
                InTurn { closed: false, all: false }
            };
            let mut closed = turns.closed;
            if !patches || (!turns.all && sum == number) {
                // discard the attempt
                kept.truncate(before);
                counters.mended = mended;
                closed = by_winding(&real, number, &mut kept);
            }
            counters.unpaired += u32::from(!closed && !cuts.1);
        }
        here[..kept.len()].copy_from_slice(&kept);
        kept.len() as u32
    };
    starts.windows(2).map(pixel).collect()
}

fn operand_of(f: &Fragment) -> u32 {
    f.operand & !FLAGS
}

fn leaves(f: &Fragment) -> bool {
    f.operand & FRAGMENT_LEAVES != 0
}

/// Whether the near and the far plane cut the box around a boundary operand.
fn cuts(frame: &Frame, boundary_operands: BoundaryOperands<'_>, operand: u32) -> (bool, bool) {
    let leaf = boundary_operands.operand_leaves[operand as usize] as usize;
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let middle = dot(frame.forward, boundary_operands.centres[leaf]);
    let reach = dot(frame.forward.map(f32::abs), boundary_operands.leaves[leaf].half_size);
    (middle - reach < frame.near, middle + reach > frame.far)
}

/// Counts entries and exits, from `number` on; returns whether the count ends with 0.
fn by_winding(all: &[Fragment], mut number: i32, kept: &mut Vec<Fragment>) -> bool {
    let start = if number != 0 { FRAGMENT_WITHIN } else { 0 };
    for group in all.chunk_by(|a, b| a.depth == b.depth) {
        let before = number != 0;
        let mut owner = group[0];
        for f in group {
            number += if leaves(f) { -1 } else { 1 };
            if (number != 0) != before {
                owner = *f;
            }
        }
        if (number != 0) != before {
            let side = if before { FRAGMENT_LEAVES } else { 0 };
            let operand = owner.operand & !FRAGMENT_LEAVES | start | side;
            kept.push(Fragment { operand, ..owner });
        }
    }
    number == 0
}

/// Whether entries and exits alternate, with skirts' fragments at gaps.
struct InTurn {
    /// Only entries are removed, and the ray ends outside.
    closed: bool,
    /// Nothing is removed.
    all: bool,
}

/// For spline faces.
fn in_turn(all: &[Fragment], cut: bool, kept: &mut Vec<Fragment>, counters: &mut Counters) -> InTurn {
    let first = all.iter().find(|f| f.operand & FRAGMENT_SKIRT == 0);
    let mut within = cut && first.is_some_and(leaves);
    let start = if within { FRAGMENT_WITHIN } else { 0 };
    let mut skirts: [Option<Fragment>; 2] = [None; 2]; // entry, exit
    let mut lost = [false; 2]; // entry, exit
    let mut mend = |skirt: Fragment, kept: &mut Vec<Fragment>| {
        kept.push(Fragment { operand: skirt.operand & !FRAGMENT_SKIRT | start, ..skirt });
        counters.mended += 1;
    };
    for f in all {
        let kind = usize::from(leaves(f));
        if f.operand & FRAGMENT_SKIRT != 0 {
            skirts[kind].get_or_insert(*f);
            continue;
        }
        if leaves(f) != within {
            match skirts[1 - kind] {
                Some(skirt) => mend(skirt, kept),
                None => {
                    lost[kind] = true;
                    continue;
                }
            }
        }
        within = !leaves(f);
        skirts = [None; 2];
        kept.push(Fragment { operand: f.operand | start, ..*f });
    }
    if let (true, Some(skirt)) = (within, skirts[1]) {
        mend(skirt, kept);
        within = false;
    }
    InTurn { closed: !within && !lost[1], all: !within && lost == [false; 2] }
}
