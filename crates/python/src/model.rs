//! Models: what a file holds, as Python sees it.

use crate::camera::{Camera, viewpoint};
use crate::error::{incomplete, raised};
use crate::picture::plain;
use crate::shape::{Edge, Face, corners};
use crate::waiting::apart;
use numpy::ndarray::Array2;
use numpy::{PyArray, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;
use selvedge::model;
use selvedge_io::import;
use selvedge_jobs::{JobError, Loaded, Node, ReadOptions, SNAP_KINDS, Snapper, Source, bounds, read};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// Where a model comes from.
#[derive(FromPyObject)]
pub enum From {
    #[pyo3(transparent)]
    Bytes(PyBackedBytes),
    #[pyo3(transparent)]
    Path(PathBuf),
}

/// Reads a file or bytes; see ``selvedge.open``.
#[pyfunction]
#[pyo3(signature = (source, name, strict, search, limit_mib, limit_s))]
pub fn open(
    py: Python<'_>,
    source: From,
    name: String,
    strict: bool,
    search: Vec<PathBuf>,
    limit_mib: Option<f64>,
    limit_s: Option<f64>,
) -> PyResult<Model> {
    let most_bytes = limit_mib.map(|mebibytes| (mebibytes * f64::from(1 << 20)) as u64);
    let most_time = limit_s.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
    let how = ReadOptions { most_bytes, most_time, search };
    let loaded = apart(py, move |stop| {
        let source = match &source {
            From::Path(path) => Source::Path(path),
            From::Bytes(bytes) => Source::Bytes { bytes, name: &name },
        };
        read(source, &how, stop, &|_| ())
    })?;
    if strict && !loaded.summary.is_complete() {
        return Err(incomplete(py, &loaded.file, &loaded.summary.to_string(), &loaded.warnings));
    }
    Ok(Model { loaded: Arc::new(loaded), faces: PyOnceLock::new(), edges: PyOnceLock::new(), snapper: OnceLock::new() })
}

/// A model in memory, as ``selvedge.open`` reads it. Lengths are millimetres.
#[pyclass(frozen, module = "selvedge")]
pub struct Model {
    pub loaded: Arc<Loaded>,
    faces: PyOnceLock<Py<PyTuple>>,
    edges: PyOnceLock<Py<PyTuple>>,
    snapper: OnceLock<Arc<Snapper>>,
}

#[pymethods]
impl Model {
    /// The file's or product's name.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.model.name
    }

    /// The file as messages name it.
    #[getter]
    fn file(&self) -> &str {
        &self.loaded.file
    }

    /// Length unit of the file; coordinates are millimetres all the same.
    #[getter]
    fn unit(&self) -> &str {
        &self.loaded.model.unit
    }

    /// What is drawn of the file and what is missing, in one sentence.
    #[getter]
    fn summary(&self) -> String {
        self.loaded.summary.to_string()
    }

    /// Whether all that the file states is there.
    #[getter]
    fn complete(&self) -> bool {
        self.loaded.summary.is_complete()
    }

    /// float64 (2, 3): smallest and largest coordinates of what is drawn, millimetres.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let model = Arc::clone(&self.loaded.model);
        corners(py, py.detach(|| bounds(&model)))
    }

    /// The assembly: names, bodies (part, name, count) and children, each like it. Occurrences side by side that
    /// hold the same are one node with all their names.
    #[getter]
    fn tree<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &Node::new(&self.loaded.model))
    }

    /// Distinct bodies. In the image "part" they are counted from 1.
    #[getter]
    fn parts(&self) -> Vec<Part> {
        let of = |index| Part { loaded: Arc::clone(&self.loaded), index };
        (0..self.loaded.model.parts.len()).map(of).collect()
    }

    /// Placed bodies. In the image "instance" they are counted from 1.
    #[getter]
    fn instances(&self) -> Vec<Instance> {
        let of = |index| Instance { loaded: Arc::clone(&self.loaded), index };
        (0..self.loaded.model.instances.len()).map(of).collect()
    }

    /// Faces of all parts, one part after another.
    #[getter]
    fn faces(&self, py: Python<'_>) -> PyResult<Py<PyTuple>> {
        let made = || {
            let parts = self.loaded.model.parts.iter().enumerate();
            let places = parts.flat_map(|(part, body)| (0..body.faces.len()).map(move |index| (part, index)));
            let faces = places.map(|(part, index)| Face { loaded: Arc::clone(&self.loaded), part, index });
            Ok::<_, PyErr>(
                PyTuple::new(py, faces.map(|face| Py::new(py, face)).collect::<PyResult<Vec<_>>>()?)?.unbind(),
            )
        };
        Ok(self.faces.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// Edges of all parts, one part after another, of each those of faces and then those of meshes. In the image
    /// "edge" they are counted from 1 in this order. Found when they are first asked for.
    #[getter]
    fn edges(&self, py: Python<'_>) -> PyResult<Py<PyTuple>> {
        let made = || {
            let model = Arc::clone(&self.loaded.model);
            let edges =
                |(part, p): (usize, &model::Part)| p.edges().map_err(|source| JobError::Boundary { part, source });
            let found = py.detach(|| model.parts.iter().enumerate().map(edges).collect::<Result<Vec<_>, _>>());
            let found = Arc::new(found.map_err(|error| raised(py, &error))?);
            let counts = found.iter().map(|edges| edges.edges.len() + edges.of_meshes.len());
            let places = counts.enumerate().flat_map(|(part, count)| (0..count).map(move |index| (part, index)));
            let edge = |(number, (part, index)): (usize, (usize, usize))| Edge {
                loaded: Arc::clone(&self.loaded),
                found: Arc::clone(&found),
                part,
                index,
                number: number + 1,
            };
            let edges = places.enumerate().map(|place| Py::new(py, edge(place))).collect::<PyResult<Vec<_>>>()?;
            Ok::<_, PyErr>(PyTuple::new(py, edges)?.unbind())
        };
        Ok(self.edges.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// A visible point of the model near a place in a view's picture, to snap to.
    ///
    /// at: (x, y) in pixels from the upper left corner; the first pixel's centre is (0.5, 0.5). size, view, camera: as
    /// in Renderer.render. radius: pixels. kinds: some of "vertex" (an edge's end), "centre" (of a round edge) and
    /// "edge"; without it all. A vertex is preferred to a centre, and both to an edge. An edge offers only its point
    /// nearest to the place.
    ///
    /// Returns a dict: kind, point (millimetres), pixel, distance_px, depth, instance (place in Model.instances) and
    /// edge (Edge.number); or None if no visible point is near. The search uses double precision and no device.
    #[allow(clippy::too_many_arguments)] // keywords of Python
    #[pyo3(signature = (at, radius = 8.0, view = None, size = (1920, 1080), *, camera = None, kinds = None))]
    fn snap<'py>(
        &self,
        py: Python<'py>,
        at: [f64; 2],
        radius: f64,
        view: Option<&str>,
        size: (u32, u32),
        camera: Option<PyRef<'_, Camera>>,
        kinds: Option<Vec<String>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let kind = |name: &String| {
            let known = SNAP_KINDS.iter().find(|(known, _)| known == name).map(|(_, kind)| *kind);
            known.ok_or_else(|| PyValueError::new_err(format!("kinds are vertex, centre and edge, not {name}")))
        };
        let kinds = match kinds {
            Some(names) => names.iter().map(kind).collect::<PyResult<Vec<_>>>()?,
            None => SNAP_KINDS.map(|(_, kind)| kind).to_vec(),
        };
        let viewpoint = viewpoint(view, camera.as_deref())?;
        let found = py.detach(|| {
            let camera = viewpoint.camera(&self.loaded.model, size)?;
            let snapper = match self.snapper.get() {
                Some(snapper) => snapper,
                None => {
                    let made = Arc::new(Snapper::new(Arc::clone(&self.loaded.model))?);
                    self.snapper.get_or_init(|| made)
                }
            };
            snapper.snap(&camera, at, radius, &kinds)
        });
        found.map_err(|error| raised(py, &error))?.map(|snapped| plain(py, &snapped)).transpose()
    }

    /// What was left out or repaired, in the order in which it was found.
    #[getter]
    fn warnings(&self) -> Vec<Warning> {
        self.loaded.warnings.iter().cloned().map(|inner| Warning { inner }).collect()
    }

    fn __repr__(&self) -> String {
        format!("<selvedge.Model {}: {}>", self.loaded.file, self.loaded.summary)
    }
}

/// A distinct body.
#[pyclass(frozen, module = "selvedge")]
pub struct Part {
    loaded: Arc<Loaded>,
    index: usize,
}

impl Part {
    fn inner(&self) -> &model::Part {
        &self.loaded.model.parts[self.index]
    }
}

#[pymethods]
impl Part {
    /// Its place in Model.parts.
    #[getter]
    fn index(&self) -> usize {
        self.index
    }

    /// Name in the file, or empty.
    #[getter]
    fn name(&self) -> &str {
        &self.inner().name
    }

    /// Whether its faces or meshes bound a volume.
    #[getter]
    fn closed(&self) -> bool {
        self.inner().closed
    }

    /// Its faces.
    #[getter]
    fn faces(&self) -> Vec<Face> {
        let of = |index| Face { loaded: Arc::clone(&self.loaded), part: self.index, index };
        (0..self.inner().faces.len()).map(of).collect()
    }

    /// How many meshes it has.
    #[getter]
    fn meshes(&self) -> usize {
        self.inner().meshes.len()
    }

    fn __repr__(&self) -> String {
        format!("<selvedge.Part {} {:?}: {} faces>", self.index, self.inner().name, self.inner().faces.len())
    }
}

/// A part placed in the model.
#[pyclass(frozen, module = "selvedge")]
pub struct Instance {
    loaded: Arc<Loaded>,
    index: usize,
}

#[pymethods]
impl Instance {
    /// Its place in Model.instances.
    #[getter]
    fn index(&self) -> usize {
        self.index
    }

    /// Names of the occurrences from the root, with slashes between.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.model.instances[self.index].name
    }

    /// The part that is placed, by its place in Model.parts.
    #[getter]
    fn part(&self) -> usize {
        self.loaded.model.instances[self.index].part
    }

    /// float64 (4, 4): part to model coordinates, millimetres, for columns: model = transform @ [x, y, z, 1].
    #[getter]
    fn transform<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let matrix = glam::DMat4::from(self.loaded.model.instances[self.index].transform);
        let rows = Array2::from_shape_fn((4, 4), |(row, column)| matrix.col(column)[row]);
        PyArray::from_owned_array(py, rows)
    }

    fn __repr__(&self) -> String {
        format!("<selvedge.Instance {} {:?} of part {}>", self.index, self.name(), self.part())
    }
}

/// Something in a file that was left out, repaired or guessed.
#[pyclass(frozen, module = "selvedge")]
pub struct Warning {
    inner: import::Warning,
}

#[pymethods]
impl Warning {
    /// The file.
    #[getter]
    fn file(&self) -> &str {
        &self.inner.file
    }

    /// Line, counted from 1, or None.
    #[getter]
    fn line(&self) -> Option<usize> {
        self.inner.place.numbers().0
    }

    /// Number of the entity, or None.
    #[getter]
    fn entity(&self) -> Option<u32> {
        self.inner.place.numbers().1
    }

    /// What was wrong and what was done.
    #[getter]
    fn message(&self) -> &str {
        &self.inner.message
    }

    /// How many occurrences this one stands for.
    #[getter]
    fn count(&self) -> usize {
        self.inner.count
    }

    fn __str__(&self) -> String {
        self.inner.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<selvedge.Warning {}>", self.inner)
    }
}
