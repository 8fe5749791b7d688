//! Panels without a window: their texts, and the effects of clicks.

mod by_keys;
mod facts;
mod trust;

use super::*;
use crate::pick::Hit;
use crate::session::{Loaded, Picked, PointKind, World};
use crate::view::Hover;
use std::sync::Arc;
use std::time::Instant;

/// Texts of a frame, with their places.
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
    rect: egui::Rect,
    /// Held in each frame.
    modifiers: egui::Modifiers,
    /// The accessibility information of the widget that got the keys in the last frame, if egui has any.
    heard: Option<egui::WidgetInfo>,
    /// The time until the panels want another frame.
    delay: std::time::Duration,
    /// Of the last picture.
    stats: Option<FrameStats>,
    /// What the engine says of the model.
    notice: Option<&'static str>,
    /// Red dots of the last frame.
    dots: Vec<egui::Pos2>,
}

impl Bench {
    fn new() -> Self {
        Self::of("assembly.step")
    }

    /// Of a sample.
    fn of(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
        let import = selvedge_io::import::open(&path).expect("a sample");
        let mut session = Session::default();
        session.open(World::new(&[Arc::new(Loaded { path, import, partial: false })]));
        session.world.find_edges();
        let (ui, settings, view) = (Ui::default(), Settings::default(), View::default());
        Self {
            ctx: context(),
            ui,
            session,
            settings,
            view,
            rect: egui::Rect::NOTHING,
            modifiers: egui::Modifiers::NONE,
            heard: None,
            delay: std::time::Duration::ZERO,
            stats: None,
            notice: None,
            dots: Vec::new(),
        }
    }

    fn frame(&mut self, events: Vec<egui::Event>) -> Vec<(String, egui::Rect)> {
        let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::Vec2::new(1280.0, 800.0));
        let input =
            egui::RawInput { screen_rect: Some(screen), events, modifiers: self.modifiers, ..Default::default() };
        let facts = Facts {
            loading: vec![(Path::new("x/big.step"), "faces", Some(0.5))],
            stats: self.stats.as_ref(),
            notice: self.notice,
            busy: false,
            picture: None,
            view: &self.view,
            device: "none",
        };
        let Self { ctx, ui, session, settings, rect, .. } = self;
        let output = ctx.run(input, |ctx| *rect = show(ctx, ui, session, settings, &facts));
        self.delay = output.viewport_output[&egui::ViewportId::ROOT].repaint_delay;
        // the last one has all that was added to the widget
        self.heard = output.platform_output.events.iter().rev().find_map(|event| match event {
            egui::output::OutputEvent::FocusGained(info) => Some(info.clone()),
            _ => None,
        });
        let dots = output.shapes.iter().filter_map(|clipped| match &clipped.shape {
            egui::Shape::Circle(circle) if circle.fill == egui::Color32::RED => Some(circle.center),
            _ => None,
        });
        self.dots = dots.collect();
        texts(&output)
    }

    fn says(&mut self, what: &str) -> bool {
        self.frame(Vec::new());
        self.frame(Vec::new()).iter().any(|(text, _)| text.contains(what))
    }

    /// Where a point of the model is, once the view has the size of its panel.
    fn place(&mut self, p: DVec3) -> egui::Pos2 {
        for _ in 0..3 {
            self.frame(Vec::new());
            self.view.resize((self.rect.width() as u32, self.rect.height() as u32));
        }
        self.view.set_bounds(self.session.world.bounds);
        self.view.reset(Instant::now());
        let (pixel, _) = self.view.camera().project(p).expect("in front");
        self.rect.min + egui::Vec2::new(pixel.x as f32, pixel.y as f32)
    }

    /// A drag with the left button.
    fn drag(&mut self, from: egui::Pos2, by: egui::Vec2) {
        let button = |pos, pressed| egui::Event::PointerButton {
            pos,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        };
        self.frame(vec![egui::Event::PointerMoved(from)]);
        self.frame(vec![egui::Event::PointerMoved(from)]);
        self.frame(vec![button(from, true)]);
        for i in 1..=4 {
            self.frame(vec![egui::Event::PointerMoved(from + by * (i as f32 / 4.0))]);
        }
        self.frame(vec![button(from + by, false)]);
    }

    /// A key that goes down.
    fn press(&mut self, key: egui::Key) -> Vec<(String, egui::Rect)> {
        let modifiers = self.modifiers;
        self.frame(vec![egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }])
    }

    /// Presses Tab until something of this size in the picture has the keys: boxes of the tree are as large as handles.
    fn tab_to(&mut self, size: egui::Vec2) {
        for _ in 0..1000 {
            self.press(egui::Key::Tab);
            let focused = self.ctx.memory(|memory| memory.focused());
            let rect = focused.and_then(|id| self.ctx.read_response(id)).map(|response| response.rect);
            let is_in_picture = |rect: &egui::Rect| self.rect.contains(rect.center());
            if rect.filter(is_in_picture).is_some_and(|rect| (rect.size() - size).length() < 0.1) {
                // only what had the keys a frame before keeps the arrows
                (0..2).for_each(|_| _ = self.frame(Vec::new()));
                return;
            }
        }
        panic!("Tab leads to nothing of {size} in the picture");
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
fn the_tree_jumps_to_what_is_selected_in_the_picture() {
    let path = Path::new("long.step").to_owned();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step");
    let mut import = selvedge_io::import::open(&sample).expect("a sample");
    let one = import.model.instances[0].clone();
    let named = |i: usize| selvedge::model::Instance { name: format!("item {i} of many"), ..one.clone() };
    import.model.instances = (0..400).map(named).collect();
    let mut bench = Bench::new();
    bench.session.open(World::new(&[Arc::new(Loaded { path, import, partial: false })]));
    assert!(bench.says("item 0 of many") && !bench.says("item 250 of many"));
    let picked = Picked::Face { instance: 250, face: 0, uv: glam::DVec2::ZERO };
    bench.session.select(Some(picked), false);
    bench.ui.selected(&bench.session, None);
    // a second, in which it scrolls there
    (0..60).for_each(|_| drop(bench.frame(Vec::new())));
    let all = bench.frame(Vec::new());
    let has = |what: &str| all.iter().any(|(text, _)| text == what);
    assert!(has("item 250 of many") && !has("item 0 of many"), "it did not scroll: {all:?}");
    // once: the hand may scroll elsewhere
    assert!(!bench.ui.show_selection);
}

#[test]
fn progress_warnings_and_the_promise_are_shown() {
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
fn the_row_under_the_pointer_points_at_its_part() {
    let mut bench = Bench::new();
    let name = bench.session.world.instance_name(1);
    bench.frame(Vec::new());
    let all = bench.frame(Vec::new());
    let nth = usize::from(bench.session.world.instance_name(0) == name);
    let (_, row) = all.iter().filter(|(text, _)| *text == name).nth(nth).expect("a row");
    let (row, away) = (row.center(), egui::Pos2::new(640.0, 400.0));
    for (place, pointed) in [(row, Some(1)), (away, None)] {
        // a widget is hovered in the frame after that of the move
        (0..2).for_each(|_| drop(bench.frame(vec![egui::Event::PointerMoved(place)])));
        assert_eq!(bench.ui.pointed, pointed, "{place}");
    }
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
fn a_picture_is_written_or_copied_from_one_dialog() {
    let mut bench = Bench::new();
    bench.ui.obey(Command::Screenshot, &mut bench.session);
    bench.click("Copy");
    bench.click("Write");
    assert_eq!(bench.ui.commands, [Command::CopyPicture, Command::WritePicture]);
}

#[test]
fn the_help_has_the_preset_s_buttons_and_every_key() {
    let mut bench = Bench::new();
    assert!(!bench.says("Keys and buttons"));
    bench.click("?");
    bench.ui.obey(Command::Help, &mut bench.session);
    bench.settings.preset = crate::navigation::gesture::Preset::Catia;
    assert!(bench.says("hold middle and click left") && bench.says("P, then left click on both"));
    // rows out of sight are not drawn: the wheel brings them into it
    let mut said = bench.frame(Vec::new());
    let (_, first) = said.iter().find(|(text, _)| text == "open files").expect("the first key");
    let pos = first.center();
    for _ in 0..200 {
        let (unit, delta) = (egui::MouseWheelUnit::Point, egui::Vec2::new(0.0, -6.0));
        let wheel = egui::Event::MouseWheel { unit, delta, modifiers: egui::Modifiers::NONE };
        said.extend(bench.frame(vec![egui::Event::PointerMoved(pos), wheel]));
    }
    for shortcut in commands::shortcuts() {
        for wanted in [shortcut.label(), shortcut.what.to_owned()] {
            assert!(said.iter().any(|(text, _)| *text == wanted), "{wanted}");
        }
    }
}

/// Two points of the first part with a round edge: its centre, and a corner.
fn two_points(world: &World) -> [Picked; 2] {
    let round = |placed: &selvedge::model::Instance| world.centres_of(placed.part).first().copied();
    let mut instances = world.model.instances.iter().enumerate();
    let first = instances.find_map(|(instance, placed)| Some((instance, round(placed)?)));
    let (instance, (of, at)) = first.expect("a round edge");
    [Picked::Point { instance, kind: PointKind::Centre, of, at }, Picked::Vertex { instance, vertex: 0 }]
}

#[test]
fn a_point_under_the_cursor_is_named_beside_it() {
    let mut bench = Bench::new();
    let [centre, corner] = two_points(&bench.session.world);
    for (picked, name) in [(centre, "centre"), (corner, "vertex")] {
        let place = bench.place(bench.session.world.point_of(&picked).expect("a point"));
        let mut beside = |filter: PickFilter| {
            bench.ui.filter = filter;
            let hit = Hit { picked: Some(picked), point: None };
            bench.view.hover = Some(Hover { cursor: glam::DVec2::ZERO, hit });
            let texts = bench.frame(Vec::new());
            texts.iter().find(|(text, _)| text == name).map(|(_, rect)| rect.center().distance(place))
        };
        assert_eq!(beside(PickFilter::Any), None);
        let away = beside(PickFilter::Points).expect(name);
        assert!(away < 60.0, "{name} is {away} points from its point");
        assert!(bench.says(&format!("{name} ")), "the status line says of what");
    }
}

#[test]
fn two_points_are_measured_listed_and_copied() {
    let mut bench = Bench::new();
    bench.click("Points");
    assert_eq!(std::mem::take(&mut bench.ui.commands), [Command::Points]);
    bench.ui.obey(Command::Points, &mut bench.session);
    assert!(bench.ui.filter == PickFilter::Points && bench.says("Click two points"));
    let points = two_points(&bench.session.world);
    let [from, to] = points.map(|p| bench.session.world.point_of(&p).expect("a point"));
    for picked in points {
        bench.session.select_point(Some(picked), false);
        bench.ui.selected(&bench.session, None);
    }
    assert!(std::mem::take(&mut bench.ui.wants_measure) && bench.session.selection == points);
    bench.ui.measured(crate::measure::measure(&bench.session.world, &points));
    bench.place(from);
    let along = (to - from).to_array().map(crate::describe::number);
    let [x, y, z] = &along;
    assert!(bench.says(&format!("dx {x}  dy {y}  dz {z}")), "the dimension in the picture");
    assert!(bench.says("along x") && bench.says(&format!("{x} mm")), "the panel");
    bench.ui.obey(Command::Measure, &mut bench.session);
    bench.click("Copy CSV");
    let [Command::CopyText(text)] = &bench.ui.commands[..] else { panic!("{:?}", bench.ui.commands) };
    assert!(text.contains(&format!(",along y,{},", (to - from).y)), "{text}");
    bench.ui.obey(Command::Points, &mut bench.session);
    assert_eq!(bench.ui.filter, PickFilter::Any);
}

#[test]
fn the_list_of_kept_measurements_has_an_end() {
    let mut bench = Bench::new();
    let points = two_points(&bench.session.world);
    let first = crate::measure::measure(&bench.session.world, &points[..1]).expect("a point");
    bench.ui.measured(Some(first.clone()));
    bench.ui.obey(Command::Measure, &mut bench.session);
    assert_eq!(bench.ui.kept[0].title, first.title);
    bench.ui.measured(crate::measure::measure(&bench.session.world, &points));
    (0..MOST_KEPT).for_each(|_| bench.ui.obey(Command::Measure, &mut bench.session));
    assert!(bench.ui.kept.len() == MOST_KEPT && bench.ui.kept[0].title != first.title, "the oldest one goes");
}

#[test]
fn a_section_follows_its_handle_and_is_undone_as_one() {
    let mut bench = Bench::new();
    bench.modifiers = egui::Modifiers::COMMAND; // the plane snaps to no face
    let bounds = bench.session.world.bounds;
    let section = crate::session::Section::across(DVec3::X, bounds);
    bench.session.scene.change(|state| state.sections.push(section));
    let from = bench.place(bounds.centre());
    let to = bench.place(bounds.centre() + DVec3::X * 10.0);
    bench.drag(from, to - from);
    let moved = bench.session.scene.now().sections[0].offset - section.offset;
    // perspective: the arrow is nearer at its tip
    assert!((moved - 10.0).abs() < 1.5, "{moved}");
    assert!(bench.session.scene.undo() && bench.session.scene.now().sections[0] == section);
}

/// The side of the gusset, four millimetres from the middle.
#[test]
fn a_dragged_plane_stops_just_below_a_face_unless_ctrl_is_held() {
    let mut bench = Bench::of("bracket.step");
    let bounds = bench.session.world.bounds;
    let (face, below) = (4.0, crate::session::Section::BELOW * bounds.diagonal());
    let section = crate::session::Section { normal: DVec3::Y, offset: face + 4.0, on: true };
    bench.session.scene.change(|state| state.sections.push(section));
    let foot = |offset: f64| DVec3::new(bounds.centre().x, offset, bounds.centre().z);
    let (from, to) = (bench.place(foot(section.offset)), bench.place(foot(face)));
    for (modifiers, stops) in [(egui::Modifiers::NONE, true), (egui::Modifiers::COMMAND, false)] {
        bench.modifiers = modifiers;
        bench.drag(from, to - from);
        let offset = bench.session.scene.now().sections[0].offset;
        // the hand is there but for perspective, which is no tenth of the way
        assert!((offset - face).abs() < 0.4, "{offset}");
        // a thousandth of the distance below the face
        assert_eq!((offset + below - face).abs() < 1e-3 * below, stops, "{offset}");
        assert!(bench.session.scene.undo() && bench.session.scene.now().sections[0] == section);
    }
}

#[test]
fn a_trim_point_follows_the_hand_on_its_surface() {
    let mut bench = Bench::new();
    let world = bench.session.world.clone();
    let instance = 0;
    let part = world.model.instances[instance].part;
    let seen = |f: &&selvedge::model::Face| !f.loops.is_empty() && f.loops[0].curves().len() < 8;
    let face = world.model.parts[part].faces.iter().position(|f| seen(&f)).expect("a trimmed face");
    let of_face = &world.model.parts[part].faces[face];
    let before = of_face.loops[0].curves().next().expect("a curve").point(0.0);
    let inside = before.lerp(of_face.loops[0].curves().nth(2).expect("a curve").point(0.0), 0.1);
    let point =
        |uv: glam::DVec2| world.model.instances[instance].transform.transform_point3(of_face.surface.point(uv.x, uv.y));
    bench.session.select(Some(Picked::Face { instance, face, uv: before }), false);
    bench.ui.trims = true;
    let (from, to) = (bench.place(point(before)), bench.place(point(inside)));
    bench.drag(from, to - from);
    // of points at one place in the picture the upper one is gripped
    let camera = *bench.view.camera();
    let corner = bench.rect.min;
    let nearest = |trim_loop: &selvedge::model::TrimLoop| {
        let points = trim_loop.curves().flat_map(|curve| curve.points).map(|p| point(p.truncate() / p.z));
        let pixels = points
            .filter_map(|p| camera.project(p))
            .map(|(pixel, _)| (corner + egui::Vec2::new(pixel.x as f32, pixel.y as f32)).distance(to));
        pixels.fold(f32::INFINITY, f32::min)
    };
    let edits = &bench.session.scene.now().edits;
    let (far, near) = (nearest(&of_face.loops[0]), nearest(&edits[&(part, face, 0)]));
    assert!(far > 2.0 && near < 0.5, "{near} pixels from the hand, {far} before");
    assert!(bench.session.scene.undo() && bench.session.scene.now().edits.is_empty());
}

#[test]
fn a_click_chooses_the_loop_beside_it_and_the_list_another() {
    let mut bench = Bench::of("panel.step");
    let world = bench.session.world.clone();
    let (instance, face) = (0, 0);
    let loops = &world.model.parts[world.model.instances[instance].part].faces[face].loops;
    let chosen = |bench: &Bench| bench.ui.chosen.map(|chosen| chosen.trim_loop);
    bench.ui.trims = true;
    for nth in [2, 1] {
        let uv = loops[nth].curves().next().expect("a curve").point(0.4);
        bench.session.select(Some(Picked::Face { instance, face, uv }), false);
        assert!(bench.says(&format!("Trim loop {} of {}", nth + 1, loops.len())));
        assert_eq!(chosen(&bench), Some(nth));
    }
    let points: usize = loops[0].curves().map(|curve| curve.degree()).sum();
    bench.click(&format!("Loop 1: {points} points"));
    assert!(bench.says(&format!("Trim loop 1 of {}", loops.len())));
    assert_eq!(chosen(&bench), Some(0));
    bench.ui.obey(Command::Trims, &mut bench.session);
    assert!(!bench.says("Trim loop") && chosen(&bench).is_none());
}
