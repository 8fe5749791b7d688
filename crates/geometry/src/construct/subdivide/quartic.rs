//! Quartic Bézier triangles: halved, measured, and written as surfaces over a square.

use super::super::ConstructError;
use crate::spline::Surface;
use glam::DVec3;
use std::array::from_fn;

/// Bézier points of a quartic triangle: `[k][i]`, row `k` has `5 - k` of them, from the first to the second corner.
pub(super) type Quartic = [[DVec3; 5]; 5];

/// The surface that collapses at the third corner.
pub(super) fn surface(b: &Quartic) -> Result<Surface, ConstructError> {
    let mut points = Vec::with_capacity(25);
    for (k, row) in b.iter().enumerate() {
        let mut row = row[..5 - k].to_vec();
        if let [corner] = row[..] {
            row = vec![corner; 5]; // one point to the bit
        }
        while row.len() < 5 {
            let n = row.len();
            let mut raised = vec![row[0]];
            raised.extend((1..n).map(|i| {
                let t = i as f64 / n as f64;
                row[i - 1] * t + row[i] * (1.0 - t)
            }));
            raised.push(row[n - 1]);
            row = raised;
        }
        points.extend(row.iter().map(|p| p.extend(1.0)));
    }
    let knots = [[0.0; 5], [1.0; 5]].concat();
    Ok(Surface::new((4, 4), knots.clone(), knots, points)?)
}

/// The triangle's four children of half its size: at each corner, and the middle one, which is turned by half.
pub(super) fn children(b: &Quartic) -> [Quartic; 4] {
    // polar forms at midpoints, one argument at a time: barycentric coordinates of the child's corners
    let corners = |child: usize| -> [[f64; 3]; 3] {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let m = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { from_fn(|k| 0.5 * (a[k] + b[k])) };
        match child {
            0 => [x, m(x, y), m(x, z)],
            1 => [m(x, y), y, m(y, z)],
            2 => [m(x, z), m(y, z), z],
            _ => [m(y, z), m(x, z), m(x, y)],
        }
    };
    from_fn(|child| {
        let to = corners(child);
        let mut out = [[DVec3::ZERO; 5]; 5];
        for (k, row) in out.iter_mut().enumerate() {
            for (i, p) in row[..5 - k].iter_mut().enumerate() {
                let mut d = *b;
                let arguments = (0..4).map(|n| if n < k { to[2] } else { to[usize::from(n < k + i)] });
                for (n, t) in arguments.enumerate() {
                    for row in 0..4 - n {
                        for at in 0..4 - n - row {
                            d[row][at] = d[row][at] * t[0] + d[row][at + 1] * t[1] + d[row + 1][at] * t[2];
                        }
                    }
                }
                *p = d[0][0];
            }
        }
        out
    })
}

/// The largest distance of points with the same place.
pub(super) fn apart(a: &Quartic, b: &Quartic) -> f64 {
    let points = (0..5).flat_map(|k| (0..5 - k).map(move |i| (k, i)));
    points.map(|(k, i)| a[k][i].distance(b[k][i])).fold(0.0, f64::max)
}

/// The side from the second to the third corner.
pub(super) fn far_side(b: &Quartic) -> [DVec3; 5] {
    from_fn(|k| b[k][4 - k])
}

/// Replaces that side.
pub(super) fn put_far_side(b: &mut Quartic, side: [DVec3; 5]) {
    for (k, p) in side.into_iter().enumerate() {
        b[k][4 - k] = p;
    }
}

/// Halves of a quartic by de Casteljau's algorithm.
pub(super) fn halves(c: [DVec3; 5]) -> [[DVec3; 5]; 2] {
    let mut d = c;
    let mut out = [c, c];
    for n in 1..5 {
        for k in 0..5 - n {
            d[k] = (d[k] + d[k + 1]) * 0.5;
        }
        out[0][n] = d[0];
        out[1][4 - n] = d[4 - n];
    }
    out
}
