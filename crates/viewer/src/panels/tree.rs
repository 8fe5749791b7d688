//! Open files with their parts: show, hide, isolate, make transparent, colour, find.

use super::Ui;
use crate::commands::Command;
use crate::session::Picked;
use crate::session::Session;
use selvedge::model::GREY;

/// Rows that are drawn of a file; the search finds the others.
const MOST_ROWS: usize = 2000;

/// Shows it.
pub fn show(panel: &mut egui::Ui, ui: &mut Ui, session: &mut Session) {
    panel.horizontal(|row| {
        row.label("Find");
        row.add(egui::TextEdit::singleline(&mut ui.search).desired_width(f32::INFINITY));
    });
    panel.horizontal(|row| {
        for (name, command) in [("Show all", Command::ShowAll), ("Hide", Command::Hide), ("Isolate", Command::Isolate)]
        {
            if row.small_button(name).clicked() {
                ui.commands.push(command);
            }
        }
    });
    panel.separator();
    egui::ScrollArea::both().auto_shrink(false).show(panel, |area| {
        let world = session.world.clone();
        for file in &world.files {
            egui::CollapsingHeader::new(&file.name).id_salt(&file.path).default_open(true).show(area, |list| {
                if !file.complete {
                    list.colored_label(list.visuals().warn_fg_color, "not complete").on_hover_text(&file.summary);
                }
                let wanted = ui.search.to_lowercase();
                let found: Vec<usize> = file
                    .instances
                    .clone()
                    .filter(|i| wanted.is_empty() || world.instance_name(*i).to_lowercase().contains(&wanted))
                    .collect();
                found.iter().take(MOST_ROWS).for_each(|instance| part(list, ui, session, *instance));
                if found.len() > MOST_ROWS {
                    list.label(format!("and {} more: find them by name", found.len() - MOST_ROWS));
                }
                let count = world.model.instances.len();
                for solid in file.solids.clone() {
                    solid_row(list, session, count + solid, &format!("Solid {}", solid + 1));
                }
            });
        }
        if world.is_empty() {
            area.label("Open a file, or drop one here.");
        }
    });
    ui.show_selection = false;
}

fn eye(row: &mut egui::Ui, session: &mut Session, item: usize) {
    let mut visible = !session.scene.now().hidden.contains(&item);
    if row.checkbox(&mut visible, "").on_hover_text("Shown or hidden").changed() {
        session.scene.change(|state| state.set_hidden(item, !visible));
    }
}

fn solid_row(list: &mut egui::Ui, session: &mut Session, item: usize, name: &str) {
    list.horizontal(|row| {
        eye(row, session, item);
        row.label(name);
    });
}

fn part(list: &mut egui::Ui, ui: &mut Ui, session: &mut Session, instance: usize) {
    let world = session.world.clone();
    let placed = &world.model.instances[instance];
    let name = world.instance_name(instance);
    list.horizontal(|row| {
        eye(row, session, instance);
        let own = world.model.parts[placed.part].faces.iter().find_map(|face| face.colour);
        let state = session.scene.now();
        let mut colour = state.colours.get(&instance).copied().or(placed.colour).or(own).unwrap_or(GREY);
        let mut rgb = [colour[0], colour[1], colour[2]];
        if row.color_edit_button_rgb(&mut rgb).on_hover_text("Colour").changed() {
            colour[..3].copy_from_slice(&rgb);
            session.scene.change(|state| _ = state.colours.insert(instance, colour));
        }
        let selected = session.selected_instances().contains(&instance);
        let label = row.selectable_label(selected, name);
        if selected && ui.show_selection {
            label.scroll_to_me(None);
        }
        if label.clicked() {
            let add = row.input(|input| input.modifiers.shift);
            session.select(Some(Picked::Instance(instance)), add);
        }
        label.context_menu(|menu| {
            let mut item = |menu: &mut egui::Ui, name: &str, command: Command| {
                if menu.button(name).clicked() {
                    session.select(Some(Picked::Instance(instance)), false);
                    ui.commands.push(command);
                    menu.close();
                }
            };
            item(menu, "Hide", Command::Hide);
            item(menu, "Isolate", Command::Isolate);
            item(menu, "See through", Command::SeeThrough);
            item(menu, "Zoom to", Command::FitSelection);
            if menu.button("Own colour").clicked() {
                session.scene.change(|state| _ = state.colours.remove(&instance));
                menu.close();
            }
        });
    });
}
