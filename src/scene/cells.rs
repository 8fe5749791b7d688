//! The trim table's strips and bays of a face, and the cells that tell how dense its scan lines must be.
//!
//! ```text
//!    v ▲  strip   ├────┬────┤
//!      │          │cell│cell│ bays        of each: a box, and how fast the surface runs where its loops are
//!      │          ├────┼────┤
//!      └─────────────────────▶ u
//! ```

use super::face::{Domain, outward_box, round_up};
use crate::abi;
use crate::model::{Face, TrimLoop};
use crate::picture::TrimWay;
use crate::spline::{Bezier, Control, PatchGrid, SurfacePatch};
use crate::trim::{LoopIndex, RectSide};
use glam::{DVec2, DVec3};

/// v-strips of a face with few rows of patches. More strips follow a changing density more closely
/// and leave out more rows beyond the picture; each costs a cell of 52 bytes a bay.
const LEAST_STRIPS: usize = 8;
/// The paper's benchmark used 128 strips for every surface; nothing asked for more.
const MOST_STRIPS: usize = 128;
/// Intercepts of a scan line, on average, for each bay: fewer than pass `sort` holds in registers. Bays that nobody sees
/// cost nothing in a view, so many are better than few; each costs a cell a strip.
const BAY_INTERCEPTS: f64 = 8.0;
/// A word has a bit for each.
const MOST_BAYS: f64 = 32.0;
/// The root of the number of curves, for each strip: four rows of holes that are as many across, of four curves each.
const STRIP_CURVES: f64 = 8.0;

/// [`abi::Face::strips`]. Strips depend on what edits do not change, since they decide where scan lines are.
pub(super) fn strips(face: &Face, grid: &PatchGrid, way: TrimWay) -> u32 {
    let curves = || face.loops.iter().flat_map(TrimLoop::curves);
    let for_curves = (curves().count() as f64).sqrt() / STRIP_CURVES;
    let strips = (2 * grid.count_v).max(for_curves as usize).clamp(LEAST_STRIPS, MOST_STRIPS) as u32;
    if way != TrimWay::Table {
        return abi::Face::pack_strips(strips, 1);
    }
    let height = |c: Bezier<DVec3>| {
        let v = || c.points.iter().map(|p| p.point().y);
        v().fold(f64::NEG_INFINITY, f64::max) - v().fold(f64::INFINITY, f64::min)
    };
    let (v0, v1) = face.surface.domain().1;
    let intercepts = curves().map(height).sum::<f64>() / (v1 - v0);
    abi::Face::pack_strips(strips, (intercepts / BAY_INTERCEPTS).clamp(1.0, MOST_BAYS) as u32)
}

/// Which of `n` equal parts of 0 to 1 an interval reaches, and the share of the interval, 0 to 1 within it, that is in each.
fn shares(start: f64, length: f64, n: u32) -> impl Iterator<Item = (u32, (f64, f64))> {
    let parts = f64::from(n);
    let first = (start * parts).floor().clamp(0.0, parts - 1.0) as u32;
    let last = (((start + length) * parts).ceil() - 1.0).clamp(f64::from(first), parts - 1.0) as u32;
    let local = move |k: u32| ((f64::from(k) / parts - start) / length).clamp(0.0, 1.0);
    // what single precision does not tell from nothing: where ends meet up to rounding, derivatives there are roundings, too
    (first..=last).map(move |k| (k, (local(k), local(k + 1)))).filter(|(_, (from, to))| to - from > 1e-7)
}

/// One cell for each bay of each v-strip that the patch reaches. How fast the surface runs counts where the `loops` are,
/// since scan lines need not be near each other elsewhere; without `loops`, which may be edited, everywhere. Surfaces
/// are larger than their faces, and often distorted where nobody sees them.
pub(super) fn cells(
    face: &abi::Face,
    p: &SurfacePatch,
    origin: DVec3,
    domain: &Domain,
    loops: Option<&LoopIndex>,
) -> Vec<abi::Cell> {
    let mut cells = Vec::new();
    let (strips, bays) = (face.strip_count(), face.bay_count());
    let corner = domain.unit(DVec2::new(p.u.0, p.v.0));
    let size = domain.unit(DVec2::new(p.u.1, p.v.1)) - corner;
    for (strip, v) in shares(corner.y, size.y, strips) {
        for (bay, u) in shares(corner.x, size.x, bays) {
            let (lo, hi) = (DVec2::new(u.0, v.0), DVec2::new(u.1, v.1));
            let near = loops.map_or(Some((lo, hi)), |index| near_loops(index, p, lo, hi));
            let is_inside = || loops.is_some_and(|index| index.contains(at(p, (lo + hi) * 0.5)));
            // a strip without rows is outside; a bay without them may lie between others
            if near.is_none() && bays == 1 && !is_inside() {
                continue;
            }
            let (box_min, box_max) = outward_box(&p.patch.rectangle(u, v), origin);
            let bay = strip * bays + bay;
            let mut cell = abi::Cell { box_min, box_max, bay, ..Default::default() };
            if let Some((lo, hi)) = near {
                let piece = p.patch.rectangle((lo.x, hi.x), (lo.y, hi.y));
                let (speed_u, speed_v) = piece.speed_bound();
                let (slope_v, spread_v) = piece.slope_v();
                let per = 1.0 / (size * (hi - lo));
                (cell.speed_u, cell.speed_v) = (round_up(speed_u * per.x), round_up(speed_v * per.y));
                (cell.slope_v, cell.spread_v) = ((slope_v * per.y).as_vec3().to_array(), round_up(spread_v * per.y));
            }
            cells.push(cell);
        }
    }
    cells
}

/// The point of the surface's parameters at `uv`, 0 to 1 within a patch.
fn at(p: &SurfacePatch, uv: DVec2) -> DVec2 {
    let (lo, hi) = (DVec2::new(p.u.0, p.v.0), DVec2::new(p.u.1, p.v.1));
    lo + (hi - lo) * uv
}

/// Where the loops are in a rectangle within a patch: around those of its parts that a curve meets, or comes so near to that
/// its chords may; `None` where no curve does.
fn near_loops(index: &LoopIndex, p: &SurfacePatch, lo: DVec2, hi: DVec2) -> Option<(DVec2, DVec2)> {
    /// Along either parameter.
    const PARTS: u32 = 4;
    /// Of a part: chords are off by less, where parts are wider than a pixel.
    const AROUND: f64 = 1.0 / 16.0;
    let part = (hi - lo) / f64::from(PARTS);
    let corner = |i: u32, j: u32| lo + part * DVec2::new(f64::from(i), f64::from(j));
    let around = |i: u32, j: u32| (corner(i, j) - part * AROUND, corner(i + 1, j + 1) + part * AROUND);
    let meets = |&(lo, hi): &(DVec2, DVec2)| index.classify(at(p, lo), at(p, hi)) == RectSide::Boundary;
    let parts = (0..PARTS * PARTS).map(|c| around(c % PARTS, c / PARTS)).filter(meets);
    let (from, to) = parts.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    Some((from.max(lo), to.min(hi)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parity::{placed, untrimmed};
    use crate::picture::SceneSettings;
    use crate::scene::SceneData;
    use crate::spline::Surface;
    use glam::{DAffine3, DVec4};

    #[test]
    fn shares_add_up_and_none_is_but_a_rounding() {
        for patches in [1u32, 3, 7, 8, 24] {
            for n in [8u32, 16, 48, 128] {
                for k in 0..patches {
                    let start = f64::from(k) / f64::from(patches);
                    let length = f64::from(k + 1) / f64::from(patches) - start;
                    let all: Vec<_> = shares(start, length, n).collect();
                    assert!(all.iter().all(|(_, (from, to))| to - from > 1e-3), "{all:?}");
                    let sum: f64 = all.iter().map(|(_, (from, to))| to - from).sum();
                    assert!((sum - 1.0).abs() < 1e-9, "{sum} of {k} of {patches} in {n}");
                    let expected = f64::from(n) / f64::from(patches);
                    assert!(all.len() as f64 <= expected.ceil() + 1.0);
                }
            }
        }
    }

    /// A hundred times as long as its face, and bent where nobody sees it: strips without loops have no cells, and the others
    /// the speed at the loops.
    #[test]
    fn only_strips_with_loops_have_cells_and_the_speed_there() {
        // y = v up to 0.5, and fast beyond
        let point = |(x, y): (f64, f64)| DVec4::new(x, y, 0.0, 1.0);
        let net = [(0.0, 0.0), (1.0, 0.0), (0.0, 0.5), (1.0, 0.5), (0.0, 100.0), (1.0, 100.0)].map(point).to_vec();
        let surface = Surface::new((1, 1), vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 0.5, 1.0, 1.0], net).unwrap();
        let corners = [(0.1, 0.05), (0.9, 0.05), (0.9, 0.2), (0.1, 0.2)];
        let side = |i: usize| {
            let at = |i: usize| DVec2::from(corners[i % 4]).extend(1.0);
            Bezier { points: vec![at(i), at(i + 1)] }
        };
        let l = TrimLoop::new((0..4).map(side).collect(), DVec2::ZERO).unwrap();
        let face = crate::model::Face { loops: vec![l], ..untrimmed(surface) };
        let settings = |editable| SceneSettings { trim: Some(TrimWay::Table), editable, ..SceneSettings::default() };
        let data =
            |editable| SceneData::new(&placed(vec![face.clone()], DAffine3::IDENTITY), settings(editable)).unwrap();
        let (fixed, editable) = (data(false), data(true));
        assert_eq!(fixed.faces[0].strip_count(), 8);
        let strips: Vec<u32> = fixed.cells.iter().map(|cell| cell.bay).collect();
        assert_eq!(strips, [0, 1], "strips of an eighth, from 0.05 to 0.2");
        assert!(fixed.cells.iter().all(|cell| (cell.speed_v - 1.0).abs() < 1e-5), "{:?}", fixed.cells);
        assert!(fixed.cells.iter().all(|cell| cell.slope_v[1] > 0.999 && cell.spread_v < 1e-5), "{:?}", fixed.cells);
        assert_eq!(editable.cells.len(), 8, "an edit may take the loop anywhere");
    }
}
