//! Models that are added to a living scene, and removed.
//!
//! ```text
//!   add(model) ─▶ Model: its parts, instances and solids behind the others ─▶ ModelId
//!        │            arrays of the model alone, behind those of the scene (scene/join.rs) ──▶ copied by the next frame
//!        ╰─ a model that wants other pipelines, or of which more follows than its own arrays ──▶ all is loaded anew
//!
//!   remove(id) ─▶ nobody sees its instances; their numbers stay empty, for the next model with as many
//!        ╰─ once more is gone than is left ──▶ what is left is loaded anew, with the next frame
//! ```
//!
//! What is loaded anew after removals is less than what was removed: a long life costs what its changes cost.

use super::constants::draw_vertices;
use super::source::Source;
use super::{Loaded, RenderError, Renderer};
use crate::frame::capacities::Ranges;
use crate::frame::counts::Counts;
use crate::gpu::Device;
use crate::model::{Bounds, Instance, Model, Part};
use crate::scene::{EditTarget, FirstNumbers, Shown};
use glam::DAffine3;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Faces and triangles below which it does not matter how many are gone.
const LEAST_GONE: u64 = 256;

/// A model that was added to a scene: see [`Renderer::add`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ModelId {
    scene: u64,
    number: u64,
}

/// Why no model was removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RemoveError {
    /// It was removed before.
    #[error("the model was removed before")]
    Removed,
    /// It was added to another renderer, or before the last upload.
    #[error("the model was added to another scene: to another renderer, or before the last upload")]
    OtherScene,
}

/// The numbers of one added model, in the model of the whole scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) parts: Range<usize>,
    pub(super) instances: Range<usize>,
    solids: Range<usize>,
    /// Faces and triangles of its instances.
    weight: u64,
}

/// The models that were added to a scene.
#[derive(Clone, Debug)]
pub(super) struct Models {
    /// Differs between all scenes.
    scene: u64,
    next: u64,
    living: HashMap<u64, Span>,
    /// Numbers of removed models.
    free: Vec<Span>,
    /// Of all that is not removed.
    weight: u64,
    /// Around everything since all was counted.
    pub(super) bounds: Bounds,
}

impl Models {
    pub(super) fn new(model: &Model) -> Self {
        static SCENES: AtomicU64 = AtomicU64::new(0);
        Self {
            scene: SCENES.fetch_add(1, Ordering::Relaxed),
            next: 0,
            living: HashMap::new(),
            free: Vec::new(),
            weight: weight(model),
            bounds: model.control_bounds(),
        }
    }

    fn span(&self, id: ModelId) -> Result<&Span, RemoveError> {
        let is_own = id.scene == self.scene && id.number < self.next;
        let living = is_own.then(|| self.living.get(&id.number)).ok_or(RemoveError::OtherScene)?;
        living.ok_or(RemoveError::Removed)
    }

    /// The instance is one of a removed model.
    pub(super) fn is_free(&self, instance: usize) -> bool {
        self.free.iter().any(|span| span.instances.contains(&instance))
    }

    /// Numbers for a model in `whole`: those of a removed one with as many parts and instances, or the next ones.
    fn take(&mut self, whole: &Model, model: &Model) -> Span {
        let behind = |first: usize, count: usize| first..first + count;
        let solids = behind(whole.solids.len(), model.solids.len());
        let counts = (model.parts.len(), model.instances.len());
        let as_many = self.free.iter().position(|span| (span.parts.len(), span.instances.len()) == counts);
        let (parts, instances) = match as_many.map(|nth| self.free.swap_remove(nth)) {
            Some(span) => (span.parts, span.instances),
            None => (behind(whole.parts.len(), counts.0), behind(whole.instances.len(), counts.1)),
        };
        Span { parts, instances, solids, weight: weight(model) }
    }
}

/// Faces and triangles of all instances: what a scene costs, about.
fn weight(model: &Model) -> u64 {
    let of = |part: &Part| part.faces.len() + part.meshes.iter().map(|mesh| mesh.triangles().len()).sum::<usize>();
    let parts: Vec<usize> = model.parts.iter().map(of).collect();
    model.instances.iter().map(|instance| 1 + parts[instance.part] as u64).sum()
}

impl Source {
    /// Puts a model that has been checked behind the others.
    fn join(&mut self, model: &Model) -> (ModelId, Span) {
        let whole = Arc::make_mut(&mut self.model);
        let span = self.models.take(whole, model);
        let (parts, instances) = (span.parts.clone(), span.instances.clone());
        whole.parts.resize_with(whole.parts.len().max(parts.end), Part::default);
        whole.parts[parts.clone()].clone_from_slice(&model.parts);
        whole.instances.resize(whole.instances.len().max(instances.end), nothing(0));
        for (placed, new) in whole.instances[instances.clone()].iter_mut().zip(&model.instances) {
            *placed = Instance { part: parts.start + new.part, ..new.clone() };
        }
        whole.solids.extend(model.solids.iter().cloned());
        self.shown.resize(whole.instances.len(), Shown::default());
        self.shown[instances].fill(Shown::default());
        self.deep_zoom.change(whole, parts);
        let models = &mut self.models;
        models.weight += span.weight;
        models.bounds = models.bounds.union(model.control_bounds());
        let id = ModelId { scene: models.scene, number: models.next };
        models.next += 1;
        models.living.insert(id.number, span.clone());
        (id, span)
    }

    /// Takes a model away. The numbers of others stay.
    fn leave(&mut self, id: ModelId) -> Result<Span, RemoveError> {
        let span = self.models.span(id)?.clone();
        let (models, whole) = (&mut self.models, Arc::make_mut(&mut self.model));
        models.living.remove(&id.number);
        models.weight -= span.weight;
        whole.solids.drain(span.solids.clone());
        for other in models.living.values_mut().filter(|other| other.solids.start >= span.solids.end) {
            let by = span.solids.len();
            other.solids = other.solids.start - by..other.solids.end - by;
        }
        whole.parts[span.parts.clone()].fill(Part::default());
        whole.instances[span.instances.clone()].iter_mut().for_each(|placed| *placed = nothing(placed.part));
        self.shown[span.instances.clone()].fill(Shown { visible: false, ..Shown::default() });
        models.free.push(span.clone());
        // those at the end are no numbers any more
        let last = |span: &Span, whole: &Model| {
            (span.parts.end, span.instances.end) == (whole.parts.len(), whole.instances.len())
        };
        while let Some(nth) = models.free.iter().position(|span| last(span, whole)) {
            let span = models.free.swap_remove(nth);
            whole.parts.truncate(span.parts.start);
            whole.instances.truncate(span.instances.start);
        }
        self.shown.truncate(whole.instances.len());
        self.deep_zoom.change(whole, span.parts.clone());
        // what was picked may be of it
        self.upload += 1;
        Ok(span)
    }
}

/// An instance of a removed model.
fn nothing(part: usize) -> Instance {
    Instance { part, transform: DAffine3::IDENTITY, colour: None, name: String::new() }
}

/// Models come and go while the scene lives.
impl Renderer {
    /// Adds a model to the scene; the next frame recorded shows it. Frames in flight draw the scene as it was; nothing
    /// waits. [`model`](Self::model) then has its parts, instances and Boolean solids, too: [`instances_of`](Self::instances_of)
    /// says where, for what changes one instance. The numbers of all others stay.
    ///
    /// It costs what the model costs: its arrays are made, and copied by the next frame
    /// ([`FrameStats::edit_bytes`](crate::picture::FrameStats::edit_bytes)). A buffer without room gets a successor
    /// twice as large, filled on the GPU; pipelines stay. In two cases the whole scene is loaded anew, as by
    /// [`upload`](Self::upload):
    ///
    /// * The scene has or gets Boolean solids, lines along edges, a sun, something that is seen through, loops that may
    ///   be edited, a [`thickness`](crate::picture::SceneSettings::thickness) or a
    ///   [`highlight`](crate::picture::SceneSettings::highlight).
    /// * The model is the first one that has meshes, trims, rational patches or the like.
    ///
    /// The picture is that of the whole, uploaded. What the upload chose for the model as it was stays: how faces are
    /// trimmed, and how finely trimmed faces are cut for a model of that size.
    ///
    /// The renderer's copy of the model grows; where somebody else shares it ([`model`](Self::model)), it is copied first.
    ///
    /// # Errors
    /// As [`upload`](Self::upload), and [`RenderError::AddedVolume`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded: an empty one does.
    pub fn add(&mut self, model: &Model) -> Result<ModelId, RenderError> {
        self.device.alive()?;
        model.check()?;
        if model.trim.is_some() {
            return Err(RenderError::AddedVolume);
        }
        let (Some(source), Some(loaded)) = (&mut self.source, &mut self.loaded) else {
            panic!("upload a model before adding to it")
        };
        let (id, span) = source.join(model);
        if loaded.is_cut {
            source.forget();
        } else if !self.stale && !loaded.join(&self.device, model, (&span, source.models.bounds)) {
            let request = (None, source.request);
            match Loaded::new(&self.device, self.formats, source, request, &|_| ()) {
                Ok(loaded) => self.replace(loaded),
                Err(error) => {
                    source.leave(id).expect("it was added above");
                    return self.noting(Err(error));
                }
            }
        }
        self.source.iter_mut().for_each(Source::moved);
        Ok(id)
    }

    /// Removes a model that was added; the next frame recorded does not show it. Frames in flight draw it still; nothing
    /// waits. The numbers of all others stay: its parts become empty in [`model`](Self::model), its instances are theirs,
    /// and the next added model with as many of both gets them.
    ///
    /// It costs what its instances cost. The next frame loads what is left anew where rays are followed through the
    /// model, where it has Boolean solids, and where the scene has a sun. It also does so once more has been removed
    /// than is left, which frees memory. Such a frame takes as long as an upload.
    ///
    /// # Errors
    /// [`RemoveError`]; the scene is as it was.
    pub fn remove(&mut self, id: ModelId) -> Result<(), RemoveError> {
        let (Some(source), Some(loaded)) = (&mut self.source, &mut self.loaded) else {
            return Err(RemoveError::OtherScene);
        };
        let mut span = source.leave(id)?;
        source.moved();
        if loaded.is_cut {
            source.forget();
            return Ok(());
        }
        loaded.gone += span.weight;
        loaded.moved = true;
        let alone = span.solids.is_empty() && span.instances.all(|nth| loaded.data.leave(nth).is_some());
        self.stale |= !alone || loaded.gone > source.models.weight.max(LEAST_GONE);
        Ok(())
    }

    /// Which of [`Model::instances`] of [`model`](Self::model) are those of an added model, in its order.
    ///
    /// # Errors
    /// [`RemoveError`].
    pub fn instances_of(&self, id: ModelId) -> Result<Range<usize>, RemoveError> {
        let source = self.source.as_ref().ok_or(RemoveError::OtherScene)?;
        Ok(source.models.span(id)?.instances.clone())
    }
}

impl Loaded {
    /// Takes a model in, in a scene of these bounds; `false` if the scene has to be loaded anew with it.
    fn join(&mut self, device: &Device, model: &Model, (span, bounds): (&Span, Bounds)) -> bool {
        let Some(joinable) = &mut self.joinable else { return false };
        let Some(arrays) = joinable.arrays_of(model, bounds.diagonal()) else { return false };
        let counts = self.counts.and(Counts::of(&arrays));
        let range = Ranges::of(device).quads;
        if counts.check(range).is_err() {
            return false;
        }
        let first = FirstNumbers { part: span.parts.start, instance: span.instances.start };
        let Some(joined) = self.data.join((model, arrays), joinable, first, self.scene.is_some()) else { return false };
        Arc::make_mut(&mut self.picking).join(joined.picking);
        for write in joined.writes {
            match write.to {
                // changes of it take its place
                EditTarget::Instances => drop(self.changes.insert(write.offset, write)),
                _ => self.edits.push(write),
            }
        }
        if let Some(meshes) = self.scene.as_mut().and_then(|scene| scene.meshes.as_mut()) {
            meshes.draws.extend(joined.draws);
            meshes.outward = meshes.draws.len();
        }
        if !counts.fits(self.room) {
            let spare = counts.with_spare();
            self.room = if spare.check(range).is_ok() { spare } else { counts };
            self.capacities = self.capacities.for_more(self.room, draw_vertices(device));
        }
        self.counts = counts;
        self.history = None;
        self.moved = true;
        true
    }
}
