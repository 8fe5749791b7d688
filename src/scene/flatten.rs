//! Surfaces cut into patches flat enough for their boxes to mean something.
//!
//! ```text
//!   quarter circle, one patch        three patches
//!   ┌────────────╮                   ┌──╮ ╲
//!   │            ╰─╮                 └──╯──┐ ╲     an eye beside the arc lies in the one box, so the
//!   │    ·eye      ╰╮                ·eye  │__│    arc might touch it; the three are told apart
//!   └───────────────┘
//! ```

use crate::spline::{PatchGrid, SurfacePatch};

/// A patch is cut where its border curves bulge by more than this share of their length: its box then
/// hugs it, and tells what is seen, how near it comes, and whether a trim curve meets it. At 1/50 a
/// quarter circle falls into three.
const MOST_BULGE: f64 = 0.02;
/// Pieces along each parameter, at most: each costs a patch of 64 bytes and its control points.
const MOST_PIECES: usize = 4;

/// The grid with all its patches cut alike into flatter ones.
pub(super) fn flattened(grid: PatchGrid) -> PatchGrid {
    let pieces = |bend: f64, speed: f64| {
        let bulge = bend / 8.0 / speed.max(f64::MIN_POSITIVE);
        ((bulge / MOST_BULGE).sqrt().ceil() as usize).clamp(1, MOST_PIECES)
    };
    let (ku, kv) = grid.patches.iter().fold((1, 1), |(ku, kv), p| {
        let b = p.patch.derivative_bound();
        (ku.max(pieces(b.uu, b.u)), kv.max(pieces(b.vv, b.v)))
    });
    if (ku, kv) == (1, 1) {
        return grid;
    }
    let (count_u, count_v) = (grid.count_u * ku, grid.count_v * kv);
    // halving a side by the same rule in both neighbours keeps their shared control points the same
    let range = |i: usize, n: usize| (i as f64 / n as f64, (i + 1) as f64 / n as f64);
    let at = |(a, b): (f64, f64), t: f64| if t >= 1.0 { b } else { a + (b - a) * t };
    let mut patches = Vec::with_capacity(count_u * count_v);
    for j in 0..count_v {
        for i in 0..count_u {
            let p = &grid.patches[j / kv * grid.count_u + i / ku];
            let (u, v) = (range(i % ku, ku), range(j % kv, kv));
            patches.push(SurfacePatch {
                u: (at(p.u, u.0), at(p.u, u.1)),
                v: (at(p.v, v.0), at(p.v, v.1)),
                patch: p.patch.rectangle(u, v),
            });
        }
    }
    weld(&mut patches, count_u, count_v);
    PatchGrid { count_u, count_v, patches }
}

/// Neighbours get the same control points along the side that they share, bit for bit: those of the
/// patch before. A rational point is the same whatever the scale of its side, so the sides stand in
/// their own weights.
fn weld(patches: &mut [SurfacePatch], count_u: usize, count_v: usize) {
    for j in 0..count_v {
        for i in 0..count_u {
            let here = j * count_u + i;
            if i > 0 {
                let before = patches[here - 1].patch.clone();
                let (n, patch) = (before.degree_u, &mut patches[here].patch);
                (0..=patch.degree_v).for_each(|r| patch.points[r * (n + 1)] = before.points[r * (n + 1) + n]);
            }
            if j > 0 {
                let before = patches[here - count_u].patch.clone();
                let (n, k) = (before.degree_u + 1, before.degree_v);
                patches[here].patch.points[..n].copy_from_slice(&before.points[k * n..]);
            }
        }
    }
}
