//! The crossings of a line with a carrier.
//!
//! ```text
//!   plane     one root            quadric   two roots, by the sum without cancellation
//!   torus     a quartic: isolated by sign variations of its Bernstein form, then every stretch between
//!             roots is tested by the distance to the tube, and every change pinned by that distance
//! ```
//!
//! Only changes of sign count: a tangent line crosses nothing.

use crate::math::{bernstein, root::bracketed};
use crate::model::Carrier;
use glam::DVec3;

/// The crossings of a line with one carrier.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Roots {
    /// The value is negative before the first crossing.
    pub inside_before: bool,
    /// Parameters of the changes of sign, ascending.
    pub at: Vec<f64>,
}

impl Roots {
    /// Of the line `o + t d`, all `t`.
    pub fn new(carrier: &Carrier, o: DVec3, d: DVec3) -> Self {
        // from the point nearest the carrier's origin: no digits are lost to a far eye
        let start = -o.dot(d) / d.length_squared();
        let near = o + d * start;
        let mut roots = match carrier {
            Carrier::Plane { normal, offset } => Self::plane(offset - normal.dot(near), normal.dot(d)),
            Carrier::Quadric(q) => {
                Self::quadratic(0.5 * q.slope(d).dot(d), 0.5 * q.gradient(near).dot(d), q.value(near))
            }
            Carrier::Torus { major, minor } => Self::torus(*major, *minor, near, d),
        };
        roots.at.iter_mut().for_each(|t| *t += start);
        roots
    }

    /// `slope t < gap`.
    fn plane(gap: f64, slope: f64) -> Self {
        let t = gap / slope;
        if t.is_finite() {
            Self { inside_before: slope > 0.0, at: vec![t] }
        } else {
            Self { inside_before: gap > 0.0, at: Vec::new() }
        }
    }

    /// `a t² + 2 b t + c < 0`.
    fn quadratic(a: f64, b: f64, c: f64) -> Self {
        // a line along a generator has rounding in place of a
        let flat = a.abs() * c.abs() <= 1e-30 * b * b || a == 0.0;
        if flat {
            return Self::plane(-c, 2.0 * b);
        }
        let root = b * b - a * c;
        if root <= 0.0 || root.is_nan() {
            return Self { inside_before: if root < 0.0 { c < 0.0 } else { a < 0.0 }, at: Vec::new() };
        }
        let far = -(b + root.sqrt().copysign(b));
        let (x, y) = (far / a, c / far);
        if !(x.is_finite() && y.is_finite()) || x == y {
            return Self { inside_before: a < 0.0, at: Vec::new() };
        }
        Self { inside_before: a < 0.0, at: vec![x.min(y), x.max(y)] }
    }

    fn torus(major: f64, minor: f64, o: DVec3, d: DVec3) -> Self {
        let speed = d.length();
        let reach = (major + minor) * (1.0 + 1e-9);
        let miss = reach * reach - o.length_squared();
        if !(miss > 0.0 && reach.is_finite() && speed > 0.0) {
            return Self::default();
        }
        // s in [-1, 1] along the chord of the sphere around the torus; lengths in units of the reach
        let half = miss.sqrt() / reach;
        let (o, d) = (o / reach, d / speed * half);
        let (big, small) = (major / reach, minor / reach);
        // (|p|² + R² - r²)² - 4 R² (x² + y²) with p = o + s d and o ⟂ d
        let (dd, k) = (d.length_squared(), o.length_squared() + big * big - small * small);
        let flat = |a: DVec3, b: DVec3| 4.0 * big * big * (a.x * b.x + a.y * b.y);
        let od = o.dot(d); // rounding of 0
        let power = [
            k * k - flat(o, o),
            4.0 * k * od - 2.0 * flat(o, d),
            2.0 * k * dd + 4.0 * od * od - flat(d, d),
            4.0 * od * dd,
            dd * dd,
        ];
        let value = |s: f64| {
            let p = o + d * s;
            let out = p.x.hypot(p.y) - big;
            out * out + p.z * p.z - small * small
        };
        let coefficients = from_power(power);
        let noise = [8.0 * f64::EPSILON; 5]; // all terms are below 4
        let mut stops = vec![-1.0];
        stops.extend(bernstein::sign_changes(&coefficients, &noise).iter().map(|u| 2.0 * u - 1.0));
        stops.push(1.0);
        // one point between any two roots; the chord's ends are outside
        let mut before = (-1.0, false);
        let mut at = Vec::new();
        for pair in stops.windows(2) {
            // the middle may be a point of tangency, where the distance is 0: the clearest of three
            let clear = [0.5, 0.29, 0.74].map(|k| pair[0] + (pair[1] - pair[0]) * k);
            let middle = clear.into_iter().max_by(|a, b| value(*a).abs().total_cmp(&value(*b).abs()));
            let middle = middle.expect("there are three");
            let inside = value(middle) < 0.0;
            if inside != before.1 {
                at.push(bracketed(value, before.0, middle, 0.0));
            }
            before = (middle, inside);
        }
        if before.1 {
            at.push(bracketed(value, before.0, 1.0, 0.0));
        }
        Self { inside_before: false, at: at.into_iter().map(|s| s * half * reach / speed).collect() }
    }
}

/// Bernstein coefficients over `[0, 1]` of a polynomial in `s = 2 u - 1`.
fn from_power(c: [f64; 5]) -> [f64; 5] {
    /// Row `k`: Bernstein coefficients of degree 4 of `(2 u - 1)^k`.
    const ROWS: [[f64; 5]; 5] = [
        [1.0; 5],
        [-1.0, -0.5, 0.0, 0.5, 1.0],
        [1.0, 0.0, -1.0 / 3.0, 0.0, 1.0],
        [-1.0, 0.5, 0.0, -0.5, 1.0],
        [1.0, -1.0, 1.0, -1.0, 1.0],
    ];
    std::array::from_fn(|i| (0..5).map(|k| c[k] * ROWS[k][i]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Quadric, Shape};

    fn torus(major: f64, minor: f64, o: DVec3, d: DVec3) -> Vec<f64> {
        Roots::new(&Carrier::Torus { major, minor }, o, d).at
    }

    fn near(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{found:?} for {expected:?}");
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() < 1e-14 * (1.0 + e.abs()) * 100.0, "{found:?} for {expected:?}");
        }
    }

    #[test]
    fn bernstein_form_of_powers() {
        for (k, u) in [(0, 0.3), (1, 0.7), (2, 0.2), (3, 0.9), (4, 0.4)] {
            let mut c = [0.0; 5];
            c[k] = 1.0;
            let value = bernstein::value(&from_power(c), u);
            assert!((value - (2.0 * u - 1.0f64).powi(k as i32)).abs() < 1e-15);
        }
    }

    /// Along x through the middle: -4 -2 2 4; along z through the tube; far eyes and long directions.
    #[test]
    fn four_roots() {
        near(&torus(3.0, 1.0, DVec3::ZERO, DVec3::X), &[-4.0, -2.0, 2.0, 4.0]);
        near(&torus(3.0, 1.0, DVec3::new(3.0, 0.0, -9.0), DVec3::Z * 2.0), &[4.0, 5.0]);
        near(&torus(3.0, 1.0, DVec3::new(-1e6, 0.0, 0.0), DVec3::X), &[1e6 - 4.0, 1e6 - 2.0, 1e6 + 2.0, 1e6 + 4.0]);
    }

    /// The tangent plane z = minor and the line through the inner equator touch and do not cross.
    #[test]
    fn tangents_cross_nothing() {
        near(&torus(3.0, 1.0, DVec3::new(0.0, 0.0, 1.0), DVec3::X), &[]);
        near(&torus(3.0, 1.0, DVec3::new(0.0, 2.0, 0.0), DVec3::X), &[-(12f64.sqrt()), 12f64.sqrt()]);
        // just inside the tube's top: two short chords
        let h: f64 = 1.0 - 1e-9;
        let w = (1.0 - h * h).sqrt();
        let found = torus(3.0, 1.0, DVec3::new(0.0, 0.0, h), DVec3::X);
        assert_eq!(found.len(), 4);
        assert!((found[0] + 3.0 + w).abs() < 1e-10 && (found[3] - 3.0 - w).abs() < 1e-10);
    }

    /// Horn and spindle: the surface inside, around the centre, is none.
    #[test]
    fn horn_and_spindle() {
        near(&torus(1.0, 1.0, DVec3::ZERO, DVec3::X), &[-2.0, 2.0]);
        near(&torus(1.0, 2.0, DVec3::ZERO, DVec3::X), &[-3.0, 3.0]);
        near(&torus(1.0, 2.0, DVec3::ZERO, DVec3::Z), &[-(3f64.sqrt()), 3f64.sqrt()]);
    }

    #[test]
    fn quadrics_and_planes() {
        let carriers = Shape::Cone { bottom: 1.0, top: 0.0, height: 1.0 }.carriers();
        let through = |o: DVec3, d: DVec3| Roots::new(&carriers[0], o, d);
        near(&through(DVec3::new(0.0, 0.0, 0.5), DVec3::X).at, &[-0.5, 0.5]);
        // parallel to a generator: one root
        assert_eq!(through(DVec3::ZERO, DVec3::new(1.0, 0.0, -1.0)).at.len(), 1);
        // through the apex along the axis: inside both nappes
        let axis = through(DVec3::ZERO, DVec3::Z);
        assert!(axis.inside_before && axis.at.is_empty());
        let sphere = Carrier::from(Quadric { squares: DVec3::ONE, constant: -1.0, ..Quadric::default() });
        let far = Roots::new(&sphere, DVec3::new(0.0, 0.0, -1e8), DVec3::Z);
        near(&far.at, &[1e8 - 1.0, 1e8 + 1.0]);
        assert!(Roots::new(&sphere, DVec3::X, DVec3::Z).at.is_empty());
        let plane = Carrier::Plane { normal: DVec3::Z, offset: 0.0 };
        assert_eq!(Roots::new(&plane, DVec3::NEG_Z, DVec3::X), Roots { inside_before: true, at: vec![] });
    }
}
