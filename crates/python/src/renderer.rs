//! Renderers, and the judge.

use crate::camera::{Camera, viewpoint};
use crate::error::raised;
use crate::model::Model;
use crate::picture::{Picture, plain};
use crate::waiting::{apart, until};
use glam::DVec3;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use selvedge::model::Camera as View;
use selvedge::picture::{EdgeChoice, EdgeSettings, FrameSettings, Outputs, Samples, SceneSettings, Smooth, Style};
use selvedge_jobs::{
    self as jobs, Ambient, Backdrop, CameraFile, DeviceOptions, Drawn, Image, Job, JobError, Ticket, Verdict,
    Viewpoint, Worker, lines, smooth,
};
use std::str::FromStr;
use std::sync::{Arc, Mutex, PoisonError, RwLock};
use std::time::Duration;

/// Longest side of a picture, pixels.
const MOST_PIXELS: i64 = 16_384;

/// A device, and a thread that draws on it; see ``selvedge.Renderer``.
#[pyclass(frozen, module = "selvedge._native")]
pub struct Renderer {
    /// Nothing once it is closed. No code of Python's runs while it is locked: it may let another thread have the
    /// interpreter's lock, which waits for this one then.
    worker: RwLock<Option<Worker>>,
}

/// How a picture is drawn, as ``selvedge.Renderer.render`` has it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings<'py> {
    view: Option<String>,
    camera: Option<PyRef<'py, Camera>>,
    size: (i64, i64),
    outputs: Vec<String>,
    style: String,
    curvature_range: Option<f64>,
    background: String,
    edges: Option<String>,
    silhouettes: bool,
    hidden_lines: bool,
    line_width: Option<f64>,
    samples: u32,
    smooth: Option<String>,
    ao: Option<Bound<'py, PyAny>>,
    sun: Option<[f64; 3]>,
    tolerance: f64,
}

/// A word of a list, or ValueError with the list.
fn word<T: FromStr>(text: &str) -> PyResult<T>
where
    T::Err: ToString,
{
    text.parse().map_err(|error: T::Err| PyValueError::new_err(error.to_string()))
}

impl Settings<'_> {
    fn pixels(&self) -> PyResult<(u32, u32)> {
        let (width, height) = self.size;
        let range = 1..=MOST_PIXELS;
        if !(range.contains(&width) && range.contains(&height)) {
            let text = format!("size must be (width, height), each from 1 to {MOST_PIXELS}, not ({width}, {height})");
            return Err(PyValueError::new_err(text));
        }
        Ok((width as u32, height as u32))
    }

    fn outputs(&self) -> PyResult<Outputs> {
        let beside = self.outputs.iter().filter(|name| *name != "colour");
        Ok(Image::outputs(beside.map(|name| word::<Image>(name)).collect::<PyResult<Vec<_>>>()?))
    }

    /// Lines in the picture; the image of edges is made of them.
    fn lines(&self, outputs: Outputs, size: (u32, u32)) -> PyResult<Option<EdgeSettings>> {
        let usual = if outputs.edge { "all" } else { "none" };
        let which: EdgeChoice = word(self.edges.as_deref().unwrap_or(usual))?;
        let (silhouettes, hidden) = (self.silhouettes, self.hidden_lines);
        let settings = EdgeSettings { which, silhouettes, hidden, ..lines(self.line_width, size.1) };
        settings.check().map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok((which != EdgeChoice::None || self.silhouettes).then_some(settings))
    }

    /// The arguments, each by itself.
    fn chosen(&self) -> PyResult<Chosen> {
        let (size, outputs) = (self.pixels()?, self.outputs()?);
        if !(self.tolerance >= FrameSettings::LEAST_TOLERANCE_PX && self.tolerance.is_finite()) {
            let least = FrameSettings::LEAST_TOLERANCE_PX;
            return Err(PyValueError::new_err(format!(
                "tolerance must be at least {least} pixels, not {}",
                self.tolerance
            )));
        }
        let sun = self.sun.map(DVec3::from);
        if let Some(sun) = sun.filter(|sun| !sun.is_finite() || *sun == DVec3::ZERO) {
            return Err(PyValueError::new_err(format!("sun must be a direction: finite and not 0, not {sun}")));
        }
        let samples: Samples = word(&self.samples.to_string())?;
        let style = word::<Style>(&self.style)?;
        if let Some(range) = self.curvature_range.filter(|range| !(range.is_finite() && *range > 0.0))
            && style.is_curvature()
        {
            return Err(PyValueError::new_err(format!("curvature_range must be above 0, not {range}")));
        }
        Ok(Chosen {
            size,
            outputs,
            viewpoint: viewpoint(self.view.as_deref(), self.camera.as_deref())?,
            lines: self.lines(outputs, size)?,
            samples,
            smooth: smooth(self.smooth.as_deref().map(word::<Smooth>).transpose()?, samples),
            ambient: self.ao.as_ref().map(|said| word::<Ambient>(&said.str()?.to_string())).transpose()?,
            sun,
            style,
            curvature_range: self.curvature_range,
            tolerance: self.tolerance,
            backdrop: word::<Backdrop>(&self.background)?,
        })
    }

    fn job(&self, py: Python<'_>, model: &Model) -> PyResult<Job> {
        let (chosen, model) = (self.chosen()?, Arc::clone(&model.loaded.model));
        py.detach(|| chosen.job(model)).map_err(|error| raised(py, &error))
    }
}

/// [`Settings`] whose words are known and whose numbers are in range.
struct Chosen {
    size: (u32, u32),
    outputs: Outputs,
    viewpoint: Viewpoint,
    lines: Option<EdgeSettings>,
    samples: Samples,
    smooth: Smooth,
    ambient: Option<Ambient>,
    sun: Option<DVec3>,
    style: Style,
    curvature_range: Option<f64>,
    tolerance: f64,
    backdrop: Backdrop,
}

impl Chosen {
    /// The picture of a model.
    fn job(self, model: Arc<selvedge::model::Model>) -> Result<Job, JobError> {
        let camera = self.viewpoint.camera(&model, self.size)?;
        let curvature = self.style.is_curvature();
        let curvature_range = match self.curvature_range {
            _ if !curvature => 1.0,
            Some(range) => range,
            None => model.curvature_range(),
        };
        let scene = SceneSettings {
            curvature,
            edges: self.lines,
            samples: self.samples,
            smooth: self.smooth,
            ambient: Ambient::radius(self.ambient, self.samples, &model),
            sun: self.sun,
            ..SceneSettings::default()
        };
        let frame = FrameSettings {
            tolerance_px: self.tolerance,
            style: self.style,
            curvature_range,
            ..FrameSettings::default()
        };
        let (outputs, backdrop) = (self.outputs, self.backdrop);
        Ok(Job { model, camera, scene, frame, outputs, backdrop, limits: Default::default() })
    }
}

impl Renderer {
    fn order(&self, py: Python<'_>, job: Job) -> PyResult<Pending> {
        let (outputs, camera) = (job.outputs, job.camera);
        let submitted = {
            let worker = self.worker.read().unwrap_or_else(PoisonError::into_inner);
            worker.as_ref().ok_or(JobError::Closed).and_then(|worker| worker.submit(job))
        };
        let ticket = submitted.map_err(|error| raised(py, &error))?;
        Ok(Pending { ticket: Mutex::new(Some(ticket)), outputs, camera })
    }
}

#[pymethods]
impl Renderer {
    #[new]
    #[pyo3(signature = (device, validation, limit_mib))]
    fn new(py: Python<'_>, device: Option<String>, validation: bool, limit_mib: Option<f64>) -> PyResult<Self> {
        let memory_budget = limit_mib.map(|mebibytes| (mebibytes * f64::from(1 << 20)) as u64);
        let options = DeviceOptions { device, validation, memory_budget, ..Default::default() };
        let worker = apart(py, move |_| Worker::new(options))?;
        Ok(Self { worker: RwLock::new(Some(worker)) })
    }

    /// Sends a picture to the device's thread.
    #[pyo3(signature = (model, settings, limits = None))]
    fn submit(
        &self,
        py: Python<'_>,
        model: &Model,
        settings: Settings<'_>,
        limits: Option<PyRef<'_, Limits>>,
    ) -> PyResult<Pending> {
        let limits = limits.map(|limits| limits.inner.clone()).unwrap_or_default();
        let job = Job { limits, ..settings.job(py, model)? };
        self.order(py, job)
    }

    /// Frees the device once the pictures sent before are drawn.
    fn close(&self, py: Python<'_>) {
        py.detach(|| {
            let worker = self.worker.write().unwrap_or_else(PoisonError::into_inner).take();
            drop(worker);
        });
    }

    /// Whether it was closed.
    #[getter]
    fn closed(&self) -> bool {
        self.worker.read().unwrap_or_else(PoisonError::into_inner).is_none()
    }
}

/// The time of a file's pictures, which share it; see ``selvedge.render_files``.
#[pyclass(frozen, module = "selvedge._native")]
pub struct Limits {
    inner: jobs::Limits,
}

#[pymethods]
impl Limits {
    /// Of a file, in seconds; reading it has spent some.
    #[new]
    #[pyo3(signature = (file, most_s, spent_s))]
    fn new(file: String, most_s: Option<f64>, spent_s: f64) -> Self {
        let duration = |seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        let inner = jobs::Limits::new(&file, most_s.map(duration), None);
        inner.spend(duration(spent_s));
        Self { inner }
    }
}

/// A picture that will be there.
#[pyclass(frozen, module = "selvedge._native")]
pub struct Pending {
    ticket: Mutex<Option<Ticket>>,
    outputs: Outputs,
    camera: View,
}

impl Pending {
    fn drawn(&self, py: Python<'_>) -> PyResult<Drawn> {
        let ticket = self.ticket.lock().unwrap_or_else(PoisonError::into_inner).take();
        let ticket = ticket.ok_or_else(|| PyRuntimeError::new_err("the picture was taken before"))?;
        let ticket = Mutex::new(ticket);
        let locked = || ticket.lock().unwrap_or_else(PoisonError::into_inner);
        until(py, || locked().stop(), |at_most| locked().wait(at_most))
    }
}

#[pymethods]
impl Pending {
    /// Waits for the picture; once.
    fn result(&self, py: Python<'_>) -> PyResult<Picture> {
        let drawn = self.drawn(py)?;
        Picture::new(py, drawn, self.outputs, &CameraFile::from(&self.camera))
    }

    /// The picture is not drawn if it is not begun.
    fn cancel(&self) {
        if let Some(ticket) = &*self.ticket.lock().unwrap_or_else(PoisonError::into_inner) {
            ticket.stop();
        }
    }
}

/// Draws and judges; see ``selvedge.check``.
#[pyfunction]
pub fn check<'py>(
    py: Python<'py>,
    renderer: &Renderer,
    model: &Model,
    settings: Settings<'_>,
    judged: usize,
) -> PyResult<Bound<'py, PyAny>> {
    let images = Outputs { edge: false, ..Outputs::ALL };
    let job = Job { outputs: images, ..settings.job(py, model)? };
    let (model, camera, tolerance) = (Arc::clone(&job.model), job.camera, job.frame.tolerance_px);
    let picture = renderer.order(py, job)?.drawn(py)?.picture;
    let verdict = apart(py, move |stop| Verdict::new(&model, &camera, &picture, judged, tolerance, stop))?;
    plain(py, &verdict)
}

/// Raises what is wrong with a picture's settings, whatever the model.
#[pyfunction]
pub fn validate(settings: Settings<'_>) -> PyResult<()> {
    settings.chosen().map(|_| ())
}
