//! Twin of `glsl/include/curve.glsl`: points of trim curves in the normalised `(u, v)` domain.

use crate::abi::Curve;

/// Point `i` of `n` equal steps along the parameter, by Horner's scheme in the Bernstein basis.
///
/// The ends are the stored ones, so curves of a loop share them bit for bit. Inner points depend only on
/// `(curve, i, n)`, so segments share theirs.
pub fn curve_point(curve: &Curve, curve_points: &[f32], i: u32, n: u32) -> [f32; 2] {
    if i == 0 {
        return curve.start;
    }
    if i >= n {
        return curve.end;
    }
    let t = i as f32 / n as f32;
    let s = 1.0 - t;
    if curve.degree == 1 {
        return std::array::from_fn(|a| curve.start[a] * s + curve.end[a] * t);
    }
    let control = |i: u32| -> [f32; 3] { std::array::from_fn(|a| curve_points[(curve.first + 3 * i) as usize + a]) };
    let (mut f, mut c) = (1.0f32, 1.0f32);
    let mut sum = control(0).map(|x| x * s);
    for k in 1..curve.degree {
        f *= t;
        c *= (curve.degree - k + 1) as f32 / k as f32;
        let p = control(k);
        sum = std::array::from_fn(|a| (sum[a] + p[a] * (f * c)) * s);
    }
    let p = control(curve.degree);
    let sum: [f32; 3] = std::array::from_fn(|a| sum[a] + p[a] * (f * t));
    [sum[0] / sum[2], sum[1] / sum[2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Bezier;
    use glam::{DVec2, DVec3};

    /// Horner in single precision stays within a few roundings of `f64`: degree + 3 of them a
    /// coordinate, half an ulp each, on numbers up to 1.
    #[test]
    fn points_are_those_of_the_curve() {
        const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;
        for degree in 1..=5u32 {
            let at = |k: u32| f64::from(k * 7 % 5) / 5.0;
            let points: Vec<DVec3> = (0..=degree)
                .map(|k| {
                    let w = 1.0 + f64::from(k % 2);
                    DVec3::new(at(k) * w, f64::from(k) / f64::from(degree) * w, w)
                })
                .collect();
            let exact = Bezier { points: points.clone() };
            let flat: Vec<f32> = points.iter().flat_map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
            let ends = [exact.point(0.0), exact.point(1.0)].map(|p| p.as_vec2().to_array());
            let mut curve = Curve { start: ends[0], end: ends[1], first: 0, degree, ..Default::default() };
            if degree == 1 {
                curve.first = u32::MAX; // a straight line reads no control point
            }
            for i in 0..=17 {
                let p = curve_point(&curve, &flat, i, 17);
                // weights of a line do not change its shape, only its speed: stored lines are polynomial
                let t = f64::from(i) / 17.0;
                let q = if degree == 1 { exact.point(0.0).lerp(exact.point(1.0), t) } else { exact.point(t) };
                let off = (DVec2::new(p[0].into(), p[1].into()) - q).abs().max_element();
                assert!(off <= ROUNDING, "degree {degree}, point {i}: off by {off:e}");
            }
        }
    }
}
