//! A B-spline surface as a support: inversion, closedness, collapsed sides, repetition.

use super::pieces::creases;
use super::support::Pole;
use crate::spline::arc::assemble;
use crate::spline::{BSpline, Control, Jet, PatchGrid, Span, SplineError, Surface, SurfacePatch};
use glam::{DVec2, DVec3, DVec4};
use std::cell::{Cell, OnceCell};

/// A surface with what its inversion needs.
#[derive(Clone, Debug)]
pub(super) struct SplineForm {
    /// As the source states it.
    pub surface: Surface,
    grid: PatchGrid,
    /// Where each patch lies; made by the first search.
    places: OnceCell<Vec<PatchPlace>>,
    /// Parameter ranges.
    pub domain: [(f64, f64); 2],
    /// First and last side coincide, in `u` and in `v`.
    pub closed: [bool; 2],
    /// Diagonal of the control points' box, mm.
    size: f64,
    /// Knots of low continuity, in `u` and in `v`; the seam of a closed direction is one.
    pub creases: [Vec<f64>; 2],
    /// Evaluations since the last call of `take_work`.
    work: Cell<u64>,
    /// The patch that was evaluated last.
    near: Cell<usize>,
}

/// Where a patch lies.
#[derive(Clone, Debug)]
struct PatchPlace {
    /// Box of its control points.
    bounds: (DVec3, DVec3),
    /// Its points from which a search begins, once it was searched.
    seeds: OnceCell<Vec<DVec3>>,
}

/// Boxes that take as long to test and to sort as one evaluation.
const BOXES: u64 = 4;

impl SplineForm {
    /// Steps of Newton's method from one start, where nothing calls for fewer.
    pub const STEPS: usize = 40;

    /// `eps`: distance in mm at which two sides are the same.
    pub fn new(surface: &Surface, eps: f64) -> Self {
        let (u, v) = surface.domain();
        let grid = surface.patches();
        let (ku, kv) = surface.knots();
        let (du, dv) = surface.degrees();
        let (lo, hi) = surface.bounds();
        let mut this = Self {
            size: lo.distance(hi),
            surface: surface.clone(),
            grid,
            places: OnceCell::new(),
            domain: [u, v],
            closed: [false; 2],
            creases: [creases(du, ku), creases(dv, kv)],
            work: Cell::new(0),
            near: Cell::new(0),
        };
        this.closed = [0, 1].map(|axis| {
            let (a, b) = this.domain[axis];
            let mut spread = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let meet = this.side(axis, a).zip(this.side(axis, b)).all(|(p, q)| {
                spread = (spread.0.min(p), spread.1.max(p));
                p.distance(q) <= eps
            });
            // two sides collapsed to one point do not make a tube
            meet && (spread.1 - spread.0).length() > eps
        });
        for axis in 0..2 {
            if this.closed[axis] {
                this.creases[axis].insert(0, this.domain[axis].0);
            }
        }
        this
    }

    /// The pieces of the side where `axis` has the value of one of its ends: the range of the other coordinate, and
    /// the control points. `None` unless there are `count` of them, of that degree.
    pub fn border(&self, axis: usize, value: f64, count: usize, degree: usize) -> Option<Vec<Span<Vec<DVec4>>>> {
        let (degrees, counts) = (self.surface.degrees(), [self.grid.count_u, self.grid.count_v]);
        let degrees = [degrees.0, degrees.1];
        if counts[1 - axis] != count || degrees[1 - axis] != degree {
            return None;
        }
        let last = value == self.domain[axis].1;
        let fixed = |n: usize| if last { n } else { 0 };
        let piece = |i: usize| {
            let along = [fixed(counts[axis] - 1), i];
            let p = &self.grid.patches[along[1 - axis] * counts[0] + along[axis]];
            let point = |k: usize| {
                let at = [fixed(degrees[axis]), k];
                p.patch.points[at[1 - axis] * (degrees[0] + 1) + at[axis]]
            };
            let (start, end) = if axis == 0 { p.v } else { p.u };
            Span { start, end, piece: (0..=degree).map(point).collect() }
        };
        Some((0..count).map(piece).collect())
    }

    /// Points along the side where `axis` has the given value.
    fn side(&self, axis: usize, value: f64) -> impl Iterator<Item = DVec3> {
        const SAMPLES: usize = 24;
        let (a, b) = self.domain[1 - axis];
        (0..=SAMPLES).map(move |i| {
            let t = a + (b - a) * i as f64 / SAMPLES as f64;
            let p = if axis == 0 { DVec2::new(value, t) } else { DVec2::new(t, value) };
            self.grid.point(p.x, p.y)
        })
    }

    /// Sides that are one point.
    pub fn poles(&self, eps: f64) -> Vec<Pole> {
        let mut poles = Vec::new();
        for axis in (0..2).filter(|a| !self.closed[*a]) {
            for value in [self.domain[axis].0, self.domain[axis].1] {
                let mut side = self.side(axis, value);
                if let Some(point) = side.next()
                    && side.all(|p| p.distance(point) <= eps)
                {
                    poles.push(Pole { axis, value, point, reach: Pole::REACH * eps });
                }
            }
        }
        poles
    }

    /// Parameters in the domain: wrapped where closed, clamped elsewhere.
    pub fn wrap(&self, p: DVec2) -> DVec2 {
        let one = |i: usize| {
            let (a, b) = self.domain[i];
            let inside = (a..=b).contains(&p[i]);
            if self.closed[i] && !inside { a + (p[i] - a).rem_euclid(b - a) } else { p[i].clamp(a, b) }
        };
        DVec2::new(one(0), one(1))
    }

    /// Point and derivatives; parameters wrap or clamp.
    pub fn jet(&self, p: DVec2) -> Jet {
        let p = self.wrap(p);
        // mostly that of the point before; a patch holds its first sides, not its last ones
        let holds = |q: &SurfacePatch| q.u.0 <= p.x && p.x < q.u.1 && q.v.0 <= p.y && p.y < q.v.1;
        if !holds(&self.grid.patches[self.near.get()]) {
            self.near.set(self.grid.index(p.x, p.y));
        }
        self.grid.patches[self.near.get()].jet(p.x, p.y)
    }

    /// Distance of `p` from the nearest point of the surface, and the parameters of that.
    ///
    /// From `hint` if Newton's method ends within `accept` mm of `p`; else from the best patches. It takes at most
    /// `steps` each time.
    pub fn invert(&self, p: DVec3, hint: Option<DVec2>, accept: f64, steps: usize) -> (f64, DVec2) {
        let near = hint.map(|h| self.polish(p, h, steps));
        if let Some(near) = near
            && near.0 <= accept
        {
            return near;
        }
        let far = self.search(p, steps);
        match near {
            // equally good: stay where the curve was
            Some(near) if near.0 <= 1.5 * far.0 => near,
            _ => far,
        }
    }

    /// Bézier patches.
    pub fn patch_count(&self) -> usize {
        self.grid.patches.len()
    }

    /// Evaluations that inversion took since the last call.
    pub fn take_work(&self) -> u64 {
        self.work.take()
    }

    fn worked(&self, evaluations: u64) {
        self.work.set(self.work.get() + evaluations);
    }

    /// Global search: patches in order of the distance to their boxes, polished from the best of a
    /// grid of samples, until no box can hold a nearer point.
    fn search(&self, p: DVec3, steps: usize) -> (f64, DVec2) {
        let place = |q: &SurfacePatch| PatchPlace { bounds: q.patch.bounds(), seeds: OnceCell::new() };
        let places = self.places.get_or_init(|| self.grid.patches.iter().map(place).collect());
        let gap = |place: &PatchPlace| p.distance(p.clamp(place.bounds.0, place.bounds.1));
        let mut order: Vec<(f64, usize)> = places.iter().map(gap).zip(0..).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.worked(order.len() as u64 / BOXES);
        let mut best = (f64::INFINITY, DVec2::new(self.domain[0].0, self.domain[1].0));
        for (gap, i) in order {
            // boxes touch at their borders: the point on a border need not be found twice
            if gap >= best.0 || best.0 == 0.0 {
                break;
            }
            let patch = &self.grid.patches[i];
            let (n, k) = seed_counts(patch);
            let points = places[i].seeds.get_or_init(|| seeds(patch));
            self.worked(points.len() as u64 / BOXES);
            let mut seed = (f64::INFINITY, DVec2::ZERO);
            for (index, point) in points.iter().enumerate() {
                let d = point.distance(p);
                if d < seed.0 {
                    let (s, t) = ((index % (n + 1)) as f64 / n as f64, (index / (n + 1)) as f64 / k as f64);
                    let at = |(a, b): (f64, f64), x: f64| a + (b - a) * x;
                    seed = (d, DVec2::new(at(patch.u, s), at(patch.v, t)));
                }
            }
            let found = self.polish(p, seed.1, steps);
            if found.0 < best.0 {
                best = found;
            }
        }
        best
    }

    /// Gauss-Newton on the distance to `p` with halved steps where it does not fall; a coordinate on
    /// the border that pushes outward stays there. Returns the distance and unwrapped parameters.
    fn polish(&self, p: DVec3, start: DVec2, steps: usize) -> (f64, DVec2) {
        let fine = 1e-12 * self.size;
        let clamp = |q: DVec2| {
            let one = |i: usize| if self.closed[i] { q[i] } else { q[i].clamp(self.domain[i].0, self.domain[i].1) };
            DVec2::new(one(0), one(1))
        };
        let range = DVec2::new(self.domain[0].1 - self.domain[0].0, self.domain[1].1 - self.domain[1].0);
        let mut at = clamp(start);
        let mut jet = self.jet(at);
        self.worked(1);
        let mut distance = jet.point.distance(p);
        let mut before = 0.0;
        for _ in 0..steps {
            let r = p - jet.point;
            let mut g = DVec2::new(jet.du.dot(r), jet.dv.dot(r));
            let (mut a, mut b, mut c) = (jet.du.length_squared(), jet.du.dot(jet.dv), jet.dv.length_squared());
            for i in 0..2 {
                let (lo, hi) = self.domain[i];
                let outward = !self.closed[i] && ((at[i] <= lo && g[i] < 0.0) || (at[i] >= hi && g[i] > 0.0));
                if outward {
                    (g[i], b) = (0.0, 0.0);
                    if i == 0 { a = 1.0 } else { c = 1.0 }
                }
            }
            // damping far below any useful curvature: it only keeps collapsed sides solvable
            let damping = 1e-14 * (a + c);
            (a, c) = (a + damping, c + damping);
            let det = a * c - b * b;
            let step = DVec2::new(c * g.x - b * g.y, a * g.y - b * g.x) / det;
            if det <= 0.0 || !step.is_finite() {
                break;
            }
            // convergence is quadratic, so the remaining error is below this step shrunk by the last factor again; the
            // step is so short that the tangent plane is the surface
            let length = (step * DVec2::new(jet.du.length(), jet.dv.length())).length();
            if length <= fine || (length <= 1e5 * fine && length * length <= fine * before) {
                let last = clamp(at + step);
                let by = last - at;
                let last_distance = (jet.point + jet.du * by.x + jet.dv * by.y).distance(p);
                return if last_distance <= distance { (last_distance, last) } else { (distance, at) };
            }
            before = length;
            let mut factor = 1.0;
            let mut moved = false;
            while factor > 1e-3 {
                let next = clamp(at + (step * factor).clamp(-0.5 * range, 0.5 * range));
                let next_jet = self.jet(next);
                self.worked(1);
                let next_distance = next_jet.point.distance(p);
                if next_distance < distance {
                    (at, jet, distance, moved) = (next, next_jet, next_distance, true);
                    break;
                }
                factor *= 0.5;
            }
            if !moved {
                break;
            }
        }
        (distance, at)
    }

    /// The surface over at least `u`, `v`, repeated across its seams where that leaves the domain;
    /// whole where it does not.
    ///
    /// # Errors
    /// `None` when the weights along a seam forbid repetition.
    pub fn carrier(&self, range: [(f64, f64); 2]) -> Result<Surface, Option<SplineError>> {
        let leaves = |i: usize| {
            let (a, b) = self.domain[i];
            let slack = 1e-9 * (b - a);
            self.closed[i] && (range[i].0 < a - slack || range[i].1 > b + slack)
        };
        let mut surface = self.surface.clone();
        if leaves(0) {
            surface = repeat_u(&surface, range[0])?;
        }
        if leaves(1) {
            surface = repeat_u(&surface.transposed(), range[1])?.transposed();
        }
        Ok(surface)
    }
}

/// Steps of a patch's grid of seeds along `u` and `v`.
fn seed_counts(patch: &SurfacePatch) -> (usize, usize) {
    (patch.patch.degree_u + 2, patch.patch.degree_v + 2)
}

/// The grid of seeds, `u` fastest.
fn seeds(patch: &SurfacePatch) -> Vec<DVec3> {
    let (n, k) = seed_counts(patch);
    let point = |i: usize, j: usize| patch.patch.point(i as f64 / n as f64, j as f64 / k as f64);
    (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| point(i, j)).collect()
}

/// The Bézier strips of the endless repetition of `surface` along `u` that meet `(lo, hi)`.
///
/// Where the weights of the two sides differ by a common factor the copies are scaled to agree; the
/// seam points are then one column of control points, so the copies meet bit for bit.
fn repeat_u(surface: &Surface, (lo, hi): (f64, f64)) -> Result<Surface, Option<SplineError>> {
    if !seam_weights_agree(surface) {
        return Err(None);
    }
    let ((u0, u1), _) = surface.domain();
    let period = u1 - u0;
    let (nu, nv) = surface.counts();
    let mut knots = Vec::new();
    let mut points: Vec<DVec4> = Vec::new();
    for j in 0..nv {
        let row = surface.points()[j * nu..(j + 1) * nu].to_vec();
        let spans = BSpline::new(surface.degrees().0, surface.knots().0.to_vec(), row).map_err(Some)?.beziers();
        let mut chosen: Vec<Span<_>> = Vec::new();
        let mut turn = ((lo - u0) / period).floor();
        while u0 + turn * period < hi {
            for s in &spans {
                let (start, end) = (s.start + turn * period, s.end + turn * period);
                let sliver = 1e-9 * (end - start);
                if end > lo + sliver && start < hi - sliver {
                    chosen.push(Span { start, end, piece: s.piece.clone() });
                }
            }
            turn += 1.0;
        }
        let (_, k, p) = assemble(&chosen);
        knots = k;
        points.extend(p);
    }
    Surface::new(surface.degrees(), knots, surface.knots().1.to_vec(), points).map_err(Some)
}

/// Weights of the two sides along `u` stand in one ratio (within `1e-9`), so that copies can be
/// scaled to meet.
fn seam_weights_agree(s: &Surface) -> bool {
    let (nu, nv) = s.counts();
    let ((u0, u1), _) = s.domain();
    let ratio = |j: usize| {
        let row = s.points()[j * nu..(j + 1) * nu].to_vec();
        let c = BSpline::new(s.degrees().0, s.knots().0.to_vec(), row).ok()?;
        Some(c.homogeneous(u1).weight() / c.homogeneous(u0).weight())
    };
    let first = ratio(0);
    (1..nv).all(|j| matches!((first, ratio(j)), (Some(a), Some(b)) if (a - b).abs() <= 1e-9 * a.abs()))
}
