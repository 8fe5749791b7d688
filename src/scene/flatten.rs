//! Splits surfaces into patches flat enough for tight boxes, and even enough for equal segments.
//!
//! ```text
//!   quarter circle, one patch        three patches
//!   ┌────────────╮                   ┌──╮ ╲
//!   │            ╰─╮                 └──╯──┐ ╲     the eye lies in the box of the whole arc, which might be
//!   │    ·eye      ╰╮                ·eye  │__│    arbitrarily near; the three boxes do not contain it
//!   └───────────────┘
//! ```

use crate::model::Face;
use crate::spline::{Patch, PatchGrid, SurfacePatch};
use glam::DVec4;

/// A patch is split if its border curves bulge by more than this share of their length. Tight boxes decide better
/// whether the patch is visible, how near it comes, and whether a trim curve meets it. At 1/50 a quarter circle falls
/// into three.
const MOST_BULGE: f64 = 0.02;
/// Most pieces along each parameter for flatness: each costs a patch of 64 bytes and its control points.
const MOST_PIECES: usize = 4;
/// Pieces are halved along a parameter while their weights differ by more than this factor. Large ratios concentrate
/// most of the patch in a small part of its parameters, and equal segments that suffice there are too many: a ratio of
/// 1000:1 on a patch of 100 pixels would need 17,000. A turn by 120 degrees has 2:1.
const MOST_WEIGHTS: f64 = 8.0;
/// Most halvings for weights; a ratio of 2^20:1 needs fewer.
const MOST_HALVINGS: u32 = 20;

/// The numbers of pieces into which patches may be split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cuts {
    /// Any number.
    Any,
    /// One, two or four. Faces that meet along a side must be split at halves of it: see [`link`](super::link).
    Halves,
}

impl Cuts {
    /// For faces that may meet along sides: two or more without trims.
    pub(crate) fn of<'a>(faces: impl IntoIterator<Item = &'a Face>) -> Self {
        if faces.into_iter().filter(|f| f.loops.is_empty()).nth(1).is_some() { Self::Halves } else { Self::Any }
    }

    /// For one of these faces.
    pub(crate) fn in_face(self, face: &Face) -> Self {
        if face.loops.is_empty() { self } else { Self::Any }
    }
}

/// The grid with every patch split alike into flatter ones.
pub(crate) fn flattened(grid: PatchGrid, cuts: Cuts) -> PatchGrid {
    let pieces = |bend: f64, speed: f64| {
        let bulge = bend / 8.0 / speed.max(f64::MIN_POSITIVE);
        let pieces = ((bulge / MOST_BULGE).sqrt().ceil() as usize).clamp(1, MOST_PIECES);
        if cuts == Cuts::Halves { pieces.next_power_of_two() } else { pieces }
    };
    let (ku, kv) = grid.patches.iter().fold((1, 1), |(ku, kv), p| {
        let b = p.patch.derivative_bound();
        (ku.max(pieces(b.uu, b.u)), kv.max(pieces(b.vv, b.v)))
    });
    let uneven = |p: &&SurfacePatch| !p.patch.is_polynomial();
    let column = |i: usize| {
        let column = grid.patches[i..].iter().step_by(grid.count_u).filter(uneven);
        column.map(|p| p.patch.clone()).collect::<Vec<_>>()
    };
    let row = |j: usize| {
        let row = grid.patches[j * grid.count_u..(j + 1) * grid.count_u].iter().filter(uneven);
        row.map(|p| p.patch.transposed()).collect::<Vec<_>>()
    };
    let across: Vec<_> = (0..grid.count_u).map(|i| ends(ku, &column(i))).collect();
    let up: Vec<_> = (0..grid.count_v).map(|j| ends(kv, &row(j))).collect();
    divided(grid, &[across, up])
}

/// The grid split at these places, 0 to 1 of each column along u and of each row along v.
pub(super) fn divided(grid: PatchGrid, [across, up]: &[Vec<Vec<f64>>; 2]) -> PatchGrid {
    let pieces = |ends: &[Vec<f64>]| -> Vec<(usize, (f64, f64))> {
        let of = |(i, ends): (usize, &Vec<f64>)| ends.windows(2).map(|w| (i, (w[0], w[1]))).collect::<Vec<_>>();
        ends.iter().enumerate().flat_map(of).collect()
    };
    let (across, up) = (pieces(across), pieces(up));
    let (count_u, count_v) = (across.len(), up.len());
    if (count_u, count_v) == (grid.count_u, grid.count_v) {
        return grid;
    }
    let at = |(a, b): (f64, f64), t: f64| if t >= 1.0 { b } else { a + (b - a) * t };
    let mut patches = Vec::with_capacity(count_u * count_v);
    for &(j, v) in &up {
        for &(i, u) in &across {
            let p = &grid.patches[j * grid.count_u + i];
            patches.push(SurfacePatch {
                u: (at(p.u, u.0), at(p.u, u.1)),
                v: (at(p.v, v.0), at(p.v, v.1)),
                patch: p.patch.rectangle(u, v),
            });
        }
    }
    weld(&mut patches, count_u, count_v);
    PatchGrid::new(count_u, patches)
}

/// The ends, along u, of the pieces of these patches, which share one knot span: `equal` equal pieces, halved where
/// weights differ by too much.
fn ends(equal: usize, patches: &[Patch]) -> Vec<f64> {
    let mut ends = vec![0.0];
    for k in 0..equal {
        // a stack of the remaining parts: the end of each, and how often it was halved
        let mut parts = vec![((k + 1) as f64 / equal as f64, 0)];
        while let Some((end, halvings)) = parts.pop() {
            let start = ends[ends.len() - 1];
            let uneven = |p: &Patch| weights_along_u(&p.rectangle((start, end), (0.0, 1.0))) > MOST_WEIGHTS;
            if halvings < MOST_HALVINGS && patches.iter().any(uneven) {
                parts.extend([(end, halvings + 1), (start + (end - start) / 2.0, halvings + 1)]);
            } else {
                ends.push(end);
            }
        }
    }
    ends
}

/// The largest ratio of weights within a row of control points.
fn weights_along_u(patch: &Patch) -> f64 {
    let ratio = |row: &[DVec4]| {
        let (lo, hi) = row.iter().fold((f64::INFINITY, 0.0f64), |(lo, hi), p| (lo.min(p.w), hi.max(p.w)));
        hi / lo
    };
    (0..=patch.degree_v).map(|j| ratio(patch.row(j))).fold(1.0, f64::max)
}

/// Two adjacent pieces compute their common side from different ends, with different roundings. Each takes the control
/// points of the piece before it, so that neighbours agree bit for bit.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Surface;

    /// Two quarter arcs with a wavy generator: the surface is split in both directions.
    fn bent() -> Surface {
        let w = std::f64::consts::FRAC_1_SQRT_2;
        let arcs = [(1.0, 0.0, 1.0), (1.0, 1.0, w), (0.0, 1.0, 1.0), (-1.0, 1.0, w), (-1.0, 0.0, 1.0)];
        let waves = [(0.0, 1.0), (0.4, 2.0), (0.9, 0.3)];
        let net = waves.iter().flat_map(|&(z, r)| arcs.map(|(x, y, w)| DVec4::new(x * r * w, y * r * w, z * w, w)));
        let knots_u = vec![0.0, 0.0, 0.0, 0.7, 0.7, 1.9, 1.9, 1.9];
        Surface::new((2, 2), knots_u, vec![-1.0, -1.0, -1.0, 2.0, 2.0, 2.0], net.collect()).unwrap()
    }

    #[test]
    fn pieces_tile_the_domain_and_share_their_sides_bit_for_bit() {
        let surface = bent();
        let grid = flattened(surface.patches(), Cuts::Any);
        let ((u0, u1), (v0, v1)) = surface.domain();
        assert!(grid.count_u > 2 && grid.count_v > 1, "{} x {}", grid.count_u, grid.count_v);
        for (n, p) in grid.patches.iter().enumerate() {
            let (i, j) = (n % grid.count_u, n / grid.count_u);
            let right = (i + 1 < grid.count_u).then(|| &grid.patches[n + 1]);
            let above = (j + 1 < grid.count_v).then(|| &grid.patches[n + grid.count_u]);
            assert_eq!(p.u.1, right.map_or(u1, |r| r.u.0));
            assert_eq!(p.v.1, above.map_or(v1, |a| a.v.0));
            assert!((i > 0 || p.u.0 == u0) && (j > 0 || p.v.0 == v0));
            let (n, k) = (p.patch.degree_u, p.patch.degree_v);
            if let Some(r) = right {
                (0..=k).for_each(|row| assert_eq!(p.patch.row(row)[n], r.patch.row(row)[0]));
            }
            if let Some(a) = above {
                assert_eq!(p.patch.row(k), a.patch.row(0));
            }
            // the surface has not changed: 1e-14 is some tens of roundings of coordinates below 2
            let middle = surface.jet((p.u.0 + p.u.1) / 2.0, (p.v.0 + p.v.1) / 2.0).point;
            assert!(p.patch.point(0.5, 0.5).distance(middle) < 1e-14);
        }
    }

    #[test]
    fn a_flat_patch_stays_whole() {
        let corner = |x: f64, y: f64| DVec4::new(x, y, 0.0, 1.0);
        let net = vec![corner(0.0, 0.0), corner(2.0, 0.0), corner(0.0, 3.0), corner(2.0, 3.0)];
        let plane = Surface::new((1, 1), vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0], net).unwrap();
        assert_eq!(flattened(plane.patches(), Cuts::Any), plane.patches());
    }
}
