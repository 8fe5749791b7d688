//! Trim curves on their surface as rational Bézier curves in space.
//!
//! ```text
//!    v ▲  ┌──────┬──────┐        cut where the curve passes a knot line, so that each piece lies on one patch
//!      │  │   ╭──●──╮   │
//!      │  │ ╭─╯  │  ╰─╮ │        S(u, v) = Σ P_ij B_i(u) B_j(v),  u = U(t) / W(t),  v = V(t) / W(t)
//!      │  ●─╯    │    ╰─●        de Casteljau's steps with polynomials in the place of numbers:
//!      │  └──────┴──────┘            b_i ◀─ (W - U) b_i + U b_i+1
//!      └─────────────────▶ u
//! ```
//!
//! A curve of degree `n` on a patch of degrees `p` and `q` becomes one of degree `n (p + q)`; `n p` where `v` is
//! constant. Exact but for rounding, which grows where a control point of the trim curve lies beyond the patch:
//! there a factor is negative, and terms cancel. A curve beyond the domain lies on the domain's border, as
//! [`Surface::jet2`](crate::spline::Surface::jet2) has it.
//!
//! A piece whose weights come out not positive is halved. One that still has such weights after [`MOST_HALVINGS`], or
//! whose degree exceeds [`MOST_DEGREE`], is replaced by chords in `(u, v)`; how far those lie off in space is part of the
//! piece's [`Curve::noise`].
//!
//! Source: T. DeRose, *Composing Bézier simplexes*, 1988.

use crate::math::bernstein::sign_changes;
use crate::spline::{Bezier, Control, Patch, PatchGrid, SurfacePatch, binomial};
use glam::{DVec2, DVec3, DVec4};

/// Largest degree of a composed curve: binomials, and with them rounding, stay far from the limits of `f64`.
const MOST_DEGREE: usize = 96;
/// Halvings before chords.
const MOST_HALVINGS: u32 = 6;
/// Chords of a piece that is not composed.
const CHORDS: usize = 32;

/// A part of a trim curve in space.
pub(super) struct Curve {
    /// Homogeneous control points, model coordinates.
    pub points: Vec<DVec4>,
    /// How far it may be off the trim curve, model units.
    pub noise: f64,
}

/// One patch of a surface, in model coordinates.
pub(super) struct Cell {
    /// Its part of the domain, and the patch over it.
    pub of: SurfacePatch,
    /// Bound of the rounding of its points, model units.
    pub noise: f64,
    /// Rounding of its parameters, shares of its sides.
    pub fine: DVec2,
}

/// The pieces of a trim curve; `cells[i]` is patch `i` of the grid, in its place.
pub(super) fn on_surface(curve: &Bezier<DVec3>, grid: &PatchGrid, cells: &[Cell]) -> Vec<Curve> {
    let mut cuts = vec![0.0, 1.0];
    let (first, last) = (&grid.patches[0], &grid.patches[grid.patches.len() - 1]);
    let of_u = grid.patches[..grid.count_u].iter().map(|p| p.u.0).chain([last.u.1]);
    let of_v = grid.patches.iter().step_by(grid.count_u).map(|p| p.v.0).chain([last.v.1]);
    let lines = of_u.map(|k| (0, k)).chain(of_v.map(|k| (1, k)));
    lines.for_each(|(axis, line)| cuts.extend(passes(curve, axis, line)));
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let (low, high) = (DVec2::new(first.u.0, first.v.0), DVec2::new(last.u.1, last.v.1));
    let mut all = Vec::new();
    for range in cuts.windows(2) {
        let at = curve.point(0.5 * (range[0] + range[1]));
        let cell = &cells[grid.index(at.x, at.y)];
        let (u, v) = (cell.of.u, cell.of.v);
        let share = |x: f64, w: f64, (a, b): (f64, f64)| (x - a * w) / (b - a);
        let piece = curve.segment(range[0], range[1]);
        let local = piece.points.iter().map(|p| DVec3::new(share(p.x, p.z, u), share(p.y, p.z, v), p.z)).collect();
        // beyond the domain: on its border
        let held = |k: usize| if at[k] < low[k] { Some(0.0) } else { (at[k] > high[k]).then_some(1.0) };
        composed(&Bezier { points: local }, [held(0), held(1)], cell, MOST_HALVINGS, &mut all);
    }
    all
}

/// Parameters where a curve passes a line of the domain.
fn passes(curve: &Bezier<DVec3>, axis: usize, line: f64) -> Vec<f64> {
    let beyond: Vec<f64> = curve.points.iter().map(|p| p[axis] - line * p.z).collect();
    if beyond.iter().all(|x| *x >= 0.0) || beyond.iter().all(|x| *x <= 0.0) {
        return Vec::new();
    }
    let noise = |p: &DVec3| 4.0 * f64::EPSILON * (p[axis].abs() + (line * p.z).abs());
    sign_changes(&beyond, &curve.points.iter().map(noise).collect::<Vec<_>>())
}

/// The curve's coordinate, where it has one value but for rounding.
fn constant(curve: &Bezier<DVec3>, axis: usize, fine: f64) -> Option<f64> {
    let value = curve.points[0][axis] / curve.points[0].z;
    let is_same = |p: &DVec3| (p[axis] - value * p.z).abs() <= fine * p.z;
    curve.points.iter().all(is_same).then_some(value.clamp(0.0, 1.0))
}

/// Appends a curve, given in the unit square of its patch.
fn composed(curve: &Bezier<DVec3>, held: [Option<f64>; 2], cell: &Cell, halvings: u32, all: &mut Vec<Curve>) {
    let fixed = [0, 1].map(|axis| held[axis].or_else(|| constant(curve, axis, cell.fine[axis])));
    let mut patch = cell.of.patch.clone();
    if let Some(v) = fixed[1] {
        patch = across(&patch.transposed(), v).transposed();
    }
    if let Some(u) = fixed[0] {
        patch = across(&patch, u);
    }
    let degree = curve.degree() * (patch.degree_u + patch.degree_v);
    if degree <= MOST_DEGREE {
        let points = substituted(curve, &patch);
        if points.iter().all(|p| p.is_finite() && p.w > 0.0) {
            let spread = spread(curve, 0).powi(patch.degree_u as i32) * spread(curve, 1).powi(patch.degree_v as i32);
            all.push(Curve { points, noise: cell.noise * spread });
            return;
        }
    }
    if halvings > 0 && degree <= MOST_DEGREE {
        let (a, b) = curve.split(0.5);
        composed(&a, held, cell, halvings - 1, all);
        composed(&b, held, cell, halvings - 1, all);
        return;
    }
    let (along_u, along_v) = cell.of.patch.speed_bound();
    for i in 0..CHORDS {
        let part = curve.segment(i as f64 / CHORDS as f64, (i + 1) as f64 / CHORDS as f64);
        let [from, to] = [0, part.degree()].map(|k| part.points[k].point().clamp(DVec2::ZERO, DVec2::ONE));
        // each control point is as near to the chord as the nearest of its points
        let along = to - from;
        let off = |p: &DVec3| {
            let of = p.point() - from;
            let share = of.dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
            let apart = (of - along * share.clamp(0.0, 1.0)).abs();
            apart.x * along_u + apart.y * along_v
        };
        let noise = cell.noise + part.points.iter().map(off).fold(0.0, f64::max);
        all.push(Curve { points: substituted(&Bezier::line(from, to), &patch), noise });
    }
}

/// How many times as large as their sum the two factors of a de Casteljau step may be; 1 within the patch.
fn spread(curve: &Bezier<DVec3>, axis: usize) -> f64 {
    curve.points.iter().map(|p| ((p.z - p[axis]).abs() + p[axis].abs()) / p.z).fold(1.0, f64::max)
}

/// The curve of a patch at one `u`, as a patch of degree 0 along `u`.
fn across(patch: &Patch, u: f64) -> Patch {
    let row = |j: usize| Bezier { points: patch.row(j).to_vec() }.homogeneous(u);
    Patch { degree_u: 0, degree_v: patch.degree_v, points: (0..=patch.degree_v).map(row).collect() }
}

/// Control points of the patch along the curve, whose degree is the product.
fn substituted(curve: &Bezier<DVec3>, patch: &Patch) -> Vec<DVec4> {
    // coefficients times binomials: products are convolutions
    let scaled = |value: &dyn Fn(&DVec3) -> f64| -> Vec<f64> {
        let n = curve.degree();
        curve.points.iter().enumerate().map(|(i, p)| value(p) * binomial(n, i)).collect()
    };
    let factors = [0, 1].map(|axis| [scaled(&|p| p.z - p[axis]), scaled(&|p| p[axis])]);
    let step = |polynomials: &[Vec<DVec4>], [less, more]: &[Vec<f64>; 2]| -> Vec<Vec<DVec4>> {
        let mixed = |pair: &[Vec<DVec4>]| {
            let mut sum = vec![DVec4::ZERO; pair[0].len() + less.len() - 1];
            for (factor, of) in [(less, &pair[0]), (more, &pair[1])] {
                for (i, f) in factor.iter().enumerate() {
                    of.iter().enumerate().for_each(|(k, p)| sum[i + k] += *p * *f);
                }
            }
            sum
        };
        polynomials.windows(2).map(mixed).collect()
    };
    let row = |j: usize| {
        let mut row: Vec<Vec<DVec4>> = patch.row(j).iter().map(|p| vec![*p]).collect();
        while row.len() > 1 {
            row = step(&row, &factors[0]);
        }
        row.remove(0)
    };
    let mut rows: Vec<Vec<DVec4>> = (0..=patch.degree_v).map(row).collect();
    while rows.len() > 1 {
        rows = step(&rows, &factors[1]);
    }
    let points = rows.remove(0);
    let n = points.len() - 1;
    points.iter().enumerate().map(|(k, p)| *p * (1.0 / binomial(n, k))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use crate::spline::Surface;

    fn surface(random: &mut Random) -> Surface {
        let mut point = |i: usize, j: usize| {
            let at = DVec3::new(i as f64, j as f64, random.range(-2.0, 2.0));
            DVec4::from_point(at, random.range(0.3, 3.0))
        };
        let net = (0..4).flat_map(|j| (0..5).map(move |i| (i, j))).map(|(i, j)| point(i, j)).collect();
        let knots = (vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0], vec![2.0, 2.0, 2.0, 3.0, 5.0, 5.0, 5.0]);
        Surface::new((3, 2), knots.0, knots.1, net).expect("a surface")
    }

    fn cells(grid: &PatchGrid) -> Vec<Cell> {
        let cell = |of: &SurfacePatch| Cell { of: of.clone(), noise: 1e-14, fine: DVec2::splat(1e-15) };
        grid.patches.iter().map(cell).collect()
    }

    /// Points of random curves, evaluated in two steps, lie on the pieces within a piece's noise and the rounding of a
    /// curve of degree 15.
    #[test]
    fn pieces_are_the_curve_on_the_surface() {
        let mut random = Random::new(3);
        for case in 0..40 {
            let (surface, degree) = (surface(&mut random), 1 + case % 3);
            let grid = surface.patches();
            let mut point = || DVec2::new(random.range(0.0, 1.0), random.range(2.0, 5.0));
            let mut points: Vec<DVec2> = (0..=degree).map(|_| point()).collect();
            if case % 4 == 0 {
                points.iter_mut().for_each(|p| p.y = 2.5);
            }
            let points = points.iter().map(|p| DVec3::from_point(*p, random.range(0.5, 2.0))).collect();
            let curve = Bezier { points };
            let pieces = on_surface(&curve, &grid, &cells(&grid));
            let ends = |c: &Curve| [c.points[0].point(), c.points[c.points.len() - 1].point()];
            for pair in pieces.windows(2) {
                assert!(ends(&pair[0])[1].distance(ends(&pair[1])[0]) < 1e-12, "pieces follow each other");
            }
            for k in 0..=50 {
                let uv = curve.point(f64::from(k) / 50.0);
                let expected = surface.point(uv.x, uv.y);
                let near = |c: &Curve| {
                    let along = Bezier { points: c.points.clone() };
                    let apart = |t: f64| along.point(t).distance(expected);
                    // from the best of some samples, by ever shorter steps
                    let best = (0..=200).map(|i| f64::from(i) / 200.0).min_by(|a, b| apart(*a).total_cmp(&apart(*b)));
                    let mut t = best.unwrap_or(0.0);
                    let mut step = 1.0 / 200.0;
                    for _ in 0..120 {
                        let tries = [t, (t - step).max(0.0), (t + step).min(1.0)];
                        t = tries.into_iter().min_by(|a, b| apart(*a).total_cmp(&apart(*b))).unwrap_or(t);
                        step *= 0.75;
                    }
                    apart(t)
                };
                let least = pieces.iter().map(near).fold(f64::INFINITY, f64::min);
                assert!(least < 1e-12, "case {case}: {least:e} off at {uv}");
            }
        }
    }

    /// A curve of too high a degree becomes chords, and lies as near to them as they say.
    #[test]
    fn chords_state_how_far_they_are_off() {
        let mut random = Random::new(9);
        let surface = surface(&mut random);
        let grid = surface.patches();
        let point = |i: i32| DVec3::new(0.05 + 0.02 * f64::from(i), 2.05 + 0.004 * f64::from(i * i), 1.0);
        let curve = Bezier { points: (0..=15).map(point).collect::<Vec<_>>() };
        assert!(curve.degree() * 5 <= MOST_DEGREE);
        let elevated = (0..6).fold(curve, |c, _| c.elevated());
        let pieces = on_surface(&elevated, &grid, &cells(&grid));
        assert!(pieces.len() >= CHORDS && pieces.iter().all(|c| c.noise > 1e-9), "{}", pieces.len());
        for k in 0..=100 {
            let uv = elevated.point(f64::from(k) / 100.0);
            let expected = surface.point(uv.x, uv.y);
            let near = |c: &Curve| {
                let along = Bezier { points: c.points.clone() };
                let apart = (0..=1000).map(|i| along.point(f64::from(i) / 1000.0).distance(expected));
                apart.fold(f64::INFINITY, f64::min) - c.noise
            };
            // a sample's own spacing is a thousandth of a chord
            assert!(pieces.iter().map(near).fold(f64::INFINITY, f64::min) < 1e-4);
        }
    }
}
