//! Panels without a window: what they say, and what a click does.

use super::*;
use crate::session::Picked;
use crate::session::{Loaded, World};
use std::sync::Arc;

/// Texts of a frame, with where they are.
fn texts(output: &egui::FullOutput) -> Vec<(String, egui::Rect)> {
    fn walk(shape: &egui::Shape, all: &mut Vec<(String, egui::Rect)>) {
        match shape {
            egui::Shape::Text(text) => all.push((text.galley.text().to_owned(), text.visual_bounding_rect())),
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| walk(shape, all)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    output.shapes.iter().for_each(|clipped| walk(&clipped.shape, &mut all));
    all
}

struct Bench {
    ctx: egui::Context,
    ui: Ui,
    session: Session,
    settings: Settings,
    view: View,
}

impl Bench {
    fn new() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        let mut session = Session::default();
        session.open(World::new(&[Arc::new(Loaded { path, import })]));
        session.world.find_edges();
        let (ui, settings, view) = (Ui::default(), Settings::default(), View::default());
        Self { ctx: egui::Context::default(), ui, session, settings, view }
    }

    fn frame(&mut self, events: Vec<egui::Event>) -> Vec<(String, egui::Rect)> {
        let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::Vec2::new(1280.0, 800.0));
        let input = egui::RawInput { screen_rect: Some(screen), events, ..Default::default() };
        let facts = Facts {
            loading: vec![(Path::new("x/big.step"), "faces", Some(0.5))],
            stats: None,
            notice: None,
            busy: false,
            picture: None,
            view: &self.view,
            device: "none",
        };
        let Self { ctx, ui, session, settings, .. } = self;
        let output = ctx.run(input, |ctx| _ = show(ctx, ui, session, settings, &facts));
        texts(&output)
    }

    fn says(&mut self, what: &str) -> bool {
        self.frame(Vec::new());
        self.frame(Vec::new()).iter().any(|(text, _)| text.contains(what))
    }

    fn click(&mut self, what: &str) {
        self.frame(Vec::new());
        let all = self.frame(Vec::new());
        let (_, place) = all.iter().find(|(text, _)| text == what).unwrap_or_else(|| panic!("no {what} in {all:?}"));
        let pos = place.center();
        let button = |pressed| egui::Event::PointerButton {
            pos,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        };
        self.frame(vec![egui::Event::PointerMoved(pos)]);
        self.frame(vec![button(true)]);
        self.frame(vec![button(false)]);
    }
}

#[test]
fn the_tree_names_every_part_and_the_search_finds_one() {
    let mut bench = Bench::new();
    let world = bench.session.world.clone();
    let names: Vec<String> = (0..world.model.instances.len()).map(|i| world.instance_name(i)).collect();
    for name in &names {
        assert!(bench.says(name), "{name}");
    }
    let wanted = names[1].clone();
    bench.ui.search = wanted.to_uppercase();
    let found = bench.frame(Vec::new());
    let listed = |name: &String| found.iter().any(|(text, _)| text == name);
    assert!(listed(&wanted));
    let other = names.iter().find(|n| !n.contains(&wanted)).expect("another name");
    assert!(!listed(other), "{other}");
}

#[test]
fn progress_warnings_and_the_promise_are_told() {
    let mut bench = Bench::new();
    assert!(bench.says("big.step: faces") && bench.says("exact within 0.5 px"));
    bench.click("Cancel");
    assert_eq!(bench.ui.commands, [Command::Cancel]);
}

#[test]
fn a_click_in_the_tree_selects_and_the_panel_says_what_it_is() {
    let mut bench = Bench::new();
    let name = bench.session.world.instance_name(0);
    bench.click(&name);
    assert_eq!(bench.session.selection.len(), 1);
    bench.session.select(Some(Picked::Face { instance: 0, face: 0, uv: glam::DVec2::ZERO }), false);
    let id = bench.session.world.model.parts[bench.session.world.model.instances[0].part].faces[0].id;
    assert!(bench.says(&format!("#{id}")) && bench.says("control points"));
}

#[test]
fn buttons_hide_and_show_again() {
    let mut bench = Bench::new();
    bench.session.select(Some(Picked::Instance(1)), false);
    bench.click("Hide");
    let wishes = std::mem::take(&mut bench.ui.commands);
    assert_eq!(wishes, [Command::Hide]);
    bench.ui.obey(Command::Hide, &mut bench.session);
    assert!(bench.session.scene.now().hidden.contains(&1) && bench.session.selection.is_empty());
    bench.click("Show all");
    bench.ui.obey(Command::ShowAll, &mut bench.session);
    assert!(bench.session.scene.now().hidden.is_empty());
    bench.ui.obey(Command::Undo, &mut bench.session);
    assert!(bench.session.scene.now().hidden.contains(&1));
}

#[test]
fn the_help_has_the_preset_s_buttons_and_every_key() {
    let mut bench = Bench::new();
    assert!(!bench.says("Keys and buttons"));
    bench.click("?");
    bench.ui.obey(Command::Help, &mut bench.session);
    bench.settings.preset = crate::navigation::gesture::Preset::Catia;
    assert!(bench.says("hold middle and click left") && bench.says("open files"));
}
