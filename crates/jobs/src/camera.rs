//! Cameras that frame a model, look from a point, or belong to a calibrated picture; the camera file for other
//! programs.
//!
//! ```text
//!   OpenCV      x right, y down, z ahead; pixel (0, 0) has its centre at (0, 0)      p ~ K (R X + t)
//!   here        y down in pixels; pixel (0, 0) has its centre at (0.5, 0.5)
//!   eye = -Rᵀ t      ahead = third row of R      up = -second row
//! ```

use crate::directions::Direction;
use crate::error::JobError;
use glam::{DMat3, DVec3};
use selvedge::model::{Bounds, Camera, CameraError, Model, Projection};
use serde::Serialize;

/// Largest deviation of a rotation from orthonormal, and of the zeros and the one in K: decimal files round so much
/// off.
const ROUNDED: f64 = 1e-6;

/// How wide a view is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Vertical field of view, degrees.
    Fov(f64),
    /// Parallel; the height of the picture in model units.
    Ortho(f64),
}

impl Default for Lens {
    fn default() -> Self {
        Self::Fov(Camera::FOV_DEG)
    }
}

impl Lens {
    fn projection(self) -> Projection {
        match self {
            Self::Fov(degrees) => Projection::Perspective { fov_y: degrees.to_radians() },
            Self::Ortho(height) => Projection::Orthographic { height },
        }
    }
}

/// A calibrated camera and its pose, as OpenCV has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// `fx 0 cx / 0 fy cy / 0 0 1`, pixels.
    pub intrinsics: DMat3,
    /// Model to camera axes.
    pub rotation: DMat3,
    /// The model's origin in camera axes, model units.
    pub translation: DVec3,
    /// Where the middle of the first pixel is: 0 in OpenCV, 0.5 where pixels are counted from their corners.
    pub first_pixel: f64,
}

/// How a picture is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// From a standard direction, fitted to the model.
    Standard(Direction),
    /// From a point to another.
    LookAt {
        /// The eye, model units.
        eye: DVec3,
        /// The point in the middle of the picture.
        target: DVec3,
        /// The direction that is up in the picture.
        up: DVec3,
        /// How wide.
        lens: Lens,
    },
    /// By matrices.
    Pinhole(Pinhole),
}

impl Viewpoint {
    /// The camera, its depth range that of the model.
    ///
    /// # Errors
    /// [`JobError::Camera`], [`JobError::Pinhole`].
    pub fn camera(&self, model: &Model, size: (u32, u32)) -> Result<Camera, JobError> {
        // a picture without pixels frames nothing
        if size.0 == 0 || size.1 == 0 {
            return Err(CameraError::Size.into());
        }
        let camera = match *self {
            Self::Standard(direction) => {
                Camera::framing(model, direction.from(), direction.up(), Camera::FOV_DEG.to_radians(), size)
            }
            Self::LookAt { eye, target, up, lens } => {
                Camera { eye, target, up, projection: lens.projection(), depth_range: (1.0, 2.0), size }
            }
            Self::Pinhole(pinhole) => pinhole.camera(size)?,
        };
        // a camera without a direction has no depth either
        camera.check()?;
        Ok(fitted(camera, bounds(model))?)
    }
}

impl Pinhole {
    fn camera(&self, size: (u32, u32)) -> Result<Camera, JobError> {
        let Self { intrinsics: k, rotation, translation, first_pixel } = *self;
        let bad = |why| Err(JobError::Pinhole(why));
        if !(k.is_finite() && rotation.is_finite() && translation.is_finite() && first_pixel.is_finite()) {
            return bad("a camera matrix has an entry that is not a number");
        }
        let turned = rotation * rotation.transpose() - DMat3::IDENTITY;
        if turned.to_cols_array().iter().any(|x| x.abs() > ROUNDED) || rotation.determinant() < 0.0 {
            return bad("R is no rotation: its rows are not at right angles and of length 1, or it mirrors");
        }
        let (fx, fy) = (k.x_axis.x, k.y_axis.y);
        let below = [k.x_axis.y, k.x_axis.z, k.y_axis.z, k.y_axis.x];
        if !(fx > 0.0 && fy > 0.0) || below.iter().any(|x| x.abs() > ROUNDED) || (k.z_axis.z - 1.0).abs() > ROUNDED {
            return bad("K must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] with fx and fy above 0");
        }
        let (cx, cy) = (k.z_axis.x - first_pixel, k.z_axis.y - first_pixel);
        Ok(Camera::from_intrinsics(fx, fy, cx, cy, size).posed(rotation, translation))
    }
}

/// The box for a picture of the whole model: that of its control points where its trims leave nothing, so that there is
/// a picture that shows this.
pub fn bounds(model: &Model) -> Bounds {
    let bounds = model.bounds();
    if bounds.is_empty() { model.control_bounds() } else { bounds }
}

/// A camera with all of the model in the picture.
pub fn whole(bounds: Bounds, size: (u32, u32)) -> Camera {
    Camera::around(bounds, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size)
}

/// `camera` with a depth range that holds the model, checked.
///
/// # Errors
/// As [`Camera::check`].
pub fn fitted(mut camera: Camera, bounds: Bounds) -> Result<Camera, CameraError> {
    camera.fit_depth(bounds);
    camera.check()?;
    Ok(camera)
}

/// A camera as other programs read it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CameraFile {
    /// The eye, model units.
    pub eye: [f64; 3],
    /// The point in the middle of the picture.
    pub target: [f64; 3],
    /// The direction that is up in the picture.
    pub up: [f64; 3],
    /// Vertical field of view, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fovy: Option<f64>,
    /// fx, fy, cx and cy of a calibrated camera, as OpenCV has them, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub intrinsics: Option<[f64; 4]>,
    /// Half the height of a parallel view, millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ortho: Option<f64>,
    /// Width and height, pixels.
    pub size: [u32; 2],
}

impl From<&Camera> for CameraFile {
    fn from(camera: &Camera) -> Self {
        let (mut fovy, mut intrinsics, mut ortho) = (None, None, None);
        match camera.projection {
            Projection::Perspective { fov_y } => fovy = Some(fov_y.to_degrees()),
            Projection::Orthographic { height } => ortho = Some(height * 0.5),
            Projection::Pinhole { focal, principal } => {
                intrinsics = Some([focal.x, focal.y, principal.x - 0.5, principal.y - 0.5]);
            }
        }
        Self {
            eye: camera.eye.into(),
            target: camera.target.into(),
            up: camera.up.into(),
            fovy,
            intrinsics,
            ortho,
            size: camera.size.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, EulerRot};

    fn pinhole() -> Pinhole {
        let intrinsics = DMat3::from_cols(DVec3::X * 800.0, DVec3::Y * 790.5, DVec3::new(301.25, 255.5, 1.0));
        let rotation = DMat3::from_euler(EulerRot::XYZ, 0.3, -0.5, 0.2);
        Pinhole { intrinsics, rotation, translation: DVec3::new(0.2, -0.1, 9.0), first_pixel: 0.0 }
    }

    /// By OpenCV's own formula, computed separately.
    #[test]
    fn points_fall_where_opencv_projects_them() {
        let pinhole = pinhole();
        let camera = pinhole.camera((640, 480)).expect("a camera");
        for point in [DVec3::ZERO, DVec3::new(1.0, -0.5, 0.7), DVec3::new(-1.1, 0.9, -0.3)] {
            let seen = pinhole.intrinsics * (pinhole.rotation * point + pinhole.translation);
            let (pixel, depth) = camera.project(point).expect("in front");
            let expected = DVec2::new(seen.x / seen.z, seen.y / seen.z) + 0.5;
            assert!((pixel - expected).length() < 1e-9 && (depth - seen.z).abs() < 1e-12, "{pixel} for {expected}");
        }
    }

    #[test]
    fn matrices_of_no_camera_are_refused() {
        let good = pinhole();
        let with = |change: fn(&mut Pinhole)| {
            let mut pinhole = good;
            change(&mut pinhole);
            pinhole.camera((640, 480)).expect_err("refused").to_string()
        };
        assert!(with(|p| p.intrinsics.y_axis.x = 1.0).contains("K must be"));
        assert!(with(|p| p.rotation.x_axis *= -1.0).contains("no rotation"));
        assert!(with(|p| p.rotation *= 1.01).contains("no rotation"));
        assert!(with(|p| p.translation.x = f64::NAN).contains("not a number"));
        let corners = Pinhole { first_pixel: 0.5, ..good };
        let corners = Pinhole {
            intrinsics: DMat3::from_cols(DVec3::X * 800.0, DVec3::Y * 790.5, DVec3::new(301.75, 256.0, 1.0)),
            ..corners
        };
        assert_eq!(corners.camera((640, 480)).expect("a camera"), good.camera((640, 480)).expect("a camera"));
        let far = Viewpoint::Pinhole(Pinhole { first_pixel: 17_000.0, ..good });
        let error = far.camera(&Model::default(), (640, 480)).expect_err("refused").to_string();
        assert!(error.contains("principal point"), "{error}");
    }

    #[test]
    fn the_file_holds_degrees_or_half_the_height() {
        let text = |projection| {
            let camera = Camera { projection, ..whole(Bounds { min: DVec3::ZERO, max: DVec3::ONE }, (64, 48)) };
            serde_json::to_value(CameraFile::from(&camera)).expect("serialises")
        };
        let fov = text(Projection::Perspective { fov_y: 40f64.to_radians() });
        assert!((fov["fovy"].as_f64().expect("degrees") - 40.0).abs() < 1e-12 && fov.get("ortho").is_none());
        assert_eq!(fov["size"], serde_json::json!([64, 48]));
        let ortho = text(Projection::Orthographic { height: 20.0 });
        assert!(ortho["ortho"] == 10.0 && ortho.get("fovy").is_none());
        let pinhole = serde_json::to_value(CameraFile::from(&pinhole().camera((640, 480)).expect("a camera")));
        assert_eq!(pinhole.expect("serialises")["intrinsics"], serde_json::json!([800.0, 790.5, 301.25, 255.5]));
    }
}
