//! Events of the window and of other threads, and the commands.

use super::app::{App, Event, Opened};
use crate::commands::Command;
use crate::describe::command;
use crate::navigation::gesture::{Button, Scroll};
use crate::navigation::standard::up_from;
use crate::session::{Ended, Loaded, News, World};
use crate::view::View;
use glam::DVec2;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::WindowId;

impl ApplicationHandler<Event> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let opened = if self.opened.is_none() { self.open_window(events) } else { self.resume() };
        if let Err(error) = opened {
            self.fail(error, events);
        }
    }

    fn suspended(&mut self, _: &ActiveEventLoop) {
        self.suspend();
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            self.read_changed(Instant::now());
            if self.wake.is_some_and(|wake| wake <= Instant::now()) {
                self.wake = None;
                self.redraw();
            }
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let next = [self.wake, self.loads.wake()].into_iter().flatten().min();
        events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        let is_idle = self.is_idle();
        if is_idle && !self.rests {
            tracing::debug!("idle");
        }
        self.rests = is_idle;
        if self.ui.quit {
            events.exit();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(Opened { window, input, screen, .. }) = &mut self.opened else { return };
        let response = input.on_window_event(window, &event);
        name_copying(input.egui_input_mut());
        match &event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(_) => {
                screen.resized();
                self.redraw();
            }
            WindowEvent::ScaleFactorChanged { scale_factor, .. } => {
                tracing::debug!("the display's scale is {scale_factor}");
                screen.resized();
                self.scale = Some(*scale_factor);
                self.redraw();
            }
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    self.recover(error, events);
                }
                return;
            }
            WindowEvent::DroppedFile(path) => self.load(path.clone()),
            WindowEvent::ModifiersChanged(modifiers) => {
                (self.held.ctrl, self.held.shift) = (modifiers.state().control_key(), modifiers.state().shift_key());
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.cursor = Some(DVec2::new(position.x, position.y));
                self.cursor_moved();
            }
            WindowEvent::CursorLeft { .. } => {
                self.cursor = None;
                self.view.hover = None;
                self.redraw();
            }
            WindowEvent::MouseInput { state, button, .. } => self.button(*state, *button),
            WindowEvent::MouseWheel { delta, .. } => {
                let scroll = match delta {
                    MouseScrollDelta::LineDelta(x, y) => Scroll::Lines(DVec2::new(f64::from(*x), f64::from(*y))),
                    MouseScrollDelta::PixelDelta(by) => Scroll::Pixels(DVec2::new(by.x, by.y)),
                };
                tracing::debug!("scrolled by {scroll:?}");
                let scrolled = self.settings.preset.scroll(scroll, self.held);
                let style = self.settings.orbit;
                self.move_at_cursor(|view, at, now| view.scroll(at, scrolled, style, now));
            }
            // macOS has these
            WindowEvent::PinchGesture { delta, .. } => self.move_at_cursor(|view, at, now| view.pinch(at, *delta, now)),
            WindowEvent::RotationGesture { delta, .. } => {
                let (angle, style) = (f64::from(*delta).to_radians(), self.settings.orbit);
                self.move_at_cursor(|view, at, now| view.twist(at, angle, style, now));
            }
            _ => {}
        }
        if response.repaint {
            self.redraw();
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, event: Event) {
        self.rests = false;
        match event {
            // of a device that was lost
            Event::FrameDone(device, _) if device != self.devices => {}
            Event::FrameDone(_, result) => {
                if let Err(error) = self.frame_done(result) {
                    self.recover(error, events);
                }
            }
            Event::Joiner(event) => {
                match self.joiner.take(event) {
                    Some(Ok(world)) => self.joined(world),
                    Some(Err(failure)) => {
                        tracing::error!("{failure}");
                        self.ui.tell(failure);
                    }
                    None => {}
                }
                self.redraw();
            }
            Event::Uploaded => self.uploaded(),
            Event::Loader(number, event) => {
                let previews = self.previews().count();
                match self.loads.take(number, event) {
                    Some(News::Preview(loaded)) => self.previewed(&loaded),
                    Some(News::Ended(Ended { result: Ok(loaded), .. })) => self.loaded(loaded),
                    Some(News::Ended(Ended { result: Err(why), path })) => self.not_loaded(&path, why, previews),
                    None => {}
                }
                self.redraw();
            }
            Event::Chosen(paths) => paths.into_iter().for_each(|path| self.load(path)),
            Event::Changed(path) => {
                // a closed file may have been written before
                if self.is_open(&path) || self.loads.is_reading(&path) {
                    self.loads.written(path, Instant::now());
                }
            }
            Event::Measured(selection, measured) => {
                self.measuring -= 1;
                if selection == self.session.selection {
                    self.ui.measured(measured);
                }
                self.redraw();
            }
            Event::Judged(verdict) => {
                match verdict {
                    Ok(verdict) => self.ui.judged(verdict),
                    Err(why) => self.ui.tell(why),
                }
                self.redraw();
            }
            Event::Resumed => self.resumed(events),
            Event::LessMotion => {
                tracing::info!("the desktop asks for less motion");
                self.less_motion = true;
            }
            Event::Dark(dark) => {
                tracing::info!("the desktop is {}", if dark { "dark" } else { "light" });
                self.desktop = Some(if dark { egui::Theme::Dark } else { egui::Theme::Light });
                self.redraw();
            }
            Event::Repaint => self.redraw(),
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        tracing::info!("closing");
    }
}

/// Ctrl + Shift + C comes as the event of copying, which has no modifiers: by the time of the frame they may be let go.
/// It becomes the event of a key.
fn name_copying(input: &mut egui::RawInput) {
    let modifiers = input.modifiers;
    if let Some(last) = input.events.last_mut().filter(|last| modifiers.shift && **last == egui::Event::Copy) {
        *last = egui::Event::Key { key: egui::Key::C, physical_key: None, pressed: true, repeat: false, modifiers };
    }
}

impl App {
    fn fail(&mut self, error: super::ViewError, events: &ActiveEventLoop) {
        self.failed.get_or_insert(error);
        events.exit();
    }

    /// Goes on after a lost device; every other error closes the window.
    fn recover(&mut self, error: super::ViewError, events: &ActiveEventLoop) {
        if !error.is_device_lost() {
            return self.fail(error, events);
        }
        tracing::error!("{error}");
        if self.is_suspended() {
            // there is no surface to choose a device for: the first frame after it meets the loss again
            return;
        }
        if let Err(error) = self.reopen_device() {
            self.fail(error, events);
        }
    }

    /// Passes the current cursor to the view.
    pub fn catch_up(&mut self) {
        let Some(cursor) = self.cursor else { return };
        let at = cursor - DVec2::new(f64::from(self.rect.x), f64::from(self.rect.y));
        let mode = (self.settings.preset, self.settings.orbit);
        self.view.moved(at, self.held, mode, Instant::now());
    }

    fn cursor_moved(&mut self) {
        self.catch_up();
        match (self.view.is_dragging(), self.over_view()) {
            (false, Some(at)) => {
                (self.pick, self.pointed) = (Some(self.view.wants_point().unwrap_or(at)), Some(Instant::now()));
            }
            (false, None) => self.view.hover = None,
            _ => {}
        }
        self.redraw();
    }

    fn button(&mut self, state: ElementState, button: MouseButton) {
        let button = match button {
            MouseButton::Left => Button::Left,
            MouseButton::Middle => Button::Middle,
            MouseButton::Right => Button::Right,
            _ => return,
        };
        let down = state == ElementState::Pressed;
        if down {
            let Some(at) = self.over_view() else { return };
            self.held.button(button, true);
            self.view.press(at);
            self.pick = self.view.wants_point();
        } else if self.held.any() {
            if self.view.wants_point().is_some() {
                // the drag ended before its point was found
                self.view.hold(None);
                self.catch_up();
            }
            self.held.button(button, false);
            if !self.held.any()
                && self.view.release()
                && button == Button::Left
                && let Some(at) = self.over_view()
            {
                self.clicked(at);
            }
        }
        self.redraw();
    }

    /// Moves the view at the cursor, while that is over it.
    fn move_at_cursor(&mut self, act: impl FnOnce(&mut View, DVec2, Instant)) {
        if let Some(at) = self.over_view() {
            act(&mut self.view, at, Instant::now());
            self.redraw();
        }
    }

    /// Begins to read a file. It is watched from now on, since it may be written while it is read.
    pub fn load(&mut self, path: PathBuf) {
        if let Some(watcher) = &mut self.watcher {
            // `loaded` tries it again, and says why it fails
            let _ = watcher.add(&path);
        }
        let proxy = self.proxy.clone();
        self.loads.begin(path, move |number, event| drop(proxy.send_event(Event::Loader(number, event))));
        self.redraw();
    }

    fn is_open(&self, path: &Path) -> bool {
        self.files.iter().any(|file| file.path == path)
    }

    /// The finished parts of files that are being read and not open. Of an open file that is read again, the parts as
    /// they were are shown until it is read.
    fn previews(&self) -> impl Iterator<Item = &Arc<Loaded>> {
        self.loads.previews().filter(move |preview| !self.is_open(&preview.path))
    }

    /// Puts the open files together, and the finished parts of others.
    fn join(&mut self) {
        let all = self.files.iter().chain(self.previews()).cloned().collect();
        self.joiner.join(all);
    }

    fn give_up(&mut self) {
        let previews = self.previews().count();
        for path in self.loads.give_up() {
            self.unwatch(&path);
            self.ui.tell(format!("{}: given up", path.display()));
        }
        self.join_without(previews);
    }

    /// Watches a file no more, unless it is open.
    fn unwatch(&mut self, path: &Path) {
        if !self.is_open(path)
            && let Some(watcher) = &mut self.watcher
        {
            watcher.remove(path);
        }
    }

    /// A file cannot be read; there were so many previews before.
    fn not_loaded(&mut self, path: &Path, why: String, previews: usize) {
        self.unwatch(path);
        tracing::error!("{why}");
        self.ui.tell(why);
        self.join_without(previews);
    }

    /// Puts the files together again where a preview has gone; there were so many before.
    fn join_without(&mut self, previews: usize) {
        if self.previews().count() < previews {
            self.join();
        }
    }

    fn previewed(&mut self, loaded: &Loaded) {
        if !self.is_open(&loaded.path) {
            tracing::info!("{} so far: {} faces", loaded.path.display(), loaded.import.model.face_count());
            self.join();
        }
    }

    fn loaded(&mut self, loaded: Arc<Loaded>) {
        let (faces, warnings) = (loaded.import.model.face_count(), loaded.import.warnings.len());
        tracing::info!("read {}: {faces} faces, {warnings} warnings", loaded.path.display());
        self.settings.opened(&loaded.path);
        if let Some(Err(error)) = self.watcher.as_mut().map(|watcher| watcher.add(&loaded.path)) {
            self.ui.tell(format!("{} is not watched: {error}", loaded.path.display()));
        }
        match self.files.iter().position(|file| file.path == loaded.path) {
            Some(known) => self.files[known] = loaded,
            None => self.files.push(loaded),
        }
        self.join();
    }

    /// Shows the model of all open files.
    fn joined(&mut self, world: Arc<World>) {
        // the first parts are all in view, and so are those after them, unless the view was moved meanwhile
        let before = &self.session.world;
        let first = before.is_empty() || before.files.iter().all(|file| file.partial) && self.view.is_untouched();
        let gone = self.session.open(Arc::clone(&world));
        self.ui.opened();
        if gone > 0 {
            self.ui
                .tell(format!("Edits of {gone} trim loops are gone: their files are closed or have other loops now."));
        }
        world.notices.iter().for_each(|notice| self.ui.tell(notice.clone()));
        self.view.set_bounds(self.session.scene.now().bounds(&world));
        self.explosion = self.session.scene.now().explosion;
        self.view.hover = None;
        if first {
            self.view.reset(Instant::now());
        }
        let title: Vec<_> = world.files.iter().map(|file| file.name.as_str()).collect();
        if let Some(opened) = &self.opened {
            opened.window.set_title(&format!("{} - selvedge", title.join(", ")));
        }
    }

    /// Reads files again that have changed on the disk and rest.
    fn read_changed(&mut self, now: Instant) {
        for path in self.loads.rested(now) {
            tracing::info!("{} has changed", path.display());
            self.load(path);
        }
    }

    /// Carries out the commands of panels and keys.
    pub fn obey(&mut self, now: Instant) {
        let smooth = !self.settings.reduced_motion && !self.less_motion;
        for command in std::mem::take(&mut self.ui.commands) {
            tracing::debug!("{command:?}");
            match command {
                Command::OpenDialog => self.open_dialog(),
                Command::Open(path) => self.load(path),
                Command::Close(file) => self.close_file(file),
                Command::Reload => {
                    let paths: Vec<_> = self.files.iter().map(|f| f.path.clone()).collect();
                    paths.into_iter().for_each(|path| self.load(path));
                }
                Command::Cancel => self.give_up(),
                Command::Fit => self.view.fit(smooth, now),
                Command::FitSelection => {
                    let points = crate::describe::extent(&self.session);
                    if points.is_empty() {
                        self.view.fit(smooth, now);
                    } else {
                        self.view.fit_points(&points, smooth, now);
                    }
                }
                Command::Standard(view) => self.view.look_from(view.from(), view.up(), smooth, now),
                Command::LookFrom(from) => self.view.look_from(from, up_from(from), smooth, now),
                Command::Projection => self.view.toggle_projection(now),
                Command::Previous => drop(self.view.previous(smooth, now)),
                Command::Turn(x, y) => self.view.turn(DVec2::new(x, y), self.settings.orbit, now),
                Command::Shift(x, y) => self.view.shift(DVec2::new(x, y), now),
                Command::Zoom(notches) => self.view.zoom(notches, now),
                Command::CopyCommand => {
                    let (style, background) = (self.ui.style, self.background());
                    let text = command::line(&self.session, self.view.camera(), &self.settings, (style, background));
                    self.copy(text);
                    let left_out = command::left_out(&self.session);
                    if !left_out.is_empty() {
                        self.ui.tell(format!("The copied line leaves out: {}.", left_out.join(", ")));
                    }
                }
                Command::CopyText(text) => self.copy(text),
                Command::WritePicture => self.write_picture(),
                Command::CopyPicture => self.copy_picture(),
                Command::Check => self.check(),
                Command::Save => self.save(),
                Command::Points => {
                    self.ui.obey(Command::Points, &mut self.session);
                    // the item under a resting cursor changes
                    self.pick = self.over_view();
                }
                Command::Quit => self.ui.quit = true,
                other => self.ui.obey(other, &mut self.session),
            }
            self.again = true;
        }
    }

    /// Closes a file of the tree, or ends its reading.
    fn close_file(&mut self, file: usize) {
        let Some(path) = self.session.world.files.get(file).map(|file| file.path.clone()) else { return };
        self.files.retain(|file| file.path != path);
        self.unwatch(&path);
        self.loads.forget(&path);
        self.join();
    }

    /// The desktop's dialog, in a thread that waits for it.
    fn open_dialog(&mut self) {
        let proxy = self.proxy.clone();
        std::thread::spawn(move || {
            let dialog = rfd::FileDialog::new().set_title("Open").add_filter("CAD files", ENDINGS);
            if let Some(paths) = dialog.add_filter("All files", &["*"]).pick_files() {
                drop(proxy.send_event(Event::Chosen(paths)));
            }
        });
    }

    fn copy(&mut self, text: String) {
        tracing::info!("copied: {text}");
        self.context.copy_text(text);
        self.ui.tell("Copied.".to_owned());
    }
}

/// Endings of files that are read.
const ENDINGS: &[&str] = &[
    "step", "stp", "stpz", "p21", "iges", "igs", "obj", "stl", "3mf", "amf", "ply", "off", "gltf", "glb", "3dm", "bv",
    "csg", "scad", "asc", "selvedge", "toml", "gz",
];

#[cfg(test)]
mod tests {
    use super::name_copying;
    use egui::{Event, Key, Modifiers, RawInput};

    #[test]
    fn copying_with_shift_is_a_key() {
        let after = |modifiers: Modifiers| {
            let mut input = RawInput { events: vec![Event::Copy], modifiers, ..RawInput::default() };
            name_copying(&mut input);
            input.events.remove(0)
        };
        let held = Modifiers::COMMAND.plus(Modifiers::SHIFT);
        assert!(matches!(after(held), Event::Key { key: Key::C, pressed: true, modifiers, .. } if modifiers == held));
        assert_eq!(after(Modifiers::COMMAND), Event::Copy);
    }
}
