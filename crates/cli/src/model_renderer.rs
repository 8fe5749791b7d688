//! A renderer with one model; progress and warnings go to standard error.

use crate::args::{EdgeArgs, FrameArgs, LookArgs, ReadArgs};
use crate::progress::{advancing, during};
use crate::reading::{failure, named};
use crate::{camera, device, output};
use anyhow::{Error, Result, bail};
use glam::DVec3;
use selvedge::headless::{HeadlessOptions, HeadlessRenderer, PictureView};
use selvedge::model::{Camera, Colour, LoopAt, Model, TrimLoop};
use selvedge::picture::{EdgeSettings, FrameSettings, FrameStats, Highlight, Outputs, Picture, SceneSettings, Style};
use selvedge_io::import::Import;
use selvedge_jobs::{Ambient, Limits, Step, Work, guarded};
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// The direction towards the sun, if there is a sun.
pub fn sun(args: &FrameArgs, import: &Import) -> Option<DVec3> {
    args.sun.or(import.picture.sun)
}

/// Whether any pixel shows the model, by the image of faces.
pub fn shows(picture: &Picture) -> bool {
    picture.face.iter().any(|face| *face != 0)
}

/// A renderer that holds one model.
pub struct ModelRenderer {
    renderer: HeadlessRenderer,
    settings: FrameSettings,
    first_frame: Option<FirstFrame>,
}

/// The cost of the first frame: drivers compile for it alone.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FirstFrame {
    /// Sum of the driver's times for each pipeline of the scene. Pipelines are made in parallel, so the wall time is
    /// less.
    pub pipelines_ms: f64,
    /// From the call to the picture in host memory, including shaders that the driver compiles when they first run.
    pub wall_ms: f64,
}

/// A frame's statistics, the cost of the renderer's first frame, and the objects of the scene.
#[derive(Debug, Serialize)]
pub struct Measured {
    #[serde(flatten)]
    pub frame: FrameStats,
    pub first_frame: Option<FirstFrame>,
    pub objects: Vec<Object>,
}

/// A buffer, an image or a pipeline.
#[derive(Debug, Serialize)]
pub struct Object {
    pub name: String,
    /// Bytes of device memory; 0 for a pipeline.
    pub bytes: u64,
}

/// Opens the device of the arguments, whose objects have so many bytes at most.
pub fn opened(args: &FrameArgs, most_memory: Option<u64>) -> Result<HeadlessRenderer> {
    during("opening the device", || device(args, most_memory))
}

/// The same without a progress message, for use beside other work.
pub fn device(args: &FrameArgs, most_memory: Option<u64>) -> Result<HeadlessRenderer> {
    let options = device::options(args.device.as_deref(), args.validation);
    Ok(HeadlessRenderer::new(&HeadlessOptions { memory_budget: most_memory, ..options })?)
}

impl ModelRenderer {
    /// Opens the device and uploads the model for pictures with these images, with lines along edges if `lines` is set.
    pub fn with_lines(
        args: &FrameArgs,
        import: &Import,
        lines: Option<EdgeSettings>,
        outputs: Outputs,
    ) -> Result<Self> {
        let scene = SceneSettings { edges: lines, ..SceneSettings::default() };
        let mut on = opened(args, None)?;
        on.expect(outputs);
        Self::with(on, args, import, scene, (Arc::new(import.model.clone()), &unlimited()))
    }

    /// The same with smooth edges, on a device that is open.
    pub fn smooth(on: HeadlessRenderer, args: &FrameArgs, import: &Import, edges: &EdgeArgs) -> Result<Self> {
        let scene = SceneSettings { samples: edges.samples, smooth: edges.smooth(), ..SceneSettings::default() };
        Self::with(on, args, import, scene, (Arc::new(import.model.clone()), &unlimited()))
    }

    /// The same for a model that the renderer shares, with lines along edges, within limits: the import's own model is
    /// not used.
    pub fn of_one(
        on: HeadlessRenderer,
        args: &FrameArgs,
        import: &Import,
        (model, step): (&Arc<Model>, &Step),
        (edges, look, lines): (&EdgeArgs, &LookArgs, Option<EdgeSettings>),
    ) -> Result<Self> {
        let scene = SceneSettings {
            samples: edges.samples,
            smooth: edges.smooth(),
            ambient: during("measuring the model", || Ambient::radius(look.ao, edges.samples, model)),
            curvature: look.style.is_curvature(),
            edges: lines,
            ..SceneSettings::default()
        };
        Self::with(on, args, import, scene, (Arc::clone(model), step))
    }

    /// The same with a model whose loops may be edited.
    pub fn editable(args: &FrameArgs, import: &Import) -> Result<Self> {
        let scene = SceneSettings { editable: true, ..SceneSettings::default() };
        Self::with(opened(args, None)?, args, import, scene, (Arc::new(import.model.clone()), &unlimited()))
    }

    fn with(
        mut renderer: HeadlessRenderer,
        args: &FrameArgs,
        import: &Import,
        scene: SceneSettings,
        (model, step): (Arc<Model>, &Step),
    ) -> Result<Self> {
        let highlight = args.highlight.then(Highlight::default);
        let sun = sun(args, import);
        let (trim, solids) = (args.trim, args.solids);
        let solid_budget = args.solid_budget.map(|mebibytes| (mebibytes * f64::from(1 << 20)) as u64);
        let scene = SceneSettings { trim, solids, highlight, sun, solid_budget, ..scene };
        let faces = model.face_count();
        let uploaded = advancing("preparing faces", faces, |told| {
            let told = |count: usize| {
                step.check();
                told(count);
            };
            guarded(|| Ok(renderer.upload_shared(model, scene, &told)?))
        });
        uploaded.map_err(|error| failure(error, "preparing the model"))?;
        let mut settings =
            FrameSettings { tolerance_px: args.tolerance, levels: args.factors.0, ..FrameSettings::default() };
        settings.background = import.picture.background.or(settings.background);
        Ok(Self { renderer, settings, first_frame: None })
    }

    /// Sets background, style and the end of the scale of curvature for the frames from now on.
    pub fn look(&mut self, background: Colour, style: Style, curvature_range: f64) {
        self.settings.background = Some(background);
        self.settings.style = style;
        self.settings.curvature_range = curvature_range;
    }

    /// Ends a picture between two of its frames if a limit of the step is exceeded; until the step ends.
    pub fn watch(&mut self, step: &Arc<Step>) {
        let step = Arc::downgrade(step);
        self.renderer.set_watch(Some(Arc::new(move || step.upgrade().iter().for_each(|step| step.check()))));
    }

    /// One frame.
    pub fn render(&mut self, camera: &Camera, outputs: Outputs) -> Result<Picture> {
        let start = Instant::now();
        let picture = during("drawing", || bounded(|| self.renderer.render(camera, &self.settings, outputs)))?;
        self.first_frame.get_or_insert_with(|| FirstFrame {
            pipelines_ms: self.renderer.pipeline_time().as_secs_f64() * 1e3,
            wall_ms: start.elapsed().as_secs_f64() * 1e3,
        });
        output::clamps(&picture.stats);
        Ok(picture)
    }

    /// A frame for each camera, several in flight; `take` gets each picture, and its error ends the sequence.
    pub fn render_sequence(
        &mut self,
        cameras: &[Camera],
        outputs: Outputs,
        mut take: impl FnMut(usize, &PictureView<'_>) -> Result<()>,
    ) -> Result<()> {
        bounded(|| self.renderer.render_sequence(cameras, &self.settings, outputs, |nth, picture| take(nth, picture)))
    }

    /// The cost of the first frame, once it is drawn.
    pub fn first_frame(&self) -> Option<FirstFrame> {
        self.first_frame
    }

    /// The statistics of a picture, measured again by a frame of all passes for which the driver compiles nothing.
    pub fn measured(&mut self, camera: &Camera, outputs: Outputs, first: &FrameStats) -> Result<Measured> {
        let settings = FrameSettings { all_passes: true, ..self.settings };
        let draw = || bounded(|| self.renderer.render(camera, &settings, outputs));
        let again = during("drawing again, to measure", draw)?.stats;
        let mut frame = again;
        frame.retries = first.retries;
        let objects = self.renderer.object_bytes().into_iter().map(|(name, bytes)| Object { name, bytes }).collect();
        Ok(Measured { frame, first_frame: self.first_frame, objects })
    }

    /// Whether any pixel of the picture shows the model.
    pub fn shows(&mut self, camera: &Camera, picture: &Picture) -> Result<bool> {
        if !is_of_one_colour(&picture.colour) {
            return Ok(true);
        }
        let faces = Outputs { face: true, ..Outputs::default() };
        Ok(shows(&bounded(|| self.renderer.render(camera, &self.settings, faces))?))
    }

    /// Refuses a model that is invisible in a picture of all of it. Otherwise the camera looks past the model, which is
    /// a warning, or with `--strict` an error. For pictures that show nothing.
    pub fn blank(&mut self, path: &Path, model: &Model, size: (u32, u32), read: &ReadArgs) -> Result<()> {
        let camera = camera::whole(camera::bounds(model), size);
        let picture = self.render(&camera, Outputs { face: true, ..Outputs::default() })?;
        if !shows(&picture) {
            let why = match picture.stats.clamps {
                0 => "its solids and what cuts it open leave no surface, or none at the centre of any pixel".to_owned(),
                clamps => format!("{clamps} parts of the picture were not followed to their ends"),
            };
            bail!("{}: nothing is seen with all of it in the picture: {why}", named(path));
        }
        let told = format!("{}: no pixel shows anything of it: the camera looks past it", named(path));
        if read.strict {
            bail!("--strict: {told}");
        }
        tracing::warn!("{told}");
        Ok(())
    }

    /// Whether every frame from now on records all passes, or a still view may reuse those of the frame before.
    pub fn record_all(&mut self, all_passes: bool) {
        self.settings.all_passes = all_passes;
    }

    /// Replaces a loop; the next frame shows it.
    pub fn edit(&mut self, at: LoopAt, new: &TrimLoop) -> Result<()> {
        Ok(self.renderer.edit_loop(at, new)?)
    }

    /// Prints the validation layer's messages on standard error; true when there were any.
    pub fn complaints(&self) -> bool {
        tell(&self.renderer.messages())
    }

    /// The device, for another model.
    pub fn into_headless(self) -> HeadlessRenderer {
        self.renderer
    }

    /// Frees the device; prints all messages of the layer, those about leaked objects included.
    pub fn close(self) -> bool {
        close(self.renderer)
    }
}

/// Draws what a limit may end.
fn bounded<T, E: Into<Error>>(draw: impl FnOnce() -> Result<T, E>) -> Result<T> {
    guarded(|| Ok(draw())).map_err(|error| failure(error, "drawing"))?.map_err(Into::into)
}

/// Work on a model that is bounded where it is read.
fn unlimited() -> Step {
    Limits::default().begin(Work::Preparing)
}

/// The background has one colour: a picture may be of nothing else.
pub fn is_of_one_colour(pixels: &[[u8; 4]]) -> bool {
    pixels.windows(2).all(|pair| pair[0] == pair[1])
}

/// Frees a device; true when the validation layer had messages, which are printed on standard error.
pub fn close(renderer: HeadlessRenderer) -> bool {
    tell(&renderer.shutdown())
}

fn tell(messages: &[String]) -> bool {
    messages.iter().for_each(|message| tracing::error!("validation: {message}"));
    !messages.is_empty()
}
