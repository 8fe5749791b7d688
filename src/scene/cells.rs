//! The trim table's strips and bins of a face, and the cells from which the distance of its scan lines is computed.
//!
//! ```text
//!    v ▲  strip   ├────┬────┤
//!      │          │cell│cell│ bins        each cell: a box, and the surface's speed in it
//!      │          ├────┼────┤
//!      └─────────────────────▶ u
//! ```

use super::face::{Domain, outward_box, round_up};
use crate::abi;
use crate::math::octahedral;
use crate::model::{Face, TrimLoop};
use crate::picture::TakenWay;
use crate::spline::{Bezier, Control, Patch, SurfacePatch};
use glam::{DVec2, DVec3};

/// The fewest v-strips of a face. More strips follow a changing density more closely and leave out more rows beyond the
/// picture; each costs a cell of 48 bytes a bin.
const LEAST_STRIPS: usize = 8;
/// The benchmark of the paper used 128 strips for every surface. No scene tried has gained from more.
const MOST_STRIPS: usize = 128;
/// Intercepts of a scan line, on average, for each bin: fewer than pass `sort` holds in registers. Bins outside the
/// picture cost nothing, so there may be many; each costs a cell a strip.
const BIN_INTERCEPTS: f64 = 8.0;
/// A word has a bit for each bin.
const MOST_BINS: f64 = 32.0;
/// The square root of the number of curves for each strip. At this value a strip has four rows of holes, if the holes
/// form a square grid and have four curves each.
const STRIP_CURVES: f64 = 8.0;

/// [`abi::Face::strips`] of a face with this number of rows of patches. Strips decide where scan lines are, so they
/// must depend only on what edits leave unchanged.
pub(super) fn strips(face: &Face, rows: usize, way: TakenWay) -> u32 {
    let count: usize = face.loops.iter().map(|l| l.curves().len()).sum();
    let for_curves = (count as f64).sqrt() / STRIP_CURVES;
    let strips = (2 * rows).max(for_curves as usize).clamp(LEAST_STRIPS, MOST_STRIPS) as u32;
    if way != TakenWay::Table {
        return abi::Face::pack_strips(strips, 1);
    }
    let height = |c: Bezier<DVec3>| {
        let v = || c.points.iter().map(|p| p.point().y);
        v().fold(f64::NEG_INFINITY, f64::max) - v().fold(f64::INFINITY, f64::min)
    };
    let (v0, v1) = face.surface.domain().1;
    let intercepts = face.loops.iter().flat_map(TrimLoop::curves).map(height).sum::<f64>() / (v1 - v0);
    abi::Face::pack_strips(strips, (intercepts / BIN_INTERCEPTS).clamp(1.0, MOST_BINS) as u32)
}

/// The parts, of `n` equal parts of 0 to 1, that an interval meets. With each comes the range of the interval, 0 to 1
/// within it, that lies in the part.
fn shares(start: f64, length: f64, n: u32) -> impl Iterator<Item = (u32, (f64, f64))> {
    let parts = f64::from(n);
    let first = (start * parts).floor().clamp(0.0, parts - 1.0) as u32;
    let last = (((start + length) * parts).ceil() - 1.0).clamp(f64::from(first), parts - 1.0) as u32;
    let local = move |k: u32| ((f64::from(k) / parts - start) / length).clamp(0.0, 1.0);
    // shorter ranges come from rounding at the ends; derivatives over them would be roundings, too
    (first..=last).map(move |k| (k, (local(k), local(k + 1)))).filter(|(_, (from, to))| to - from > 1e-7)
}

/// The slab around a patch, parallel to both of its diagonals: the normal, and the smallest and largest distance along
/// it.
fn slab(piece: &Patch, origin: DVec3) -> (u32, f32, f32) {
    let (n, k) = (piece.degree_u, piece.degree_v);
    let at = |i: usize, j: usize| piece.points[j * (n + 1) + i].point() - origin;
    let across = (at(n, k) - at(0, 0)).cross(at(0, k) - at(n, 0));
    let word = octahedral::pack(across.try_normalize().unwrap_or(DVec3::Z));
    let normal = DVec3::from_array(octahedral::unpack(word).map(f64::from));
    let along = piece.points.iter().map(|p| normal.dot(p.point() - origin));
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
    (word, (low as f32).next_down(), round_up(high))
}

/// One cell for each bin of each v-strip that a patch of the face meets.
pub(super) fn cells(face: &abi::Face, p: &SurfacePatch, origin: DVec3, domain: &Domain) -> Vec<abi::Cell> {
    let (strips, bins) = (face.strip_count(), face.bin_count());
    let corner = domain.unit(DVec2::new(p.u.0, p.v.0));
    let size = domain.unit(DVec2::new(p.u.1, p.v.1)) - corner;
    let cell = |(strip, v): (u32, (f64, f64)), (bin, u): (u32, (f64, f64))| {
        let piece = p.patch.rectangle(u, v);
        let (speed_u, speed_v) = piece.speed_bound();
        let (box_min, box_max) = outward_box(&piece, origin);
        let (normal, low, high) = slab(&piece, origin);
        abi::Cell {
            box_min,
            speed_u: round_up(speed_u / (size.x * (u.1 - u.0))),
            box_max,
            speed_v: round_up(speed_v / (size.y * (v.1 - v.0))),
            bin: strip * bins + bin,
            normal,
            low,
            high,
        }
    };
    let in_u: Vec<_> = shares(corner.x, size.x, bins).collect();
    shares(corner.y, size.y, strips).flat_map(|v| in_u.iter().map(move |&u| (v, u))).map(|(v, u)| cell(v, u)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Surface;
    use glam::DVec4;
    use std::f64::consts::PI;

    /// Patches of a half turn: their ends are not exact in floating point.
    #[test]
    fn shares_add_up_and_none_is_but_a_rounding() {
        let ends = |k: u32, n: u32| PI + PI * f64::from(k) / f64::from(n);
        let domain = Domain { origin: DVec2::splat(PI), size: DVec2::splat(PI) };
        for patches in [1u32, 2, 3, 4, 7, 8, 24] {
            for n in [8u32, 16, 48, 128] {
                for k in 0..patches {
                    let [start, end] = [k, k + 1].map(|k| domain.unit(DVec2::splat(ends(k, patches))).x);
                    let all: Vec<_> = shares(start, end - start, n).collect();
                    assert!(all.iter().all(|(_, (from, to))| to - from > 1e-3), "{k} of {patches} in {n}: {all:?}");
                    let sum: f64 = all.iter().map(|(_, (from, to))| to - from).sum();
                    assert!((sum - 1.0).abs() < 1e-9, "{sum} of {k} of {patches} in {n}");
                }
            }
        }
    }

    /// Eighths of a half turn in sixteen strips: each patch meets two strips and runs through both at the same speed.
    #[test]
    fn a_patch_has_no_cell_in_a_strip_that_it_meets_by_a_rounding() {
        let point = |i: usize| DVec4::new((i % 2) as f64, (i / 2) as f64, 0.0, 1.0);
        let inner = (0..=8).map(|k| PI + PI * f64::from(k) / 8.0);
        let knots = std::iter::once(PI).chain(inner).chain([2.0 * PI]).collect();
        let surface = Surface::new((1, 1), vec![0.0, 0.0, 1.0, 1.0], knots, (0..18).map(point).collect()).unwrap();
        let domain = Domain { origin: DVec2::new(0.0, PI), size: DVec2::new(1.0, PI) };
        let face = abi::Face { strips: abi::Face::pack_strips(16, 1), ..Default::default() };
        for (nth, p) in (0..).zip(&surface.patches().patches) {
            let cells = cells(&face, p, DVec3::ZERO, &domain);
            assert_eq!(cells.iter().map(|cell| cell.bin).collect::<Vec<_>>(), [2 * nth, 2 * nth + 1]);
            assert!(cells.iter().all(|cell| (cell.speed_v - 8.0).abs() < 1e-4), "{cells:?}");
        }
    }
}
