//! Opens the window and its device, and closes both.

use super::app::{App, Event, Opened};
use super::context::DeviceOptions;
use super::engine::Engine;
use super::screen::Screen;
use super::waiter::Waiter;
use super::{Closed, ViewError, ViewOptions};
use crate::desktop;
use crate::navigation::gesture::Held;
use std::sync::Arc;
use std::time::Duration;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

/// How often a lost device is tried to be opened again, and the pause between: drivers reset a device within seconds.
const TRIES: u32 = 10;
const PAUSE: Duration = Duration::from_millis(500);

impl App {
    /// Opens the window, begins to read the files, and opens the device.
    pub fn open_window(&mut self, events: &ActiveEventLoop) -> Result<(), ViewError> {
        let mut attributes = Window::default_attributes().with_title("selvedge");
        if let Some((width, height)) = self.options.size {
            attributes = attributes.with_inner_size(winit::dpi::LogicalSize::new(width, height));
        }
        let window = events.create_window(attributes).map_err(|e| ViewError::Window(e.to_string()))?;
        let window = Arc::new(window);
        let scale = Some(window.scale_factor() as f32);
        let root = egui::ViewportId::ROOT;
        let input = egui_winit::State::new(self.context.clone(), root, &window, scale, window.theme(), None);
        self.watch_panels();
        // threads read while the device is opened
        for file in std::mem::take(&mut self.options.files) {
            self.load(file);
        }
        let (waiter, engine, screen) = self.open_device(&window)?;
        tracing::info!("window on {} after {:.0?}", screen.context.name, self.begun.elapsed());
        self.opened = Some(Opened { window, input, waiter, engine, screen });
        if let Some(folder) = self.options.desktop.take() {
            let proxy = self.proxy.clone();
            std::thread::spawn(move || {
                if desktop::reduces_motion(&folder) {
                    drop(proxy.send_event(Event::LessMotion));
                }
                if let Some(dark) = desktop::is_dark(&folder) {
                    drop(proxy.send_event(Event::Dark(dark)));
                }
            });
        }
        self.redraw();
        Ok(())
    }

    /// Panels that move draw themselves again.
    pub fn watch_panels(&self) {
        let proxy = self.proxy.clone();
        self.context.set_request_repaint_callback(move |info| {
            if info.delay.is_zero() {
                drop(proxy.send_event(Event::Repaint));
            }
        });
    }

    /// Opens the device, with a renderer on it.
    pub fn open_device(&mut self, window: &Window) -> Result<(Waiter, Engine, Screen), ViewError> {
        let ViewOptions { device, validation, .. } = &self.options;
        let options = DeviceOptions { device: device.clone(), validation: *validation };
        let screen = Screen::new(window, &options)?;
        let engine = Engine::new(screen.renderer()?);
        self.devices += 1;
        let (proxy, device) = (self.proxy.clone(), self.devices);
        let done = move |result| drop(proxy.send_event(Event::FrameDone(device, result)));
        Ok((Waiter::new(screen.context.device.clone(), done), engine, screen))
    }

    /// The system takes the surface until it resumes the program. The device with the scene, the view and the selection
    /// stay.
    pub fn suspend(&mut self) {
        let Some(opened) = &mut self.opened else { return };
        opened.screen.suspend();
        (self.due, self.wake) = (false, None);
        // the system reports no release of what is held
        self.held = Held::default();
        self.view.release();
        tracing::info!("suspended");
    }

    /// Goes on after [`suspend`](Self::suspend).
    pub fn resume(&mut self) -> Result<(), ViewError> {
        let Some(Opened { window, screen, .. }) = &mut self.opened else { return Ok(()) };
        if screen.is_suspended() {
            screen.resume(window)?;
            tracing::info!("resumed");
            self.redraw();
        }
        Ok(())
    }

    /// Imitates a system that suspends the program for a while.
    pub fn suspend_for(&mut self, time: Duration) {
        self.suspend();
        let proxy = self.proxy.clone();
        std::thread::spawn(move || {
            std::thread::sleep(time);
            drop(proxy.send_event(Event::Resumed));
        });
    }

    /// Makes all objects of the device again, after it was lost. The window, the session and the view stay.
    pub fn reopen_device(&mut self) -> Result<(), ViewError> {
        let Some(Opened { window, input, waiter, mut engine, screen }) = self.opened.take() else { return Ok(()) };
        engine.wait();
        screen.context.wait();
        drop((waiter, engine, input));
        self.messages.extend(screen.shutdown());
        let (waiter, engine, screen) = self.open_lost_device(&window)?;
        // the textures of the panels are gone: a new context sends them again
        self.context = crate::panels::context();
        self.watch_panels();
        let (root, scale) = (egui::ViewportId::ROOT, Some(window.scale_factor() as f32));
        let mut input = egui_winit::State::new(self.context.clone(), root, &window, scale, window.theme(), None);
        // the system reports changes of the focus, not the focus that a new window has
        input.egui_input_mut().focused = window.has_focus();
        self.opened = Some(Opened { window, input, waiter, engine, screen });
        self.forget_frames();
        tracing::info!("the device is open again");
        self.ui.tell("The device was lost and is open again.".to_owned());
        self.redraw();
        Ok(())
    }

    /// Opens the device, again and again while its driver resets it.
    fn open_lost_device(&mut self, window: &Window) -> Result<(Waiter, Engine, Screen), ViewError> {
        for _ in 1..TRIES {
            match self.open_device(window) {
                Err(error) if error.is_of_device() => tracing::warn!("the device cannot be opened yet: {error}"),
                opened => return opened,
            }
            std::thread::sleep(PAUSE);
        }
        self.open_device(window)
    }

    /// Frees everything.
    pub fn close(mut self) -> Result<Closed, ViewError> {
        self.loads.give_up();
        if let Some(Opened { window, input, waiter, mut engine, screen }) = self.opened.take() {
            engine.wait();
            screen.context.wait();
            drop((waiter, engine, input));
            self.messages.extend(screen.shutdown());
            drop(window);
        }
        match self.failed {
            Some(error) => Err(error),
            None => Ok(Closed { messages: self.messages }),
        }
    }
}
