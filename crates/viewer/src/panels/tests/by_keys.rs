//! Panels by keys alone: everything is reached, has a name for those who do not see it, and is used.

use super::*;
use egui::{WidgetInfo, WidgetType};

/// Presses of Tab in one round at most.
const MOST_STOPS: usize = 2000;
/// Bars and areas of panels that the mouse drags, such as those of scrolling, are at least so long, points. Tab leads to
/// them, too, and egui has no information of them.
const GRIP: f32 = 100.0;

impl Bench {
    /// The next stop of Tab.
    fn tab(&mut self) -> egui::Id {
        self.press(egui::Key::Tab);
        let focused = |bench: &Self| bench.ctx.memory(|memory| memory.focused());
        if focused(self).is_none() {
            // from the last stop to the first one
            self.frame(Vec::new());
        }
        focused(self).expect("something has the keys")
    }

    /// One round of Tab: the information of each stop that has some, and the places of the others.
    fn round(&mut self) -> (Vec<WidgetInfo>, Vec<egui::Rect>) {
        (0..3).for_each(|_| drop(self.frame(Vec::new())));
        let (mut stops, mut heard, mut silent) = (Vec::new(), Vec::new(), Vec::new());
        while stops.len() < MOST_STOPS {
            let stop = self.tab();
            if stops.contains(&stop) {
                return (heard, silent);
            }
            stops.push(stop);
            let rect = self.ctx.read_response(stop).map_or(egui::Rect::NOTHING, |response| response.rect);
            match self.heard.take() {
                Some(info) => heard.push(info),
                None => silent.push(rect),
            }
        }
        panic!("Tab leads to {} stops, and not back", stops.len());
    }

    /// Leads the keys to a widget of this kind and name.
    fn lead_to(&mut self, kind: WidgetType, name: &str) {
        for _ in 0..MOST_STOPS {
            self.tab();
            if self.heard.take().is_some_and(|info| info.typ == kind && info.label.as_deref() == Some(name)) {
                return;
            }
        }
        panic!("Tab leads to no {kind:?} {name}");
    }
}

/// Whether there is a widget of this kind and name.
fn has(heard: &[WidgetInfo], kind: WidgetType, name: &str) -> bool {
    heard.iter().any(|info| info.typ == kind && info.label.as_deref() == Some(name))
}

#[test]
fn everything_that_tab_leads_to_has_a_name() {
    let mut bench = Bench::new();
    let world = bench.session.world.clone();
    let part = world.model.instances[0].part;
    let face = world.model.parts[part].faces.iter().position(|f| !f.loops.is_empty()).expect("a trimmed face");
    let uv = world.model.parts[part].faces[face].loops[0].curves().next().expect("a curve").point(0.0);
    let section = crate::session::Section::across(DVec3::X, world.bounds);
    bench.session.scene.change(|state| state.sections.push(section));
    bench.session.select(Some(Picked::Face { instance: 0, face, uv }), false);
    bench.ui.selected(&bench.session, None);
    bench.ui.measured(crate::measure::measure(&world, &bench.session.selection));
    bench.ui.obey(Command::Measure, &mut bench.session);
    bench.ui.trims = true;
    bench.place(world.bounds.centre());
    let (heard, silent) = bench.round();
    assert!(silent.iter().all(|rect| rect.size().max_elem() >= GRIP), "nothing says what is there: {silent:?}");
    let nameless = |info: &&WidgetInfo| info.label.as_ref().is_none_or(|label| label.trim().is_empty());
    let nameless: Vec<String> = heard.iter().filter(nameless).map(WidgetInfo::description).collect();
    assert!(nameless.is_empty(), "{nameless:?}");
    let name = world.instance_name(0);
    let (show, colour) = (format!("Show {name}"), format!("Colour of {name}"));
    let wanted = [
        (WidgetType::Button, "File"),
        (WidgetType::Button, "Help"),
        (WidgetType::ComboBox, "Pick"),
        (WidgetType::Slider, "Explode"),
        (WidgetType::TextEdit, "Find"),
        (WidgetType::TextEdit, "Colour"),
        (WidgetType::Slider, "Handle of section 1"),
        (WidgetType::Other, "Point 1 of curve 1"),
        (WidgetType::Checkbox, show.as_str()),
        (WidgetType::ColorButton, colour.as_str()),
    ];
    for (kind, name) in wanted {
        assert!(has(&heard, kind, name), "no {kind:?} {name}");
    }
    // values, too
    let said = |kind: WidgetType, name: &str| {
        let found = heard.iter().find(|info| info.typ == kind && info.label.as_deref() == Some(name));
        found.map(|info| (info.value, info.selected, info.current_text_value.clone()))
    };
    assert_eq!(said(WidgetType::Slider, "Handle of section 1"), Some((Some(section.offset), None, None)));
    assert_eq!(said(WidgetType::Checkbox, &show), Some((None, Some(true), None)));
    assert_eq!(said(WidgetType::ComboBox, "Pick"), Some((None, None, Some("Anything".to_owned()))));
}

#[test]
fn menus_and_dialogs_have_names_too() {
    let mut bench = Bench::new();
    let section = crate::session::Section::across(DVec3::X, bench.session.world.bounds);
    bench.session.scene.change(|state| state.sections.push(section));
    bench.click("Section");
    let (heard, _) = bench.round();
    for (kind, name) in [(WidgetType::Checkbox, "Section 1"), (WidgetType::Slider, "Section 1")] {
        assert!(has(&heard, kind, name), "no {kind:?} {name}");
    }
    bench.press(egui::Key::Escape);
    bench.ui.commands.clear();
    bench.ui.obey(Command::Screenshot, &mut bench.session);
    bench.ui.obey(Command::SaveAs, &mut bench.session);
    let (heard, _) = bench.round();
    let wanted = [
        (WidgetType::TextEdit, "File"),
        (WidgetType::DragValue, "Width"),
        (WidgetType::DragValue, "Height"),
        (WidgetType::Checkbox, "transparent"),
        (WidgetType::Button, "Write"),
        (WidgetType::Button, "Save"),
    ];
    for (kind, name) in wanted {
        assert!(has(&heard, kind, name), "no {kind:?} {name}");
    }
}

#[test]
fn no_frame_is_due_while_a_text_waits_for_keys() {
    let mut bench = Bench::new();
    bench.lead_to(WidgetType::TextEdit, "Find");
    // a second, in which animations end
    (0..60).for_each(|_| drop(bench.frame(Vec::new())));
    assert_eq!(bench.delay, std::time::Duration::MAX);
}

#[test]
fn parts_are_moved_apart_by_keys_alone() {
    let mut bench = Bench::new();
    bench.lead_to(WidgetType::Slider, "Explode");
    // only what had the keys a frame before keeps the arrows
    (0..2).for_each(|_| drop(bench.frame(Vec::new())));
    bench.press(egui::Key::ArrowRight);
    let explosion = bench.session.scene.now().explosion;
    assert!(explosion > 0.0 && bench.ui.commands.is_empty(), "{explosion}, and {:?}", bench.ui.commands);
    assert!(bench.session.scene.undo() && bench.session.scene.now().explosion == 0.0);
}

#[test]
fn a_part_gets_a_colour_by_keys_alone() {
    let mut bench = Bench::new();
    bench.session.scene.change(|state| _ = state.colours.insert(1, [0.0, 0.0, 0.0, 0.25]));
    bench.session.select(Some(Picked::Instance(1)), false);
    let colour = |bench: &Bench| bench.session.scene.now().colours[&1];
    // into the field, in place of the text that stands there
    let write = |bench: &mut Bench, text: &str, end: egui::Key| {
        bench.lead_to(WidgetType::TextEdit, "Colour");
        bench.frame(Vec::new());
        bench.press(egui::Key::End);
        (0.."#000000".len()).for_each(|_| drop(bench.press(egui::Key::Backspace)));
        bench.frame(vec![egui::Event::Text(text.to_owned())]);
        bench.press(end);
    };
    write(&mut bench, "#ff0080", egui::Key::Enter);
    let [red, green, blue, opacity] = colour(&bench);
    // 128 of 255 in sRGB
    assert!(red == 1.0 && green == 0.0 && (blue - 0.21586).abs() < 1e-4 && opacity == 0.25, "{:?}", colour(&bench));
    assert!(bench.ui.commands.is_empty(), "keys of the text are no commands");

    let before = colour(&bench);
    write(&mut bench, "no", egui::Key::Enter);
    assert!(
        colour(&bench) == before && bench.ui.messages.last().is_some_and(|told| told.contains("`no` is no colour"))
    );
    write(&mut bench, "#00ff00", egui::Key::Escape);
    assert!(colour(&bench) == before, "it was given up");
    bench.ui.commands.clear();
    assert!(bench.session.scene.undo() && colour(&bench) == [0.0, 0.0, 0.0, 0.25], "one change");
}

#[test]
fn arrow_keys_move_handles_that_tab_leads_to() {
    let mut bench = Bench::new();
    let world = bench.session.world.clone();
    let part = world.model.instances[0].part;
    let face = world.model.parts[part].faces.iter().position(|f| !f.loops.is_empty()).expect("a trimmed face");
    let before = world.model.parts[part].faces[face].loops[0].curves().next().expect("a curve").point(0.0);
    bench.session.select(Some(Picked::Face { instance: 0, face, uv: before }), false);
    bench.ui.trims = true;
    bench.place(world.bounds.centre());
    bench.tab_to(egui::Vec2::splat(12.0));
    let camera = *bench.view.camera();
    bench.press(egui::Key::ArrowDown);
    assert_eq!(bench.session.scene.now().edits.keys().copied().collect::<Vec<_>>(), [(part, face, 0)]);
    assert!(bench.ui.commands.is_empty() && *bench.view.camera() == camera, "the view stands still");
    assert!(bench.session.scene.undo() && bench.session.scene.now().edits.is_empty());
    bench.ui.trims = false;

    let section = crate::session::Section::across(DVec3::X, world.bounds);
    bench.session.scene.change(|state| state.sections.push(section));
    bench.tab_to(egui::Vec2::splat(18.0));
    bench.press(egui::Key::ArrowRight);
    let offset = |bench: &Bench| bench.session.scene.now().sections[0].offset;
    let step = offset(&bench) - section.offset;
    assert!(step > 0.0, "{step}");
    bench.modifiers = egui::Modifiers::SHIFT;
    bench.press(egui::Key::ArrowLeft);
    let back = section.offset + step - offset(&bench);
    // the arrow of the moved plane is as long but for perspective
    assert!((back / step - 10.0).abs() < 0.5, "{back} after {step}");
    assert!(bench.ui.commands.is_empty(), "{:?}", bench.ui.commands);
}

#[test]
fn menus_open_and_choose_by_keys_alone() {
    let mut bench = Bench::new();
    bench.press(egui::Key::Tab);
    assert!(!bench.says("Open..."));
    bench.press(egui::Key::Enter);
    assert!(bench.says("Open..."), "the first menu is open");
    // the menu itself, then its first entry
    (0..2).for_each(|_| _ = bench.press(egui::Key::Tab));
    bench.frame(Vec::new());
    bench.press(egui::Key::Enter);
    assert_eq!(bench.ui.commands, [Command::OpenDialog]);
    assert!(!bench.says("Open..."));
}

#[test]
fn a_dialog_is_used_by_keys_alone() {
    let mut bench = Bench::new();
    bench.ui.obey(Command::Screenshot, &mut bench.session);
    (0..3).for_each(|_| drop(bench.frame(Vec::new())));
    bench.frame(vec![egui::Event::Text("2".to_owned())]);
    assert_eq!(bench.ui.shot.path, Path::new("view.png2"), "its text takes the keys");
    assert_eq!(bench.ui.commands, []);
    bench.press(egui::Key::Enter);
    assert_eq!(std::mem::take(&mut bench.ui.commands), [Command::WritePicture]);
    // the first one is open still, and Enter is the second one's
    bench.ui.obey(Command::SaveAs, &mut bench.session);
    (0..3).for_each(|_| drop(bench.frame(Vec::new())));
    bench.press(egui::Key::Enter);
    assert_eq!(std::mem::take(&mut bench.ui.commands), [Command::Save]);
    bench.press(egui::Key::Escape);
    for command in std::mem::take(&mut bench.ui.commands) {
        bench.ui.obey(command, &mut bench.session);
    }
    assert!(bench.ui.save.is_none() && !bench.ui.shot.open);
}

#[test]
fn keys_select_one_face_after_another_and_give_colours_back() {
    let mut bench = Bench::new();
    bench.press(egui::Key::N);
    for command in std::mem::take(&mut bench.ui.commands) {
        bench.ui.obey(command, &mut bench.session);
    }
    assert!(matches!(bench.session.selection[..], [Picked::Face { instance: 0, face: 0, .. }]));
    assert!(bench.ui.wants_measure && bench.says("control points"));
    bench.session.scene.change(|state| _ = state.colours.insert(0, [1.0; 4]));
    bench.ui.obey(Command::OwnColours, &mut bench.session);
    assert!(bench.session.scene.now().colours.is_empty());
}
