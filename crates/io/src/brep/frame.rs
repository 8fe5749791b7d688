//! Orthonormal frames.

use super::Frame;
use glam::DVec3;

impl Frame {
    /// The coordinate axes.
    pub const WORLD: Self = Self { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y, z: DVec3::Z };

    /// `z` along `axis`, `x` the part of `reference` across it, `y = z × x`.
    ///
    /// A reference that is zero or parallel to the axis is replaced by the world `x` axis, or `y`
    /// where that is parallel too (ISO 10303-42, `build_axes` and `first_proj_axis`). `None` when
    /// the axis has no direction.
    pub fn new(origin: DVec3, axis: DVec3, reference: DVec3) -> Option<Self> {
        /// Sine of the angle to the axis below which a reference counts as parallel.
        const PARALLEL: f64 = 1e-9;
        let z = axis.try_normalize()?;
        let across = |r: DVec3| {
            let r = r.try_normalize()?;
            let x = r - z * r.dot(z);
            (x.length() > PARALLEL).then(|| x.normalize())
        };
        let x = across(reference).or_else(|| across(DVec3::X)).or_else(|| across(DVec3::Y))?;
        origin.is_finite().then(|| Self { origin, x, y: z.cross(x), z })
    }

    /// Coordinates of `p` in this frame.
    pub fn local(&self, p: DVec3) -> DVec3 {
        self.local_direction(p - self.origin)
    }

    /// Components of the direction `d` in this frame.
    pub fn local_direction(&self, d: DVec3) -> DVec3 {
        DVec3::new(d.dot(self.x), d.dot(self.y), d.dot(self.z))
    }

    /// The point with coordinates `l` in this frame.
    pub fn world(&self, l: DVec3) -> DVec3 {
        self.origin + self.x * l.x + self.y * l.y + self.z * l.z
    }

    /// The three axes are unit and at right angles, to `1e-6`.
    pub(super) fn is_orthonormal(&self) -> bool {
        let unit = |v: DVec3| (v.length() - 1.0).abs() < 1e-6;
        let right = |a: DVec3, b: DVec3| a.dot(b).abs() < 1e-6;
        self.origin.is_finite()
            && unit(self.x)
            && unit(self.y)
            && unit(self.z)
            && right(self.x, self.y)
            && (self.z - self.x.cross(self.y)).length() < 1e-6
    }
}
