//! The eye: from model coordinates to pixels, in `f64`.
//!
//! ```text
//!      pixel (0,0)──────▶ x          view space: x right, y up, z towards the viewer
//!        │  centre of a pixel        the eye looks along -z; "depth" is the distance along the
//!        ▼  is at +0.5, +0.5         view axis, positive in front of the eye
//!        y
//! ```

use super::Bounds;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

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
    /// A calibrated camera of a picture of [`Camera::size`]. The view axis need not be in the middle of the picture.
    /// [`Camera::from_intrinsics`] takes OpenCV's numbers.
    Pinhole {
        /// Pixels per unit slope, across and down.
        focal: DVec2,
        /// The principal point: the pixel position of the view axis.
        principal: DVec2,
    },
}

/// A view of the model and the size of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye, model units.
    pub eye: DVec3,
    /// A point on the view axis, model units.
    pub target: DVec3,
    /// A direction that points up in the picture; not along the view axis.
    pub up: DVec3,
    /// Perspective or parallel.
    pub projection: Projection,
    /// Nearest and farthest depth drawn: distances from the eye along the view axis, model units.
    pub depth_range: (f64, f64),
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// Least height of a picture relative to the distance of its content: a picture of 4096 rows then has steps of 16
/// roundings of `f64`.
const LEAST_STEP: f64 = 4096.0 * 16.0 * f64::EPSILON;
/// Largest ratio of the two focal lengths: bounds of the frame use the longer one for both.
const MOST_OBLONG: f64 = 2.0;
/// Largest distance of the principal point from the picture, pixels: single precision then resolves 1/500 pixel.
const MOST_BESIDE: f64 = 16384.0;
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
    #[error("the focal lengths must lie above 0, the longer one at most twice the shorter one")]
    Focal,
    #[error("the principal point must lie within 16384 pixels of the picture")]
    Principal,
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
    /// Where the standard view looks from, from the model towards the eye: front, right, a little above; no axis of the
    /// model is seen edge-on.
    pub const FROM: DVec3 = DVec3::new(1.0, -1.6, 1.1);
    /// The standard view's vertical field of view, degrees.
    pub const FOV_DEG: f64 = 35.0;

    /// Checks that the camera defines a picture.
    ///
    /// # Errors
    /// The first of [`CameraError`] that applies.
    pub fn check(&self) -> Result<(), CameraError> {
        if !(self.eye.is_finite() && self.target.is_finite() && self.up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        let place = self.eye.abs().max(self.target.abs()).max_element();
        if place > *LENGTHS.end() {
            return Err(CameraError::Scale);
        }
        let axis = self.target - self.eye;
        if axis == DVec3::ZERO {
            return Err(CameraError::NoDirection);
        }
        // what has no square has no direction below
        let longest = [axis, self.up].map(|v| v.abs().max_element());
        if longest.into_iter().any(|length| length > 0.0 && !LENGTHS.contains(&length)) {
            return Err(CameraError::Scale);
        }
        if axis.normalize().cross(self.up.normalize_or_zero()).length() < 1e-9 {
            return Err(CameraError::UpAlongAxis);
        }
        let good = match self.projection {
            Projection::Perspective { fov_y } => fov_y > 0.0 && fov_y < std::f64::consts::PI,
            Projection::Orthographic { height } => height > 0.0 && height.is_finite(),
            Projection::Pinhole { .. } => true,
        };
        if !good {
            return Err(CameraError::Projection);
        }
        if let Projection::Pinhole { focal, principal } = self.projection {
            let (long, short) = (focal.max_element(), focal.min_element());
            if !(focal.is_finite() && short > 0.0 && long <= MOST_OBLONG * short) {
                return Err(CameraError::Focal);
            }
            let beside = (principal - self.pixels()).max(-principal);
            if !(principal.is_finite() && beside.max_element() <= MOST_BESIDE) {
                return Err(CameraError::Principal);
            }
        }
        let (near, far) = self.depth_range;
        if !(near > 0.0 && far > near && far.is_finite()) {
            return Err(CameraError::DepthRange);
        }
        match self.projection {
            Projection::Perspective { fov_y } if fov_y < LEAST_STEP => return Err(CameraError::Narrow),
            Projection::Orthographic { height } if !LENGTHS.contains(&height) => return Err(CameraError::Scale),
            Projection::Orthographic { height } if height < LEAST_STEP * place => return Err(CameraError::Small),
            Projection::Pinhole { focal, .. } if focal.max_element() * LEAST_STEP > f64::from(self.size.1) => {
                return Err(CameraError::Narrow);
            }
            Projection::Pinhole { focal, .. } if !LENGTHS.contains(&focal.min_element()) => {
                return Err(CameraError::Scale);
            }
            _ => {}
        }
        if !(LENGTHS.contains(&near) && LENGTHS.contains(&far)) {
            return Err(CameraError::Scale);
        }
        if self.size.0 == 0 || self.size.1 == 0 || self.size.0.max(self.size.1) > 16384 {
            return Err(CameraError::Size);
        }
        Ok(())
    }

    /// A calibrated camera by OpenCV's conventions, of a picture of `size` pixels. A point `(x, y, z)`, with x to the
    /// right, y down and z ahead, is seen at `(fx x / z + cx, fy y / z + cy)`. The centre of the first pixel is `(0,
    /// 0)`.
    ///
    /// The camera stands in the origin of the model and looks along the model's z axis; [`Camera::posed`] moves it. The
    /// depth range is 1 to 2 until [`Camera::fit_depth`] sets it. The numbers are checked by [`Camera::check`], not
    /// here.
    ///
    /// ```
    /// # use selvedge_geometry::model::Camera;
    /// # use glam::{DMat3, DVec2, DVec3};
    /// let camera = Camera::from_intrinsics(800.0, 790.0, 300.0, 250.0, (640, 480));
    /// let camera = camera.posed(DMat3::IDENTITY, DVec3::Z * 4.0);
    /// let (pixel, depth) = camera.project(DVec3::new(1.0, -0.5, 0.0)).unwrap();
    /// // continuous positions have the first pixel's centre at (0.5, 0.5)
    /// assert!(pixel.distance(DVec2::new(800.0 / 4.0 + 300.5, 790.0 * -0.5 / 4.0 + 250.5)) < 1e-12 && depth == 4.0);
    /// ```
    pub fn from_intrinsics(fx: f64, fy: f64, cx: f64, cy: f64, size: (u32, u32)) -> Self {
        let projection = Projection::Pinhole { focal: DVec2::new(fx, fy), principal: DVec2::new(cx, cy) + 0.5 };
        Self { eye: DVec3::ZERO, target: DVec3::Z, up: -DVec3::Y, projection, depth_range: (1.0, 2.0), size }
    }

    /// The same camera, moved so that a point `X` of the model has the camera coordinates `rotation * X + translation`:
    /// x to the right, y down, z ahead. The rows of `rotation` are the camera's axes.
    #[must_use]
    pub fn posed(self, rotation: DMat3, translation: DVec3) -> Self {
        let axes = rotation.transpose();
        let eye = -(axes * translation);
        Self { eye, target: eye + axes.z_axis, up: -axes.y_axis, ..self }
    }

    /// A camera that shows the sphere around `bounds` from direction `from` (towards the eye); the depth range encloses
    /// it. [`Camera::framing`] fits a model tightly. `fov_y` in radians, `size` in pixels.
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

    /// Sets the depth range to the part of `bounds` in front of the eye, with a margin. For an eye beside or within the
    /// bounds it begins at a hundred-thousandth of its end, or at a tenth of the distance to the target if that is less.
    pub fn fit_depth(&mut self, bounds: Bounds) {
        let radius = (bounds.diagonal() * 0.5).max(1e-9);
        let (_, _, forward) = self.axes();
        let depth = if bounds.is_empty() { radius } else { (bounds.centre() - self.eye).dot(forward) };
        let far = (depth + radius * 1.01).max(radius * 1e-3);
        let held = self.eye.distance(self.target) * 0.1;
        let least = if held > 0.0 { held.min(far * 1e-5) } else { far * 1e-5 };
        let near = (depth - radius * 1.01).max(least);
        self.depth_range = (near, far.max(near * 2.0));
    }

    /// Right, up and forward unit vectors.
    pub fn axes(&self) -> (DVec3, DVec3, DVec3) {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        (right, right.cross(forward), forward)
    }

    /// Whether all rays start at the eye. In a parallel view they start in the plane of the eye.
    pub fn is_perspective(&self) -> bool {
        !matches!(self.projection, Projection::Orthographic { .. })
    }

    /// Width and height of the picture.
    fn pixels(&self) -> DVec2 {
        DVec2::new(f64::from(self.size.0), f64::from(self.size.1))
    }

    /// Pixels per unit slope, across and down; in a parallel view, pixels per model unit.
    pub fn focal_px(&self) -> DVec2 {
        let height_px = f64::from(self.size.1);
        match self.projection {
            Projection::Perspective { fov_y } => DVec2::splat(height_px * 0.5 / (fov_y * 0.5).tan()),
            Projection::Orthographic { height } => DVec2::splat(height_px / height),
            Projection::Pinhole { focal, .. } => focal,
        }
    }

    /// The pixel position of the view axis. Without a [`Projection::Pinhole`] it is the middle of the picture.
    pub fn principal_px(&self) -> DVec2 {
        match self.projection {
            Projection::Pinhole { principal, .. } => principal,
            _ => self.pixels() * 0.5,
        }
    }

    /// Model coordinates to *homogeneous pixels* `(X, Y, D, W)`: the pixel is `(X / W, Y / W)` with
    /// `y` down, and `D` is the depth along the view axis times the model point's weight. `W` is the
    /// depth for a perspective view and 1 for a parallel one.
    pub fn pixel_matrix(&self) -> DMat4 {
        let (right, up, forward) = self.axes();
        let (focal, principal) = (self.focal_px(), self.principal_px());
        let row = |axis: DVec3| axis.extend(-axis.dot(self.eye));
        let (rx, ry, rz) = (row(right), row(up), row(forward));
        let w = if self.is_perspective() { rz } else { DVec4::W };
        let (x, y) = (rx * focal.x + w * principal.x, ry * -focal.y + w * principal.y);
        DMat4::from_cols(x, y, rz, w).transpose()
    }

    /// Model coordinates to Vulkan's clip space, as in the engine's depth target: x to the right, y down, depth 1 at
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
        let nearness = if self.is_perspective() { nearness * near } else { nearness };
        let across = |row: DVec4, size: u32| row * (2.0 / f64::from(size)) - w;
        DMat4::from_cols(across(x, self.size.0), across(y, self.size.1), nearness, w).transpose()
    }

    /// The ray through pixel position `p` (continuous, `y` down): origin and unit direction, model coordinates.
    pub fn ray(&self, p: DVec2) -> (DVec3, DVec3) {
        let (right, up, forward) = self.axes();
        let principal = self.principal_px();
        let (x, y) = (p.x - principal.x, principal.y - p.y);
        if let Projection::Orthographic { height } = self.projection {
            let unit = height / f64::from(self.size.1);
            return (self.eye + right * (x * unit) + up * (y * unit), forward);
        }
        let focal = self.focal_px();
        let across = right * x + up * (y * (focal.x / focal.y));
        (self.eye, (forward + across / focal.x).normalize())
    }

    /// Pixel position and depth of a model point; `None` behind the eye of a perspective view. Depth is the distance
    /// from the eye along the view axis, model units.
    pub fn project(&self, p: DVec3) -> Option<(DVec2, f64)> {
        let q = self.pixel_matrix() * p.extend(1.0);
        (q.w > 0.0).then(|| (DVec2::new(q.x / q.w, q.y / q.w), q.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels and clip space agree, in both projections; right, down and near have Vulkan's signs.
    #[test]
    fn clip_space_is_that_of_pixels() {
        let off = Projection::Pinhole { focal: DVec2::new(250.0, 240.0), principal: DVec2::new(160.0, 90.0) };
        let lens = [Projection::Perspective { fov_y: 0.7 }, Projection::Orthographic { height: 3.0 }, off];
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
                    Projection::Orthographic { .. } => (20.0 - depth) / 19.5,
                    _ => (20.0 - depth) / 19.5 * 0.5 / depth,
                });
                assert!((clip - expected).abs().max_element() < 1e-12, "{clip} for {expected}");
                let signs = (clip.x * a >= -1e-12, clip.y * b <= 1e-12); // the axis may be off by roundings
                assert_eq!(signs, (true, true));
            }
        }
    }

    fn off_centre() -> Camera {
        let rotation = DMat3::from_euler(glam::EulerRot::XYZ, 0.3, -0.5, 0.2);
        let mut camera = Camera::from_intrinsics(812.5, 790.25, 170.75, 301.5, (640, 480));
        camera.depth_range = (0.1, 100.0);
        camera.posed(rotation, DVec3::new(0.2, -0.1, 9.0))
    }

    /// Pixels follow OpenCV's formula, written out here; the ray of a pixel runs through the projected point.
    #[test]
    fn calibrated_cameras_see_points_where_the_formula_says() {
        let camera = off_centre();
        assert_eq!(camera.check(), Ok(()));
        let rotation = DMat3::from_euler(glam::EulerRot::XYZ, 0.3, -0.5, 0.2);
        for point in [DVec3::ZERO, DVec3::new(1.0, -0.5, 0.7), DVec3::new(-3.1, 2.9, -4.3)] {
            let seen = rotation * point + DVec3::new(0.2, -0.1, 9.0);
            let expected =
                DVec2::new(812.5 * seen.x / seen.z + 170.75, 790.25 * seen.y / seen.z + 301.5) + DVec2::splat(0.5);
            let (pixel, depth) = camera.project(point).expect("in front");
            assert!((pixel - expected).length() < 1e-9 && (depth - seen.z).abs() < 1e-12, "{pixel} for {expected}");
            let (origin, direction) = camera.ray(pixel);
            let beside = (point - origin).cross(direction).length();
            assert!(beside < 1e-12 * point.distance(origin), "{beside}");
        }
    }

    #[test]
    fn what_a_view_from_very_near_looks_at_is_in_its_depth_range() {
        let bounds = Bounds { min: DVec3::splat(-50.0), max: DVec3::splat(50.0) };
        for distance in [1e-6, 1e-3, 1.0, 40.0, 400.0] {
            let target = DVec3::new(0.0, 0.0, 50.0);
            let mut camera = Camera { target, eye: target + DVec3::Z * distance, up: DVec3::Y, ..off_centre() };
            camera.fit_depth(bounds);
            let (near, far) = camera.depth_range;
            assert!(near > 0.0 && near < distance && far > distance + 100.0, "{distance}: {near} to {far}");
        }
    }

    #[test]
    fn calibrations_of_no_picture_are_refused() {
        let with = |fx, fy, cx, cy| {
            let camera = Camera::from_intrinsics(fx, fy, cx, cy, (640, 480));
            camera.check().expect_err("refused")
        };
        for (fx, fy) in [(0.0, 500.0), (500.0, -1.0), (500.0, 1001.0), (f64::NAN, 500.0), (f64::INFINITY, 1.0)] {
            assert_eq!(with(fx, fy, 320.0, 240.0), CameraError::Focal, "{fx} {fy}");
        }
        for (cx, cy) in [(f64::NAN, 240.0), (320.0, f64::INFINITY), (17100.0, 240.0), (320.0, -16500.0)] {
            assert_eq!(with(500.0, 500.0, cx, cy), CameraError::Principal, "{cx} {cy}");
        }
        assert_eq!(with(1e15, 1e15, 320.0, 240.0), CameraError::Narrow);
        assert_eq!(with(1e-16, 1e-16, 320.0, 240.0), CameraError::Scale);
        assert_eq!(Camera::from_intrinsics(500.0, 1000.0, 17000.0, -16000.0, (640, 480)).check(), Ok(()));
    }
}
