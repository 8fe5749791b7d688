//! A model read and a renderer opened, with everything worth knowing told on standard error.

use crate::args::{EdgeArgs, FrameArgs, SubdivideArgs};
use crate::progress::{during, importing};
use crate::{openscad, output};
use anyhow::Result;
use glam::DVec3;
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, LoopAt, TrimLoop};
use selvedge::picture::{FrameSettings, Highlight, Outputs, Picture, SceneSettings};
use selvedge_io::import::{self, Facets, Import};
use std::path::Path;
use std::time::Instant;

/// Reads a file, its polygons as `subdivide` says, and tells its warnings.
pub fn open(path: &Path, subdivide: &SubdivideArgs) -> Result<Import> {
    let start = Instant::now();
    if let Some(smooth) = subdivide.subdivide {
        let import = import::open_subdivided(path, smooth.scheme(), subdivide.within)?;
        tracing::info!("read {} in {:.1?}", path.display(), start.elapsed());
        let (faces, off) = (import.report.faces, import.report.made);
        tracing::info!("{faces} faces within {off:.2e} mm of the limit surface");
        return Ok(import);
    }
    let facets = if subdivide.as_openscad { Facets::AsWritten } else { Facets::Round };
    let import = if openscad::is_program(path) {
        during("running openscad", || openscad::open(path, facets))?
    } else {
        importing(&path.display().to_string(), |tell| {
            import::open_with(path, &import::Options { progress: Some(tell), facets })
        })?
    };
    tracing::info!("read {} in {:.1?}", path.display(), start.elapsed());
    output::warnings(&import);
    Ok(import)
}

/// The direction towards the sun, where one is asked for.
pub fn sun(args: &FrameArgs, import: &Import) -> Option<DVec3> {
    args.sun.or(import.picture.sun)
}

/// A renderer that holds one model.
pub struct Session {
    renderer: HeadlessRenderer,
    settings: FrameSettings,
}

/// Opens the device that is asked for.
pub fn opened(args: &FrameArgs) -> Result<HeadlessRenderer> {
    during("opening the device", || device(args))
}

/// The same without a word, beside something else.
pub fn device(args: &FrameArgs) -> Result<HeadlessRenderer> {
    Ok(HeadlessRenderer::new(&HeadlessOptions { device: args.device.clone(), validation: args.validation })?)
}

impl Session {
    /// Opens the device and hands it the model.
    pub fn new(args: &FrameArgs, import: &Import) -> Result<Self> {
        Self::with(opened(args)?, args, import, SceneSettings::default())
    }

    /// The same with smooth edges, on a device that is open.
    pub fn smooth(on: HeadlessRenderer, args: &FrameArgs, import: &Import, edges: &EdgeArgs) -> Result<Self> {
        let EdgeArgs { samples, smooth_trims } = *edges;
        Self::with(on, args, import, SceneSettings { samples, smooth_trims, ..SceneSettings::default() })
    }

    /// The same with a model whose loops may be edited.
    pub fn editable(args: &FrameArgs, import: &Import) -> Result<Self> {
        Self::with(opened(args)?, args, import, SceneSettings { editable: true, ..SceneSettings::default() })
    }

    fn with(mut renderer: HeadlessRenderer, args: &FrameArgs, import: &Import, scene: SceneSettings) -> Result<Self> {
        let highlight = args.highlight.then(Highlight::default);
        let sun = sun(args, import);
        let (trim, solids) = (args.trim, args.solids);
        let solid_budget = args.solid_budget.map(|mebibytes| (mebibytes * f64::from(1 << 20)) as u64);
        let scene = SceneSettings { trim, solids, highlight, sun, solid_budget, ..scene };
        during("uploading the model", || renderer.upload_with(&import.model, scene))?;
        let mut settings =
            FrameSettings { tolerance_px: args.tolerance, levels: args.factors.0, ..FrameSettings::default() };
        settings.background = import.picture.background.or(settings.background);
        Ok(Self { renderer, settings })
    }

    /// One frame.
    pub fn render(&mut self, camera: &Camera, outputs: Outputs) -> Result<Picture> {
        let picture = during("drawing", || self.renderer.render(camera, &self.settings, outputs))?;
        output::clamps(&picture.stats);
        Ok(picture)
    }

    /// From now on every pass is recorded in every frame, or what a standing view keeps is not.
    pub fn record_all(&mut self, all_passes: bool) {
        self.settings.all_passes = all_passes;
    }

    /// Replaces a loop; the next frame shows it.
    pub fn edit(&mut self, at: LoopAt, new: &TrimLoop) -> Result<()> {
        Ok(self.renderer.edit_loop(at, new)?)
    }

    /// What the validation layer said, told on standard error.
    ///
    /// True when it said anything.
    pub fn complaints(&self) -> bool {
        Self::tell(&self.renderer.messages())
    }

    /// Frees the device; the same of all that the layer said, of what was left over, too.
    pub fn close(self) -> bool {
        Self::tell(&self.renderer.shutdown())
    }

    fn tell(messages: &[String]) -> bool {
        messages.iter().for_each(|message| tracing::error!("validation: {message}"));
        !messages.is_empty()
    }
}
