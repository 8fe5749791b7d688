//! Trimmed faces as triangles within a bounded distance.
//!
//! ```text
//!   ┌───┬───┬───┐     cells of a patch: with n of them along u and m along v, the bilinear surface over the corners of
//!   │▒▒▒│▒▒╱│   │     a cell, and every triangle with corners on it, is within
//!   ├───┼─╱─┼───┤         (|S_uu| / n² + 2 |S_uv| / (n m) + |S_vv| / m²) / 8
//!   │▒▒▒│╱  │   │     of S at the same (u, v)
//!   └───┴───┴───┘     loops become chords within the same deviation; cells that they cross are cut into trapezoids
//! ```
//!
//! *Proof.* Along one parameter a chord is within `h² |S''| / 8` of its curve, so the bilinear surface is within `h²
//! |S_uu| / 8 + k² |S_vv| / 8` of S. Its own second derivative is the mixed one, at most `|S_uv|`. A point with weights
//! `w_i` of a triangle's corners is off it by at most `|S_uv| Σ w_i |Δu_i| |Δv_i|`. That is `|S_uv| h k / 4`: the
//! spread of numbers that differ by h at most is h / 2 (T. Popoviciu, 1935). The sum is the bound of D. Filip, R.
//! Magedson, R. Markot, *Surface algorithms using bounds on derivatives*, 1986, here for cut triangles.
//!
//! Trapezoids' corners lie on the bilinear surface, whose isolines are straight: pieces on both sides of an isoline
//! meet. Patches in a column have equally many cells along u, so triangles leave no gap except by rounding.

use super::region::Region;
use crate::model::Face;
use crate::scene::flatten::{Cuts, flattened};
use crate::spline::{Bezier, PatchGrid};
use crate::trim::{LoopIndex, RectSide, chord_bend, polyline};
use glam::{DVec2, DVec3};

/// Most cells of a patch along a parameter. A patch that bends more gets a larger deviation.
const MOST_CELLS: f64 = 1024.0;
/// Most chords of a trim curve. A curve that bends more gets a larger deviation.
const MOST_CHORDS: f64 = 4096.0;
/// Deviation of trim curves, as a share of the surface's: it becomes a gap between two faces.
const OF_TRIMS: f64 = 0.125;
/// Most chords in a cell that is cut into trapezoids at once; the cost is slabs times chords.
const FEW_CHORDS: usize = 12;
/// Most halvings of a cell with more chords.
const MOST_HALVINGS: u32 = 32;

/// Rounding of a corner, relative to its distance from the origin: 4096 ulp.
const PLACE_ROUNDING: f64 = 1.0 / 1_099_511_627_776.0;

/// A triangle of a face.
pub(super) struct Near {
    /// Counter-clockwise from outside.
    pub corners: [DVec3; 3],
    /// Largest distance from the face at the same parameters.
    pub off: f64,
    /// Corners of the cell that contains it.
    pub cell: [DVec3; 4],
}

/// A face, and bounds on its patches' derivatives.
pub(super) struct FacePlan<'a> {
    face: &'a Face,
    grid: PatchGrid,
    /// For each patch: bounds of the second derivatives along u and v, each with half of the mixed one. `None` if no
    /// part of the face lies in the patch.
    bends: Vec<Option<DVec2>>,
    /// Bounds of the first derivatives, per unit of the face's parameters.
    speed: DVec2,
}

/// The numbers of cells in each column and each row of patches.
struct Cells {
    across: Vec<u32>,
    up: Vec<u32>,
}

impl<'a> FacePlan<'a> {
    /// Cost: the patches' derivative bounds, some 10 to 200 µs each.
    pub fn new(face: &'a Face) -> Self {
        let grid = flattened(face.surface.patches(), Cuts::Any);
        let index = (!face.loops.is_empty()).then(|| LoopIndex::new(&face.loops));
        let mut speed = DVec2::ZERO;
        let mut bends = Vec::with_capacity(grid.patches.len());
        for p in &grid.patches {
            let (low, high) = (DVec2::new(p.u.0, p.v.0), DVec2::new(p.u.1, p.v.1));
            let side = index.as_ref().map_or(RectSide::Inside, |index| index.classify(low, high));
            bends.push((side != RectSide::Outside).then(|| {
                let b = p.patch.derivative_bound();
                speed = speed.max(DVec2::new(b.u, b.v) / (high - low));
                // 2 h k <= a h² + k² / a, with equality for square cells
                let a = if b.u > 0.0 && b.v > 0.0 { b.u / b.v } else { 1.0 };
                DVec2::new(b.uu + a * b.uv, b.vv + b.uv / a)
            }));
        }
        Self { face, grid, bends, speed }
    }

    fn cells(&self, deviation: f64) -> Cells {
        let rows = self.grid.count_u;
        let count = |x: f64| x.sqrt().ceil().clamp(1.0, MOST_CELLS) as u32;
        let mut up = vec![1; self.grid.count_v];
        for (n, bend) in self.bends.iter().enumerate().filter_map(|(n, b)| Some((n, b.as_ref()?))) {
            up[n / rows] = up[n / rows].max(count(bend.y / (4.0 * deviation)));
        }
        let mut across = vec![1; rows];
        for (n, bend) in self.bends.iter().enumerate().filter_map(|(n, b)| Some((n, b.as_ref()?))) {
            // the share that the rows leave: at least half, unless the rows have reached their most cells
            let rest = (8.0 * deviation - bend.y / f64::from(up[n / rows]).powi(2)).max(4.0 * deviation);
            across[n % rows] = across[n % rows].max(count(bend.x / rest));
        }
        Cells { across, up }
    }

    fn chords(&self, curve: &Bezier<DVec3>, deviation: f64) -> u32 {
        let bend = (chord_bend(curve) * self.speed).length() / (OF_TRIMS * deviation);
        bend.sqrt().ceil().clamp(1.0, MOST_CHORDS) as u32
    }

    /// Approximate number of triangles for a deviation.
    pub fn count(&self, deviation: f64) -> u64 {
        let cells = self.cells(deviation);
        let rows = self.grid.count_u;
        let patches = self.bends.iter().enumerate().filter(|(_, bend)| bend.is_some());
        let whole: u64 =
            patches.map(|(n, _)| 2 * u64::from(cells.across[n % rows]) * u64::from(cells.up[n / rows])).sum();
        let chords = |c: &Bezier<DVec3>| u64::from(self.chords(c, deviation));
        let cut: u64 = self.face.loops.iter().flat_map(|l| l.curves().map(|c| chords(&c)).collect::<Vec<_>>()).sum();
        // a chord adds trapezoids in its own cell, in the next cell, and beside itself
        whole + 4 * cut
    }

    /// Passes triangles within `deviation` to `found`; the deviation is larger if [`MOST_CELLS`] does not suffice.
    pub fn triangles(&self, deviation: f64, found: &mut impl FnMut(Near)) {
        let sheet = Sheet::new(self, &self.cells(deviation));
        let chain = |l: &crate::model::TrimLoop| {
            let mut points: Vec<DVec2> = Vec::new();
            for c in l.curves() {
                let chords = if c.degree() == 1 { 1 } else { self.chords(&c, deviation) };
                // the end of a curve is the start of the next, bit for bit
                points.extend(polyline(&c, chords).take(chords as usize));
            }
            points.extend(points.first().copied());
            points
        };
        let ((u0, u1), (v0, v1)) = self.face.surface.domain();
        let chains: Vec<Vec<DVec2>> = self.face.loops.iter().map(chain).collect();
        let all = [0, sheet.across.len() as u32, 0, sheet.up.len() as u32];
        if chains.is_empty() {
            sheet.whole(all, found);
        } else {
            let region = Region::new(chains.iter().map(Vec::as_slice), DVec2::new(u0, v0), DVec2::new(u1, v1));
            sheet.cut(all, &region, found);
        }
    }
}

/// One cell of a column or row.
#[derive(Clone, Copy)]
struct Slot {
    /// Its column or row of patches.
    patch: u32,
    /// Its range of the patch's parameters.
    from: f64,
    to: f64,
    /// Its range of the face's parameters.
    low: f64,
    high: f64,
    cells: u32,
}

/// A face divided into cells.
struct Sheet<'a> {
    plan: &'a FacePlan<'a>,
    across: Vec<Slot>,
    up: Vec<Slot>,
}

/// First cell and end along u, then first cell and end along v.
type Block = [u32; 4];

impl<'a> Sheet<'a> {
    fn new(plan: &'a FacePlan<'a>, cells: &Cells) -> Self {
        let patches = &plan.grid.patches;
        let across = slots(&cells.across, |i| patches[i].u);
        let up = slots(&cells.up, |j| patches[j * plan.grid.count_u].v);
        Self { plan, across, up }
    }

    /// Number of the cell's patch.
    fn patch(&self, i: u32, j: u32) -> usize {
        let (column, row) = (self.across[i as usize].patch, self.up[j as usize].patch);
        row as usize * self.plan.grid.count_u + column as usize
    }

    /// A bound on the distance between the face and the triangles of a cell.
    fn deviation(&self, i: u32, j: u32) -> Option<f64> {
        let bend = self.plan.bends[self.patch(i, j)]?;
        let n = DVec2::new(f64::from(self.across[i as usize].cells), f64::from(self.up[j as usize].cells));
        Some((bend / (n * n)).element_sum() / 8.0)
    }

    /// The point of the face at a corner of cell (i, j).
    fn point(&self, (i, j): (u32, u32), (right, top): (bool, bool)) -> DVec3 {
        let at = |slot: &Slot, end: bool| if end { slot.to } else { slot.from };
        let (u, v) = (at(&self.across[i as usize], right), at(&self.up[j as usize], top));
        self.plan.grid.patches[self.patch(i, j)].patch.point(u, v)
    }

    /// Corners (0, 0), (1, 0), (0, 1) and (1, 1). Corners that cells share are computed alike for all of them.
    fn corners(&self, i: u32, j: u32) -> [DVec3; 4] {
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, top)| {
            let beyond = (i + right == self.across.len() as u32, j + top == self.up.len() as u32);
            let cell = (if beyond.0 { i } else { i + right }, if beyond.1 { j } else { j + top });
            self.point(cell, beyond)
        })
    }

    fn push(&self, corners: [DVec3; 4], cell: [DVec3; 4], off: f64, found: &mut impl FnMut(Near)) {
        let [a, b, c, d] = corners;
        for [p, q, r] in [[a, b, d], [a, d, c]] {
            if !is_line([p, q, r]) {
                let corners = if self.plan.face.same_sense { [p, q, r] } else { [p, r, q] };
                found(Near { corners, off, cell });
            }
        }
    }

    /// Triangles of all cells in a block.
    fn whole(&self, [first, end, low, high]: Block, found: &mut impl FnMut(Near)) {
        for j in low..high {
            // the right corners of a cell are the left corners of the next
            let mut left: Option<[DVec3; 2]> = None;
            for i in first..end {
                let corners = match left {
                    Some([a, c]) => {
                        let [_, b, _, d] = self.corners(i, j);
                        [a, b, c, d]
                    }
                    None => self.corners(i, j),
                };
                left = Some([corners[1], corners[3]]);
                if let Some(deviation) = self.deviation(i, j) {
                    self.push(corners, corners, deviation, found);
                }
            }
        }
    }

    /// Triangles of the part of a block that the loops surround.
    fn cut(&self, block: Block, region: &Region, found: &mut impl FnMut(Near)) {
        let [first, end, low, high] = block;
        match region.whole() {
            Some(true) => return self.whole(block, found),
            Some(false) => return,
            None => {}
        }
        let (wide, tall) = (end - first, high - low);
        if wide == 1 && tall == 1 {
            if let Some(deviation) = self.deviation(first, low) {
                self.trapezoids((first, low), &self.corners(first, low), deviation, region, MOST_HALVINGS, found);
            }
        } else if wide >= tall {
            let middle = first + wide / 2;
            let [left, right] = region.across_u(self.across[middle as usize].low);
            self.cut([first, middle, low, high], &left, found);
            self.cut([middle, end, low, high], &right, found);
        } else {
            let middle = low + tall / 2;
            let [below, above] = region.across_v(self.up[middle as usize].low);
            self.cut([first, end, low, middle], &below, found);
            self.cut([first, end, middle, high], &above, found);
        }
    }

    /// Triangles of the part of a cell that the loops surround.
    fn trapezoids(
        &self,
        cell: (u32, u32),
        corners: &[DVec3; 4],
        deviation: f64,
        region: &Region,
        halvings: u32,
        found: &mut impl FnMut(Near),
    ) {
        if region.chord_count() > FEW_CHORDS && halvings > 0 {
            let (low, high) = region.corners();
            let (middle, size) = (low.midpoint(high), (high - low) * self.plan.speed);
            let halves = if size.x >= size.y { region.across_u(middle.x) } else { region.across_v(middle.y) };
            let mut half = |half: &Region| self.trapezoids(cell, corners, deviation, half, halvings - 1, found);
            return halves.iter().for_each(&mut half);
        }
        let (across, up) = (&self.across[cell.0 as usize], &self.up[cell.1 as usize]);
        let (low, high) = (DVec2::new(across.low, up.low), DVec2::new(across.high, up.high));
        let bilinear = |p: DVec2| {
            let s = ((p - low) / (high - low)).clamp(DVec2::ZERO, DVec2::ONE);
            let between = |a: DVec3, b: DVec3, t: f64| a * (1.0 - t) + b * t;
            between(between(corners[0], corners[1], s.x), between(corners[2], corners[3], s.x), s.y)
        };
        region.trapezoids(|trapezoid| self.push(trapezoid.map(bilinear), *corners, deviation, found));
    }
}

/// Whether corners lie on a line, up to rounding, as at a pole, where two of them are one point computed twice.
fn is_line([p, q, r]: [DVec3; 3]) -> bool {
    let longest = (q - p).length().max((r - q).length()).max((p - r).length());
    let known = PLACE_ROUNDING * [p, q, r].into_iter().map(|c| c.abs().max_element()).fold(0.0, f64::max);
    (q - p).cross(r - p).length() <= known * longest
}

/// The cells of a row of patches, each with its range of the face's parameters.
fn slots(counts: &[u32], range: impl Fn(usize) -> (f64, f64)) -> Vec<Slot> {
    let mut all = Vec::with_capacity(counts.iter().sum::<u32>() as usize);
    for (patch, &cells) in counts.iter().enumerate() {
        let (low, high) = range(patch);
        let own = |k: u32| if k == cells { 1.0 } else { f64::from(k) / f64::from(cells) };
        let of_face = |k: u32| if k == cells { high } else { low + (high - low) * own(k) };
        all.extend((0..cells).map(|k| Slot {
            patch: patch as u32,
            from: own(k),
            to: own(k + 1),
            low: of_face(k),
            high: of_face(k + 1),
            cells,
        }));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{SurfaceKind, TrimLoop};
    use crate::spline::{Control, Surface};
    use glam::DVec4;
    use std::f64::consts::{FRAC_1_SQRT_2, PI};

    fn face(degrees: (usize, usize), points: Vec<DVec4>, loops: Vec<TrimLoop>) -> Face {
        let knots = |degree| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
        let surface = Surface::new(degrees, knots(degrees.0), knots(degrees.1), points).unwrap();
        Face { id: 1, kind: SurfaceKind::BSpline, surface, loops, same_sense: true, colour: None }
    }

    /// A circle in (u, v), clockwise.
    fn hole(middle: DVec2, radius: f64) -> TrimLoop {
        let corners = [(1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0)];
        let at = |k: usize| {
            let (x, y) = corners[k];
            let weight = if k.is_multiple_of(2) { 1.0 } else { FRAC_1_SQRT_2 };
            DVec3::from_point(middle + radius * DVec2::new(f64::from(x), f64::from(y)), weight)
        };
        let arc = |k: usize| Bezier { points: (2 * k..2 * k + 3).map(at).collect() };
        TrimLoop::new((0..4).map(arc).collect(), DVec2::splat(1e-12)).unwrap()
    }

    fn square() -> TrimLoop {
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let side = |k: usize| Bezier::line(corners[k], corners[(k + 1) % 4]);
        TrimLoop::new((0..4).map(side).collect(), DVec2::ZERO).unwrap()
    }

    /// A quarter of a cylinder of radius 1 and height 3.
    fn round() -> Vec<DVec4> {
        let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, FRAC_1_SQRT_2), (0.0, 1.0, 1.0)];
        [0.0, 3.0].iter().flat_map(|z| arc.map(|(x, y, w)| DVec4::new(x * w, y * w, z * w, w))).collect()
    }

    /// A bicubic, rational patch with hills.
    fn hilly() -> Vec<DVec4> {
        let height = [0.0, 1.0, -1.0, 0.3, 1.0, 2.0, 0.0, -1.0, -1.0, 0.0, -3.0, 1.0, 0.5, -1.0, 1.0, 0.0];
        let point = |(k, z): (usize, f64)| {
            let weight = 1.0 + 0.5 * ((k * 7) % 5) as f64;
            DVec4::from_point(DVec3::new((k % 4) as f64, (k / 4) as f64, z), weight)
        };
        height.into_iter().enumerate().map(point).collect()
    }

    /// A parabola along a straight line: it attains the bound.
    fn bent() -> Vec<DVec4> {
        [0.0, 3.0]
            .iter()
            .flat_map(|y| [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)].map(|(x, z)| DVec4::new(x, *y, z, 1.0)))
            .collect()
    }

    /// A bilinear, twisted patch.
    fn twisted() -> Vec<DVec4> {
        [(0.0, 0.0, 0.0), (2.0, 0.0, 1.0), (0.0, 2.0, 1.0), (2.0, 2.0, -0.5)]
            .map(|p| DVec3::from(p).extend(1.0))
            .to_vec()
    }

    fn triangles(face: &Face, deviation: f64) -> Vec<Near> {
        let (plan, mut all) = (FacePlan::new(face), Vec::new());
        plan.triangles(deviation, &mut |near| all.push(near));
        // the estimate serves to reserve memory; it must not be far too small
        assert!(all.len() as u64 <= 2 * plan.count(deviation) + 16, "{} for {}", all.len(), plan.count(deviation));
        all
    }

    /// Source: C. Ericson, *Real-Time Collision Detection*, 2005, section 5.1.5.
    fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
        let n = (b - a).cross(c - a);
        let inside = [(a, b), (b, c), (c, a)].iter().all(|(s, e)| n.cross(*e - *s).dot(p - *s) >= 0.0);
        if inside && n.length() > 0.0 {
            return (p - a).dot(n.normalize()).abs();
        }
        let to_side = |s: DVec3, e: DVec3| {
            let t = ((p - s).dot(e - s) / (e - s).length_squared().max(1e-300)).clamp(0.0, 1.0);
            p.distance(s + (e - s) * t)
        };
        to_side(a, b).min(to_side(b, c)).min(to_side(c, a))
    }

    /// Points of a face, trimmed or not, are within the promised distance, which some nearly attain.
    #[test]
    fn triangles_keep_within_the_deviation() {
        for (name, degrees, points) in [
            ("round", (2, 1), round()),
            ("bent", (2, 1), bent()),
            ("hilly", (3, 3), hilly()),
            ("twisted", (1, 1), twisted()),
        ] {
            for (loops, deviation) in
                [(vec![], 0.02), (vec![], 0.2), (vec![square(), hole(DVec2::splat(0.45), 0.3)], 0.05)]
            {
                let face = face(degrees, points.clone(), loops);
                let (index, all) = (LoopIndex::new(&face.loops), triangles(&face, deviation));
                assert!(all.iter().all(|near| near.off <= deviation * (1.0 + 1e-9)), "{name}");
                let mut worst = 0.0f64;
                for k in 0..50 * 50 {
                    let uv = DVec2::new(f64::from(k % 50) + 0.5, f64::from(k / 50) + 0.5) / 50.0;
                    let near = index.distance(uv, 0.1) < 0.01;
                    if !near && index.contains(uv) {
                        let p = face.surface.point(uv.x, uv.y);
                        worst =
                            worst.max(all.iter().map(|near| distance(p, near.corners)).fold(f64::INFINITY, f64::min));
                    }
                }
                let told = all.iter().map(|near| near.off).fold(0.0, f64::max) * (1.0 + 1e-9);
                let least = if name == "bent" { 0.9 * told } else { 0.02 * deviation };
                assert!(worst <= told && worst > least, "{name}: {worst} for {told}, {deviation}");
            }
        }
    }

    /// The triangles have the trimmed area, and none lies in a hole. The face is a plane, with the coarsest cells.
    #[test]
    fn holes_are_left_out() {
        let plane = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 4.0)].map(|(x, y)| DVec4::new(x, y, 0.0, 1.0));
        let (middle, radius) = (DVec2::new(0.4, 0.55), 0.2);
        let many: Vec<TrimLoop> = (0..100u32)
            .map(|k| hole(DVec2::new(f64::from(k % 10) + 0.5, f64::from(k / 10) + 0.5) / 10.0, 0.03))
            .chain([square()])
            .collect();
        let once = vec![square(), hole(middle, radius)];
        for (loops, holes, radii) in [(once, radius * radius, radius), (many, 100.0 * 0.0009, 100.0 * 0.03)] {
            let face = face((1, 1), plane.to_vec(), loops);
            let (index, all) = (LoopIndex::new(&face.loops), triangles(&face, 1e-3));
            let area: f64 = all.iter().map(|Near { corners: [a, b, c], .. }| 0.5 * (*b - *a).cross(*c - *a).z).sum();
            let (truth, around) = (16.0 * (1.0 - PI * holes), 2.0 * PI * 4.0 * radii);
            // chords deviate by an eighth of the deviation, all around the holes
            assert!(area - truth < around * 1e-3 / 8.0 && area >= truth, "{area} for {truth}");
            for Near { corners: [a, b, c], off, .. } in &all {
                let p = (*a + *b + *c).truncate() / 12.0;
                assert!(*off == 0.0 && (index.contains(p) || index.distance(p, 0.1) < 1e-3 / 16.0), "{p}");
            }
        }
    }

    /// At a row of corners that is one point, computed in many ways, no triangle stands on end: an eighth of a ball
    /// away from the origin.
    #[test]
    fn triangles_at_a_pole_lie_on_the_face() {
        let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, FRAC_1_SQRT_2), (0.0, 1.0, 1.0)];
        let middle = DVec3::new(0.3, 0.7, 0.1);
        let round = |(r, z, of_v): (f64, f64, f64)| {
            let around =
                |(x, y, of_u): (f64, f64, f64)| (middle + DVec3::new(r * x, r * y, z)).extend(1.0) * of_u * of_v;
            arc.map(around)
        };
        let face = face((2, 2), arc.into_iter().flat_map(round).collect(), vec![]);
        let all = triangles(&face, 0.002);
        let upright = all.iter().filter(|Near { corners: [a, b, c], .. }| {
            let outwards = ((a + b + c) / 3.0 - middle).normalize();
            // a cell turns by a few degrees
            (b - a).cross(c - a).normalize_or_zero().dot(outwards) < 0.98
        });
        assert!(upright.count() == 0 && all.len() > 100, "{}", all.len());
    }

    /// Every side of a triangle, except at the face's border, is also a side of another triangle, in the other
    /// direction.
    #[test]
    fn cells_meet() {
        let face = face((3, 3), hilly(), vec![]);
        let all = triangles(&face, 0.05);
        let key = |p: DVec3| p.to_array().map(f64::to_bits);
        let sides = |Near { corners: [a, b, c], .. }: &Near| [(*a, *b), (*b, *c), (*c, *a)];
        let known: std::collections::HashSet<_> = all.iter().flat_map(sides).map(|(a, b)| (key(a), key(b))).collect();
        let on_border = |p: DVec3| p.x.min(p.y).abs() < 1e-9 || (p.x.max(p.y) - 3.0).abs() < 1e-9;
        let open = all.iter().flat_map(sides).filter(|(a, b)| !known.contains(&(key(*b), key(*a))));
        let mut count = 0;
        for (a, b) in open {
            assert!(on_border(a) && on_border(b), "{a} to {b}");
            count += 1;
        }
        assert!(count > 8 && all.len() > 200, "{count} of {}", all.len());
    }
}
