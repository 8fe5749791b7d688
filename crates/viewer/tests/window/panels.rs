//! The window's panels laid out once more, without a window: where the hand finds their texts.

use super::hand::{Display, Program};
use super::scene::Scene;
use glam::DVec2;
use selvedge_viewer::commands::Command;
use selvedge_viewer::panels::{Facts, Ui, context, show};
use selvedge_viewer::session::Session;
use selvedge_viewer::settings::Settings;
use selvedge_viewer::view::View;
use std::path::Path;
use std::sync::Arc;

/// Frames until a menu or a dialog has its place.
const FRAMES: usize = 4;

/// Panels that have seen what those of the window have seen.
pub struct Panels {
    ctx: egui::Context,
    pub ui: Ui,
    pub session: Session,
    settings: Settings,
    view: View,
    size: (u32, u32),
    /// A file is being read.
    pub reads: bool,
}

impl Panels {
    /// Those of a window of this size with a scene, in which nothing was clicked yet.
    pub fn new(scene: &Scene, size: (u32, u32)) -> Self {
        let mut session = Session::default();
        session.open(Arc::clone(&scene.world));
        let (mut view, settings) = (View::default(), Settings::default());
        view.resize(scene.camera.size);
        let mut panels = Self { ctx: context(), ui: Ui::default(), session, settings, view, size, reads: false };
        panels.texts();
        let (rect, _) = panels.frame(Vec::new());
        let (corner, end) = (scene.corner, DVec2::new(f64::from(rect.max.x), f64::from(rect.max.y)).round());
        let place = (f64::from(rect.min.x).round(), f64::from(rect.min.y).round());
        let size = DVec2::new(f64::from(scene.camera.size.0), f64::from(scene.camera.size.1));
        assert_eq!((place, end), ((corner.x, corner.y), corner + size), "other panels than those of the window");
        panels
    }

    /// The picture's place, and the texts with theirs.
    fn frame(&mut self, events: Vec<egui::Event>) -> (egui::Rect, Vec<(String, egui::Rect)>) {
        let size = egui::Vec2::new(self.size.0 as f32, self.size.1 as f32);
        let screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size));
        let input = egui::RawInput { screen_rect, events, ..Default::default() };
        let Self { ctx, ui, session, settings, view, .. } = self;
        let loading = self.reads.then_some((Path::new(""), "", None)).into_iter().collect();
        let facts = Facts { loading, stats: None, notice: None, busy: false, picture: None, view, device: "" };
        let mut rect = egui::Rect::NOTHING;
        let output = ctx.run(input, |ctx| rect = show(ctx, ui, session, settings, &facts));
        let mut texts = Vec::new();
        output.shapes.iter().for_each(|clipped| walk(&clipped.shape, &mut texts));
        (rect, texts)
    }

    /// Texts once everything has its place.
    fn texts(&mut self) -> Vec<(String, egui::Rect)> {
        let mut texts = Vec::new();
        for _ in 0..FRAMES {
            (_, texts) = self.frame(Vec::new());
        }
        texts
    }

    /// Where the `nth` of equal texts is.
    pub fn find(&mut self, what: &str, nth: usize) -> DVec2 {
        let all = self.texts();
        let found = all.iter().filter(|(text, _)| text == what).nth(nth);
        let (_, rect) = found.unwrap_or_else(|| panic!("no {what} in {all:?}"));
        let centre = rect.center();
        DVec2::new(f64::from(centre.x), f64::from(centre.y)).round()
    }

    /// Carries out a command that a key of the window has given.
    pub fn obey(&mut self, command: Command) {
        self.ui.obey(command, &mut self.session);
    }

    /// Clicks on a text, in the window and here.
    pub fn click(&mut self, display: &Display, program: &mut Program, what: &str, nth: usize) {
        let at = self.find(what, nth);
        // the window knows what is under the cursor before the button goes down
        display.move_to(at);
        program.settle();
        display.click(at);
        program.settle();
        let pos = egui::Pos2::new(at.x as f32, at.y as f32);
        let button = |pressed| egui::Event::PointerButton {
            pos,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        };
        for event in [egui::Event::PointerMoved(pos), button(true), button(false)] {
            self.frame(vec![event]);
        }
        for command in std::mem::take(&mut self.ui.commands) {
            self.obey(command);
        }
    }

    /// Writes another text into the field that shows `what`, in the window alone.
    pub fn write(&mut self, display: &Display, program: &mut Program, what: &str, text: &str) {
        self.click(display, program, what, 0);
        display.key("ctrl+a");
        display.xdotool(&format!("type --delay 30 {text}"));
        program.settle();
    }
}

fn walk(shape: &egui::Shape, all: &mut Vec<(String, egui::Rect)>) {
    match shape {
        egui::Shape::Text(text) => all.push((text.galley.text().to_owned(), text.visual_bounding_rect())),
        egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| walk(shape, all)),
        _ => {}
    }
}
