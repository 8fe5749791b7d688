//! Renderers: a device and a thread that draws on it.

use crate::border::{Failure, SelvedgeStatus, Sized, argument, border, free, handle, place, taken, text};
use crate::model::{NO_TEXT, SelvedgeModel};
use crate::picture::{SelvedgePicture, images};
use glam::{DMat3, DVec3};
use selvedge::model::{Camera, Model};
use selvedge::picture::{EdgeChoice, EdgeSettings, FrameSettings, Samples, SceneSettings, Style};
use selvedge_jobs::{
    Ambient, Backdrop, DeviceOptions, Directions, Image, Job, Lens, Limits, Pinhole, Viewpoint, Worker, colour, lines,
    smooth,
};
use std::ffi::c_char;
use std::str::FromStr;
use std::sync::Arc;
use std::time::Duration;

/// A device that draws. Several threads may use one: it draws their pictures in turn.
pub struct SelvedgeRenderer {
    worker: Worker,
}

/// Which device. Zeros are the defaults.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeRendererOptions {
    /// sizeof(SelvedgeRendererOptions)
    pub struct_size: usize,
    /// Part of the device's name; null takes a discrete GPU, else an integrated one, else the CPU. Of several devices it
    /// is the first, and with "#1" behind it the second: "#1" alone is the second of all.
    pub device: *const c_char,
    /// Not 0: load Vulkan's validation layer; its messages about a picture give SELVEDGE_STATUS_RENDER.
    pub validation: u32,
    /// Most bytes of buffers and images on the device, beyond which a picture gives SELVEDGE_STATUS_RENDER; 0: as many
    /// as the device has left.
    pub limit_bytes: u64,
}

/// A picture to be drawn. Zeros and null are the defaults, but for width and height.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeView {
    /// sizeof(SelvedgeView)
    pub struct_size: usize,
    /// Pixels, 1 to 16384.
    pub width: u32,
    /// Pixels, 1 to 16384.
    pub height: u32,
    /// iso, front, right, back, left, top, bottom, or "AZIMUTH,ELEVATION" in degrees: the model fills the picture. Null:
    /// iso, or from `eye` where eye and target differ.
    pub standard: *const c_char,
    /// Position of the eye, millimetres.
    pub eye: [f64; 3],
    /// Point that the eye looks at.
    pub target: [f64; 3],
    /// Direction that points up in the picture; zeros: 0, 0, 1.
    pub up: [f64; 3],
    /// Vertical field of view from `eye`, degrees; 0: 35.
    pub fov: f64,
    /// Not 0: a parallel view from `eye`; the height of the picture in millimetres.
    pub ortho: f64,
    /// Images beside the colour: SELVEDGE_DEPTH | SELVEDGE_NORMAL and so on.
    pub outputs: u32,
    /// 1, 4 or 8 samples of each pixel's colour; 0: 1.
    pub samples: u32,
    /// shaded, clay, technical, normals, zebra, isophotes, mean-curvature or gaussian-curvature; null: shaded.
    pub style: *const c_char,
    /// A CSS colour, gradient or none; null: gradient.
    pub background: *const c_char,
    /// Lines along edges: all, sharp or none; null: none, and all where SELVEDGE_EDGE is among the outputs.
    pub edges: *const c_char,
    /// Width of lines in pixels; 0: 1 or more, and more in high pictures.
    pub line_width: f64,
    /// Direction towards a sun that casts shadows; zeros: a studio's light.
    pub sun: [f64; 3],
    /// Largest distance in pixels between a drawn boundary and the true one, at least 0.1; 0: 0.5.
    pub tolerance: f64,
    /// A calibrated camera in place of `standard` and `eye`, by OpenCV's conventions: fx, fy, cx, cy in pixels of this
    /// picture. The first pixel's centre is 0, 0. Zeros: the camera is not calibrated.
    pub intrinsics: [f64; 4],
    /// The calibrated camera's rotation from model to camera axes (x right, y down, z ahead), row by row; zeros: the
    /// identity.
    pub rotation: [f64; 9],
    /// The model's origin in the calibrated camera's axes, millimetres: a point X is seen at K (R X + t).
    pub translation: [f64; 3],
    /// Radius of ambient occlusion, millimetres. 0: a twenty-fifth of the model's diagonal with one sample, no ambient
    /// occlusion with several. Below 0: no ambient occlusion.
    pub ambient: f64,
    /// The largest mean curvature on the scale of the styles of curvature, 1/mm, whose square is that of Gaussian curvature;
    /// 0: a round number at which most of the model's curvatures are told apart.
    pub curvature_range: f64,
}

pub(crate) const NO_VIEW: SelvedgeView = SelvedgeView {
    struct_size: 0,
    width: 0,
    height: 0,
    standard: NO_TEXT,
    eye: [0.0; 3],
    target: [0.0; 3],
    up: [0.0; 3],
    fov: 0.0,
    ortho: 0.0,
    outputs: 0,
    samples: 0,
    style: NO_TEXT,
    background: NO_TEXT,
    edges: NO_TEXT,
    line_width: 0.0,
    sun: [0.0; 3],
    tolerance: 0.0,
    intrinsics: [0.0; 4],
    rotation: [0.0; 9],
    translation: [0.0; 3],
    ambient: 0.0,
    curvature_range: 0.0,
};

// SAFETY: each begins with its size and consists of numbers and pointers
unsafe impl Sized for SelvedgeRendererOptions {}
// SAFETY: as above
unsafe impl Sized for SelvedgeView {}

/// Opens a device; `options` may be null.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_renderer_new(
    options: *const SelvedgeRendererOptions,
    renderer: *mut *mut SelvedgeRenderer,
) -> SelvedgeStatus {
    border(|| {
        let usual = SelvedgeRendererOptions { struct_size: 0, device: NO_TEXT, validation: 0, limit_bytes: 0 };
        // SAFETY: as the caller promises
        let (place, options) = unsafe { (place(renderer)?, taken(options, usual)?) };
        // SAFETY: as the caller promises
        let device = unsafe { text("the device's name", options.device) }?.map(str::to_owned);
        let memory_budget = Some(options.limit_bytes).filter(|bytes| *bytes > 0);
        let validation = options.validation != 0;
        let worker = Worker::new(DeviceOptions { device, validation, memory_budget, ..Default::default() })?;
        *place = Box::into_raw(Box::new(SelvedgeRenderer { worker }));
        Ok(())
    })
}

/// Draws a picture and waits for it. A model that was drawn by the call before is not prepared again.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_render(
    renderer: *const SelvedgeRenderer,
    model: *const SelvedgeModel,
    view: *const SelvedgeView,
    picture: *mut *mut SelvedgePicture,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (place, renderer) = unsafe { (place(picture)?, handle("renderer", renderer)?) };
        if view.is_null() {
            return Err(argument("the view is a null pointer"));
        }
        // SAFETY: as the caller promises
        let (model, view) = unsafe { (handle("model", model)?, taken(view, NO_VIEW)?) };
        // SAFETY: the texts are the caller's
        let job = unsafe { view.job(model) }?;
        let asked = view.outputs;
        let ticket = renderer.worker.submit(job)?;
        let drawn = loop {
            if let Some(answer) = ticket.wait(Duration::MAX) {
                break answer?;
            }
        };
        *place = SelvedgePicture::boxed(drawn.picture, asked);
        Ok(())
    })
}

/// The word, or the default for null.
///
/// # Safety
/// As [`text`].
unsafe fn word<T: FromStr>(what: &str, from: *const c_char, usual: &str) -> Result<T, Failure>
where
    T::Err: ToString,
{
    // SAFETY: as the caller promises
    let word = unsafe { text(what, from) }?.unwrap_or(usual);
    word.parse().map_err(|error: T::Err| argument(error.to_string()))
}

/// The vector, or the default for zeros.
fn or(given: [f64; 3], usual: DVec3) -> DVec3 {
    if given == [0.0; 3] { usual } else { given.into() }
}

impl SelvedgeView {
    /// # Safety
    /// Its texts are null, or end with a zero.
    unsafe fn job(&self, model: &SelvedgeModel) -> Result<Job, Failure> {
        let images = images(self.outputs)?;
        // SAFETY: as the caller promises
        unsafe {
            Ok(Job {
                camera: self.camera_of(&model.loaded.model)?,
                scene: self.scene(images.contains(&Image::Edge), &model.loaded.model)?,
                frame: self.frame(&model.loaded.model)?,
                outputs: Image::outputs(images),
                backdrop: word::<Backdrop>("the background", self.background, "gradient")?,
                model: Arc::clone(&model.loaded.model),
                limits: Limits::default(),
            })
        }
    }

    /// How a model is uploaded. Where the view names no edges, lines are drawn if the image of edges is wanted.
    ///
    /// # Safety
    /// As [`SelvedgeView::job`].
    pub(crate) unsafe fn scene(&self, has_edge_image: bool, model: &Model) -> Result<SceneSettings, Failure> {
        let usual = if has_edge_image { "all" } else { "none" };
        // SAFETY: as the caller promises
        let which = unsafe { word::<EdgeChoice>("the choice of edges", self.edges, usual) }?;
        let drawn = (which != EdgeChoice::None)
            .then(|| EdgeSettings { which, ..lines(Some(self.line_width).filter(|w| *w != 0.0), self.height) });
        if let Some(drawn) = &drawn {
            drawn.check().map_err(|error| argument(error.to_string()))?;
        }
        let samples = self.samples.max(1).to_string();
        let samples: Samples =
            samples.parse().map_err(|error: selvedge::picture::UnknownSamples| argument(error.to_string()))?;
        let sun = DVec3::from(self.sun);
        if !sun.is_finite() {
            return Err(argument(format!("the direction towards the sun must be three finite numbers, not {sun}")));
        }
        let sun = Some(sun).filter(|sun| *sun != DVec3::ZERO);
        if !self.ambient.is_finite() {
            return Err(argument(format!("the radius of ambient occlusion must be finite, not {}", self.ambient)));
        }
        let smooth = smooth(None, samples);
        let ambient = match self.ambient {
            radius if radius < 0.0 => Some(Ambient::None),
            radius => Some(Ambient::Radius(radius)).filter(|_| radius != 0.0),
        };
        let ambient = Ambient::radius(ambient, samples, model);
        // SAFETY: as the caller promises
        let curvature = unsafe { self.style() }?.is_curvature();
        Ok(SceneSettings { edges: drawn, samples, smooth, ambient, sun, curvature, ..SceneSettings::default() })
    }

    /// # Safety
    /// As [`SelvedgeView::job`].
    unsafe fn style(&self) -> Result<Style, Failure> {
        // SAFETY: as the caller promises
        unsafe { word::<Style>("the style", self.style, "shaded") }
    }

    /// # Safety
    /// As [`SelvedgeView::job`].
    unsafe fn frame(&self, model: &Model) -> Result<FrameSettings, Failure> {
        // SAFETY: as the caller promises
        let style = unsafe { self.style() }?;
        let curvature_range = match self.curvature_range {
            0.0 if style.is_curvature() => model.curvature_range(),
            0.0 => 1.0,
            range if range.is_finite() && range > 0.0 => range,
            range => return Err(argument(format!("the largest curvature must be above 0, not {range}"))),
        };
        let tolerance_px = if self.tolerance == 0.0 { 0.5 } else { self.tolerance };
        if !(tolerance_px >= FrameSettings::LEAST_TOLERANCE_PX && tolerance_px.is_finite()) {
            return Err(argument(format!(
                "the tolerance must be at least {} pixels",
                FrameSettings::LEAST_TOLERANCE_PX
            )));
        }
        Ok(FrameSettings { tolerance_px, style, curvature_range, ..FrameSettings::default() })
    }

    /// The settings of a host's frame: over the host's picture, or over a colour.
    ///
    /// # Safety
    /// As [`SelvedgeView::job`].
    pub(crate) unsafe fn host_frame(&self, model: &Model) -> Result<FrameSettings, Failure> {
        // SAFETY: as the caller promises
        let (frame, background) = unsafe { (self.frame(model)?, text("the background", self.background)?) };
        let background = background.map(colour).transpose().map_err(argument)?;
        Ok(FrameSettings { background, ..frame })
    }

    /// # Safety
    /// As [`SelvedgeView::job`].
    pub(crate) unsafe fn camera_of(&self, model: &Model) -> Result<Camera, Failure> {
        // SAFETY: as the caller promises
        let viewpoint = unsafe { self.viewpoint() }?;
        Ok(viewpoint.camera(model, (self.width, self.height))?)
    }

    /// The calibrated camera, where there is one.
    fn pinhole(&self) -> Option<Pinhole> {
        let [fx, fy, cx, cy] = self.intrinsics;
        let turned = self.rotation != [0.0; 9];
        let rotation = if turned { DMat3::from_cols_array(&self.rotation).transpose() } else { DMat3::IDENTITY };
        (self.intrinsics != [0.0; 4]).then(|| Pinhole {
            intrinsics: DMat3::from_cols(DVec3::X * fx, DVec3::Y * fy, DVec3::new(cx, cy, 1.0)),
            rotation,
            translation: self.translation.into(),
            first_pixel: 0.0,
        })
    }

    /// # Safety
    /// As [`SelvedgeView::job`].
    unsafe fn viewpoint(&self) -> Result<Viewpoint, Failure> {
        if let Some(pinhole) = self.pinhole() {
            let alone = self.standard.is_null() && self.eye == self.target && self.fov == 0.0 && self.ortho == 0.0;
            return alone
                .then_some(Viewpoint::Pinhole(pinhole))
                .ok_or_else(|| argument("intrinsics exclude standard, eye, fov and ortho"));
        }
        if self.rotation != [0.0; 9] || self.translation != [0.0; 3] {
            return Err(argument("rotation and translation are those of a camera with intrinsics"));
        }
        if self.standard.is_null() && self.eye != self.target {
            let lens = match (self.fov, self.ortho) {
                (0.0, 0.0) => Lens::Fov(Camera::FOV_DEG),
                (fov, 0.0) => Lens::Fov(fov),
                (0.0, height) => Lens::Ortho(height),
                _ => return Err(argument("fov and ortho exclude each other")),
            };
            let (eye, target, up) = (self.eye.into(), self.target.into(), or(self.up, DVec3::Z));
            return Ok(Viewpoint::LookAt { eye, target, up, lens });
        }
        // SAFETY: as the caller promises
        let directions = unsafe { word::<Directions>("the view", self.standard, "iso") }?;
        match directions.0.as_slice() {
            [one] => Ok(Viewpoint::Standard(*one)),
            _ => Err(argument("one view a picture")),
        }
    }
}

/// Frees the device; null is allowed.
///
/// # Safety
/// This library made it, and no other call uses it at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_renderer_free(renderer: *mut SelvedgeRenderer) {
    // SAFETY: as the caller promises
    unsafe { free(renderer) }
}
