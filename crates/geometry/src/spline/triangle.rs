//! Triangular Bézier patches as tensor-product surfaces, exactly.
//!
//! ```text
//!   v = 1  9                     a polynomial of total degree n in (u, v) has degree n in each:
//!          7  8                  the patch is the part u + v <= 1 of a surface over [0, 1]²
//!          4  5  6
//!          0  1  2  3  u = 1     points row by row, the row of v = 0 first
//! ```
//!
//! The polar form of the surface, with `p` ones among its `n` arguments in `u` and `q` ones in `v`, is the
//! mean of the triangle's polar form over all ways to pair the arguments:
//!
//! ```text
//!   c_pq = sum_m C(p, m) C(n - p, q - m) / C(n, q)  f((1,1)^m, (1,0)^(p-m), (0,1)^(q-m), (0,0)^rest)
//! ```
//!
//! `f` with `m` arguments at `(1, 1)` is a step of de Casteljau's algorithm with barycentric coordinates
//! `(-1, 1, 1)` for each.
//!
//! Source: L. Ramshaw, *Blossoms are polar forms*, 1989, section 4.

use super::bspline::SplineError;
use super::{MAX_DEGREE, Surface, binomial};
use glam::DVec4;

/// Control points of a triangle of degree `n`.
pub const fn triangle_points(n: usize) -> usize {
    (n + 1) * (n + 2) / 2
}

/// The surface over `[0, 1]²` whose part `u + v <= 1` is the triangular patch.
///
/// `points` are homogeneous, `(n + 1)(n + 2) / 2` of them, in the order of the figure. The error is a few roundings,
/// magnified by at most `3^n` in the corner `(1, 1)`, outside the triangle, and by less than 4 inside it.
///
/// # Errors
/// [`SplineError`] for a wrong degree or count, and for weights that are not positive over the square.
pub fn triangle_surface(degree: usize, points: &[DVec4]) -> Result<Surface, SplineError> {
    let n = degree;
    if n == 0 || n > MAX_DEGREE {
        return Err(SplineError::Degree(n));
    }
    if points.len() != triangle_points(n) {
        return Err(SplineError::NetSize { points: points.len(), count_u: n + 1, count_v: n + 1 });
    }
    // steps[m][row][column]: after m steps at (1, 1)
    let mut steps: Vec<Vec<Vec<DVec4>>> = Vec::with_capacity(n + 1);
    let mut rest = points;
    let rows = (0..=n).map(|row| {
        let (this, more) = rest.split_at(n + 1 - row);
        rest = more;
        this.to_vec()
    });
    steps.push(rows.collect());
    for m in 0..n {
        let before = &steps[m];
        let at = |row: usize, column: usize| before[row][column + 1] + before[row + 1][column] - before[row][column];
        steps.push((0..n - m).map(|row| (0..n - m - row).map(|column| at(row, column)).collect()).collect());
    }
    let point = |p: usize, q: usize| -> DVec4 {
        let least = (p + q).saturating_sub(n);
        let pairs = (least..=p.min(q)).map(|m| {
            let share = binomial(p, m) * binomial(n - p, q - m) / binomial(n, q);
            steps[m][q - m][p - m] * share
        });
        pairs.sum()
    };
    let net = (0..=n).flat_map(|q| (0..=n).map(move |p| (p, q))).map(|(p, q)| point(p, q)).collect();
    let knots = [[0.0].repeat(n + 1), [1.0].repeat(n + 1)].concat();
    Surface::new((n, n), knots.clone(), knots, net)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// The Bernstein sum over the triangle itself.
    fn direct(n: usize, points: &[DVec4], u: f64, v: f64) -> DVec3 {
        let mut sum = DVec4::ZERO;
        let mut at = points.iter();
        for k in 0..=n {
            for j in 0..=n - k {
                let i = n - j - k;
                let many = binomial(n, k) * binomial(n - k, j);
                sum +=
                    *at.next().unwrap() * (many * (1.0 - u - v).powi(i as i32) * u.powi(j as i32) * v.powi(k as i32));
            }
        }
        sum.truncate() / sum.w
    }

    #[test]
    fn every_degree_agrees_with_the_triangle() {
        for n in 1..=MAX_DEGREE {
            // a fixed, uneven net of size 1
            let wave = |i: usize| DVec3::new((i as f64 * 1.7).sin(), (i as f64 * 2.3).cos(), (i as f64 * 0.9).sin());
            let points: Vec<DVec4> = (0..triangle_points(n)).map(|i| wave(i).extend(1.0)).collect();
            let surface = triangle_surface(n, &points).unwrap();
            for (u, v) in
                [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.2, 0.3), (0.1, 0.85), (1.0 / 3.0, 1.0 / 3.0)]
            {
                let gap = (surface.jet(u, v).point - direct(n, &points, u, v)).length();
                // control points reach 3^n beyond the triangle, and cancel inside it
                assert!(gap < 1e-15 * 3f64.powi(n as i32).max(8.0), "degree {n} at {u} {v}: {gap:e}");
            }
        }
    }

    /// A plane stays a plane, a paraboloid itself, also beyond the triangle.
    #[test]
    fn polynomials_are_reproduced() {
        let linear = [DVec4::new(0., 0., 1., 1.), DVec4::new(2., 0., 3., 1.), DVec4::new(0., 5., -1., 1.)];
        let surface = triangle_surface(1, &linear).unwrap();
        assert_eq!(surface.points()[3], DVec4::new(2., 5., 1., 1.));
        // z = u v: polar form (u1 v2 + u2 v1) / 2
        let z = |h: f64, x: f64, y: f64| DVec4::new(x, y, h, 1.0);
        let saddle = [z(0., 0., 0.), z(0., 0.5, 0.), z(0., 1., 0.), z(0., 0., 0.5), z(0.5, 0.5, 0.5), z(0., 0., 1.)];
        let surface = triangle_surface(2, &saddle).unwrap();
        assert_eq!(surface.jet(1.0, 1.0).point, DVec3::ONE);
        assert_eq!(surface.jet(0.25, 0.5).point, DVec3::new(0.25, 0.5, 0.125));
    }

    #[test]
    fn rational_triangles_keep_their_weights() {
        let points: Vec<DVec4> =
            (0..6).map(|i| DVec4::new(i as f64, 1.0, (i * i) as f64, 1.0 + 0.1 * i as f64)).collect();
        let surface = triangle_surface(2, &points).unwrap();
        assert!((surface.jet(0.3, 0.6).point - direct(2, &points, 0.3, 0.6)).length() < 1e-14);
    }

    #[test]
    fn what_is_no_triangle() {
        assert_eq!(triangle_surface(0, &[DVec4::ONE]), Err(SplineError::Degree(0)));
        assert_eq!(triangle_surface(16, &[]), Err(SplineError::Degree(16)));
        assert!(matches!(triangle_surface(2, &[DVec4::ONE; 5]), Err(SplineError::NetSize { points: 5, .. })));
        let bad = [DVec4::ONE, DVec4::NAN, DVec4::ONE];
        assert!(matches!(triangle_surface(1, &bad), Err(SplineError::ControlPoint { .. })));
    }
}
