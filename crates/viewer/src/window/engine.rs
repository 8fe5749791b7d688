//! The engine's renderer. It changes instances and loops in place; a thread takes it for uploads, so that the window
//! stays responsive.
//!
//! ```text
//!   Ready ──hidden, coloured, moved, a loop──▶ changed in place ─▶ Ready
//!     └─────anything else──▶ Uploading (thread: model of the state, upload) ──▶ Ready, or the model before
//!                              └─ of a preview, and all files are read; of a file that is closed: given up
//! ```

use super::living::{self, Placed};
use crate::session::{SceneState, World, joiner};
use selvedge::model::Model;
use selvedge::picture::{Effects, SceneSettings, Smooth};
use selvedge::renderer::{RenderError, Renderer};
use selvedge_io::import::{Stop, Unwound, caught};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};

/// A model to draw.
#[derive(Clone, Debug)]
pub struct Request {
    pub world: Arc<World>,
    pub state: Arc<SceneState>,
    pub settings: SceneSettings,
}

/// The same, borrowed: it is copied only when it differs from the last one.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    pub world: &'a Arc<World>,
    pub state: &'a SceneState,
    pub settings: SceneSettings,
}

impl Wanted<'_> {
    fn is_of(self, request: &Request) -> bool {
        let Request { world, state, settings } = request;
        Arc::ptr_eq(self.world, world) && self.settings == *settings && *self.state == **state
    }

    fn request(self) -> Request {
        Request { world: Arc::clone(self.world), state: Arc::new(self.state.clone()), settings: self.settings }
    }
}

/// The model that the renderer holds.
struct Current {
    request: Request,
    /// The settings of the upload, which may have fewer effects than the requested ones.
    settings: SceneSettings,
    placed: Placed,
    /// A change in place failed halfway: only an upload leads to a known state.
    is_mixed: bool,
}

/// What the renderer draws, for picks in its pictures: the session may have another state by the time of a pick.
pub struct Drawn {
    pub world: Arc<World>,
    /// Places the instances.
    pub state: Arc<SceneState>,
    /// Of each instance the number in the world.
    pub instances: Arc<[usize]>,
}

/// Why a model was not uploaded.
#[derive(Debug, thiserror::Error)]
pub enum UploadError {
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error("the upload failed by a defect of the program: {0}")]
    Panic(String),
    #[error("the upload was given up")]
    GivenUp,
}

/// An upload in a thread.
struct Upload {
    thread: JoinHandle<()>,
    from: Receiver<Uploaded>,
    stop: Stop,
}

/// The result of a thread.
struct Uploaded {
    renderer: Renderer,
    result: Result<(Current, Option<String>), UploadError>,
}

/// The renderer and its model.
pub struct Engine {
    renderer: Option<Renderer>,
    upload: Option<Upload>,
    current: Option<Current>,
    /// The last request, which may have failed.
    asked: Option<Request>,
    /// A setting that does not apply to the model.
    pub notice: Option<String>,
    /// Counts uploads and changes: pictures of another count are old.
    pub generation: u64,
}

impl Engine {
    pub fn new(renderer: Renderer) -> Self {
        Self { renderer: Some(renderer), upload: None, current: None, asked: None, notice: None, generation: 0 }
    }

    /// Whether a thread uploads.
    pub fn is_busy(&self) -> bool {
        self.renderer.is_none()
    }

    /// What is drawn of this world; `None` while another one is drawn.
    pub fn drawn(&self, world: &Arc<World>) -> Option<Drawn> {
        let Current { request, placed, .. } = self.current.as_ref()?;
        let drawn = || Drawn {
            world: Arc::clone(world),
            state: Arc::clone(&request.state),
            instances: Arc::clone(&placed.instances),
        };
        Arc::ptr_eq(&request.world, world).then(drawn)
    }

    /// The renderer's model, and its instances that are hidden; `None` during an upload.
    pub fn model(&self) -> Option<(Arc<Model>, BTreeSet<usize>)> {
        let (current, renderer) = (self.current.as_ref()?, self.renderer.as_ref()?);
        Some((Arc::clone(renderer.model()?), current.placed.hidden.clone()))
    }

    /// What is drawn may be drawn in a style of curvature.
    pub fn has_curvature(&self) -> bool {
        self.current.as_ref().is_some_and(|current| current.settings.curvature)
    }

    /// Effects of what is drawn, which a frame may leave out.
    pub fn effects(&self) -> Effects {
        let of = |settings: &SceneSettings| Effects {
            borders: settings.smooth == Smooth::Borders,
            ambient: settings.ambient.is_some(),
            lines: settings.edges.is_some(),
            shadows: settings.sun.is_some(),
        };
        self.current.as_ref().map(|current| of(&current.settings)).unwrap_or_default()
    }

    /// The renderer, when it holds a model.
    pub fn renderer(&mut self) -> Option<&mut Renderer> {
        self.renderer.as_mut().filter(|_| self.current.is_some())
    }

    /// Shows the requested model: by changes in place, or by an upload that begins now. No frame is in flight. The thread
    /// of an upload calls `done`; [`take`](Self::take) then has the result.
    pub fn want(&mut self, wanted: Wanted<'_>, done: impl FnOnce() + Send + 'static) {
        self.end_upload(wanted.world);
        let is_asked = self.asked.as_ref().is_some_and(|asked| wanted.is_of(asked));
        if self.is_busy() || is_asked || wanted.world.is_empty() || self.changes(wanted) {
            return;
        }
        let Some(mut renderer) = self.renderer.take() else { return };
        let request = wanted.request();
        self.asked = Some(request.clone());
        let (to, from) = mpsc::channel();
        let stop = Stop::default();
        let stopped = stop.clone();
        let thread = thread::spawn(move || {
            let between_faces = |_: usize| stopped.check();
            let result = guarded(|| upload(&mut renderer, request, &between_faces));
            // when the window closes, the receiver is gone
            drop(to.send(Uploaded { renderer, result }));
            done();
        });
        self.upload = Some(Upload { thread, from, stop });
    }

    /// Ends the upload. Nobody waits for its picture.
    fn end_upload(&self, wanted: &World) {
        let is_void = self.asked.as_ref().is_some_and(|asked| is_void(&asked.world, wanted));
        if let Some(upload) = self.upload.as_ref().filter(|_| is_void) {
            upload.stop.set();
        }
    }

    /// Changes the scene in place. `false` where only an upload can show what is wanted.
    fn changes(&mut self, wanted: Wanted<'_>) -> bool {
        let (Some(current), Some(renderer)) = (&mut self.current, &mut self.renderer) else { return false };
        let Request { world, state, settings } = &mut current.request;
        if current.is_mixed || !Arc::ptr_eq(world, wanted.world) || *settings != wanted.settings {
            return false;
        }
        let changed = living::Change { world, before: state, after: wanted.state };
        match changed.apply(renderer, &mut current.placed, current.settings.editable) {
            Ok(()) => {
                tracing::debug!("changed in place");
                let request = wanted.request();
                *state = Arc::clone(&request.state);
                self.asked = Some(request);
                self.generation += 1;
                true
            }
            Err(why) => {
                tracing::info!("an upload is needed: {why}");
                current.is_mixed = true;
                false
            }
        }
    }

    /// Takes the renderer back from a thread that has called `done`, if there is one.
    ///
    /// # Errors
    /// Why the model was not uploaded, unless it was given up; the model before stays.
    pub fn take(&mut self) -> Result<(), UploadError> {
        let Some(upload) = self.upload.take() else { return Ok(()) };
        let uploaded = match upload.from.try_recv() {
            Ok(uploaded) => uploaded,
            Err(mpsc::TryRecvError::Empty) => {
                self.upload = Some(upload);
                return Ok(());
            }
            Err(mpsc::TryRecvError::Disconnected) => return Ok(()),
        };
        // it has nothing left to do
        let _ = upload.thread.join();
        self.renderer = Some(uploaded.renderer);
        match uploaded.result {
            Ok((current, notice)) => {
                (self.current, self.notice) = (Some(current), notice);
                self.generation += 1;
                Ok(())
            }
            Err(error) => {
                // the second of two uploads may have failed
                self.current.iter_mut().for_each(|current| current.is_mixed = true);
                if matches!(error, UploadError::GivenUp) { Ok(()) } else { Err(error) }
            }
        }
    }

    /// Gives up an upload, and waits for its thread. The renderer is then here, or freed with the engine.
    pub fn wait(&mut self) {
        if let Some(Upload { thread, from, stop }) = self.upload.take() {
            stop.set();
            let _ = thread.join();
            self.renderer = from.try_recv().ok().map(|uploaded| uploaded.renderer);
        }
    }
}

/// An upload of files that is not worth its time once others are wanted: of previews when all files are read, and of a
/// file that is closed or given up. One of fewer files than are wanted goes on: its picture comes first.
fn is_void(asked: &World, wanted: &World) -> bool {
    let stays = |path: &Path| wanted.files.iter().any(|file| file.path == path);
    asked.is_partial() && !wanted.is_partial() || !asked.files.iter().all(|file| stays(&file.path))
}

/// The result of an upload, or its panic. The renderer keeps the model before until it has all of the next one.
fn guarded<T>(upload: impl FnOnce() -> Result<T, RenderError>) -> Result<T, UploadError> {
    match caught(upload) {
        Ok(result) => result.map_err(UploadError::Render),
        Err(Unwound::Stopped) => Err(UploadError::GivenUp),
        Err(unwound) => Err(UploadError::Panic(joiner::reason(&unwound))),
    }
}

/// Uploads a model with hidden instances in it, without those where one of them cannot be hidden. `between_faces` may
/// unwind to [`guarded`].
fn upload(
    renderer: &mut Renderer,
    request: Request,
    between_faces: &(dyn Fn(usize) + Sync),
) -> Result<(Current, Option<String>), RenderError> {
    // shadows are those of an upload
    let lives = request.settings.sun.is_none();
    let state = &request.state;
    let shown = if lives { state.show_and_hide(&request.world) } else { state.show(&request.world) };
    let failed = shown.failed.as_ref().map(|error| format!("A section is not cut: {error}."));
    let (mut settings, mut rough) = put(renderer, shown.model, request.settings, between_faces)?;
    let mut placed = Placed { instances: shown.instances.into(), hidden: shown.hidden };
    let hidden = placed.hidden.iter().try_for_each(|nth| renderer.set_visible(*nth, false));
    if let Err(why) = hidden {
        tracing::info!("what is hidden is left out: {why}");
        let shown = request.state.show(&request.world);
        (settings, rough) = put(renderer, shown.model, request.settings, between_faces)?;
        placed = Placed { instances: shown.instances.into(), hidden: BTreeSet::new() };
    }
    tracing::info!("uploaded");
    Ok((Current { request, settings, placed, is_mixed: false }, rough.or(failed)))
}

/// Uploads a model, with fewer effects where they do not go with it. Returns the settings that it has, and a notice.
fn put(
    renderer: &mut Renderer,
    model: Model,
    settings: SceneSettings,
    between_faces: &(dyn Fn(usize) + Sync),
) -> Result<(SceneSettings, Option<String>), RenderError> {
    let model = Arc::new(model);
    match renderer.upload_shared(Arc::clone(&model), settings, between_faces) {
        Ok(()) => Ok((settings, None)),
        Err(RenderError::SmoothTrims(what)) => {
            let settings = SceneSettings { smooth: Smooth::None, ..settings };
            renderer.upload_shared(model, settings, between_faces)?;
            Ok((settings, Some(format!("Borders are not smooth: that does not go with {what}."))))
        }
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Loaded;
    use selvedge_io::import::Import;

    #[test]
    fn an_upload_goes_on_as_long_as_its_files_are_wanted() {
        let world = |files: &[(&str, bool)]| {
            let loaded = |(path, partial): &(&str, bool)| {
                Arc::new(Loaded { path: path.into(), import: Import::default(), partial: *partial })
            };
            World::new(&files.iter().map(loaded).collect::<Vec<_>>())
        };
        let of_one = world(&[("a", false)]);
        assert!(!is_void(&of_one, &world(&[("a", false)])), "it changed on the disk: the old one is shown until then");
        assert!(!is_void(&of_one, &world(&[("a", false), ("b", false)])), "its picture comes first");
        assert!(!is_void(&of_one, &world(&[("a", false), ("b", true)])));
        assert!(is_void(&of_one, &world(&[("b", false)])), "it is closed");
        assert!(is_void(&of_one, &world(&[])));
        let preview = world(&[("a", true)]);
        assert!(!is_void(&preview, &world(&[("a", true)])), "more of it is read");
        assert!(is_void(&preview, &of_one), "all of it is read");
    }

    #[test]
    fn a_panic_of_an_upload_is_an_error() {
        let failed = guarded(|| -> Result<(), RenderError> { panic!("on purpose") });
        assert!(matches!(&failed, Err(UploadError::Panic(why)) if why == "on purpose"), "{failed:?}");
        assert!(matches!(guarded(|| Err::<(), _>(RenderError::Tolerance(0.0))), Err(UploadError::Render(_))));
        assert!(matches!(guarded(|| Ok(1)), Ok(1)));
        let stop = Stop::default();
        stop.set();
        let given_up = guarded(|| {
            stop.check();
            Ok(())
        });
        assert!(matches!(given_up, Err(UploadError::GivenUp)));
    }
}
