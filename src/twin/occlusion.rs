//! Twin of the passes `cull_early`, `depth_pyramid` and `cull_late`, and of `glsl/include/behind.glsl` and
//! `nearer.glsl`: finds the patches that are hidden behind the surfaces drawn so far.
//!
//! ```text
//!        eye
//!         │      a cell's triangles lie within `off` of the bilinear surface through its corners, so within
//!     ▁▁▁▁▼▁▁▁▁  the corners' pixels and `off` more, and not nearer than the nearest corner less `off`:
//!       front    if the front is nearer in all of these pixels, nothing of the cell passes the depth test
//!     ┌───────┐
//!     │ cell  │
//!     └───────┘
//! ```
//!
//! **Triangles.** With the patch's bend `a`, `b`, `c` ([`factor`](super::factor)), let `E(s) = (a s_u² + 2 b s_u s_v +
//! c s_v²) / 8`. A triangle's point at `(u, v)` is within `E(1 / τ)` of the surface there. The surface of a cell of
//! sides `s` is within `E(s)` of the bilinear surface through its corners. A bilinear point is a mean of the corners:
//! its depth lies between theirs, and its pixel, a quotient of linear functions, within theirs.
//!
//! **Borders.** Pass `visibility` pushes skirts along the tangent by at most a segment, and by at most twice the gap
//! radius across the border: `s + p` is within `4 E(p)` of `s + p S_u`. Along the border the tangent turns by at most
//! `|S_uv| <= b + sqrt(a c)`: the form along `(s, 1 / s)` less that along `(s, -1 / s)` is 4 S_uv. The push in units of
//! u depends on the place; here it is computed at the cell's corners and doubled. For faces with cells that are left
//! out ([`is_outside`]), all sides of a cell count as borders.
//!
//! **A fragment that fails the depth test changes neither visibility nor depth.** Fronts are moved back, never forward,
//! so they are not nearer than this bound. A skirt stores its depth without a depth test. Each pixel has the nearest
//! one of its skirts, and pass `gap_find` compares it with the visible surface, so a skirt behind that surface does not
//! count. `docs/design/culling.md` has the two exceptions.
//!
//! Rounding is covered by a pixel on each side, and by `DEPTH_ROUNDING` of the depth.

use super::{MAX_PUSH, Scene};
use crate::abi::constants::behind::{self, MOST_CELLS};
use crate::abi::constants::nearer::MOST_SQUARES;
pub use crate::abi::constants::scene::TAU_HIDDEN;
use crate::abi::{self, BLOCK, Frame, OUTSIDE_CELLS, Side, TILE, square_side};
use crate::spline::Patch;
use glam::{DVec2, DVec3, DVec4};
use std::ops::RangeInclusive;

/// Approximate size of a cell along each parameter, in pixels.
const CELL_PX: f64 = behind::CELL_PX as f64;
/// Rounding of depths that the rasteriser interpolates.
const DEPTH_ROUNDING: f64 = behind::DEPTH_ROUNDING as f64;
/// Factor by which skirts may be pushed farther between a cell's corners than at them.
const PUSH_SLACK: f64 = behind::PUSH_SLACK as f64;

/// Whether a patch with these taus is drawn now.
pub fn is_drawn(tau: u32) -> bool {
    tau != 0 && tau & TAU_HIDDEN == 0
}

/// Marks patches that were `hidden`; returns the number of marks.
pub fn cull_early(hidden: &[u32], taus: &mut [u32]) -> u32 {
    let mut marked = 0;
    for (tau, _) in taus.iter_mut().zip(hidden).filter(|(tau, was_hidden)| **tau != 0 && **was_hidden != 0) {
        *tau |= TAU_HIDDEN;
        marked += 1;
    }
    marked
}

/// The result of pass `cull_late` for a patch: its taus, whether it is hidden, and whether it appears.
pub fn cull_late(tau: u32, lies_behind: bool) -> (u32, u32, bool) {
    let appears = tau & TAU_HIDDEN != 0 && !lies_behind;
    let marked = if appears { tau & !TAU_HIDDEN } else { tau | TAU_HIDDEN };
    if tau == 0 { (0, 0, false) } else { (marked, u32::from(lies_behind), appears) }
}

/// The farthest depths of a picture, reversed.
#[derive(Clone, Debug, PartialEq)]
pub struct Farthest {
    size: [u32; 2],
    /// Depths of squares of [`square_side`] pixels a side, row by row, then of tiles, then of blocks of tiles.
    pub depths: Vec<f32>,
}

impl Farthest {
    /// For a picture of this size, row by row.
    pub fn new(size: [u32; 2], depth: &[f32]) -> Self {
        let least = |x: u32, y: u32, side: u32| {
            let columns = x * side..((x + 1) * side).min(size[0]);
            let rows = y * side..((y + 1) * side).min(size[1]);
            let pixels = rows.flat_map(|y| columns.clone().map(move |x| (y * size[0] + x) as usize));
            pixels.map(|i| depth[i]).fold(1.0, f32::min)
        };
        let of = |side: u32| {
            let [across, down] = size.map(|pixels| pixels.div_ceil(side));
            (0..down).flat_map(move |y| (0..across).map(move |x| (x, y))).map(move |(x, y)| least(x, y, side))
        };
        Self { size, depths: of(square_side(size)).chain(of(TILE)).chain(of(TILE * BLOCK)).collect() }
    }

    /// Whether all of these squares with this side are nearer than `z`.
    fn all_nearer(&self, columns: RangeInclusive<u32>, rows: RangeInclusive<u32>, side: u32, z: f64) -> bool {
        let count = |side: u32| self.size.map(|pixels| pixels.div_ceil(side));
        let smaller = [square_side(self.size), TILE].into_iter().filter(|s| *s < side);
        let first: u32 = smaller.map(|s| count(s)[0] * count(s)[1]).sum();
        let depth = |x: u32, y: u32| f64::from(self.depths[(first + y * count(side)[0] + x) as usize]);
        rows.into_iter().all(|y| columns.clone().all(|x| depth(x, y) > z))
    }

    /// Whether all of these pixels, columns and rows, are certainly nearer than the reversed depth `z`.
    pub fn all_pixels_nearer(&self, pixels: &[RangeInclusive<u32>; 2], z: f64) -> bool {
        let squares = |side: u32| pixels.clone().map(|p| p.start() / side..=p.end() / side);
        let few = |side: &u32| squares(*side).iter().all(|range| range.end() - range.start() < MOST_SQUARES);
        let side = [square_side(self.size), TILE].into_iter().find(few).unwrap_or(TILE * BLOCK);
        let [columns, rows] = squares(side);
        self.all_nearer(columns, rows, side, z)
    }
}

/// Whether no part of the face lies in a cell of `n` by `n`, by the bits of [`OUTSIDE_CELLS`] by [`OUTSIDE_CELLS`]
/// cells.
pub fn is_outside(outside: [u32; 2], cell: [u32; 2], n: u32) -> bool {
    let range = |k: u32| k * OUTSIDE_CELLS / n..((k + 1) * OUTSIDE_CELLS / n).max(k * OUTSIDE_CELLS / n + 1);
    let bits = u64::from(outside[0]) | u64::from(outside[1]) << 32;
    range(cell[1]).all(|y| range(cell[0]).all(|x| bits >> (y * OUTSIDE_CELLS + x) & 1 != 0))
}

/// A patch in the picture.
struct Seen<'a> {
    frame: &'a Frame,
    view: &'a abi::View,
    abi: &'a abi::Patch,
    patch: Patch,
    scale: f64,
    segment: DVec2,
}

/// The pixels that a cell covers, and its nearest depth.
struct Cover {
    low: DVec2,
    high: DVec2,
    depth: f64,
    /// Distance that it may extend beside these pixels.
    beside: f64,
}

/// Whether a patch instance with these taus is hidden behind all depths of `farthest`, in double precision. Pixels are
/// widened by `slack` pixels, and depths by a thousandth of it: single precision must agree if slightly more and
/// slightly less slack give the same result.
pub fn lies_behind(
    frame: &Frame,
    scene: &Scene<'_>,
    patch_instance: usize,
    tau: u32,
    farthest: &Farthest,
    slack: f64,
) -> bool {
    let (placed, face, patch) = scene.patch_instance(patch_instance);
    let index = (face.first_patch + patch_instance as u32 - placed.first_patch_instance) as usize;
    let (degree_u, degree_v) = patch.degrees();
    let points = &scene.points[patch.first as usize..][..(degree_u + 1) * (degree_v + 1)];
    let homogeneous = |p: &[f32; 4]| {
        let [x, y, z, w] = p.map(f64::from);
        DVec4::new(x, y, z, w)
    };
    let seen = Seen {
        frame,
        view: &scene.views[placed.instance as usize],
        abi: &patch,
        patch: Patch { degree_u, degree_v, points: points.iter().map(homogeneous).collect() },
        scale: f64::from(scene.instances[placed.instance as usize].scale),
        segment: DVec2::new(f64::from(tau & 0x7fff), f64::from(tau >> 16)).recip(),
    };
    seen.lies_behind(scene.outside[index], farthest, slack)
}

impl Seen<'_> {
    fn lies_behind(&self, outside: [u32; 2], farthest: &Farthest, slack: f64) -> bool {
        let Some(whole) = self.cover([0, 0], 1, false) else { return false };
        let span = (whole.high - whole.low).max_element() + 2.0 * whole.beside;
        let mut n = 1;
        while n < MOST_CELLS && span > CELL_PX * f64::from(n) {
            n *= 2;
        }
        if n == 1 {
            return self.is_covered(&whole, farthest, slack);
        }
        let cells = (0..n).flat_map(|j| (0..n).map(move |i| [i, j]));
        let mut left = cells.filter(|cell| !is_outside(outside, *cell, n));
        left.all(|cell| {
            self.cover(cell, n, outside != [0; 2]).is_some_and(|cover| self.is_covered(&cover, farthest, slack))
        })
    }

    /// Twice the distance that the surface may have from its tangent within such a step.
    fn bend(&self, step: DVec2) -> f64 {
        let [uu, uv, vv] = self.abi.bend.map(f64::from);
        uu * step.x * step.x + 2.0 * uv * step.x * step.y + vv * step.y * step.y
    }

    /// A bound on `|S_uv|`.
    fn turn(&self) -> f64 {
        let [uu, twist, vv] = self.abi.bend.map(f64::from);
        twist + (uu * vv).sqrt()
    }

    fn to_pixel(&self, p: DVec3, w: f64) -> [f64; 4] {
        let rows = [self.view.x, self.view.y, self.view.depth, self.view.w];
        rows.map(|row| DVec4::from_array(row.map(f64::from)).dot(p.extend(w)))
    }

    /// The cover of a cell of `n` by `n`, including skirts beyond borders, with `all_sides` beyond every side; `None`
    /// if the cell reaches the near plane.
    fn cover(&self, cell: [u32; 2], n: u32, all_sides: bool) -> Option<Cover> {
        let size = DVec2::splat(1.0 / f64::from(n));
        let chord = self.bend(self.segment) / 8.0;
        let mut off = chord + self.bend(size) / 8.0;
        let borders = if self.abi.side() == Side::Boundary { self.abi.borders() } else { 0 };
        let near = f64::from(self.frame.near) * (1.0 + DEPTH_ROUNDING);
        let (mut low, mut high, mut depth) = (DVec2::INFINITY, DVec2::NEG_INFINITY, f64::INFINITY);
        let mut add = |q: [f64; 4]| {
            let pixel = DVec2::new(q[0], q[1]) / q[3];
            (low, high, depth) = (low.min(pixel), high.max(pixel), depth.min(q[2]));
            (q[2] >= near).then_some(())
        };
        for far in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let at: [f64; 2] = std::array::from_fn(|a| f64::from(cell[a] + far[a]) / f64::from(n));
            let jet = self.patch.jet(at[0], at[1]);
            let q = self.to_pixel(jet.point, 1.0);
            add(q)?;
            let border = [[abi::BORDER_U0, abi::BORDER_U1], [abi::BORDER_V0, abi::BORDER_V1]];
            let outwards: [f64; 2] = std::array::from_fn(|a| {
                let at_end = cell[a] + far[a] == far[a] * n;
                let counts = if at_end { borders & border[a][far[a] as usize] != 0 } else { all_sides };
                if counts { 2.0 * f64::from(far[a]) - 1.0 } else { 0.0 }
            });
            if outwards == [0.0; 2] {
                continue;
            }
            let (qu, qv) = (self.to_pixel(jet.du, 0.0), self.to_pixel(jet.dv, 0.0));
            let push = (PUSH_SLACK * self.push(q, qu, qv)).min(DVec2::splat(f64::from(MAX_PUSH)).min(self.segment));
            add(std::array::from_fn(|k| q[k] + outwards[0] * push.x * qu[k] + outwards[1] * push.y * qv[k]))?;
            let turned = self.turn() * (push.x * size.y + push.y * size.x) / 2.0;
            off = off.max(chord + self.bend(push) / 2.0 + turned);
        }
        let depth = depth - off * self.scale;
        let perspective = self.frame.perspective != 0;
        let pixels = self.scale * f64::from(self.frame.focal) * f64::from(self.frame.slant);
        let beside = off * pixels / if perspective { depth } else { 1.0 };
        (depth >= near).then_some(Cover { low, high, depth, beside })
    }

    /// Units of u and v that move a border twice the gap radius across itself.
    fn push(&self, q: [f64; 4], qu: [f64; 4], qv: [f64; 4]) -> DVec2 {
        let w = if self.frame.perspective != 0 { q[3].max(f64::from(self.frame.near)) } else { 1.0 };
        let at = DVec2::new(q[0], q[1]) / w;
        let speed = |d: [f64; 4]| (DVec2::new(d[0], d[1]) - at * d[3]) / w;
        let (pu, pv) = (speed(qu), speed(qv));
        2.0 * f64::from(self.frame.gap_radius_px) * DVec2::new(pv.length(), pu.length())
            / pu.perp_dot(pv).abs().max(1e-12)
    }

    fn is_covered(&self, cover: &Cover, farthest: &Farthest, slack: f64) -> bool {
        let reach = cover.beside + 1.0 + slack;
        let size = DVec2::new(f64::from(self.frame.size[0]), f64::from(self.frame.size[1]));
        let low = (cover.low - reach).floor().max(DVec2::ZERO);
        let high = (cover.high + reach).ceil().min(size - 1.0);
        if low.cmpgt(high).any() {
            return true;
        }
        let [near, far] = [self.frame.near, self.frame.far].map(f64::from);
        let scale = if self.frame.perspective != 0 { near / cover.depth } else { 1.0 };
        let z = (far - cover.depth) / (far - near) * scale * (1.0 + DEPTH_ROUNDING + 1e-3 * slack);
        farthest.all_pixels_nearer(&[low.x as u32..=high.x as u32, low.y as u32..=high.y as u32], z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_the_farthest_of_its_pixels() {
        // (columns, rows) of squares, tiles and blocks
        let small = ([37, 21], 2, [19, 11], [3, 2], 1);
        let large = ([477, 359], 4, [120, 90], [30, 23], 4 * 3);
        for (size, side, squares, tiles, blocks) in [small, large] {
            assert_eq!(square_side(size), side);
            let mut depth = vec![0.5; (size[0] * size[1]) as usize];
            *depth.last_mut().unwrap() = 0.25;
            let farthest = Farthest::new(size, &depth);
            let ends = [squares[0] * squares[1], tiles[0] * tiles[1], blocks];
            let last = [ends[0] - 1, ends[0] + ends[1] - 1, ends.iter().sum::<u32>() - 1];
            assert_eq!(farthest.depths.len() as u32 - 1, last[2]);
            let low: Vec<u32> = (0..).zip(&farthest.depths).filter(|(_, d)| **d == 0.25).map(|(i, _)| i).collect();
            assert_eq!(low, last, "the last square, tile and block");
            let [columns, rows] = squares.map(|n| n - 1);
            assert!(farthest.all_nearer(0..=columns - 1, 0..=rows, side, 0.4));
            assert!(!farthest.all_nearer(0..=columns, 0..=rows, side, 0.4));
            assert!(!farthest.all_nearer(0..=0, 0..=0, side, 0.5));
            let [columns, rows] = tiles.map(|n| n - 1);
            assert!(farthest.all_nearer(0..=columns, 0..=rows - 1, TILE, 0.4));
            assert!(!farthest.all_nearer(columns..=columns, rows..=rows, TILE, 0.4));
        }
    }

    #[test]
    fn cells_are_outside_where_all_their_bits_are() {
        let bits = 0x0f0f_0f0f_u64; // columns 0 to 3 of rows 0 to 3
        let outside = [bits as u32, (bits >> 32) as u32];
        assert!(is_outside(outside, [0, 0], 2) && !is_outside(outside, [1, 0], 2) && !is_outside(outside, [0, 1], 2));
        assert!(is_outside(outside, [3, 3], 8) && !is_outside(outside, [4, 3], 8) && !is_outside(outside, [3, 4], 8));
        assert!(is_outside(outside, [7, 7], 16) && !is_outside(outside, [8, 7], 16) && !is_outside(outside, [0, 0], 1));
    }
}
