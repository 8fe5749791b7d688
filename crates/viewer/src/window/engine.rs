//! The engine's renderer. A thread takes it for uploads, so that the window stays responsive.
//!
//! ```text
//!   Ready ──request──▶ Uploading (thread: model of the state, upload) ──Uploaded──▶ Ready, or the renderer before
//! ```

use crate::session::{SceneState, Shown, World};
use selvedge::model::LoopAt;
use selvedge::picture::{SceneSettings, Smooth};
use selvedge::renderer::{RenderError, Renderer};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::thread::{self, JoinHandle};

/// A model to draw.
#[derive(Clone, Debug)]
pub struct Request {
    pub world: Arc<World>,
    pub state: SceneState,
    pub settings: SceneSettings,
}

impl PartialEq for Request {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.world, &other.world) && self.state == other.state && self.settings == other.settings
    }
}

/// The result of a thread.
pub struct Uploaded {
    renderer: Renderer,
    /// `None`: another part of the same model.
    request: Option<(Request, Arc<Shown>)>,
    result: Result<(), RenderError>,
    /// A setting that had to be ignored.
    notice: Option<String>,
}

/// The result of an upload.
pub enum Outcome {
    /// Another model, or the same in another state, is drawn from now on.
    Model,
    /// Another part of it.
    Cut,
    /// The reason of a failure; the model before stays.
    Failed(RenderError),
}

/// The renderer and its model.
pub struct Engine {
    renderer: Option<Renderer>,
    thread: Option<JoinHandle<()>>,
    /// The renderer's model.
    current: Option<(Request, Arc<Shown>)>,
    /// The last request.
    asked: Option<Request>,
    /// A setting that does not apply to the model.
    pub notice: Option<String>,
    /// Counts uploads: pictures of another count are old.
    pub generation: u64,
}

impl Engine {
    pub fn new(renderer: Renderer) -> Self {
        Self { renderer: Some(renderer), thread: None, current: None, asked: None, notice: None, generation: 0 }
    }

    /// Whether a thread uploads.
    pub fn is_busy(&self) -> bool {
        self.renderer.is_none()
    }

    /// The model that is drawn.
    pub fn shown(&self) -> Option<&Arc<Shown>> {
        self.current.as_ref().map(|(_, shown)| shown)
    }

    /// What is drawn may be drawn in a style of curvature.
    pub fn has_curvature(&self) -> bool {
        self.current.as_ref().is_some_and(|(request, _)| request.settings.curvature)
    }

    /// The renderer, when it holds a model.
    pub fn renderer(&mut self) -> Option<&mut Renderer> {
        self.renderer.as_mut().filter(|_| self.current.is_some())
    }

    /// Begins to upload the requested model, unless it is there or on its way; no frame is in flight. The thread calls
    /// `done`.
    pub fn want(&mut self, request: &Request, done: impl FnOnce(Box<Uploaded>) + Send + 'static) {
        if self.is_busy() || self.asked.as_ref() == Some(request) || request.world.is_empty() || self.edits(request) {
            return;
        }
        let Some(mut renderer) = self.renderer.take() else { return };
        self.asked = Some(request.clone());
        let request = request.clone();
        self.thread = Some(thread::spawn(move || {
            let shown = Arc::new(request.state.show(&request.world));
            let mut notice = shown.failed.as_ref().map(|error| format!("A section is not cut: {error}."));
            let mut settings = request.settings;
            let mut result = renderer.upload_with(&shown.model, settings);
            if let Err(RenderError::SmoothTrims(what)) = result {
                notice = Some(format!("Borders are not smooth: that does not go with {what}."));
                settings.smooth = Smooth::None;
                result = renderer.upload_with(&shown.model, settings);
            }
            let request = Request { settings, ..request };
            done(Box::new(Uploaded { renderer, request: Some((request, shown)), result, notice }));
        }));
    }

    /// Changes trim loops in place, if nothing else differs from the last request.
    fn edits(&mut self, request: &Request) -> bool {
        let (Some(asked), Some((current, shown)), Some(renderer)) =
            (&self.asked, &mut self.current, &mut self.renderer)
        else {
            return false;
        };
        let same = Arc::ptr_eq(&asked.world, &request.world) && asked.settings == request.settings;
        if !(same && current.settings.editable && asked.state.differs_in_loops_alone(&request.state)) {
            return false;
        }
        let (old, new) = (&asked.state.edits, &request.state.edits);
        let changed: BTreeSet<_> = old.keys().chain(new.keys()).filter(|key| old.get(key) != new.get(key)).collect();
        let model = &mut Arc::make_mut(shown).model;
        for key in changed {
            let (part, face, trim_loop) = *key;
            let Some(original) =
                request.world.model.parts.get(part).and_then(|p| p.faces.get(face)?.loops.get(trim_loop))
            else {
                continue;
            };
            let wanted = new.get(key).unwrap_or(original);
            if let Err(error) = renderer.edit_loop(LoopAt { part, face, trim_loop }, wanted) {
                // uploaded anew, it is drawn
                tracing::info!("{error}");
                return false;
            }
            model.parts[part].faces[face].loops[trim_loop] = wanted.clone();
        }
        current.state = request.state.clone();
        self.asked = Some(request.clone());
        self.generation += 1;
        true
    }

    /// Takes the renderer back from the thread.
    pub fn take(&mut self, uploaded: Uploaded) -> Outcome {
        let Uploaded { renderer, request, result, notice } = uploaded;
        if let Some(thread) = self.thread.take() {
            // the thread has ended
            let _ = thread.join();
        }
        self.renderer = Some(renderer);
        let is_model = request.is_some();
        if let Err(error) = result {
            return Outcome::Failed(error);
        }
        self.generation += 1;
        if let Some(current) = request {
            self.current = Some(current);
            self.notice = notice;
        }
        if is_model { Outcome::Model } else { Outcome::Cut }
    }

    /// Waits for the thread; its result is then in the queue of events, and must be taken or dropped.
    pub fn wait(&mut self) {
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
