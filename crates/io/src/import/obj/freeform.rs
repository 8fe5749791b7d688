//! Free-form curves and surfaces: the statements between `curv2` or `surf` and `end`.
//!
//! ```text
//!   cstype rat bspline, deg 2 2           the state when the element begins
//!   surf u0 u1 v0 v1  c00 c10 c20 c01 …   control points, u fastest
//!   parm u …, parm v …                    knots, or the ends of segments
//!   trim a b n  c d m  …                  pieces [a, b] of curve n, [c, d] of curve m: one outer loop
//!   hole …                                one inner loop
//!   end                                   ▶ Face over [u0, u1] x [v0, v1]
//! ```
//!
//! Weights (the fourth number of `v`, the third of `vp`) count where `cstype` says `rat`.
//!
//! Source: Alias|Wavefront, *Advanced Visualizer Manual*, appendix B1, "Specifying free-form curves and
//! surfaces".

use super::axis::{Axis, Basis};
use crate::brep::crossing_note;
use crate::import::chain::{ROUNDING, chain};
use crate::model::{Face, SurfaceKind, TrimLoop};
use crate::spline::{BSpline, Bezier, Control, Surface};
use glam::{DVec2, DVec3, DVec4};

/// The last `cstype`, `deg`, `step` and `bmatrix`.
#[derive(Clone, Default)]
pub(super) struct State {
    pub rational: bool,
    pub basis: Option<Basis>,
    pub degree: [usize; 2],
    pub step: [usize; 2],
    pub matrix: [Vec<f64>; 2],
}

/// One piece of a loop: from and to parameter of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub from: f64,
    pub to: f64,
    /// Place among the curves of the file.
    pub curve: usize,
}

/// A loop as stated.
pub(super) struct Trim {
    pub pieces: Vec<Piece>,
    pub hole: bool,
}

/// An element while it is read.
pub(super) struct Element {
    pub state: State,
    pub parm: [Vec<f64>; 2],
    pub trims: Vec<Trim>,
    pub points: Vec<DVec4>,
    pub range: [f64; 4],
}

/// Curves in `(u, v)` by their number less one; `None` where one could not be built.
pub(super) type Curves = Vec<Option<BSpline<DVec3>>>;

/// Largest gap that a line closes, relative to the size of the loop; printed numbers have few digits.
const MAX_GAP: f64 = 1e-3;

impl Element {
    fn axis(&self, direction: usize) -> Result<Axis, String> {
        let basis = self.state.basis.ok_or("no cstype that is known")?;
        let State { degree, step, matrix, .. } = &self.state;
        let name = ["u", "v"][direction];
        Axis::new(basis, degree[direction], step[direction], &matrix[direction], &self.parm[direction])
            .map_err(|why| format!("parm {name}: {why}"))
    }

    /// The points as the bases take them: homogeneous, or without a weight where nothing is divided,
    /// since not every basis sums to one.
    fn taken(&self) -> impl Iterator<Item = DVec4> {
        let rational = self.state.rational;
        self.points.iter().map(move |&p| if rational { DVec4::from_point(p.truncate(), p.w) } else { p.with_w(0.0) })
    }

    /// The weight of a control point that a basis made.
    fn weight(&self, w: f64) -> f64 {
        if self.state.rational { w } else { 1.0 }
    }

    /// A curve of the `(u, v)` plane; points are `(u, v, 0, weight)`.
    pub fn curve(&self) -> Result<BSpline<DVec3>, String> {
        let axis = self.axis(0)?;
        fits(axis.count, self.points.len())?;
        let points = axis.apply(&self.taken().map(|p| DVec3::new(p.x, p.y, p.w)).collect::<Vec<_>>())?;
        let points = points.into_iter().map(|p| p.with_z(self.weight(p.z))).collect();
        BSpline::new(axis.degree, axis.knots, points).map_err(|e| e.to_string())
    }

    /// The face of a surface, and notes on repairs. `work` falls by the control points that are made.
    pub fn face(&self, id: u32, curves: &Curves, work: &mut usize) -> Result<(Face, Vec<String>), String> {
        let (u, v) = (self.axis(0)?, self.axis(1)?);
        fits(u.count.saturating_mul(v.count), self.points.len())?;
        spend(work, u.output().saturating_mul(v.count.max(v.output())))?;
        let points: Vec<DVec4> = self.taken().collect();
        let rows = points.chunks_exact(u.count).map(|row| u.apply(row)).collect::<Result<Vec<_>, _>>()?;
        let columns = (0..u.output()).map(|i| v.apply(&rows.iter().map(|r| r[i]).collect::<Vec<_>>()));
        let columns = columns.collect::<Result<Vec<_>, _>>()?;
        let net = (0..v.output()).flat_map(|j| columns.iter().map(move |c| c[j]));
        let net = net.map(|p| p.with_w(self.weight(p.w))).collect();
        let surface = Surface::new((u.degree, v.degree), u.knots, v.knots, net).map_err(|e| e.to_string())?;
        let mut notes = Vec::new();
        let surface = self.within_range(surface, &mut notes)?;
        let mut loops = Vec::new();
        for trim in &self.trims {
            loops.push(trim.build(curves, work, &mut notes)?);
        }
        if !loops.is_empty() && self.trims.iter().all(|t| t.hole) {
            let ((u0, u1), (v0, v1)) = surface.domain();
            let corners = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)].map(DVec2::from);
            let sides = (0..4).map(|i| Bezier::line(corners[i], corners[(i + 1) % 4])).collect();
            loops.insert(0, TrimLoop::new(sides, DVec2::ZERO).map_err(|e| e.to_string())?);
        }
        notes.extend(crossing_note(&loops));
        let face = Face { id, kind: SurfaceKind::BSpline, surface, loops, same_sense: true, colour: None };
        Ok((face, notes))
    }

    /// The surface cut to the range that `surf` states.
    fn within_range(&self, surface: Surface, notes: &mut Vec<String>) -> Result<Surface, String> {
        let (u, v) = surface.domain();
        let mut cut = |[a, b]: [f64; 2], (lo, hi): (f64, f64)| {
            if !(a.is_finite() && b.is_finite() && a.max(lo) < b.min(hi)) {
                return Err(format!("range {a} {b} outside the domain {lo} {hi}"));
            }
            let slack = ROUNDING * (hi - lo);
            if a < lo - slack || b > hi + slack {
                notes.push(format!("range {a} {b} beyond the domain {lo} {hi}"));
            }
            let snap = |x: f64, end: f64| if (x - end).abs() <= slack { end } else { x };
            Ok((snap(a.max(lo), lo), snap(b.min(hi), hi)))
        };
        let [u0, u1, v0, v1] = self.range;
        let (to_u, to_v) = (cut([u0, u1], u)?, cut([v0, v1], v)?);
        if (to_u, to_v) == (u, v) {
            return Ok(surface);
        }
        surface.within(to_u, to_v).map_err(|e| e.to_string())
    }
}

impl Trim {
    fn build(&self, curves: &Curves, work: &mut usize, notes: &mut Vec<String>) -> Result<TrimLoop, String> {
        let mut beziers: Vec<Bezier<DVec3>> = Vec::new();
        for piece in &self.pieces {
            let number = piece.curve + 1;
            let curve = curves[piece.curve].as_ref().ok_or(format!("trim curve {number} could not be built"))?;
            let (lo, hi) = curve.domain();
            let (a, b) = (piece.from.min(piece.to).max(lo), piece.from.max(piece.to).min(hi));
            if a >= b {
                return Err(format!("trim curve {number} has no part from {} to {}", piece.from, piece.to));
            }
            spend(work, curve.points().len())?;
            let spans = curve.beziers_between(a, b);
            let pieces = spans.into_iter().map(|s| s.piece);
            if piece.from <= piece.to {
                beziers.extend(pieces);
            } else {
                beziers.extend(pieces.rev().map(Bezier::reversed));
            }
        }
        chain(&beziers, self.hole, notes, |a, b, size| (a - b).abs().max_element() <= MAX_GAP * size)
    }
}

fn fits(wanted: usize, given: usize) -> Result<(), String> {
    if wanted == given { Ok(()) } else { Err(format!("{given} control points where parm asks for {wanted}")) }
}

/// Takes `amount` off the work that is left.
fn spend(work: &mut usize, amount: usize) -> Result<(), String> {
    match work.checked_sub(amount) {
        Some(rest) => *work = rest,
        None => return Err("geometry is shared so often that the work was cut off".into()),
    }
    Ok(())
}
