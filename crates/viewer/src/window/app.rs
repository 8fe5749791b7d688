//! The window's state, and one frame of it.

use super::composite::ViewRect;
use super::engine::{Drawn, Engine, Wanted};
use super::look::background;
use super::screen::{Frame, Picture, Screen};
use super::selecting::{Click, LookUp};
use super::shown::{Pictures, ShownPicture};
use super::waiter::Waiter;
use super::{Failure, Fault, ViewError, ViewOptions};
use crate::measure::Measurement;
use crate::navigation::gesture::Held;
use crate::panels::{Facts, Ui, Verdict};
use crate::session::Picked;
use crate::session::{Joiner, JoinerEvent, Loaded, LoaderEvent, Loads, Session};
use crate::settings::{Settings, Theme};
use crate::view::{Due, View};
use crate::watch::Watcher;
use glam::DVec2;
use selvedge::ash::vk;
use selvedge::model::Camera;
use selvedge::picture::{FrameSettings, FrameStats, Style};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use winit::event_loop::EventLoopProxy;
use winit::window::Window;

/// Most threads that measure at once: the last selection waits for one of them.
const MOST_MEASURING: usize = 4;

/// Messages of other threads to the window.
pub enum Event {
    /// The frame that was submitted to the device of this number has finished.
    FrameDone(u32, Result<(), vk::Result>),
    /// A file, by the number of its load.
    Loader(u64, LoaderEvent),
    /// The open files as one model.
    Joiner(JoinerEvent),
    /// The engine's thread has finished.
    Uploaded,
    /// Files were chosen.
    Chosen(Vec<PathBuf>),
    /// An open file has changed.
    Changed(PathBuf),
    /// The measurement of a selection.
    Measured(Vec<Picked>, Option<Measurement>),
    /// The verdict on a picture, or why there is none.
    Judged(Result<Verdict, String>),
    /// The system resumes the program, as imitated.
    Resumed,
    /// The desktop is set to less motion.
    LessMotion,
    /// The desktop is dark, or light.
    Dark(bool),
    /// The panels need to be drawn again.
    Repaint,
}

/// A frame in flight.
struct Flight {
    /// The engine's picture in it, and its start.
    picture: Option<(Due, FrameSettings, u64, Instant)>,
    /// Where it picks: pixels of the view.
    pick: Option<DVec2>,
    /// The move of the cursor before it.
    pointed: Option<Instant>,
    /// The picture that the pick reads.
    camera: Option<Camera>,
    /// The scene of that picture, and the engine's count.
    scene: Option<Drawn>,
    generation: u64,
    free: Vec<egui::TextureId>,
}

/// Objects that live as long as the window.
pub struct Opened {
    pub window: Arc<Window>,
    pub input: egui_winit::State,
    // in the order in which they are dropped
    pub waiter: Waiter,
    pub engine: Engine,
    pub screen: Screen,
}

/// The state of the program.
pub struct App {
    pub options: ViewOptions,
    pub proxy: EventLoopProxy<Event>,
    pub opened: Option<Opened>,
    pub context: egui::Context,
    pub session: Session,
    pub view: View,
    pub ui: Ui,
    pub settings: Settings,
    /// The desktop is set to less motion.
    pub less_motion: bool,
    /// The desktop's colours, where its settings have them.
    pub desktop: Option<egui::Theme>,
    /// The settings in the file.
    pub kept: Settings,
    pub files: Vec<Arc<Loaded>>,
    pub loads: Loads,
    pub joiner: Joiner,
    pub watcher: Option<Watcher>,
    flight: Option<Flight>,
    /// The system was told that a frame is due.
    pub due: bool,
    /// Drawn again once the frame in flight is done.
    pub again: bool,
    /// Nothing has happened since the log said that the window is idle.
    pub rests: bool,
    /// The time of the next frame, if no event comes before.
    pub wake: Option<Instant>,
    pub pictures: Pictures,
    pub stats: Option<FrameStats>,
    pub rect: ViewRect,
    /// The display's scale in the last event of it.
    pub scale: Option<f64>,
    /// Pixels of the window.
    pub cursor: Option<DVec2>,
    pub held: Held,
    /// A pick to make: pixels of the view.
    pub pick: Option<DVec2>,
    /// The last move of the cursor, until a frame has it.
    pub pointed: Option<Instant>,
    /// A click that waits for its pick.
    pub click: Option<Click>,
    /// The last pick, whose result the view has.
    pub look_up: Option<LookUp>,
    /// The time of a click whose selection no frame has shown yet.
    pub selected: Option<Instant>,
    pub failed: Option<ViewError>,
    pub clipboard: Option<arboard::Clipboard>,
    /// Of the validation layer.
    pub messages: Vec<String>,
    /// The first frame was shown.
    shows: bool,
    /// The first picture was shown.
    seen: bool,
    /// Size of the engine's last picture.
    drawn: (u32, u32),
    /// The explosion that the view has room for.
    pub explosion: f64,
    /// Counts devices that were opened.
    pub devices: u32,
    /// Threads that measure.
    pub measuring: usize,
    pub begun: Instant,
}

impl App {
    /// `begun` is the time of the call of [`run`](super::run).
    pub fn new(mut options: ViewOptions, proxy: EventLoopProxy<Event>, begun: Instant) -> Self {
        let mut ui = Ui::default();
        let read = options.settings.as_deref().map(Settings::read);
        let settings = match read {
            Some(Ok(settings)) => settings,
            Some(Err(error)) => {
                ui.tell(format!("The settings cannot be read and are left as they are: {error}"));
                options.settings = None;
                Settings::default()
            }
            None => Settings::default(),
        };
        let watched = proxy.clone();
        let watcher = Watcher::new(move |path| drop(watched.send_event(Event::Changed(path))));
        let watcher = watcher.inspect_err(|e| ui.tell(format!("Files are not watched: {e}"))).ok();
        let joined = proxy.clone();
        let joiner = Joiner::new(move |event| drop(joined.send_event(Event::Joiner(event))));
        let loads = Loads::new(options.finder.clone());
        let context = crate::panels::context();
        // the first layout frames the model: `set_zoom_factor` would change the text after it
        context.options_mut(|all| all.zoom_factor = settings.text);
        Self {
            options,
            proxy,
            opened: None,
            context,
            session: Session::default(),
            view: View::default(),
            ui,
            less_motion: false,
            desktop: None,
            kept: settings.clone(),
            settings,
            files: Vec::new(),
            loads,
            joiner,
            watcher,
            flight: None,
            due: false,
            again: false,
            rests: false,
            wake: None,
            pictures: Pictures::default(),
            stats: None,
            rect: ViewRect::default(),
            scale: None,
            cursor: None,
            held: Held::default(),
            pick: None,
            pointed: None,
            click: None,
            look_up: None,
            selected: None,
            failed: None,
            clipboard: None,
            messages: Vec::new(),
            shows: false,
            seen: false,
            drawn: (0, 0),
            explosion: 0.0,
            devices: 0,
            measuring: 0,
            begun,
        }
    }

    /// Frames and pictures of a lost device are gone.
    pub fn forget_frames(&mut self) {
        (self.flight, self.pictures, self.look_up) = (None, Pictures::default(), None);
    }

    /// A frame is due.
    pub fn redraw(&mut self) {
        let is_ready = self.is_ready();
        match &self.opened {
            Some(opened) if is_ready => {
                opened.window.request_redraw();
                self.due = true;
            }
            _ => self.again = true,
        }
    }

    /// A frame may begin: none is in flight, and the window has a surface.
    fn is_ready(&self) -> bool {
        self.flight.is_none() && self.opened.is_some() && !self.is_suspended()
    }

    /// The system has suspended the program.
    pub fn is_suspended(&self) -> bool {
        self.opened.as_ref().is_some_and(|opened| opened.screen.is_suspended())
    }

    /// Nothing is drawn, read, put together or uploaded, and no frame is due.
    pub fn is_idle(&self) -> bool {
        let draws = self.flight.is_some() || self.due || self.wake.is_some();
        let uploads = self.opened.as_ref().is_none_or(|opened| opened.engine.is_busy());
        !draws && !uploads && self.loads.is_idle() && self.joiner.is_idle()
    }

    /// No frame is due or in flight: the window shows everything as it is.
    pub fn is_up_to_date(&self) -> bool {
        self.flight.is_none() && !self.due && !self.again
    }

    /// The cursor in pixels of the view; `None` beside the view, and where a panel covers it. Each event asks anew: the
    /// cursor may have come from a panel since the last frame.
    pub fn over_view(&self) -> Option<DVec2> {
        let cursor = self.cursor?;
        let points = cursor.as_vec2() / self.context.pixels_per_point();
        let layer = self.context.layer_id_at(egui::pos2(points.x, points.y));
        let is_taken =
            self.context.is_using_pointer() || layer.is_some_and(|layer| layer.order != egui::Order::Background);
        let ViewRect { x, y, width, height } = self.rect;
        let at = cursor - DVec2::new(f64::from(x), f64::from(y));
        let inside = at.min_element() >= 0.0 && at.x < f64::from(width) && at.y < f64::from(height);
        (inside && !is_taken).then_some(at)
    }

    /// One frame; none while one is in flight, or while the program is suspended.
    pub fn draw(&mut self) -> Result<(), ViewError> {
        (self.due, self.rests) = (false, false);
        if !self.is_ready() {
            self.again = true;
            return Ok(());
        }
        self.again = false;
        let now = Instant::now();
        self.view.advance(now);
        let output = self.run_panels();
        self.obey(now);
        if self.measuring < MOST_MEASURING && std::mem::take(&mut self.ui.wants_measure) {
            self.measure();
        }
        self.keep_settings();
        self.make_room();
        let effects = self.opened.as_ref().map(|opened| opened.engine.effects());
        self.view.pacing.set_effects(effects.unwrap_or_default());
        let due = if self.seen { self.view.due(now) } else { self.view.first() };
        let (mut settings, marks) = (self.frame_settings(), self.marks());
        settings.without = due.step.without;
        let (under, scene_settings) = (self.over_view(), self.scene_settings());
        let Some(Opened { window, waiter, engine, screen, .. }) = &mut self.opened else { return Ok(()) };
        let wanted = Wanted { world: &self.session.world, state: self.session.scene.now(), settings: scene_settings };
        let proxy = self.proxy.clone();
        engine.want(wanted, move || drop(proxy.send_event(Event::Uploaded)));
        if settings.style.is_curvature() && !engine.has_curvature() {
            settings.style = Style::Clay; // until the upload that was just asked for is there
        }
        if self.session.world.is_empty() {
            screen.blank();
            self.pictures = Pictures::default();
        }
        let wanted = ShownPicture { camera: due.camera, settings, generation: engine.generation };
        let is_new = self.pictures.is_due(&wanted) && due.camera.size.0 > 1 && !self.session.world.is_empty();
        let generation = engine.generation;
        let scene = engine.drawn(&self.session.world);
        let picture = if is_new { engine.renderer() } else { None };
        let picture = picture.map(|renderer| Picture { renderer, camera: &due.camera, settings });
        let in_picture = picture.is_some().then_some((due, settings, generation, now));
        let seen_by = in_picture.map(|_| due.camera).or(self.pictures.camera(generation));
        // the item under a resting cursor changes with the picture
        let rests = in_picture.is_some() && !self.view.is_dragging();
        let scene = scene.filter(|_| seen_by.is_some());
        // without a picture of what is open there is nothing to click
        self.click = self.click.filter(|_| scene.is_some());
        let clicked = self.click.map(|click| click.at);
        let pick = clicked.or(self.pick.take()).or(under.filter(|_| rests)).filter(|_| scene.is_some());
        if scene.is_none() && self.view.wants_point().is_some() {
            self.view.hold(None);
        }
        screen.set_textures(&output.textures_delta)?;
        let fault = self.options.faults.as_ref().and_then(|faults| (faults.0)());
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        let frame = Frame {
            view: self.rect,
            pick: pick.zip(seen_by).map(|(at, camera)| self.rect.pixel(at, camera.size)),
            marks: (marks.0, &marks.1),
            panels: (&shapes, output.pixels_per_point),
            background: background(self.context.style().visuals.dark_mode),
            fault,
        };
        let (free, pointed) = (output.textures_delta.free, self.pointed.take());
        let (drawn, in_picture, pick) = match screen.draw(window, picture, &frame) {
            Ok(drawn) => (drawn, in_picture, pick),
            Err(Failure::Picture(error)) => {
                tracing::error!("a view cannot be drawn: {error}");
                self.ui.tell(format!("This view cannot be drawn: {error}"));
                self.pictures.failed(wanted);
                // its place was one of the picture that is not there: the next frame picks from the one before
                self.pick = pick;
                (true, None, None)
            }
            Err(Failure::Screen(error)) => return Err(error),
        };
        if drawn {
            waiter.watch(screen.context.fence);
            self.flight = Some(Flight { picture: in_picture, pick, pointed, camera: seen_by, scene, generation, free });
        } else {
            screen.free_textures(&free)?;
        }
        let repaint = output.viewport_output.get(&egui::ViewportId::ROOT).map(|v| v.repaint_delay);
        let repaint = repaint.and_then(|delay| now.checked_add(delay)).filter(|_| drawn);
        self.wake = [repaint, self.view.wake(now)].into_iter().flatten().min();
        if let Some(Fault::Suspended(time)) = fault {
            self.suspend_for(time);
        }
        Ok(())
    }

    /// Near and far plane enclose instances that are moved apart, too.
    fn make_room(&mut self) {
        let state = self.session.scene.now();
        if self.explosion != state.explosion {
            self.explosion = state.explosion;
            self.view.set_bounds(state.bounds(&self.session.world));
        }
    }

    fn run_panels(&mut self) -> egui::FullOutput {
        let theme = match self.settings.theme {
            Theme::System => egui::ThemePreference::System,
            Theme::Light => egui::ThemePreference::Light,
            Theme::Dark => egui::ThemePreference::Dark,
        };
        self.context.set_theme(theme);
        let zoom = self.zoom();
        if (self.context.zoom_factor() - zoom).abs() > 1e-3 {
            self.context.set_zoom_factor(zoom);
        }
        let Some(Opened { window, input, engine, screen, .. }) = &mut self.opened else { unreachable!("checked") };
        let mut raw = input.take_egui_input(window);
        raw.system_theme = raw.system_theme.or(self.desktop);
        let facts = Facts {
            loading: self.loads.iter().collect(),
            stats: self.stats.as_ref(),
            notice: engine.notice.as_deref(),
            busy: self.joiner.is_busy() || engine.is_busy(),
            picture: screen.shown(),
            view: &self.view,
            device: &screen.context.name,
        };
        let (session, ui, settings) = (&mut self.session, &mut self.ui, &mut self.settings);
        let (mut view, mut copied) = (egui::Rect::NOTHING, None);
        let output = self.context.run(raw, |ctx| view = crate::panels::show(ctx, ui, session, settings, &facts));
        for command in &output.platform_output.commands {
            if let egui::OutputCommand::CopyText(text) = command {
                copied = Some(text.clone());
            }
        }
        input.handle_platform_output(window, output.platform_output.clone());
        let pixels = output.pixels_per_point;
        let (at, is_down) = self.context.input(|input| (input.pointer.latest_pos(), input.pointer.any_down()));
        if let Some(at) = at.map(|at| at * pixels) {
            // of the frame that ends next
            tracing::debug!("pointer at {:.0}, {:.0}, {}", at.x, at.y, if is_down { "down" } else { "up" });
        }
        let size = window.inner_size();
        let pixel = |x: f32, most: u32| ((x * pixels).round().max(0.0) as u32).min(most);
        let (x, y) = (pixel(view.min.x, size.width), pixel(view.min.y, size.height));
        let (right, bottom) = (pixel(view.max.x, size.width), pixel(view.max.y, size.height));
        let rect = ViewRect { x, y, width: right.saturating_sub(x), height: bottom.saturating_sub(y) };
        if rect != self.rect {
            tracing::debug!("view of {} x {} at {x}, {y}", rect.width, rect.height);
        }
        self.rect = rect;
        self.view.resize((self.rect.width, self.rect.height));
        copied.into_iter().for_each(|text| self.set_clipboard(text));
        output
    }

    /// The frame in flight has finished.
    pub fn frame_done(&mut self, result: Result<(), vk::Result>) -> Result<(), ViewError> {
        let Some(flight) = self.flight.take() else { return Ok(()) };
        let Flight { picture, pick, pointed, camera, scene, generation, free } = flight;
        result?;
        tracing::debug!("frame");
        let ms = |since: Instant| since.elapsed().as_secs_f64() * 1e3;
        if !std::mem::replace(&mut self.shows, true) {
            tracing::info!("first frame after {:.0} ms", ms(self.begun));
        }
        if let Some(click) = self.selected.take() {
            tracing::debug!("its selection is shown {:.1} ms after the click", ms(click));
        }
        let Some(Opened { engine, screen, .. }) = &mut self.opened else { return Ok(()) };
        screen.free_textures(&free)?;
        if let Some((due, settings, generation, start)) = picture {
            let report = match engine.renderer() {
                Some(renderer) => renderer.report(0)?,
                None => None,
            };
            let complete = report.as_ref().is_some_and(|r| r.complete);
            self.stats = report.map(|r| r.stats);
            let shown = ShownPicture { camera: due.camera, settings, generation };
            self.pictures.drawn(shown, complete);
            // the first picture of a size makes its buffers, and an incomplete one is no measure
            if std::mem::replace(&mut self.drawn, due.camera.size) == due.camera.size && complete {
                self.view.pacing.took(due.step, start.elapsed());
            }
            self.again |= !complete;
            if complete && engine.drawn(&self.session.world).is_some() {
                self.joiner.shown();
            }
            if !self.seen && complete {
                // the whole picture is next
                (self.seen, self.again) = (true, true);
                tracing::info!("first picture after {:.0} ms", ms(self.begun));
            }
            let (width, height) = due.camera.size;
            let (time, without) = (start.elapsed(), settings.without);
            tracing::debug!("picture of {width} x {height} in {time:.1?}, complete: {complete}, without {without:?}");
        }
        let samples = screen.picked();
        let scene = scene.filter(|scene| Arc::ptr_eq(&scene.world, &self.session.world));
        if let (Some(at), Some(camera), Some(samples), Some(scene)) = (pick, camera, samples, scene) {
            self.picked(&samples, &scene, LookUp { at, camera, generation, filter: self.ui.filter });
            if let Some(moved) = pointed {
                tracing::debug!("the item under the cursor is found {:.1} ms after its move", ms(moved));
            }
        }
        if self.again || self.pick.is_some() || self.click.is_some() {
            self.redraw();
        }
        Ok(())
    }

    /// The engine's thread has finished.
    pub fn uploaded(&mut self) {
        let Some(opened) = &mut self.opened else { return };
        if let Err(error) = opened.engine.take() {
            tracing::error!("{error}");
            self.ui.tell(format!("It cannot be drawn: {error}"));
        }
        if !self.joiner.is_busy() && opened.engine.drawn(&self.session.world).is_some() {
            self.loads.shown(Instant::now());
        }
        self.redraw();
    }
}
