//! Cameras that are no standard views.

use glam::{DMat3, DVec3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use selvedge_jobs::{Directions, Lens, Pinhole, Viewpoint};

/// Where a picture is taken from, for any size: ``Camera.look_at`` or ``Camera.opencv``.
#[pyclass(frozen, module = "selvedge")]
pub struct Camera {
    pub viewpoint: Viewpoint,
}

/// Numbers of an array of any shape that has so many of them, row by row.
fn numbers<const N: usize>(what: &Bound<'_, PyAny>) -> PyResult<[f64; N]> {
    let array = what.py().import("numpy")?.call_method1("asarray", (what, "float64"))?;
    array.call_method1("reshape", (N,))?.extract()
}

#[pymethods]
impl Camera {
    /// A camera at `eye` that looks at `target`.
    ///
    /// eye, target, up: three numbers, millimetres of the model; `up` points up in the picture.
    /// fov: vertical field of view, degrees. ortho: a parallel view in its place, the picture's height in millimetres.
    #[staticmethod]
    #[pyo3(signature = (eye, target, up = [0.0, 0.0, 1.0], fov = None, ortho = None))]
    fn look_at(eye: [f64; 3], target: [f64; 3], up: [f64; 3], fov: Option<f64>, ortho: Option<f64>) -> PyResult<Self> {
        let lens = match (fov, ortho) {
            (Some(_), Some(_)) => return Err(PyValueError::new_err("fov and ortho exclude each other")),
            (fov, None) => Lens::Fov(fov.unwrap_or(selvedge::model::Camera::FOV_DEG)),
            (None, Some(height)) => Lens::Ortho(height),
        };
        let [eye, target, up] = [eye, target, up].map(DVec3::from);
        Ok(Self { viewpoint: Viewpoint::LookAt { eye, target, up, lens } })
    }

    /// A calibrated camera as OpenCV has it: a point X of the model is seen at K (R X + t).
    ///
    /// K: (3, 3), [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] in pixels of the picture that is drawn. The first pixel's
    /// centre is (0, 0); with first_pixel=0.5 it is (0.5, 0.5). fx and fy differ by no more than a factor of two, and
    /// the principal point lies within 16384 pixels of the picture. R: (3, 3), a rotation from model to camera axes. t:
    /// three numbers, millimetres.
    #[staticmethod]
    #[pyo3(signature = (K, R, t, first_pixel = 0.0))]
    #[allow(non_snake_case)] // the names that users know
    fn opencv(K: &Bound<'_, PyAny>, R: &Bound<'_, PyAny>, t: &Bound<'_, PyAny>, first_pixel: f64) -> PyResult<Self> {
        let matrix = |rows: [f64; 9]| DMat3::from_cols_array(&rows).transpose();
        let (intrinsics, rotation) = (matrix(numbers(K)?), matrix(numbers(R)?));
        let translation = DVec3::from(numbers::<3>(t)?);
        Ok(Self { viewpoint: Viewpoint::Pinhole(Pinhole { intrinsics, rotation, translation, first_pixel }) })
    }

    fn __repr__(&self) -> String {
        match self.viewpoint {
            Viewpoint::LookAt { eye, target, .. } => format!("Camera.look_at(eye={eye}, target={target})"),
            Viewpoint::Pinhole(Pinhole { translation, .. }) => format!("Camera.opencv(t={translation})"),
            Viewpoint::Standard(direction) => format!("{direction}"),
        }
    }
}

/// The viewpoint that a view's name and a camera say; one of them at most.
pub fn viewpoint(view: Option<&str>, camera: Option<&Camera>) -> PyResult<Viewpoint> {
    match (view, camera) {
        (Some(_), Some(_)) => Err(PyValueError::new_err("view and camera exclude each other")),
        (None, Some(camera)) => Ok(camera.viewpoint),
        (view, None) => {
            let list: Directions = view.unwrap_or("iso").parse().map_err(PyValueError::new_err)?;
            match list.0.as_slice() {
                [one] => Ok(Viewpoint::Standard(*one)),
                _ => Err(PyValueError::new_err("one view a picture")),
            }
        }
    }
}
