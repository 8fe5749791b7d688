//! Pictures as NumPy arrays.

use numpy::ndarray::{Array2, Array3};
use numpy::{Element, PyArray, PyReadonlyArray3};
use pyo3::exceptions::{PyAttributeError, PyOSError, PyRuntimeWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use selvedge::picture::{self, Outputs};
use selvedge_jobs::{CameraFile, Drawn, Image, save_png, write_png};
use serde::Serialize;
use std::ffi::CString;
use std::path::PathBuf;

/// A finished picture: an array for each output, row 0 on top, as an attribute of its name. Renderer.render lists
/// them with dtype, shape and unit.
#[pyclass(frozen, module = "selvedge")]
pub struct Picture {
    size: (u32, u32),
    images: Py<PyDict>,
    camera: Py<PyAny>,
    stats: Py<PyAny>,
}

/// Plain dictionaries, lists and numbers of something that has a form in JSON.
pub fn plain<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

impl Picture {
    /// The arrays take over the picture's memory: nothing is copied.
    pub fn new(py: Python<'_>, drawn: Drawn, outputs: Outputs, camera: &CameraFile) -> PyResult<Self> {
        let Drawn { picture, upload_s, draw_s, blank } = drawn;
        let picture::Picture { size, colour, depth, face, uv, normal, thickness, edge, part, instance, stats, .. } =
            picture;
        if stats.clamps > 0 {
            let text = format!(
                "{} places of the picture do not keep the promise of accuracy: stats[\"clamps\"]",
                stats.clamps
            );
            let text = CString::new(text).unwrap_or_default();
            PyErr::warn(py, &py.get_type::<PyRuntimeWarning>(), &text, 2)?;
        }
        let images = PyDict::new(py);
        images.set_item("colour", cube(py, size, 4, colour.into_flattened())?)?;
        let floats = [(Image::Depth, outputs.depth, depth), (Image::Thickness, outputs.thickness, thickness)];
        for (image, _, values) in floats.into_iter().filter(|(_, wanted, _)| *wanted) {
            images.set_item(image.name(), plane(py, size, values)?)?;
        }
        let numbers = [
            (Image::Face, outputs.face, face),
            (Image::Edge, outputs.edge, edge),
            (Image::Part, outputs.part, part),
            (Image::Instance, outputs.instance, instance),
        ];
        for (image, _, values) in numbers.into_iter().filter(|(_, wanted, _)| *wanted) {
            images.set_item(image.name(), plane(py, size, values)?)?;
        }
        if outputs.uv {
            images.set_item(Image::Uv.name(), cube(py, size, 2, uv.into_flattened())?)?;
        }
        if outputs.normal {
            images.set_item(Image::Normal.name(), cube(py, size, 3, normal.into_flattened())?)?;
        }
        let stats = plain(py, &stats)?;
        stats.set_item("upload_s", upload_s)?;
        stats.set_item("draw_s", draw_s)?;
        stats.set_item("blank", blank)?;
        Ok(Self { size, images: images.unbind(), camera: plain(py, camera)?.unbind(), stats: stats.unbind() })
    }

    fn pixels(&self, py: Python<'_>) -> PyResult<Vec<[u8; 4]>> {
        let colour = self.images.bind(py).as_any().get_item("colour")?;
        let colour = colour.extract::<PyReadonlyArray3<'_, u8>>()?;
        Ok(colour.as_slice()?.as_chunks().0.to_vec())
    }
}

fn shaped(error: numpy::ndarray::ShapeError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// (H, W)
fn plane<T: Element>(py: Python<'_>, (w, h): (u32, u32), values: Vec<T>) -> PyResult<Bound<'_, PyAny>> {
    let array = Array2::from_shape_vec((h as usize, w as usize), values).map_err(shaped)?;
    Ok(PyArray::from_owned_array(py, array).into_any())
}

/// (H, W, channels)
fn cube<T: Element>(py: Python<'_>, (w, h): (u32, u32), channels: usize, values: Vec<T>) -> PyResult<Bound<'_, PyAny>> {
    let array = Array3::from_shape_vec((h as usize, w as usize, channels), values).map_err(shaped)?;
    Ok(PyArray::from_owned_array(py, array).into_any())
}

#[pymethods]
impl Picture {
    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The arrays by name: "colour" and the outputs of the picture.
    #[getter]
    fn images(&self, py: Python<'_>) -> Py<PyDict> {
        self.images.clone_ref(py)
    }

    /// eye, target, up, fovy in degrees or ortho (half the height), millimetres; size in pixels.
    #[getter]
    fn camera(&self, py: Python<'_>) -> Py<PyAny> {
        self.camera.clone_ref(py)
    }

    /// Device, driver, milliseconds of each pass, counts; "clamps" above 0 are places where the promise is not
    /// kept. "upload_s": seconds in which the model was prepared, before its first picture. "draw_s": seconds of this
    /// picture; with pictures in flight, since the one before. "blank": no pixel shows anything of the model; known
    /// with the image of faces, or on a background that hides nothing, else False.
    #[getter]
    fn stats(&self, py: Python<'_>) -> Py<PyAny> {
        self.stats.clone_ref(py)
    }

    /// An image by its name; those that are no output of the picture raise AttributeError.
    fn __getattr__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        if let Some(image) = self.images.bind(py).get_item(name)? {
            return Ok(image.unbind());
        }
        Err(PyAttributeError::new_err(match name.parse::<Image>() {
            Ok(_) => format!("the picture has no {name}: ask for it, as in outputs=[\"{name}\"]"),
            Err(_) => format!("'Picture' object has no attribute '{name}'"),
        }))
    }

    /// Writes the colour as a PNG file. Raises ValueError for a name that does not end in .png, and OSError.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
            return Err(PyValueError::new_err(format!(
                "{}: what is saved is PNG, so its name ends in .png",
                path.display()
            )));
        }
        let (size, pixels) = (self.size, self.pixels(py)?);
        py.detach(|| save_png(&path, size, &pixels))
            .map_err(|error| PyOSError::new_err(format!("cannot write {}: {error}", path.display())))
    }

    /// The colour as PNG, which notebooks show.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let (size, pixels) = (self.size, self.pixels(py)?);
        let mut bytes = Vec::new();
        py.detach(|| write_png(&mut bytes, size, &pixels)).map_err(|error| PyOSError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let names: Vec<String> = self.images.bind(py).keys().extract()?;
        Ok(format!("<selvedge.Picture {} x {}: {}>", self.size.0, self.size.1, names.join(", ")))
    }
}
