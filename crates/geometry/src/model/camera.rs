//! The eye: from model coordinates to pixels, in `f64`.
//!
//! ```text
//!      pixel (0,0)──────▶ x          view space: x right, y up, z towards the viewer
//!        │  centre of a pixel        the eye looks along -z; "depth" is the distance along the
//!        ▼  is at +0.5, +0.5         view axis, positive in front of the eye
//!        y
//! ```

use super::Bounds;
use glam::{DMat4, DVec2, DVec3, DVec4};

/// How depth foreshortens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Vertical field of view in radians.
    Perspective {
        /// Full angle between the top and the bottom of the picture, in `(0, π)`.
        fov_y: f64,
    },
    /// Parallel projection.
    Orthographic {
        /// Height of the picture in model units.
        height: f64,
    },
}

/// A view of the model and the size of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye, model units.
    pub eye: DVec3,
    /// A point on the view axis.
    pub target: DVec3,
    /// A direction that points up in the picture; not along the view axis.
    pub up: DVec3,
    /// Perspective or parallel.
    pub projection: Projection,
    /// Nearest and farthest depth drawn.
    pub depth_range: (f64, f64),
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// Smallest height of a picture beside what it lies at: a picture of 4096 rows then has steps of 16 roundings of `f64`.
const LEAST_STEP: f64 = 4096.0 * 16.0 * f64::EPSILON;
/// Lengths whose squares, times a count of pixels, are single-precision numbers.
const LENGTHS: std::ops::RangeInclusive<f64> = 1e-15..=1e15;

/// Why a camera shows nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)]
#[non_exhaustive]
pub enum CameraError {
    #[error("the camera has a coordinate that is not a number")]
    NotFinite,
    #[error("eye and target coincide")]
    NoDirection,
    #[error("the up direction is along the view axis")]
    UpAlongAxis,
    #[error("the field of view must lie between 0 and 180 degrees, the orthographic height above 0")]
    Projection,
    #[error("the field of view is so narrow that double precision tells no two pixels apart")]
    Narrow,
    #[error("the orthographic height is so small that double precision tells no two pixels apart there")]
    Small,
    #[error("lengths of the view are outside of 1e-15 to 1e15, which single precision can square")]
    Scale,
    #[error("the depth range must be 0 < near < far")]
    DepthRange,
    #[error("the picture has no pixels, or a side above 16384")]
    Size,
}

impl Camera {
    /// Checks that the camera defines a picture.
    ///
    /// # Errors
    /// The first of [`CameraError`] that applies.
    pub fn check(&self) -> Result<(), CameraError> {
        if !(self.eye.is_finite() && self.target.is_finite() && self.up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        let axis = self.target - self.eye;
        if axis.length() <= 0.0 {
            return Err(CameraError::NoDirection);
        }
        if axis.normalize().cross(self.up.normalize_or_zero()).length() < 1e-9 {
            return Err(CameraError::UpAlongAxis);
        }
        let good = match self.projection {
            Projection::Perspective { fov_y } => fov_y > 0.0 && fov_y < std::f64::consts::PI,
            Projection::Orthographic { height } => height > 0.0 && height.is_finite(),
        };
        if !good {
            return Err(CameraError::Projection);
        }
        let (near, far) = self.depth_range;
        if !(near > 0.0 && far > near && far.is_finite()) {
            return Err(CameraError::DepthRange);
        }
        let place = self.eye.abs().max(self.target.abs()).max_element();
        match self.projection {
            Projection::Perspective { fov_y } if fov_y < LEAST_STEP => return Err(CameraError::Narrow),
            Projection::Orthographic { height } if !LENGTHS.contains(&height) => return Err(CameraError::Scale),
            Projection::Orthographic { height } if height < LEAST_STEP * place => return Err(CameraError::Small),
            _ => {}
        }
        if !(LENGTHS.contains(&near) && LENGTHS.contains(&far) && place <= *LENGTHS.end()) {
            return Err(CameraError::Scale);
        }
        if self.size.0 == 0 || self.size.1 == 0 || self.size.0.max(self.size.1) > 16384 {
            return Err(CameraError::Size);
        }
        Ok(())
    }

    /// A camera that shows the sphere around `bounds` from direction `from` (towards the eye); the depth range encloses it.
    /// [`Camera::framing`] shows a model as large as it fits.
    pub fn around(bounds: Bounds, from: DVec3, up: DVec3, fov_y: f64, size: (u32, u32)) -> Self {
        let radius = (bounds.diagonal() * 0.5).max(1e-9);
        let centre = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
        let aspect = f64::from(size.0) / f64::from(size.1);
        let half = ((fov_y * 0.5).tan() * aspect.min(1.0)).atan();
        let distance = radius / half.sin();
        let mut camera = Self {
            eye: centre + from.normalize() * distance,
            target: centre,
            up,
            projection: Projection::Perspective { fov_y },
            depth_range: (1.0, 2.0),
            size,
        };
        camera.fit_depth(bounds);
        camera
    }

    /// Sets the depth range to the part of `bounds` in front of the eye, with a margin.
    pub fn fit_depth(&mut self, bounds: Bounds) {
        let radius = (bounds.diagonal() * 0.5).max(1e-9);
        let (_, _, forward) = self.axes();
        let depth = if bounds.is_empty() { radius } else { (bounds.centre() - self.eye).dot(forward) };
        let far = (depth + radius * 1.01).max(radius * 1e-3);
        let near = (depth - radius * 1.01).max(far * 1e-5);
        self.depth_range = (near, far.max(near * 2.0));
    }

    /// Right, up and forward unit vectors.
    pub fn axes(&self) -> (DVec3, DVec3, DVec3) {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        (right, right.cross(forward), forward)
    }

    /// Model coordinates to *homogeneous pixels* `(X, Y, D, W)`: the pixel is `(X / W, Y / W)` with
    /// `y` down, and `D` is the depth along the view axis times the model point's weight. `W` is the
    /// depth for a perspective view and 1 for a parallel one.
    pub fn pixel_matrix(&self) -> DMat4 {
        let (right, up, forward) = self.axes();
        let (w, h) = (f64::from(self.size.0), f64::from(self.size.1));
        let row = |axis: DVec3| axis.extend(-axis.dot(self.eye));
        let (rx, ry, rz) = (row(right), row(up), row(forward));
        let one = DVec4::W;
        let (x, y, rw) = match self.projection {
            Projection::Perspective { fov_y } => {
                let focal = h * 0.5 / (fov_y * 0.5).tan(); // pixels per unit slope
                (rx * focal + rz * (w * 0.5), ry * -focal + rz * (h * 0.5), rz)
            }
            Projection::Orthographic { height } => {
                let scale = h / height; // pixels per model unit
                (rx * scale + one * (w * 0.5), ry * -scale + one * (h * 0.5), one)
            }
        };
        DMat4::from_cols(x, y, rz, rw).transpose()
    }

    /// Model coordinates to Vulkan's clip space, as the engine's depth target has it: x to the right, y down, depth 1 at
    /// the near plane and 0 at the far one. A host that draws its own geometry by this matrix, with `GREATER_OR_EQUAL`,
    /// hides the model and is hidden by it.
    ///
    /// ```
    /// # use selvedge_geometry::model::{Camera, Projection};
    /// # use glam::DVec3;
    /// let camera = Camera {
    ///     eye: DVec3::ZERO,
    ///     target: DVec3::NEG_Z,
    ///     up: DVec3::Y,
    ///     projection: Projection::Perspective { fov_y: 1.0 },
    ///     depth_range: (2.0, 8.0),
    ///     size: (640, 480),
    /// };
    /// let depth = |z: f64| camera.clip_matrix().project_point3(DVec3::new(0.0, 0.0, -z)).z;
    /// assert_eq!((depth(2.0), depth(8.0)), (1.0, 0.0));
    /// ```
    pub fn clip_matrix(&self) -> DMat4 {
        let pixels = self.pixel_matrix().transpose(); // columns are the rows
        let (x, y, depth, w) = (pixels.x_axis, pixels.y_axis, pixels.z_axis, pixels.w_axis);
        let (near, far) = self.depth_range;
        let nearness = (DVec4::W * far - depth) / (far - near);
        let nearness = match self.projection {
            Projection::Perspective { .. } => nearness * near,
            Projection::Orthographic { .. } => nearness,
        };
        let across = |row: DVec4, size: u32| row * (2.0 / f64::from(size)) - w;
        DMat4::from_cols(across(x, self.size.0), across(y, self.size.1), nearness, w).transpose()
    }

    /// The ray through pixel position `p` (continuous, `y` down): origin and unit direction.
    pub fn ray(&self, p: DVec2) -> (DVec3, DVec3) {
        let (right, up, forward) = self.axes();
        let (w, h) = (f64::from(self.size.0), f64::from(self.size.1));
        let (x, y) = (p.x - w * 0.5, h * 0.5 - p.y);
        match self.projection {
            Projection::Perspective { fov_y } => {
                let focal = h * 0.5 / (fov_y * 0.5).tan();
                (self.eye, (forward + (right * x + up * y) / focal).normalize())
            }
            Projection::Orthographic { height } => {
                let unit = height / h;
                (self.eye + right * (x * unit) + up * (y * unit), forward)
            }
        }
    }

    /// Pixel position and depth of a model point; `None` behind the eye of a perspective view.
    pub fn project(&self, p: DVec3) -> Option<(DVec2, f64)> {
        let q = self.pixel_matrix() * p.extend(1.0);
        (q.w > 0.0).then(|| (DVec2::new(q.x / q.w, q.y / q.w), q.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels and clip space say the same, in both projections; right, down and near have the signs that Vulkan has.
    #[test]
    fn clip_space_is_that_of_pixels() {
        let lens = [Projection::Perspective { fov_y: 0.7 }, Projection::Orthographic { height: 3.0 }];
        for projection in lens {
            let camera = Camera {
                eye: DVec3::new(4.0, -3.0, 2.0),
                target: DVec3::new(0.5, 0.25, 0.0),
                up: DVec3::Z,
                projection,
                depth_range: (0.5, 20.0),
                size: (320, 180),
            };
            let (right, up, forward) = camera.axes();
            for (a, b, z) in [(0.0, 0.0, 0.5), (0.3, -0.2, 4.0), (-0.7, 0.1, 20.0)] {
                let p = camera.eye + right * a + up * b + forward * z;
                let clip = camera.clip_matrix().project_point3(p);
                let (pixel, depth) = camera.project(p).unwrap();
                let expected = (pixel / DVec2::new(160.0, 90.0) - 1.0).extend(match projection {
                    Projection::Perspective { .. } => (20.0 - depth) / 19.5 * 0.5 / depth,
                    Projection::Orthographic { .. } => (20.0 - depth) / 19.5,
                });
                assert!((clip - expected).abs().max_element() < 1e-12, "{clip} for {expected}");
                let signs = (clip.x * a >= -1e-12, clip.y * b <= 1e-12); // the axis may be off by roundings
                assert_eq!(signs, (true, true));
            }
        }
    }
}
