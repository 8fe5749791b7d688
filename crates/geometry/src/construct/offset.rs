//! The surface at a constant distance from a surface.
//!
//! ```text
//!   ───────────────  S + d n          n: unit normal, on the side of S_u × S_v; a limit at poles
//!     ↑   ↑   ↑  d
//!   ───────────────  S
//!    sites: ├─┼─┼─┼───┼───┤           tensor-product cubic splines through S + d n at sites, halved where the
//!                                     error between them is too large
//! ```
//!
//! One spline each between *creases*, the knots where `S` is less than C²; all of them meet along the creases, where
//! their sites are the same.

use super::{Built, ConstructError};
use crate::spline::cubic::{Cubic, Ends, tensor};
use crate::spline::{Control, Patch, PatchGrid, Surface};
use glam::{DVec3, DVec4};

/// Most cells between sites.
const MOST_CELLS: usize = 1 << 17;
/// Share of the size that rounding leaves of any tolerance.
const ROUNDING: f64 = 1e-13;
/// Sites in each knot span to begin with.
const FIRST: usize = 4;
/// Radians between the normals on both sides of a knot above which it is an edge.
const EDGE: f64 = 1e-6;
/// Factor for the error between the samples.
const MARGIN: f64 = 1.2;

/// `S + distance n` over the same domain; negative distances lie on the other side. A plane's is exact.
///
/// C² between the creases of `S`, continuous across them. Folds are searched at the sites and between them.
///
/// # Errors
/// Numbers out of range; a surface with an edge inside, or without a normal; a distance beyond a centre of
/// curvature; a tolerance that is not reached.
pub fn offset(surface: &Surface, distance: f64, tolerance: f64) -> Result<Built, ConstructError> {
    if !distance.is_finite() {
        return Err(ConstructError::NotFinite { what: "the distance of an offset" });
    }
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(ConstructError::Range { what: "the tolerance", value: tolerance, must: "positive" });
    }
    if let Some(surface) = plane(surface, distance) {
        return Ok(Built { surface, deviation: 0.0 });
    }
    let source = Source { surface, grid: surface.patches(), distance };
    source.edges()?;
    let (ku, kv) = surface.knots();
    let (du, dv) = surface.degrees();
    let (lo, hi) = surface.bounds();
    let rounding = ROUNDING * (lo.distance(hi) + distance.abs());
    let (mut u, mut v) = (Axis::new(du, ku), Axis::new(dv, kv));
    loop {
        let (built, cells) = source.attempt(&u, &v)?;
        let deviation = MARGIN * cells.iter().map(|c| c.2).fold(0.0, f64::max);
        if deviation <= tolerance {
            return Ok(Built { surface: built, deviation });
        }
        let (mut split_u, mut split_v) = (vec![false; u.sites.len()], vec![false; v.sites.len()]);
        for (i, j, error, [along_u, along_v]) in &cells {
            if MARGIN * error > tolerance {
                split_u[*i] |= along_u >= along_v || 2.0 * MARGIN * along_u > tolerance;
                split_v[*j] |= along_v >= along_u || 2.0 * MARGIN * along_v > tolerance;
            }
        }
        u.halve(&split_u);
        v.halve(&split_v);
        let pieces = u.sites.len() * v.sites.len();
        if pieces > MOST_CELLS || tolerance < rounding {
            return Err(ConstructError::Bound { asked: tolerance, reached: deviation, pieces });
        }
    }
}

/// A plane moved along its normal.
fn plane(surface: &Surface, distance: f64) -> Option<Surface> {
    let (lo, hi) = surface.bounds();
    let ((u0, u1), (v0, v1)) = surface.domain();
    let jet = surface.jet(0.5 * (u0 + u1), 0.5 * (v0 + v1));
    let n = jet.du.cross(jet.dv).try_normalize()?;
    let flat = |p: &DVec4| (p.point() - jet.point).dot(n).abs() <= 1e-15 * lo.distance(hi);
    let moved = || surface.transformed(&glam::DAffine3::from_translation(n * distance));
    surface.points().iter().all(flat).then(moved)
}

/// The sites along one parameter.
struct Axis {
    /// Increasing, over the domain.
    sites: Vec<f64>,
    /// Sites at which splines end, both ends of the domain among them.
    creases: Vec<f64>,
}

impl Axis {
    fn new(degree: usize, knots: &[f64]) -> Self {
        let inside = &knots[degree..knots.len() - degree];
        let (a, b) = (inside[0], inside[inside.len() - 1]);
        let runs: Vec<(f64, usize)> = inside.chunk_by(|x, y| x == y).map(|run| (run[0], run.len())).collect();
        let crease = |&&(x, n): &&(f64, usize)| x == a || x == b || n + 2 > degree;
        let creases = runs.iter().filter(crease).map(|r| r.0).collect();
        let span = |w: &[(f64, usize)]| {
            let (lo, hi) = (w[0].0, w[1].0);
            (0..FIRST).map(move |k| lo + (hi - lo) * k as f64 / FIRST as f64)
        };
        Self { sites: runs.windows(2).flat_map(span).chain([b]).collect(), creases }
    }

    /// The marked intervals in half.
    fn halve(&mut self, marked: &[bool]) {
        let middles = self.sites.windows(2).zip(marked).filter(|(_, m)| **m).map(|(w, _)| 0.5 * (w[0] + w[1]));
        let middles: Vec<f64> = middles.collect();
        self.sites.extend(middles);
        self.sites.sort_by(f64::total_cmp);
        self.sites.dedup();
    }

    /// Ranges of sites between creases.
    fn blocks(&self) -> Vec<std::ops::RangeInclusive<usize>> {
        let index = |x: f64| self.sites.partition_point(|s| *s < x);
        self.creases.windows(2).map(|w| index(w[0])..=index(w[1])).collect()
    }
}

/// The surface and its distance.
struct Source<'a> {
    surface: &'a Surface,
    grid: PatchGrid,
    distance: f64,
}

/// Indices of its sites, its error, and the errors halfway along `u` and along `v`.
type Cell = (usize, usize, f64, [f64; 2]);

impl Source<'_> {
    /// Point and unit normal.
    fn normal(&self, patch: &Patch, s: f64, t: f64) -> Option<(DVec3, DVec3)> {
        let jet = patch.jet(s, t);
        let cross = jet.du.cross(jet.dv);
        let sound = cross.length() > 1e-4 * jet.du.length() * jet.dv.length();
        let size = jet.du.length().min(jet.dv.length()) > 1e-3 * jet.du.length().max(jet.dv.length());
        let n = if sound && size { cross.normalize() } else { patch.normal(s, t)? };
        Some((jet.point, n))
    }

    /// `S + d n`.
    fn point(&self, u: f64, v: f64) -> Result<DVec3, ConstructError> {
        let (found, s, t) = self.grid.locate(u, v);
        let Some((p, n)) = self.normal(&found.patch, s, t) else {
            return Err(ConstructError::NoNormal { u, v });
        };
        Ok(p + n * self.distance)
    }

    /// No edge between patches.
    fn edges(&self) -> Result<(), ConstructError> {
        const SAMPLES: u32 = 8;
        let (nu, nv) = (self.grid.count_u, self.grid.count_v);
        for j in 0..nv {
            for i in 0..nu {
                let here = j * nu + i;
                for k in 0..=SAMPLES {
                    let x = f64::from(k) / f64::from(SAMPLES);
                    let mut both = Vec::new();
                    if i + 1 < nu {
                        both.push(((here, 1.0, x), (here + 1, 0.0, x), self.grid.patches[here].u.1));
                    }
                    if j + 1 < nv {
                        both.push(((here, x, 1.0), (here + nu, x, 0.0), self.grid.patches[here].v.1));
                    }
                    for (a, b, parameter) in both {
                        let normal = |(i, s, t): (usize, f64, f64)| self.normal(&self.grid.patches[i].patch, s, t);
                        let pair = (normal(a), normal(b));
                        if let (Some((_, m)), Some((_, n))) = pair
                            && m.distance(n) > EDGE
                        {
                            return Err(ConstructError::Corner { what: "the surface", parameter });
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Neither principal centre of curvature is reached at `(u, v)`.
    fn fold(&self, u: f64, v: f64) -> Result<(), ConstructError> {
        let jet = self.surface.jet2(u, v);
        let ((u0, u1), (v0, v1)) = self.surface.domain();
        let (along_u, along_v) = (jet.du.length() * (u1 - u0), jet.dv.length() * (v1 - v0));
        // near a pole the curvature is mostly rounding
        let sound = along_u.min(along_v) > 1e-6 * along_u.max(along_v);
        let Some(c) = jet.curvature().filter(|_| sound) else { return Ok(()) };
        for k in [c.most, c.least] {
            if self.distance * k >= 1.0 {
                return Err(ConstructError::FoldsAt { u, v, reach: self.distance.abs(), radius: 1.0 / k.abs() });
            }
        }
        Ok(())
    }

    /// The splines through the sites as one surface, and the error of each cell.
    fn attempt(&self, u: &Axis, v: &Axis) -> Result<(Surface, Vec<Cell>), ConstructError> {
        let nu = u.sites.len();
        let mut values = Vec::with_capacity(nu * v.sites.len());
        for y in &v.sites {
            for x in &u.sites {
                values.push(self.point(*x, *y)?.extend(1.0));
            }
        }
        let splines = |axis: &Axis| -> Result<Vec<Cubic>, ConstructError> {
            axis.blocks().into_iter().map(|b| Ok(Cubic::new(&axis.sites[b], Ends::NotAKnot)?)).collect()
        };
        let (along_u, along_v) = (splines(u)?, splines(v)?);
        let count = |all: &[Cubic]| 1 + all.iter().map(|c| c.count() - 1).sum::<usize>();
        let (cu, cv) = (count(&along_u), count(&along_v));
        let mut net = vec![DVec4::ZERO; cu * cv];
        let mut top = 0;
        for (rows, sv) in v.blocks().into_iter().zip(&along_v) {
            let mut left = 0;
            for (columns, su) in u.blocks().into_iter().zip(&along_u) {
                let block: Vec<DVec4> = rows
                    .clone()
                    .flat_map(|j| columns.clone().map(move |i| (i, j)))
                    .map(|(i, j)| values[j * nu + i])
                    .collect();
                let control = tensor(su, sv, &block);
                for (k, p) in control.into_iter().enumerate() {
                    net[(top + k / su.count()) * cu + left + k % su.count()] = p.with_w(1.0);
                }
                left += su.count() - 1;
            }
            top += sv.count() - 1;
        }
        let built = Surface::new((3, 3), joined(&along_u), joined(&along_v), net)?;
        let cells = self.cells(&built, u, v)?;
        Ok((built, cells))
    }

    fn cells(&self, built: &Surface, u: &Axis, v: &Axis) -> Result<Vec<Cell>, ConstructError> {
        const INSIDE: [f64; 3] = [0.2, 0.5, 0.8];
        let made = built.patches();
        let off = |x: f64, y: f64| Ok::<f64, ConstructError>(self.point(x, y)?.distance(made.point(x, y)));
        let mut cells = Vec::new();
        for (j, y) in v.sites.windows(2).enumerate() {
            for (i, x) in u.sites.windows(2).enumerate() {
                let at = |w: &[f64], f: f64| w[0] + (w[1] - w[0]) * f;
                let (mut error, mut along): (f64, [f64; 2]) = (0.0, [0.0; 2]);
                for f in INSIDE {
                    along[0] = along[0].max(off(at(x, f), y[0])?).max(off(at(x, f), y[1])?);
                    along[1] = along[1].max(off(x[0], at(y, f))?).max(off(x[1], at(y, f))?);
                    for g in INSIDE {
                        error = error.max(off(at(x, f), at(y, g))?);
                    }
                }
                self.fold(x[0], y[0])?;
                self.fold(at(x, 0.5), at(y, 0.5))?;
                cells.push((i, j, error.max(along[0]).max(along[1]), along));
            }
        }
        Ok(cells)
    }
}

/// One knot vector of splines end to end, triple knots between them.
fn joined(all: &[Cubic]) -> Vec<f64> {
    let mut knots: Vec<f64> = Vec::new();
    for c in all {
        let k = c.knots();
        if knots.is_empty() {
            knots.extend(k);
        } else {
            knots.pop();
            knots.extend(&k[4..]);
        }
    }
    knots
}
