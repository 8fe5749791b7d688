//! Loading a model, and loading it once more to be trimmed exactly where the trim table has no room for a view.
//!
//! ```text
//!   Auto ──rows expected──▶ few ──▶ Table, with the model as a fallback ──a view needs too many──▶ Exact
//!             └────────────▶ many ─▶ Exact
//! ```

use super::constants::draw_vertices;
use super::{Loaded, RenderError, Renderer, Retired, TargetFormats, validate};
use crate::frame::Passes;
use crate::frame::capacities::Capacities;
use crate::frame::counts::Counts;
use crate::frame::shading::resolve;
use crate::model::{LoopAt, Model, TrimLoop};
use crate::picture::{EdgeSettings, SceneSettings, Smooth, TakenWay, TrimWay};
use crate::scene::{Cut, SceneData, SceneRequest, Told, UndrawnEdges, UndrawnSolid};

/// The source of a scene: a model, or the part cut out of it for a view.
#[derive(Clone, Copy)]
struct Source<'a> {
    whole: &'a Model,
    cut: Option<&'a Cut>,
    progress: Told<'a>,
}

impl Source<'_> {
    fn data(self, settings: SceneRequest) -> Result<SceneData, UndrawnSolid> {
        match self.cut {
            None => SceneData::telling(self.whole, settings, self.progress),
            Some(cut) => SceneData::cut_from(self.whole, cut, settings),
        }
    }

    fn find_edges(self, data: &mut SceneData, settings: EdgeSettings) -> Result<(), UndrawnEdges> {
        match self.cut {
            None => data.find_edges(self.whole, settings),
            Some(cut) => data.find_edges_of_cut(self.whole, cut, settings),
        }
    }
}

/// A copy of the model, loaded once more where the table does not suffice for a view.
pub(super) struct Fallback {
    whole: Model,
    cut: Option<Cut>,
    settings: SceneRequest,
}

impl Fallback {
    fn new(of: Source<'_>, settings: SceneRequest) -> Self {
        // beside a cut, shadows and edges alone need the whole model
        let whole = if of.cut.is_none() || settings.sun.is_some() || settings.edges.is_some() {
            of.whole.clone()
        } else {
            Model::default()
        };
        Self { whole, cut: of.cut.cloned(), settings }
    }

    /// The loop is another one now.
    pub(super) fn edit(&mut self, at: LoopAt, new: &TrimLoop) {
        let model = self.cut.as_mut().map_or(&mut self.whole, |cut| &mut cut.model);
        model.parts[at.part].faces[at.face].loops[at.trim_loop] = new.clone();
    }
}

impl Renderer {
    /// Replaces the model: makes the pipelines that it needs; the next [`record`](Self::record)
    /// copies its data. Frames in flight keep the old one until their slots come round.
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

    /// As [`upload_with`](Self::upload_with). `progress` is called by several threads, in no order, with the number of faces
    /// of placed parts that have become ready since its last call.
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
    pub fn upload_with_progress(
        &mut self,
        model: &Model,
        settings: SceneSettings,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<(), RenderError> {
        self.upload_request(model, settings.into(), progress)
    }

    /// As [`upload_with`](Self::upload_with), of what [`DeepZoom`](super::DeepZoom) cut out of a model for a view: shadows
    /// are those of the whole model, of which all spline faces that cast them are made triangles for each cut.
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
    pub fn upload_cut(&mut self, whole: &Model, cut: &Cut, settings: SceneSettings) -> Result<(), RenderError> {
        self.upload_cut_request(whole, cut, settings.into())
    }

    /// The same model once more, trimmed exactly: the table has no room for a view of it.
    pub(super) fn load_exact(&mut self) -> Result<(), RenderError> {
        let Some(fallback) = self.loaded.as_mut().and_then(|loaded| loaded.fallback.take()) else { return Ok(()) };
        let Fallback { whole, cut, settings } = &*fallback;
        let of = Source { whole, cut: cut.as_ref(), progress: &|_| () };
        self.load(of, settings.exact())
    }

    /// As [`upload_with_progress`](Self::upload_with_progress).
    pub(crate) fn upload_request(
        &mut self,
        model: &Model,
        request: SceneRequest,
        progress: Told<'_>,
    ) -> Result<(), RenderError> {
        self.load(Source { whole: model, cut: None, progress }, request)
    }

    /// As [`upload_cut`](Self::upload_cut).
    pub(crate) fn upload_cut_request(
        &mut self,
        whole: &Model,
        cut: &Cut,
        request: SceneRequest,
    ) -> Result<(), RenderError> {
        self.load(Source { whole, cut: Some(cut), progress: &|_| () }, request)
    }

    fn load(&mut self, of: Source<'_>, settings: SceneRequest) -> Result<(), RenderError> {
        validate::check_sun(*settings)?;
        if of.cut.is_none() {
            of.whole.check()?; // a cut is of a model that was
        }
        settings.edges.map_or(Ok(()), |edges| edges.check())?;
        let mut data = of.data(settings)?;
        if settings.smooth == Smooth::Trims {
            validate::check_smooth_trims(&data, settings)?;
        }
        let may_change = settings.trim == TrimWay::Auto && data.trim_way() == Some(TakenWay::Table);
        let too_many = Counts::of(&data).check().err().filter(|too_many| may_change && too_many.is_of_table());
        if too_many.is_some() {
            data = of.data(settings.exact())?;
        }
        data.has_numbers = self.formats.numbers;
        if let Some(edges) = settings.edges {
            of.find_edges(&mut data, edges)?;
        }
        let fallback = (may_change && too_many.is_none()).then(|| Box::new(Fallback::new(of, settings)));
        let counts = Counts::of(&data);
        counts.check()?;
        let TargetFormats { colour, depth, aovs, numbers } = self.formats;
        let formats = resolve::Formats { colour, depth, aovs, numbers };
        let passes = Passes::new(&self.device, &data, formats)?;
        let loaded = Loaded {
            data,
            counts,
            capacities: Capacities::first(counts, draw_vertices(&self.device)),
            passes,
            scene: None,
            stages: None,
            edits: Vec::new(),
            history: None,
            fallback,
        };
        if let Some(old) = self.loaded.replace(loaded) {
            self.retire(Retired::Loaded(Box::new(old)));
            self.slots.iter_mut().for_each(|slot| slot.capacities = None);
        }
        Ok(())
    }
}
