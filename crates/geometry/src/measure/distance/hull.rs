//! How far apart convex hulls of points are: a lower bound for what lies in them.
//!
//! ```text
//!    ╭───╮                      ╭────╮
//!    │ A │──▶ n                 │ B  │      for every unit vector n:  |a - b| >= min n·A - max n·B
//!    ╰───╯                      ╰────╯      the hulls' own distance is reached by one n
//! ```
//!
//! Each step has a direction `n`, and keeps the bound that it gives: the result is a bound wherever the steps end.
//!
//! Source: E. Gilbert, D. Johnson, S. Keerthi, *A fast procedure for computing the distance between complex objects in
//! three-dimensional space*, 1988; nearest points of triangles from C. Ericson, *Real-Time Collision Detection*, 2005,
//! section 5.1.5.

use glam::DVec3;

/// Steps; five are usual.
const STEPS: usize = 48;
/// The bound and the distance of the points found agree within this share: no step gives more.
const CLOSE: f64 = 1e-13;

/// A lower bound of the distance of the convex hulls of two sets of points, of at least one each: the distance itself
/// but for rounding, unless `enough` is reached before. Off by a few roundings of the coordinates.
pub fn apart(a: &[DVec3], b: &[DVec3], enough: f64) -> f64 {
    let mut simplex = vec![a[0] - b[0]];
    let mut nearest = simplex[0];
    let mut bound = 0.0_f64;
    for _ in 0..STEPS {
        let length = nearest.length();
        if length == 0.0 {
            break;
        }
        let support = lowest(a, nearest) - lowest(b, -nearest);
        bound = bound.max(support.dot(nearest) / length);
        if bound >= enough || length - bound <= CLOSE * length || simplex.contains(&support) {
            break;
        }
        simplex.push(support);
        match reduced(&mut simplex) {
            Some(next) if next.length_squared() < nearest.length_squared() => nearest = next,
            _ => break,
        }
    }
    bound
}

/// The point that lies least far along a direction.
fn lowest(points: &[DVec3], along: DVec3) -> DVec3 {
    let mut least = (f64::INFINITY, points[0]);
    for p in points {
        let height = p.dot(along);
        if height < least.0 {
            least = (height, *p);
        }
    }
    least.1
}

/// The point of a simplex that is nearest to the origin; the simplex becomes the side that it lies on. `None` where the
/// origin is within.
fn reduced(simplex: &mut Vec<DVec3>) -> Option<DVec3> {
    let (nearest, kept) = match simplex[..] {
        [a] => (a, vec![a]),
        [a, b] => on_segment(a, b),
        [a, b, c] => on_triangle(a, b, c),
        [a, b, c, d] => on_tetrahedron([a, b, c, d])?,
        _ => return None,
    };
    *simplex = kept;
    Some(nearest)
}

fn on_segment(a: DVec3, b: DVec3) -> (DVec3, Vec<DVec3>) {
    let along = b - a;
    let (share, whole) = (-a.dot(along), along.length_squared());
    if share <= 0.0 {
        (a, vec![a])
    } else if share >= whole {
        (b, vec![b])
    } else {
        (a + along * (share / whole), vec![a, b])
    }
}

fn on_triangle(a: DVec3, b: DVec3, c: DVec3) -> (DVec3, Vec<DVec3>) {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    let (of_a, of_b, of_c) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if d1 <= 0.0 && d2 <= 0.0 {
        (a, vec![a])
    } else if d3 >= 0.0 && d4 <= d3 {
        (b, vec![b])
    } else if d6 >= 0.0 && d5 <= d6 {
        (c, vec![c])
    } else if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        on_segment(a, b)
    } else if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        on_segment(a, c)
    } else if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        on_segment(b, c)
    } else {
        let normal = ab.cross(ac);
        (normal * (a.dot(normal) / normal.length_squared()), vec![a, b, c])
    }
}

fn on_tetrahedron(corners: [DVec3; 4]) -> Option<(DVec3, Vec<DVec3>)> {
    let sides = [[0, 1, 2, 3], [0, 1, 3, 2], [0, 2, 3, 1], [1, 2, 3, 0]].map(|side| side.map(|i: usize| corners[i]));
    let beyond = sides.iter().filter(|[a, b, c, opposite]| {
        let normal = (*b - *a).cross(*c - *a);
        -a.dot(normal) * (*opposite - *a).dot(normal) <= 0.0
    });
    beyond
        .map(|[a, b, c, _]| on_triangle(*a, *b, *c))
        .min_by(|x, y| x.0.length_squared().total_cmp(&y.0.length_squared()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    fn cloud(random: &mut Random, count: u32, middle: DVec3) -> Vec<DVec3> {
        let mut point = || DVec3::from_array([0; 3].map(|_| random.range(-1.0, 1.0)));
        (0..count).map(|_| middle + point()).collect()
    }

    /// Known distances of boxes: between corners, sides and edges, and of boxes that overlap.
    #[test]
    fn boxes_have_their_distances() {
        let corners = |low: DVec3, high: DVec3| {
            let pick = |i: usize, k: usize| if i >> k & 1 == 0 { low[k] } else { high[k] };
            (0..8).map(|i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2))).collect::<Vec<_>>()
        };
        let unit = corners(DVec3::ZERO, DVec3::ONE);
        for (at, expected) in [
            (DVec3::new(3.0, 4.0, 5.0), DVec3::new(2.0, 3.0, 4.0).length()),
            (DVec3::new(3.0, 0.25, 5.0), DVec3::new(2.0, 0.0, 4.0).length()),
            (DVec3::new(0.5, -0.5, 1.5), 0.5),
            (DVec3::new(0.5, 0.5, 0.5), 0.0),
            (DVec3::new(1.0, 0.0, 0.0), 0.0),
        ] {
            let found = apart(&unit, &corners(at, at + DVec3::ONE), f64::INFINITY);
            assert!((found - expected).abs() <= 1e-14, "{found} instead of {expected}");
        }
    }

    /// No two points of the hulls are nearer than the bound, and where a plane between them proves a distance, the
    /// bound is not below it.
    #[test]
    fn random_hulls_are_not_nearer_than_the_bound() {
        let mut random = Random::new(7);
        let mut positive = 0;
        for _ in 0..400 {
            let middle = DVec3::from_array([0; 3].map(|_| random.range(-3.0, 3.0)));
            let (a, b) = (cloud(&mut random, 9, DVec3::ZERO), cloud(&mut random, 6, middle));
            let found = apart(&a, &b, f64::INFINITY);
            positive += i32::from(found > 0.0);
            let mut mixed = |points: &[DVec3]| {
                let shares: Vec<f64> = points.iter().map(|_| random.range(0.0, 1.0).powi(4)).collect();
                let sum: f64 = shares.iter().sum();
                points.iter().zip(&shares).fold(DVec3::ZERO, |at, (p, share)| at + *p * (share / sum))
            };
            for _ in 0..200 {
                let (p, q) = (mixed(&a), mixed(&b));
                assert!(p.distance(q) >= found - 1e-14, "{} below {found}", p.distance(q));
                let along = (p - q).normalize();
                let proven = lowest(&a, along).dot(along) - lowest(&b, -along).dot(along);
                assert!(found >= proven - 1e-13, "{found} below {proven}");
            }
            assert!((apart(&b, &a, f64::INFINITY) - found).abs() <= 1e-12);
        }
        assert!(positive > 100 && positive < 400, "{positive}");
    }
}
