//! The row of menus and buttons above the picture.

use super::{Facts, Ui};
use crate::commands::Command;
use crate::measure::cut;
use crate::navigation::OrbitStyle;
use crate::navigation::gesture::Preset;
use crate::navigation::standard::StandardView;
use crate::pick::PickFilter;
use crate::session::shown::MOST_SECTIONS;
use crate::session::{Section, Session};
use crate::settings::{Lines, Settings, Theme};
use egui::{WidgetInfo, WidgetType};
use glam::DVec3;
use selvedge::picture::Style;

/// Shows it.
pub fn show(panel: &mut egui::Ui, ui: &mut Ui, session: &mut Session, settings: &mut Settings, facts: &Facts<'_>) {
    panel.horizontal_wrapped(|row| {
        row.menu_button("File", |menu| file(menu, ui, session, settings));
        row.menu_button("View", |menu| views(menu, ui, facts));
        row.menu_button("Style", |menu| style(menu, ui, settings));
        row.menu_button("Section", |menu| sections(menu, ui, session));
        row.menu_button("Settings", |menu| choices(menu, settings));
        row.separator();
        if row.button("Fit").on_hover_text("All in view (Home)").clicked() {
            ui.commands.push(Command::Fit);
        }
        let projection = if facts.view.is_parallel() { "Parallel" } else { "Perspective" };
        if row.button(projection).on_hover_text("The other projection (5)").clicked() {
            ui.commands.push(Command::Projection);
        }
        row.separator();
        row.label("Pick");
        let kinds = egui::ComboBox::from_id_salt("filter").selected_text(ui.filter.name()).width(80.0);
        let kinds = kinds.show_ui(row, |list| {
            for filter in PickFilter::ALL {
                list.selectable_value(&mut ui.filter, filter, filter.name());
            }
        });
        kinds.response.widget_info(|| {
            let value = Some(ui.filter.name().to_owned());
            WidgetInfo { current_text_value: value, ..WidgetInfo::labeled(WidgetType::ComboBox, true, "Pick") }
        });
        row.separator();
        let (undo, redo) = session.scene.has();
        for (name, command, on) in [("Undo", Command::Undo, undo), ("Redo", Command::Redo, redo)] {
            if row.add_enabled(on, egui::Button::new(name)).clicked() {
                ui.commands.push(command);
            }
        }
        row.separator();
        let mut explosion = session.scene.now().explosion;
        let trims = row.selectable_label(ui.trims, "Trims").on_hover_text("Drag a trim loop of the selected face (T)");
        if trims.clicked() {
            ui.commands.push(Command::Trims);
        }
        row.separator();
        row.label("Explode");
        let slider = row.add(egui::Slider::new(&mut explosion, 0.0..=1.0).show_value(false));
        slider.widget_info(|| WidgetInfo::slider(true, explosion, "Explode"));
        drag(&slider, session, |state| state.explosion = explosion);
        row.separator();
        let help = row.button("?").on_hover_text("Help");
        help.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Help"));
        if help.clicked() {
            ui.commands.push(Command::Help);
        }
    });
}

/// A slider is one change from its press to its release.
fn drag(slider: &egui::Response, session: &mut Session, change: impl FnOnce(&mut crate::session::SceneState)) {
    if slider.drag_started() {
        session.scene.begin();
    }
    if slider.dragged() {
        session.scene.go_on(change);
    } else if slider.changed() {
        session.scene.change(change);
    }
}

fn file(menu: &mut egui::Ui, ui: &mut Ui, session: &Session, settings: &Settings) {
    let mut item = |menu: &mut egui::Ui, name: &str, command: Command| {
        if menu.button(name).clicked() {
            ui.commands.push(command);
            menu.close();
        }
    };
    item(menu, "Open...", Command::OpenDialog);
    menu.menu_button("Recent", |menu| {
        for path in &settings.recent {
            item(menu, &path.display().to_string(), Command::Open(path.clone()));
        }
    });
    item(menu, "Read again", Command::Reload);
    menu.menu_button("Close", |menu| {
        for (i, file) in session.world.files.iter().enumerate() {
            item(menu, &file.name, Command::Close(i));
        }
    });
    menu.separator();
    item(menu, "Save model...", Command::SaveAs);
    item(menu, "Write picture...", Command::Screenshot);
    item(menu, "Copy picture", Command::CopyPicture);
    item(menu, "Check this view", Command::Check);
    item(menu, "Copy command of this view", Command::CopyCommand);
    menu.separator();
    item(menu, "Quit", Command::Quit);
}

fn views(menu: &mut egui::Ui, ui: &mut Ui, facts: &Facts<'_>) {
    let mut item = |menu: &mut egui::Ui, name: &str, command: Command| {
        if menu.button(name).clicked() {
            ui.commands.push(command);
            menu.close();
        }
    };
    for view in StandardView::ALL {
        item(menu, view.name(), Command::Standard(view));
    }
    menu.separator();
    item(menu, "All", Command::Fit);
    item(menu, "Selection", Command::FitSelection);
    item(menu, "Previous", Command::Previous);
    let other = if facts.view.is_parallel() { "Perspective" } else { "Parallel" };
    item(menu, other, Command::Projection);
}

fn style(menu: &mut egui::Ui, ui: &mut Ui, settings: &mut Settings) {
    for style in Style::ALL {
        menu.radio_value(&mut ui.style, *style, style.name());
    }
    menu.separator();
    for (lines, name) in [(Lines::All, "all edges"), (Lines::Sharp, "sharp edges"), (Lines::None, "no edges")] {
        menu.radio_value(&mut settings.lines, lines, name);
    }
    menu.checkbox(&mut settings.silhouettes, "silhouettes");
    menu.checkbox(&mut settings.hidden_lines, "hidden lines");
    menu.checkbox(&mut settings.smooth, "smooth borders");
    menu.separator();
    menu.checkbox(&mut settings.ambient, "ambient occlusion");
    menu.checkbox(&mut settings.shadows, "shadows");
}

/// There may be another section.
fn has_room(session: &Session) -> bool {
    session.scene.now().sections.len() < MOST_SECTIONS && !session.world.is_empty()
}

fn sections(menu: &mut egui::Ui, ui: &mut Ui, session: &mut Session) {
    let bounds = session.world.bounds;
    let at_face = egui::Button::new("At the selected face").shortcut_text("C");
    if menu.add_enabled(cut::at_selection(session).is_some() && has_room(session), at_face).clicked() {
        ui.commands.push(Command::Cut);
        menu.close();
    }
    menu.horizontal(|row| {
        for (name, axis) in [("Across x", DVec3::X), ("Across y", DVec3::Y), ("Across z", DVec3::Z)] {
            if row.add_enabled(has_room(session), egui::Button::new(name)).clicked() {
                session.scene.change(|state| state.sections.push(Section::across(axis, bounds)));
            }
        }
    });
    let all = session.scene.now().sections.clone();
    for (i, section) in all.iter().enumerate() {
        menu.horizontal(|row| {
            let mut on = section.on;
            let name = format!("Section {}", i + 1);
            let is_on = row.checkbox(&mut on, "");
            is_on.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, on, &name));
            if is_on.changed() {
                session.scene.change(|state| state.sections[i].on = on);
            }
            let (low, high) = section.range(bounds);
            let mut offset = section.offset;
            let slider = row.add(egui::Slider::new(&mut offset, low..=high).text(name));
            drag(&slider, session, |state| state.sections[i].offset = offset);
            if row.button("Flip").clicked() {
                session.scene.change(|state| state.sections[i] = state.sections[i].flipped());
            }
            if row.button("Remove").clicked() {
                session.scene.change(|state| _ = state.sections.remove(i));
            }
        });
    }
}

fn choices(menu: &mut egui::Ui, settings: &mut Settings) {
    menu.label("Mouse as in");
    for preset in Preset::ALL {
        menu.radio_value(&mut settings.preset, preset, preset.name());
    }
    menu.separator();
    menu.radio_value(&mut settings.orbit, OrbitStyle::Turntable, "turn upright");
    menu.radio_value(&mut settings.orbit, OrbitStyle::Free, "turn freely");
    let at_once = menu.checkbox(&mut settings.reduced_motion, "views change at once");
    at_once.on_hover_text("They do so, too, where the desktop's settings ask for less motion");
    menu.separator();
    for (theme, name) in [(Theme::System, "as the system"), (Theme::Light, "light"), (Theme::Dark, "dark")] {
        menu.radio_value(&mut settings.theme, theme, name);
    }
    menu.add(egui::Slider::new(&mut settings.text, 0.5..=4.0).text("text"));
}
