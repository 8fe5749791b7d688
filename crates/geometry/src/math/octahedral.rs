//! Directions as two 16-bit numbers. Twin of `glsl/include/octahedral.glsl`.
//!
//! ```text
//!          ╱╲         the octahedron |x| + |y| + |z| = 1, its lower half unfolded around the upper one to a square:
//!         ╱  ╲        a direction is off by at most 0.0037°
//!        ╱────╲
//!        ╲    ╱
//!         ╲  ╱
//! ```
//!
//! Source: Z. H. Cigolle et al., *A Survey of Efficient Representations for Independent Unit Vectors*, Journal of Computer
//! Graphics Techniques 3 (2), 2014.

use glam::DVec3;

/// The word of the direction of `n`, which is not zero.
pub fn pack(n: DVec3) -> u32 {
    let p = n / n.abs().element_sum();
    let fold = |a: f64, b: f64| if p.z < 0.0 { (1.0 - b.abs()) * 1f64.copysign(a) } else { a };
    let half = |x: f64| u32::from((x * 32767.0).round() as i16 as u16);
    half(fold(p.x, p.y)) | half(fold(p.y, p.x)) << 16
}

/// A vector in that direction, on the octahedron.
pub fn unpack(word: u32) -> [f32; 3] {
    let [x, y] = [word as i16, (word >> 16) as i16].map(|e| f32::from(e) / 32767.0);
    let z = 1.0 - x.abs() - y.abs();
    let sign = |e: f32| if e < 0.0 { -1.0 } else { 1.0 };
    if z < 0.0 { [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y), z] } else { [x, y, z] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_come_back() {
        let all =
            (0..27).map(|k| DVec3::new(f64::from(k % 3) - 1.0, f64::from(k / 3 % 3) - 1.1, f64::from(k / 9) - 0.9));
        for n in all.chain([DVec3::X, -DVec3::Y, -DVec3::Z, DVec3::new(0.6, -1e-9, -0.8)]) {
            let back = DVec3::from_array(unpack(pack(n)).map(f64::from));
            assert!(back.angle_between(n).to_degrees() < 0.0037, "{n} {back}");
            assert!((back.abs().element_sum() - 1.0).abs() < 1e-6, "{n} {back}");
        }
    }
}
