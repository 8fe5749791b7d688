//! Loading a model; loading what a near view needs of it; and loading it once more to be trimmed exactly where the trim
//! table has no room for a view.
//!
//! ```text
//!   Auto ──rows expected──▶ few ──▶ Table ──a view needs too many──▶ Exact
//!             └────────────▶ many ─▶ Exact
//!
//!   whole model ◀──from afar── record ──near──▶ what the view sees, cut out of it (scene/deep_zoom)
//! ```

use super::constants::draw_vertices;
use super::source::Source;
use super::{Loaded, RenderError, Renderer, Retired, TargetFormats, validate};
use crate::frame::Passes;
use crate::frame::capacities::{Capacities, Ranges};
use crate::frame::counts::Counts;
use crate::gpu::{Device, Uploads};
use crate::model::{Camera, Model};
use crate::picture::{SceneSettings, Smooth, TakenWay, TrimWay};
use crate::scene::{Cut, DeepZoomUpload, Joinable, SceneData, SceneRequest, Told};
use std::sync::Arc;

impl Renderer {
    /// Replaces the model: makes the pipelines that it needs; the next [`record`](Self::record)
    /// copies its data, or the next few where it is more than staging memory holds ([`FrameReport`](super::FrameReport)).
    /// Frames in flight keep the old one until their slots come round. The renderer keeps a copy of the
    /// model: [`upload_shared`](Self::upload_shared) makes none.
    ///
    /// # Errors
    /// [`RenderError::Model`] where [`Model::check`] fails, [`RenderError::TooMany`], [`RenderError::Gpu`]; the model before
    /// stays.
    pub fn upload(&mut self, model: &Model) -> Result<(), RenderError> {
        self.upload_with(model, SceneSettings::default())
    }

    /// As [`upload`](Self::upload), with settings that hold as long as the model.
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
    pub fn upload_with(&mut self, model: &Model, settings: SceneSettings) -> Result<(), RenderError> {
        self.upload_with_progress(model, settings, &|_| ())
    }

    /// As [`upload_with`](Self::upload_with). `progress` is called by several threads, in no order, with the number
    /// of faces of placed parts that have become ready since its last call; that is 0 before each part is put in
    /// place or searched for edges, and before pipelines are made. It may unwind to end the upload: the model before
    /// stays.
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
    pub fn upload_with_progress(
        &mut self,
        model: &Model,
        settings: SceneSettings,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<(), RenderError> {
        self.upload_shared(Arc::new(model.clone()), settings, progress)
    }

    /// As [`upload_with_progress`](Self::upload_with_progress), of a model that is not copied. Edits and changes of
    /// instances copy it first where somebody else shares it still.
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
    pub fn upload_shared(
        &mut self,
        model: Arc<Model>,
        settings: SceneSettings,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<(), RenderError> {
        self.upload_request(model, settings.into(), progress)
    }

    /// Loads what a view of this camera needs, as [`record`](Self::record) does by itself. From afar that is the model as
    /// it is. From so near that single precision would show, it is what the view sees, cut out of the model in double
    /// precision: it serves the views from near by, too. A host whose views come near calls this where it may take as long as
    /// an upload. With settings under which the model stays as a whole (`editable`, `thickness`, `highlight`) it does
    /// nothing.
    ///
    /// # Errors
    /// As [`upload`](Self::upload), and [`RenderError::Camera`]; what was loaded stays.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn prepare(&mut self, camera: &Camera) -> Result<(), RenderError> {
        camera.check()?;
        self.device.alive()?;
        let Some(source) = &mut self.source else { panic!("upload a model before recording") };
        let cut = match source.wanted(camera) {
            DeepZoomUpload::Same => return Ok(()),
            DeepZoomUpload::Whole => None,
            DeepZoomUpload::Cut(cut) => Some(cut),
        };
        match Loaded::new(&self.device, self.formats, source, (cut, source.request), &|_| ()) {
            Ok(loaded) => self.replace(loaded),
            Err(error) => {
                source.forget();
                return self.noting(Err(error));
            }
        }
        Ok(())
    }

    /// As [`upload_shared`](Self::upload_shared).
    pub(crate) fn upload_request(
        &mut self,
        model: Arc<Model>,
        request: SceneRequest,
        progress: Told<'_>,
    ) -> Result<(), RenderError> {
        model.check()?;
        self.upload_source(Source::new(model, request), progress)
    }

    /// As [`upload_shared`](Self::upload_shared), of what another renderer had.
    pub(crate) fn upload_source(&mut self, mut source: Source, progress: Told<'_>) -> Result<(), RenderError> {
        self.device.alive()?;
        let loaded = Loaded::new(&self.device, self.formats, &source, (None, source.request), progress);
        let loaded = self.noting(loaded)?;
        self.stale = false;
        source.upload = self.source.as_ref().map_or(0, |before| before.upload + 1);
        self.source = Some(source);
        self.replace(loaded);
        Ok(())
    }

    /// The same once more, trimmed exactly: the table has no room for a view of it.
    pub(super) fn load_exact(&mut self) -> Result<(), RenderError> {
        let (Some(source), Some(loaded)) = (&self.source, &mut self.loaded) else { return Ok(()) };
        loaded.may_be_exact = false;
        let loaded = (loaded.cut.take(), source.request.exact());
        let loaded = Loaded::new(&self.device, self.formats, source, loaded, &|_| ())?;
        self.replace(loaded);
        Ok(())
    }

    pub(super) fn replace(&mut self, loaded: Loaded) {
        if let Some(old) = self.loaded.replace(loaded) {
            self.retire(Retired::Loaded(Box::new(old)));
            self.slots.iter_mut().for_each(|slot| slot.capacities = None);
        }
    }
}

impl Loaded {
    /// Of a whole model, or of what was cut out of it for a view. Shadows are those of the whole model: for each cut,
    /// triangles are made of all spline faces that cast them.
    pub(super) fn new(
        device: &Device,
        formats: TargetFormats,
        source: &Source,
        (cut, request): (Option<Box<Cut>>, SceneRequest),
        progress: Told<'_>,
    ) -> Result<Self, RenderError> {
        validate::check_sun(*request)?;
        validate::check_ambient(*request)?;
        request.edges.map_or(Ok(()), |edges| edges.check())?;
        let whole = &*source.model;
        let data = |request| match &cut {
            None => SceneData::telling(whole, request, progress),
            Some(cut) => SceneData::cut_from(whole, cut, request),
        };
        let mut data_of = data(request)?;
        if request.smooth == Smooth::Trims {
            validate::check_smooth_trims(&data_of, request)?;
        }
        let may_change = request.trim == TrimWay::Auto && data_of.trim_way() == Some(TakenWay::Table);
        let too_many = Counts::of(&data_of)
            .check(Ranges::of(device).quads)
            .err()
            .filter(|too_many| may_change && too_many.is_of_table());
        if too_many.is_some() {
            data_of = data(request.exact())?;
        }
        let mut data = data_of;
        let is_cut = cut.is_some();
        data.has_numbers = formats.outputs.has_numbers();
        if let Some(edges) = request.edges {
            match &cut {
                None => data.find_edges(whole, edges, progress)?,
                Some(cut) => data.find_edges_of_cut(whole, cut, edges)?,
            }
            data.find_edges_of_operands(whole)?;
        }
        progress(0);
        let picking = match &cut {
            None => data.picking(whole, |_, face| face),
            Some(cut) => data.picking(&cut.model, |part, face| cut.face_of(part, face)),
        };
        data.show(&whole.instances, &source.shown);
        let joinable = if is_cut { None } else { Joinable::of(&data, whole, request) };
        let counts = Counts::of(&data);
        counts.check(Ranges::of(device).quads)?;
        progress(0);
        let passes = Passes::new(device, &data, formats.of_passes())?;
        let may_be_exact = may_change && too_many.is_none();
        Ok(Self {
            data,
            counts,
            capacities: Capacities::first(counts, draw_vertices(device)),
            passes,
            picking: Arc::new(picking),
            scene: None,
            waiting: Uploads::new(),
            stages: None,
            room: counts,
            joinable,
            gone: 0,
            is_cut,
            edits: Vec::new(),
            changes: Default::default(),
            moved: false,
            history: None,
            may_be_exact,
            cut: cut.filter(|_| may_be_exact),
        })
    }
}
