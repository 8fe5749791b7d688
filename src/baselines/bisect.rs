//! Bisection of monotone pieces in every pixel: A. Schollmeyer, B. Fröhlich, *Direct trimming of NURBS
//! surfaces on the GPU*, 2009.
//!
//! ```text
//!   v ▲  band 3 ┌──────┬─────┐            bands of v; in each, cells of u that hold the pieces there,
//!     │  band 2 │ ╱‾╲  │  ╱  │  …         cut so that no piece lies in two cells of a band
//!     │  band 1 │ │ │  │ ╱   │            a point between cells: the parity of the pieces left of it
//!     │  band 0 └──────┴─────┘            in a cell: its pieces, each bisected until the box of the rest
//!     └───────────────────────▶ u         lies on one side of the point
//! ```
//!
//! Pieces are rational Bézier curves, monotone in both coordinates. In the source, bands end at every end of a piece,
//! and cells are unions of the boxes of whole pieces: [`Sorted::Source`]. [`Sorted::Tuned`] limits the number of bands
//! to `most_bands`, because a band for each end of 40,000 pieces takes tens of megabytes, and clips the boxes to the
//! band. Both differ from the source in three ways: the bracket after the last step is replaced by a chord, straight
//! pieces need no step, and a pixel's box between two cells is decided as a whole. The shader is
//! `glsl/include/baselines/bisect.glsl`, its twin is [`Bisect::contains`].

use super::Sorted;
use crate::model::{Face, TrimLoop};
use crate::spline::{Bezier, Control};
use crate::trim::monotone_pieces;
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Vec2};

/// Steps in the source.
pub const STEPS: u32 = 16;

/// The bands of one face.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BisectFace {
    /// Index of its first band.
    pub first_band: u32,
    /// Number of its bands; one more band ends the last.
    pub band_count: u32,
    /// Most bisections of a piece.
    pub steps: u32,
}

/// A range of v: from its own `v`, exclusive, to the next band's.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Band {
    /// Lower end, exclusive.
    pub v: f32,
    /// Index of its first cell; its cells end at the next band's first.
    pub first_cell: u32,
}

/// Pieces of a band whose boxes overlap.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Cell {
    /// Smallest u of the pieces.
    pub u_lo: f32,
    /// Largest u of the pieces.
    pub u_hi: f32,
    /// Index into the list of pieces.
    pub first: u32,
    /// Pieces | the parity left of the cell << 30 | the parity right of it << 31.
    pub count: u32,
}

/// A monotone piece.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Piece {
    /// Start point; neighbouring pieces share it bit for bit.
    pub start: [f32; 2],
    /// End point, shared likewise.
    pub end: [f32; 2],
    /// Index of its first homogeneous control point.
    pub first: u32,
    /// Degree.
    pub degree: u32,
}

/// The arrays of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bisect {
    /// One a face.
    pub faces: Vec<BisectFace>,
    /// Bands of all faces.
    pub bands: Vec<Band>,
    /// Cells of all bands.
    pub cells: Vec<Cell>,
    /// Indices of pieces, cell by cell.
    pub lists: Vec<u32>,
    /// Pieces of all faces.
    pub pieces: Vec<Piece>,
    /// Homogeneous, in normalised (u, v).
    pub points: Vec<[f32; 3]>,
}

/// Most bands for this number of pieces. With evenly spread pieces, a band then has about as many cells as there are
/// bands; both are found by binary search.
fn most_bands(pieces: usize) -> usize {
    4 * (pieces as f64).sqrt().ceil() as usize + 4
}

/// One piece in one band.
struct Clipped {
    u_lo: f32,
    u_hi: f32,
    piece: u32,
}

impl Bisect {
    /// Appends a face, whose `(u, v)` becomes the unit square.
    pub fn push(&mut self, face: &Face, steps: u32, sorted: Sorted) {
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let (origin, size) = (DVec2::new(u0, v0), DVec2::new(u1 - u0, v1 - v0));
        let first_piece = self.pieces.len();
        let mut curves = Vec::new();
        for trim_loop in &face.loops {
            self.push_loop(trim_loop, origin, size, &mut curves);
        }
        let first_band = self.bands.len() as u32;
        let ends = self.band_ends(first_piece, sorted);
        let mut members = vec![Vec::new(); ends.len()];
        for (k, piece) in self.pieces[first_piece..].iter().enumerate() {
            let (lo, hi) = (piece.start[1].min(piece.end[1]), piece.start[1].max(piece.end[1]));
            // a scan line crosses a piece above `lo` and up to `hi`; a horizontal piece crosses none
            let from = ends.partition_point(|v| *v <= lo).max(1) - 1;
            let to = ends.partition_point(|v| *v < hi);
            members[from..to].iter_mut().for_each(|m: &mut Vec<usize>| m.push(k));
        }
        for (k, &v) in ends.iter().enumerate() {
            self.bands.push(Band { v, first_cell: self.cells.len() as u32 });
            if let Some(&top) = ends.get(k + 1) {
                let clip = |&m: &usize| {
                    let piece = &self.pieces[first_piece + m];
                    let (u_lo, u_hi) = match sorted {
                        Sorted::Source => (piece.start[0].min(piece.end[0]), piece.start[0].max(piece.end[0])),
                        Sorted::Tuned => clipped(piece, &curves[m], v, top),
                    };
                    Clipped { u_lo, u_hi, piece: (first_piece + m) as u32 }
                };
                let pieces = members[k].iter().map(clip).collect();
                self.push_cells(pieces, top);
            }
        }
        let band_count = (ends.len() as u32).saturating_sub(1);
        self.faces.push(BisectFace { first_band, band_count, steps });
    }

    fn push_loop(&mut self, trim_loop: &TrimLoop, origin: DVec2, size: DVec2, curves: &mut Vec<Bezier<DVec3>>) {
        let unit = |p: DVec2| (p - origin) / size;
        let round = |p: DVec2| unit(p).as_vec2().to_array();
        for piece in monotone_pieces(trim_loop) {
            let (start, end) = (round(piece.start), round(piece.end));
            let w = piece.curve.points[0].z;
            let points: Vec<DVec3> =
                piece.curve.points.iter().map(|p| DVec3::from_point(unit(p.point()), p.z / w)).collect();
            let degree = if piece.straight { 1 } else { points.len() as u32 - 1 };
            self.pieces.push(Piece { start, end, first: self.points.len() as u32, degree });
            if degree > 1 {
                self.points.extend(points.iter().map(|p| p.as_vec3().to_array()));
            }
            curves.push(Bezier { points });
        }
    }

    /// The starts of the bands, and the end of the last: at ends of pieces.
    fn band_ends(&self, first_piece: usize, sorted: Sorted) -> Vec<f32> {
        let pieces = &self.pieces[first_piece..];
        let mut ends: Vec<f32> = pieces.iter().flat_map(|p| [p.start[1], p.end[1]]).collect();
        ends.sort_by(f32::total_cmp);
        ends.dedup();
        let Some(&last) = ends.last() else { return ends };
        let stride = match sorted {
            Sorted::Source => 1,
            Sorted::Tuned => ends.len().div_ceil(most_bands(pieces.len())),
        };
        let mut kept: Vec<f32> = ends.into_iter().step_by(stride).collect();
        if kept.last().is_some_and(|v| *v < last) {
            kept.push(last);
        }
        kept
    }

    fn push_cells(&mut self, mut pieces: Vec<Clipped>, top: f32) {
        pieces.sort_by(|a, b| a.u_lo.total_cmp(&b.u_lo));
        let crosses = |piece: &Piece| (piece.start[1] >= top) != (piece.end[1] >= top);
        let mut parity = false;
        let mut rest = pieces.as_slice();
        while let [head, ..] = rest {
            let (mut u_hi, mut count) = (head.u_hi, 1);
            while count < rest.len() && rest[count].u_lo <= u_hi {
                u_hi = u_hi.max(rest[count].u_hi);
                count += 1;
            }
            let (here, behind) = rest.split_at(count);
            let left = parity;
            parity ^= here.iter().filter(|c| crosses(&self.pieces[c.piece as usize])).count() % 2 == 1;
            self.cells.push(Cell {
                u_lo: head.u_lo,
                u_hi,
                first: self.lists.len() as u32,
                count: count as u32 | u32::from(left) << 30 | u32::from(parity) << 31,
            });
            self.lists.extend(here.iter().map(|c| c.piece));
            rest = behind;
        }
    }

    /// Bytes of the arrays.
    pub fn bytes(&self) -> u64 {
        fn of<T>(list: &[T]) -> u64 {
            size_of_val(list) as u64
        }
        of(&self.faces) + of(&self.bands) + of(&self.cells) + of(&self.lists) + of(&self.pieces) + of(&self.points)
    }

    /// Whether a point is inside a face, as the shader computes it.
    pub fn contains(&self, face: usize, p: Vec2) -> bool {
        let face = self.faces[face];
        let bands = &self.bands[face.first_band as usize..][..face.band_count as usize + 1];
        let band = bands.partition_point(|b| b.v < p.y);
        if band == 0 || band == bands.len() {
            return false;
        }
        let first = bands[band - 1].first_cell as usize;
        let cells = &self.cells[first..bands[band].first_cell as usize];
        let cell = cells.partition_point(|c| c.u_lo <= p.x);
        let Some(cell) = cell.checked_sub(1).map(|c| cells[c]) else { return false };
        if p.x > cell.u_hi {
            return cell.count >> 31 != 0;
        }
        let list = &self.lists[cell.first as usize..][..(cell.count & 0x3fff_ffff) as usize];
        let left = list.iter().filter(|&&k| self.is_left(&self.pieces[k as usize], p, face.steps)).count();
        (cell.count >> 30 & 1 != 0) != (left % 2 == 1)
    }

    /// Whether the piece crosses the point's scan line at the point or left of it.
    fn is_left(&self, piece: &Piece, p: Vec2, steps: u32) -> bool {
        let (start, end) = (Vec2::from(piece.start), Vec2::from(piece.end));
        if (start.y >= p.y) == (end.y >= p.y) {
            return false;
        }
        let (mut a, mut b) = ((0.0f32, start), (1.0f32, end));
        let mut step = if piece.degree == 1 { steps } else { 0 };
        loop {
            if p.x < a.1.x.min(b.1.x) {
                return false;
            }
            if p.x >= a.1.x.max(b.1.x) {
                return true;
            }
            if step >= steps {
                break;
            }
            let t = 0.5 * (a.0 + b.0);
            let m = self.point(piece, t).clamp(start.min(end), start.max(end));
            if (m.y >= p.y) == (a.1.y >= p.y) {
                a = (t, m)
            } else {
                b = (t, m)
            }
            step += 1;
        }
        let (a, b) = (a.1, b.1);
        a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y)) <= p.x
    }

    fn point(&self, piece: &Piece, t: f32) -> Vec2 {
        let points = &self.points[piece.first as usize..][..piece.degree as usize + 1];
        let s = 1.0 - t;
        let n = piece.degree as f32;
        let (mut f, mut c) = (1.0, 1.0);
        let mut sum = glam::Vec3::from(points[0]) * s;
        for k in 1..piece.degree {
            f *= t;
            c *= (n - k as f32 + 1.0) / k as f32;
            sum = (sum + glam::Vec3::from(points[k as usize]) * (f * c)) * s;
        }
        sum += glam::Vec3::from(points[piece.degree as usize]) * (f * t);
        Vec2::new(sum.x, sum.y) / sum.z
    }
}

/// The range of u of a piece between two scan lines, with some units in the last place to spare for u and for the
/// lines. The shader rounds the piece, and in a nearly horizontal piece one unit of v is many units of u.
fn clipped(piece: &Piece, curve: &Bezier<DVec3>, bottom: f32, top: f32) -> (f32, f32) {
    let (lower, upper) =
        if piece.start[1] <= piece.end[1] { (piece.start, piece.end) } else { (piece.end, piece.start) };
    let at = |v: f32| {
        let rises = piece.end[1] > piece.start[1];
        let (mut a, mut b) = (0.0, 1.0);
        for _ in 0..48 {
            let t = 0.5 * (a + b);
            if (curve.point(t).y >= f64::from(v)) == rises { b = t } else { a = t }
        }
        curve.point(b).x as f32
    };
    let slack = 8.0 * f32::EPSILON;
    let (bottom, top) = (bottom - slack, top + slack);
    // a horizontal piece lies in the band as a whole
    let a = if bottom <= lower[1] { lower[0] } else { at(bottom) };
    let b = if top >= upper[1] { upper[0] } else { at(top) };
    (a.min(b) - slack, a.max(b) + slack)
}
